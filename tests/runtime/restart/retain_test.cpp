#include "runtime/restart/retain.hpp"

#include <fstream>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/run/single_run.hpp"
#include "tests/folder.hpp"
#include "tests/fuzz/kept_runs.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr const char* own = R"(
FUNCTION_BLOCK Inner
VAR_INPUT go : BOOL; preset : TIME; END_VAR
VAR_OUTPUT done : BOOL; END_VAR
VAR delays : ARRAY[0..1, 1..2] OF TON; edge : R_TRIG; count : INT; END_VAR
edge(CLK := go);
IF edge.Q THEN count := count + 1; END_IF;
delays[1, 2](IN := go, PT := preset, Q => done);
END_FUNCTION_BLOCK
FUNCTION_BLOCK Job
VAR_INPUT go : BOOL; preset : TIME; END_VAR
VAR inner : Inner; END_VAR
inner(go := go, preset := preset);
END_FUNCTION_BLOCK
DATA_BLOCK Totals
VAR RETAIN starts : DINT; END_VAR
VAR ended : BOOL; END_VAR
BEGIN
END_DATA_BLOCK
PROGRAM Keeper
VAR RETAIN scans : DINT; list : ARRAY[0..1] OF LREAL; END_VAR
VAR fresh : DINT; END_VAR
IF fresh = 0 THEN Totals.starts := Totals.starts + 1; END_IF;
scans := scans + 1; fresh := fresh + 1; list[1] := list[1] + 0.5; Totals.ended := TRUE;
END_PROGRAM
)";

constexpr const char* barrier = R"(
lineshaft: 1
parameters: {counted: parts, preset: 5 s}
tasks: {main: {every: 10 ms}}
blocks:
  parts: {type: ctu, task: main, cu: inputs.barrier, pv: 100}
  delay: {type: ton, task: main, in: inputs.barrier, pt: $preset}
  job: {type: Job, task: main, go: inputs.barrier, preset: $preset}
  mean: {type: filter_pt1, task: main, in: inputs.level, time_constant: 0.5 s}
  keeper: {type: Keeper, task: main}
inputs: {barrier: true, level: 1}
retain: [$counted, delay, mean, job]
sources: job.st
run: {for: 1 s}
)";

void write(const std::string& path, std::string_view text) {
    std::ofstream(path, std::ios::binary) << text;
}

Loaded load(const Folder& folder, std::vector<Setting> settings = {}) {
    Diagnostics out;
    write(folder / "line.yaml", barrier);
    write(folder / "job.st", own);
    LoadOptions options;
    options.settings = std::move(settings);
    auto loaded = load_program(folder / "line.yaml", options, standard_blocks(), out);
    INFO(out.render());
    REQUIRE(loaded);
    return std::move(*loaded);
}

/// A run with the retain file of the folder.
RunReport run_on(Loaded& loaded, const Folder& folder) {
    RunOptions options;
    options.retain_path = folder / "line.retain";
    RunReport report = run(loaded, options);
    CHECK(report.restart_error.empty());
    return report;
}

Value value_of(const Loaded& loaded, std::string_view signal) {
    const Signal* found = loaded.linked.machine.find(signal);
    REQUIRE(found);
    return found->value();
}

}  // namespace

TEST_CASE("a part in the light barrier is counted once over warm restarts", "[retain]") {
    const Folder folder;
    for (int restart = 0; restart < 3; ++restart) {
        Loaded loaded = load(folder);
        run_on(loaded, folder);
        CHECK(value_of(loaded, "parts.cv") == Value(std::int64_t{1}));
    }
}

TEST_CASE("retained values in one line are those of the file", "[retain]") {
    const Folder folder;
    Loaded first = load(folder);
    run_on(first, folder);
    const std::string line = retained_line(folder / "line.retain");
    CHECK(line.find('\n') == std::string::npos);
    Loaded by_file = load(folder), by_line = load(folder);
    Diagnostics out;
    const int count = read_retained(folder / "line.retain", by_file.linked.machine, out);
    CHECK(count > 0);
    CHECK(take_retained(line, by_line.program.file, by_line.linked.machine, out) == count);
    CHECK(out.empty());
    for (const char* signal : {"parts.cv", "delay.et", "job.inner.count", "keeper.scans"})
        CHECK(value_of(by_file, signal) == value_of(by_line, signal));
    CHECK(retained_line(folder / "none.retain").empty());
}

TEST_CASE("a retained counter's value alone counts the part again", "[retain]") {
    const Folder folder;
    for (std::int64_t restart = 1; restart <= 3; ++restart) {
        Loaded loaded = load(folder, {{"counted", "parts.cv"}});
        run_on(loaded, folder);
        CHECK(value_of(loaded, "parts.cv") == Value(restart));
    }
}

TEST_CASE("a retained timer goes on where it stood when the power went", "[retain]") {
    const Folder folder;
    for (std::int64_t restart = 1; restart <= 6; ++restart) {
        Loaded loaded = load(folder);
        run_on(loaded, folder);
        const std::int64_t elapsed = std::min<std::int64_t>(restart * 1000, 5000);
        CHECK(value_of(loaded, "delay.et") == Value(elapsed * 1'000'000));
        CHECK(value_of(loaded, "delay.q") == Value(restart >= 5));
        CHECK(value_of(loaded, "job.inner.count") == Value(std::int64_t{1}));
        CHECK(value_of(loaded, "job.inner.delays[1,2].et") == Value(elapsed * 1'000'000));
        CHECK(value_of(loaded, "job.inner.done") == Value(restart >= 5));
    }
}

