#include "blocks/motion/probes.hpp"

#include <cmath>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "runtime/model/random.hpp"
#include "tests/blocks/motion/bench.hpp"
#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// `x` and `y` run at speeds of their own; a cam of `y` triggers the probe of `x`.
std::string probing(const std::string& of_probe = {}, const std::string& of_x = {},
                    const char* unit = "mm") {
    return fmt::format(R"(
tasks: {{main: {{every: 1 ms}}}}
blocks:
  x: {{type: axis, task: main, unit: {2}, default_acceleration: 1e5 {2}/s^2, default_jerk: 0 {2}/s^3{0}}}
  y: {{type: axis, task: main, default_acceleration: 1e5 mm/s^2, default_jerk: 0 mm/s^3}}
  run: {{type: MC_MoveVelocity, task: main, Axis: x, Velocity: 77 {2}/s}}
  lead: {{type: MC_MoveVelocity, task: main, Axis: y, Velocity: 130 mm/s}}
  cams: {{type: cam_switches, task: main, switches: [[1, 20.03 mm, 25 mm]]}}
  cam: {{type: MC_DigitalCamSwitch, task: main, Axis: y, Switches: cams, Enable: true}}
  probe: {{type: MC_TouchProbe, task: main, Axis: x{1}}}
  set: {{type: MC_SetPosition, task: main, Axis: x, Position: 1000 {2}, Relative: true}}
  abort: {{type: MC_AbortTrigger, task: main, Axis: x}}
)",
                       of_x, of_probe, unit);
}

void run(MotionBench& bench) {
    for (const char* go : {"run.Execute", "lead.Execute", "probe.Execute"}) bench.set(go, true);
}

}  // namespace

TEST_CASE("MC_TouchProbe records where the axis was when another passed a cam, between scans") {
    MotionBench bench(probing(", TriggerInput: cam.Output1, TriggerTime: cam.OnTime1"));
    run(bench);
    double before_x = 0, before_y = 0;
    for (int i = 0; i < 1000 && !bench.is("probe.Done"); ++i) {
        before_x = bench.number("x.position");
        before_y = bench.number("y.position");
        bench.step();
    }
    REQUIRE(bench.is("probe.Done"));
    const double x = bench.number("x.position"), y = bench.number("y.position");
    const double part = (20.03 - before_y) / (y - before_y);
    CHECK(part > 0.01);
    CHECK(part < 0.99);
    CHECK(bench.number("probe.RecordedPosition") ==
          Approx(before_x + part * (x - before_x)).epsilon(1e-7));
    CHECK(bench.number("probe.RecordedTime") == bench.number("cam.OnTime1"));
}

TEST_CASE("without a time of its own a trigger comes with the scan that sees it") {
    MotionBench bench(probing());
    run(bench);
    bench.step(100);
    bench.set("probe.TriggerInput", true);
    bench.step();
    CHECK(bench.is("probe.Done"));
    CHECK(bench.number("probe.RecordedPosition") == bench.number("x.position"));
    CHECK(bench.number("probe.RecordedTime") == static_cast<double>(bench.now() * millisecond));
}

TEST_CASE("a trigger that is told late is recorded where the axis was, also when it was renamed") {
    MotionBench bench(probing());
    run(bench);
    bench.step(101);
    const std::int64_t now = bench.now();
    const double at = bench.number("x.position");
    bench.set("set.Execute", true);
    bench.step(10);
    bench.set("probe.TriggerInput", true);
    bench.set("probe.TriggerTime", now * millisecond - millisecond / 4);
    bench.step();
    CHECK(bench.is("probe.Done"));
    CHECK(bench.number("probe.RecordedPosition") == Approx(1000 + at - 0.25e-3 * 77).margin(1e-9));
}

TEST_CASE("a trigger whose time is not known any more, or to come, is refused") {
    for (const std::int64_t off : {-40 * millisecond, 2 * millisecond}) {
        MotionBench bench(probing());
        run(bench);
        bench.step(100);
        bench.set("probe.TriggerInput", true);
        bench.set("probe.TriggerTime", bench.now() * millisecond + off);
        bench.step();
        CHECK(bench.is("probe.Error"));
        CHECK(bench.text("probe.ErrorID") == "out_of_range");
    }
}

