#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "runtime/scan/executive.hpp"
#include "runtime/trace/trigger.hpp"

namespace lineshaft {

/// What a trace records.
struct TraceSetup {
    std::string name = {};  ///< empty: the program's `trace:`
    int task = 0;           ///< after each `every`-th scan of this task
    std::int64_t every = 1;
    std::vector<Signal> signals;
    TraceTrigger trigger = {};     ///< looked at after every scan of the task
    std::int64_t pre_trigger = 0;  ///< rows from before the trigger, at most
    std::int64_t samples = 0;      ///< rows from the trigger on, at most; 0: no limit
    std::int64_t duration = 0;     ///< [ns] from the trigger on; 0: no limit
    std::int64_t repeat = 1;       ///< measurements, at most

    /// Words of a row: time [ns], scan, then one a signal.
    std::size_t row_words() const { return 2 + signals.size(); }

    /// What recording it takes, whatever the length of the run: the ring of rows from before the
    /// trigger, and blocks of rows on their way to the disk. [bytes] At most 2^63.
    std::uint64_t memory() const;
};

/// Takes recorded rows: times [ns], scans, and values as their 64 bits (boolean 0 or 1).
class TraceSink {
  public:
    virtual ~TraceSink() = default;

    /// A measurement begins, with the rows from before its trigger.
    virtual void begin() {}

    /// `rows` rows of 2 + signals words each: time since the trigger, scan, then a word a signal.
    virtual void rows(const std::uint64_t* words, std::size_t rows) = 0;

    /// The measurement has all its rows.
    virtual void end() {}
};

/// Copies the traced signals into a block of rows after each recorded scan; full blocks go to the
/// sink. Before the trigger the rows go round in a ring. Nothing is allocated while cycling.
class Recorder : public Observer {
  public:
    Recorder(TraceSetup setup, TraceSink& sink);
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    void scanned(int task, const Scan& scan) override;
    void settled(std::int64_t, std::int64_t) override {}
    void save(StateWriter& out) const override;
    void restore(StateReader& in) override;

    /// Hands the rows over that wait in the block under way.
    void flush();

    /// Ends the measurement under way. To be called after the run.
    void finish();

    std::int64_t recorded() const { return recorded_; }          ///< rows given to the sink
    std::int64_t measurements() const { return measurements_; }  ///< begun so far

    bool is_recording() const { return recording_; }  ///< a measurement has begun and not ended

    /// Called with the scan in which the trigger came; not for an immediate one.
    std::function<void(const Scan&)> on_trigger;

  private:
    void begin(std::int64_t time);
    void end();
    void look(const Scan& scan);
    void record(const Scan& scan);
    void copy_row(const Scan& scan, std::int64_t origin, std::uint64_t* word) const;
    void keep(const Scan& scan);
    void give_ring();
    void give_ring(std::size_t row, std::size_t end);
    bool is_over(std::int64_t time) const;

    /// Where a signal's value is, close to the next one's.
    struct Source {
        const std::byte* slot;
        bool is_word;  ///< 8 bytes; else one
    };

    TraceSetup setup_;
    std::vector<Source> sources_;
    TraceSink& sink_;
    TriggerWatch watch_;
    std::size_t row_words_;
    std::vector<std::uint64_t> words_;  ///< the block under way
    std::size_t used_ = 0;
    std::vector<std::uint64_t> ring_;
    std::size_t ring_next_ = 0;  ///< word where the next row goes
    std::int64_t ring_rows_ = 0;
    std::int64_t origin_ = 0;  ///< time of the trigger [ns]
    std::int64_t rows_ = 0;    ///< of the measurement, from its trigger on
    bool recording_ = false;
    std::int64_t recorded_ = 0;
    std::int64_t measurements_ = 0;
};

}  // namespace lineshaft
