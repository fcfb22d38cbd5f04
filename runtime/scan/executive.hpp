#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "runtime/scan/machine.hpp"
#include "runtime/model/random.hpp"

namespace lineshaft {

/// Sees the machine run. Called in virtual time, single-threaded.
class Observer {
  public:
    virtual ~Observer() = default;

    /// After the outputs of a scan of task `task` (its index) have been published.
    virtual void scanned(int task, const Scan& scan) = 0;

    /// Everything due at `time` has run; nothing changes before `next`, which is later, and at most
    /// one nanosecond past the end of the run.
    virtual void settled(std::int64_t time, std::int64_t next) = 0;
};

enum class Outcome {
    completed,    ///< the time has passed, or `until` has become true
    block_error,  ///< a block set `error`
    overrun,      ///< a task fell due while it was still running
    limit,        ///< `until` did not become true in time
    interrupted,
};

struct RunResult {
    Outcome outcome = Outcome::completed;
    std::int64_t time = 0;            ///< virtual time reached [ns]
    std::vector<std::int64_t> scans;  ///< per task
    std::string message;              ///< what happened, unless completed
};

/// Runs a machine in virtual time. A scan takes its inputs at its start and publishes its outputs
/// when its cost has passed. A task of higher priority that falls due in between runs in between,
/// on what was published, and puts the end off by its own cost; one of lower or equal priority
/// waits. At one instant: devices, then stimuli, then outputs that are due, then tasks by priority.
/// The run covers [0, duration], both included. Nothing is allocated, locked or looked up by name
/// while cycling.
///
/// An event task is released by each rising edge of a published boolean: of a device, a stimulus or
/// another task's output. A value that is true from the start is no edge. Several edges at one
/// instant are one release. An edge that comes while the task still runs is remembered and runs it
/// again at its end, as an interrupt controller does; a second one in that time is an overrun, and
/// so are a thousand runs at one instant.
class Executive {
  public:
    explicit Executive(Machine& machine);

    RunResult run(const std::vector<Observer*>& observers,
                  const std::atomic<bool>* interrupt = nullptr,
                  const std::function<void(std::int64_t time)>& progress = {});

  private:
    struct State {
        Random jitter;
        Random cost_jitter;
        std::int64_t due = 0;        ///< next release [ns]
        std::int64_t released = 0;   ///< last release [ns]
        std::int64_t remaining = 0;  ///< of the scan under way [ns]
        std::int64_t index = 0;      ///< of the next scan
        std::int64_t repeats = 0;    ///< of an event task: starts at the instant of the last one
        Scan scan;                   ///< the one under way
        bool pending = false;        ///< released, not yet started
        bool active = false;         ///< started, not yet published
    };

    std::int64_t next_event() const;
    void instant();
    void advance_devices();
    void detect_edges();
    void stimulate();
    void advance(std::int64_t time);
    void finish_top();
    void release();
    void start_pending();
    int next_to_start() const;
    void start(int task);
    bool repeats_without_end(int task);
    void publish(int task);
    void check_errors(const Task& task, const Scan& scan);
    void stop(Outcome outcome, std::string message);

    Machine& machine_;
    std::vector<State> states_;
    std::vector<std::uint8_t> trigger_levels_;  ///< of each trigger's signal when last looked at
    std::vector<int> running_;  ///< stack of started scans, the interrupted ones below
    const std::vector<Observer*>* observers_ = nullptr;
    std::size_t next_stimulus_ = 0;
    std::size_t next_look_ = 0;
    std::int64_t now_ = 0;
    bool stopped_ = false;
    RunResult result_;
};

/// `12.345 s`, exact from integer nanoseconds.
std::string format_time(std::int64_t nanoseconds);

}  // namespace lineshaft
