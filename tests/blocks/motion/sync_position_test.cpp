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

/// A knife over a web, and a slave that moves before it is to get in gear.
constexpr const char* positions = R"(
tasks: {{main: {{every: 1 ms}}}}
blocks:
  m: {{type: axis, task: main, default_jerk: 0 mm/s^3}}
  s: {{type: axis, task: main, default_velocity: 10 m/s, default_acceleration: 1e6 mm/s^2, default_deceleration: 1e6 mm/s^2, default_jerk: 1e9 mm/s^3}}
  knife: {{type: cam_table, task: main, periodic: true, points: [[0 mm, 0 mm], [100 mm, 60 mm], [250 mm, 20 mm], [400 mm, 0 mm]]}}
  run: {{type: MC_MoveVelocity, task: main, Axis: m, Velocity: {} mm/s}}
  slow: {{type: MC_MoveVelocity, task: main, Axis: m, Velocity: {} mm/s, Acceleration: 400 mm/s^2}}
  move: {{type: MC_MoveVelocity, task: main, Axis: s, Velocity: {} mm/s}}
  gear: {{type: MC_GearInPos, task: main, Master: m, Slave: s, RatioNumerator: {}, MasterSyncPosition: {} mm, SlaveSyncPosition: {} mm, MasterStartDistance: {} mm}}
  select: {{type: MC_CamTableSelect, task: main, Master: m, Slave: s, CamTable: knife, Periodic: true}}
  cam: {{type: MC_CamIn, task: main, Master: m, Slave: s, CamTableID: select.CamTableID, MasterSyncPosition: {} mm, SlaveScaling: {}, MasterStartDistance: {} mm}}
)";

struct Found {
    bool in_sync = false;
    double most_position = 0, most_velocity = 0;
};

/// Steps until the slave is in sync, and some more, and compares it with what it is to be.
template <class Wanted>
Found follow(MotionBench& bench, std::string_view in_sync, const Wanted& wanted) {
    Found found;
    double last = bench.number("s.position"), velocity = bench.number("s.velocity");
    for (int i = 0; i < 6000; ++i) {
        if (i == 700) bench.set("slow.Execute", true);
        bench.step();
        const double jump = bench.number("s.position") - last;
        const double mean = 0.5 * (velocity + bench.number("s.velocity")) * 1e-3;
        CHECK(std::abs(jump - mean) <= 0.01 + 0.02 * std::abs(mean));
        last = bench.number("s.position");
        velocity = bench.number("s.velocity");
        if (!bench.is(in_sync)) continue;
        found.in_sync = true;
        const MotionState is = bench.axis("s").total(), due = wanted(bench.axis("m").total());
        found.most_position = std::max(found.most_position, std::abs(is.position - due.position));
        found.most_velocity = std::max(found.most_velocity, std::abs(is.velocity - due.velocity));
    }
    return found;
}

}  // namespace

TEST_CASE("MC_GearInPos meets its positions, wherever the slave comes from") {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        oracle::Random random{seed};
        const double speed = random.between(200, 600), ratio = random.between(0.5, 2);
        const double at = random.between(600, 900), slave = random.between(200, 500);
        const double before = random.between(-100, 100), start = random.between(300, 500);
        MotionBench bench(fmt::format(positions, speed, random.between(150, 700), before, ratio, at,
                                      slave, start, 0, 1, 0));
        INFO("seed " << seed);
        for (const char* command : {"run.Execute", "move.Execute"}) bench.set(command, true);
        bench.step(50);
        bench.set("gear.Execute", true);
        const Found found = follow(bench, "gear.InSync", [&](const MotionState& m) {
            return MotionState{slave + ratio * (m.position - at), ratio * m.velocity};
        });
        CHECK(found.in_sync);
        CHECK(found.most_position <= 1e-9);
        CHECK(found.most_velocity <= 1e-9);
    }
}

TEST_CASE("MC_CamIn meets the cam, and keeps it over its end") {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        oracle::Random random{seed};
        const double speed = random.between(200, 600), scale = random.between(0.5, 2);
        const double at = random.between(0, 400), start = random.between(200, 300);
        MotionBench bench(fmt::format(positions, speed, random.between(150, 700), 20, 1, 0, 0, 0,
                                      at, scale, start));
        INFO("seed " << seed);
        for (const char* command : {"run.Execute", "move.Execute", "select.Execute"})
            bench.set(command, true);
        bench.step(50);
        bench.set("cam.Execute", true);
        std::vector<CamPoint> points{{0, 0}, {100, 60}, {250, 20}, {400, 0}};
        REQUIRE(complete_cam(points, true).fault == CamFault::none);
        const Cam cam{points, true};
        const Found found = follow(bench, "cam.InSync", [&](const MotionState& m) {
            MotionState due = cam.at(m.position).led_by(m);
            due.position *= scale;
            due.velocity *= scale;
            return due;
        });
        CHECK(found.in_sync);
        CHECK(found.most_position <= 1e-9);
        CHECK(found.most_velocity <= 1e-9);
    }
}

