#pragma once

#include <cstddef>
#include <span>

#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

enum class BooleanKind : std::size_t { and_, or_, xor_ };

inline constexpr std::string_view boolean_names[] = {"and", "or", "xor"};
inline constexpr std::string_view boolean_docs[] = {
    "true when all inputs are", "true when any input is", "true when an odd number of inputs is"};

/// AND, OR, XOR of two to eight booleans, IEC 61131-3:2013, table 31. Inputs left out change
/// nothing. XOR is true when an odd number of its inputs is.
template <BooleanKind kind>
struct Boolean {
    static constexpr bool neutral = kind == BooleanKind::and_;
    bool in1 = neutral, in2 = neutral, in3 = neutral, in4 = neutral;
    bool in5 = neutral, in6 = neutral, in7 = neutral, in8 = neutral;

    bool out = false;

    static constexpr std::string_view type = boolean_names[static_cast<std::size_t>(kind)];
    static constexpr std::string_view doc = boolean_docs[static_cast<std::size_t>(kind)];
    static std::span<const Field> fields();
    void scan(const Scan& now);
};

using And = Boolean<BooleanKind::and_>;
using Or = Boolean<BooleanKind::or_>;
using Xor = Boolean<BooleanKind::xor_>;

template <>
void And::scan(const Scan& now);
template <>
void Or::scan(const Scan& now);
template <>
void Xor::scan(const Scan& now);

/// NOT, table 31. On a wire, `NOT x.q` does the same without a block.
struct Not {
    bool in = false;
    bool out = false;

    static constexpr std::string_view type = "not";
    static constexpr std::string_view doc = "true when the input is false";
    static std::span<const Field> fields();
    static constexpr auto main_input = &Not::in;
    void scan(const Scan& now);
};

}  // namespace lineshaft
