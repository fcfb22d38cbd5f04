#include "blocks/path/path_ahead.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/path/path.hpp"

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

}  // namespace

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