TEST_CASE("a sync position that cannot be met within the limits is refused") {
    MotionBench bench(fmt::format(positions, 500, 500, 0, 1, 100, 900, 0, 0, 1, 0));
    bench.set("run.Execute", true);
    bench.step(600);
    bench.set("gear.Execute", true);
    bench.step(3);
    CHECK(bench.is("gear.Error"));
    CHECK(std::get<std::int64_t>(bench.get("gear.ErrorID")) ==
          static_cast<std::int64_t>(MotionError::sync_passed));
    CHECK(bench.axis("s").state == AxisState::standstill);
    MotionBench fast(fmt::format(positions, 500, 500, 0, 1, 250, 9000, 0, 0, 1, 0));
    fast.set("run.Execute", true);
    fast.step(600);
    fast.set("gear.Execute", true);
    fast.step(3);
    CHECK(fast.is("gear.Error"));
}

/// LINESHAFT_MEETINGS makes it longer: tools/long.
TEST_CASE("a slave that meets a master whose velocity changes keeps its limits, or is in error") {
    const auto rounds = static_cast<std::uint64_t>(count_of("LINESHAFT_MEETINGS", 75));
    std::uint64_t in_sync = 0, refused = 0;
    for (std::uint64_t seed = 1; seed <= rounds; ++seed) {
        oracle::Random random{seed};
        const double V = random.decades(1.5, 3), A = V * random.decades(0.5, 1.5),
                     J = A * random.decades(0.5, 2);
        const double way = random.between(0.2, 3) * V;
        MotionBench bench(fmt::format(
            "tasks: {{main: {{every: 1 ms}}}}\nblocks:\n"
            "  m: {{type: axis, task: main, default_velocity: {0} mm/s, default_acceleration: {1} "
            "mm/s^2, default_deceleration: {1} mm/s^2, default_jerk: {2} mm/s^3}}\n"
            "  s: {{type: axis, task: main, default_velocity: {3} mm/s, default_acceleration: {4} "
            "mm/s^2, default_deceleration: {4} mm/s^2, default_jerk: {5} mm/s^3}}\n"
            "  first: {{type: MC_MoveVelocity, task: main, Axis: m, Velocity: {6} mm/s}}\n"
            "  second: {{type: MC_MoveVelocity, task: main, Axis: m, Velocity: {7} mm/s}}\n"
            "  gear: {{type: MC_GearInPos, task: main, Master: m, Slave: s, MasterSyncPosition: "
            "{8} mm, SlaveSyncPosition: {9} mm}}\n",
            V, A * random.decades(-1, 0), random.one_in(3) ? 0 : J, V, A, J,
            V * random.between(0.1, 0.8), V * random.between(0.1, 0.8), way,
            way * random.between(0.3, 1.2)));
        const std::int64_t begin = random.one_in(2) ? 0 : 300, coupled = random.one_in(2) ? 100 : 1;
        for (int i = 0; i < 40'000 && !bench.is("gear.InSync") && !bench.is("gear.Error"); ++i) {
            if (i == begin) bench.set("first.Execute", true);
            if (i == 900) bench.set("second.Execute", true);
            if (i == coupled) bench.set("gear.Execute", true);
            bench.step();
            const Axis& slave = bench.axis("s");
            if (slave.state != AxisState::synchronized_motion) continue;
            const MotionState now = slave.total();
            INFO("seed " << seed << ", at " << bench.now() << " ms");
            REQUIRE(std::abs(now.velocity) <= V * (1 + 1e-8));
            REQUIRE(std::abs(now.acceleration) <= A * (1 + 1e-8));
        }
        in_sync += bench.is("gear.InSync") ? 1 : 0;
        refused += bench.is("gear.Error") ? 1 : 0;
    }
    CAPTURE(in_sync, refused);
    CHECK(in_sync * 20 > rounds * 19);
    CHECK(in_sync + refused == rounds);
}
