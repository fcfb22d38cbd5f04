#include "runtime/program/program.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/runtime/names/small_blocks.hpp"

using namespace lineshaft;
namespace fs = std::filesystem;

namespace {

constexpr const char* head =
    "lineshaft: 1\ntasks: {t: {every: 2 ms}}\nblocks: {c: {type: counter, task: t}}\n";

struct Read {
    Program program;
    Diagnostics out;
};

Read read(std::string text, const LoadOptions& options = {}) {
    Read result;
    result.program = read_program(small_file(std::move(text)), options, result.out);
    INFO(result.out.render());
    return result;
}

std::string mistakes(std::string text, const LoadOptions& options = {}) {
    return codes_of(read(std::move(text), options).out);
}

/// A folder that is removed at the end.
class Folder {
  public:
    Folder() {
        std::string name = (fs::temp_directory_path() / "lineshaft_XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    ~Folder() { fs::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string write(const std::string& name, const std::string& text) const {
        fs::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name) << text;
        return (path_ / name).string();
    }
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

}  // namespace

TEST_CASE("program: a whole one as plain data") {
    const auto [program, out] = read(R"(lineshaft: 1
title: Counting
parameters: {step: 3}
tasks:
  fast: {every: 2 ms, offset: 1 ms, priority: 26, jitter: 1 %, cost: 100 us, cost_jitter: 50 %}
blocks:
  c: {type: counter, task: fast, step: $step}
inputs: {go: false}
run: {for: 1 s, until: c.odd, seed: 7, on_error: continue}
stimulus:
  - {at: 2 ms, set: {inputs.go: false}}
  - {at: 1 ms, set: {inputs.go: true}}
trace: {task: fast, every: 10, signals: [c.count]}
expect:
  - {at: end, c.count: 3, within: 1}
  - {at: 5 ms, c.count: {at_least: 1, at_most: 9}}
  - {always: c.count, at_most: 9}
)");
    REQUIRE(out.empty());
    CHECK(program.title == "Counting");
    REQUIRE(program.tasks.size() == 1);
    const TaskPlan& task = program.tasks[0];
    CHECK(task.every == 2'000'000);
    CHECK(task.offset == 1'000'000);
    CHECK(task.priority == 26);
    CHECK(task.jitter == 20'000);
    CHECK(task.cost == 100'000);
    CHECK(task.cost_jitter == 50'000);
    REQUIRE(program.blocks.size() == 1);
    CHECK(program.blocks[0].ports[0].second.text == "3");
    CHECK(program.blocks[0].ports[0].second.parameter == "step");
    CHECK(program.run.duration == 1'000'000'000);
    CHECK(program.run.until->text == "c.odd");
    CHECK(program.run.seed == 7);
    CHECK(program.run.continue_on_error);
    REQUIRE(program.stimuli.size() == 2);
    CHECK(program.stimuli[0].at == 1'000'000);
    REQUIRE(program.traces.size() == 1);
    CHECK(program.traces[0].every == 10);
    REQUIRE(program.expectations.size() == 3);
    CHECK(program.expectations[0].within->text == "1");
    CHECK(program.expectations[1].from == 5'000'000);
    CHECK(program.expectations[2].when == ExpectPlan::When::always);
}

TEST_CASE("program: settings replace parameters") {
    const std::string text = std::string(head) + "parameters: {long: 1 s}\nrun: {for: $long}\n";
    CHECK(read(text).program.run.duration == 1'000'000'000);
    const auto [program, out] = read(text, {.settings = {{"long", "2 s"}}, .include_dirs = {}});
    CHECK(out.empty());
    CHECK(program.run.duration == 2'000'000'000);
    CHECK(program.parameters == std::vector<std::pair<std::string, std::string>>{{"long", "2 s"}});
}

TEST_CASE("program: a study's setting is wrong where the study makes it") {
    const auto study = std::make_shared<const SourceFile>(SourceFile{"s.yaml", "set: {long: 2}\n"});
    const Setting setting{"long", "2", {study, 1, 7, 4}, {study, 1, 13, 1}};
    const auto [program, out] =
        read(std::string(head) + "parameters: {long: 1 s}\nrun: {for: $long}\n",
             {.settings = {setting}, .include_dirs = {}});
    REQUIRE(out.list().size() == 1);
    CHECK(out.list()[0].mark.file == study);
    CHECK(out.list()[0].mark.column == 13);
}

TEST_CASE("program: what the structure must be") {
    const std::string rest = "run: {for: 1 s}\n";
    struct Row {
        std::string text, mistakes;
    };
    const auto row = GENERATE_COPY(values<Row>({
        {head + rest, ""},
        {head, "L0202 1:1"},
        {"lineshaft: 1\n" + rest, "L0202 1:1; L0202 1:1"},
        {head + rest + "trace: {task: t, signals: []}\n", "L0202 5:27"},
        {head + rest + "trace: {task: t, signals: [c.odd, c.odd]}\n", "L0212 5:35"},
        {head + rest + "expect: [{at: end, always: c.odd}]\n", "L0213 5:10"},
        {head + rest + "expect: [{at: end, c.count: 3, at_most: 4}]\n", "L0213 5:10"},
        {head + rest + "expect: [{always: c.count, at_most: 4, within: 1}]\n", "L0202 5:48"},
        {head + rest + "stimulus: [{at: 1 s}]\n", "L0202 5:12"},
        {head + std::string("run: {for: 0 s, seed: -1}\n"), "L0308 4:12; L0305 4:23"},
        {head + std::string("run: {until: c.odd}\n"), "L0202 4:6"},
    }));
    INFO(row.text);
    CHECK(mistakes(row.text) == row.mistakes);
}

TEST_CASE("program: kinds and versions of files") {
    CHECK(mistakes("title: x\nblocks: {}\n") == "L0211 1:1");
    CHECK(mistakes("lineshaft: 2\nbloks: {}\n") == "L0211 1:12");
    CHECK(mistakes("title: x\nlineshaft_study: 1\n") == "L0211 2:1");
    CHECK(mistakes("lineshaft_controller: 1\n") == "L0211 1:1");
}

TEST_CASE("program: an unknown parameter is one mistake") {
    CHECK(mistakes(std::string(head) + "run: {for: $long}\n") == "L0207 4:12");
}

TEST_CASE("program: tasks of the controller may be changed by the program") {
    const Folder folder;
    folder.write(
        "c.yaml",
        "lineshaft_controller: 1\ntasks:\n  t: {every: 5 ms, jitter: 2 ms}\n  u: {every: 1 s}\n");
    const std::string rest = "blocks: {c: {type: counter, task: t}}\nrun: {for: 1 s}\n";
    const auto load = [&](const std::string& tasks) {
        const std::string path =
            folder.write("p.yaml", "lineshaft: 1\ncontroller: c.yaml\n" + tasks + rest);
        Read result;
        result.program = read_program(read_source(path, result.out), {}, result.out);
        return result;
    };
    const auto [program, out] = load("tasks: {t: {priority: 3}}\n");
    CHECK(out.empty());
    REQUIRE(program.tasks.size() == 2);
    CHECK(program.tasks[0].every == 5'000'000);
    CHECK(program.tasks[0].priority == 3);
    CHECK(program.tasks_known);
    const auto [wrong, mistake] = load("tasks: {t: {every: 1 ms}}\n");
    REQUIRE(mistake.list().size() == 1);
    CHECK(mistake.list()[0].code == "L0305");
}

TEST_CASE("program: files of the project only") {
    const Folder folder;
    fs::create_directories(folder.path() / "project/config");
    fs::create_directories(folder.path() / "project/programs/deep");
    const std::string from = folder.write("project/programs/deep/p.yaml", "");
    folder.write("project/config/c.yaml", "");
    const std::string other = folder.write("other/c.yaml", "");
    Diagnostics out;
    CHECK(resolve_path("../../config/c.yaml", from, {}, {}, out).has_value());
    CHECK(resolve_path("missing.yaml", from, {}, {}, out).has_value());
    CHECK(out.empty());
    for (const std::string& path : {std::string("../../../other/c.yaml"), other}) {
        CHECK_FALSE(resolve_path(path, from, {}, {}, out).has_value());
        CHECK(resolve_path(path, from, {(folder.path() / "other").string()}, {}, out).has_value());
    }
    REQUIRE(out.list().size() == 2);
    CHECK(out.list()[0].code == "L0002");
}

TEST_CASE("program: a link does not lead out of the project") {
    const Folder folder;
    fs::create_directories(folder.path() / "project/config");
    const std::string from = folder.write("project/p.yaml", "");
    folder.write("secret.yaml", "");
    fs::create_symlink(folder.path() / "secret.yaml", folder.path() / "project/c.yaml");
    Diagnostics out;
    CHECK_FALSE(resolve_path("c.yaml", from, {}, {}, out).has_value());
}

TEST_CASE("program: a link in the middle of a path does not lead out of the project") {
    const Folder folder;
    fs::create_directories(folder.path() / "project/config/deep");
    const std::string from = folder.write("project/p.yaml", "");
    folder.write("secret.yaml", "");
    fs::create_directory_symlink("config/deep", folder.path() / "project/link");
    Diagnostics out;
    CHECK_FALSE(resolve_path("link/../../../secret.yaml", from, {}, {}, out).has_value());
    // The folder above config/deep, as the system has it, not the one above link.
    CHECK(resolve_path("link/../../secret.yaml", from, {}, {}, out).has_value());
    CHECK_FALSE(fs::exists(folder.path() / "project/link/../../secret.yaml"));
}

TEST_CASE("program: a path that cannot be followed is told") {
    const Folder folder;
    const std::string from = folder.write("p.yaml", "");
    fs::create_symlink("loop.yaml", folder.path() / "loop.yaml");
    Diagnostics out;
    CHECK_FALSE(resolve_path("loop.yaml", from, {}, {}, out).has_value());
    CHECK_FALSE(resolve_path(std::string(300, 'x'), from, {}, {}, out).has_value());
    REQUIRE(out.list().size() == 2);
    CHECK(out.list()[0].code == "L0001");
    CHECK(out.list()[1].code == "L0001");
}
