#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <map>
#include <mutex>
#include <thread>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "runtime/run/side_by_side.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/library/coverage.hpp"
#include "runtime/trace/output_file.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/test_files.hpp"

namespace lineshaft {

namespace {

constexpr const char* test_help =
    "A program passes when its expectations hold, a study when its bounds and claims do, a fit\n"
    "when what it finds is within its bounds. A file of Structured Text with a TEST is a file of\n"
    "tests: it sees those files of the folder that declare what it names, x.st first for\n"
    "test_x.st. The answer stands in the order of the files, however many run side by side. What\n"
    "is marked 'slow: true' is skipped, and named at the end.\n"
    "lineshaft explain tests says more.";

struct TestCommand {
    std::vector<std::string> paths, sources;
    std::string junit, coverage, filter;
    TestOptions options;
    unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
    bool list = false, fail_fast = false;
};

void print(const SuiteEntry& entry) {
    if (!entry.skipped.empty()) {
        fmt::print("skipped {}: {}\n", entry.name, entry.skipped);
        return;
    }
    fmt::print("{}  {}{}{} ({:.2f} s)\n", entry.failures.empty() ? "ok    " : "FAILED", entry.file,
               entry.file.empty() ? "" : ": ", entry.name, entry.wall_seconds);
    for (const std::string& failure : entry.failures) fmt::print("        {}\n", failure);
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

/// Runs files side by side and prints what came of them in their order.
class Suite {
  public:
    Suite(const std::vector<TestFile>& files, const TestCommand& command)
        : files_(files), command_(command), results_(files.size()) {}

    std::vector<SuiteEntry> run() {
        const std::jthread telling([this](const std::stop_token& stop) { keep_telling(stop); });
        side_by_side(
            std::min<std::int64_t>(command_.jobs, std::ssize(files_)), [this] { work(); },
            [this] { stopped_ = true; });
        return std::move(entries_);
    }

  private:
    void work() {
        for (std::size_t i = 0; (i = next_++) < files_.size() && !stopped_;) {
            TestOptions options = command_.options;
            options.jobs = cores_for(i);
            options.at_work = [this, i](const std::string& suite) { go_on_with(i, suite); };
            begun(i);
            auto entries = run_tests(files_[i], options);
            if (interrupt_requested) return;
            done(i, std::move(entries));
        }
    }

    /// The last files share the cores that no other file needs any more.
    unsigned cores_for(std::size_t i) const {
        const auto left = static_cast<unsigned>(files_.size() - i);
        return std::max(1u, std::thread::hardware_concurrency() / std::min(left, command_.jobs));
    }

    void begun(std::size_t i) {
        const std::lock_guard lock(mutex_);
        at_work_[i] = {wall_seconds(), {}};
    }

    void go_on_with(std::size_t i, const std::string& suite) {
        const std::lock_guard lock(mutex_);
        at_work_[i].suite = suite;
    }

    /// Rewrites the line of progress until all is done. An interrupt ends what goes on without
    /// looking at it, a scan of a suite or what is being compiled, after a second.
    void keep_telling(const std::stop_token& stop) {
        constexpr std::chrono::milliseconds pause(100);
        std::unique_lock lock(mutex_);
        for (int last = 10; !stop.stop_requested(); last -= interrupt_requested ? 1 : 0) {
            if (last == 0) end_now();
            progress_.show([this](double) { return at_work(); });
            tick_.wait_for(lock, stop, pause, [] { return false; });
        }
    }

    [[noreturn]] void end_now() {
        progress_.clear();
        std::fflush(stdout);
        std::_Exit(static_cast<int>(Exit::interrupted));
    }

    /// `12 of 40 files, at work: a.yaml (35 s), b.plcproj, MAIN.x (2 s)`
    std::string at_work() const {
        std::string text = fmt::format("{} of {} files", finished_, files_.size());
        const char* between = ", at work: ";
        for (const auto& [i, work] : at_work_) {
            text += fmt::format("{}{}{}{} ({:.0f} s)", between, files_[i].path,
                                work.suite.empty() ? "" : ", ", work.suite,
                                wall_seconds() - work.since);
            between = ", ";
        }
        return text;
    }

    void done(std::size_t i, std::vector<SuiteEntry> entries) {
        const std::lock_guard lock(mutex_);
        at_work_.erase(i);
        ++finished_;
        results_[i] = std::move(entries);
        for (; printed_ < files_.size() && results_[printed_]; ++printed_) {
            progress_.clear();
            for (SuiteEntry& entry : *results_[printed_]) {
                if (command_.fail_fast && stopped_) return;
                print(entry);
                stopped_ = stopped_ || (command_.fail_fast && !entry.failures.empty());
                entries_.push_back(std::move(entry));
            }
        }
    }

    const std::vector<TestFile>& files_;
    const TestCommand& command_;
    std::vector<std::optional<std::vector<SuiteEntry>>> results_;
    std::vector<SuiteEntry> entries_;
    ProgressLine progress_{false};
    struct Work {
        double since = 0;  ///< when it began [s]
        std::string suite;
    };
    std::map<std::size_t, Work> at_work_;  ///< by the number of the file
    std::size_t finished_ = 0;
    std::mutex mutex_;
    std::condition_variable_any tick_;
    std::atomic<std::size_t> next_ = 0;
    std::atomic<bool> stopped_ = false;
    std::size_t printed_ = 0;
};

/// L0502 for a filter that is not a regular expression; the folder for traces is made.
bool prepare(TestCommand& command) {
    TestOptions& options = command.options;
    try {
        if (!command.filter.empty()) options.filter.emplace(command.filter);
    } catch (const std::regex_error& error) {
        spdlog::error("--filter: '{}' is not a regular expression: {}", command.filter,
                      error.what());
        return false;
    }
    std::error_code failed;
    if (!options.traces_folder.empty())
        std::filesystem::create_directories(options.traces_folder, failed);
    if (failed)
        spdlog::error("--trace-failed: cannot make '{}': {}", options.traces_folder,
                      failed.message());
    return !failed;
}

/// `inputs` are still to be read. False, and reported, when one would replace what is read.
bool check_files(const TestCommand& command, const std::vector<std::string>& inputs) {
    Diagnostics out;
    check_outputs({command.junit, command.coverage}, inputs, out);
    if (!out.empty()) report(out, false);
    return out.empty();
}

/// False, and reported, when one is not there.
bool are_there(const std::vector<std::string>& paths) {
    std::error_code error;
    const auto is_missing = [&](const auto& path) { return !std::filesystem::exists(path, error); };
    for (const std::string& path : paths)
        if (is_missing(path)) spdlog::error("cannot read '{}': it does not exist", path);
    return std::ranges::none_of(paths, is_missing);
}

/// The folder above the first one with tests that is given, where what nobody declares may be.
/// Empty: all is declared, or sources are given.
std::string folder_to_look_in(const TestCommand& command, const std::vector<SuiteEntry>& entries) {
    const auto is_undeclared = [](const std::string& failure) {
        return failure.find("error[L0904]") != failure.npos;
    };
    const bool lacks = std::ranges::any_of(entries, [&](const SuiteEntry& entry) {
        return entry.error && std::ranges::any_of(entry.failures, is_undeclared);
    });
    if (!lacks || !command.sources.empty()) return {};
    const auto is_of_tests = [](const std::string& path) {
        std::error_code error;
        const std::string name = lower(std::filesystem::path(path).filename().string());
        return name.find("test") != name.npos && std::filesystem::is_directory(path, error);
    };
    const auto first = std::ranges::find_if(command.paths, is_of_tests);
    return first == command.paths.end()
               ? std::string()
               : (std::filesystem::path(*first) / "..").lexically_normal().string();
}

Exit finish(const TestCommand& command, const std::vector<SuiteEntry>& entries) {
    const auto failed =
        std::ranges::count_if(entries, [](const SuiteEntry& e) { return !e.failures.empty(); });
    std::vector<std::string> slow;
    for (const SuiteEntry& e : entries)
        if (!e.skipped.empty() && e.file.empty()) slow.push_back(e.name);
    const auto ran =
        std::ranges::count_if(entries, [](const SuiteEntry& e) { return e.skipped.empty(); });
    fmt::print("{} of {} passed\n", ran - failed, ran);
    if (!slow.empty())
        fmt::print("skipped as slow, --slow runs {}: {}\n", slow.size() == 1 ? "it" : "them",
                   fmt::join(slow, ", "));
    if (const std::string folder = folder_to_look_in(command, entries); !folder.empty())
        fmt::print("what nobody declares may stand above: --source {} looks there, too\n", folder);
    if (!check_files(command, {})) return Exit::wrong;
    const bool written =
        write(command.junit, junit_xml(entries)) && write(command.coverage, st::lcov_text());
    if (!written) return Exit::fault;
    if (entries.empty())
        spdlog::error("no program, study, fit or TEST was found{}",
                      command.filter.empty() ? "" : " that the filter leaves");
    if (entries.empty()) return Exit::wrong;
    return failed == 0 ? Exit::fine : Exit::failed;
}

Exit execute(TestCommand& command) {
    const bool is_ready =
        prepare(command) && are_there(command.paths) && are_there(command.sources);
    if (!is_ready) return Exit::wrong;
    if (!command.coverage.empty()) st::start_coverage();
    std::vector<TestFile> files;
    for (const std::string& path : command.paths)
        for (TestFile& file : find_tests(path, command.sources)) files.push_back(std::move(file));
    if (command.list) {
        for (const TestFile& file : files)
            for (const std::string& name : test_names(file, command.options))
                fmt::print("{}\n", name);
        return Exit::fine;
    }
    std::vector<std::string> paths;
    for (const TestFile& file : files) paths.push_back(file.path);
    if (!check_files(command, paths)) return Exit::wrong;
    const std::vector<SuiteEntry> entries = Suite(files, command).run();
    return interrupt_requested ? Exit::interrupted : finish(command, entries);
}

}  // namespace

void add_test(CLI::App& app, Exit& result) {
    auto command = std::make_shared<TestCommand>();
    CLI::App* sub = app.add_subcommand(
        "test", "Run programs, studies, fits and TESTs of Structured Text as a test suite");
    sub->add_option("paths", command->paths, "Files, or folders to search")->required();
    sub->add_option("-j,--jobs", command->jobs, "Files side by side; as many as there are cores")
        ->check(CLI::Range(1u, 1024u));
    sub->add_option("--filter", command->filter,
                    "Run only what this regular expression finds in FILE, or in 'FILE: NAME' of a "
                    "TEST")
        ->type_name("REGEX");
    sub->add_flag("--slow", command->options.slow,
                  "Run those that are marked 'slow: true', too; one that is named runs anyway");
    sub->add_flag("--list", command->list, "Print the names only");
    sub->add_flag("--fail-fast", command->fail_fast, "End with the first that fails");
    sub->add_option("--trace-failed", command->options.traces_folder,
                    "Write a trace of each program that fails into this folder")
        ->type_name("DIR");
    sub->add_option("--junit", command->junit, "Write a JUnit report, too")->type_name("OUT.xml");
    sub->add_option("--include-dir", command->options.include_dirs,
                    "Allow files below this folder, too")
        ->type_name("DIR");
    add_dialect(*sub);
    sub->add_option("--source", command->sources,
                    "Look for what TESTs test in this file or folder, too")
        ->type_name("PATH");
    sub->add_option("--coverage", command->coverage,
                    "Write which lines and branches of Structured Text all of it executed, for "
                    "lcov and genhtml")
        ->type_name("FILE.info");
    add_native(*sub);
    sub->footer(test_help);
    add_strict(*sub, command->options.strict);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
