#include "blocks/profile/cam.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cassert>
#include <cmath>

namespace lineshaft {

namespace {

CamProblem check(std::span<const CamPoint> points) {
    if (points.size() < 2) return {CamFault::too_few_points, 0};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const CamPoint& p = points[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || std::isinf(p.slope) || std::isinf(p.bend))
            return {CamFault::not_finite, i};
        if (i > 0 && !(p.x > points[i - 1].x)) return {CamFault::not_monotonic, i};
    }
    return {};
}

class Spline {
  public:
    Spline(std::span<CamPoint> points, bool periodic) : points_(points), periodic_(periodic) {}

    void complete() {
        take_slopes_of_lines();
        solve_slopes();
        for (CamPoint& p : points_)
            if (std::isnan(p.bend)) p.bend = bend(static_cast<std::size_t>(&p - points_.data()));
    }

  private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    /// The segments before and after a point, by the points that they begin at.
    std::array<std::size_t, 2> beside(std::size_t i) const {
        const std::size_t last = points_.size() - 1;
        return {i > 0 ? i - 1 : periodic_ ? last - 1 : none, i < last ? i : periodic_ ? 0 : none};
    }
    double way(std::size_t s) const { return points_[s + 1].x - points_[s].x; }
    double secant(std::size_t s) const { return (points_[s + 1].y - points_[s].y) / way(s); }

    void take_slopes_of_lines() {
        for (std::size_t i = 0; i < points_.size(); ++i)
            for (const std::size_t s : beside(i))
                if (s != none && points_[s].curve == CamCurve::linear &&
                    std::isnan(points_[i].slope))
                    points_[i].slope = secant(s);
    }

    /// The equations of a spline have a dominant diagonal: each sweep halves the error at least.
    void solve_slopes() {
        std::bitset<most_cam_points> open;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            open[i] = std::isnan(points_[i].slope);
            if (open[i]) points_[i].slope = 0;
        }
        for (int sweep = 0; sweep < 100; ++sweep)
            for (std::size_t i = 0; i < points_.size(); ++i)
                if (open[i]) points_[i].slope = slope_between_neighbours(i);
    }

    double slope_between_neighbours(std::size_t i) const {
        double sum = 0, weight = 0;
        const auto [before, after] = beside(i);
        const auto add = [&](std::size_t s, double other) {
            sum += (3 * secant(s) - other) / way(s);
            weight += 2 / way(s);
        };
        if (before != none) add(before, points_[before].slope);
        if (after != none) add(after, points_[after + 1].slope);
        return sum / weight;
    }

    double bend(std::size_t i) const {
        double sum = 0, sides = 0;
        const auto [before, after] = beside(i);
        const auto add = [&](std::size_t s, double sign, double here, double there) {
            sum += sign * (6 * secant(s) - 4 * here - 2 * there) / way(s);
            ++sides;
        };
        if (after != none) add(after, 1, points_[after].slope, points_[after + 1].slope);
        if (before != none) add(before, -1, points_[before + 1].slope, points_[before].slope);
        return sum / sides;
    }

    std::span<CamPoint> points_;
    bool periodic_;
};

/// Over the way from p.
Polynomial<5> curve(const CamPoint& p, const CamPoint& q) {
    const double h = q.x - p.x, rise = (q.y - p.y) / h;
    if (p.curve == CamCurve::linear) return {{p.y, rise, 0, 0, 0, 0}};
    if (p.curve == CamCurve::cubic)
        return {{p.y, p.slope, (3 * rise - 2 * p.slope - q.slope) / h,
                 (p.slope + q.slope - 2 * rise) / (h * h), 0, 0}};
    Polynomial<5> y = SyncCurve::between(0, h, {p.y, p.slope, p.bend}, {q.y, q.slope, q.bend}).y;
    double per = 1;
    for (double& c : y.c) {
        c *= per;
        per /= h;
    }
    return y;
}

CurvePoint at_way(const Polynomial<5>& y, double h) {
    const auto first = y.slope();
    const auto second = first.slope();
    return {y.at(h), first.at(h), second.at(h), second.slope().at(h)};
}

}  // namespace

CamProblem complete_cam(std::span<CamPoint> points, bool periodic) {
    assert(points.size() <= most_cam_points);
    const CamProblem problem = check(points);
    if (problem.fault == CamFault::none) Spline(points, periodic).complete();
    return problem;
}

