#include "blocks/contour/contour_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "blocks/contour/baseline.hpp"

namespace lineshaft {

namespace {

constexpr double nm_in_mm = 1e6;
constexpr double farthest = 1e9;  // [mm] sums of squares stay numbers

bool usable(double x) {
    return std::abs(x) <= farthest;
}

}  // namespace

std::span<const Field> ContourComparison::fields() {
    using C = ContourComparison;
    using S = MagnitudeStatistics;
    static const Field table[] = {
        input("enable", &C::enable, "", "take samples").must_be_set(),
        input("command_x", &C::command_x, "mm", "set-point of the path").must_be_set(),
        input("command_y", &C::command_y, "mm", "set-point of the path").must_be_set(),
        input("actual_x", &C::actual_x, "mm", "actual position").must_be_set(),
        input("actual_y", &C::actual_y, "mm", "actual position").must_be_set(),
        output("real_time", &C::real_time, "mm", "real-time estimate of the contour error"),
        output("linear", &C::linear, "mm", "distance to the polyline of the commands"),
        output("spline", &C::spline, "mm", "distance to the natural spline of the commands"),
        output("mean_real_time", &C::real_time_error, &S::mean, "mm", "of real_time"),
        output("rms_real_time", &C::real_time_error, &S::rms, "mm", "of real_time"),
        output("greatest_real_time", &C::real_time_error, &S::greatest, "mm", "of real_time"),
        output("mean_linear", &C::linear_error, &S::mean, "mm", "of linear"),
        output("rms_linear", &C::linear_error, &S::rms, "mm", "of linear"),
        output("greatest_linear", &C::linear_error, &S::greatest, "mm", "of linear"),
        output("mean_spline", &C::spline_error, &S::mean, "mm", "of spline"),
        output("rms_spline", &C::spline_error, &S::rms, "mm", "of spline"),
        output("greatest_spline", &C::spline_error, &S::greatest, "mm", "of spline"),
        output("mean_to_linear", &C::to_linear, &S::mean, "nm", "of |real_time - linear|"),
        output("greatest_to_linear", &C::to_linear, &S::greatest, "nm", "of |real_time - linear|"),
        output("mean_to_spline", &C::to_spline, &S::mean, "nm", "of |real_time - spline|"),
        output("greatest_to_spline", &C::to_spline, &S::greatest, "nm", "of |real_time - spline|"),
        output("mean_following_error", &C::following_error, &S::mean, "mm",
               "command to actual point"),
        output("mean_points_back", &C::mean_points_back, "",
               "command points from the newest to the nearest"),
        output("samples", &C::samples, "", "taken since the rising edge"),
        output("waiting", &C::waiting, "",
               "ahead of the newest command, until it has gone by them"),
    };
    return table;
}

void ContourComparison::scan(const Scan&) {
    if (rising_edge(enable, last_enable)) begin();
    if (!usable(command_x) || !usable(command_y)) return;
    path.add({command_x, command_y});
    if (!enable) return;
    take_passed();
    if (!usable(actual_x) || !usable(actual_y)) return;
    const ContourEstimate estimate = path.estimate({actual_x, actual_y});
    const Sample sample{
        {command_x, command_y}, {actual_x, actual_y}, std::abs(estimate.signed_error)};
    if (estimate.is_ahead)
        wait(sample);
    else if (!estimate.out_of_reach)
        take(sample, estimate.points_back);
}

void ContourComparison::begin() {
    real_time_error = linear_error = spline_error = following_error = {};
    to_linear = to_spline = points_back = {};
    samples = waiting = 0;
    mean_points_back = 0;
}

void ContourComparison::take_passed() {
    std::int64_t kept = 0;
    for (std::int64_t i = 0; i < waiting; ++i) {
        const Sample sample = ahead[static_cast<std::size_t>(i)];
        const ContourEstimate now = path.estimate(sample.actual);
        if (now.is_ahead)
            ahead[static_cast<std::size_t>(kept++)] = sample;
        else if (!now.out_of_reach)
            take(sample, now.points_back);
    }
    waiting = kept;
}

void ContourComparison::wait(const Sample& sample) {
    if (waiting == most_waiting) {
        std::copy(ahead.begin() + 1, ahead.end(), ahead.begin());
        --waiting;
    }
    ahead[static_cast<std::size_t>(waiting++)] = sample;
}

void ContourComparison::take(const Sample& sample, std::int64_t back) {
    const Point p = sample.actual;
    const std::int64_t oldest = std::min(path.size() - 1, back + reach);
    const std::int64_t newest = std::max<std::int64_t>(0, back - reach);
    std::array<Point, 2 * reach + 1> room{};
    std::array<SplineSpan, 2 * reach> span_room{};
    const auto count = static_cast<std::size_t>(oldest - newest) + 1;
    const auto nearest = static_cast<std::size_t>(oldest - back);
    const std::span points(room.data(), count);
    const std::span spans(span_room.data(), count - 1);
    for (std::size_t i = 0; i < count; ++i)
        points[i] = path.point(oldest - static_cast<std::int64_t>(i));
    natural_spline(points, spans);

    real_time = sample.real_time;
    linear = polyline_distance(points, nearest, p);
    spline = spans.empty() ? linear : spline_distance(spans, nearest, p);
    real_time_error.add(real_time);
    linear_error.add(linear);
    spline_error.add(spline);
    to_linear.add((real_time - linear) * nm_in_mm);
    to_spline.add((real_time - spline) * nm_in_mm);
    const double dx = sample.command.x - p.x, dy = sample.command.y - p.y;
    following_error.add(std::sqrt(dx * dx + dy * dy));
    points_back.add(static_cast<double>(back));
    mean_points_back = points_back.mean;
    samples = points_back.count;
}

}  // namespace lineshaft
