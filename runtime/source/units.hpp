#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "runtime/source/wide.hpp"

namespace lineshaft {

/// A unit of measure: `mm`, `rad/s`, `mm/s^3`, `pulses/cm`, `kHz`, `%`, or none (empty text).
/// One of it is `numerator / denominator` of the dimension's base unit (m, rad, s, pulse).
struct Unit {
    enum Dimension { length, angle, time, pulses, dimensions };

    std::array<int, dimensions> exponents{};
    double numerator = 1;
    double denominator = 1;
    std::string text;

    /// Empty when the text is no unit. Grammar: factor (('*' | '/') factor)*, without spaces, where
    /// factor = name ['^' digit] and each '/' divides by the one factor after it; `1/s` begins with
    /// the number 1, which is no unit by itself. Hz is 1/s, rpm (without a power) rev/min. Prefixes
    /// are part of the listed names: nothing is composed. The empty text is the unit of plain
    /// numbers.
    static std::optional<Unit> parse(std::string_view text);

    bool same_dimension(const Unit& other) const { return exponents == other.exponents; }

    /// `length / time`: what the unit measures, for messages ("length", "length/time^2", "number").
    std::string dimension_name() const;
};

/// `value` given in `from`, expressed in `to`; both of one dimension. Where the units' ratio is a
/// finite decimal (not so: s to min, deg to rad) the value is taken as the decimal text
/// it is written with (`format_number`), and the result is that text's value in `to`, correctly
/// rounded: 1.005 m is 1005 mm, not 1004.9999999999999. Else it is value * ratio, correctly
/// rounded.
double convert(double value, const Unit& from, const Unit& to);

/// A number with an optional unit as it stands in a program file: `20 mm`, `1.5`, `5e4 mm/s^3`,
/// `20 %`. A percentage is a plain number of scale 1/100: convert it to the port's unit.
struct Quantity {
    double number = 0;
    Unit unit;
    bool has_unit = false;
    bool is_integer = false;  ///< written without point or exponent and within 64 bits, with or
                              ///< without a sign
    Wide integer = 0;         ///< exact value when is_integer
};

enum class QuantityError {
    not_a_number,  ///< no number at the beginning (`fast`, `.`, `010`: a leading zero is no number)
    out_of_range,  ///< a number beyond double's range, or too small to be told from 0
    unknown_unit,  ///< a number, then something that is no unit
};

/// Locale-independent. A number is what `std::from_chars` takes (`5`, `-5`, `.5`, `5.`, `1e3`), or
/// with a '+'; or `16#E0`, `8#17`, `2#1010` without sign (IEC 61131-3 integer literals); with
/// single underscores between digits as there. Infinite and NaN are no numbers. Spaces between
/// number and unit are optional (`2ms`).
std::variant<Quantity, QuantityError> parse_quantity(std::string_view text);

/// The whole text as a decimal integer of 64 bits, with or without a sign: -2^63 to 2^64 - 1.
std::optional<Wide> whole_number(std::string_view text);

/// Every unit name that `Unit::parse` knows, each once, for messages.
const std::vector<std::string>& unit_names();

/// Seconds-like quantity to whole nanoseconds; empty if it is no time, beyond +-9.2e18 ns (292
/// years) or no whole number of nanoseconds. Integer arithmetic on the decimal text: exact for
/// `0.1 s`, `1.25 ms` and all others of up to 15 digits, or of 18 without point and exponent.
std::optional<std::int64_t> to_nanoseconds(const Quantity& quantity);

/// Shortest text that reads back as the same double, as in traces (see write_real); `inf`, `nan`.
std::string format_number(double value);

/// `12.345 s`, exact from integer nanoseconds.
std::string format_time(std::int64_t nanoseconds);

}  // namespace lineshaft
