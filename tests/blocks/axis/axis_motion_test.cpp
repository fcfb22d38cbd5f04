#include "blocks/axis/axis_motion.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "runtime/model/random.hpp"

using namespace lineshaft;

TEST_CASE("a stop never turns round, whatever the state, and keeps its jerk where that suffices") {
    Random random(1, "stops");
    const auto decades = [&](double least, double ratio) {
        return least * std::pow(ratio, random.share());
    };
    int raised = 0;
    for (int i = 0; i < 4000; ++i) {
        const double sign = random.below(2) == 0 ? -1 : 1;
        const MotionState from{0, sign * decades(1e-6, 1e9), 1000 * (random.share() - 0.5), 0};
        const Dynamics asked{100, decades(10, 300), decades(10, 300), decades(1, 1e6)};
        const double trapezoid = effective_jerk(0, asked.acceleration, asked.deceleration);
        const Dynamics d = without_turning(asked, from, trapezoid);
        VelocityMotion stop;
        REQUIRE(stop.begin(from, 0, d, {}) == PlanResult::ok);
        CHECK(stop.end_state().velocity == 0);
        CHECK(stop.end_state().acceleration == 0);
        const double slack =
            1e-9 * std::abs(from.velocity) + from.acceleration * from.acceleration / trapezoid;
        for (int n = 0; n <= 100; ++n) {
            INFO("from " << from.velocity << ", " << from.acceleration << " with " << asked.jerk);
            REQUIRE(stop.later(0.01 * n * stop.ramp.duration).velocity * sign >= -slack);
        }
        if (d.jerk == asked.jerk) continue;
        ++raised;
        const Dynamics less{100, asked.acceleration, asked.deceleration, 0.9 * d.jerk};
        VelocityMotion weaker;
        REQUIRE(weaker.begin(from, 0, less, {}) == PlanResult::ok);
        CHECK(weaker.later(std::abs(from.acceleration) / less.jerk).velocity * sign < 0);
    }
    CHECK(raised > 500);
}
