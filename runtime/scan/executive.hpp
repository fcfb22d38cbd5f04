#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/machine/machine.hpp"
#include "runtime/model/random.hpp"
#include "runtime/model/state.hpp"
#include "runtime/scan/event.hpp"
#include "runtime/scan/forces.hpp"

namespace lineshaft {

class KeptMemory;

/// Sees the machine run. Called in virtual time, single-threaded.
class Observer {
  public:
    virtual ~Observer() = default;

    /// After the outputs of a scan of task `task` (its index) have been published.
    virtual void scanned(int task, const Scan& scan) = 0;

    /// Whether scanned() ever does anything: else it is not called.
    virtual bool looks_at_scans() const { return true; }

    /// Everything due at `time` has run; nothing changes before `next`, which is later, and at most
    /// one nanosecond past the end of the run.
    virtual void settled(std::int64_t time, std::int64_t next) = 0;

    /// What it must remember for a run that goes on later, see Executive::save().
    virtual void save(StateWriter&) const {}
    virtual void restore(StateReader&) {}
};

enum class Outcome {
    completed,    ///< the time has passed, or `until` has become true
    block_error,  ///< a block set `error`
    overrun,      ///< a time error that no task may handle, or the second in one cycle
    limit,        ///< `until` did not become true in time
    interrupted,
};

struct RunResult {
    Outcome outcome = Outcome::completed;
    std::int64_t time = 0;            ///< virtual time reached [ns]
    std::vector<std::int64_t> scans;  ///< per task
    std::int64_t time_errors = 0;     ///< those handled by a time-error task, and the last one
    std::string message;              ///< what happened, unless completed
};

/// Runs a machine in virtual time. A scan takes its inputs at its start and publishes its outputs
/// when its cost has passed. A task of higher priority that falls due in between runs in between,
/// on what was published, and puts the end off by its own cost; one of lower or equal priority
/// waits. At one instant: devices, then forces, then replays, then stimuli, then outputs that are
/// due, then tasks by priority. The run covers [0, duration], both included. Nothing is allocated,
/// locked or looked up by name while cycling, unless an event is told.
///
/// A task that runs once is released by the start, before all others.
///
/// An event task is released by each rising edge of a published boolean: of a device, a stimulus or
/// another task's output. A value that is true from the start is no edge. Several edges at one
/// instant are one release. An edge that comes while the task still runs is remembered and runs it
/// again at its end, as an interrupt controller does; a second one in that time is a time error.
///
/// Time errors, as on an S7-1500: a scan has not ended when its maximum cycle time has passed (and
/// again each time it passes once more), or its task is due again before it has ended; that release
/// is lost. The time-error task of the task (OB80) is released. Without one, in a motion task
/// (MC_Servo), or at the second time error since the main task last began a scan, the machine
/// stops. A thousand runs of an event task at one instant are STOP in any case.
///
/// One class, though large: all of it looks at the same instant, and its members are what a
/// checkpoint holds.
class Executive {
  public:
    explicit Executive(Machine& machine);

    /// Before begin(): where events go.
    void report_to(EventSink& events) { events_ = &events; }

    /// Before begin(): calls `save` when every instant due at a multiple of `every` [ns] has
    /// passed, and when the run is interrupted.
    void checkpoint(std::int64_t every, std::function<void(std::int64_t time)> save);

    /// Before begin(): `interrupt` ends the run within a millisecond of wall time (or after the
    /// instant under way), and `progress` is told how far it is as often as that is looked at.
    void look_out(const std::atomic<bool>* interrupt,
                  std::function<void(std::int64_t time)> progress = {});

    /// A whole run: begin(), run_until() the machine's duration, finish().
    RunResult run(const std::vector<Observer*>& observers,
                  const std::atomic<bool>* interrupt = nullptr,
                  const std::function<void(std::int64_t time)>& progress = {});

    /// A run step by step. The steps make no difference to what happens in it: run_until() runs
    /// each instant up to `time` [ns], included, and tells whether there is more to come; finish()
    /// ends the run where it is.
    void begin();
    bool run_until(std::int64_t time);
    RunResult finish();

