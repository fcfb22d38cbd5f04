#include "blocks/path/path_ahead.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/path/path.hpp"
#include "blocks/path/path_ahead.hpp"
#include "tests/blocks/path/path_random.hpp"

using namespace lineshaft;

namespace {

struct Contour {
    std::vector<PathPiece> ring = std::vector<PathPiece>(32);
    Path path;
    PathLimits limits{{150, 2000, 5e4}, {}};

    Contour() {
        limits.axes.fill({200, 2000, 5e4});
        PathVector from{};
        for (const PathVector& to : {PathVector{30, 0}, {30, 20}, {0, 25}, {-10, 0}}) {
            PathCurve line;
            REQUIRE(line_to(from, to, line) == PathFault::none);
            REQUIRE(path.append(ring, line, limits, {0, 4}) == PathFault::none);
            from = to;
        }
        path.advance(ring, 0);
    }

    double run_to_stand() {
        double time = 0;
        for (; !path.standing(); time += 1e-3) path.advance(ring, 1e-3);
        return time;
    }
};

/// Random lines with corners, and what is planned of them before the motion begins. Times are
/// `slower` times as long.
struct Outset {
    std::vector<PathPiece> ring = std::vector<PathPiece>(64);
    Path path;
    PathOutlook outlook;
    PathLeg leg;

    Outset(std::uint64_t seed, double size, double slower) {
        test::Random random(seed);
        const auto limit = [&](double v, double a, double j) {
            return PathLimit{v / slower, a / (slower * slower), j / (slower * slower * slower)};
        };
        PathLimits limits{limit(random.decades(1, 3), random.decades(2, 4), random.decades(3, 6)),
                          {}};
        for (PathLimit& axis : limits.axes)
            axis = limit(200, random.decades(2, 4), random.decades(3, 6));
        PathVector from{};
        for (int k = 0; k < 24; ++k) {
            PathVector to = from;
            for (std::size_t i = 0; i < 2; ++i) to[i] += size * random.between(-1, 1);
            PathCurve line;
            REQUIRE(line_to(from, to, line) == PathFault::none);
            const double corner = size * random.between(0.02, 0.3);
            REQUIRE(path.append(ring, line, limits, {0, corner}) == PathFault::none);
            from = to;
        }
        look_back({ring, 0, path.stretches}, 0, {});
        outlook = {{ring, 0, path.stretches}, {ring, 0, path.count}, 1, no_path_limit};
        REQUIRE(plan_leg(outlook.stretches, {}, 0, 1, no_path_limit, leg));
    }

    /// What legs in boxes take to a place at which one of them ends [s].
    double in_boxes_until(double place) const {
        PathLeg next;
        REQUIRE(plan_leg(outlook.stretches, {}, 0, 1, no_path_limit, next));
        double taken = next.duration();
        while (next.end < place) {
            const ConstPathStretches rest{ring, next.goal + 1, path.stretches};
            REQUIRE(
                plan_leg(rest, {0, next.end_velocity(), 0, 0}, next.end, 1, no_path_limit, next));
            taken += next.duration();
        }
        CHECK(next.end == place);
        return taken;
    }
};

}  // namespace

TEST_CASE("path_ahead: what is looked for in vain is looked for over fewer legs and further on") {
    int found = 0, over_fewer = 0, in_vain = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        Outset outset(seed, 20, 1);
        const PathLeg before = outset.leg;
        PathVain vain;
        INFO("seed " << seed);
        if (look_ahead(outset.outlook, 0, outset.leg, vain)) {
            ++found;
            CHECK(outset.leg.duration() <= 0.998 * outset.in_boxes_until(outset.leg.end));
            CHECK(vain.until == 0);
            CHECK(vain.legs >= 2);
            PathVain few;
            few.legs = 2;
            PathLeg leg = before;
            if (!look_ahead(outset.outlook, 0, leg, few)) continue;
            CHECK(leg.end <= outset.leg.end);
            CHECK(few.legs <= 4);
            if (leg.end < outset.leg.end) ++over_fewer;
        } else {
            ++in_vain;
            CHECK(outset.leg.end == before.end);
            CHECK(outset.leg.course.count == 0);
            CHECK(vain.until > 0);
            CHECK(vain.legs < PathCourse::most_phases);
        }
        vain.until = before.end;
        PathLeg leg = before;
        CHECK_FALSE(look_ahead(outset.outlook, 0, leg, vain));
    }
    CHECK(found > 20);
    CHECK(over_fewer > 20);
    CHECK(in_vain > 3);
}

