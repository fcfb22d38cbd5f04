#include "blocks/path/path_speed.hpp"

#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/profile/seven_segment.hpp"

using namespace lineshaft;

namespace {

/// Between two velocities on a line, in equal intervals.
struct Line {
    PathLimits limits;
    std::vector<SpeedInterval> intervals;
    std::vector<double> energies;

    Line(double length, std::size_t count, const PathLimit& limit) {
        limits.path = limit;
        limits.axes.fill(no_path_limit);
        for (std::size_t k = 0; k < count; ++k) {
            SpeedInterval i;
            i.length = length / static_cast<double>(count);
            i.begin = i.length * static_cast<double>(k);
            i.limits = &limits;
            i.along = limit;
            i.left.tangent[0] = i.right.tangent[0] = 1;
            intervals.push_back(i);
            energies.push_back(0.5 * 30 * 30);
        }
    }
};

double time_over(const SpeedProblem& problem, const Line& line) {
    double time = 0;
    for (std::size_t k = 0; k < line.intervals.size(); ++k) {
        const double a = std::sqrt(2 * problem.at(k).energy);
        const double b = std::sqrt(2 * problem.at(k + 1).energy);
        time += 2 * line.intervals[k].length / (a + b);
    }
    return time;
}

}  // namespace

TEST_CASE("path_speed: on a line it comes to the seven-segment move, and cruises evenly") {
    const PathLimit limit{60, 500, 5000};
    SevenSegmentPlan least;
    REQUIRE(plan(SevenSegment{30, 30, 60, 500, 5000, 60}, least) == PlanResult::ok);
    Line line(60, 120, limit);
    SpeedProblem problem(line.intervals, {450, 0}, {450, 0}, line.energies);
    REQUIRE(problem.solve());
    CHECK(time_over(problem, line) == Approx(least.duration).epsilon(2e-3));
    CHECK(std::sqrt(2 * problem.at(60).energy) == Approx(60).epsilon(1e-14));
    for (std::size_t k = 0; k < line.intervals.size(); ++k) {
        const SpeedEnd &a = problem.at(k), &b = problem.at(k + 1);
        const double slope = (b.acceleration - a.acceleration) / line.intervals[k].length;
        CHECK(std::abs(a.acceleration) <= 500);
        CHECK(std::abs(slope) * std::sqrt(2 * a.energy) <= 5000 * (1 + 1e-4));
        CHECK(a.energy <= 1800);
    }
}

TEST_CASE("path_speed: it goes on from a solution where limits are made tighter") {
    Line line(60, 80, {1000, 500, 5000});
    SpeedProblem problem(line.intervals, {450, 0}, {450, 0}, line.energies);
    REQUIRE(problem.solve());
    const double before = problem.at(40).energy;
    for (SpeedInterval& i : line.intervals) i.tight = 0.9;
    REQUIRE(problem.solve());
    CHECK(problem.at(40).energy < before);
    SevenSegmentPlan least;
    REQUIRE(plan(SevenSegment{30, 30, 1000, 450, 4500, 60}, least) == PlanResult::ok);
    CHECK(time_over(problem, line) == Approx(least.duration).epsilon(6e-3));
}

TEST_CASE("path_speed: what has no solution is said to have none") {
    Line line(60, 80, {20, 500, 5000});
    SpeedProblem problem(line.intervals, {1800, 0}, {1800, 0}, line.energies);
    CHECK_FALSE(problem.solve());
}
