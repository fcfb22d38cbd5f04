#pragma once

#include <optional>
#include <vector>

#include "runtime/outside/outside.hpp"
#include "runtime/scan/judge.hpp"

namespace lineshaft {

/// What the program expects, for the judge.
std::vector<Expectation> connect_expectations(const Connecting& to);

/// A bound of what the signal may be, in its unit; an enumeration's name is its number.
std::optional<Value> read_bound(const Connecting& to, const Signal& signal, const Node& node);

}  // namespace lineshaft