    /// An observer asks, or a block that is looked at: run_until() is to return when the instant
    /// under way has passed; asked again, it goes on.
    void hold();

    /// Between two steps: the run ends here, as it does by the interrupt of look_out().
    void interrupt();

    /// Before begin() or between two steps.
    void add(Observer& observer);
    void remove(Observer& observer);

    /// Up to which everything has run [ns]; below 0 before the first instant.
    std::int64_t time() const { return known_until_ - 1; }

    /// When something is due next [ns].
    std::int64_t next_time();

    /// Between two steps: a value from outside counts from the next nanosecond on, so before every
    /// scan that comes, and is told as a stimulus of that time. A run of the same program with that
    /// stimulus in its file does the same. Returns that time [ns].
    std::int64_t post(Stimulus value);

    /// The value that was posted to it since the last step, last.
    std::optional<Value> posted(const std::byte* target) const;

    /// So many values can be posted, and so many forces imposed, without taking memory.
    void make_room(std::size_t values);

    /// Likewise: see Machine::impose() and lift_force().
    std::int64_t force(Force force);
    std::int64_t lift_force(const std::byte* live);

    /// After run(): what the devices have put up with, a sentence for each that has.
    std::vector<std::string> warnings() const;

    /// All that the run depends on, the machine's memory too: a machine of the same program, with
    /// restore() before run(), goes on as if there had been no end. The reader tells whether it
    /// fits: nothing in it is believed, every number is looked at that the run rests on.
    void save(StateWriter& out) const;
    void restore(StateReader& in);

    /// restore() of what this very machine has saved: what a scan does not leave to the next one is
    /// as it was, too, so that the bytes of the memory are.
    void recall(StateReader& in);

  private:
    using Clock = std::chrono::steady_clock;

    struct State {
        std::int64_t due = 0;           ///< next release [ns]
        bool pending = false;           ///< released, not yet started
        bool active = false;            ///< started, not yet published
        std::int64_t released = 0;      ///< last release [ns]
        std::int64_t cost = 0;          ///< of the scan under way [ns]
        std::int64_t remaining = 0;     ///< of it [ns]
        std::int64_t deadline = never;  ///< when its maximum cycle time passes [ns]
        std::int64_t index = 0;         ///< of the next scan
        std::int64_t outside = never;   ///< of the next scan with a stimulus
        std::int64_t repeats = 0;       ///< of an event task: starts at the instant of the last one
        std::size_t next_stimulus = 0;  ///< by scan
        std::size_t next_cost = 0;      ///< likewise
        std::size_t first_error = 0;    ///< place in error_levels_
        bool may_err = true;            ///< an error flag may be set, or was when last looked at
        Scan scan;                      ///< the one under way
        Random jitter;
        Random cost_jitter;

        void set_next(const Task& task);

        /// Each member for itself: between them are bytes that mean nothing, and differ.
        static void visit(auto& state, auto&& take) {
            take(state.due), take(state.pending), take(state.active), take(state.released);
            take(state.cost), take(state.remaining), take(state.deadline), take(state.index);
            take(state.outside), take(state.repeats), take(state.next_stimulus);
            take(state.next_cost), take(state.first_error), take(state.may_err), take(state.scan);
            take(state.jitter), take(state.cost_jitter);
        }
    };

    /// What has been told of a device's warnings.
    struct Warned {
        std::int64_t count = 0;      ///< told so far
        std::int64_t first = never;  ///< when [ns]
        std::int64_t id = 0;         ///< of the first
    };

