#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/path/path.hpp"
#include "blocks/profile/seven_segment.hpp"
#include "tests/blocks/path/least_duration.hpp"

using namespace lineshaft;

namespace {

class Choice {
  public:
    explicit Choice(std::uint64_t seed) : numbers(seed) {}
    double between(double least, double most) {
        return least + (most - least) * (static_cast<double>(numbers() >> 11) * 0x1p-53);
    }
    double decades(double least, double most) {
        return std::pow(10, between(std::log10(least), std::log10(most)));
    }
    double whole(double least, double most) { return std::floor(between(least, most + 1)); }
    PathVector direction() {
        for (;;) {
            PathVector x{};
            for (std::size_t i = 0; i < path_space; ++i) x[i] = between(-1, 1);
            const double size = std::hypot(x[0], x[1], x[2]);
            if (size < 0.1 || size > 1) continue;
            for (double& part : x) part /= size;
            return x;
        }
    }

  private:
    std::mt19937_64 numbers;
};

struct Planned {
    std::vector<PathPiece> ring = std::vector<PathPiece>(32);
    Path path;
};

/// It is 6 to 40 mm long, by a radius of 4 to 25 mm.
PathCurve random_arc(Choice& choice, const PathVector& from) {
    for (;;) {
        const double radius = choice.between(4, 25);
        const double angle = choice.whole(6, std::min(40.0, 6 * radius)) / radius;
        const PathVector u = choice.direction(), other = choice.direction();
        PathVector w{}, middle = from, end = from;
        double along = 0, square = 0;
        for (std::size_t i = 0; i < path_space; ++i) along += u[i] * other[i];
        for (std::size_t i = 0; i < path_space; ++i) {
            w[i] = other[i] - along * u[i];
            square += w[i] * w[i];
        }
        const auto go = [&](PathVector& x, double phi) {
            for (std::size_t i = 0; i < path_space; ++i)
                x[i] += radius *
                        (u[i] * (std::cos(phi) - 1) + w[i] * (std::sin(phi) / std::sqrt(square)));
        };
        go(middle, 0.5 * angle);
        go(end, angle);
        PathCurve arc;
        if (arc_through(from, middle, end, arc) == PathFault::none) return arc;
    }
}

/// Two to four lines and arcs in space, whole millimetres long, lines joined by corners; jerks of
/// 2e4 to 2e5 mm/s^3.
Planned random_pieces(std::uint64_t seed) {
    Choice choice(seed);
    PathLimits limits{
        {choice.between(80, 300), choice.between(1000, 3000), choice.decades(2e4, 2e5)}, {}};
    for (PathLimit& axis : limits.axes)
        axis = {choice.between(100, 400), choice.between(1000, 3000), choice.decades(2e4, 2e5)};
    Planned out;
    PathVector from{};
    double before = 0;
    for (double left = choice.whole(2, 4); left > 0; --left) {
        PathCurve curve;
        const bool is_arc = choice.between(0, 1) < 0.35;
        if (is_arc) {
            curve = random_arc(choice, from);
        } else {
            const PathVector direction = choice.direction();
            PathVector to = from;
            const double length = choice.whole(8, 40);
            for (std::size_t i = 0; i < path_space; ++i) to[i] += length * direction[i];
            REQUIRE(line_to(from, to, curve) == PathFault::none);
        }
        PathJoint joint;
        if (!is_arc && before > 0)
            joint.distance =
                choice.whole(1, std::clamp(std::min(0.98 * before, 0.5 * curve.length), 1.0, 10.0));
        REQUIRE(out.path.append(out.ring, curve, limits, joint) == PathFault::none);
        before = is_arc ? 0 : out.ring[(out.path.count - 1) % out.ring.size()].curve.length;
        from = curve.end;
    }
    return out;
}

double duration_of(Planned& planned) {
    double time = 0;
    planned.path.advance(planned.ring, 0);
    while (!planned.path.finished()) {
        const double left = planned.path.leg.duration() - planned.path.time;
        time += left;
        planned.path.advance(planned.ring, left);
    }
    return time;
}

long number_from(const char* variable, long otherwise) {
    const char* const text = std::getenv(variable);
    return text == nullptr ? otherwise : std::atol(text);
}

/// What a path takes, the bound without jerk, and lattices of a step of 1 mm, half of it, ...
struct Durations {
    double planned = 0, bound = 0;
    std::vector<double> lattices;

