#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/path/path.hpp"
#include "tests/blocks/path/path_motions.hpp"
#include "tests/blocks/path/path_random.hpp"
#include "tests/blocks/path/random_path.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

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
    double length = 0, before = 0, base = -1, lasts = 0;
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
        const bool is_new = path.leg.base != base || path.leg.duration() != lasts;
        base = path.leg.base, lasts = path.leg.duration();
        if (is_new && passes_stop(path, ring, limits))
            return "a stop is passed in scan " + std::to_string(scan);
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

TEST_CASE("path: a greater exit that lowers an entry leaves no ramp that ends faster") {
    CHECK(fault_of(200884, 500).empty());
}

TEST_CASE("path: a velocity that the direct ramp reaches is planned with each limit") {
    CHECK(fault_of(600005775, 500).empty());
}

TEST_CASE("path: lines of any length end, or are known to be beyond planning") {
    Random random(11);
    std::array<int, 2> planned{};
    for (int n = 0; n < 2000; ++n) {
        const double length = random.decades(-320, 300), spread = n % 2 == 0 ? 0 : 100;
        PathLimits limits =
            wide_limits({random.decades(-spread, spread), random.decades(-spread, spread),
                         random.decades(-spread, spread)});
        limits.axes.fill(no_path_limit);
        PathCurve curve;
        std::array<PathPiece, 4> ring;
        Path path;
        if (line_to({}, {length}, curve) != PathFault::none ||
            path.append(ring, curve, limits) != PathFault::none)
            continue;
        path.advance(ring, 0);
        for (int step = 0; step < 8 && !path.finished() && !path.lost; ++step)
            path.advance(ring, path.leg.duration() - path.time);
        INFO(length << ' ' << limits.path.velocity);
        CHECK((path.finished() || path.lost));
        ++planned[path.lost ? 0 : 1];
        if (path.finished()) CHECK(path.now(ring).position[0] == length);
        if (length > 1e-60 && length < 1e60 && spread == 0) CHECK_FALSE(path.lost);
    }
    CHECK(planned[0] > 100);
    CHECK(planned[1] > 100);
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
