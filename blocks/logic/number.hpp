#pragma once

#include <cstdint>
#include <string_view>

#include "blocks/inputs.hpp"

/// What the blocks that compute with numbers share. They compute in LREAL (64-bit real); a wire
/// widens an integer to it, exact up to 2^53.
namespace lineshaft {

/// Unit of a block's numbers, its parameter `unit`; plain numbers have none. Wires convert within
/// a dimension.
enum class NumberUnit : std::int64_t {};

inline constexpr std::string_view number_unit_names[] = {
    "",    "m",     "m/s",     "m/s^2", "mm", "mm/s", "mm/s^2", "rad",    "rad/s",   "rad/s^2",
    "deg", "deg/s", "deg/s^2", "s",     "ms", "Hz",   "kHz",    "pulses", "pulses/s"};

inline constexpr std::string_view number_unit_doc = "unit of the numbers; left out: plain numbers";

/// Why a block set `error`; its outputs are then held.
enum class NumberError : std::int64_t {
    none,
    not_finite,        ///< an input is NaN or infinite
    division_by_zero,  ///< the divisor is 0
    overflow,          ///< the result is beyond the type of the output
    wrong_index,       ///< `k` of MUX names no input
    wrong_limits,      ///< limits are equal or crossed, or a time is below 0
};

inline constexpr std::string_view number_error_names[] = {
    "none", "not_finite", "division_by_zero", "overflow", "wrong_index", "wrong_limits"};

inline constexpr std::string_view number_error_doc =
    "no result from these inputs; the output is held";

/// Sets `error` and `error_id`; true when there is none.
template <class Block>
bool report(Block& block, NumberError error) {
    block.error_id = error;
    block.error = error != NumberError::none;
    return !block.error;
}

/// Sets `out` to `value`, unless there is an error or no double holds it.
template <class Block>
void settle(Block& block, double value, NumberError error) {
    if (error == NumberError::none && !all_finite(value)) error = NumberError::overflow;
    if (report(block, error)) block.out = value;
}

template <class... T>
NumberError finite_error(T... inputs) {
    return all_finite(inputs...) ? NumberError::none : NumberError::not_finite;
}

}  // namespace lineshaft
