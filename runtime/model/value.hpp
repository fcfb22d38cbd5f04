#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "runtime/model/value_names.hpp"
#include "runtime/source/wide.hpp"

namespace lineshaft {

/// The kinds of data a signal carries. An enumeration is stored as its number, 64 bits wide. An
/// unsigned integer has the values from 2^63 on that no other integer has (ULINT, LWORD); those who
/// look from outside take both for integers.
enum class Type : std::uint8_t { boolean, integer, real, enumeration, unsigned_integer };

/// Enumerations count as integers here; their names stand in the field.
using Value = std::variant<bool, std::int64_t, double, std::uint64_t>;

/// With a sign or without.
constexpr bool is_integer(Type type) {
    return type == Type::integer || type == Type::unsigned_integer;
}

/// In ns.
constexpr bool is_time(Type type, std::string_view unit) {
    return is_integer(type) && unit == "ns";
}

constexpr std::size_t size_of(Type type) {
    return type == Type::boolean ? 1 : 8;
}

constexpr std::string_view name_of(Type type) {
    constexpr std::string_view names[] = {"boolean", "integer", "real", "enumeration", "integer"};
    return names[static_cast<std::size_t>(type)];
}

/// As its bytes are.
template <class T>
T read(const std::byte* slot) {
    T value;
    std::memcpy(&value, slot, sizeof value);
    return value;
}

/// Reads the signal of `type` that is stored at `slot`.
Value load(Type type, const std::byte* slot);

/// Writes `value`, which must be of `type`, to `slot`.
void store(Type type, std::byte* slot, const Value& value);

/// The integer, which counts for a boolean and an enumeration, too; empty for a real.
std::optional<Wide> whole(const Value& value);

/// As a value of the type, which is one of integers; empty where that has none such.
std::optional<Value> whole_value(Wide number, Type type);

/// As a trace has it: boolean 0 or 1, enumeration its number, shortest round-trip real.
std::string format(const Value& value);

/// As a person reads it: `true`, an enumeration's name or the number that has none, a number with
/// its unit.
std::string describe(const Value& value, Type type, const ValueNames& names, std::string_view unit);

/// For formulas: true is 1.
double as_real(const Value& value);

/// Exact, also of integers beyond 2^53 and of an integer with a real; true is 1. A real that is
/// not a number is unordered.
std::partial_ordering compare(const Value& a, const Value& b);

}  // namespace lineshaft
