#include "blocks/path/path_phase.hpp"

#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "blocks/path/path_course.hpp"

using namespace lineshaft;

TEST_CASE("path_phase: with a slope the acceleration changes evenly with the way") {
    std::mt19937_64 numbers(48);
    const auto between = [&](double least, double most) {
        return least + (most - least) * (static_cast<double>(numbers() >> 11) * 0x1p-53);
    };
    for (int problem = 0; problem < 2000; ++problem) {
        INFO("problem " << problem);
        const double v = std::pow(10, between(-2, 3)), time = std::pow(10, between(-3, 1));
        const double slope = between(-1, 1) / (time * time), a = between(-0.4, 0.4) * v / time;
        const PathPhase phase{0, {between(-5, 5), v, a, 0}, slope};
        const MotionState s = phase.after(time);
        const double way = s.position - phase.start.position;
        CHECK(s.acceleration == Approx(a + slope * way).margin(1e-12 * v / time));
        CHECK(s.jerk == Approx(slope * s.velocity).margin(1e-12));
        CHECK(s.velocity * s.velocity ==
              Approx(v * v + way * (2 * a + slope * way)).margin(1e-11 * v * v));
        const double h = 1e-5 * time;
        const MotionState before = phase.after(time - h), behind = phase.after(time + h);
        CHECK((behind.position - before.position) / (2 * h) ==
              Approx(s.velocity).margin(1e-6 * v + 1e-11 / h));
        if (!(s.velocity > 0.01 * v)) continue;
        CHECK(duration_over(phase, way, s.velocity) == Approx(time).epsilon(1e-9));
        CHECK(time_at_way(phase, 2 * time, way) == Approx(time).epsilon(1e-9));
    }
}

TEST_CASE("path_course: it is continuous from phase to phase, and stays at its end") {
    PathCourse course;
    REQUIRE(course.add({0, {0, 0, 0, 8}, 0}, 0.5));
    REQUIRE(course.add({0, course.end, -2}, 0.25));
    course.end = {1, 0.5, 0, 0};
    CHECK(course.duration == 0.75);
    CHECK(course.at(-1).velocity == 0);
    CHECK(course.at(0.5 - 1e-9).velocity == Approx(course.at(0.5).velocity).epsilon(1e-7));
    CHECK(course.at(9).position == 1);
    for (std::size_t n = course.count; n < PathCourse::most_phases; ++n)
        REQUIRE(course.add({0, {}, 0}, 1));
    CHECK_FALSE(course.add({0, {}, 0}, 1));
}
