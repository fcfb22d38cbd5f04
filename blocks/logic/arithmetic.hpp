#pragma once

#include <cstddef>
#include <span>

#include "blocks/logic/number.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

enum class Operation : std::size_t { add, sub, mul, div, mod };

inline constexpr std::string_view operation_names[] = {"add", "sub", "mul", "div", "mod"};
inline constexpr std::string_view operation_docs[] = {"in1 + in2", "in1 - in2", "in1 * in2",
                                                      "in1 / in2", "remainder of in1 / in2"};

/// Arithmetic of two numbers, IEC 61131-3:2013, table 29. in1 and out are in `unit`; so is in2 of
/// ADD, SUB and MOD, while MUL and DIV take a plain number there. MOD has the sign of in1, as the
/// standard's division that drops the fraction gives it, and is exact. A divisor of 0 is an error
/// (the standard leaves DIV open and has MOD give 0).
template <Operation operation>
struct Arithmetic {
    static constexpr bool plain_in2 = operation == Operation::mul || operation == Operation::div;
    static constexpr bool divides = operation == Operation::div || operation == Operation::mod;

    NumberUnit unit{};
    double in1 = 0, in2 = divides ? 1 : 0;

    double out = 0;
    bool error = false;
    NumberError error_id = NumberError::none;

    static constexpr std::string_view type = operation_names[static_cast<std::size_t>(operation)];
    static constexpr std::string_view doc = operation_docs[static_cast<std::size_t>(operation)];
    static std::span<const Field> fields();
    void scan(const Scan& now);
};

using Add = Arithmetic<Operation::add>;
using Sub = Arithmetic<Operation::sub>;
using Mul = Arithmetic<Operation::mul>;
using Div = Arithmetic<Operation::div>;
using Mod = Arithmetic<Operation::mod>;

/// ABS, table 28.
struct Abs {
    NumberUnit unit{};
    double in = 0;

    double out = 0;
    bool error = false;
    NumberError error_id = NumberError::none;

    static constexpr std::string_view type = "abs";
    static constexpr std::string_view doc = "a number without its sign";
    static std::span<const Field> fields();
    static constexpr auto main_input = &Abs::in;
    void scan(const Scan& now);
};

enum class Conversion : std::size_t { lreal_to_lint, lreal_to_time };

/// Type conversion, table 22: to the nearest whole number, of two equally near the even one (as
/// there). `lreal_to_time` takes seconds and gives the whole ns that a timer's `pt` takes; a double
/// tells single ns apart up to 97 days. No conversion is needed the other way: a wire widens.
template <Conversion conversion>
struct Convert {
    double in = 0;

    std::int64_t out = 0;
    bool error = false;
    NumberError error_id = NumberError::none;

    static constexpr bool to_time = conversion == Conversion::lreal_to_time;
    static constexpr std::string_view type = to_time ? "lreal_to_time" : "lreal_to_lint";
    static constexpr std::string_view doc =
        to_time ? "a real number of seconds as a time" : "a real number rounded to an integer";
    static std::span<const Field> fields();
    static constexpr auto main_input = &Convert::in;
    void scan(const Scan& now);
};

using LrealToLint = Convert<Conversion::lreal_to_lint>;
using LrealToTime = Convert<Conversion::lreal_to_time>;

}  // namespace lineshaft
