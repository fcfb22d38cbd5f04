#pragma once

#include <cstddef>
#include <span>

#include "blocks/logic/number.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

enum class Comparison : std::size_t { gt, ge, eq, le, lt, ne };

inline constexpr std::string_view comparison_names[] = {"gt", "ge", "eq", "le", "lt", "ne"};
inline constexpr std::string_view comparison_docs[] = {"in1 > in2",  "in1 >= in2", "in1 = in2",
                                                       "in1 <= in2", "in1 < in2",  "in1 <> in2"};

/// Comparison of two numbers, IEC 61131-3:2013, table 33. Exact: eq has no tolerance.
template <Comparison comparison>
struct Compare {
    NumberUnit unit{};
    double in1 = 0, in2 = 0;

    bool out = false, error = false;
    NumberError error_id = NumberError::none;

    static constexpr std::string_view type = comparison_names[static_cast<std::size_t>(comparison)];
    static constexpr std::string_view doc = comparison_docs[static_cast<std::size_t>(comparison)];
    static std::span<const Field> fields();
    static constexpr auto main_input = &Compare::in1;
    void scan(const Scan& now);
};

using Gt = Compare<Comparison::gt>;
using Ge = Compare<Comparison::ge>;
using Eq = Compare<Comparison::eq>;
using Le = Compare<Comparison::le>;
using Lt = Compare<Comparison::lt>;
using Ne = Compare<Comparison::ne>;

/// A comparison that does not chatter, after the example HYSTERESIS of the standard: q rises with
/// in >= high, falls with in <= low, and stays in between. Error: high <= low.
struct Hysteresis {
    NumberUnit unit{};
    double in = 0, high = 1, low = 0;

    bool q = false, error = false;
    NumberError error_id = NumberError::none;

    static constexpr std::string_view type = "hysteresis";
    static constexpr std::string_view doc = "two-point switch: true from high on, false from low";
    static std::span<const Field> fields();
    static constexpr auto main_input = &Hysteresis::in;
    void scan(const Scan& now);
};

}  // namespace lineshaft