    /// What the last two lattices lead to, if halving the step once more halves what is left.
    double led_to() const {
        const std::size_t n = lattices.size();
        return n > 1 ? 2 * lattices[n - 1] - lattices[n - 2] : lattices[0];
    }
};

Durations durations_of(std::uint64_t seed, int levels) {
    Planned planned = random_pieces(seed);
    Durations out;
    out.lattices.assign(static_cast<std::size_t>(levels), 0);
    for (const WholeWay& way :
         ways_between_stops(planned.ring, planned.path.count, planned.path.stretches)) {
        out.bound += least_without_jerk(way, 400);
        double step = 1, acceleration = way.pieces[0]->limits.path.acceleration / 20;
        for (double& lattice : out.lattices) {
            lattice += least_of_lattice(way, step, acceleration);
            step *= 0.5;
            acceleration *= 0.5;
        }
    }
    out.planned = duration_of(planned);
    return out;
}

}  // namespace

TEST_CASE("least_duration: both references come to what is known of a line") {
    Planned planned;
    PathCurve line;
    const PathLimit limit{100, 2000, 5e4};
    PathLimits limits{limit, {}};
    limits.axes.fill({1e9, 1e9, 1e12});
    REQUIRE(line_to({0, 0}, {40, 0}, line) == PathFault::none);
    REQUIRE(planned.path.append(planned.ring, line, limits) == PathFault::none);
    const WholeWay way = ways_between_stops(planned.ring, 1, 1)[0];
    CHECK(least_without_jerk(way, 1000) == Approx(40.0 / 100 + 100.0 / 2000).epsilon(1e-5));
    SevenSegmentPlan least;
    REQUIRE(plan(SevenSegment{0, 0, 100, 2000, 5e4, 40}, least) == PlanResult::ok);
    const double coarse = least_of_lattice(way, 1, 100), fine = least_of_lattice(way, 0.5, 50);
    CHECK(coarse >= least.duration);
    CHECK(fine >= least.duration * (1 - 1e-4));
    CHECK(fine < coarse);
    CHECK(fine <= 1.01 * least.duration);
}

TEST_CASE("path: durations are those of a dynamic programme with jerk") {
    const long first = number_from("LINESHAFT_SEED", 0);
    const long count = number_from("LINESHAFT_PATHS", 6);
    const int levels = static_cast<int>(number_from("LINESHAFT_LEVELS", 1));
    const bool shows = std::getenv("LINESHAFT_FIGURES") != nullptr;
    std::array<double, 3> sums{};
    double most = -1;
    for (long seed = first; seed < first + count; ++seed) {
        const Durations d = durations_of(static_cast<std::uint64_t>(seed), levels);
        const double longer = d.planned / d.led_to() - 1;
        INFO("seed " << seed);
        CHECK(d.bound <= d.planned);
        CHECK(d.bound <= d.lattices.back());
        CHECK(longer <= 0.06);
        sums[0] += d.planned / d.bound - 1;
        sums[1] += d.planned / d.lattices.back() - 1;
        sums[2] += longer;
        most = std::max(most, longer);
        if (!shows) continue;
        std::printf("%ld: planned %.4f s, without jerk %.4f s", seed, d.planned, d.bound);
        for (const double lattice : d.lattices) std::printf(", lattice %.4f s", lattice);
        std::printf("; longer by %.2f %%\n", 100 * longer);
        std::fflush(stdout);
    }
    const double per = 100 / static_cast<double>(count);
    CHECK(sums[2] * per <= 3);
    if (shows)
        std::printf(
            "%ld paths: longer than without jerk by %.2f %%, than the last lattice by "
            "%.2f %%, than what lattices lead to by %.2f %% (most %.2f %%)\n",
            count, sums[0] * per, sums[1] * per, sums[2] * per, 100 * most);
}
