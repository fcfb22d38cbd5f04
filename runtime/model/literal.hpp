#pragma once

#include <optional>
#include <string>

#include "runtime/model/field.hpp"
#include "runtime/source/reader.hpp"

namespace lineshaft {

/// A constant for `field`, whose unit is `unit` here: checked for type, unit, names and limits;
/// reported to `read` when it does not fit.
std::optional<Value> read_literal(const Reader& read, const Node& node, const Field& field,
                                  const Unit& unit);

/// `mm/s > 0`, `one of: a, b`: what a field takes, for messages.
std::string describe_limits(const Field& field, const std::string& unit);

}  // namespace lineshaft
