#pragma once

#include <cstdint>
#include <vector>

#include "runtime/scan/executive.hpp"

namespace lineshaft {

/// What a trace records.
struct TraceSetup {
    int task = 0;  ///< after each `every`-th scan of this task
    std::int64_t every = 1;
    std::vector<Signal> signals;
};

/// Takes recorded rows: times [ns], scans, and values as their 64 bits (boolean 0 or 1).
class TraceSink {
  public:
    virtual ~TraceSink() = default;

    /// `rows` rows of 2 + signals words each: time, scan, then a word a signal.
    virtual void rows(const std::uint64_t* words, std::size_t rows) = 0;
};

/// Copies the traced signals into a block of rows after each recorded scan; full blocks go to the
/// sink. Nothing is allocated while cycling.
class Recorder : public Observer {
  public:
    Recorder(TraceSetup setup, TraceSink& sink);

    void scanned(int task, const Scan& scan) override;
    void settled(std::int64_t, std::int64_t) override {}
    void flush();
    void save(StateWriter& out) const override { out.put(recorded_); }
    void restore(StateReader& in) override { in.get(recorded_); }

    std::int64_t recorded() const { return recorded_; }

  private:
    TraceSetup setup_;
    TraceSink& sink_;
    std::vector<std::uint64_t> words_;
    std::size_t used_ = 0;
    std::int64_t recorded_ = 0;
};

}  // namespace lineshaft
