#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/run/link.hpp"
#include "runtime/trace/csv_writer.hpp"

namespace lineshaft {

/// A program file, read, checked and wired.
struct Loaded {
    Program program;
    Linked linked;
};

/// Empty when `out` got any diagnostic.
std::optional<Loaded> load_program(const std::string& path, const LoadOptions& options,
                                   const Catalog& catalog, Diagnostics& out,
                                   CompiledSources* sources = nullptr);

/// How a run begins, as the S7-400 manual has it: cold, all values are the initial ones; warm,
/// retained ones are kept; hot, everything is as at the last checkpoint and goes on.
enum class Restart { cold, warm, hot };

struct RunOptions {
    /// CSV, see TraceFiles; empty: no trace is recorded. Events go beside it; `-` is the standard
    /// output, and has none beside it.
    std::string trace_path;
    std::string pulses_path = {};  ///< CSV of all pulse channels' edges; empty: none
    CsvStyle csv_style = {};
    bool flush = true;  ///< traces, events and pulses to the disk, see OutputSet
    const std::atomic<bool>* interrupt = nullptr;
    std::function<void(std::int64_t time)> progress;  ///< called now and then [ns]
    Observer* observer = nullptr;                     ///< sees the run, besides the trace
    EventSink* events = nullptr;                      ///< is told what the events' file is told
    /// Steps it, and may ask for a checkpoint between two steps; else it runs to its end at once.
    /// False: it could not begin, so that files of runs before stay as they are.
    std::function<bool(Executive&, const std::function<std::string()>& checkpoint)> drive = {};
    Restart restart = Restart::warm;
    std::string retain_path = {};       ///< of retained values, read and written; empty: none
    std::string checkpoint_path = {};   ///< read by a hot restart
    std::int64_t checkpoint_every = 0;  ///< virtual time between checkpoints [ns]; 0: none
};

/// What came of one trace.
struct TraceReport {
    std::string name;                ///< as in TraceSetup
    std::vector<std::string> paths;  ///< one a measurement; without any an empty one
    std::int64_t measurements = 0;   ///< 0: the trigger did not come
    std::int64_t rows = 0;           ///< of all measurements
};

/// What came of one run. Final values stand in the machine's signals.
struct RunReport {
    RunResult result;
    std::vector<Verdict> verdicts;  ///< one per expectation; none when files could not be written
    std::vector<std::string>
        never_looked_at;  ///< expectations of every scan of a task that had none
    /// What devices have put up with, and what errors of blocks the run has gone on after, a
    /// sentence each.
    std::vector<std::string> warnings;
    std::vector<TraceReport> traces;  ///< that were recorded
    std::string output_error;         ///< why traces, events and pulses are not there
    std::string restart_error;        ///< why retained values or checkpoints were not written
    Diagnostics refused;              ///< why the run could not begin, if so; nothing has run then
    double wall_seconds = 0;

    bool expectations_hold() const;
    bool faulted() const {
        return result.outcome != Outcome::completed || !output_error.empty() ||
               !restart_error.empty();
    }
};

RunReport run(Loaded& loaded, const RunOptions& options);

}  // namespace lineshaft
