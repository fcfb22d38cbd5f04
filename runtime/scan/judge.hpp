#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "runtime/scan/executive.hpp"

namespace lineshaft {

/// A statement about a signal, at an instant, at the end, or after every scan of the task that
/// writes it. It holds when low <= value <= high; true counts as 1, an enumeration as its number.
struct Expectation {
    std::string text;  ///< as `run` prints it: `at 1 s: slave.in_gear = true`
    Signal signal;
    bool always = false;
    std::optional<std::int64_t> at;  ///< [ns]; empty and not always: at the end
    Value low = -std::numeric_limits<double>::infinity();
    Value high = std::numeric_limits<double>::infinity();
    std::string wanted;  ///< `true`, `15 mm/s`, for the message
};

struct Verdict {
    bool ok = false;
    std::string deviation;  ///< of the first failure: scan, time, both values; empty when ok
};

/// Watches a run and judges its expectations.
class Judge : public Observer {
  public:
    explicit Judge(std::vector<Expectation> expectations);

    void scanned(int task, const Scan& scan) override;
    void settled(std::int64_t time, std::int64_t next) override;
    void save(StateWriter& out) const override;
    void restore(StateReader& in) override;

    /// Judges what is due at the end; what was due later has failed.
    void finish(const RunResult& result);

    const std::vector<Expectation>& expectations() const { return expectations_; }
    const std::vector<Verdict>& verdicts() const { return verdicts_; }
    bool ok() const;

  private:
    void judge(std::size_t index, std::int64_t time, std::optional<std::int64_t> scan);

    std::vector<Expectation> expectations_;
    std::vector<Verdict> verdicts_;
    std::vector<std::size_t> timed_;  ///< indices with a time, soonest first
    std::vector<std::size_t> always_;
    std::size_t next_timed_ = 0;
};

/// For a trace's sidecar: `[{"text", "signal", "always", "ok"}...]`, with "at" [s] where an instant
/// is meant (the end has none), "low" and "high" where there are bounds, "deviation" where it
/// failed.
nlohmann::ordered_json verdicts_json(const Judge& judge);

}  // namespace lineshaft
