#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <thread>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "blocks/catalog.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/study/merge.hpp"
#include "runtime/study/study_reader.hpp"
#include "runtime/trace/folder_locks.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/study_table.hpp"

namespace lineshaft {

namespace {

struct StudyCommand {
    CommonOptions common;
    std::string plan, output, chunk, merge, report;
    CaseTraces traces;
    bool resume = false, wide = false;
    unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
};

/// `3/8`.
std::optional<Chunk> parse_chunk(const std::string& text, Diagnostics& out) {
    Chunk chunk;
    int end = 0;
    const int read = std::sscanf(text.c_str(), "%ld/%ld%n", &chunk.index, &chunk.of, &end);
    const bool whole = read == 2 && static_cast<std::size_t>(end) == text.size();
    if (whole && chunk.index >= 1 && chunk.index <= chunk.of && chunk.of <= most_runs) return chunk;
    out.add(code::unusable_option, {}, fmt::format("'{}' is not a chunk", text),
            fmt::format("write --chunk 3/8, the third of eight, at most {}", most_runs));
    return {};
}

/// A study on its way: what is done goes into the report and, if one is wanted, the file.
class StudyRun {
  public:
    StudyRun(const StudyCommand& command, const Study& study, std::optional<Chunk> chunk)
        : command_(command),
          study_(study),
          range_(chunk.value_or(Chunk{}).range(study.case_count())),
          builder_(study, command.common.json || !command.report.empty()),
          csv_(study) {
        if (!command.output.empty()) file_.emplace(command.output, study, csv_, chunk);
    }

    Exit simulate(const Catalog& catalog);
    Exit merge();

  private:
    bool begin(std::map<std::int64_t, CaseResult>& late);
    bool take(const CaseResult& result);
    Exit finish(bool interrupted);
    Exit tell_stopped(Exit exit) const;
    void print(const StudyReport& report) const;

