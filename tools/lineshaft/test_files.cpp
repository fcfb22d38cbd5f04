#include "tools/lineshaft/test_files.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/core.h>

#include "blocks/catalog.hpp"
#include "runtime/fit/fit.hpp"
#include "runtime/program/whole_project.hpp"
#include "runtime/projects/apax.hpp"
#include "runtime/projects/fixtures.hpp"
#include "runtime/projects/solution.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/entries.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/library/suites.hpp"
#include "runtime/st/library/test_suite.hpp"
#include "runtime/study/report.hpp"
#include "runtime/study/study_reader.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/fit_table.hpp"
#include "tools/lineshaft/study_table.hpp"

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

bool is_folder(const fs::path& path) {
    std::error_code unknown;
    return fs::is_directory(path, unknown);
}

bool is_yaml(const fs::path& path) {
    return path.extension() == ".yaml";
}

/// All files below a folder, or in it, of which `wanted` is true, sorted; of a file that file.
template <class Wanted>
std::vector<std::string> files_of(const std::string& path, bool below, Wanted wanted) {
    if (!is_folder(path)) return {path};
    std::vector<std::string> files;
    const auto take = [&](const fs::directory_entry& entry) {
        if (is_file_to_read(entry) && wanted(entry.path()))
            files.push_back(entry.path().lexically_normal().string());
    };
    constexpr auto options = fs::directory_options::skip_permission_denied;
    if (below)
        for (const auto& entry : fs::recursive_directory_iterator(path, options)) take(entry);
    else
        for (const auto& entry : fs::directory_iterator(path, options)) take(entry);
    std::ranges::sort(files);
    return files;
}

bool is_slow(const std::shared_ptr<const SourceFile>& file) {
    Diagnostics unread;
    const auto root = file->has_key("slow:") ? parse_yaml(file, unread) : std::nullopt;
    const Node* slow = root ? root->find("slow") : nullptr;
    return slow && slow->text == "true";
}

projects::Project project_of(const std::string& path) {
    Diagnostics unread;
    return read_project(path, {}, unread);
}

/// Whether some program of another tool's project runs suites of TcUnit.
bool has_suites(const std::string& path) {
    return std::ranges::any_of(project_of(path).sources, st::calls_suites);
}

/// A file of another tool that is read as sources.
bool is_of_project(const fs::path& path) {
    return projects::is_source(path) && !is_structured_text(path);
}

/// A program, a study or a fit; or whoever runs it tells why it cannot be read.
bool is_form(const fs::path& path) {
    if (!is_yaml(path)) return false;
    Diagnostics unread;
    const auto file = read_source(path.string(), unread);
    if (!file) return unread.list().front().code == code::file_cannot_be_read;
    return is_study(*file) || is_fit(*file) || is_program(*file);
}

bool can_be_tested(const fs::path& path) {
    if (!is_structured_text(path)) return is_form(path);
    Diagnostics unread;
    const auto file = read_source(path.string(), unread);
    return !file || has_tests(file) || st::calls_suites(file);
}

void add_sources(st::SourcePool& pool, const std::string& path, bool below) {
    Diagnostics unread;
    for (const std::string& file : files_of(path, below, projects::is_source))
        for (const auto& source : read_project(file, {}, unread).sources) pool.add(source);
}

/// A project's own sources, and those of its libraries, which are looked for in `folders`.
std::shared_ptr<const st::SourcePool> sources_of_project(const std::string& path,
                                                         const std::vector<std::string>& folders) {
    auto pool = std::make_shared<st::SourcePool>();
    Diagnostics unread;
    for (const WholeProject& project : read_projects(path, folders, unread))
        for (const auto& source : project.project.sources) pool->add(source);
    pool->leave_out_tcunit();
    return pool;
}

bool is_plcproj(const fs::path& path) {
    return path.extension() == ".plcproj";
}