TEST_CASE("only a trigger within the window counts, by the position at its time") {
    MotionBench bench(probing(", WindowOnly: true, FirstPosition: 5 mm, LastPosition: 6 mm"));
    run(bench);
    const auto pulse = [&](double wanted) {
        while (bench.number("x.position") < wanted) bench.step();
        const double late = (bench.number("x.position") - wanted) / 77;
        bench.set("probe.TriggerInput", true);
        bench.set("probe.TriggerTime",
                  bench.now() * millisecond - static_cast<std::int64_t>(std::llround(late * 1e9)));
        bench.step();
        bench.set("probe.TriggerInput", false);
        bench.step();
    };
    pulse(4.99);
    CHECK(bench.is("probe.Busy"));
    pulse(5.99);  // the scan that sees it is beyond the window
    CHECK(bench.is("probe.Done"));
    CHECK(bench.number("probe.RecordedPosition") == Approx(5.99).margin(1e-6));
}

TEST_CASE("a modulo axis is probed over its end, and a drive by what it measures") {
    MotionBench bench(probing("", ", modulo: true, period: 10 deg", "deg"));
    run(bench);
    while (!(bench.number("x.position") < 0.05 && bench.now() > 50)) bench.step();
    const double at = bench.number("x.position");
    bench.set("probe.TriggerInput", true);
    bench.set("probe.TriggerTime", bench.now() * millisecond - millisecond * 9 / 10);
    bench.step();
    REQUIRE(bench.is("probe.Done"));
    CHECK(bench.number("probe.RecordedPosition") == Approx(10 + at - 0.9e-3 * 77).margin(1e-9));

    MotionBench driven(probing("", ", has_drive: true"));
    driven.set("probe.Execute", true);
    driven.step(2);
    for (const double position : {1.0, 3.0}) {
        driven.set("x.actual_position", position);
        driven.step();
    }
    driven.set("probe.TriggerInput", true);
    driven.set("probe.TriggerTime", driven.now() * millisecond - millisecond / 4);
    driven.set("x.actual_position", 4.0);
    driven.step();
    CHECK(driven.number("probe.RecordedPosition") == Approx(2.5));
}

TEST_CASE("a probe of another task waits for the axis' scan, and MC_AbortTrigger ends it") {
    MotionBench bench(R"(
tasks: {slow: {every: 10 ms, priority: 1}, fast: {every: 1 ms, priority: 2}}
blocks:
  x: {type: axis, task: slow, default_acceleration: 1e5 mm/s^2, default_jerk: 0 mm/s^3}
  run: {type: MC_MoveVelocity, task: slow, Axis: x, Velocity: 100 mm/s}
  probe: {type: MC_TouchProbe, task: fast, Axis: x}
  abort: {type: MC_AbortTrigger, task: fast, Axis: x}
)");
    bench.set("run.Execute", true);
    bench.step(100);
    bench.set("probe.Execute", true);
    bench.step(5);
    bench.set("probe.TriggerInput", true);
    bench.set("probe.TriggerTime", bench.now() * millisecond);
    bench.step();
    CHECK(bench.is("probe.Busy"));
    for (int i = 0; i < 40 && bench.is("probe.Busy"); ++i) bench.step();
    REQUIRE(bench.is("probe.Done"));
    const double late = bench.number("x.position") - bench.number("probe.RecordedPosition");
    CHECK(late == Approx(0.6).margin(1e-9));  // at 104 ms, between scans at 100 ms and 110 ms
    bench.set("probe.TriggerInput", false);
    bench.set("probe.Execute", false);
    bench.step(2);
    bench.set("probe.Execute", true);
    bench.step(2);
    bench.set("abort.Execute", true);
    bench.step(30);
    CHECK(bench.is("probe.CommandAborted"));
}

TEST_CASE("a checkpoint of armed probes and cams goes on to the same bytes") {
    const std::string program = probing(", TriggerInput: cam.Output1, TriggerTime: cam.OnTime1");
    for (const std::int64_t at : {50, 150, 155, 156, 157, 158, 200}) {
        MotionBench whole(program), resumed(program);
        run(whole);
        whole.step(at);
        resumed.resume(whole.checkpoint(), whole.now() + 1);
        whole.step(100);
        resumed.step(100);
        CHECK(whole.checkpoint() == resumed.checkpoint());
    }
}
