#include "blocks/motion/synchronous.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "tests/blocks/motion/bench.hpp"
#include "tests/blocks/profile/oracle.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// A master and two slaves, all in one task, the commands behind the axes. With trapezoids of 1000
/// mm/s^2 the times are round.
constexpr const char* line_shaft = R"(
tasks: {main: {every: 1 ms}}
blocks:
  m: {type: axis, task: main, default_velocity: 1 m/s, default_acceleration: 1000 mm/s^2, default_deceleration: 1000 mm/s^2, default_jerk: 0 mm/s^3}
  s: {type: axis, task: main, default_velocity: 1 m/s, default_acceleration: 1000 mm/s^2, default_deceleration: 1000 mm/s^2, default_jerk: 0 mm/s^3}
  t: {type: axis, task: main}
  run: {type: MC_MoveVelocity, task: main, Axis: m, Velocity: 100 mm/s}
  halt: {type: MC_Halt, task: main, Axis: m}
  gear: {type: MC_GearIn, task: main, Master: m, Slave: s}
  gear2: {type: MC_GearIn, task: main, Master: m, Slave: s, RatioNumerator: 2}
  third: {type: MC_GearIn, task: main, Master: s, Slave: t}
  back: {type: MC_GearIn, task: main, Master: t, Slave: m}
  out: {type: MC_GearOut, task: main, Slave: s}
  stop: {type: MC_Stop, task: main, Axis: s}
  phase: {type: MC_PhasingAbsolute, task: main, Master: m, Slave: s, PhaseShift: 10 mm, Velocity: 100 mm/s, Acceleration: 1000 mm/s^2, Deceleration: 1000 mm/s^2, Jerk: 0 mm/s^3}
  more: {type: MC_PhasingRelative, task: main, Master: m, Slave: s, PhaseShift: 10 mm, Velocity: 100 mm/s, Acceleration: 1000 mm/s^2, Deceleration: 1000 mm/s^2, Jerk: 0 mm/s^3}
  set: {type: MC_SetPosition, task: main, Axis: m, Position: 5000 mm}
  home: {type: MC_Home, task: main, Axis: m, Position: 500 mm}
)";

double relative(const MotionBench& bench) {
    return bench.number("s.position") - bench.number("m.position");
}

}  // namespace

TEST_CASE("MC_GearIn with a ratio change: a new command takes over") {
    MotionBench bench(line_shaft);
    bench.check(R"(
    ms    run.Execute gear.Execute gear2.Execute | gear.Busy gear.InGear gear.CommandAborted gear2.Busy gear2.InGear s.state             s.velocity
    0     0           0            0             | 0         0           0                   0          0            standstill          0
    1     1           0            0             | 0         0           0                   0          0            standstill          0
    200   .           1            .             | 1         0           0                   0          0            standstill          0
    201   .           .            .             | 1         0           0                   0          0            synchronized_motion 0
    202   .           .            .             | 1         0           0                   0          0            synchronized_motion 1
    300   .           .            .             | 1         0           0                   0          0            synchronized_motion 99
    302   .           .            .             | 1         1           0                   0          0            synchronized_motion 100
    400   .           .            1             | 1         1           0                   1          0            synchronized_motion 100
    401   .           .            .             | 0         0           1                   1          0            synchronized_motion 100
    402   .           .            .             | 0         0           1                   1          0            synchronized_motion 101
    403   .           0            .             | 0         0           0                   1          0            synchronized_motion 102
    501   .           .            .             | 0         0           0                   1          1            synchronized_motion 200
    503   .           .            .             | 0         0           0                   1          1            synchronized_motion 200 )");
}

TEST_CASE("a slave that got in gear between two scans follows a master that stopped behind that") {
    MotionBench bench(R"(
tasks: {main: {every: 1 ms}}
blocks:
  m: {type: axis, task: main}
  s: {type: axis, task: main, default_acceleration: 1000 mm/s^2, default_deceleration: 1000 mm/s^2, default_jerk: 0 mm/s^3}
  move: {type: MC_MoveAbsolute, task: main, Axis: m, Position: 30.065025 mm, Velocity: 100.05 mm/s, Acceleration: 1e9 mm/s^2, Deceleration: 1e9 mm/s^2, Jerk: 0 mm/s^3}
  gear: {type: MC_GearIn, task: main, Master: m, Slave: s}
)");
    bench.check(R"(
    ms    move.Execute gear.Execute | m.velocity s.velocity gear.InGear
    0     1            0            | 0          0          0
    200   .            1            | 100.05     0          0
    301   .            .            | 100.05     100        0
    302   .            .            | 0          0          1
    303   .            .            | 0          0          1 )");
    CHECK(bench.number("s.position") == Approx(100.05 * (0.10005 / 2 + 0.00045)).margin(1e-6));
}