std::shared_ptr<const st::SourcePool> sources_for(const std::string& path,
                                                  const std::vector<std::string>& more) {
    if (is_plcproj(path)) return sources_of_project(path, more);
    auto pool = std::make_shared<st::SourcePool>();
    for (const std::string& source : more) add_sources(*pool, source, true);
    const fs::path package = is_of_project(path) ? fs::path() : projects::package_of(path);
    if (!package.empty()) {
        add_sources(*pool, package.string(), true);
        for (const fs::path& beside : projects::packages_beside(package))
            add_sources(*pool, (beside / "src").string(), true);
    } else if (is_folder(path)) {
        add_sources(*pool, path, true);
    } else if (is_of_project(path)) {
        for (const auto& source : project_of(path).sources) pool->add(source);
        add_sources(*pool, fs::path(path).parent_path().string(), true);
    } else if (is_structured_text(path)) {
        const fs::path folder = fs::path(path).parent_path();
        const std::string name = folder.filename().string();
        add_sources(*pool, folder.empty() ? "." : folder.string(), false);
        if (name == "tests" || name == "test")
            add_sources(*pool, (folder / "..").lexically_normal().string(), false);
    }
    pool->leave_out_tcunit();
    return pool;
}

std::optional<st::TestSuite> compile_text(const TestFile& tests,
                                          const std::shared_ptr<const SourceFile>& text,
                                          Diagnostics& out) {
    if (!st::is_test_file(text))
        out.add(code::not_declared, {text, 0, 0, 1}, "there is no TEST in this file",
                "write TEST 'text' ... END_TEST");
    if (!out.empty()) return {};
    return st::compile_tests(text, tests.sources->needed_by(text), standard_blocks(), out);
}

bool is_suites(const std::string& path) {
    return is_of_project(path) || (is_structured_text(path) && has_suites(path));
}

SuiteEntry wrong(const std::string& name, const std::string& messages) {
    return {.name = name, .failures = {messages}, .error = true};
}

SuiteEntry test_study(const std::shared_ptr<const SourceFile>& file, const TestOptions& options) {
    Diagnostics out;
    const Catalog catalog = standard_blocks();
    const Study study =
        read_study(file, {.settings = {}, .include_dirs = options.include_dirs}, catalog, out);
    if (!out.empty()) return wrong(file->path, out.render());
    const StudyReport report = run(
        study, catalog, {.jobs = options.jobs, .interrupt = &interrupt_requested, .progress = {}});
    SuiteEntry entry{.name = file->path,
                     .wall_seconds = report.wall_seconds,
                     .failures = {},
                     .error = !report.faults.empty(),
                     .repeat = "lineshaft study " + file->path};
    if (entry.error)
        entry.failures.push_back(report.faults.front());
    else if (!report.deviations.empty())
        entry.failures = report.deviations;
    else if (!report.ok())
        entry.failures.push_back(first_failure(report));
    return entry;
}

SuiteEntry test_fit(const std::shared_ptr<const SourceFile>& file, const TestOptions& options) {
    Diagnostics out;
    const Catalog catalog = standard_blocks();
    const FitPlan plan =
        read_fit(file, {.settings = {}, .include_dirs = options.include_dirs}, catalog, out);
    if (!out.empty()) return wrong(file->path, out.render());
    const FitReport report =
        run(plan, catalog, {.jobs = options.jobs, .interrupt = &interrupt_requested});
    SuiteEntry entry{.name = file->path,
                     .wall_seconds = report.wall_seconds,
                     .failures = report.faults,
                     .error = !report.faults.empty() || report.values.empty(),
                     .repeat = "lineshaft fit " + file->path};
    if (entry.error && entry.failures.empty()) entry.failures = {"no start could begin"};
    if (!entry.error && !report.ok())
        entry.failures = {"a value is outside of its 'within'\n" + fit_table(plan, report)};
    return entry;
}

/// A run is the same each time: so a program that has failed runs once more, traced.
void trace_failed(const std::string& path, const TestOptions& options, SuiteEntry& entry) {
    Diagnostics out;
    auto loaded = load_program(path, {.settings = {}, .include_dirs = options.include_dirs},
                               standard_blocks(), out);
    if (!loaded) return;
    if (loaded->program.traces.empty()) {
        entry.warnings += fmt::format("warning: {} has no 'trace:', so it is not traced\n", path);
        return;
    }
    std::string name = path;
    std::ranges::replace(name, '/', '_');
    const std::string trace =
        (fs::path(options.traces_folder) / fs::path(name).replace_extension(".csv")).string();
    const RunReport report =
        run(*loaded, {.trace_path = trace, .interrupt = &interrupt_requested, .progress = {}});
    if (report.output_error.empty())
        entry.repeat += " --trace " + trace;
    else
        entry.failures.push_back(report.output_error);
}

