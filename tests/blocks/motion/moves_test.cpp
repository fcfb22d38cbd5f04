#include "blocks/motion/moves.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "runtime/model/random.hpp"
#include "tests/blocks/motion/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// A trapezoid of 100 mm/s and 1000 mm/s^2; all in one task, the commands behind the axis.
constexpr const char* one_axis = R"(
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: axis, task: main, default_velocity: 100 mm/s, default_acceleration: 1000 mm/s^2, default_deceleration: 1000 mm/s^2, default_jerk: 0 mm/s^3}
  power: {type: MC_Power, task: main, Axis: x, Enable: true}
  one: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 50 mm}
  two: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 80 mm, Velocity: 50 mm/s}
  velocity: {type: MC_MoveVelocity, task: main, Axis: x, Velocity: 20 mm/s}
  stop: {type: MC_Stop, task: main, Axis: x}
  halt: {type: MC_Halt, task: main, Axis: x}
  added: {type: MC_MoveSuperimposed, task: main, Axis: x, Distance: 10 mm, VelocityDiff: 50 mm/s}
  reset: {type: MC_Reset, task: main, Axis: x}
)";

}  // namespace

TEST_CASE("MC_MoveAbsolute in sequence: the second begins at the Done of the first") {
    MotionBench bench(one_axis);
    bench.check(R"(
    ms    one.Execute two.Execute | one.Busy one.Active one.Done one.CommandAborted two.Busy two.Done x.state         x.position
    0     0           0           | 0        0          0        0                  0        0        standstill      0
    1     1           0           | 1        0          0        0                  0        0        standstill      0
    2     .           .           | 1        1          0        0                  0        0        discrete_motion 0
    102   .           .           | 1        1          0        0                  0        0        discrete_motion 5
    502   .           .           | 1        1          0        0                  0        0        discrete_motion 45
    601   .           .           | 1        1          0        0                  0        0        discrete_motion 49.9995
    602   .           .           | 0        0          1        0                  0        0        standstill      50
    604   .           1           | 0        0          1        0                  1        0        standstill      50
    605   0           .           | 0        0          0        0                  1        0        discrete_motion 50
    1260  .           0           | 0        0          0        0                  0        0        standstill      80 )");
}

TEST_CASE("MC_MoveAbsolute in sequence: the second aborts the first") {
    MotionBench bench(one_axis);
    bench.check(R"(
    ms    one.Execute two.Execute | one.Busy one.Done one.CommandAborted two.Busy two.Active two.Done x.velocity x.position
    1     1           0           | 1        0        0                  0        0          0        0          0
    202   .           0           | 1        0        0                  0        0          0        100        15
    203   .           1           | 1        0        0                  1        0          0        100        15.1
    204   .           .           | 0        0        1                  1        1          0        100        15.2
    205   0           .           | 0        0        0                  1        1          0        99         15.2995
    254   .           .           | 0        0        0                  1        1          0        50         18.95
    1450  .           .           | 0        0        0                  1        1          0        50         78.75
    1475  .           .           | 0        0        0                  1        1          0        25         79.6875
    1499  .           .           | 0        0        0                  1        1          0        1          79.9995
    1500  .           .           | 0        0        0                  0        0          1        0          80
    1502  .           0           | 0        0        0                  0        0          0        0          80 )");
}

TEST_CASE("MC_Stop holds the axis as long as Execute is true, and is done when it stands") {
    MotionBench bench(one_axis);
    bench.check(R"(
    ms    velocity.Execute stop.Execute one.Execute | velocity.InVelocity velocity.CommandAborted stop.Busy stop.Done one.Error one.ErrorID   x.state           x.velocity
    1     1                0            0           | 0                   0                       0         0         0         none          standstill        0
    21    .                .            .           | 0                   0                       0         0         0         none          continuous_motion 19
    23    .                .            .           | 1                   0                       0         0         0         none          continuous_motion 20
    30    .                1            .           | 1                   0                       1         0         0         none          continuous_motion 20
    31    .                .            .           | 0                   1                       1         0         0         none          stopping          20
    40    .                .            1           | 0                   1                       1         0         0         none          stopping          11
    41    .                .            .           | 0                   1                       1         0         1         axis_stopping stopping          10
    50    .                .            .           | 0                   1                       1         0         1         axis_stopping stopping          1
    51    .                .            0           | 0                   1                       0         1         0         none          stopping          0
    60    0                .            .           | 0                   0                       0         1         0         none          stopping          0
    61    .                0            .           | 0                   0                       0         0         0         none          stopping          0
    62    .                .            .           | 0                   0                       0         0         0         none          standstill        0 )");
}

