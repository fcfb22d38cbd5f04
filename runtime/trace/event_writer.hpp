#pragma once

#include <string>
#include <vector>

#include "runtime/machine/machine.hpp"
#include "runtime/scan/event.hpp"
#include "runtime/trace/output_set.hpp"

namespace lineshaft {

/// `run.events.csv` beside the trace `run.csv`.
std::string events_path(const std::string& trace_path);

/// Writes the events of a run as RFC 4180 CSV: `time` [s], `scan` and `task` (empty between scans),
/// `kind`, `text`. Streamed: memory does not grow with the events.
class EventWriter : public EventSink {
  public:
    EventWriter(std::string path, const Machine& machine);
    /// Goes on where save() was called.
    EventWriter(std::string path, const Machine& machine, StateReader& begun);

    void happened(const RunEvent& event) override;

    void save(StateWriter& out) { file_->save(out); }
    const std::string& error() const { return file_->error(); }

    /// Hands the file over. Nothing may follow.
    void finish(OutputSet& files) { files.add(std::move(file_)); }

  private:
    std::unique_ptr<OutputFile> file_;
    const Machine& machine_;
};

}  // namespace lineshaft
