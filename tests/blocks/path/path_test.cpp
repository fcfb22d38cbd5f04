#include "blocks/path/path.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/profile/seven_segment.hpp"
#include "tests/blocks/path/path_motions.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

TEST_CASE("path: a single line takes the time of the seven-segment move") {
    std::vector<PathPiece> ring(4);
    Path path;
    PathCurve line;
    REQUIRE(line_to({0, 0}, {30, 40}, line) == PathFault::none);
    REQUIRE(path.append(ring, line, wide_limits({20, 100, 1000})) == PathFault::none);
    SevenSegmentPlan least;
    REQUIRE(plan(SevenSegment{0, 0, 20, 100, 1000, 50}, least) == PlanResult::ok);
    path.advance(ring, 0);
    CHECK(path.leg.duration() == Approx(least.duration).epsilon(1e-12));
    path.advance(ring, 100);
    CHECK(path.finished());
    CHECK(path.now(ring).position == PathVector{30, 40});
}

TEST_CASE("path: on an arc the speed does not ripple and keeps what the axes allow") {
    std::vector<PathPiece> ring(4);
    Path path;
    PathCurve arc;
    REQUIRE(arc_through({20, 0}, {0, 20}, {-20, 0}, arc) == PathFault::none);
    PathLimits limits = wide_limits({10, 100, 1000});
    REQUIRE(path.append(ring, arc, limits) == PathFault::none);
    path.advance(ring, 1);
    for (int scan = 0; scan < 400; ++scan) {
        const PathMotion m = path.advance(ring, 0.01);
        CHECK(std::abs(std::hypot(m.velocity[0], m.velocity[1]) - 10) <= 1e-8);
        CHECK(std::hypot(m.position[0], m.position[1]) == Approx(20).epsilon(1e-14));
    }
}

TEST_CASE("path: many short pieces of a line take the time of the line, also when they come late") {
    constexpr double slant = 0.7, scan = 1e-3;
    constexpr int pieces = 2000;
    const PathLimits limits = wide_limits({100, 1000, 10000});
    std::vector<PathPiece> ring(300);
    Path path;
    PathVector from{};
    double time = 0;
    for (int given = 0; given < pieces || !path.finished(); time += scan) {
        for (; given < pieces && path.count - path.first < ring.size(); ++given) {
            const double way = 0.1 * (given + 1);
            const PathVector to{way * std::cos(slant), way * std::sin(slant)};
            PathCurve line;
            REQUIRE(line_to(from, to, line) == PathFault::none);
            REQUIRE(path.append(ring, line, limits) == PathFault::none);
            from = to;
        }
        REQUIRE(violation(path.advance(ring, scan), limits).empty());
    }
    SevenSegmentPlan least;
    REQUIRE(plan(SevenSegment{0, 0, 100, 1000, 10000, 0.1 * pieces}, least) == PlanResult::ok);
    CHECK(time <= least.duration + 2 * scan);
}

TEST_CASE("path: a ramp spans pieces whose limits differ, and keeps those of each") {
    std::vector<PathPiece> ring(16);
    Path path;
    PathVector from{};
    for (int i = 0; i < 10; ++i) {
        const PathVector to{2.0 * (i + 1)};
        PathCurve line;
        REQUIRE(line_to(from, to, line) == PathFault::none);
        REQUIRE(path.append(ring, line, wide_limits({100.0 - i, 1000, 10000})) == PathFault::none);
        from = to;
    }
    double time = 0;
    for (; !path.finished(); time += 1e-3) {
        const std::uint64_t piece = path.first;
        const PathMotion m = path.advance(ring, 1e-3);
        if (path.first != piece) continue;
        CHECK(violation(m, wide_limits({100.0 - static_cast<double>(piece), 1000, 10000})).empty());
    }
    SevenSegmentPlan least;
    REQUIRE(plan(SevenSegment{0, 0, 91, 1000, 10000, 20}, least) == PlanResult::ok);
    CHECK(path.stretches == 10);
    CHECK(time <= 1.01 * least.duration);
}

