#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "runtime/debug/breakpoints.hpp"
#include "runtime/debug/data_breakpoints.hpp"
#include "runtime/debug/history.hpp"
#include "runtime/debug/signal_conditions.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/serve/desk.hpp"

namespace lineshaft::debug {

/// Where a run is: before a statement of a scan, or between two instants.
struct Position {
    static constexpr std::uint64_t behind = ~std::uint64_t{0};

    std::int64_t time = -1;       ///< of the instant [ns]
    std::uint64_t scan = behind;  ///< of Structured Text in it, from 1 on; behind: it has passed
    std::uint64_t statement = 0;  ///< in that scan, from 1 on

    auto operator<=>(const Position&) const = default;
};

/// How a run goes on.
enum class Way : std::uint8_t {
    none,
    go,         ///< to the next stop
    next,       ///< to the task's next statement, calls at once
    into,       ///< into calls
    out,        ///< of the call that runs
    next_scan,  ///< to the task's next scan
    back,       ///< to the task's statement before, calls at once
    back_go,    ///< to the stop before
    end,        ///< of the session
    to,         ///< to a position, in the past or to come
    writer,     ///< back to what last changed some bytes of the memory
};

struct Command {
    Way way = Way::none;
    int task = -1;  ///< index; -1: any
    Position to = {};
    const std::byte* at = nullptr;  ///< of writer
    std::size_t bytes = 0;
};

/// Why a run stands still.
struct Stop {
    std::string reason, text = {};  ///< as the protocol has them
    int task = 0;
    std::vector<int> breakpoints = {};
};

/// Who tells a session what to do.
class Front {
  public:
    virtual ~Front() = default;

    /// Returns when Session::command() has been called.
    virtual void stopped(const Stop& stop) = 0;

    /// Now and then while the machine runs; it may call pause() and end().
    virtual void look() = 0;

    virtual void happened(const RunEvent& event) = 0;
    virtual void log(const std::string& text) = 0;
};

/// A value that was changed by hand.
struct HandChange {
    std::int64_t at = 0, until = never;  ///< of a force, when it ends [ns]
    Change change;                       ///< of a signal
    std::function<void()> write = {};    ///< of a variable that is none; else none
};

/// One program under the debugger: runs it forwards as `lineshaft run` does, looks at it from
/// inside, and repeats what has been from a checkpoint to go back. Who never goes back has run it
/// in a piece; else the files are written at the end, by a run in a piece to where the session
/// ended. One thread.
class Session final : Observer, EventSink {
  public:
    Session(Loaded& loaded, Front& front);
    ~Session() override;

    bool stop_on_entry = false;
    bool stop_at_end = false;

    /// The whole session. `how` has no `drive`, `observer` or `events`.
    RunReport run(RunOptions how);

    /// While it stands still.
    void command(Command command) { command_ = command; }
    /// While it runs.
    void pause() { pausing_ = true; }
    void end() { ending_ = true; }

    /// A value of a signal, as a program would have it: an input keeps it, any other signal has it
    /// for one scan of its task. It counts from the next instant on, and what was to come after
    /// that is forgotten. What is wrong goes to `out`. Gives the value as it is shown then.
    std::string change(const std::string& signal, const std::string& value, Diagnostics& out);
    /// Likewise what is no signal, but a recording does not have it.
    void change(const std::string& variable, std::function<void()> write);

    /// What was changed by hand, for `lineshaft run --recording`; empty: nothing was.
    std::string recording() const;

    /// A hash of the executive's state: the same number, the same state.
    std::string fingerprint() const;

    /// In place of those that the file had: see Breakpoints. What they are come to is counted from
    /// here on, also when the run goes back behind this place and comes again.
    std::vector<Breakpoint> set_breakpoints(const std::string& path,
                                            const std::vector<Wanted>& wanted);
    SignalConditions& signals() { return signals_; }
    DataBreakpoints& data() { return data_; }
    bool stop_on_error = false;
    const Loaded& loaded() const { return loaded_; }
    const st::Library::Made* made() const { return made_; }
    /// The scan under way, or the one that a fault ended; null between two instants.
    const st::Halt* halt() const { return halt_; }
    const Position& here() const { return here_; }
    std::int64_t time() const { return executive_ ? executive_->time() : -1; }
    const History& history() const { return history_; }