namespace {

/// A slave that plans in steps of 3 ms, and a master that comes to 100 mm/s in a second.
constexpr const char* in_steps = R"(
tasks: {main: {every: 1 ms}}
blocks:
  m: {type: axis, task: main}
  s: {type: axis, task: main, transition_quantum: 3 ms}
  run: {type: MC_MoveVelocity, task: main, Axis: m, Velocity: 100 mm/s, Acceleration: 100 mm/s^2, Jerk: 1000 mm/s^3}
  gear: {type: MC_GearIn, task: main, Master: m, Slave: s, Acceleration: 1000 mm/s^2, Deceleration: 1000 mm/s^2, Jerk: 0 mm/s^3}
)";

}  // namespace

TEST_CASE("a slave gets in gear in whole steps of its axis, each at one acceleration") {
    MotionBench bench(in_steps);
    bench.set("run.Execute", true);
    bench.step(2000);
    bench.set("gear.Execute", true);
    bench.step(2);
    // 34 steps: 100 mm/s at 1000 mm/s^2 are 33.3.
    const double a = 100 / (34 * 0.003);
    for (int ms = 1; ms < 102; ++ms) {
        CAPTURE(ms);
        bench.step();
        REQUIRE(bench.number("s.velocity") == Approx(a * ms * 1e-3));
        REQUIRE_FALSE(bench.is("gear.InGear"));
    }
    bench.step(2);
    CHECK(bench.is("gear.InGear"));
    CHECK(bench.number("s.velocity") == 100);
    CHECK(bench.number("s.acceleration") == 0);
}

TEST_CASE("a slave gets in gear in whole steps, whenever its master accelerates, without a jump") {
    for (int begin = 5; begin < 1200; begin += 7) {
        CAPTURE(begin);
        MotionBench bench(in_steps);
        bench.set("run.Execute", true);
        bench.step(begin);
        bench.set("gear.Execute", true);
        double velocity = 0;
        for (int ms = 0; ms < 1400 - begin; ++ms) {
            bench.step();
            const double now = bench.number("s.velocity");
            REQUIRE(std::abs(now - velocity) <= 1.0001 + 0.1);
            velocity = now;
        }
        REQUIRE(bench.is("gear.InGear"));
        REQUIRE(bench.number("s.velocity") == Approx(100));
    }
}

TEST_CASE("the profile s7_1500 takes ratios of whole numbers alone") {
    const auto answer = [](const std::string& profile, const std::string& ratio) {
        MotionBench bench(fmt::format(R"(
tasks: {{main: {{every: 1 ms}}}}
blocks:
  m: {{type: axis, task: main}}
  s: {{type: axis, task: main, profile: {}}}
  gear: {{type: MC_GearIn, task: main, Master: m, Slave: s, Execute: true, {}}}
)",
                                      profile, ratio));
        bench.step(3);
        CHECK(bench.is("gear.InGear") != bench.is("gear.Error"));
        return bench.block<GearIn>("gear").error_id;
    };
    CHECK(answer("plcopen", "RatioNumerator: 1.5") == MotionError::none);
    CHECK(answer("s7_1500", "RatioNumerator: 1.5") == MotionError::out_of_range);
    CHECK(answer("s7_1500", "RatioNumerator: 3, RatioDenominator: 2") == MotionError::none);
    CHECK(answer("s7_1500", "RatioNumerator: -3, RatioDenominator: 2") == MotionError::none);
    CHECK(answer("s7_1500", "RatioNumerator: 3, RatioDenominator: -2") ==
          MotionError::out_of_range);
    CHECK(answer("s7_1500", "RatioNumerator: 0") == MotionError::out_of_range);
    CHECK(answer("s7_1500", "RatioNumerator: 3e9") == MotionError::out_of_range);
}

