#include "blocks/motion/digital_cam_switch.hpp"

#include <cmath>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "runtime/model/random.hpp"
#include "tests/blocks/motion/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// An axis that runs at a velocity at once.
std::string switching(const std::string& cams, const std::string& of_axis = {},
                      const std::string& more = {}, const char* unit = "mm") {
    return fmt::format(R"(
tasks: {{main: {{every: 1 ms}}}}
blocks:
  x: {{type: axis, task: main, unit: {3}, default_acceleration: 1e6 {3}/s^2, default_deceleration: 1e6 {3}/s^2, default_jerk: 0 {3}/s^3{0}}}
  run: {{type: MC_MoveVelocity, task: main, Axis: x, Velocity: 100 {3}/s, ContinuousUpdate: true}}
  cams: {{type: cam_switches, task: main, {1}}}
  cam: {{type: MC_DigitalCamSwitch, task: main, Axis: x, Switches: cams, Enable: true{2}}}
)",
                       of_axis, cams, more, unit);
}

/// Runs on until the output is so.
void until(MotionBench& bench, const char* output, bool wanted) {
    for (int i = 0; i < 5000 && bench.is(output) != wanted; ++i) bench.step();
    INFO(output << " " << wanted);
    REQUIRE(bench.is(output) == wanted);
}

/// Where the axis, which runs at a constant velocity, was at the time.
double place(const MotionBench& bench, const char* time, double velocity) {
    const double ago = static_cast<double>(bench.now()) * 1e6 - bench.number(time);
    return bench.number("x.position") - velocity * ago * 1e-9;
}

}  // namespace

TEST_CASE("a track goes on and off with its cams, at their positions between two scans") {
    MotionBench bench(
        switching("switches: [[1, 10.02 mm, 20.07 mm], [2, 15 mm, 40 mm, "
                  "mcNegative], [1, 18 mm, 30.011 mm], [3, 5 mm, 5.01 mm]]"));
    bench.set("run.Execute", true);
    until(bench, "cam.Output1", true);
    CHECK(place(bench, "cam.OnTime1", 100) == Approx(10.02).margin(1e-6));
    CHECK(bench.number("x.position") - 10.02 < 0.1);
    CHECK_FALSE(bench.is("cam.Output3"));  // it is over before a scan, but its times tell
    CHECK(bench.number("cam.OffTime3") - bench.number("cam.OnTime3") == Approx(1e5).margin(2));
    until(bench, "cam.Output1", false);
    CHECK(place(bench, "cam.OffTime1", 100) == Approx(30.011).margin(1e-6));
    CHECK_FALSE(bench.is("cam.Output2"));
    CHECK(bench.number("cam.OnTime2") == 0);
    bench.set("run.Velocity", -100.0);
    until(bench, "cam.Output1", true);
    CHECK(place(bench, "cam.OnTime1", -100) == Approx(30.011).margin(1e-6));
    CHECK(bench.is("cam.Output2"));
    until(bench, "cam.Output2", false);
    CHECK(place(bench, "cam.OffTime2", -100) == Approx(15).margin(1e-6));
    until(bench, "cam.Output1", false);
    CHECK(place(bench, "cam.OffTime1", -100) == Approx(10.02).margin(1e-6));
}

TEST_CASE("an axis that stands at the edge of a cam is in it") {
    for (const char* there : {"10", "20"}) {
        MotionBench bench(switching("switches: [[1, 10 mm, 20 mm], [2, 20 mm, 10 mm]]", {},
                                    "}\n  move: {type: MC_MoveAbsolute, task: main, Axis: x, "
                                    "Position: " +
                                        std::string(there) + " mm, Velocity: 73 mm/s"));
        bench.set("move.Execute", true);
        until(bench, "move.Done", true);
        bench.step(5);
        CHECK(bench.is("cam.Output1"));
        CHECK(bench.is("cam.Output2"));  // the other way round: outside of both, which belong to it
    }
}

TEST_CASE("compensations move the edges by the velocity, in both directions") {
    const std::string cams = "switches: [[1, 10 mm, 20 mm]], tracks: [[-12.3 ms, 4.5 ms]]";
    MotionBench bench(switching(cams));
    bench.set("run.Execute", true);
    until(bench, "cam.Output1", true);
    CHECK(place(bench, "cam.OnTime1", 100) == Approx(10 - 1.23).margin(1e-6));
    until(bench, "cam.Output1", false);
    CHECK(place(bench, "cam.OffTime1", 100) == Approx(20 + 0.45).margin(1e-6));
    bench.set("run.Velocity", -40.0);
    until(bench, "cam.Output1", true);
    bench.step(20);
    CHECK(place(bench, "cam.OnTime1", -40) == Approx(20 + 0.492).margin(1e-6));
    until(bench, "cam.Output1", false);
    CHECK(place(bench, "cam.OffTime1", -40) == Approx(10 - 0.18).margin(1e-6));
}

TEST_CASE("a cam that is left sooner than its compensations let it begin is never on") {
    MotionBench bench(switching("switches: [[1, 10 mm, 10.5 mm]], tracks: [[10 ms, -1 ms]]"));
    bench.set("run.Execute", true);
    bench.step(400);
    CHECK(bench.number("cam.OnTime1") == 0);
}