TEST_CASE("MC_MoveSuperimposed adds its distance to the motion beneath") {
    MotionBench bench(one_axis);
    bench.check(R"(
    ms    velocity.Execute added.Execute | velocity.InVelocity added.Busy added.Active added.Done x.state           x.velocity x.position
    1     1                0             | 0                   0          0            0          standstill        0          0
    101   .                .             | 1                   0          0            0          continuous_motion 20         1.78
    102   .                1             | 1                   1          0            0          continuous_motion 20         1.8
    103   .                .             | 1                   1          1            0          continuous_motion 20         1.82
    153   .                .             | 1                   1          1            0          continuous_motion 70         4.07
    303   .                .             | 1                   1          1            0          continuous_motion 70         14.57
    352   .                .             | 1                   1          1            0          continuous_motion 21         16.7995
    353   .                .             | 1                   0          0            1          continuous_motion 20         16.82
    355   .                0             | 1                   0          0            0          continuous_motion 20         16.86 )");
}

TEST_CASE("without power an axis ramps down, and refuses") {
    MotionBench bench(one_axis);
    bench.check(R"(
    ms    power.Enable velocity.Execute one.Execute | power.Status velocity.CommandAborted velocity.Busy one.Error one.ErrorID   x.state           x.velocity
    1     .            1                0           | 1            0                       1             0         none          standstill        0
    52    .            .                .           | 1            0                       1             0         none          continuous_motion 20
    53    0            .                .           | 1            0                       1             0         none          continuous_motion 20
    54    .            .                1           | 0            1                       0             0         none          disabled          20
    55    .            .                .           | 0            1                       0             1         axis_disabled disabled          19
    80    1            .                0           | 0            1                       0             0         none          disabled          0
    81    .            0                .           | 1            0                       0             0         none          standstill        0 )");
}

TEST_CASE("CoveredDistance is what a superimposed move has added, whatever ends it") {
    MotionBench bench(one_axis);
    bench.set("one.Execute", true);
    bench.step(100);
    bench.set("added.Execute", true);
    bench.step(2);
    double last = -1;
    for (int ms = 0; ms < 5000 && !bench.is("added.Done"); ++ms) {
        REQUIRE(bench.number("added.CoveredDistance") ==
                Approx(bench.axis("x").extra.position).margin(1e-12));
        REQUIRE(bench.number("added.CoveredDistance") > last - 1e-12);
        last = bench.number("added.CoveredDistance");
        bench.step();
    }
    CHECK(bench.number("added.CoveredDistance") == 10);
    bench.step(1000);
    CHECK(bench.number("x.position") == Approx(60));
    bench.set("added.Execute", false);
    bench.set("velocity.Execute", true);
    bench.step(100);
    bench.set("added.Execute", true);
    bench.step(100);
    const double rest = bench.number("x.velocity") - 20;
    CHECK(rest > 1);
    const double before = bench.number("added.CoveredDistance");
    CHECK(before > 1);
    bench.set("two.Execute", true);
    bench.step(3);
    CHECK(bench.is("added.CommandAborted"));
    CHECK(bench.number("added.CoveredDistance") > before);
    CHECK(bench.number("added.CoveredDistance") < before + 0.003 * 50);
}

namespace {

/// With more of the axis' parameters.
std::string led_axis(std::string_view more = "") {
    return fmt::format(R"(
tasks: {{main: {{every: 1 ms}}}}
blocks:
  x: {{type: axis, task: main, default_acceleration: 1000 mm/s^2, default_deceleration: 1000 mm/s^2, default_jerk: 0 mm/s^3{}}}
  lead: {{type: MC_MotionInPosition, task: main, Axis: x}}
  other: {{type: MC_MotionInPosition, task: main, Axis: x, Position: 30 mm}}
  move: {{type: MC_MoveAbsolute, task: main, Axis: x, Position: 2 mm, Velocity: 100 mm/s, BufferMode: mcBuffered}}
  stop: {{type: MC_Stop, task: main, Axis: x}}
  out: {{type: MC_GearOut, task: main, Slave: x}}
  reset: {{type: MC_Reset, task: main, Axis: x}}
)",
                       more);
}

}  // namespace

TEST_CASE("MC_MotionInPosition gives set-points, which the axis takes in its next scan") {
    MotionBench bench(led_axis());
    bench.check(R"(
    ms   lead.Enable lead.Position lead.Velocity | lead.Busy lead.Active x.state             x.position x.velocity
    1    1           0.1           20            | 1         0           standstill          0          0
    2    .           0.12          .             | 1         1           synchronized_motion 0.1        20
    3    .           0.14          .             | 1         1           synchronized_motion 0.12       20
    4    .           0.5           30            | 1         1           synchronized_motion 0.14       20
    5    .           0.53          .             | 1         1           synchronized_motion 0.5        30
    6    0           .             .             | 1         1           synchronized_motion 0.53       30
    7    .           .             .             | 0         0           discrete_motion     0.56       30
    36   .           .             .             | 0         0           discrete_motion     1.0095     1
    37   .           .             .             | 0         0           standstill          1.01       0 )");
}

