#include <algorithm>
#include <filesystem>
#include <thread>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "blocks/catalog.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/study/junit.hpp"
#include "runtime/study/report.hpp"
#include "runtime/study/study_reader.hpp"
#include "runtime/trace/output_file.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/study_table.hpp"

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

struct TestCommand {
    std::vector<std::string> paths;
    std::string junit;
    std::vector<std::string> include_dirs;
    bool strict = false;
};

/// The file itself, or every program and study below a folder, sorted.
std::vector<std::string> find_files(const std::string& path) {
    if (!fs::is_directory(path)) return {path};
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
        if (entry.path().extension() != ".yaml" || !entry.is_regular_file()) continue;
        Diagnostics unread;
        const auto file = read_source(entry.path().string(), unread);
        if (file && (is_study(*file) || is_program(*file))) files.push_back(entry.path().string());
    }
    std::ranges::sort(files);
    return files;
}

SuiteEntry test_study(const std::shared_ptr<const SourceFile>& file, const LoadOptions& options) {
    SuiteEntry entry{.name = file->path};
    Diagnostics out;
    const Catalog catalog = standard_blocks();
    const Study study = read_study(file, options, catalog, out);
    if (!out.empty()) return {file->path, 0, out.render(), true};
    const StudyReport report = run(study, catalog,
                                   {.jobs = std::max(1u, std::thread::hardware_concurrency()),
                                    .interrupt = &interrupt_requested,
                                    .progress = {}});
    entry.wall_seconds = report.wall_seconds;
    entry.error = !report.faults.empty();
    if (entry.error)
        entry.failure = report.faults.front();
    else if (!report.deviations.empty())
        entry.failure = report.deviations.front();
    else if (!report.ok())
        entry.failure = first_failure(report);
    return entry;
}

SuiteEntry test_program(const std::string& path, const LoadOptions& options, bool strict) {
    SuiteEntry entry{.name = path};
    Diagnostics out;
    auto loaded = load_program(path, options, standard_blocks(), out);
    if (loaded && loaded->program.expectations.empty())
        out.warn("L0804", {loaded->program.file, 0, 0, 1},
                 "the program expects nothing, so it always passes",
                 "say under 'expect:' what must hold");
    if (strict) out.be_strict();
    if (!out.empty()) return {path, 0, out.render(), true};
    entry.warnings = out.render();
    const RunReport report =
        run(*loaded, {.trace_path = {}, .interrupt = &interrupt_requested, .progress = {}});
    entry.wall_seconds = report.wall_seconds;
    entry.error = report.faulted();
    if (entry.error) entry.failure = report.result.message;
    for (const Verdict& verdict : report.verdicts)
        if (entry.failure.empty() && !verdict.ok) entry.failure = verdict.deviation;
    for (const std::string& text : report.never_looked_at) {
        const std::string unseen =
            fmt::format("'{}' is never looked at: its task never scans", text);
        if (strict && entry.failure.empty()) entry.failure = unseen;
        if (!strict) entry.warnings += fmt::format("warning: {}\n", unseen);
    }
    return entry;
}

SuiteEntry test(const std::string& path, const LoadOptions& options, bool strict) {
    Diagnostics out;
    const auto file = read_source(path, out);
    if (!file) return {path, 0, out.render(), true};
    return is_study(*file) ? test_study(file, options) : test_program(path, options, strict);
}

Exit execute(const TestCommand& command) {
    std::vector<SuiteEntry> entries;
    for (const std::string& path : command.paths) {
        for (const std::string& file : find_files(path)) {
            entries.push_back(
                test(file, {.settings = {}, .include_dirs = command.include_dirs}, command.strict));
            if (interrupt_requested) return Exit::interrupted;
            const SuiteEntry& entry = entries.back();
            fmt::print("{}  {} ({:.2f} s)\n", entry.failure.empty() ? "ok    " : "FAILED",
                       entry.name, entry.wall_seconds);
            if (!entry.failure.empty()) fmt::print("        {}\n", entry.failure);
            std::fflush(stdout);
            fmt::print(stderr, "{}", entry.warnings);
        }
    }
    const auto failed =
        std::ranges::count_if(entries, [](const SuiteEntry& e) { return !e.failure.empty(); });
    fmt::print("{} of {} passed\n", static_cast<std::ptrdiff_t>(entries.size()) - failed,
               entries.size());
    if (!command.junit.empty()) {
        OutputFile xml(command.junit);
        xml.write(junit_xml(entries));
        if (!xml.commit()) {
            spdlog::error("{}", xml.error());
            return Exit::fault;
        }
    }
    if (entries.empty()) spdlog::error("no program and no study was found");
    if (entries.empty()) return Exit::wrong;
    return failed == 0 ? Exit::fine : Exit::failed;
}

}  // namespace

void add_test(CLI::App& app, Exit& result) {
    auto command = std::make_shared<TestCommand>();
    CLI::App* sub = app.add_subcommand("test", "Run programs and studies as a test suite");
    sub->add_option("paths", command->paths, "Files, or folders to search")->required();
    sub->add_option("--junit", command->junit, "Write a JUnit report, too")->type_name("OUT.xml");
    sub->add_option("--include-dir", command->include_dirs, "Allow files below this folder, too")
        ->type_name("DIR");
    add_strict(*sub, command->strict);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