TEST_CASE("path_ahead: a leg that leads beyond what was looked at in vain is looked at") {
    Outset outset(0, 20, 1);
    PathVain vain;
    vain.until = 0.99 * outset.leg.end;
    CHECK(look_ahead(outset.outlook, 0, outset.leg, vain));
}

TEST_CASE("path_ahead: no course is looked for where a piece takes a few milliseconds") {
    for (const double slower : {0.02, 1.0}) {
        Outset outset(1, 20, slower);
        const bool is_slow = slower == 1;
        const double in_boxes = outset.leg.end;
        PathVain vain;
        CHECK(look_ahead(outset.outlook, 0, outset.leg, vain) == is_slow);
        CHECK((outset.leg.course.count > 0) == is_slow);
        CHECK((outset.leg.end > in_boxes) == is_slow);
        CHECK((vain.until > in_boxes) == !is_slow);
    }
}

TEST_CASE("path_ahead: corners are passed by one course, sooner than in boxes") {
    Contour contour;
    CHECK(contour.path.leg.course.count > 0);
    CHECK(contour.path.leg.end == contour.path.total);
    PathLeg in_boxes;
    double boxes = 0, velocity = 0, base = 0;
    for (std::uint64_t stretch = 0; stretch < contour.path.stretches; stretch = in_boxes.goal + 1) {
        REQUIRE(plan_leg({contour.ring, stretch, contour.path.stretches}, {0, velocity, 0, 0}, base,
                         1, no_path_limit, in_boxes));
        boxes += in_boxes.duration();
        velocity = in_boxes.end_velocity();
        base = in_boxes.end;
    }
    CHECK(contour.path.leg.duration() < 0.95 * boxes);
}

TEST_CASE("path_ahead: on an arc a course cruises without a ripple") {
    std::vector<PathPiece> ring(4);
    Path path;
    PathLimits limits{{60, 2000, 1e6}, {}};
    limits.axes.fill({200, 2000, 4e4});
    PathCurve arc;
    REQUIRE(arc_through({5, 0}, {-5, 0}, {0, -5}, arc) == PathFault::none);
    REQUIRE(path.append(ring, arc, limits) == PathFault::none);
    path.advance(ring, 0);
    CHECK(path.leg.course.count > 0);
    int cruising = 0;
    while (!path.finished()) {
        const PathMotion m = path.advance(ring, 1e-3);
        if (m.path.position < 8 || m.path.position > 15) continue;
        CHECK(std::abs(m.path.velocity / 60 - 1) <= 1e-9);
        ++cruising;
    }
    CHECK(cruising > 100);
}

TEST_CASE("path_ahead: a course ends within a fifth of a second wherever it is halted") {
    for (int begin = 10; begin < 900; begin += 7) {
        Contour contour;
        contour.path.advance(contour.ring, begin * 1e-3);
        if (contour.path.finished()) break;
        contour.path.halt();
        INFO("halted after " << begin << " ms");
        CHECK(contour.run_to_stand() < 0.2);
        contour.path.resume();
        for (int scan = 0; scan < 3000 && !contour.path.finished(); ++scan)
            contour.path.advance(contour.ring, 1e-3);
        CHECK(contour.path.finished());
    }
}

TEST_CASE("path_ahead: the velocity follows an override, also in the middle of a course") {
    Contour contour;
    contour.path.advance(contour.ring, 0.3);
    contour.path.set_override(0.25);
    for (int scan = 0; scan < 200; ++scan) contour.path.advance(contour.ring, 1e-3);
    while (!contour.path.finished())
        CHECK(contour.path.advance(contour.ring, 1e-3).path.velocity <= 0.25 * 150 * (1 + 1e-9));
}

TEST_CASE("path_ahead: pieces that come while a course is halted do not set it in motion") {
    Contour contour;
    contour.path.advance(contour.ring, 0.3);
    contour.path.halt();
    PathVector from{-10, 0};
    for (int scan = 0; scan < 400; ++scan) {
        if (scan % 20 == 0 && scan < 200) {
            const PathVector to{from[0] - 5, scan % 40 == 0 ? 5.0 : 0.0};
            PathCurve line;
            REQUIRE(line_to(from, to, line) == PathFault::none);
            REQUIRE(contour.path.append(contour.ring, line, contour.limits, {0, 1}) ==
                    PathFault::none);
            from = to;
        }
        const PathMotion m = contour.path.advance(contour.ring, 1e-3);
        if (scan > 200) CHECK(m.path.velocity == 0);
    }
    contour.path.resume();
    for (int scan = 0; scan < 5000 && !contour.path.finished(); ++scan)
        contour.path.advance(contour.ring, 1e-3);
    CHECK(contour.path.now(contour.ring).position == from);
}