TEST_CASE("what stands in VAR RETAIN is retained without a word of the program", "[retain]") {
    const Folder folder;
    std::int64_t scans = 0;
    for (std::int64_t restart = 1; restart <= 3; ++restart) {
        Loaded loaded = load(folder);
        run_on(loaded, folder);
        scans += std::get<std::int64_t>(value_of(loaded, "keeper.fresh"));
        CHECK(value_of(loaded, "keeper.scans") == Value(scans));
        CHECK(value_of(loaded, "keeper.list[1]") == Value(0.5 * static_cast<double>(scans)));
        CHECK(value_of(loaded, "Totals.starts") == Value(restart));
    }
    CHECK(scans > 3);
}

TEST_CASE("what a program says of a retained block counts after the restart", "[retain]") {
    const Folder folder;
    Loaded first = load(folder);
    run_on(first, folder);
    Loaded second = load(folder, {{"preset", "500 ms"}});
    run_on(second, folder);
    CHECK(value_of(second, "delay.q") == Value(true));
    CHECK(value_of(second, "delay.pt") == Value(std::int64_t{500'000'000}));
}

TEST_CASE("a block retained by other settings, or cut short, is refused", "[retain]") {
    const Folder folder;
    Loaded first = load(folder);
    run_on(first, folder);
    const std::string whole = read(folder / "line.retain");
    const auto refused = [&](const std::string& text) {
        write(folder / "line.retain", with_check(text));
        Loaded loaded = load(folder);
        const RunReport report = run_on(loaded, folder);
        CHECK(value_of(loaded, "parts.cv") == Value(std::int64_t{0}));
        return report.refused.render();
    };
    const auto replaced = [&](std::string_view from, std::string_view to) {
        std::string text = whole;
        return text.replace(text.find(from), from.size(), to);
    };
    CHECK(refused(replaced("\"settings\": \"", "\"settings\": \"0")).find("'parts' (ctu) was") !=
          std::string::npos);
    CHECK(refused(replaced("\"state\": \"", "\"state\": \"00")).find("L0507") != std::string::npos);
    CHECK(refused(replaced("\"state\": \"0", "\"state\": \"x")).find("L0507") != std::string::npos);
}

TEST_CASE("a damaged file gives way to the copy before it, with a warning", "[retain]") {
    const Folder folder;
    const std::string path = folder / "line.retain";
    for (int restart = 0; restart < 2; ++restart) {
        Loaded loaded = load(folder);
        run_on(loaded, folder);
    }
    const std::string whole = read(path), before = read(path + ".bak");
    CHECK(whole != before);
    for (std::size_t at = 0; at < whole.size(); at += 97) {
        std::string flipped = whole;
        flipped[at] = static_cast<char>(flipped[at] ^ 1 << at % 7);
        write(path, flipped);
        write(path + ".bak", before);
        Loaded loaded = load(folder);
        const RunReport report = run_on(loaded, folder);
        REQUIRE(report.refused.empty());
        REQUIRE(report.warnings.size() == 1);
        CHECK(report.warnings[0].find("is damaged: the copy before it") != std::string::npos);
        CHECK(value_of(loaded, "delay.et") == Value(std::int64_t{2'000'000'000}));
        CHECK(read(path + ".bak") == before);
    }
    std::filesystem::remove(path);
    Loaded loaded = load(folder);
    CHECK(run_on(loaded, folder).warnings.size() == 1);
}

TEST_CASE("a damaged file alone, and one of an earlier layout, is refused", "[retain]") {
    const Folder folder;
    Loaded first = load(folder);
    run_on(first, folder);
    std::string text = read(folder / "line.retain");
    const auto refused = [&](const std::string& other) {
        write(folder / "line.retain", other);
        Loaded loaded = load(folder);
        return run_on(loaded, folder).refused.render();
    };
    CHECK(refused(text.substr(0, text.size() / 2)).find("damaged") != std::string::npos);
    std::string flipped = text;
    flipped[text.find("\"delay\"") + 1] = 'D';
    CHECK(refused(flipped).find("its check does not fit") != std::string::npos);
    const std::string layout = "\"lineshaft_retain\": 8";
    text.replace(text.find(layout), layout.size(), "\"lineshaft_retain\": 1");
    CHECK(refused(with_check(text)).find("of an earlier lineshaft") != std::string::npos);
    CHECK(refused("{}").find("this is not a file of retained values") != std::string::npos);
}

TEST_CASE("a retained axis stands where it was when the power went", "[retain]") {
    const Folder folder;
    write(folder / "axis.yaml", R"(
lineshaft: 1
parameters: {go: true}
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: axis, task: main, start_position: 5 mm}
  go: {type: MC_MoveVelocity, task: main, Axis: x, Execute: inputs.go, Velocity: 10 mm/s}
inputs: {go: $go}
retain: [x, go]
run: {for: 1 s}
)");
    double place = 5;
    for (const char* go : {"true", "true", "false"}) {
        Diagnostics out;
        LoadOptions options;
        options.settings = {{"go", go}};
        auto loaded = load_program(folder / "axis.yaml", options, standard_blocks(), out);
        INFO(out.render());
        REQUIRE(loaded);
        run_on(*loaded, folder);
        const double at = std::get<double>(value_of(*loaded, "x.position"));
        if (place == 5)
            CHECK(at > 14);
        else
            CHECK(at == Approx(place).margin(0.02));
        CHECK(value_of(*loaded, "go.Busy") == Value(place == 5));
        place = at;
    }
}
