#include "runtime/run/single_run.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <deque>

#include <fmt/format.h>

#include "runtime/restart/checkpoint.hpp"
#include "runtime/restart/retain.hpp"
#include "runtime/run/origin.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/st/library/library.hpp"
#include "runtime/trace/event_writer.hpp"
#include "runtime/trace/pulse_writer.hpp"
#include "runtime/trace/trace_files.hpp"

namespace lineshaft {

std::optional<Loaded> load_program(const std::string& path, const LoadOptions& options,
                                   const Catalog& catalog, Diagnostics& out,
                                   CompiledSources* sources) {
    const auto file = options.files ? options.files->source(path, out) : read_source(path, out);
    if (!file) return {};
    Loaded loaded{.program = read_program(file, options, out), .linked = {}};
    auto kinds = sources ? sources->kinds(loaded.program, catalog) : nullptr;
    loaded.linked = link(loaded.program, catalog, out, std::move(kinds));
    if (!out.empty()) return {};
    return loaded;
}

bool RunReport::expectations_hold() const {
    return std::ranges::all_of(verdicts, &Verdict::ok);
}

namespace {

/// Tells two, one after the other.
class BothSinks final : public EventSink {
  public:
    BothSinks(EventSink* first, EventSink* second) : first_(first), second_(second) {}

    void happened(const RunEvent& event) override {
        if (first_) first_->happened(event);
        if (second_) second_->happened(event);
    }

  private:
    EventSink *first_, *second_;
};

/// The errors of blocks that a run goes on after: the first of each block, and how many they were.
class BlockErrors final : public EventSink {
  public:
    explicit BlockErrors(EventSink* next) : next_(next) {}

    void happened(const RunEvent& event) override {
        if (next_) next_->happened(event);
        if (event.kind != EventKind::block_error) return;
        const std::string block = event.text.substr(0, event.text.find(" reports error"));
        const auto known = std::ranges::find(blocks_, block, &Block::name);
        if (known == blocks_.end())
            blocks_.push_back({block, event.text, 1});
        else
            ++known->errors;
    }

    void tell(std::vector<std::string>& out) const {
        for (const auto& [name, first, errors] : blocks_)
            out.push_back(errors == 1 ? first : fmt::format("{} (the first of {})", first, errors));
    }

  private:
    struct Block {
        std::string name, first;
        std::int64_t errors = 0;
    };

    EventSink* next_;
    std::vector<Block> blocks_;
};

/// One trace while it is recorded.
struct Tracing {
    Tracing(const TraceSetup& setup, const TraceOrigin& origin, const RunOptions& options,
            OutputSet& outputs)
        : name(setup.name),
          files(options.trace_path, setup, origin, options.csv_style, outputs),
          recorder(setup, files) {}

    void save(StateWriter& out) {
        recorder.flush();
        files.save(out);
    }

    TraceReport finish(const RunResult& result, const Judge& judge) {
        files.set_outcome(result.message, verdicts_json(judge));
        recorder.finish();
        if (recorder.measurements() == 0) {
            files.begin();
            files.end();
        }
        return {name, files.paths(), recorder.measurements(), recorder.recorded()};
    }

    std::string name;
    TraceFiles files;
    Recorder recorder;
};

/// One run: its observers and files from the start to the end.
class SingleRun {
  public:
    SingleRun(Loaded& loaded, const RunOptions& options)
        : loaded_(loaded), options_(options), machine_(loaded.linked.machine) {}

    RunReport run();

  private:
    bool begin();
    RunResult step();
    bool restart();
    bool open_files();
    std::vector<std::string> known_files() const;
    template <class Writer, class... Arguments>
    void open(std::optional<Writer>& writer, Arguments&&... arguments);
    void refuse(const std::string& error);
    bool resume();
    void tell_restart();
    std::string checkpoint(std::int64_t time);
    void look(std::int64_t time);
    bool writing_fails() const;
    void warn_of_cut_texts();
    void conclude();
    void finish();
    void open_traces();
    /// What a recording keeps was retained, too.
    bool is_warm() const {
        const auto& recording = loaded_.program.recording;
        return options_.restart == Restart::warm &&
               (!options_.retain_path.empty() || (recording && !recording->retained.empty()));
    }
    bool has_trace() const {
        return !options_.trace_path.empty() && !loaded_.linked.traces.empty();
    }

