#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace lineshaft {

/// A character that looks like one of the keyboard, or like nothing, and is another.
struct LookAlike {
    std::size_t offset = 0;    ///< in the text, in bytes
    std::string name;          ///< "a no-break space (U+00A0)"
    std::string_view instead;  ///< "a blank", "'-'"
};

/// The first one in `text`: spaces other than the blank, minus signs, dashes, typographic quotes, a
/// wide colon.
std::optional<LookAlike> find_look_alike(std::string_view text);

/// What to write instead of an expression, which a file has none of: the block of IEC 61131-3 that
/// does it
/// (`a.q AND b.q`: 'and'), or for a text that begins with a comparison (`>= 5 mm`) a bound. Empty
/// if `text` is none.
std::string expression_help(std::string_view text);

/// What to write instead of `name`, which is no unit of `Unit::parse`: its right spelling ("did you
/// mean 's'?"), or what it measures ("'Nm' measures torque; expected a number in mm"), else where
/// the units are listed.
std::string unit_help(std::string_view name, std::string_view expected);

}  // namespace lineshaft
