#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/motion/synchronous.hpp"
#include "tests/blocks/motion/bench.hpp"
#include "tests/blocks/profile/oracle.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

struct Limits {
    double acceleration, jerk;
};

/// A master that is told to move otherwise now and then, and a slave that is geared to it by ratios
/// that change: a master may reverse, and begin anew in mid-ramp.
std::string couplings(oracle::Random& random, Limits& slave) {
    slave = {random.decades(2.5, 4), random.decades(4, 6)};
    const double acceleration = random.decades(1, 3), jerk = acceleration * random.decades(0.5, 3);
    std::string text = fmt::format(
        "tasks: {{main: {{every: 1 ms}}}}\nblocks:\n"
        "  m: {{type: axis, task: main, default_acceleration: {0} mm/s^2, default_deceleration: "
        "{0} mm/s^2, default_jerk: {1} mm/s^3}}\n"
        "  s: {{type: axis, task: main, default_velocity: 5 m/s, default_acceleration: {2} "
        "mm/s^2, default_deceleration: {2} mm/s^2, default_jerk: {3} mm/s^3}}\n",
        acceleration, random.one_in(3) ? 0 : jerk, slave.acceleration, slave.jerk);
    for (int i = 0; i < 4; ++i)
        text += fmt::format(
            "  run{}: {{type: MC_MoveVelocity, task: main, Axis: m, Velocity: {} "
            "mm/s}}\n",
            i, random.one_in(4) ? 0 : random.between(-400, 400));
    for (int i = 0; i < 4; ++i)
        text += fmt::format(
            "  gear{}: {{type: MC_GearIn, task: main, Master: m, Slave: s, RatioNumerator: {}, "
            "CatchUp: {}}}\n",
            i, random.sign() * random.between(0.1, 2), random.one_in(3));
    return text +
           "  stop: {type: MC_Stop, task: main, Axis: s}\n"
           "  halt: {type: MC_Halt, task: main, Axis: s}\n";
}

/// Between two scans the slave's acceleration is linear in each phase of its transition. In gear it
/// has the master's, whatever its limits are: a transition may begin beyond them, and comes back.
bool keeps_limits(const Axis& slave, const Limits& limits, double from, double until) {
    constexpr double more = 1 + 1e-9;
    const Transition& t = slave.sync.transition;
    const double begun = t.plan.phases[0].start.acceleration + t.guide.acceleration;
    const double most = std::max(limits.acceleration, std::abs(begun)) * more;
    for (std::size_t i = 0; i < t.plan.count; ++i) {
        const auto& phase = t.plan.phases[i];
        const double low = std::max(from, phase.begin);
        const double high = std::min(until, phase.begin + phase.duration);
        if (!(low < high)) continue;
        const double jerk = phase.start.jerk + t.guide.jerk;
        for (const double at : {low, high}) {
            const double a = phase.start.acceleration + phase.start.jerk * (at - phase.begin) +
                             t.guide.after(at).acceleration;
            if (std::abs(a) > most) return false;
        }
        if (std::abs(jerk) > limits.jerk * more) return false;
    }
    return true;
}

void run(std::uint64_t seed) {
    oracle::Random random{seed};
    Limits limits{};
    MotionBench bench(couplings(random, limits));
    const auto require = [&](bool holds, const std::string& what) {
        if (!holds)
            oracle::print_failure(what, fmt::format("seed {}, at {} ms", seed, bench.now()));
        REQUIRE(holds);
    };
    int run = 0, gear = 0;
    double last = 0, velocity = 0;
    for (int i = 0; i < 3000; ++i) {
        if (i < 1500 && random.one_in(200) && run < 4)
            bench.set(fmt::format("run{}.Execute", run++), true);
        if (i < 1500 && random.one_in(200) && gear < 4)
            bench.set(fmt::format("gear{}.Execute", gear++), true);
        bench.step();
        const Axis& slave = bench.axis("s");
        const MotionState now = slave.total();
        require(slave.state != AxisState::error_stop, "the axis has an error");
        const double mean = 0.5 * (velocity + now.velocity) * 1e-3;
        const double slack = 1e-6 * 0.25 * 2 * limits.acceleration + 1e-9;
        const bool rigid = slave.sync.stage == SyncMotion::Stage::in_sync;
        require(rigid || std::abs(now.position - last - mean) <= slack, "the position jumps");
        last = now.position;
        velocity = now.velocity;
        if (slave.doing != Axis::Doing::following_axes || rigid) continue;
        const double t = slave.sync.start.until(bench.now() * 1'000'000);
        require(keeps_limits(slave, limits, t, t + 1e-3), "a limit is not kept");
    }
    if (gear == 0) return;
    const std::string in_gear = fmt::format("gear{}.InGear", gear - 1);
    for (int i = 0; i < 100'000 && !bench.is(in_gear); ++i) bench.step();
    require(bench.is(in_gear), "not in gear in the end");
}

}  // namespace

TEST_CASE("random masters and ratios: limits at any instant, no jump, in gear in the end") {
    const auto count = static_cast<std::uint64_t>(count_of("LINESHAFT_COUPLINGS", 40));
    for (std::uint64_t seed = 1; seed <= count; ++seed) run(seed);
}

TEST_CASE(
    "a stop out of gear at any moment stands within v / a + a / j, and the slave gears in again") {
    const auto count = static_cast<std::uint64_t>(count_of("LINESHAFT_COUPLINGS", 40));
    for (std::uint64_t seed = 1; seed <= count; ++seed) {
        oracle::Random random{seed};
        Limits limits{};
        MotionBench bench(couplings(random, limits));
        bench.set("run0.Execute", true);
        bench.set("gear0.Execute", true);
        bench.step(2 + static_cast<std::int64_t>(random.between(0, 800)));
        bench.set("stop.Execute", true);
        bench.step();  // sent; it is taken up in the next scan
        const MotionState before = bench.axis("s").total().after(1e-3);
        int scans = 0;
        for (; scans < 20000 && !bench.is("stop.Done"); ++scans) bench.step();
        const double a = limits.acceleration, ease = std::abs(before.acceleration) / limits.jerk;
        const double speed = std::abs(before.velocity + 0.5 * before.acceleration * ease);
        const double allowed = ease + speed / a + a / limits.jerk;
        INFO("seed " << seed << ": " << scans << " scans, allowed " << allowed * 1e3 << " ms");
        CHECK(scans <= allowed * 1e3 + 4);
        CHECK(bench.number("s.velocity") == 0);
        bench.set("stop.Execute", false);
        bench.step(2);
        bench.set("gear1.Execute", true);
        for (int i = 0; i < 100'000 && !bench.is("gear1.InGear"); ++i) bench.step();
        CHECK(bench.is("gear1.InGear"));
    }
}
