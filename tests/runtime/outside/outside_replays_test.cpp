#include <array>
#include <random>

#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/scan/executive.hpp"
#include "runtime/source/number_text.hpp"
#include "tests/folder.hpp"
#include "tests/runtime/names/small_blocks.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

void write(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

/// What a column of a file without sidecar makes of an input after all of it has been played, or
/// the code of what is wrong with it.
std::string played(const std::string& title, const std::vector<std::string>& cells,
                   const std::string& input) {
    const Folder folder;
    std::string csv = "time," + title + "\n";
    for (std::size_t i = 0; i < cells.size(); ++i) csv += fmt::format("{},{}\n", i, cells[i]);
    write(folder / "run.csv", csv);
    const std::string name = title.substr(0, title.find(' '));
    Diagnostics out;
    const std::string text = fmt::format(R"(lineshaft: 1
tasks: {{a: {{every: 1 ms}}}}
blocks: {{p: {{type: probe, task: a}}, c: {{type: counter, task: a}}}}
inputs: {{length: 1 mm, plain: 1.5, count: 1, flag: false}}
stimulus: [{{file: run.csv, set: {{{}: {}}}}}]
run: {{for: 3 s}}
)",
                                         input, name);
    const auto file = std::make_shared<const SourceFile>(SourceFile{folder / "p.yaml", text});
    const Program program = read_program(file, {}, out);
    static const Catalog catalog = small_catalog();
    Linked linked = link(program, catalog, out);
    if (!out.empty()) return out.list().front().code;
    Executive(linked.machine).run({});
    const Signal* signal = linked.machine.find(input);
    REQUIRE(signal);
    return signal->describe(signal->value());
}

/// As traces write them.
std::string time(std::int64_t nanoseconds) {
    std::array<char, longest_number> text;
    return {text.data(), write_seconds(text.data(), nanoseconds)};
}
std::string real(double value) {
    std::array<char, longest_number> text;
    return {text.data(), write_real(text.data(), value)};
}

/// All but the header.
std::string rows(const std::string& csv) {
    return csv.substr(csv.find('\n'));
}

/// Runs a program, which stands in `folder`, and returns the rows of its trace.
std::string recorded(const Folder& folder, const std::string& name, const std::string& program) {
    write(folder / name + ".yaml", program);
    Diagnostics out;
    auto loaded = load_program(folder / name + ".yaml", {}, standard_blocks(), out);
    INFO(out.render());
    REQUIRE(loaded);
    const RunReport report = run(*loaded, {.trace_path = folder / name + ".csv", .progress = {}});
    REQUIRE_FALSE(report.faulted());
    return rows(read(folder / name + ".csv"));
}

/// Takes three columns of `FILE.csv` in its first task and passes them on.
std::string pass_through(const std::string& file, const std::string& every,
                         const std::string& length) {
    return fmt::format(R"(lineshaft: 1
tasks: {{main: {{every: {}}}}}
inputs: {{x: {}, flag: false, n: 0}}
blocks:
  x: {{type: move_value, task: main, unit: mm, in: inputs.x}}
  flag: {{type: or, task: main, in1: inputs.flag, in2: false}}
  n: {{type: ctu, task: main, data_type: lint, cu: false, pv: inputs.n}}
stimulus: [{{file: {}.csv, set: {{inputs.x: x.out, inputs.flag: flag.out, inputs.n: n.pv}}}}]
run: {{for: 2 s}}
trace: {{task: main, signals: [x.out, flag.out, inputs.n]}}
)",
                       every, length, file);
}

}  // namespace

TEST_CASE("link: a replayed column is converted to the unit of its input", "[replay]") {
    CHECK(played("x [cm]", {"1", "2.5"}, "inputs.length") == "25 mm");
    CHECK(played("x", {"1", "2.5"}, "inputs.length") == "2.5 mm");
    CHECK(played("x [mm]", {"1", "2"}, "p.length") == "0.002 m");
    CHECK(played("x [%]", {"1", "2"}, "inputs.plain") == "0.02");
    CHECK(played("x [s]", {"1", "2"}, "inputs.length") == "L0303");
    CHECK(played("x [parsec]", {"1", "2"}, "inputs.length") == "L0303");
    CHECK(played("x [mm]", {"1", "2"}, "inputs.plain") == "L0303");
}

