#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "runtime/run/single_run.hpp"
#include "runtime/serve/lateness.hpp"
#include "runtime/serve/mailbox.hpp"
#include "runtime/serve/pacer.hpp"
#include "runtime/serve/recording_writer.hpp"
#include "runtime/serve/stream.hpp"

namespace lineshaft {

/// What happens when a scan is a whole interval late.
enum class WhenLate : std::uint8_t {
    catch_up,  ///< those that are due follow at once, until the clock is reached
    skip,      ///< the clock is put off: the next scan comes an interval later
};

struct LiveOptions {
    double speed = 1;  ///< see Pacer
    WhenLate late = WhenLate::catch_up;
    std::int64_t end = never;  ///< virtual time at which the machine stops by itself [ns]
    const std::atomic<bool>* interrupt = nullptr;
};

/// How a task has kept its times.
struct TaskPace {
    std::string name;
    std::int64_t every = 0;  ///< [ns]; 0: at events
    std::int64_t scans = 0;
    std::int64_t overruns = 0;  ///< scans that were a whole interval late
    Lateness lateness;          ///< of all that were paced
};

/// How the machine has kept up with the clock.
struct Pace {
    std::vector<TaskPace> tasks;
    std::int64_t skipped = 0;  ///< what the clock was put off by [ns]

    std::int64_t overruns() const;
};

/// Per task: scans, overruns, quantiles and histogram of its lateness [us].
nlohmann::ordered_json to_json(const Pace& pace);

struct Forced {
    std::string name, value;  ///< as a person reads it
};

struct LiveState {
    std::int64_t time = 0;  ///< virtual [ns]
    double speed = 1;
    bool paused = false;
    std::vector<Forced> forced;
    Pace pace;
    std::string recording, recording_error;  ///< its file; why not all is in it. Empty: none
};

/// When changes count, and where they stand in the recording.
struct Applied {
    std::int64_t at = 0;    ///< virtual [ns]
    std::int64_t mark = 0;  ///< of RecordingWriter
};

/// A machine that runs by the clock, by stepping an executive that has begun. The thread that makes
/// it is the machine's: it calls drive(), and the other functions as jobs of the mailbox, between
/// two instants.
class Live : public Observer {
  public:
    /// `recording` takes what changes; may be null.
    Live(Loaded& loaded, Executive& executive, const LiveOptions& options,
         RecordingWriter* recording, World& world = World::system());
    ~Live() override { executive_.remove(*this); }
    Live(const Live&) = delete;
    Live& operator=(const Live&) = delete;

    Mailbox& mailbox() { return mailbox_; }
    World& world() { return world_; }

    /// Runs until the end, an interrupt, or what ends a run.
    void drive();

    /// All at once, or none when there is no memory for them. Who asked for them is not told so
    /// before keep().
    Applied apply(const std::vector<Change>& changes);
    /// The value that an input has been set to since the machine last moved.
    std::optional<Value> posted(const std::byte* input) const { return executive_.posted(input); }

    /// For any thread. Waits until the recording has what was applied; empty, or why it has not.
    std::string keep(const Applied& applied);
    /// Likewise: why nothing more may be changed now; empty when all is well.
    std::string recording_error() const { return recording_ ? recording_->error() : ""; }

    void pause();
    void resume();
    /// Pauses, and runs so many scans of a task, any task's for -1, but for no longer than a few
    /// milliseconds of the clock. Returns how many of them are left.
    std::int64_t step(int task, std::int64_t scans);
    /// Goes on until `time` [ns], then pauses. False: that has been, and nothing changes.
    bool run_until(std::int64_t time);
    void set_speed(double speed);

    void add(std::shared_ptr<Stream> stream) { streams_.push_back(std::move(stream)); }

    /// Virtual, up to which everything has run [ns].
    std::int64_t time() const { return std::max<std::int64_t>(executive_.time(), 0); }
    LiveState state() const;
    const Pace& pace() const { return pace_; }

    void scanned(int task, const Scan& scan) override;
    void settled(std::int64_t, std::int64_t) override {}

  private:
    void turn();
    void rest();
    void run_paced(std::int64_t next);
    void run_freely(std::int64_t next, std::int64_t limit);
    void deliver();
    void advance(std::int64_t time);
    void sample();

    Machine& machine_;
    Executive& executive_;
    const LiveOptions options_;
    World& world_;
    Mailbox mailbox_;
    Pacer pacer_;
    Pace pace_;
    RecordingWriter* recording_;
    std::vector<std::shared_ptr<Stream>> streams_;
    std::int64_t shortest_ = 0;       ///< interval of a task; 0: none has one [ns]
    std::int64_t goal_ = never;       ///< where it pauses [ns]
    std::int64_t late_ = 0;           ///< the instant under way, on the clock [ns]
    std::int64_t chunk_ = 1'000'000;  ///< virtual time at once when there is no pace [ns]
    std::int64_t delivered_ = 0;      ///< when the mail was last looked at, on the clock [ns]
    int step_task_ = -1;
    std::int64_t steps_ = 0;  ///< scans still to come while stepping
    bool paused_ = false, goes_on_ = true;
};

}  // namespace lineshaft
