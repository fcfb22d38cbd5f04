#pragma once

#include <cstdint>
#include <string_view>

namespace lineshaft::st {

/// Why a scan of a block ended before its end.
enum class Fault : std::int64_t {
    none,
    array_bounds,
    division_by_zero,
    out_of_range,         ///< a value beyond its type: of a conversion, a subrange, an enumeration
    no_reference,         ///< a block with VAR_IN_OUT that no other block calls, or has called yet
    no_end,               ///< more loops and calls than one scan may have
    runs_already,         ///< a method is called, by what it calls, on the instance it works on
    outside_of_variable,  ///< a reference is to nothing of its type that its variable has
    call_has_ended,       ///< the one that had the variable that is referred to
    assertion,            ///< of a TEST, which ends with it
    calls_too_deep,       ///< routines that call themselves do so more often than there is room for
};

inline constexpr std::string_view fault_names[] = {
    "none",           "array_bounds", "division_by_zero", "out_of_range",
    "no_reference",   "no_end",       "runs_already",     "outside_of_variable",
    "call_has_ended", "assertion",    "calls_too_deep"};

}  // namespace lineshaft::st