  private:
    class Looking;
    using Clock = std::chrono::steady_clock;

    /// A step that is being done.
    struct Plan {
        Command command;
        Position from;
        std::uint32_t depth = 0;
        std::int64_t scan = -1;  ///< index of the task's scan it began in; -1: between two
    };
    /// A look at the past: the last place before `end` that matches.
    struct Search {
        Position end;
        Plan plan;
        std::optional<Position> found = {};
        std::string bytes = {};        ///< of writer: as they were when last looked at
        Position last = {};            ///< of writer: then
        std::optional<Stop> why = {};  ///< what it found between two instants
    };

    // What is seen.
    void scanned(int task, const Scan& scan) override;
    void settled(std::int64_t time, std::int64_t next) override;
    void happened(const RunEvent& event) override;
    bool steps(const st::CodeRoutine& routine, const Scan& now);
    void look(const st::Halt& halt);
    bool is_reached(const Plan& plan, int task, std::uint32_t depth, std::int64_t scan) const;
    bool matches(const Search& search, const st::Halt& halt);
    bool hits(const st::Halt& halt, Stop& stop, bool tells);
    std::optional<Stop> stop_between(std::int64_t time);
    void watch(const Position& now, bool is_statement);

    // Forwards.
    bool play(Executive& executive);
    void begin(Executive& executive);
    bool run_freely(std::int64_t limit, bool is_quiet);
    void stand(Stop stop, const st::Halt* halt);
    void find_failed(int task);
    void obey(const st::Halt* halt);
    void want(HandChange wanted);
    void post_due();
    void apply(const HandChange& made);
    static std::string text_of(const HandChange& made);
    void attach();
    bool has_code(int task) const;
    std::int64_t end_of_run() const;

    // Backwards: replay.cpp.
    void note_beginning();
    void reset();
    void keep(bool at_once = false);
    Position target();
    std::optional<Position> last_before(const Position& end, const Plan& plan);
    std::optional<Position> search(std::int64_t from, const Position& end, const Plan& plan);
    void start_at(Executive& executive, std::int64_t time);
    void wander();
    RunReport repeat(RunOptions how);

    Loaded& loaded_;
    Machine& machine_;
    Front& front_;
    const st::Library::Made* made_;
    Breakpoints breakpoints_;
    SignalConditions signals_;
    DataBreakpoints data_;
    std::map<int, std::int64_t> hits_;  ///< of breakpoints, by their numbers
    std::map<int, Position> set_at_;    ///< likewise
    std::vector<HandChange> changes_;
    std::size_t next_change_ = 0;
    std::vector<HandChange> wanted_changes_;  ///< of the instant under way
    std::unique_ptr<st::Probe> looking_;      ///< null without Structured Text
    std::vector<bool> has_code_;              ///< by task
    BlockMemory fresh_;                       ///< the memory as the run began
    std::vector<Force> fresh_forces_;
    History history_;
    std::int64_t kept_ = 0,
                 keep_cost_ = 0;      ///< when last, and what that took of the processor [ns]
    std::int64_t chunk_ = 1'000'000;  ///< virtual time between two looks at the front [ns]

    Executive* executive_ = nullptr;
    const st::Halt* halt_ = nullptr;
    std::optional<FailedScan> failed_;  ///< that the run stands still for
    Position here_;
    std::int64_t instant_ = -1;  ///< that is under way, or was last [ns]
    std::uint64_t scans_ = 0, statements_ = 0;
    std::uint32_t polls_ = 0;
    int plain_scan_ = -1;  ///< a task without Structured Text that was scanned in this instant
    Command command_;
    std::optional<Plan> plan_;
    std::optional<Stop> between_;  ///< stands still when the instant has passed
    std::optional<Plan> jump_;     ///< back
    std::optional<Stop> landing_;  ///< what the jump leads to, between two instants
    std::optional<Position> goal_;
    std::optional<Search> search_;
    bool quiet_ = false;     ///< nothing is told, nothing stops
    bool recounts_ = false;  ///< likewise, but breakpoints are counted
    bool pausing_ = false, ending_ = false, has_ended_ = false;
    std::int64_t end_ = -1;  ///< where the session left the machine [ns]
};

}  // namespace lineshaft::debug