TEST_CASE("path: a corner is a stop, a line cut in two is not") {
    std::vector<PathPiece> ring(4);
    Path path;
    PathCurve a, b, c;
    REQUIRE(line_to({0, 0}, {10, 0}, a) == PathFault::none);
    REQUIRE(line_to({10, 0}, {30, 0}, b) == PathFault::none);
    REQUIRE(line_to({30, 0}, {30, 10}, c) == PathFault::none);
    const PathLimits limits = wide_limits({10, 100, 1000});
    for (const PathCurve& curve : {a, b, c}) {
        REQUIRE(path.append(ring, curve, limits) == PathFault::none);
    }
    CHECK(path.stretches == 2);
    path.advance(ring, 0);
    CHECK(path.leg.end == 30);
    CHECK(path.leg.end_velocity() == 0);
    CHECK(path.append(ring, a, limits) == PathFault::not_joined);
}

TEST_CASE("path: a corner is passed in motion, also when it is put in under way") {
    for (const bool late : {false, true}) {
        std::vector<PathPiece> ring(8);
        Path path;
        PathCurve a, b;
        REQUIRE(line_to({0, 0}, {10, 0}, a) == PathFault::none);
        REQUIRE(line_to({10, 0}, {10, 10}, b) == PathFault::none);
        const PathLimits limits = wide_limits({10, 100, 1000});
        REQUIRE(path.append(ring, a, limits) == PathFault::none);
        path.advance(ring, late ? 0.6 : 0);
        REQUIRE(path.append(ring, b, limits, {0, 2}) == PathFault::none);
        REQUIRE(path.count == 3);
        CHECK(path.total == Approx(20).epsilon(1e-15));
        double slowest = 10;
        while (path.first < 2) {
            const PathMotion m = path.advance(ring, 1e-3);
            if (m.position[0] > 5) slowest = std::min(slowest, m.path.velocity);
            CHECK(violation(m, limits).empty());
        }
        CHECK(slowest > 5);
    }
}

TEST_CASE(
    "path: pieces far ahead are planned with when they are needed, and change nothing before") {
    constexpr int pieces = 1200;
    const PathLimits limits = wide_limits({100, 1000, 1e4});
    const auto appended = [&](std::size_t ahead, double& lasts) {
        std::vector<PathPiece> ring(ahead);
        Path path;
        PathVector at{};
        std::uint64_t times = 0, known = 0;
        for (int k = 0; k < pieces; ++k) {
            PathVector to = at;
            const double direction = std::sin(1e-2 * k) + 0.5 * std::sin(3.7e-2 * k);
            to[0] += 0.1 * std::cos(direction);
            to[1] += 0.1 * std::sin(direction);
            PathCurve line;
            while (path.count - path.first + 2 > ring.size())
                lasts += path.advance_to(ring, Path::any_time, path.first + 1);
            REQUIRE(line_to(at, to, line) == PathFault::none);
            REQUIRE(path.append(ring, line, limits, {0, PathJoint::any, PathBlend::low, 0.01}) ==
                    PathFault::none);
            CHECK(path.sure <= path.known);
            CHECK(path.known <= path.stretches);
            times += path.known != known ? 1 : 0;
            known = path.known;
            at = to;
        }
        while (!path.finished()) lasts += path.advance_to(ring, Path::any_time, Path::to_end);
        CHECK(path.now(ring).position == at);
        return times;
    };
    double at_once = 0, far = 0, near = 0;
    CHECK(appended(2 * pieces + 2, at_once) == 0);
    CHECK(appended(1000, far) < 10);
    CHECK(appended(80, near) > 100);
    CHECK(far == Approx(at_once).epsilon(1e-9));
    CHECK(near == Approx(at_once).epsilon(0.02));
}

TEST_CASE("path: a corner that is put in before the path begins is run along") {
    std::vector<PathPiece> ring(8);
    Path path;
    PathCurve a, b;
    REQUIRE(line_to({0, 0}, {10, 0}, a) == PathFault::none);
    REQUIRE(line_to({10, 0}, {10, 10}, b) == PathFault::none);
    const PathLimits limits = wide_limits({10, 100, 1000});
    REQUIRE(path.append(ring, a, limits) == PathFault::none);
    REQUIRE(path.append(ring, b, limits, {0, 2}) == PathFault::none);
    REQUIRE(path.count == 3);
    path.advance(ring, 100);
    CHECK(path.finished());
    CHECK(path.now(ring).position == PathVector{10, 10});
}

