#include <filesystem>
#include <random>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/restart/checkpoint.hpp"
#include "runtime/run/single_run.hpp"
#include "tests/count_of.hpp"
#include "tests/folder.hpp"
#include "tests/source_folder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

Loaded load(const std::string& program) {
    Diagnostics out;
    auto loaded = load_program(test::in_source("programs/" + program), {}, standard_blocks(), out);
    INFO(out.render());
    REQUIRE(loaded);
    return std::move(*loaded);
}

RunOptions options_in(const Folder& folder) {
    return {.trace_path = folder / "run.csv",
            .progress = {},
            .checkpoint_path = folder / "run.checkpoint"};
}

/// Everything that a run leaves behind, with what came of its expectations.
std::string result_of(const RunReport& report, const Folder& folder) {
    std::string text = read(folder / "run.csv") + read(folder / "run.events.csv") +
                       std::to_string(report.result.time);
    for (const char* more : {"pulses.csv", "run.fast.csv"})
        if (std::filesystem::exists(folder / more)) text += read(folder / more);
    for (const Verdict& verdict : report.verdicts) text += verdict.ok ? "ok" : verdict.deviation;
    return text;
}

void check_resumed(const std::string& program, bool pulses) {
    const Folder whole, parted;
    RunOptions options = options_in(whole);
    if (pulses) options.pulses_path = whole / "pulses.csv";
    Loaded first = load(program);
    const RunReport report = run(first, options);
    const std::string wanted = result_of(report, whole);
    REQUIRE(report.result.outcome == Outcome::completed);
    const std::int64_t end = report.result.time;
    std::mt19937_64 random(1);
    for (std::int64_t i = count_of("LINESHAFT_RESUMES", 15); i > 0; --i) {
        options = options_in(parted);
        if (pulses) options.pulses_path = parted / "pulses.csv";
        // From here to the end there is one checkpoint.
        options.checkpoint_every =
            end / 2 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(end / 2));
        Loaded begun = load(program);
        run(begun, options);
        options.checkpoint_every = 0;
        options.restart = Restart::hot;
        Loaded resumed = load(program);
        const RunReport rest = run(resumed, options);
        INFO(rest.refused.render());
        REQUIRE(rest.refused.empty());
        REQUIRE((result_of(rest, parted) == wanted));
    }
}

}  // namespace

TEST_CASE("a resumed run leaves the same bytes: the circle", "[resume]") {
    check_resumed("paper/wei2025_circle.yaml", false);
}

TEST_CASE("a resumed run leaves the same bytes: mechanics", "[resume]") {
    check_resumed("paper/wei2025_platform.yaml", false);
}

TEST_CASE("a resumed run leaves the same bytes: pulses", "[resume]") {
    check_resumed("05_pulses.yaml", true);
}

TEST_CASE("a resumed run leaves the same bytes: machine logic", "[resume]") {
    check_resumed("06_machine_logic.yaml", false);
}

TEST_CASE("a resumed run leaves the same bytes: a trace with a trigger", "[resume]") {
    check_resumed("../tests/cases/trace_begins_at_its_trigger/program.yaml", false);
}

TEST_CASE("a resumed run leaves the same bytes: a replayed trace", "[resume]") {
    check_resumed("../tests/cases/replay_plays_a_recorded_trace/program.yaml", false);
}

TEST_CASE("a resumed run leaves the same bytes: forces of integers without a sign", "[resume]") {
    check_resumed("../tests/cases/unsigned_numbers_of_64_bits/program.yaml", false);
}

TEST_CASE("a foreign or cut checkpoint is refused", "[resume]") {
    const Folder folder;
    RunOptions options = options_in(folder);
    options.checkpoint_every = 1'000'000'000;
    Loaded begun = load("03_ratio_change.yaml");
    run(begun, options);
    options.restart = Restart::hot;
    const std::string whole = read(options.checkpoint_path);
    const auto message = [&](const std::string& program) {
        Loaded resumed = load(program);
        const RunReport report = run(resumed, options);
        REQUIRE(report.refused.list().size() == 1);
        CHECK(report.result.scans.empty());
        return report.refused.list().front().message;
    };
    CHECK(message("02_gear.yaml") ==
          "the checkpoint is of another program, or of other parameters");
    std::string of_serve = whole;
    const std::string command = R"("command":"run")";
    of_serve.replace(of_serve.find(command), command.size(), R"("command":"serve")");
    std::ofstream(options.checkpoint_path, std::ios::binary) << of_serve;
    CHECK(message("03_ratio_change.yaml") ==
          "the checkpoint is of 'serve': a served machine has no end, and a run judges what is "
          "expected from its start");
    for (const std::size_t size : {whole.size() - 1, whole.size() / 2}) {
        std::ofstream(options.checkpoint_path, std::ios::binary) << whole.substr(0, size);
        CHECK(message("03_ratio_change.yaml") == "the checkpoint is not whole");
    }
    std::ofstream(options.checkpoint_path, std::ios::binary) << whole.substr(0, 10);
    CHECK(message("03_ratio_change.yaml") == "this is not a checkpoint");
    std::ofstream(options.checkpoint_path, std::ios::binary) << whole;
    std::ofstream(options.trace_path, std::ios::binary) << "time,scan\n";
    CHECK_THAT(message("03_ratio_change.yaml"),
               Catch::EndsWith("it is not the file of the checkpoint"));
}

TEST_CASE("a resumed run leaves the same bytes: Structured Text", "[resume]") {
    check_resumed("08_state_machine.yaml", false);
    check_resumed("../tests/cases/structured_text_in_a_program/program.yaml", false);
}
