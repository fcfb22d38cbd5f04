#include "runtime/program/meaning.hpp"

#include <fstream>
#include <random>

#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/run/origin.hpp"
#include "tests/folder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr const char* plain = R"(lineshaft: 1
title: An axis
parameters: {speed: 10 mm/s, seed: 7}
tasks:
  main: {every: 2 ms, cost: 0.5 ms}
inputs: {limit: 100 mm/s^2, go: true}
blocks:
  axis: {type: path_move, task: main, execute: true, length: 1 m, velocity_limit: $speed, acceleration_limit: inputs.limit}
  after: {type: not, task: main, input: inputs.go}
stimulus: [{at: 1 s, set: {inputs.limit: 50 mm/s^2}}]
run: {for: 2 s, seed: $seed}
trace: {task: main, signals: [axis.position]}
expect: [{at: end, axis.velocity: 10 mm/s, within: 10 %}]
)";

Meaning meaning(const std::string& text, const LoadOptions& options = {}) {
    Diagnostics out;
    const auto file = std::make_shared<const SourceFile>(SourceFile{"p.yaml", text});
    const Program program = read_program(file, options, out);
    INFO(out.render());
    REQUIRE(out.empty());
    return meaning_of(program);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), by);
}

void check_same(const std::string& what, const std::string& by) {
    INFO(what << " -> " << by);
    const Meaning a = meaning(plain), b = meaning(replaced(plain, what, by));
    CHECK(a.in_force == b.in_force);
    CHECK(a.form == b.form);
}

void check_other(const std::string& what, const std::string& by) {
    INFO(what << " -> " << by);
    const Meaning a = meaning(plain), b = meaning(replaced(plain, what, by));
    CHECK(a.in_force != b.in_force);
    CHECK(a.form != b.form);
}

}  // namespace

TEST_CASE("comments, titles, the order of keys and the spelling of quantities mean nothing") {
    check_same("tasks:", "# one more line\n\ntasks:");
    check_same("An axis", "Another title");
    check_same("{every: 2 ms, cost: 0.5 ms}", "{cost: 500 us, every: 0.002 s}");
    check_same("{type: path_move, task: main,", "{task: main, 'type': \"path_move\",");
    check_same("at: 1 s", "at: 1000ms");
    check_same("50 mm/s^2", "5 cm/s^2");
    check_same(
        "run: {for: 2 s, seed: $seed}\ntrace: {task: main, signals: [axis.position]}",
        "trace:\n  signals:\n    - axis.position\n  task: main\nrun: {seed: $seed, for: 2000 ms}");
    check_same("velocity: 10 mm/s, within", "velocity: 0.01 m/s, within");
}

TEST_CASE("what a program does, it means") {
    check_other("{every: 2 ms", "{every: 4 ms");
    check_other("50 mm/s^2", "50.000001 mm/s^2");
    check_other("limit: 100 mm/s^2", "limit: 10 cm/s^2");
    check_other("within: 10 %", "within: 0.1 mm/s");
    check_other("{for: 2 s", "{for: 3 s");
    check_other("[axis.position]", "[axis.velocity]");
    check_other(
        "  axis: {type: path_move, task: main, execute: true, length: 1 m, velocity_limit: $speed, "
        "acceleration_limit: inputs.limit}\n"
        "  after: {type: not, task: main, input: inputs.go}\n",
        "  after: {type: not, task: main, input: inputs.go}\n"
        "  axis: {type: path_move, task: main, execute: true, length: 1 m, velocity_limit: $speed, "
        "acceleration_limit: inputs.limit}\n");
}

