#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/source/units.hpp"

namespace lineshaft {

/// A number and what it is in: `20 mm`, `5 %`, or a plain one.
struct Amount {
    double value = 0;
    Unit unit = {};

    Amount(double plain = 0) : value(plain) {}
    Amount(double in, Unit of) : value(in), unit(std::move(of)) {}

    /// `20 mm`, which parse_quantity() reads again: with 15 digits, so that 3 * 0.1 s is 0.3 s; a
    /// whole number has no exponent.
    std::string text() const;
};

/// What a name in a formula stands for; empty when there is none.
using Lookup = std::function<std::optional<Amount>(std::string_view name)>;

struct FormulaResult {
    Amount amount;
    std::string error;         ///< empty when all is well
    std::string name;          ///< that is unknown, if that is the error
    std::size_t position = 0;  ///< of the error in the text, from 0
};

/// Evaluates `1 - early / immediate`, `$radius / 2 + 1 mm`, `cos(0.02)`: + - * / with the usual
/// precedence, unary minus, parentheses, numbers with or without a unit, names (letters, digits,
/// '_' and '.', perhaps a '$' before), the constant pi, abs(x), sqrt(x), exp(x), ln(x), min(a,
/// ...), max(a, ...), mean(a, ...), sin(x), cos(x), tan(x) of an angle or a plain number [rad], and
/// asin(x), acos(x), atan(x), atan2(y, x) [rad]. What is added or compared is of one dimension, and
/// comes in the first one's unit; a product is in its only unit, else in base units. At most 100
/// levels deep. `operation` names one more function of one value, which is taken as that value: for
/// a check of a formula that somebody else evaluates.
FormulaResult evaluate(std::string_view formula, const Lookup& lookup,
                       std::string_view operation = {});

/// Looks like a formula, and is neither a name nor a quantity: `$speed * 2`, `cos(0.02)`, `1 mm /
/// 3` but not `b.q`, `10 mm/s` or `every(servo)`.
bool is_formula(std::string_view text);

}  // namespace lineshaft
