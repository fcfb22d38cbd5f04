#include "blocks/contour/command_path.hpp"

#include <cmath>

namespace lineshaft {

namespace {

constexpr double least_step = 1e-12;  // below it a command stands

double squared_distance(Point a, Point b) {
    const double dx = a.x - b.x, dy = a.y - b.y;
    return dx * dx + dy * dy;
}

Point difference(Point a, Point b) {
    return {a.x - b.x, a.y - b.y};
}

}  // namespace

bool CommandPath::add(Point command) {
    if (count_ > 0 && squared_distance(command, point(0)) < least_step * least_step) return false;
    points_[static_cast<std::size_t>(count_ & (capacity - 1))] = command;
    ++count_;
    return true;
}

std::int64_t CommandPath::nearest(Point actual) const {
    double least = squared_distance(actual, point(0));
    std::int64_t back = 0;
    for (const std::int64_t oldest = size() - 1; back < oldest; ++back) {
        const double next = squared_distance(actual, point(back + 1));
        if (!(next <= least)) break;
        least = next;
    }
    return back;
}

/// Not of unit length; 0 where there is none.
Point CommandPath::tangent(std::int64_t back) const {
    const bool first = back == size() - 1, newest = back == 0;
    const Point before = point(first ? back : back + 1);
    const Point t = difference(point(newest ? back : back - 1), before);
    return t.x == 0 && t.y == 0 && !first ? difference(point(back), before) : t;
}

ContourEstimate CommandPath::estimate(Point actual) const {
    ContourEstimate result;
    const std::int64_t back = nearest(actual);
    result.points_back = back;
    result.out_of_reach = back == capacity - 1;
    if (result.out_of_reach) return result;
    result.at_newest = back == 0;
    const Point r = difference(actual, point(back)), t = tangent(back);
    const double length = std::sqrt(t.x * t.x + t.y * t.y);
    if (length == 0) {
        result.signed_error = std::sqrt(r.x * r.x + r.y * r.y);
        result.is_ahead = size() == 1 && result.signed_error > 0;
        return result;
    }
    result.normal = {-t.y / length, t.x / length};
    result.signed_error = (t.x * r.y - t.y * r.x) / length;
    result.is_ahead = result.at_newest && t.x * r.x + t.y * r.y > 0;
    return result;
}

}  // namespace lineshaft
