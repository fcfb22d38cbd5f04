#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "runtime/program/program.hpp"
#include "runtime/scan/executive.hpp"

namespace lineshaft {

/// A statement about a signal: at an instant, at the end, or after every scan of the task that
/// writes it. It holds when low <= value <= high; true counts as 1, an enumeration as its number.
///
/// Counted are rising edges in the scans of the signal's task; a value that is true from the start
/// is no edge. An answer is awaited from each rising edge of the cause on: the signal has to be
/// true then, or in a scan up to `until` later. That there was no cause at all is a failure.
///
/// What the run is too short for is undecided, and that is not ok: an instant, the end of a span,
/// an answer that still has time. What a run that stopped before its end (a fault, a limit, ^C) has
/// not judged to its end is undecided, too. So whatever is ok of a run that stopped stays so,
/// however much longer it might run. Of a run that ended as planned that holds of instants, spans
/// and of edges that are at least so many; the end, `always`, `never`, the most edges and answers
/// are of the run as long as it was.
struct Expectation {
    using When = ExpectPlan::When;

    std::string text;  ///< as `run` prints it: `at 1 s: gear.InGear = true`
    Signal signal;
    When when = When::at_end;
    std::int64_t from = 0, until = never;  ///< [ns], see ExpectPlan
    std::optional<Signal> cause = {};      ///< of an answer
    Value low = -std::numeric_limits<double>::infinity();
    Value high = std::numeric_limits<double>::infinity();
    std::string wanted;  ///< `true`, `15 mm/s`, for the message
};

/// What a judge remembers of what it counts or awaits.
struct Watch {
    bool level = false;           ///< of the signal, or of the cause, when last looked at
    std::int64_t edges = 0;       ///< of it
    std::int64_t awaits = never;  ///< an answer, since the first edge without one [ns]
    bool has_risen = false, is_answered = false;  ///< in this instant

    /// Each member for itself: between them are bytes that mean nothing, and differ.
    static void visit(auto& watch, auto&& take) {
        take(watch.level), take(watch.edges), take(watch.awaits);
        take(watch.has_risen), take(watch.is_answered);
    }
};

struct Verdict {
    bool ok = false;
    bool undecided = false;  ///< not ok because the run ended too early to say
    std::string deviation;   ///< of the first failure: scan, time, both values; empty when ok

    /// How a user is told of it, in a column.
    const char* word() const { return ok ? "ok    " : undecided ? "UNDECIDED" : "FAILED"; }
};

/// Watches a run and judges its expectations.
class Judge : public Observer {
  public:
    explicit Judge(std::vector<Expectation> expectations);

    /// Before the run: the levels it begins with.
    void begin();

    void scanned(int task, const Scan& scan) override;
    bool looks_at_scans() const override { return !scanned_.empty(); }
    void settled(std::int64_t time, std::int64_t next) override;
    void save(StateWriter& out) const override;
    void restore(StateReader& in) override;

    /// Judges what is due at the end; what would be decided later is undecided.
    void finish(const RunResult& result);

    const std::vector<Expectation>& expectations() const { return expectations_; }
    const std::vector<Verdict>& verdicts() const { return verdicts_; }
    bool ok() const;

  private:
    void judge(std::size_t index, std::int64_t time, std::optional<std::int64_t> scan = {});
    void scanned(std::size_t index, int task, std::int64_t now, const Scan& scan);
    void count(std::size_t index, std::int64_t time);
    void await(std::size_t index, std::int64_t time, std::int64_t next);
    void fail(std::size_t index, std::string deviation);
    std::string undecided(std::size_t index, const RunResult& result) const;
    void conclude(std::size_t index, const RunResult& result);

    std::vector<Expectation> expectations_;
    std::vector<Verdict> verdicts_;
    std::vector<Watch> watches_;
    std::vector<std::size_t> timed_;    ///< indices that are judged at `from`, soonest first
    std::vector<std::size_t> scanned_;  ///< those that are judged or looked at in scans
    std::size_t next_timed_ = 0;
    std::int64_t next_ = never;  ///< the instant after the last one that is settled
};

/// For a trace's sidecar: `[{"text", "signal", "always", "ok"}...]`, with "at" [s] where an instant
/// is meant (the end has none), "low" and "high" where there are bounds that hold always or at it,
/// "deviation" where it failed, "undecided" where the run was too short to say.
nlohmann::ordered_json verdicts_json(const Judge& judge);

}  // namespace lineshaft