TEST_CASE("path: a corner that cannot be braked for any more is a stop") {
    std::vector<PathPiece> ring(8);
    Path path;
    PathCurve a, b;
    REQUIRE(line_to({0, 0}, {10, 0}, a) == PathFault::none);
    REQUIRE(line_to({10, 0}, {10, 10}, b) == PathFault::none);
    const PathLimits limits = wide_limits({10, 100, 1000});
    REQUIRE(path.append(ring, a, limits) == PathFault::none);
    while (path.now(ring).position[0] < 9.5) path.advance(ring, 1e-3);
    REQUIRE(path.append(ring, b, limits, {0, 2}) == PathFault::none);
    while (!path.finished()) {
        const PathMotion m = path.advance(ring, 1e-3);
        CHECK((m.position[0] < 10 ? m.position[1] : 0) <= (path.count == 3 ? 2.0 : 0.0));
        CHECK(violation(m, limits).empty());
    }
    CHECK(path.now(ring).position == PathVector{10, 10});
}

TEST_CASE("path: a halt that does not fit into a short piece between corners goes on in the next") {
    int spanning = 0;
    for (int begin = 5; begin < 700; begin += 5) {
        std::vector<PathPiece> ring(16);
        Path path;
        PathLimits limits{{1e300, 1e300, 1e300}, {}};
        limits.axes[0] = {80, 800, 2e4};
        limits.axes[1] = {40, 600, 1e4};
        limits.axes[3] = {120, 900, 3e4};
        PathVector from{};
        for (const PathVector& to :
             {PathVector{0, 0, 0, 5}, {5, 5}, {10, 5}, {10, 15}, {11, 30}, {-4, 2}}) {
            PathCurve line;
            REQUIRE(line_to(from, to, line, path_space) == PathFault::none);
            REQUIRE(path.append(ring, line, limits, {0, 40}) == PathFault::none);
            limits.path = {60, 700, 9000};
            from = to;
        }
        REQUIRE(path.count == 11);
        double before = 0, took = 0;
        std::uint64_t first = 0;
        for (int scan = 0; !(path.halted && path.standing()); ++scan) {
            if (scan == begin) path.halt(), first = path.first;
            const PathMotion m = path.advance(ring, 1e-3);
            REQUIRE(m.path.velocity >= -1e-9);
            REQUIRE(m.path.position >= before);
            before = m.path.position;
            if (path.halted) took += 1e-3;
        }
        if (path.first > first + 1) ++spanning;
        CHECK(took < 1.5);
    }
    CHECK(spanning > 10);
}

TEST_CASE("path: no halt leads through a stop in motion") {
    for (int begin = 10; begin < 1200; begin += 10) {
        std::vector<PathPiece> ring(4);
        Path path;
        PathCurve a, b;
        REQUIRE(line_to({0, 0}, {50, 0}, a) == PathFault::none);
        REQUIRE(line_to({50, 0}, {50, 50}, b) == PathFault::none);
        const PathLimits limits = wide_limits({100, 500, 1e4});
        for (const PathCurve& curve : {a, b})
            REQUIRE(path.append(ring, curve, limits) == PathFault::none);
        double before = 0;
        for (int scan = 0; !path.finished() && scan < 5000; ++scan) {
            if (scan == begin) path.halt({1e300, 60, 1e4});
            if (scan == begin + 2000) path.resume();
            const PathMotion m = path.advance(ring, 1e-3);
            REQUIRE(!passes_stop(path, ring, limits));
            if (before < 50 && m.path.position > 50) CHECK(m.path.velocity <= 0.1);
            before = m.path.position;
        }
        CHECK(path.finished());
    }
}

