#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "runtime/machine/machine.hpp"
#include "runtime/model/device.hpp"
#include "runtime/trace/csv_writer.hpp"

namespace lineshaft {

/// Writes the rising edges of a machine's pulse channels as CSV: `channel,time_ns,direction`, the
/// direction 1 or -1. Times rise within a channel; between two instants of the run all edges of one
/// channel come before those of the next. Streamed: memory does not grow with the pulses.
class PulseWriter {
  public:
    /// Becomes the sink of every device of `machine`; must outlive the run.
    PulseWriter(std::string path, Machine& machine);
    /// Goes on where save() was called.
    PulseWriter(std::string path, Machine& machine, StateReader& begun);
    PulseWriter(const PulseWriter&) = delete;
    PulseWriter& operator=(const PulseWriter&) = delete;

    void save(StateWriter& out) { file_->save(out); }
    const std::string& error() const { return file_->error(); }

    /// Hands the file over. If the run did not complete, `PATH-metadata.json` beside it says why
    /// (`lineshaft:stopped`). Nothing may follow.
    void finish(OutputSet& files, const std::string& stopped);

  private:
    struct Channel : PulseSink {
        Channel(PulseWriter& to, std::string channel_name)
            : writer(to), name(std::move(channel_name)) {}
        void edges(std::span<const std::int64_t> times, bool reverse) override;

        PulseWriter& writer;
        std::string name;
    };

    void listen_to(Machine& machine);

    std::unique_ptr<OutputFile> file_;
    std::string text_;
    std::vector<std::unique_ptr<Channel>> channels_;
};

}  // namespace lineshaft
