#include "blocks/motion/digital_signals.hpp"

#include <catch2/catch.hpp>

#include "tests/blocks/motion/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr const char* signals = R"(
tasks:
  fast: {every: 1 ms, priority: 20}
  slow: {every: 10 ms, priority: 1, cost: 3 ms}
blocks:
  sensors: {type: digital_inputs, task: fast}
  valves: {type: digital_outputs, task: fast}
  input: {type: MC_ReadDigitalInput, task: fast, Input: sensors, Enable: true, InputNumber: 32}
  output: {type: MC_ReadDigitalOutput, task: fast, Output: valves, Enable: true, OutputNumber: 7}
  write: {type: MC_WriteDigitalOutput, task: fast, Output: valves, OutputNumber: 7, Value: true}
  late: {type: MC_WriteDigitalOutput, task: slow, Output: valves, OutputNumber: 7}
)";

}  // namespace

TEST_CASE("MC_ReadDigitalInput tells the input of its number, and no other") {
    MotionBench bench(signals);
    bench.set("sensors.in31", true);
    bench.step();
    CHECK(bench.is("input.Valid"));
    CHECK_FALSE(bench.is("input.Value"));
    bench.set("sensors.in32", true);
    bench.step();
    CHECK(bench.is("input.Value"));
    for (const std::int64_t wrong : {std::int64_t{0}, std::int64_t{33}}) {
        bench.set("input.InputNumber", wrong);
        bench.step();
        CHECK(bench.is("input.Error"));
        CHECK_FALSE(bench.is("input.Value"));
        CHECK(bench.text("input.ErrorID") == "out_of_range");
    }
    bench.set("input.Enable", false);
    bench.step();
    CHECK_FALSE(bench.is("input.Error"));
}

TEST_CASE("an output that is written has its value when the writer's task has published it") {
    MotionBench bench(signals);
    bench.check(R"(
    ms  write.Execute late.Execute | write.Busy write.Done valves.out7 output.Value
    5   0             0            | 0          0          0           0
    6   1             .            | 1          0          0           0
    7   .             .            | 0          1          1           1
    8   0             .            | 0          0          1           1
    9   .             .            | 0          0          1           1 )");
    bench.set("late.Execute", true);
    bench.step(3);  // it begins at 10 ms and takes 3 ms
    CHECK(bench.is("valves.out7"));
    bench.step();
    CHECK_FALSE(bench.is("valves.out7"));
    bench.step(20);
    CHECK(bench.is("late.Done"));
}

TEST_CASE("MC_WriteDigitalOutput writes once, and refuses what is not there") {
    MotionBench bench(signals);
    bench.set("write.Execute", true);
    bench.step(5);
    bench.set("write.Value", false);
    bench.step(5);
    CHECK(bench.is("valves.out7"));
    CHECK(bench.is("write.Done"));
    bench.set("write.Execute", false);
    bench.step();
    CHECK_FALSE(bench.is("write.Done"));
    bench.set("write.OutputNumber", std::int64_t{33});
    bench.set("write.Execute", true);
    bench.step();
    CHECK(bench.is("write.Error"));
    bench.set("write.Execute", false);
    bench.step();
    CHECK_FALSE(bench.is("write.Error"));
    bench.set("write.OutputNumber", std::int64_t{1});
    bench.set("write.ExecutionMode", std::int64_t{1});
    bench.set("write.Execute", true);
    bench.step();
    CHECK(bench.is("write.Error"));
    CHECK_FALSE(bench.is("valves.out1"));
}

TEST_CASE("a checkpoint with a writing under way goes on to the same bytes") {
    for (const std::int64_t at : {6, 11, 12, 13}) {
        MotionBench whole(signals), resumed(signals);
        whole.step(5);
        whole.set("late.Execute", true);
        whole.set("write.Execute", true);
        whole.step(at - 5);
        resumed.resume(whole.checkpoint(), whole.now() + 1);
        whole.step(30);
        resumed.step(30);
        CHECK(whole.checkpoint() == resumed.checkpoint());
    }
}