TEST_CASE("path: a halt may be harder than the path, on lines as hard as it says") {
    for (const double harder : {1.0, 10.0}) {
        std::vector<PathPiece> ring(4);
        Path path;
        PathCurve line;
        REQUIRE(line_to({0, 0}, {300, 0}, line) == PathFault::none);
        PathLimits limits = wide_limits({100, 200, 4000});
        limits.axes[0] = {200, 1000, 1e5};
        REQUIRE(path.append(ring, line, limits) == PathFault::none);
        REQUIRE(path.advance(ring, 1.5).path.velocity == 100);
        path.halt({1e300, 200 * harder, 4000 * harder});
        double hardest = 0, took = 0;
        while (!path.standing()) {
            const PathMotion m = path.advance(ring, 1e-3);
            hardest = std::max(hardest, -m.path.acceleration);
            took += 1e-3;
        }
        CHECK(hardest == Approx(std::min(200 * harder, 1000.0)));
        CHECK(took == Approx(harder == 1 ? 0.55 : 0.125).margin(2e-3));
        path.resume();
        for (int scan = 0; scan < 6000 && !path.finished(); ++scan) {
            const PathMotion m = path.advance(ring, 1e-3);
            CHECK(std::abs(m.path.acceleration) <= 200 * (1 + 1e-9));
        }
        CHECK(path.now(ring).position[0] == 300);
    }
}

TEST_CASE("path: a harder halt is over sooner wherever it begins on a contour") {
    double sum = 0, sum_of_harder = 0;
    for (int begin = 50; begin < 1500; begin += 25)
        for (const bool is_harder : {false, true}) {
            std::vector<PathPiece> ring(16);
            Path path;
            PathLimits limits = wide_limits({80, 200, 4000});
            limits.axes[0] = limits.axes[1] = {100, 1500, 6e4};
            PathVector from{};
            for (const PathVector& to : {PathVector{30, 0}, {30, 40}, {0, 45}, {-20, 0}}) {
                PathCurve line;
                REQUIRE(line_to(from, to, line) == PathFault::none);
                REQUIRE(path.append(ring, line, limits, {1e300, 8}) == PathFault::none);
                from = to;
            }
            for (int scan = 0; scan < begin; ++scan) path.advance(ring, 1e-3);
            path.halt(is_harder ? PathLimit{1e300, 1500, 6e4} : no_path_limit);
            limits.path.acceleration = 1500, limits.path.jerk = 6e4;
            double took = 0;
            for (; !path.standing(); took += 1e-3) {
                const std::string what = violation(path.advance(ring, 1e-3), limits);
                INFO("halted after " << begin << " ms: " << what);
                REQUIRE(what.empty());
                REQUIRE(took < 2);
            }
            (is_harder ? sum_of_harder : sum) += took;
        }
    CHECK(sum_of_harder < 0.5 * sum);
}

TEST_CASE("path: a halt in a corner takes no longer than on a line where the axes allow that") {
    for (const PathLimit& halt : {PathLimit{1e300, 500, 10'000}, PathLimit{1e300, 100, 2000},
                                  PathLimit{1e300, 3000, 60'000}, no_path_limit})
        for (const double distance : {1.0, 10.0}) {
            std::vector<PathPiece> ring(8);
            Path path;
            PathLimits limits = wide_limits({50, 500, 10'000});
            PathCurve first, second;
            REQUIRE(line_to({}, {100, 90, 10}, first) == PathFault::none);
            REQUIRE(line_to(first.end, {150, 10, -20}, second) == PathFault::none);
            REQUIRE(path.append(ring, first, limits) == PathFault::none);
            REQUIRE(path.append(ring, second, limits, {1e300, distance, PathBlend::high}) ==
                    PathFault::none);
            while (path.first == 0) path.advance(ring, 1e-3);
            path.advance(ring, 2e-3);
            const double v = path.now(ring).path.velocity;
            path.halt(halt);
            limits.path.acceleration = std::min(halt.acceleration, 3000.0);
            limits.path.jerk = std::min(halt.jerk, 60'000.0);
            if (halt.acceleration > 1e200) limits = wide_limits({50, 500, 10'000});
            const double a = limits.path.acceleration, j = limits.path.jerk;
            double took = 0;
            for (; !path.standing(); took += 1e-4) path.advance(ring, 1e-4);
            const double by_hand = v * j > a * a ? v / a + a / j : 2 * std::sqrt(v / j);
            INFO(distance << ' ' << halt.acceleration << ' ' << v);
            CHECK(took < 1.05 * by_hand + 2e-3);  // which begins without an acceleration
        }
}
