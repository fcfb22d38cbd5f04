#include "blocks/path/path_box.hpp"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/blocks/path/path_random.hpp"
#include "tests/blocks/path/random_path.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

PathLimit random_limit(Random& random) {
    return {random.decades(1, 3), random.decades(1, 4), random.decades(2, 6)};
}

/// A corner of two lines in space, which other axes follow.
struct BoxedCorner {
    PathLimits limits;
    PathCurve corner;
    PathLimit box;

    explicit BoxedCorner(Random& random) {
        const std::size_t counted = random.share() < 0.7 ? path_space : most_path_axes;
        limits.path = random_limit(random);
        for (PathLimit& axis : limits.axes) axis = random_limit(random);
        const double turn = random.decades(-3, 0), size = random.decades(-2, 2);
        PathVector middle{}, end{};
        for (std::size_t i = 0; i < most_path_axes; ++i) {
            middle[i] = size * random.between(-1, 1);
            end[i] = middle[i] + (1 - turn) * middle[i] + turn * size * random.between(-1, 1);
        }
        PathCurve before, after;
        REQUIRE(line_to({}, middle, before, counted) == PathFault::none);
        REQUIRE(line_to(middle, end, after, counted) == PathFault::none);
        const double distance = 0.4 * std::min(before.length, after.length);
        corner = corner_between(before, after, distance);
        box = box_of_corner(before, after, corner.length, limits);
    }

    /// The greatest quotient of what a motion comes to at a place and the limit for that.
    double quotient_at(double place, double v, double a, double j) const {
        const PathPoint x = corner.at(place * corner.length);
        double most = 0, acceleration = 0, jerk = 0;
        for (std::size_t i = 0; i < most_path_axes; ++i) {
            const double a_i = x.tangent[i] * a + x.bend[i] * v * v;
            const double j_i = x.tangent[i] * j + 3 * x.bend[i] * v * a + x.twist[i] * v * v * v;
            const PathLimit& axis = limits.axes[i];
            most = std::max({most, std::abs(x.tangent[i]) * v / axis.velocity,
                             std::abs(a_i) / axis.acceleration, std::abs(j_i) / axis.jerk});
            if (i < path_space) acceleration += a_i * a_i, jerk += j_i * j_i;
        }
        return std::max({most, std::sqrt(acceleration) / limits.path.acceleration,
                         std::sqrt(jerk) / limits.path.jerk});
    }
};

}  // namespace

TEST_CASE("path_box: all that the box of a corner allows keeps the limits of axes and path") {
    Random random(3);
    int nearly_all = 0, easily = 0;
    for (int problem = 0; problem < 2000; ++problem) {
        const BoxedCorner drawn(random);
        const PathLimit& box = drawn.box;
        INFO("corner " << problem);
        REQUIRE(is_good(box));
        double most = 0, steady = 0;
        for (int k = 0; k <= 40; ++k)
            for (const double part : {1.0, 0.7})
                for (const double a : {-box.acceleration, 0.0, box.acceleration})
                    for (const double j : {-box.jerk, 0.0, box.jerk}) {
                        const double q = drawn.quotient_at(k / 40.0, part * box.velocity, a, j);
                        most = std::max(most, q);
                        if (a == 0 && j == 0) steady = std::max(steady, q);
                    }
        CHECK(most <= 1 + 1e-12);
        if (most > 0.95) ++nearly_all;
        if (steady > 0.89 || box.velocity == drawn.limits.path.velocity) ++easily;
    }
    CHECK(nearly_all > 1000);
    CHECK(easily > 1900);
}

TEST_CASE("path_box: where two lines hardly turn a corner leaves more than a third of the jerk") {
    PathCurve before, after;
    REQUIRE(line_to({}, {10, 0}, before) == PathFault::none);
    REQUIRE(line_to({10, 0}, {20, 0.1}, after) == PathFault::none);
    PathLimits limits{{100, 1000, 10'000}, {}};
    limits.axes.fill(no_path_limit);
    const PathLimit box = box_of_corner(before, after, 0.1, limits);
    CHECK(box.velocity == Approx(std::cbrt(0.93 * 10'000 / (6 * 0.01 / 0.01))).epsilon(1e-3));
    CHECK(box.acceleration == Approx(box.velocity * box.velocity / 0.15).epsilon(1e-3));
    CHECK(box.jerk > 0.36 * 10'000);
}