TEST_CASE("MC_CombineAxes follows the sum or the difference of two masters, each with its ratio") {
    for (const bool subtracts : {false, true}) {
        MotionBench bench(fmt::format(R"(
tasks: {{main: {{every: 1 ms}}}}
blocks:
  m: {{type: axis, task: main}}
  n: {{type: axis, task: main}}
  s: {{type: axis, task: main, default_acceleration: 5000 mm/s^2, default_deceleration: 5000 mm/s^2}}
  run_m: {{type: MC_MoveVelocity, task: main, Axis: m, Velocity: 100 mm/s}}
  run_n: {{type: MC_MoveVelocity, task: main, Axis: n, Velocity: 30 mm/s}}
  both: {{type: MC_CombineAxes, task: main, Master1: m, Master2: n, Slave: s, CombineMode: {}, GearRatioNumeratorM1: 2, GearRatioNumeratorM2: 3}}
)",
                                      subtracts ? "mcSubAxes" : "mcAddAxes"));
        bench.set("both.Execute", true);
        bench.step(3);
        REQUIRE(bench.is("both.InSync"));
        bench.set("run_m.Execute", true);
        bench.set("run_n.Execute", true);
        for (int i = 0; i < 500; ++i) {
            bench.step();
            const double sign = subtracts ? -1 : 1;
            const double m = bench.number("m.position"), n = bench.number("n.position");
            REQUIRE(bench.number("s.position") == Approx(2 * m + sign * 3 * n).margin(1e-9));
        }
        CHECK(bench.number("s.velocity") == Approx(subtracts ? 110 : 290));
        CHECK(bench.is("both.InSync"));
    }
}

TEST_CASE("a slave of the actual value follows what the master's drive measures") {
    MotionBench bench(R"(
tasks: {main: {every: 1 ms}}
blocks:
  m: {type: axis, task: main, has_drive: true, actual_position: previous(drive.position)}
  drive: {type: servo_drive, task: main, kv: 50 1/s, set_position: m.position}
  s: {type: axis, task: main}
  run: {type: MC_MoveVelocity, task: main, Axis: m, Velocity: 100 mm/s, Execute: true}
  gear: {type: MC_GearIn, task: main, Master: m, Slave: s, MasterValueSource: mcActualValue, Execute: true}
)");
    bench.step(1000);
    REQUIRE(bench.is("gear.InGear"));
    for (int i = 0; i < 100; ++i) {
        const double actual = bench.number("m.actual_position"), slave = bench.number("s.position");
        bench.step();
        const double moved = bench.number("m.actual_position") - actual;
        REQUIRE(moved == Approx(0.1).margin(1e-6));
        REQUIRE(bench.number("s.position") - slave == Approx(moved).margin(1e-9));
    }
}

TEST_CASE("a master that is homed does not move its slave") {
    MotionBench bench(line_shaft);
    bench.set("run.Execute", true);
    bench.set("gear2.Execute", true);
    bench.step(300);
    bench.set("halt.Execute", true);
    bench.step(300);
    REQUIRE(bench.axis("m").state == AxisState::standstill);
    const double slave = bench.number("s.position"), master = bench.number("m.position");
    bench.set("home.Execute", true);
    bench.step(5);
    CHECK(bench.is("home.Done"));
    CHECK(bench.number("m.position") == 500);
    CHECK(bench.number("s.position") == Approx(slave).margin(1e-12));
    bench.set("halt.Execute", false);
    bench.set("run.Execute", false);
    bench.step(1);
    bench.set("run.Execute", true);
    bench.step(300);
    CHECK(bench.number("s.position") - slave == Approx(2 * (bench.number("m.position") - 500)));
    CHECK(master != 500);
}

TEST_CASE("MC_GearOut leaves the slave with its velocity, and MC_Stop stops it") {
    MotionBench bench(line_shaft);
    bench.set("run.Execute", true);
    bench.set("gear.Execute", true);
    bench.step(400);
    CHECK(bench.is("gear.InGear"));
    bench.set("out.Execute", true);
    bench.set("halt.Execute", true);
    bench.step(3);
    CHECK(bench.is("out.Done"));
    CHECK(bench.is("gear.CommandAborted"));
    CHECK(bench.axis("s").state == AxisState::continuous_motion);
    bench.step(300);
    CHECK(bench.number("m.velocity") == 0);
    CHECK(bench.number("s.velocity") == 100);
    bench.set("stop.Execute", true);
    bench.step(103);
    CHECK(bench.number("s.velocity") == 0);
    CHECK(bench.axis("s").state == AxisState::stopping);
}

TEST_CASE("MC_PhasingAbsolute and MC_PhasingRelative shift the master that the slave sees") {
    MotionBench bench(line_shaft);
    bench.set("run.Execute", true);
    bench.set("gear.Execute", true);
    bench.step(400);
    const double before = relative(bench);
    bench.check(R"(
    ms    phase.Execute more.Execute | phase.Busy phase.Done more.Busy more.Done phase.AbsolutePhaseShift s.velocity s.state
    400   1             0            | 1          0          0         0         0                        100        synchronized_motion
    451   .             .            | 1          0          0         0         1.25                        150           synchronized_motion
    501   .             .            | 1          0          0         0         5                           . synchronized_motion
    600   .             .            | 1          0          0         0         9.9995                   101           synchronized_motion
    601   .             .            | 0          1          0         0         10                       100           synchronized_motion
    603   0             1            | 0          0          1         0         10                       100        synchronized_motion
    806   .             0            | 0          0          0         0         20                       100        synchronized_motion )");
    CHECK(relative(bench) - before == Approx(20).margin(1e-9));
    CHECK(bench.is("gear.InGear"));
}