SuiteEntry test_program(const std::string& path, const TestOptions& options) {
    Diagnostics out;
    auto loaded = load_program(path, {.settings = {}, .include_dirs = options.include_dirs},
                               standard_blocks(), out);
    if (loaded && loaded->program.expectations.empty())
        out.warn(code::test_expects_nothing, {loaded->program.file, 0, 0, 1},
                 "the program expects nothing, so it always passes",
                 "say under 'expect:' what must hold");
    if (options.strict) out.be_strict();
    if (!out.empty()) return wrong(path, out.render());
    const RunReport report =
        run(*loaded, {.trace_path = {}, .interrupt = &interrupt_requested, .progress = {}});
    SuiteEntry entry{.name = path,
                     .wall_seconds = report.wall_seconds,
                     .failures = {},
                     .error = report.faulted(),
                     .warnings = out.render(),
                     .repeat = "lineshaft run " + path};
    if (entry.error) entry.failures.push_back(report.result.message);
    for (const Verdict& verdict : report.verdicts)
        if (!verdict.ok && !(entry.error && verdict.undecided))  // the fault says why
            entry.failures.push_back(verdict.deviation);
    for (const std::string& text : report.never_looked_at) {
        const std::string unseen =
            fmt::format("'{}' is never looked at: its task never scans", text);
        if (options.strict) entry.failures.push_back(unseen);
        if (!options.strict) entry.warnings += fmt::format("warning: {}\n", unseen);
    }
    if (!entry.failures.empty() && !options.traces_folder.empty() && !interrupt_requested)
        trace_failed(path, options, entry);
    return entry;
}

std::string failure_text(const st::TestResult& result) {
    std::string text =
        fmt::format("{}:{}: {}", result.mark.file->path, result.mark.line, result.failure);
    for (std::size_t i = 0; i < result.calls.size(); ++i)
        text += (i == 0 ? " in " : ", called by ") + result.calls[i];
    return text;
}

std::string full_name(const TestFile& file, const st::Test& test) {
    return file.path + ": " + test.name;
}

bool passes(const std::string& name, const TestOptions& options) {
    return !options.filter || std::regex_search(name, *options.filter);
}

std::string cut_text(const Mark& cut) {
    return fmt::format("{}:{}:{}: a text was cut short; declare the STRING longer", cut.file->path,
                       cut.line, cut.column);
}

void run_suite(const TestFile& tests, const st::TestSuite& suite, const TestOptions& options,
               std::vector<SuiteEntry>& entries) {
    for (std::size_t i = 0; i < suite.tests().size() && !interrupt_requested; ++i) {
        const st::Test& test = suite.tests()[i];
        if (!passes(full_name(tests, test), options)) continue;
        const double start = wall_seconds();
        const st::TestResult result = suite.run(i);
        SuiteEntry entry{.name = test.name,
                         .wall_seconds = wall_seconds() - start,
                         .failures = {},
                         .error = result.is_fault,
                         .file = tests.path,
                         .line = static_cast<int>(test.mark.line)};
        if (!result.failure.empty()) entry.failures.push_back(failure_text(result));
        if (result.cut) {
            const std::string cut = cut_text(*result.cut);
            if (options.strict) entry.failures.push_back(cut);
            if (!options.strict) entry.warnings += fmt::format("warning: {}\n", cut);
        }
        entries.push_back(std::move(entry));
    }
}

bool is_program_of(const SourceFile& source, std::string_view name) {
    return st::same_name(source.part, name) ||
           st::same_name(fs::path(source.path).stem().string(), name);
}

bool is_of_suites(const std::shared_ptr<const SourceFile>& source) {
    return lower(source->text).find("fb_testsuite") != std::string::npos;
}

