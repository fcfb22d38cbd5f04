#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lineshaft {

/// A unit of measure: `mm`, `rad/s`, `mm/s^3`, `pulses/cm`, `kHz`, `%`, or none (empty text).
/// One of it is `numerator / denominator` of the dimension's base unit (m, rad, s, pulse).
struct Unit {
    enum Dimension { length, angle, time, pulses, dimensions };

    std::array<int, dimensions> exponents{};
    double numerator = 1;
    double denominator = 1;
    std::string text;

    /// Empty when the text is no unit. Grammar: factor (('*' | '/') factor)*, factor = name ['^' digit].
    /// Hz is 1/s. Prefixes are part of the listed names: nothing is composed.
    static std::optional<Unit> parse(std::string_view text);

    bool same_dimension(const Unit& other) const { return exponents == other.exponents; }

    /// `length / time`: what the unit measures, for messages ("length", "length/time^2", "number").
    std::string dimension_name() const;
};

/// `value` given in `from`, expressed in `to`; both of one dimension. Correctly rounded where the
/// units' ratio is a ratio of two integers (2 cm is exactly 20 mm, 3 ms exactly 0.003 s).
double convert(double value, const Unit& from, const Unit& to);

/// A number with an optional unit as it stands in a program file: `20 mm`, `1.5`, `5e4 mm/s^3`, `20 %`.
struct Quantity {
    double number = 0;
    Unit unit;
    bool has_unit = false;
    bool is_integer = false;      ///< written without point or exponent and within 64 bits
    std::int64_t integer = 0;     ///< exact value when is_integer
};

enum class QuantityError {
    not_a_number,   ///< no number at the beginning (`fast`, `.`, `010`: a leading zero is no number)
    out_of_range,   ///< a number beyond double's range
    unknown_unit,   ///< a number, then something that is no unit
};

/// Locale-independent (`std::from_chars`); decimal, `16#E0` and `2#1010` (IEC 61131-3 integer literals),
/// underscores between digits allowed as there. Infinite and NaN are no numbers.
std::variant<Quantity, QuantityError> parse_quantity(std::string_view text);

/// Every unit name that `Unit::parse` knows, for messages and the schema.
const std::vector<std::string>& unit_names();

/// Seconds-like quantity to whole nanoseconds; empty if it is no time, beyond +-9.2e18 ns (292 years)
/// or no whole number of nanoseconds. Exact for decimal text such as `0.1 s` or `1.25 ms`.
std::optional<std::int64_t> to_nanoseconds(const Quantity& quantity);

/// Shortest text that reads back as the same double (`std::to_chars`).
std::string format_number(double value);

}  // namespace lineshaft
