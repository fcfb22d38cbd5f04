#include "blocks/path/path.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/path/path_cubic.hpp"
#include "blocks/profile/seven_segment.hpp"

using namespace lineshaft;

namespace {

PathLimits wide_limits(const PathLimit& path) {
    PathLimits limits{path, {}};
    limits.axes.fill({1e9, 1e9, 1e9});
    return limits;
}

class Random {
  public:
    explicit Random(std::uint64_t seed) : numbers(seed) {}
    double share() { return static_cast<double>(numbers() >> 11) * 0x1p-53; }
    double between(double least, double most) { return least + (most - least) * share(); }
    double decades(double least, double most) { return std::pow(10, between(least, most)); }

  private:
    std::mt19937_64 numbers;
};

PathVector random_point(Random& random, std::size_t axes, double size) {
    PathVector x{};
    for (std::size_t i = 0; i < axes; ++i) x[i] = random.between(-size, size);
    return x;
}

struct RandomPath {
    std::vector<PathCurve> curves;
    std::vector<PathLimits> limits;
    std::vector<PathJoint> joints;
};

PathJoint random_joint(Random& random, double size) {
    if (random.share() < 0.2) return {random.share() < 0.5 ? 0 : random.decades(-2, 2), 0};
    return {0, size * random.decades(-4, 0)};
}

/// With the tangent of the last one, or that of a line to the point; the part of a spline that a
/// longer one would have.
void append_spline(RandomPath& out, Random& random, const PathVector& from, const PathVector& to,
                   const PathLimits& limits) {
    const PathVector beyond = random_point(random, 3, std::abs(to[0]) + 1);
    PathPoint begin = waypoint(from, from, to);
    if (!out.curves.empty() && random.share() < 0.7)
        begin = out.curves.back().at(out.curves.back().length);
    std::array<PathCurve, most_spline_parts> parts;
    const std::size_t count = spline_between(begin, waypoint(from, to, beyond), parts);
    for (std::size_t i = 0; i < count; ++i) {
        out.curves.push_back(parts[i]);
        out.limits.push_back(limits);
    }
}

/// Through two to six random points.
void append_cubic(RandomPath& out, Random& random, const PathVector& from, std::size_t axes,
                  double size, const PathLimits& limits) {
    std::vector<PathVector> points{from};
    for (auto more = 1 + static_cast<int>(random.between(0, 4.999)); more > 0; --more)
        points.push_back(random_point(random, axes, size));
    std::array<PathCurve, most_spline_parts> parts;
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const std::size_t count = cubic_between(knot_of(points, k), knot_of(points, k + 1), parts);
        if (count == 0) return;
        out.curves.insert(out.curves.end(), parts.begin(),
                          parts.begin() + static_cast<std::ptrdiff_t>(count));
        out.limits.resize(out.curves.size(), limits);
    }
}

/// Lines, arcs and splines, some lines cut in two, so that there are smooth joints.
RandomPath random_path(Random& random, std::size_t most) {
    RandomPath out;
    const auto axes = static_cast<std::size_t>(random.between(2, 6.999));
    const double size = random.decades(-2, 3);
    PathLimits limits{{random.decades(-1, 3), random.decades(-1, 4), random.decades(0, 6)}, {}};
    for (PathLimit& axis : limits.axes) {
        axis = {random.decades(-1, 3), random.decades(-1, 4), random.decades(0, 6)};
    }
    const double mean = random.share() < 0.05 ? 200 : 15;
    const auto wanted = std::min<double>(500, 1 - mean * std::log(1 - random.share()));
    PathVector from = random_point(random, axes, size);
    while (static_cast<double>(out.curves.size()) < wanted && out.curves.size() < most) {
        const PathVector to = random_point(random, axes, size);
        PathCurve curve;
        const double kind = random.share();
        if (kind < 0.2) {
            if (kind < 0.1)
                append_spline(out, random, from, random_point(random, axes, size), limits);
            else
                append_cubic(out, random, from, axes, size, limits);
            if (!out.curves.empty()) from = out.curves.back().end;
            while (out.joints.size() < out.curves.size()) out.joints.push_back({});
            continue;
        }
        const bool line = random.share() < 0.5;
        if ((line ? line_to(from, to, curve)
                  : arc_through(from, random_point(random, axes, size), to, curve)) !=
            PathFault::none) {
            continue;
        }
        PathCurve half;
        if (line && random.share() < 0.5 &&
            line_to(from, curve.at(curve.length * random.share()).position, half) ==
                PathFault::none &&
            line_to(half.end, to, curve) == PathFault::none) {
            out.curves.push_back(half);
            out.limits.push_back(limits);
        }
        out.curves.push_back(curve);
        out.limits.push_back(limits);
        while (out.joints.size() < out.curves.size())
            out.joints.push_back(random.share() < 0.5 ? PathJoint{} : random_joint(random, size));
        from = to;
    }
    return out;
}

bool above(double value, double limit) {
    return !(std::abs(value) <= limit * (1 + 1e-9));
}

std::string violation(const PathMotion& m, const PathLimits& limits) {
    if (m.path.velocity < -1e-9 * limits.path.velocity) return "backwards";
    if (above(m.path.velocity, limits.path.velocity)) return "path velocity";
    if (above(m.path.acceleration, limits.path.acceleration)) return "path acceleration";
    if (above(m.path.jerk, limits.path.jerk)) return "path jerk";
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const std::string axis = " of axis " + std::to_string(i);
        if (above(m.velocity[i], limits.axes[i].velocity)) return "velocity" + axis;
        if (above(m.acceleration[i], limits.axes[i].acceleration)) return "acceleration" + axis;
        if (above(m.jerk[i], limits.axes[i].jerk)) return "jerk" + axis;
    }
    return "";
}