/// Lists of globals of a project that have suites, and what these need.
std::vector<std::shared_ptr<const SourceFile>> lists_of_suites(const TestFile& tests,
                                                               const projects::Project& project) {
    std::vector<std::shared_ptr<const SourceFile>> found;
    for (const auto& source : project.sources) {
        if (lower(source->text).find("var_global") == std::string::npos) continue;
        const auto needed = tests.sources->needed_by(source);
        if (std::ranges::none_of(needed, is_of_suites)) continue;
        found.push_back(source);
        found.insert(found.end(), needed.begin(), needed.end());
    }
    return found;
}

/// Programs that tasks run beside that one, and in whose blocks suites may stand.
std::vector<std::string> programs_beside(const TestFile& tests, const projects::Project& project,
                                         const SourceFile& program) {
    std::vector<std::string> names;
    for (const projects::ProjectTask& task : project.tasks)
        for (const projects::Name& name : task.programs) {
            const auto is_it = [&](const auto& source) {
                return is_program_of(*source, name.text) && st::calls_suites(source);
            };
            const bool is_run =
                is_program_of(program, name.text) || std::ranges::any_of(project.sources, is_it);
            if (!is_run && std::ranges::any_of(tests.sources->needed_by({name.text}), is_of_suites))
                names.push_back(name.text);
        }
    return names;
}

std::vector<SuiteEntry> test_suites(const TestFile& tests, const projects::Project& project,
                                    const std::shared_ptr<const SourceFile>& program,
                                    std::int64_t cycle, const TestOptions& options) {
    Diagnostics out;
    const double start = wall_seconds();
    const std::vector<std::string> beside = programs_beside(tests, project, *program);
    auto sources = tests.sources->needed_by(program);
    for (const auto& more : {tests.sources->needed_by(beside), lists_of_suites(tests, project)})
        for (const auto& source : more) {
            const auto is_it = [&](const auto& known) { return known->is_same_text(*source); };
            if (!is_it(program) && std::ranges::none_of(sources, is_it)) sources.push_back(source);
        }
    const auto ran =
        st::run_suites(program, sources, standard_blocks(), cycle, out,
                       {.interrupt = &interrupt_requested, .at_work = options.at_work}, {}, beside);
    if (!ran) return {wrong(tests.path, out.render())};
    const double each =
        (wall_seconds() - start) / static_cast<double>(std::max<std::size_t>(1, ran->size()));
    std::vector<SuiteEntry> entries;
    for (const st::SuiteTest& test : *ran) {
        const std::string& file = test.test.mark.file->path;
        const std::string printed = fmt::format("{}: {}", file, test.test.name);
        if (!passes(full_name(tests, test.test), options) && !passes(printed, options)) continue;
        SuiteEntry& entry =
            entries.emplace_back(SuiteEntry{.name = test.test.name,
                                            .wall_seconds = each,
                                            .failures = {},
                                            .error = test.result.is_fault,
                                            .file = file,
                                            .line = static_cast<int>(test.test.mark.line)});
        if (test.skipped) entry.skipped = "disabled by its name";
        if (!test.result.failure.empty()) entry.failures.push_back(failure_text(test.result));
    }
    return entries;
}

/// The programs of a file or a project that run suites.
std::vector<SuiteEntry> test_project(const TestFile& tests, const TestOptions& options) {
    constexpr std::int64_t usual_cycle = 10'000'000;  // [ns] of a task of TwinCAT
    const projects::Project project = project_of(tests.path);
    std::vector<SuiteEntry> entries;
    for (const auto& source : project.sources) {
        if (!st::calls_suites(source)) continue;
        std::int64_t cycle = usual_cycle;
        for (const projects::ProjectTask& task : project.tasks)
            for (const projects::Name& name : task.programs)
                if (task.every > 0 && is_program_of(*source, name.text)) cycle = task.every;
        auto found = test_suites(tests, project, source, cycle, options);
        std::ranges::move(found, std::back_inserter(entries));
    }
    if (entries.empty() && tests.is_named && !options.filter)
        entries.push_back(wrong(tests.path, "no program of it runs a suite of TcUnit"));
    return entries;
}