TEST_CASE("CoveredPhaseShift is what the command has added, also where it is aborted") {
    MotionBench bench(line_shaft);
    bench.set("run.Execute", true);
    bench.set("gear.Execute", true);
    bench.step(400);
    bench.set("phase.Execute", true);
    bench.step(101);
    const double covered = bench.number("phase.CoveredPhaseShift");
    CHECK(covered == Approx(bench.number("phase.AbsolutePhaseShift")).margin(1e-12));
    CHECK(covered > 1);
    CHECK(covered < 9);
    bench.set("more.Execute", true);
    bench.step(3);
    CHECK(bench.is("phase.CommandAborted"));
    const double begun = bench.number("phase.CoveredPhaseShift");
    bench.step(500);
    CHECK(bench.is("more.Done"));
    CHECK(bench.number("more.CoveredPhaseShift") == Approx(10).margin(1e-9));
    CHECK(bench.number("phase.CoveredPhaseShift") == begun);
    CHECK(bench.number("more.AbsolutePhaseShift") == Approx(begun + 10).margin(1e-9));
    bench.set("phase.Execute", false);
    bench.step(2);
    bench.set("phase.Execute", true);
    bench.step(30);
    bench.set("gear2.Execute", true);
    bench.step(3);
    CHECK(bench.is("phase.CommandAborted"));
    CHECK(bench.number("phase.AbsolutePhaseShift") == 0);
    CHECK(bench.number("phase.CoveredPhaseShift") < 0);
}

TEST_CASE("a master in a loop is refused") {
    MotionBench bench(line_shaft);
    for (const char* gear : {"gear.Execute", "third.Execute"}) bench.set(gear, true);
    bench.step(3);
    bench.set("back.Execute", true);
    bench.step(3);
    CHECK(bench.is("back.Error"));
    CHECK(std::get<std::int64_t>(bench.get("back.ErrorID")) ==
          static_cast<std::int64_t>(MotionError::master_loop));
    CHECK(bench.axis("m").state == AxisState::standstill);
    CHECK(bench.is("gear.InGear"));
}

TEST_CASE("a master whose position is set anew does not move its slave") {
    MotionBench bench(line_shaft);
    bench.set("run.Execute", true);
    bench.set("gear.Execute", true);
    bench.step(400);
    const double before = bench.number("s.position");
    bench.set("set.Execute", true);
    bench.step(10);
    CHECK(bench.number("m.position") > 4000);
    CHECK(bench.number("s.position") == Approx(before + 1).margin(1e-9));
    CHECK(bench.number("s.velocity") == 100);
}

namespace {

/// A master that accelerates with 50 mm/s^2, default limits, ratio 1 and then 1.1.
constexpr const char* accelerating = R"(
tasks: {main: {every: 1 ms}}
blocks:
  m: {type: axis, task: main, default_jerk: 0 mm/s^3}
  s: {type: axis, task: main}
  run: {type: MC_MoveVelocity, task: main, Axis: m, Velocity: 1 m/s, Acceleration: 50 mm/s^2}
  gear: {type: MC_GearIn, task: main, Master: m, Slave: s}
  gear2: {type: MC_GearIn, task: main, Master: m, Slave: s, RatioNumerator: 11, RatioDenominator: 10}
)";

}  // namespace

