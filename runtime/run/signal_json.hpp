#pragma once

#include <nlohmann/json.hpp>

#include "runtime/machine/machine.hpp"

namespace lineshaft {

/// A number that was reckoned, of a statistic say: null when it is not finite, for there is none.
nlohmann::ordered_json json_number(double value);

/// A real number of a program: JSON has none that is not finite, which is the text NaN, INF or
/// -INF, as in a trace.
nlohmann::ordered_json real_json(double value);

/// An enumeration's number as it is stored, as what it counts.
nlohmann::ordered_json stored_json(const ValueNames& names, std::int64_t stored);

/// A signal's value: true or false, an enumeration's name or a number that has none, a number, or
/// what real_json() makes of it.
nlohmann::ordered_json to_json(const Signal& signal, const Value& value);

}  // namespace lineshaft
