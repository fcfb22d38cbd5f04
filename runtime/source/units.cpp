#include "runtime/source/units.hpp"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/source/number_text.hpp"

namespace lineshaft {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t longest_unit = 64;
constexpr Wide most_nanoseconds = 9'200'000'000'000'000'000;
constexpr std::int64_t most_factor = 1'000'000'000'000'000'000;

struct NamedUnit {
    std::string_view name;
    Unit::Dimension dimension;  ///< `dimensions` for a plain number
    int exponent;
    double numerator;
    double denominator;
};

constexpr std::array named_units{
    NamedUnit{"m", Unit::length, 1, 1, 1},       NamedUnit{"cm", Unit::length, 1, 1, 100},
    NamedUnit{"mm", Unit::length, 1, 1, 1000},   NamedUnit{"um", Unit::length, 1, 1, 1e6},
    NamedUnit{"nm", Unit::length, 1, 1, 1e9},    NamedUnit{"rad", Unit::angle, 1, 1, 1},
    NamedUnit{"mrad", Unit::angle, 1, 1, 1000},  NamedUnit{"deg", Unit::angle, 1, pi, 180},
    NamedUnit{"rev", Unit::angle, 1, 2 * pi, 1}, NamedUnit{"s", Unit::time, 1, 1, 1},
    NamedUnit{"ms", Unit::time, 1, 1, 1000},     NamedUnit{"us", Unit::time, 1, 1, 1e6},
    NamedUnit{"ns", Unit::time, 1, 1, 1e9},      NamedUnit{"min", Unit::time, 1, 60, 1},
    NamedUnit{"h", Unit::time, 1, 3600, 1},      NamedUnit{"Hz", Unit::time, -1, 1, 1},
    NamedUnit{"kHz", Unit::time, -1, 1000, 1},   NamedUnit{"MHz", Unit::time, -1, 1e6, 1},
    NamedUnit{"pulse", Unit::pulses, 1, 1, 1},   NamedUnit{"pulses", Unit::pulses, 1, 1, 1},
    NamedUnit{"%", Unit::dimensions, 0, 1, 100},
};

/// Multiplies `unit` by `factor` (`mm`, `s^3`), or divides; false when it is none.
bool apply(Unit& unit, std::string_view factor, bool divide) {
    if (factor == "rpm") return apply(unit, "rev", divide) && apply(unit, "min", !divide);
    const std::size_t caret = factor.find('^');
    const std::string_view name = factor.substr(0, caret);
    int power = 1;
    if (caret != std::string_view::npos) {
        if (caret + 2 != factor.size() || !is_digit(factor[caret + 1])) return false;
        power = factor[caret + 1] - '0';
    }
    const auto named = std::find_if(named_units.begin(), named_units.end(),
                                    [&](const NamedUnit& entry) { return entry.name == name; });
    if (named == named_units.end() || power == 0) return false;
    if (named->dimension != Unit::dimensions) {
        unit.exponents[named->dimension] += named->exponent * (divide ? -power : power);
    }
    for (int i = 0; i < power; ++i) {
        unit.numerator *= divide ? named->denominator : named->numerator;
        unit.denominator *= divide ? named->numerator : named->denominator;
    }
    return true;
}

bool is_whole(double x) {
    return x >= 1 && x <= 9e18 && x == std::floor(x);
}

bool is_multiple_of_pi(double x) {
    return std::round(x / pi) >= 1 && std::round(x / pi) * pi == x;
}

/// Removes the common factor of two factors of a fraction, one above and one below its bar.
void cancel(double& above, double& below) {
    double a = above;
    double b = below;
    if (is_multiple_of_pi(a) && is_multiple_of_pi(b)) {
        a = std::round(a / pi);
        b = std::round(b / pi);
    }
    if (!is_whole(a) || !is_whole(b)) return;
    const std::int64_t common =
        std::gcd(static_cast<std::int64_t>(a), static_cast<std::int64_t>(b));
    above = a / static_cast<double>(common);
    below = b / static_cast<double>(common);
}

struct Ratio {
    double above = 1;
    double below = 1;
};

/// How many `to` one `from` is, in lowest terms as far as these are whole numbers.
Ratio ratio_of(const Unit& from, const Unit& to) {
    double a = from.numerator;
    double b = from.denominator;
    double c = to.numerator;
    double d = to.denominator;
    cancel(a, b);
    cancel(d, c);
    cancel(a, c);
    cancel(d, b);
    return {a * d, b * c};
}

/// A finite double as the shortest decimal text that reads back as it: digits * 10^exponent.
struct Decimal {
    bool negative = false;
    Wide digits = 0;
    int exponent = 0;
};

Decimal decimal_of(double value) {
    assert(std::isfinite(value));
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), std::abs(value),
                                   std::chars_format::scientific);
    Decimal decimal;
    decimal.negative = std::signbit(value);
    const char* c = text.data();
    bool after_point = false;
    for (; *c != 'e'; ++c) {
        if (*c == '.') {
            after_point = true;
            continue;
        }
        decimal.digits = decimal.digits * 10 + (*c - '0');
        if (after_point) --decimal.exponent;
    }
    int exponent = 0;
    std::from_chars(c[1] == '+' ? c + 2 : c + 1, end.ptr, exponent);
    decimal.exponent += exponent;
    return decimal;
}