TEST_CASE("link: a replayed column has values of its input's type", "[replay]") {
    CHECK(played("x", {"0", "1"}, "inputs.flag") == "true");
    CHECK(played("x", {"0", "0.5"}, "inputs.flag") == "L0705");
    CHECK(played("x", {"0", "2"}, "inputs.flag") == "L0705");
    CHECK(played("x", {"0", "-12"}, "inputs.count") == "-12");
    CHECK(played("x", {"0", "1.5"}, "inputs.count") == "L0705");
    CHECK(played("x", {"0", "1e300"}, "inputs.count") == "L0705");
    CHECK(played("x", {"0", "1"}, "p.pace") == "fast");
    CHECK(played("x", {"0", "2"}, "p.pace") == "L0705");
    CHECK(played("x", {"1", "9"}, "c.step") == "9");
    CHECK(played("x", {"1", "10"}, "c.step") == "L0305");
}

TEST_CASE("link: rows without a value are left out", "[replay]") {
    CHECK(played("x", {"1", "2", "", ""}, "inputs.count") == "2");
    CHECK(played("x", {"", "", ""}, "inputs.count") == "L0721");
}

TEST_CASE("a recorded trace replayed and recorded again has the same bytes", "[replay]") {
    const Folder folder;
    const std::string first = recorded(folder, "first", R"(lineshaft: 1
tasks: {main: {every: 2 ms}}
blocks:
  shaft: {type: axis, task: main, default_acceleration: 100 mm/s^2, default_jerk: 333 mm/s^3}
  run: {type: MC_MoveVelocity, task: main, Axis: shaft, Velocity: 10 mm/s, Execute: true}
  x: {type: move_value, task: main, unit: mm, in: shaft.position}
  high: {type: gt, task: main, unit: mm, in1: shaft.position, in2: 3 mm}
  flag: {type: xor, task: main, in1: high.out, in2: inputs.go}
  n: {type: ctu, task: main, data_type: lint, cu: flag.out, pv: inputs.count}
inputs: {go: false, count: 9007199254740993}
stimulus:
  - {at: 0.5 s, set: {inputs.go: true, inputs.count: -9223372036854775807}}
  - {at: 1.5 s, set: {inputs.go: false, inputs.count: 3}}
run: {for: 2 s}
trace: {task: main, signals: [x.out, flag.out, n.pv]}
)");
    CHECK(recorded(folder, "second", pass_through("first", "2 ms", "0 mm")) == first);
}

TEST_CASE("integers without a sign come back from a replay with the same bytes", "[replay]") {
    const Folder folder;
    write(folder / "pass.st",
          "FUNCTION_BLOCK Pass\nVAR_INPUT u : ULINT; END_VAR\nVAR_OUTPUT v : ULINT; END_VAR\n"
          "v := u;\nEND_FUNCTION_BLOCK\n");
    const auto program = [](const std::string& stimulus) {
        return fmt::format(R"(lineshaft: 1
tasks: {{main: {{every: 1 ms}}}}
sources: [pass.st]
blocks: {{p: {{type: Pass, task: main}}}}
stimulus: [{}]
run: {{for: 20 ms}}
trace: {{task: main, signals: [p.v]}}
)",
                           stimulus);
    };
    const std::string first = recorded(folder, "first",
                                       program("{at: 5 ms, set: {p.u: 18446744073709551615}}, "
                                               "{at: 10 ms, set: {p.u: 9223372036854775808}}"));
    CHECK(first.find(",18446744073709551615\n") != std::string::npos);
    CHECK(recorded(folder, "second", program("{file: first.csv, set: {p.u: p.v}}")) == first);
}

TEST_CASE("any reals come back from a replay with the same bytes", "[replay]") {
    const Folder folder;
    std::mt19937_64 random(1);
    std::string csv = "time,scan,x.out,flag.out,n.pv\n";
    for (int row = 0; row <= 2000; ++row) {
        double value = 0;
        do {
            const std::uint64_t bits = random();
            std::memcpy(&value, &bits, sizeof value);
        } while (!std::isfinite(value));
        csv += fmt::format("{},{},{},{},{}\n", time(std::int64_t{row} * 1'000'000), row,
                           real(value), random() % 2, static_cast<std::int64_t>(random() >> 12));
    }
    write(folder / "first.csv", csv);
    CHECK(recorded(folder, "second", pass_through("first", "1 ms", "0 mm")) == rows(csv));
}