TEST_CASE("parameters in force change what runs, not the form") {
    const Meaning a = meaning(plain);
    for (const Setting& setting : {Setting{"speed", "11 mm/s"}, Setting{"seed", "8"}}) {
        const Meaning b = meaning(plain, {.settings = {setting}, .include_dirs = {}});
        CHECK(a.in_force != b.in_force);
        CHECK(a.form == b.form);
    }
    CHECK(meaning(plain, {.settings = {{"speed", "1 cm/s"}}, .include_dirs = {}}).in_force ==
          a.in_force);
    const Meaning fixed =
        meaning(replaced(plain, "velocity_limit: $speed", "velocity_limit: 10 mm/s"));
    CHECK(fixed.in_force == a.in_force);
    CHECK(fixed.form != a.form);
    CHECK(meaning(replaced(plain, "speed: 10 mm/s", "speed: 20 mm/s")).form == a.form);
    LoadOptions forced;
    forced.forces = {"axis.velocity=1 mm/s@1s..2s"};
    CHECK(meaning(plain, forced).in_force != a.in_force);
    CHECK(meaning(plain, forced).form == a.form);
}

TEST_CASE("a quantity means the same in each of its units, and no other means it") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 300; ++i) {
        const auto micrometres = std::uniform_int_distribution<std::int64_t>(1, 1'000'000)(random);
        const double value = static_cast<double>(micrometres);
        const auto with = [&](double number, const char* unit) {
            return meaning(plain, {.settings = {{"speed", fmt::format("{} {}", number, unit)}},
                                   .include_dirs = {}})
                .in_force;
        };
        INFO(micrometres << " um/s");
        const std::string wanted = with(value, "um/s");
        REQUIRE(with(value / 1e3, "mm/s") == wanted);
        REQUIRE(with(value / 1e6, "m/s") == wanted);
        REQUIRE(with(value + 1, "um/s") != wanted);
    }
}

TEST_CASE("the origin of a run names what made it, without folders") {
    const Folder folder;
    std::filesystem::create_directory(folder / "config");
    std::ofstream(folder / "config/plc.yaml")
        << "lineshaft_controller: 1\ntitle: A controller\nnotes: Its clock is guessed.\n"
           "tasks: {main: {every: 2 ms}}\n";
    std::ofstream(folder / "in.csv") << "time,x\n0,1\n";
    std::ofstream(folder / "p.yaml") << R"(lineshaft: 1
title: Replayed
notes: A note.
controller: config/plc.yaml
parameters: {speed: 10 mm/s}
inputs: {x: 0.0}
blocks: {axis: {type: axis, task: main, default_velocity: $speed}}
stimulus: [{file: in.csv, set: {inputs.x: x}}]
run: {for: 1 s, seed: 3}
)";
    const Catalog catalog = standard_blocks();
    Diagnostics out;
    LoadOptions options{.settings = {{"speed", "2 cm/s"}}, .include_dirs = {}};
    options.forces = {"axis.velocity=1 mm/s@0.5s..1s"};
    const auto loaded = load_program(folder / "p.yaml", options, catalog, out);
    INFO(out.render());
    REQUIRE(loaded);
    const TraceOrigin origin = origin_of(*loaded);
    CHECK(origin.title == "Replayed");
    CHECK(origin.notes == std::vector<std::string>{"Its clock is guessed.", "A note."});
    CHECK(origin.run["program"] == "p.yaml");
    CHECK(origin.run["parameters"]["speed"] == "2 cm/s");
    CHECK(origin.run["seed"] == 3);
    CHECK(origin.run["controller"]["file"] == "plc.yaml");
    CHECK(origin.run["forces"][0] == "axis.velocity = 1 mm/s from 0.5 s until 1 s");
    CHECK(origin.run["replays"][0]["file"] == "in.csv");
    CHECK(origin.run["replays"][0]["crc32"] == "7f811a67");
    std::ofstream(folder / "in.csv") << "time,x\n0,2\n";
    const auto changed = load_program(folder / "p.yaml", options, catalog, out);
    REQUIRE(changed);
    CHECK(origin_of(*changed).run["replays"] != origin.run["replays"]);
    CHECK(origin_of(*changed).run["form"] == origin.run["form"]);
}