std::vector<SuiteEntry> test_structured_text(const TestFile& tests,
                                             const std::shared_ptr<const SourceFile>& file,
                                             const TestOptions& options) {
    std::vector<SuiteEntry> entries;
    for (const auto& text : texts_of_tests(file)) {
        Diagnostics out;
        if (const auto suite = compile_text(tests, text, out))
            run_suite(tests, *suite, options, entries);
        else
            entries.push_back(wrong(file->path, out.render()));
    }
    return entries;
}

}  // namespace

std::vector<TestFile> find_tests(const std::string& path, const std::vector<std::string>& sources) {
    std::vector<TestFile> tests;
    if (projects::is_solution(path)) {
        std::vector<std::string> folders = sources;
        const std::string own = fs::path(path).parent_path().string();
        folders.push_back(own.empty() ? "." : own);
        for (const std::string& file : projects::plcprojs_of(path))
            if (has_suites(file)) tests.push_back({file, sources_of_project(file, folders), true});
        if (tests.empty()) tests.push_back({path, sources_for(path, sources), true});
        return tests;
    }
    const auto pool = sources_for(path, sources);
    for (const std::string& file : files_of(path, true, can_be_tested))
        tests.push_back({.path = file, .sources = pool, .is_named = file == path});
    if (!is_folder(path)) return tests;
    std::error_code unread;
    std::vector<std::string> folders = sources;
    folders.push_back(path);
    for (const std::string& file : projects::sources_below(path, unread))
        if (is_of_project(file) && has_suites(file))
            tests.push_back({.path = file,
                             .sources = is_plcproj(file) ? sources_of_project(file, folders) : pool,
                             .is_named = false});
    std::ranges::sort(tests, {}, &TestFile::path);
    return tests;
}

bool has_forms(const std::string& folder) {
    return is_folder(folder) && !files_of(folder, true, is_form).empty();
}

std::vector<std::shared_ptr<const SourceFile>> texts_of_tests(
    const std::shared_ptr<const SourceFile>& file) {
    if (!projects::has_fixtures(*file) || st::is_test_file(file)) return {file};
    return projects::tests_of_fixtures(file);
}

bool has_tests(const std::shared_ptr<const SourceFile>& file) {
    return projects::has_fixtures(*file) || st::is_test_file(file);
}

std::vector<st::TestSuite> compile_tests(const TestFile& tests,
                                         const std::shared_ptr<const SourceFile>& file,
                                         Diagnostics& out) {
    std::vector<st::TestSuite> suites;
    for (const auto& text : texts_of_tests(file))
        if (auto suite = compile_text(tests, text, out)) suites.push_back(std::move(*suite));
    return suites;
}

bool runs_suites(const TestFile& tests) {
    return is_suites(tests.path);
}

std::vector<std::string> test_names(const TestFile& file, const TestOptions& options) {
    std::vector<std::string> names;
    if (is_suites(file.path)) {  // which tests there are is known when they ran
        for (const SuiteEntry& entry : run_tests(file, options))
            names.push_back(entry.file.empty() ? entry.name
                                               : fmt::format("{}: {}", file.path, entry.name));
        return names;
    }
    Diagnostics out;
    const auto source = is_structured_text(file.path) ? read_source(file.path, out) : nullptr;
    if (source)
        for (const st::TestSuite& suite : compile_tests(file, source, out))
            for (const st::Test& test : suite.tests()) names.push_back(full_name(file, test));
    if (!source || !out.empty()) names.push_back(file.path);
    std::erase_if(names, [&](const std::string& name) { return !passes(name, options); });
    return names;
}

std::vector<SuiteEntry> run_tests(const TestFile& file, const TestOptions& options) {
    Diagnostics out;
    const auto source = read_source(file.path, out);
    if (!source) return {wrong(file.path, out.render())};
    if (is_suites(file.path)) return test_project(file, options);
    if (is_structured_text(file.path)) return test_structured_text(file, source, options);
    if (!passes(file.path, options)) return {};
    if (!options.slow && !file.is_named && is_slow(source))
        return {{.name = file.path, .skipped = "slow, --slow runs it"}};
    if (is_study(*source)) return {test_study(source, options)};
    if (is_fit(*source)) return {test_fit(source, options)};
    return {test_program(file.path, options)};
}

}  // namespace lineshaft
