#pragma once

#include <string>
#include <vector>

#include "runtime/run/single_run.hpp"

namespace lineshaft::debug {

/// Conditions on a program's signals, which stop a run when they become true:
/// `slave.velocity > 20 mm/s`, `axis.state = standstill`, `inputs.start`, `NOT drive.ready`,
/// `time >= 2 s`.
class SignalConditions {
  public:
    explicit SignalConditions(Loaded& loaded) : loaded_(loaded) {}

    /// In place of those that there were. Of each what is wrong with it; empty: nothing.
    std::vector<std::string> set(const std::vector<std::string>& texts);

    bool empty() const { return conditions_.empty(); }

    /// What is so now is no reason to stop.
    void begin(std::int64_t time);

    /// The first one that has become true since it was asked last; empty: none has.
    std::string risen(std::int64_t time);

  private:
    enum class Is : std::uint8_t { below, at_most, above, at_least, equal, unequal };
    struct Condition {
        std::string text;
        bool is_of_time = false;
        Signal signal = {};
        Is is = Is::equal;
        Value wanted = true;
        bool level = false;
    };

    static bool holds(const Condition& condition, std::int64_t time);
    void read(Condition& condition, Diagnostics& out);

    Loaded& loaded_;
    std::vector<Condition> conditions_;
};

}  // namespace lineshaft::debug
