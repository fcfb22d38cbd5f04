#include <algorithm>
#include <filesystem>
#include <thread>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "blocks/catalog.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/st/coverage.hpp"
#include "runtime/st/test_sources.hpp"
#include "runtime/st/test_suite.hpp"
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
    std::string junit, coverage, only;
    std::vector<std::string> include_dirs, sources;
    bool strict = false;
};

/// The file itself, or every program, study and file of tests below a folder, sorted.
std::vector<std::string> find_files(const std::string& path) {
    if (!fs::is_directory(path)) return {path};
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
        const bool is_yaml = entry.path().extension() == ".yaml";
        if (!(is_yaml || is_structured_text(entry.path())) || !entry.is_regular_file()) continue;
        Diagnostics unread;
        const auto file = read_source(entry.path().string(), unread);
        if (!file) continue;
        if (is_yaml ? is_study(*file) || is_program(*file) : st::is_test_file(file))
            files.push_back(entry.path().lexically_normal().string());
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

/// The file itself, or all Structured Text of a folder: what lies in it, and if `below` in those
/// below it.
void add_sources(st::SourcePool& pool, const std::string& path, bool below) {
    std::vector<std::string> files;
    const auto take = [&](const fs::directory_entry& entry) {
        if (entry.is_regular_file() && is_structured_text(entry.path()))
            files.push_back(entry.path().lexically_normal().string());
    };
    constexpr auto options = fs::directory_options::skip_permission_denied;
    if (!fs::is_directory(path))
        files.push_back(path);
    else if (below)
        for (const auto& entry : fs::recursive_directory_iterator(path, options)) take(entry);
    else
        for (const auto& entry : fs::directory_iterator(path, options)) take(entry);
    std::ranges::sort(files);
    Diagnostics unread;
    for (const std::string& file : files)
        if (const auto source = read_source(file, unread)) pool.add(source);
}

/// Of a folder what lies below it; of a file its folder, and the one around that if it is `tests`.
st::SourcePool sources_for(const std::string& path, const std::vector<std::string>& more) {
    st::SourcePool pool;
    for (const std::string& source : more) add_sources(pool, source, true);
    if (fs::is_directory(path)) {
        add_sources(pool, path, true);
    } else if (is_structured_text(path)) {
        const fs::path folder = fs::path(path).parent_path();
        const std::string name = folder.filename().string();
        add_sources(pool, folder.empty() ? "." : folder.string(), false);
        if (name == "tests" || name == "test")
            add_sources(pool, (folder / "..").lexically_normal().string(), false);
    }
    return pool;
}

std::string failure_text(const st::TestResult& result) {
    if (result.failure.empty()) return {};
    std::string text =
        fmt::format("{}:{}: {}", result.mark.file->path, result.mark.line, result.failure);
    for (std::size_t i = 0; i < result.calls.size(); ++i)
        text += (i == 0 ? " in " : ", called by ") + result.calls[i];
    return text;
}

std::vector<SuiteEntry> test_structured_text(const std::shared_ptr<const SourceFile>& file,
                                             const st::SourcePool& pool, const std::string& only) {
    Diagnostics out;
    const Catalog catalog = standard_blocks();
    if (!st::is_test_file(file))
        out.add("L0904", {file, 0, 0, 1}, "there is no TEST in this file",
                "write TEST 'text' ... END_TEST");
    std::optional<st::TestSuite> suite;
    if (out.empty()) suite = st::compile_tests(file, pool.needed_by(file), catalog, out);
    if (!suite) return {{file->path, 0, out.render(), true}};
    std::vector<SuiteEntry> entries;
    for (std::size_t i = 0; i < suite->tests().size() && !interrupt_requested; ++i) {
        const st::Test& test = suite->tests()[i];
        if (test.name.find(only) == std::string::npos) continue;
        const double start = wall_seconds();
        const st::TestResult result = suite->run(i);
        entries.push_back({.name = test.name,
                           .wall_seconds = wall_seconds() - start,
                           .failure = failure_text(result),
                           .error = result.is_fault,
                           .file = file->path,
                           .line = static_cast<int>(test.mark.line)});
    }
    return entries;
}

std::vector<SuiteEntry> test(const std::string& path, const st::SourcePool& pool,
                             const TestCommand& command) {
    const LoadOptions options{.settings = {}, .include_dirs = command.include_dirs};
    Diagnostics out;
    const auto file = read_source(path, out);
    if (!file) return {{path, 0, out.render(), true}};
    if (is_structured_text(path)) return test_structured_text(file, pool, command.only);
    if (!command.only.empty()) return {};
    return {is_study(*file) ? test_study(file, options)
                            : test_program(path, options, command.strict)};
}

void print(const SuiteEntry& entry) {
    fmt::print("{}  {}{}{} ({:.2f} s)\n", entry.failure.empty() ? "ok    " : "FAILED", entry.file,
               entry.file.empty() ? "" : ": ", entry.name, entry.wall_seconds);
    if (!entry.failure.empty()) fmt::print("        {}\n", entry.failure);
    std::fflush(stdout);
    fmt::print(stderr, "{}", entry.warnings);
}

/// False, and reported, when it cannot be written.
bool write(const std::string& path, const std::string& text) {
    if (path.empty()) return true;
    OutputFile file(path);
    file.write(text);
    const bool written = file.commit();
    if (!written) spdlog::error("{}", file.error());
    return written;
}

Exit execute(const TestCommand& command) {
    if (!command.coverage.empty()) st::start_coverage();
    std::vector<SuiteEntry> entries;
    for (const std::string& path : command.paths) {
        const st::SourcePool pool = sources_for(path, command.sources);
        for (const std::string& file : find_files(path)) {
            for (SuiteEntry& entry : test(file, pool, command)) {
                if (!interrupt_requested) print(entry);
                entries.push_back(std::move(entry));
            }
            if (interrupt_requested) return Exit::interrupted;
        }
    }
    const auto failed =
        std::ranges::count_if(entries, [](const SuiteEntry& e) { return !e.failure.empty(); });
    fmt::print("{} of {} passed\n", static_cast<std::ptrdiff_t>(entries.size()) - failed,
               entries.size());
    const bool written =
        write(command.junit, junit_xml(entries)) && write(command.coverage, st::lcov_text());
    if (!written) return Exit::fault;
    if (entries.empty()) spdlog::error("no program, no study and no TEST was found");
    if (entries.empty()) return Exit::wrong;
    return failed == 0 ? Exit::fine : Exit::failed;
}

}  // namespace

void add_test(CLI::App& app, Exit& result) {
    auto command = std::make_shared<TestCommand>();
    CLI::App* sub = app.add_subcommand(
        "test", "Run programs, studies and TESTs of Structured Text as a test suite");
    sub->add_option("paths", command->paths, "Files, or folders to search")->required();
    sub->add_option("--junit", command->junit, "Write a JUnit report, too")->type_name("OUT.xml");
    sub->add_option("--include-dir", command->include_dirs, "Allow files below this folder, too")
        ->type_name("DIR");
    sub->add_option("--source", command->sources,
                    "Look for what TESTs test in this file or folder, too")
        ->type_name("PATH");
    sub->add_option("--only", command->only, "Run only TESTs with this in their name")
        ->type_name("TEXT");
    sub->add_option("--coverage", command->coverage,
                    "Write which lines and branches of Structured Text all of it executed, for "
                    "lcov and genhtml")
        ->type_name("FILE.info");
    sub->footer(
        "A file of Structured Text with a TEST is a file of tests. It sees those files of the\n"
        "folder that declare what it names, x.st first for test_x.st. programs/README.md says "
        "more.");
    add_strict(*sub, command->strict);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