/// Halts are as hard as the pieces allow, or as these say.
void command(Path& path, Random& random, const PathLimit& braking) {
    const double what = random.share();
    if (what < 0.3) {
        path.set_override(random.share() < 0.2 ? 0 : random.share());
    } else if (what < 0.6) {
        path.halt(braking);
    } else {
        path.resume();
        path.set_override(random.share() < 0.5 ? 1 : random.between(0.1, 1.5));
    }
}

/// What is wrong with the path of a seed, cut to `most` pieces; empty if nothing. Halts come to
/// `harder` times the acceleration of the path, and more of the jerk.
std::string fault_of(std::uint64_t seed, std::size_t most, double harder = 1) {
    Random random(seed);
    const RandomPath wanted = random_path(random, most);
    PathLimits limits = wanted.limits[0];
    limits.path.acceleration *= harder;
    limits.path.jerk *= harder * harder;
    const PathLimit braking = harder == 1 ? no_path_limit : limits.path;
    std::vector<PathPiece> ring(wanted.curves.size() < 8 ? 8 : wanted.curves.size() / 2 + 2);
    Path path;
    std::size_t given = 0;
    double length = 0, before = 0;
    for (const PathCurve& curve : wanted.curves) length += curve.length;
    const double dt = random.decades(-3, -1) * length / wanted.limits[0].path.velocity;
    const double commands = random.share() < 0.3 ? 0 : random.decades(-3, -1);
    for (long scan = 0; scan < 60'000; ++scan) {
        while (given < wanted.curves.size()) {
            const PathFault fault =
                path.append(ring, wanted.curves[given], wanted.limits[given], wanted.joints[given]);
            if (fault == PathFault::full) break;
            if (fault != PathFault::none) return "append";
            ++given;
        }
        if (random.share() < commands && scan < 2000) command(path, random, braking);
        if (scan == 2000 && commands > 0) path.resume(), path.set_override(1);
        // An axis may be decades slower than the path: longer and longer scans come to its end.
        const double slow = std::pow(1.001, std::max(0L, scan - 20'000));
        const double step = dt * random.share() * slow;
        const PathMotion m = path.advance(ring, step);
        const std::string what = violation(m, limits);
        if (!what.empty()) return what + " in scan " + std::to_string(scan);
        if (path.lost) return "lost";
        if (m.path.position < before - 1e-9 * length) return "position falls";
        before = m.path.position;
        if (path.finished() && given == wanted.curves.size()) {
            return m.position == wanted.curves.back().end && path.remaining() == 0 ? "" : "end";
        }
    }
    return "does not end";
}

long number_of(const char* variable, long otherwise) {
    const char* const text = std::getenv(variable);
    return text == nullptr ? otherwise : std::atol(text);
}

}  // namespace

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

TEST_CASE("path: a copy of its bytes goes on alike") {
    Random random(7);
    const RandomPath wanted = random_path(random, 20);
    std::vector<PathPiece> ring(wanted.curves.size());
    Path path;
    for (std::size_t i = 0; i < wanted.curves.size(); ++i) {
        REQUIRE(path.append(ring, wanted.curves[i], wanted.limits[i]) == PathFault::none);
    }
    path.advance(ring, 0.1);
    path.halt();
    Path copy = path;
    std::vector<PathPiece> other = ring;
    for (int scan = 0; scan < 100; ++scan) {
        const PathMotion m = path.advance(ring, 0.01), n = copy.advance(other, 0.01);
        CHECK(std::memcmp(&m, &n, sizeof m) == 0);
    }
}

TEST_CASE("path: a halt that ends at a joint but for rounding goes on from there") {
    CHECK(fault_of(1144, 500).empty());
}

TEST_CASE("path: braking that was planned for holds when longer braking is found behind it") {
    CHECK(fault_of(55989, 500).empty());
}

TEST_CASE("path: a course whose last stretch has grown goes on from its end") {
    for (const std::uint64_t seed : {5003789, 6000318, 6001551, 6002405})
        CHECK(fault_of(seed, 500).empty());
}

TEST_CASE("path: random paths keep all limits and end exactly") {
    const long first = number_of("LINESHAFT_SEED", 0);
    const long count = number_of("LINESHAFT_PATHS", 120);
    for (long seed = first; seed < first + count; ++seed) {
        const auto number = static_cast<std::uint64_t>(seed);
        if (fault_of(number, 500).empty()) continue;
        std::size_t most = 1;
        while (fault_of(number, most).empty()) ++most;
        FAIL("seed " << seed << ", cut to " << most << " pieces: " << fault_of(number, most));
    }
}

TEST_CASE(
    "path: random paths keep the limits of their axes in halts that are harder than they are") {
    const long first = number_of("LINESHAFT_SEED", 0);
    const long count = number_of("LINESHAFT_PATHS", 60);
    for (long seed = first; seed < first + count; ++seed) {
        const std::string fault = fault_of(static_cast<std::uint64_t>(seed), 500, 10);
        INFO("seed " << seed);
        CHECK(fault.empty());
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