TEST_CASE(
    "a time cam is on for its time, from its position on, and begins anew when passed again") {
    MotionBench bench(
        switching("switches: [[1, 10.04 mm, 0 mm, mcBoth, mcTime, 33.25 ms], "
                  "[2, 10 mm, 0 mm, mcPositive, mcTime, 20 us]]"));
    bench.set("run.Execute", true);
    until(bench, "cam.Output1", true);
    CHECK(place(bench, "cam.OnTime1", 100) == Approx(10.04).margin(1e-6));
    until(bench, "cam.Output1", false);
    CHECK(bench.number("cam.OffTime1") - bench.number("cam.OnTime1") == 33'250'000);
    CHECK(bench.number("cam.OffTime2") - bench.number("cam.OnTime2") == 20'000);
    const double first = bench.number("cam.OnTime2");
    bench.set("run.Velocity", -100.0);
    until(bench, "cam.Output1", true);
    bench.step(10);
    bench.set("run.Velocity", 100.0);
    bench.step(30);
    CHECK(bench.is("cam.Output1"));
    CHECK(bench.number("cam.OnTime2") > first);
    const double on = bench.number("cam.OnTime1");
    until(bench, "cam.Output1", false);
    CHECK(bench.number("cam.OffTime1") - on > 43'000'000);
}

TEST_CASE("an edge that has switched holds within its hysteresis, and lets go beyond it") {
    MotionBench bench(switching("switches: [[1, 10 mm, 20 mm]], tracks: [[0 s, 0 s, 0.5 mm]]",
                                ", has_drive: true"));
    const auto at = [&](double position) {
        bench.set("x.actual_position", position);
        bench.step();
        return bench.is("cam.Output1");
    };
    for (const double before : {9.0, 9.8}) CHECK_FALSE(at(before));
    CHECK(at(10.1));
    const double on = bench.number("cam.OnTime1");
    for (const double noise : {9.9, 10.2, 9.6, 10.4, 9.51}) CHECK(at(noise));
    CHECK(bench.number("cam.OnTime1") == on);
    CHECK_FALSE(at(9.4));  // it is on the other side for good
    CHECK(at(10.2));
    CHECK(at(10.6));  // the edge lets go
    CHECK_FALSE(at(9.9));
    for (const double noise : {10.1, 9.8, 10.3}) CHECK_FALSE(at(noise));
    CHECK(at(10.7));
    CHECK(at(19));
    CHECK_FALSE(at(20.1));
    for (const double noise : {19.9, 20.2, 19.6}) CHECK_FALSE(at(noise));
    CHECK(at(19.4));
}

TEST_CASE("tracks that are not enabled are off, as all are without Enable") {
    MotionBench bench(
        switching("switches: [[1, -1 mm, 1 mm], [2, -1 mm, 1 mm]]", {}, ", EnableMask: 2"));
    bench.step(3);
    CHECK_FALSE(bench.is("cam.Output1"));
    CHECK(bench.is("cam.Output2"));
    CHECK(bench.is("cam.InOperation"));
    bench.set("cam.EnableMask", std::int64_t{1});
    bench.step();
    CHECK(bench.is("cam.Output1"));
    CHECK_FALSE(bench.is("cam.Output2"));
    CHECK(bench.number("cam.OffTime2") == static_cast<double>(bench.now()) * 1e6);
    bench.set("cam.Enable", false);
    bench.step();
    CHECK_FALSE(bench.is("cam.Output1"));
    CHECK_FALSE(bench.is("cam.InOperation"));
}

TEST_CASE("cams in another unit than the axis are refused") {
    MotionBench bench(switching("unit: deg, switches: [[1, 1 deg, 2 deg]]"));
    bench.step(2);
    CHECK(bench.is("cam.Error"));
    CHECK(bench.text("cam.ErrorID") == "other_unit");
}

/// Whatever the axis does: without hysteresis the output is what its position says, and times lie
/// in the scan in which the output has changed.
TEST_CASE("random motions past random cams: outputs are true to the position in each scan") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        Random random(seed, "cams");
        const auto any = [&](double low, double high) {
            return low + (high - low) * static_cast<double>(random.next() % 10'000) / 1e4;
        };
        const bool modulo = seed % 2 == 0;
        const double a = any(0, 9), b = any(0, 9), c = any(0, 9), d = any(0, 9);
        const bool is_turned = modulo && seed % 4 == 0;
        const double first = is_turned ? std::max(a, b) : std::min(a, b);
        const double last = is_turned ? std::min(a, b) : std::max(a, b);
        MotionBench bench(switching(
            fmt::format("unit: {0}, switches: [[1, {1} {0}, {2} {0}], [1, {3} {0}, {4} {0}]]",
                        modulo ? "deg" : "mm", first, last, std::min(c, d), std::max(c, d)),
            modulo ? ", modulo: true, period: 10 deg" : "", "", modulo ? "deg" : "mm"));
        bench.set("run.Execute", true);
        const auto within = [](double x, double low, double high) {
            return low <= high ? x >= low && x <= high : x >= low || x <= high;
        };
        bool was_on = false;
        for (int i = 0; i < 300; ++i) {
            if (i % 20 == 0) bench.set("run.Velocity", any(-1, 1) * std::pow(10, any(0, 4.3)));
            const double on_before = bench.number("cam.OnTime1"),
                         off_before = bench.number("cam.OffTime1");
            bench.step();
            const double x = bench.number("x.position");
            const bool on = bench.is("cam.Output1");
            INFO("seed " << seed << " at " << bench.now() << " ms, " << x);
            REQUIRE(on == (within(x, first, last) || within(x, std::min(c, d), std::max(c, d))));
            const double now = static_cast<double>(bench.now()) * 1e6;
            for (const auto& [time, before] : {std::pair{bench.number("cam.OnTime1"), on_before},
                                               std::pair{bench.number("cam.OffTime1"), off_before}})
                if (time != before) REQUIRE((time >= now - 1e6 && time <= now));
            const double on_time = bench.number("cam.OnTime1"),
                         off_time = bench.number("cam.OffTime1");
            if (on != was_on && i > 0)
                REQUIRE((on ? on_time != on_before : off_time != off_before));
            was_on = on;
        }
    }
}