    void restore_memory(StateReader& in, KeptMemory& memory, const std::byte* kept);
    void restore_forces(StateReader& in, const KeptMemory& memory);
    void restore_mail(StateReader& in, const KeptMemory& memory);
    void restore_states(StateReader& in);
    bool is_possible(const State& state, const State& fresh, const Task& task) const;
    void settle(std::int64_t last);
    [[gnu::cold]] bool look();
    std::int64_t next_event();
    std::int64_t next_end();
    void look_ahead();
    std::int64_t forces_changed();
    void advance(std::int64_t time);
    void instant();
    void finish_top();
    void release();
    void release(int task, State& state);
    void run_tasks();
    void run_due(std::int64_t last);
    void start_pending();
    void make_pending(int task);
    int next_to_start() const;
    void start(int task);
    void begin(int index, const Task& task, State& state);
    bool scan_blocks(const Task& task, const Scan& scan);
    void scan_forced(const Task& task, const Scan& scan);
    void publish(int task);
    [[gnu::noinline]] void show(int index, const Scan& scan);
    void conclude(int index, const State& state);

    // executive_outside.cpp
    void advance_devices();
    void advance_device(const DeviceCall& device);
    std::int64_t next_event_time(const DeviceCall& device);
    void publish_device(const DeviceCall& device);
    void act_from_outside();
    [[gnu::cold]] void stimulate(int task);
    void set(const Stimulus& stimulus, int task);
    void play();
    void look_ahead(int task);
    void detect_edges();

    // executive_faults.cpp
    bool repeats_without_end(int task);
    void check_deadlines();
    void due_again(int task);
    void time_error(int task, std::string what);
    std::string running_block(int task) const;
    [[gnu::cold]] void report_errors(int task);
    std::string why(const ErrorFlag& flag, int task);
    void report_warnings(const DeviceCall& device, int task);
    void tell(EventKind kind, int task, const std::string& text);
    void stop(Outcome outcome, std::string message, int task = -1);

    // By pointer: the library's check of an index divides by an odd size, several times a scan.
    State& state(int task) { return states_.data()[task]; }
    const State& state(int task) const { return states_.data()[task]; }
    const Task& task(int index) const { return machine_.tasks.data()[index]; }

    Machine& machine_;
    Forces forces_;
    std::vector<State> states_;
    std::vector<std::uint8_t> trigger_levels_;  ///< of each trigger's signal when last looked at
    std::vector<std::uint8_t> error_levels_;    ///< of each task's error flags, likewise
    std::vector<Warned> warned_;                ///< by device
    std::vector<int> running_;       ///< stack of started scans, the interrupted ones below
    int pending_ = 0;                ///< number of tasks
    std::int64_t next_due_ = 0;      ///< the first release of all [ns]
    std::int64_t next_outside_ = 0;  ///< of a force, a replay, a stimulus, a look at a device [ns]
    bool nothing_waits_ = false;     ///< no task takes time or comes from an event
    bool interpolates_ = false;      ///< a replay: then something is due in every instant
    const std::byte* until_ = nullptr;  ///< the boolean that ends the run
    std::vector<Observer*> observers_;
    std::vector<Observer*> scan_observers_;  ///< those of them that look at scans
    std::vector<Stimulus> mail_;             ///< posted, counts from the same instant on
    std::int64_t known_until_ = 0;           ///< observers know that nothing changes before [ns]
    bool has_run_ = false;                   ///< at least one instant
    bool ended_ = false;
    bool held_ = false;
    const std::atomic<bool>* interrupt_ = nullptr;
    std::function<void(std::int64_t)> progress_;
    Clock::time_point looked_;      ///< at the interrupt, in wall time
    double stride_ = 1;             ///< instants between two looks
    std::uint32_t until_look_ = 1;  ///< instants
    EventSink* events_ = nullptr;
    std::function<void(std::int64_t)> save_;
    std::int64_t save_every_ = 0, next_save_ = never;  ///< [ns]
    std::size_t next_stimulus_ = 0;
    std::size_t next_look_ = 0;
    std::int64_t now_ = 0;
    int errors_in_cycle_ = 0;  ///< time errors since the main task's last start
    bool stopped_ = false;
    RunResult result_;
};

/// The end of time when the sum lies beyond it.
inline std::int64_t later(std::int64_t time, std::int64_t by) {
    std::int64_t sum;
    return __builtin_add_overflow(time, by, &sum) ? never : sum;
}

}  // namespace lineshaft
