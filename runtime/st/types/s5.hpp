#pragma once

#include <optional>
#include <string_view>

#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

/// What Siemens' controllers have since the S5: S5TIME, a WORD that is a base and three digits;
/// TIMER and COUNTER, the number of one that the controller itself has.
extern const Type &s5time_type, &timer_type, &counter_type;

/// Null for another name.
const Type* find_s5_type(std::string_view name);

inline bool is_s5_number(const Type* type) {
    return type == &timer_type || type == &counter_type;
}

/// `T1`, `T#` is none; `C2` or, in German, `Z2`; whatever its capitals. Empty for another name.
struct S5Number {
    const Type* type = nullptr;
    Wide number = 0;
};
std::optional<S5Number> read_s5_number(std::string_view name);

/// `T#2s` as S5TIME: of the shortest base that has it in three digits, what is below its unit left
/// out. Empty: it is negative, or above 2h46m30s.
std::optional<Wide> s5time_of(Wide nanoseconds);

/// 25 is 16#25; empty: it has more than three digits.
std::optional<Wide> three_digits(Wide value);

}  // namespace lineshaft::st