    const StudyCommand& command_;
    const Study& study_;
    CaseRange range_;
    ReportBuilder builder_;
    StudyCsv csv_;
    std::optional<ResultFile> file_;
    std::int64_t taken_ = 0;  ///< from what was there already
    std::string trace_error_;
};

bool StudyRun::take(const CaseResult& result) {
    builder_.add(result);
    return !file_ || file_->add(result);
}

bool StudyRun::begin(std::map<std::int64_t, CaseResult>& late) {
    if (!file_) return true;
    const auto known = [this](const CaseResult& result) {
        builder_.add(result);
        ++taken_;
    };
    return command_.resume ? file_->resume(known, late) : file_->begin();
}

Exit StudyRun::simulate(const Catalog& catalog) {
    if (command_.resume && file_->take_whole([this](const CaseResult& r) { builder_.add(r); })) {
        if (!command_.common.quiet)
            spdlog::info("'{}' is whole already: nothing to run", command_.output);
        file_.reset();
        return finish(false);
    }
    std::map<std::int64_t, CaseResult> late;
    if (!begin(late)) return tell_stopped(Exit::fault);
    if (taken_ > 0 && !command_.common.quiet)
        spdlog::info("goes on after {} of {} cases", taken_, range_.count());
    ProgressLine line(command_.common.quiet || command_.common.json);
    std::int64_t done = taken_;
    const auto next = [&](const CaseResult& result) {
        trace_error_ = result.output_error;
        if (!trace_error_.empty()) return false;
        ++done;
        line.show([&](double elapsed) {
            const double rate = static_cast<double>(done - taken_) / elapsed;
            return fmt::format("{} of {} cases, {:.1f} a second, {:.0f} s left", done,
                               range_.count(), rate,
                               static_cast<double>(range_.count() - done) / rate);
        });
        return take(result);
    };
    auto waiting = run_cases(study_, catalog, {range_.first + taken_, range_.last},
                             {.jobs = command_.jobs,
                              .interrupt = &interrupt_requested,
                              .traces = command_.traces,
                              .known = &late},
                             next);
    if (file_ && !file_->error().empty()) return tell_stopped(Exit::fault);
    const bool interrupted = done < range_.count();
    if (file_ && interrupted) {
        std::erase_if(waiting, [](const auto& item) { return !item.second.output_error.empty(); });
        late.insert(waiting.begin(), waiting.end());
        file_->keep_late(late);
    }
    if (!trace_error_.empty()) return tell_stopped(Exit::fault);
    return finish(interrupted);
}

Exit StudyRun::merge() {
    Diagnostics out;
    const auto chunks = find_chunks(command_.merge, study_, csv_, out);
    check_outputs({command_.output}, chunks, out);
    if (!out.empty()) return report(out, command_.common.json);
    bool good = file_->begin();
    for (const std::string& path : chunks) {
        ResultReader reader(path, csv_);
        for (auto row = reader.next(); good && row; row = reader.next()) good = take(*row);
    }
    return good ? finish(false) : tell_stopped(Exit::fault);
}

Exit StudyRun::finish(bool interrupted) {
    const std::string& traces = command_.traces.folder;
    if (!traces.empty() && !flush_file_system(traces)) {
        spdlog::error("cannot flush the traces in '{}': {}", traces, std::strerror(errno));
        return tell_stopped(Exit::fault);
    }
    if (file_ && !interrupted && !file_->commit()) return tell_stopped(Exit::fault);
    StudyReport result = builder_.finish(interrupted, !command_.chunk.empty());
    result.wall_seconds = wall_seconds();
    print(result);
    if (interrupted) return tell_stopped(Exit::interrupted);
    if (!command_.report.empty()) {
        const Exit written = report_study(study_json(study_, result), command_.report,
                                          command_.common.quiet || command_.common.json);
        if (written != Exit::fine) return written;
    }
    return result.ok() ? Exit::fine : Exit::failed;
}

Exit StudyRun::tell_stopped(Exit exit) const {
    if (!trace_error_.empty()) spdlog::error("{}", trace_error_);
    if (!file_) return exit;
    if (!file_->error().empty()) spdlog::error("{}", file_->error());
    if (file_->rows() > 0)
        spdlog::info("{} of {} cases are in '{}.part'; --resume goes on", file_->rows(),
                     range_.count(), command_.output);
    return exit;
}

void StudyRun::print(const StudyReport& result) const {
    if (command_.common.json) return fmt::print("{}\n", study_json(study_, result).dump(2));
    if (command_.common.quiet && !(command_.output.empty() && command_.report.empty())) return;
    fmt::print("{}",
               study_table(study_, result, command_.wide ? TableStyle::wide : TableStyle::fitting));
    if (command_.common.quiet) return;
    fmt::print("\n{} cases", result.cases);
    if (result.failed > 0) fmt::print(", {} failed", result.failed);
    fmt::print(", machine time {:.1f} s", result.machine_seconds);
    if (taken_ == 0 && command_.merge.empty() && result.wall_seconds > 0)
        fmt::print(", wall time {:.2f} s, {:.0f} times faster than the clock", result.wall_seconds,
                   result.machine_seconds / result.wall_seconds);
    fmt::print("\n");
    if (file_ && !result.interrupted) fmt::print("results: {}\n", command_.output);
}

std::optional<Chunk> check_options(const StudyCommand& command, Diagnostics& out) {
    if (command.output.empty() &&
        (command.resume || !command.chunk.empty() || !command.merge.empty()))
        out.add(code::results_without_file, {}, "there is no file for the results",
                "say -o FILE.csv");
    return command.chunk.empty() ? std::nullopt : parse_chunk(command.chunk, out);
}

/// L0503 for a program that records nothing; the folder is made.
void prepare_traces(const StudyCommand& command, const Study& study, Diagnostics& out) {
    const std::string& folder = command.traces.folder;
    if (folder.empty()) return;
    if (!study.traced)
        out.add(code::no_trace_to_write, {study.file, 0, 0, 1},
                fmt::format("'{}' has no 'trace:' to write to {}", study.program, folder),
                "say under 'trace:' which task and signals to record");
    std::error_code failed;
    if (out.empty()) std::filesystem::create_directories(folder, failed);
    if (failed)
        out.add(code::file_cannot_be_read, {},
                fmt::format("cannot make '{}': {}", folder, failed.message()));
}

Exit execute(const StudyCommand& command) {
    Diagnostics out;
    const LoadOptions options = command.common.load_options(out);
    const auto chunk = check_options(command, out);
    const Catalog catalog = standard_blocks();
    const auto file = read_source(command.plan, out);
    const bool part = chunk || !command.merge.empty();
    Study study;
    if (file)
        study =
            read_study(file, options, catalog, out, part ? StudyCheck::groups : StudyCheck::values);
    check_outputs({command.output, command.report}, {study.program}, out);
    if (out.empty()) prepare_traces(command, study, out);
    if (!out.empty()) return report(out, command.common.json);
    StudyRun run(command, study, chunk);
    return command.merge.empty() ? run.simulate(catalog) : run.merge();
}

}  // namespace

void add_study(CLI::App& app, Exit& result) {
    auto command = std::make_shared<StudyCommand>();
    CLI::App* sub =
        app.add_subcommand("study", "Run a program's cases; print the paper's figures beside ours");
    sub->add_option("plan", command->plan, "The study, a YAML file")->required();
    sub->add_option("-o,--output", command->output,
                    "Write a row a case to this CSV file: settings, compared signals, outcome")
        ->type_name("FILE.csv");
    sub->add_option("-j,--jobs", command->jobs, "Runs side by side")
        ->check(CLI::Range(1u, 1024u))
        ->capture_default_str();
    auto* resume = sub->add_flag("--resume", command->resume,
                                 "Go on where an interrupted study stopped writing to FILE.csv");
    auto* chunk = sub->add_option("--chunk", command->chunk, "Run one slice of the cases only: 3/8")
                      ->type_name("I/N");
    sub->add_option("--merge", command->merge,
                    "Run nothing: put the chunks in this folder together in FILE.csv")
        ->type_name("DIR")
        ->excludes(chunk)
        ->excludes(resume);
    auto* traces = sub->add_option("--traces", command->traces.folder,
                                   "Write each case's trace into this folder, named by the case")
                       ->type_name("DIR")
                       ->excludes("--merge");
    const std::map<std::string, bool> which{{"all", false}, {"failed", true}};
    sub->add_option("--traces-of", command->traces.of_failed, "all cases, or failed ones only")
        ->transform(one_of(which).description("all|failed"))
        ->needs(traces);
    sub->add_option("--report", command->report,
                    "Write a page, too: tables, and the traces of --traces laid over each other")
        ->type_name("FILE.html");
    sub->add_flag("--wide", command->wide, "Print a row a case, a column a signal");
    command->common.add_to(*sub);
    sub->footer(
        "--chunk I/N -o parts/part_I.csv for every I, anywhere and in any order, then\n"
        "--merge parts -o FILE.csv: the same bytes as one run. tools/slurm does it on a cluster.");
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