TEST_CASE("MC_MotionInPosition of a slower task is gone on from, and what waits follows it") {
    MotionBench bench(led_axis());
    bench.check(R"(
    ms   lead.Enable lead.Position lead.Velocity move.Execute | lead.Active lead.CommandAborted move.Busy move.Active move.Done x.state             x.position x.velocity
    1    1           1             0             0            | 0           0                   0         0           0         standstill          0          0
    2    .           .             .             1            | 1           0                   1         0           0         synchronized_motion 1          0
    9    .           .             .             .            | 1           0                   1         0           0         synchronized_motion 1          0
    10   0           .             .             .            | 1           0                   1         0           0         synchronized_motion 1          0
    11   .           .             .             .            | 0           0                   1         1           0         discrete_motion     1          0
    90   .           .             .             0            | 0           0                   0         0           0         standstill          2          0 )");
}

TEST_CASE(
    "MC_MotionInPosition is taken over by another one and by MC_Stop, and no slave of a gear") {
    MotionBench bench(led_axis());
    bench.check(R"(
    ms   lead.Enable lead.Position other.Enable out.Execute stop.Execute | lead.CommandAborted other.Active other.CommandAborted out.ErrorID x.state             x.position
    1    1           1             0            0           0            | 0                   0            0                    none        standstill          0
    3    .           2             .            1           .            | 0                   0            0                    none        synchronized_motion 1
    4    .           .             .            .           .            | 0                   0            0                    wrong_state synchronized_motion 2
    5    .           .             1            0           .            | 0                   0            0                    none        synchronized_motion 2
    6    .           .             .            .           .            | 1                   1            0                    none        synchronized_motion 30
    7    .           .             .            .           1            | 1                   1            0                    none        synchronized_motion 30
    8    .           .             .            .           .            | 1                   0            1                    none        stopping            30 )");
}

TEST_CASE("MC_MotionInPosition turns a modulo axis by the shorter way") {
    MotionBench bench(led_axis(", modulo: true, period: 360 mm"));
    bench.check(R"(
    ms   lead.Enable lead.Position | x.position
    1    1           1             | 0
    2    .           359           | 1
    3    .           358           | 359
    4    .           .             | 358 )");
    CHECK(bench.axis("x").base.position == -2);
}

TEST_CASE("MC_MotionInPosition keeps the axis inside its software limits") {
    MotionBench bench(
        led_axis(", software_limits: true, lowest_position: -10 mm, highest_position: 50 mm"));
    bench.check(R"(
    ms   lead.Enable lead.Position lead.Velocity reset.Execute | lead.Error lead.ErrorID   x.state             x.position
    1    1           50.1          0             0             | 0          none           standstill          0
    2    .           .             .             .             | 1          software_limit standstill          0
    3    0           .             .             .             | 0          none           standstill          0
    4    1           49.9          100           .             | 0          none           standstill          0
    5    .           50            .             .             | 0          none           synchronized_motion 49.9
    6    .           50.1          .             .             | 0          none           synchronized_motion 50
    7    .           .             .             .             | 1          software_limit error_stop          50 )");
}

TEST_CASE("MC_Halt and MC_Stop with little jerk never turn the axis round, again and again") {
    MotionBench bench(R"(
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: axis, task: main, default_velocity: 100 mm/s, default_acceleration: 1000 mm/s^2, default_deceleration: 1000 mm/s^2, default_jerk: 5000 mm/s^3}
  go: {type: MC_MoveVelocity, task: main, Axis: x, Velocity: 100 mm/s, Jerk: 100000 mm/s^3}
  slower: {type: MC_MoveVelocity, task: main, Axis: x, Velocity: 1 mm/s, Jerk: 100000 mm/s^3}
  halt: {type: MC_Halt, task: main, Axis: x, Jerk: 1000 mm/s^3}
  weaker: {type: MC_Halt, task: main, Axis: x, Deceleration: 50 mm/s^2, Jerk: 100 mm/s^3}
  stop: {type: MC_Stop, task: main, Axis: x, Deceleration: 50 mm/s^2, Jerk: 100 mm/s^3}
)");
    lineshaft::Random random(1, "halts");
    for (int round = 0; round < 60; ++round) {
        const double sign = random.below(2) == 0 ? -1 : 1;
        bench.restart();
        bench.step(2);
        bench.set("go.Velocity", sign * 100);
        bench.set("slower.Velocity", sign);
        bench.set("go.Execute", true);
        bench.step(200);
        bench.set("slower.Execute", true);
        bench.step(2 + static_cast<std::int64_t>(random.below(110)));
        for (const char* stop : {"halt.Execute", "weaker.Execute", "stop.Execute"}) {
            bench.set(stop, true);
            for (auto left = random.below(60); left > 0; --left) {
                bench.step();
                REQUIRE(bench.number("x.velocity") * sign >= -1e-9);
            }
        }
        while (!bench.is("stop.Done")) {
            bench.step();
            INFO("round " << round << ", at " << bench.now() << " ms");
            REQUIRE(bench.number("x.velocity") * sign >= -1e-9);
            REQUIRE(bench.now() < 20'000);
        }
    }
}