/// `value` * ratio through decimal text; empty where that does not end, or leaves double's range.
std::optional<double> convert_decimal(double value, const Ratio& ratio) {
    if (!std::isfinite(value) || !is_whole(ratio.above) || !is_whole(ratio.below)) return {};
    std::int64_t power = 1;
    int zeros = 0;
    const auto below = static_cast<std::int64_t>(ratio.below);
    for (; power % below != 0; power *= 10, ++zeros) {
        if (power >= most_factor) return {};
    }
    const Wide factor = static_cast<Wide>(ratio.above) * (power / below);
    if (factor > most_factor) return {};

    const Decimal decimal = decimal_of(value);
    std::array<char, 64> text{};
    const auto written =
        fmt::format_to_n(text.data(), text.size(), "{}{}e{}", decimal.negative ? "-" : "",
                         factor * decimal.digits, decimal.exponent - zeros);
    double result = 0;
    const auto read = std::from_chars(text.data(), written.out, result);
    if (read.ec != std::errc()) return {};
    return result;
}

/// value * ratio, rounded once: what the product and the quotient lose is computed and added.
double convert_binary(double value, const Ratio& ratio) {
    const double product = value * ratio.above;
    const double quotient = product / ratio.below;
    if (!std::isfinite(product) || quotient == 0) return value / ratio.below * ratio.above;
    const double lost = std::fma(value, ratio.above, -product);
    const double rest = std::fma(-quotient, ratio.below, product);
    return quotient + (rest + lost) / ratio.below;
}

/// Length of the digits at the beginning of `text`, with single underscores between them.
std::size_t digits_length(std::string_view text, bool hexadecimal = false) {
    const auto is_one = [&](char c) {
        const char lower = static_cast<char>(c | 0x20);
        return is_digit(c) || (hexadecimal && lower >= 'a' && lower <= 'f');
    };
    std::size_t length = 0;
    while (length < text.size()) {
        const bool joined = length > 0 && text[length] == '_' && length + 1 < text.size();
        const std::size_t next = joined ? length + 1 : length;
        if (!is_one(text[next])) break;
        length = next + 1;
    }
    return length;
}

std::string without_underscores(std::string_view text) {
    std::string out(text);
    std::erase(out, '_');
    return out;
}

/// What a number is read into, and how long it is in the text; 0: there is none.
struct Number {
    Quantity quantity;
    std::size_t length = 0;
    bool out_of_range = false;
};

/// `16#E0`, where `base_length` is 2.
Number based_number(std::string_view text, std::size_t base_length) {
    const std::string_view name = text.substr(0, base_length);
    const int base = name == "16" ? 16 : name == "8" ? 8 : name == "2" ? 2 : 0;
    const std::string_view rest = text.substr(base_length + 1);
    const std::size_t length = digits_length(rest, base == 16);
    const std::string digits = without_underscores(rest.substr(0, length));
    Number number;
    if (base == 0 || digits.empty()) return number;
    std::uint64_t value = 0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
    if (read.ptr != digits.data() + digits.size()) return number;
    number.length = base_length + 1 + length;
    number.out_of_range = read.ec != std::errc();
    number.quantity.number = static_cast<double>(value);
    number.quantity.is_integer = true;
    number.quantity.integer = value;
    return number;
}

/// Length of `e3`, `E-3` at the beginning of `text`, else 0.
std::size_t exponent_length(std::string_view text) {
    if (text.empty() || (text[0] != 'e' && text[0] != 'E')) return 0;
    const bool is_signed = text.size() > 1 && (text[1] == '-' || text[1] == '+');
    const std::size_t digits = digits_length(text.substr(is_signed ? 2 : 1));
    return digits == 0 ? 0 : digits + (is_signed ? 2 : 1);
}

Number number_at_beginning(std::string_view text) {
    const bool is_signed = !text.empty() && (text[0] == '-' || text[0] == '+');
    const std::size_t begin = is_signed ? 1 : 0;
    const std::size_t whole = digits_length(text.substr(begin));
    if (text.substr(begin + whole).starts_with('#')) {
        return is_signed ? Number{} : based_number(text, whole);
    }
    if (whole > 1 && text[begin] == '0') return {};

    std::size_t end = begin + whole;
    const bool point = text.substr(end).starts_with('.');
    const std::size_t fraction = point ? digits_length(text.substr(end + 1)) : 0;
    if (whole + fraction == 0) return {};
    if (point) end += 1 + fraction;
    const std::size_t exponent = exponent_length(text.substr(end));
    end += exponent;

    Number number;
    number.length = end;
    const std::size_t first = text[0] == '+' ? 1 : 0;
    const std::string written = without_underscores(text.substr(first, end - first));
    const char* const last = written.data() + written.size();
    Quantity& quantity = number.quantity;
    number.out_of_range = std::from_chars(written.data(), last, quantity.number).ec != std::errc();
    if (point || exponent > 0) return number;
    const auto integer = whole_number(written);
    quantity.is_integer = integer.has_value();
    quantity.integer = integer.value_or(0);
    return number;
}

}  // namespace