double Cam::periods(double x) const {
    return x < begin() || x >= points.back().x ? std::floor((x - begin()) / length()) : 0;
}

CurvePoint Cam::at(double x) const {
    const double turns = periods(x);
    if (turns != 0 && !periodic) return {(x < begin() ? points.front() : points.back()).y};
    const double within = std::clamp(x - turns * length(), begin(), points.back().x);
    const auto next = std::upper_bound(points.begin(), points.end() - 1, within,
                                       [](double at, const CamPoint& p) { return at < p.x; });
    const CamPoint& p = *(next - 1);
    const double h = within - p.x;
    CurvePoint found = at_way(curve(p, *next), h);
    found.y += turns * lift();
    return found;
}

CurvePoint Cam::last() const {
    const CamPoint &p = *(points.end() - 2), &q = points.back();
    return at_way(curve(p, q), q.x - p.x);
}

double Cam::area(double x) const {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < points.size() && points[i].x < x; ++i) {
        const auto y = curve(points[i], points[i + 1]);
        const double h = std::min(x, points[i + 1].x) - points[i].x;
        double power = h;
        for (std::size_t n = 0; n < y.c.size(); ++n, power *= h)
            sum += y.c[n] * power / static_cast<double>(n + 1);
    }
    return sum;
}

namespace {

/// Twice integrated, from a value and a slope on.
Polynomial<7> twice_integrated(const Polynomial<5>& y, double value, double slope) {
    Polynomial<7> twice{{value, slope}};
    for (std::size_t n = 0; n < y.c.size(); ++n)
        twice.c[n + 2] = y.c[n] / static_cast<double>((n + 1) * (n + 2));
    return twice;
}

}  // namespace

double Cam::area_of_areas(double x) const {
    double sum = 0, slope = 0;
    for (std::size_t i = 0; i + 1 < points.size() && points[i].x < x; ++i) {
        const auto twice = twice_integrated(curve(points[i], points[i + 1]), sum, slope);
        const double h = std::min(x, points[i + 1].x) - points[i].x;
        sum = twice.at(h);
        slope = twice.slope().at(h);
    }
    return sum;
}

Range Cam::areas_of_areas(double scale, double offset, double slope) const {
    Range all;
    double sum = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        auto y = curve(points[i], points[i + 1]);
        for (double& c : y.c) c *= scale;
        y.c[0] += offset;
        const auto twice = twice_integrated(y, sum, slope);
        const double h = points[i + 1].x - points[i].x;
        const Range r = range(twice, 0, h);
        all = {std::min(all.least, r.least), std::max(all.greatest, r.greatest)};
        sum = twice.at(h);
        slope = twice.slope().at(h);
    }
    return all;
}

Range Cam::values() const {
    Range all{points.front().y, points.front().y};
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Range r = range(curve(points[i], points[i + 1]), 0, points[i + 1].x - points[i].x);
        all = {std::min(all.least, r.least), std::max(all.greatest, r.greatest)};
    }
    return all;
}

Range Cam::areas(double scale, double offset) const {
    Range all;
    double sum = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const auto y = curve(points[i], points[i + 1]);
        const double h = points[i + 1].x - points[i].x;
        Polynomial<6> area{{sum, offset}};
        for (std::size_t n = 0; n < y.c.size(); ++n)
            area.c[n + 1] += scale * y.c[n] / static_cast<double>(n + 1);
        const Range r = range(area, 0, h);
        all = {std::min(all.least, r.least), std::max(all.greatest, r.greatest)};
        sum = area.at(h);
    }
    return all;
}

CamExtremes Cam::extremes() const {
    CamExtremes most;
    CurvePoint before;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const double h = points[i + 1].x - points[i].x;
        const auto y = curve(points[i], points[i + 1]);
        const auto slope = y.slope();
        const auto bend = slope.slope();
        most.y = std::max(most.y, range(y, 0, h).size());
        most.slope = std::max(most.slope, range(slope, 0, h).size());
        most.bend = std::max(most.bend, range(bend, 0, h).size());
        most.twist = std::max(most.twist, range(bend.slope(), 0, h).size());
        const CurvePoint begin = at_way(y, 0);
        if (i > 0) {
            most.slope_jump = std::max(most.slope_jump, std::abs(begin.slope - before.slope));
            most.bend_jump = std::max(most.bend_jump, std::abs(begin.bend - before.bend));
        }
        before = at_way(y, h);
    }
    return most;
}

}  // namespace lineshaft
