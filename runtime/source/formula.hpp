#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace lineshaft {

/// Value of a name in a formula; empty when there is none.
using Lookup = std::function<std::optional<double>(std::string_view name)>;

struct FormulaResult {
    double value = 0;
    std::string error;         ///< empty when all is well
    std::string name;          ///< that is unknown, if that is the error
    std::size_t position = 0;  ///< of the error in the text, from 0
};

/// Evaluates `1 - early / immediate`, `abs(a.fit.worst_x) / 20`: + - * / with the usual precedence,
/// unary minus, parentheses, numbers, names (letters, digits, '_' and '.'), abs(x), sqrt(x), min(a,
/// ...), max(a, ...), mean(a, ...). At most 100 levels deep. `operation` names one more function of
/// one value, which is taken as that value: for a check of a formula that somebody else evaluates.
FormulaResult evaluate(std::string_view formula, const Lookup& lookup,
                       std::string_view operation = {});

}  // namespace lineshaft