std::optional<Unit> Unit::parse(std::string_view text) {
    Unit unit;
    unit.text = text;
    if (text.empty()) return unit;
    if (text.size() > longest_unit) return {};
    std::string_view rest = text.starts_with("1/") ? text.substr(1) : text;
    bool divide = rest.front() == '/';
    if (divide && rest.size() == text.size()) return {};
    if (divide) rest.remove_prefix(1);
    while (true) {
        const std::size_t end = rest.find_first_of("*/");
        if (!apply(unit, rest.substr(0, end), divide)) return {};
        if (end == std::string_view::npos) break;
        divide = rest[end] == '/';
        rest.remove_prefix(end + 1);
    }
    if (!std::isfinite(unit.numerator) || !std::isfinite(unit.denominator)) return {};
    return unit;
}

std::string Unit::dimension_name() const {
    static constexpr std::array<std::string_view, dimensions> names{"length", "angle", "time",
                                                                    "pulses"};
    std::string above;
    std::string below;
    for (std::size_t i = 0; i < dimensions; ++i) {
        const int power = std::abs(exponents[i]);
        if (power == 0) continue;
        const std::string factor =
            power == 1 ? std::string(names[i]) : fmt::format("{}^{}", names[i], power);
        if (exponents[i] < 0) {
            below += "/" + factor;
        } else {
            above += (above.empty() ? "" : "*") + factor;
        }
    }
    if (above.empty()) above = below.empty() ? "number" : "1";
    return above + below;
}

double convert(double value, const Unit& from, const Unit& to) {
    assert(from.same_dimension(to));
    const Ratio ratio = ratio_of(from, to);
    if (ratio.above == ratio.below) return value;
    const std::optional<double> exact = convert_decimal(value, ratio);
    return exact ? *exact : convert_binary(value, ratio);
}

std::variant<Quantity, QuantityError> parse_quantity(std::string_view text) {
    Number number = number_at_beginning(text);
    if (number.length == 0) return QuantityError::not_a_number;
    text.remove_prefix(number.length);
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const std::optional<Unit> unit = Unit::parse(text);
    if (!unit) return QuantityError::unknown_unit;
    if (number.out_of_range) return QuantityError::out_of_range;
    number.quantity.has_unit = !text.empty();
    number.quantity.unit = *unit;
    return number.quantity;
}

const std::vector<std::string>& unit_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        all.reserve(named_units.size());
        for (const NamedUnit& named : named_units) all.emplace_back(named.name);
        all.emplace_back("rpm");
        return all;
    }();
    return names;
}

std::optional<Wide> whole_number(std::string_view text) {
    const char* const last = text.data() + text.size();
    std::int64_t with_sign = 0;
    const auto read = std::from_chars(text.data(), last, with_sign);
    if (read.ptr != last) return {};
    if (read.ec == std::errc()) return with_sign;
    std::uint64_t without = 0;
    if (std::from_chars(text.data(), last, without).ec != std::errc()) return {};
    return without;
}

std::optional<std::int64_t> to_nanoseconds(const Quantity& quantity) {
    const Unit nanosecond = *Unit::parse("ns");
    if (!quantity.unit.same_dimension(nanosecond)) return {};
    const Ratio ratio = ratio_of(quantity.unit, nanosecond);
    if (!is_whole(ratio.above) || !is_whole(ratio.below)) return {};
    if (ratio.below > static_cast<double>(most_factor)) return {};
    if (!std::isfinite(quantity.number)) return {};

    const Decimal decimal =
        quantity.is_integer ? Decimal{false, quantity.integer, 0} : decimal_of(quantity.number);
    Wide value = decimal.digits * static_cast<Wide>(ratio.above);
    if (decimal.negative) value = -value;
    const Wide most = most_nanoseconds * static_cast<Wide>(ratio.below);
    for (int i = 0; i < decimal.exponent && value != 0; ++i) {
        if (value > most || value < -most) return {};
        value *= 10;
    }
    for (int i = decimal.exponent; i < 0 && value != 0; ++i) {
        if (value % 10 != 0) return {};
        value /= 10;
    }
    if (value > most || value < -most) return {};
    const Wide below = static_cast<Wide>(ratio.below);
    if (value % below != 0) return {};
    return static_cast<std::int64_t>(value / below);
}

std::string format_number(double value) {
    std::array<char, longest_number> text{};
    return {text.data(), write_real(text.data(), value)};
}

std::string format_time(std::int64_t nanoseconds) {
    std::array<char, longest_number> text{};
    return std::string(text.data(), write_seconds(text.data(), nanoseconds)) + " s";
}

}  // namespace lineshaft