    Loaded& loaded_;
    const RunOptions& options_;
    Machine& machine_;
    RunReport report_;
    Judge judge_{loaded_.linked.expectations};
    RunBy by_{{}, options_.drive ? "serve" : "run"};  ///< without a program: no checkpoints
    std::string state_;                               ///< of a checkpoint
    int retained_ = 0;
    std::optional<StateReader> begun_;
    TraceOrigin origin_;
    OutputSet outputs_{options_.flush};
    std::deque<Tracing> traces_;
    std::optional<EventWriter> events_;
    std::optional<BothSinks> both_;
    std::optional<BlockErrors> errors_;  ///< where the run goes on after them
    std::optional<PulseWriter> pulses_;
    std::optional<Executive> executive_;
    std::vector<Observer*> observers_;
    std::atomic<bool> stop_ = false;
    bool has_run_ = true;
};

RunReport SingleRun::run() {
    const auto start = std::chrono::steady_clock::now();
    if (begin()) {
        report_.result = step();
        if (has_run_) conclude();
    }
    for (DeviceCall& device : machine_.devices) device.sink = nullptr;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    report_.wall_seconds = wall.count();
    return std::move(report_);
}

void SingleRun::conclude() {
    const bool broke_off = report_.result.outcome == Outcome::interrupted && writing_fails();
    if (broke_off)
        report_.result.message = "the run stopped at " + format_time(report_.result.time);
    for (std::string& text : executive_->warnings()) report_.warnings.push_back(std::move(text));
    if (errors_) errors_->tell(report_.warnings);
    warn_of_cut_texts();
    judge_.finish(report_.result);
    if (!broke_off) report_.verdicts = judge_.verdicts();
    for (const Expectation& e : judge_.expectations())
        if (e.when != Expectation::When::at && e.when != Expectation::When::at_end &&
            e.signal.task >= 0 &&
            report_.result.scans[static_cast<std::size_t>(e.signal.task)] == 0)
            report_.never_looked_at.push_back(e.text);
    finish();
}

void SingleRun::warn_of_cut_texts() {
    for (const Task& task : machine_.tasks)
        for (const ErrorFlag& block : task.errors)
            if (const auto cut =
                    block.type ? st::cut_text(*block.type, block.memory) : std::nullopt)
                report_.warnings.push_back(
                    fmt::format("block {} cut a text short, first at {}:{}:{}; declare the STRING "
                                "there longer",
                                block.block, cut->file->path, cut->line, cut->column));
}

bool SingleRun::begin() {
    if (!restart() || !open_files()) return false;
    executive_.emplace(machine_);
    EventSink* told = events_ ? &*events_ : nullptr;
    if (options_.events) told = &both_.emplace(told, options_.events);
    if (told) executive_->report_to(*told);
    if (machine_.continue_on_error) executive_->report_to(errors_.emplace(told));
    if (begun_ && !resume()) return false;
    tell_restart();
    if (options_.checkpoint_every > 0)
        executive_->checkpoint(options_.checkpoint_every, [this](std::int64_t time) {
            report_.restart_error = write_checkpoint(options_.checkpoint_path, checkpoint(time));
        });
    return true;
}

RunResult SingleRun::step() {
    for (Observer* observer : observers_) executive_->add(*observer);
    executive_->look_out(&stop_, [this](std::int64_t time) { look(time); });
    executive_->begin();
    if (options_.drive)
        has_run_ = options_.drive(*executive_, [this] { return checkpoint(executive_->time()); });
    else
        executive_->run_until(machine_.end);
    return executive_->finish();
}

bool SingleRun::restart() {
    if (options_.checkpoint_every > 0 || options_.drive || options_.restart == Restart::hot)
        by_.program = fingerprint(loaded_.program, machine_);
    const auto& recording = loaded_.program.recording;
    if (is_warm() && recording && !recording->retained.empty())
        retained_ = take_retained(recording->retained, recording->file, machine_, report_.refused);
    else if (is_warm())
        retained_ = read_retained(options_.retain_path, machine_, report_.refused);
    for (const Diagnostic& warning : report_.refused.warnings())
        report_.warnings.push_back(warning.message);
    if (options_.restart == Restart::hot) {
        state_ = read_checkpoint(options_.checkpoint_path, by_, report_.refused).value_or("");
        begun_.emplace(state_);
    }
    return report_.refused.empty();
}

/// That traces are written to.
std::vector<std::string> SingleRun::known_files() const {
    std::vector<std::string> known;
    if (has_trace())
        for (const TraceSetup& trace : loaded_.linked.traces)
            for (std::string& path : trace_paths(options_.trace_path, trace))
                known.push_back(std::move(path));
    return known;
}

/// What a file of the checkpoint holds comes first in it, then the machine and its observers.
bool SingleRun::open_files() {
    const std::array<bool, 3> files = {has_trace(), !options_.pulses_path.empty(),
                                       options_.observer != nullptr};
    std::array<bool, 3> before = files;
    if (begun_)
        for (bool& file : before) begun_->get(file);
    if (files != before || (begun_ && !begun_->ok())) {
        report_.refused.add(code::checkpoint_does_not_fit, {},
                            "the checkpoint was made with other files than this run has",
                            "give the same --trace, --pulses and --record as before");
        return false;
    }
    if (begun_) {
        outputs_.restore(*begun_, known_files());
        refuse(outputs_.error());
    }
    if (has_trace()) open_traces();
    if (!options_.pulses_path.empty()) open(pulses_, options_.pulses_path, machine_);
    if (!loaded_.linked.expectations.empty()) observers_.push_back(&judge_);
    judge_.begin();
    if (options_.observer) observers_.push_back(options_.observer);
    return report_.refused.empty();
}

template <class Writer, class... Arguments>
void SingleRun::open(std::optional<Writer>& writer, Arguments&&... arguments) {
    if (begun_)
        writer.emplace(arguments..., *begun_);
    else
        writer.emplace(arguments...);
    if (begun_) refuse(writer->error());
}

void SingleRun::refuse(const std::string& error) {
    if (!error.empty())
        report_.refused.add(code::checkpoint_does_not_fit, {}, error,
                            "run the program from its start: without --resume");
}

void SingleRun::open_traces() {
    origin_ = origin_of(loaded_);
    if (options_.trace_path != "-") open(events_, events_path(options_.trace_path), machine_);
    for (const TraceSetup& setup : loaded_.linked.traces) {
        Tracing& trace = traces_.emplace_back(setup, origin_, options_, outputs_);
        if (begun_) trace.files.restore(*begun_);
        refuse(trace.files.error());
        observers_.push_back(&trace.recorder);
        if (!events_) continue;
        trace.recorder.on_trigger = [this, &setup](const Scan& scan) {
            events_->happened({.time = scan.time,
                               .scan = scan.index,
                               .task = setup.task,
                               .kind = EventKind::trigger,
                               .text = setup.name.empty() ? "trace" : "trace " + setup.name});
        };
    }
}

bool SingleRun::resume() {
    if (begun_->ok()) executive_->restore(*begun_);
    for (Observer* observer : observers_)
        if (begun_->ok()) observer->restore(*begun_);
    for (const Tracing& trace : traces_)
        begun_->require(trace.files.is_open() == trace.recorder.is_recording() &&
                            std::ssize(trace.files.paths()) == trace.recorder.measurements(),
                        "a trace");
    if (begun_->at_end()) return true;
    refuse(begun_->wrong().empty()
               ? "the checkpoint does not fit the program"
               : fmt::format("the checkpoint is damaged: {} cannot be so", begun_->wrong()));
    return false;
}

void SingleRun::tell_restart() {
    if (!events_ || options_.restart == Restart::hot) return;
    events_->happened({.kind = EventKind::restart,
                       .text = is_warm()
                                   ? fmt::format("warm restart, {} retained values", retained_)
                                   : "cold restart"});
}

std::string SingleRun::checkpoint(std::int64_t time) {
    StateWriter out;
    for (const bool file : {has_trace(), pulses_.has_value(), options_.observer != nullptr})
        out.put(file);
    outputs_.save(out);
    if (events_) events_->save(out);
    for (Tracing& trace : traces_) trace.save(out);
    if (pulses_) pulses_->save(out);
    executive_->save(out);
    for (const Observer* observer : observers_) observer->save(out);
    return checkpoint_of(by_, time, out.bytes());
}

/// Stops the run when the user wants it, and when what it records cannot be written.
void SingleRun::look(std::int64_t time) {
    if (options_.progress) options_.progress(time);
    if (writing_fails() || (options_.interrupt && *options_.interrupt)) stop_ = true;
}

bool SingleRun::writing_fails() const {
    return !outputs_.error().empty() || (events_ && !events_->error().empty()) ||
           (pulses_ && !pulses_->error().empty()) ||
           std::ranges::any_of(traces_, [](const Tracing& t) { return t.files.failed(); });
}

void SingleRun::finish() {
    for (Tracing& trace : traces_) report_.traces.push_back(trace.finish(report_.result, judge_));
    if (events_) events_->finish(outputs_);
    if (pulses_) pulses_->finish(outputs_, report_.result.message);
    outputs_.commit();
    report_.output_error = outputs_.error();
    if (options_.retain_path.empty()) return;
    const std::string error = write_retained(options_.retain_path, machine_, report_.result.time);
    if (!error.empty()) report_.restart_error = error;
}

}  // namespace

RunReport run(Loaded& loaded, const RunOptions& options) {
    return SingleRun(loaded, options).run();
}

}  // namespace lineshaft
