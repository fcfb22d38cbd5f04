#pragma once

#include <span>
#include <string_view>

namespace lineshaft {

/// What `lineshaft explain` knows of a message.
struct CodeText {
    std::string_view code;
    std::string_view title;
    std::string_view paragraph;
};

/// Every code that a diagnostic may carry, in ascending order.
std::span<const CodeText> diagnostic_codes();

/// `L0203`, or `l0203`; null for an unknown code.
const CodeText* find_code(std::string_view code);

}  // namespace lineshaft