TEST_CASE("a slave gets in gear with a master that accelerates, two scans from the optimum") {
    MotionBench bench(accelerating);
    bench.set("run.Execute", true);
    bench.set("gear.Execute", true);
    bench.step(2000);
    REQUIRE(bench.is("gear.InGear"));
    bench.set("gear2.Execute", true);
    bench.step(2);  // sent, and taken up in the scan after that
    const MotionState master = bench.axis("m").total(), slave = bench.axis("s").total();
    REQUIRE(master.acceleration == 50);
    int scans = 0;
    for (; !bench.is("gear2.InGear") && scans < 1000; ++scans) bench.step();
    // By bisection: what the slave can gain in a time, against what it has to.
    const double A = 1000, J = 5e4, a0 = slave.acceleration, end = 1.1 * 50;
    const auto gain = [&](double t) {
        const double peak = std::min(A, 0.5 * (J * t + a0 + end));
        const double up = (peak - a0) / J, down = (peak - end) / J;
        return 0.5 * (a0 + peak) * up + peak * (t - up - down) + 0.5 * (peak + end) * down;
    };
    double low = std::abs(end - a0) / J, high = 10;
    for (int i = 0; i < 100; ++i) {
        const double t = 0.5 * (low + high);
        const double needed = 1.1 * master.after(t).velocity - slave.velocity;
        (gain(t) < needed ? low : high) = t;
    }
    INFO("optimum " << high * 1e3 << " ms, in gear after " << scans << " scans");
    CHECK(scans >= high * 1e3);
    CHECK(scans <= high * 1e3 + 2);
}

TEST_CASE("a CamTableID that MC_CamTableSelect never gave is refused, whatever its number") {
    constexpr const char* program = R"(
tasks: {main: {every: 1 ms}}
blocks:
  m: {type: axis, task: main}
  points: {type: cam_table, task: main, points: [[0 mm, 0 mm], [50 mm, 30 mm]]}
  s: {type: axis, task: main}
  cam: {type: MC_CamIn, task: main, Master: m, Slave: s}
)";
    const auto error_of = [&](std::int64_t id) {
        MotionBench bench(program);
        bench.set("cam.CamTableID", id);
        bench.set("cam.Execute", true);
        bench.step(3);
        return bench.block<CamIn>("cam").error_id;
    };
    const std::int64_t points = 1, all_flags = 8;
    for (std::int64_t id = -100; id < 100; ++id) {
        INFO("CamTableID " << id);
        const bool names_it = id / all_flags - 1 == points && id > 0;
        CHECK((error_of(id) == MotionError::no_cam) == !names_it);
    }
    using Limits = std::numeric_limits<std::int64_t>;
    for (const std::int64_t id : {Limits::min(), Limits::max(), std::int64_t{1} << 35}) {
        INFO("CamTableID " << id);
        CHECK(error_of(id) == MotionError::no_cam);
    }
}

TEST_CASE("a checkpoint in mid-coupling goes on to the same bytes") {
    constexpr const char* program = R"(
tasks: {main: {every: 1 ms}}
blocks:
  m: {type: axis, task: main}
  s: {type: axis, task: main, default_acceleration: 5000 mm/s^2, default_deceleration: 5000 mm/s^2}
  run: {type: MC_MoveVelocity, task: main, Axis: m, Velocity: 100 mm/s, Execute: true}
  gear: {type: MC_GearIn, task: main, Master: m, Slave: s}
  pos: {type: MC_GearInPos, task: main, Master: m, Slave: s, MasterSyncPosition: 60 mm, SlaveSyncPosition: 50 mm, MasterStartDistance: 20 mm}
  phase: {type: MC_PhasingRelative, task: main, Master: m, Slave: s, PhaseShift: 5 mm, Velocity: 50 mm/s}
  points: {type: cam_table, task: main, periodic: true, points: [[0 mm, 0 mm], [50 mm, 30 mm], [100 mm, 0 mm]]}
  select: {type: MC_CamTableSelect, task: main, Master: m, Slave: s, CamTable: points, Periodic: true, Execute: true}
  cam: {type: MC_CamIn, task: main, Master: m, Slave: s, CamTableID: select.CamTableID, MasterSyncPosition: 50 mm, MasterStartDistance: 40 mm, StartMode: mcRelative}
)";
    const auto drive = [](MotionBench& bench, std::int64_t ms) {
        if (ms == 100) bench.set("gear.Execute", true);
        if (ms == 300) bench.set("pos.Execute", true);
        if (ms == 750) bench.set("phase.Execute", true);
        if (ms == 1000) bench.set("cam.Execute", true);
        bench.step();
    };
    for (const std::int64_t split : {101, 110, 305, 500, 620, 760, 900, 1001, 1100, 1500, 2200}) {
        INFO("checkpoint after " << split << " ms");
        MotionBench whole(program), resumed(program);
        for (std::int64_t ms = 0; ms < split; ++ms) drive(whole, ms);
        resumed.resume(whole.checkpoint(), split);
        for (std::int64_t ms = split; ms < 2500; ++ms) {
            drive(whole, ms);
            drive(resumed, ms);
        }
        CHECK(whole.checkpoint() == resumed.checkpoint());
        CHECK(whole.block<CamIn>("cam").error_id == MotionError::none);
        CHECK(whole.is("cam.InSync"));
    }
}
