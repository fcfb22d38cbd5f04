#pragma once

#include <span>
#include <string_view>

namespace lineshaft {

/// What `lineshaft explain` knows of a message: a part of runtime/source/codes.txt.
struct CodeText {
    std::string_view code;  ///< `L0203`
    std::string_view name;  ///< `unknown_port`, in namespace code
    std::string_view title;
    std::string_view paragraph;
};

/// Every code that a diagnostic may carry, in ascending order.
std::span<const CodeText> diagnostic_codes();

/// `L0203`, or `l0203`; null for an unknown code.
const CodeText* find_code(std::string_view code);

}  // namespace lineshaft
