#pragma once

#include <nlohmann/json.hpp>

#include "runtime/machine/machine.hpp"

namespace lineshaft {

/// A real number for JSON: null when it is not finite.
nlohmann::ordered_json json_number(double value);

/// A signal's value: true or false, an enumeration's name or a number that has none, a number; null
/// if it is not finite.
nlohmann::ordered_json to_json(const Signal& signal, const Value& value);

}  // namespace lineshaft
