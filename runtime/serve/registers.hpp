#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "runtime/outside/modbus_map.hpp"

namespace lineshaft {

/// A value as it stands in the registers of `signal`, from its first one on: in multiples of its
/// scale; of a whole number the nearest that the type has, 0 of what is no number.
void to_registers(const MappedSignal& signal, const Value& value, std::span<std::uint16_t> to);

/// The value that stands there. Empty when it is none of the signal's: 2 of a boolean, 1.5 of an
/// integer, an enumeration's number without a name, what is not finite.
std::optional<Value> from_registers(const MappedSignal& signal,
                                    std::span<const std::uint16_t> from);

}  // namespace lineshaft
