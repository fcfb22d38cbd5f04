#include "runtime/source/reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/formula.hpp"
#include "runtime/source/habits.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"

namespace lineshaft {

namespace {

std::string_view name_of(Node::Kind kind) {
    constexpr std::string_view names[] = {"a single value", "a map", "a list"};
    return names[static_cast<std::size_t>(kind)];
}

/// `mm/s (length/time)`, or `a plain number`.
std::string measure(const Unit& unit) {
    const bool plain = unit.same_dimension({});
    return plain ? "a plain number" : fmt::format("{} ({})", unit.text, unit.dimension_name());
}

std::string expected_in(const Unit& unit) {
    return (unit.same_dimension({}) ? "" : "a number in ") + measure(unit);
}

std::string given(const Quantity& q) {
    return (q.unit.same_dimension({}) ? "" : "in ") + measure(q.unit);
}

std::string number_help(std::string_view text, std::string expected) {
    if (text.size() > 1 && text[0] == '0' && is_digit(text[1]))
        return "a number has no leading zero";
    const bool comma = !text.empty() && is_digit(text[0]) && text.find(',') != text.npos;
    return comma ? "a number has a decimal point, not a comma" : std::move(expected);
}

/// The part of a quantity's unit that is none: `sec` of `10 mm/sec`; empty if there is no such
/// part.
std::string unknown_factor(std::string_view text) {
    const std::string_view number = text.substr(text.starts_with('+') ? 1 : 0);
    double ignored = 0;
    const char* const end =
        std::from_chars(number.data(), number.data() + number.size(), ignored).ptr;
    const auto blank = text.find(' ');
    std::string_view rest = number.substr(static_cast<std::size_t>(end - number.data()));
    if (blank != text.npos) rest = text.substr(blank + 1);
    while (!rest.empty()) {
        const auto length = std::min(rest.find_first_of("*/"), rest.size());
        const std::string_view factor = rest.substr(0, length);
        if (factor != "1" && !Unit::parse(factor)) return std::string(factor);
        rest.remove_prefix(std::min(length + 1, rest.size()));
    }
    return {};
}

/// The codes of what is reported where a value, a wire or a signal is expected.
constexpr std::string_view codes_of_values[] = {code::unknown_parameter, code::unknown_signal,
                                                code::not_a_number,      code::unknown_unit,
                                                code::not_a_boolean,     code::not_a_whole_number};

/// `at` and what is wrong become the character's.
void name_character(Diagnostic& at, std::string_view text, const LookAlike& character) {
    const bool as_written = at.mark.length == static_cast<int>(count_characters(text));
    if (as_written) {
        at.mark.column += static_cast<int>(count_characters(text.substr(0, character.offset)));
        at.mark.length = 1;
    }
    at.code = code::look_alike_character;
    at.message = fmt::format("{} stands in '{}'", character.name, text);
    at.help = fmt::format("write {} instead", character.instead);
}

}  // namespace

bool is_plain(const Unit& unit) {
    return unit.same_dimension({}) && unit.numerator == unit.denominator;
}

bool is_identifier(std::string_view text) {
    return !text.empty() && is_letter(text.front()) &&
           std::ranges::all_of(text, [](char c) { return is_letter(c) || is_digit(c); });
}

/// Sources may name a part with letters beyond ASCII.
bool is_part_letter(char c) {
    return is_letter(c) || !is_ascii(c);
}

/// `x`, or a part of it as `table[1,2].x`.
bool is_path(std::string_view text) {
    constexpr std::string_view marks = ".[],";
    char before = '.';
    for (const char c : text) {
        const bool begins = before == '.' || before == '[' || before == ',';
        const bool negative = c == '-' && (before == '[' || before == ',');
        if (!is_part_letter(c) && !is_digit(c) && !negative &&
            (begins || marks.find(c) == std::string_view::npos))
            return false;
        before = c;
    }
    return !text.empty() && is_part_letter(text.front()) &&
           (before == ']' || marks.find(before) == std::string_view::npos);
}

std::optional<SignalName> split_signal(std::string_view text) {
    const auto dot = text.find('.');
    if (dot == std::string_view::npos) return {};
    const SignalName name{text.substr(0, dot), text.substr(dot + 1)};
    if (!is_identifier(name.owner) || !is_path(name.port)) return {};
    return name;
}

/// What is wrong with the numbers of `2 mm + 3`, which is no formula; empty for all else.
static std::string why_not_computed(std::string_view text) {
    if (!is_digit(text.front()) || text.find_first_of("<>=&|") != text.npos) return {};
    const auto no_names = [](std::string_view) { return std::optional<Amount>(); };
    const FormulaResult result = evaluate(text, no_names);
    return result.name.empty() ? result.error : std::string();
}

void Reader::fail(const char* code, const Node& node, std::string message, std::string help) const {
    if (node.is_unknown_parameter()) return;
    Diagnostic found{code, node.mark, std::move(message), std::move(help)};
    if (const auto character = node.quoted ? std::nullopt : find_look_alike(node.text)) {
        name_character(found, node.text, *character);
    } else if (std::ranges::find(codes_of_values, found.code) != std::end(codes_of_values)) {
        std::string better = node.quoted && node.text.starts_with("NOT ")
                                 ? std::string()
                                 : expression_help(node.text);
        const std::string wrong = better.empty() ? std::string() : why_not_computed(node.text);
        if (!wrong.empty())
            found = {code::expression_for_a_value,
                     node.mark,
                     fmt::format("'{}' cannot be computed: {}", node.text, wrong),
                     {}};
        else if (!better.empty())
            found = {code::expression_for_a_value, node.mark,
                     fmt::format("'{}' is an expression", node.text), std::move(better)};
    }
    if (node.used_in_line > 0)
        found.message +=
            fmt::format(" (parameter '{}', used in line {})", node.parameter, node.used_in_line);
    else if (is_formula(node.parameter))
        found.message += fmt::format(" ('{}' is {})", node.parameter, node.text);
    else if (!node.parameter.empty())
        found.message += fmt::format(" (parameter '{}' is '{}')", node.parameter, node.text);
    out_.add(std::move(found.code), std::move(found.mark), std::move(found.message),
             std::move(found.help));
}

bool Reader::expect_map(const Node& node, std::string_view what, std::string help) const {
    if (!node.is_map())
        fail(code::wrong_kind_of_value, node,
             fmt::format("{} is a map, not {}", what, name_of(node.kind)), std::move(help));
    return node.is_map();
}

bool Reader::expect_sequence(const Node& node, std::string_view what, std::string help) const {
    if (!node.is_sequence())
        fail(code::wrong_kind_of_value, node,
             fmt::format("{} is a list, not {}", what, name_of(node.kind)), std::move(help));
    return node.is_sequence();
}

bool Reader::expect_scalar(const Node& node, std::string_view what) const {
    if (!node.is_scalar())
        fail(code::wrong_kind_of_value, node,
             fmt::format("{} is a single value, not {}", what, name_of(node.kind)));
    else if (node.is_empty())
        fail(code::wrong_kind_of_value, node, fmt::format("{} has no value", what));
    return node.is_scalar() && !node.is_empty();
}

bool Reader::identifier(const Node& node, std::string_view what) const {
    if (node.is_scalar() && is_identifier(node.text)) return true;
    fail(code::unusable_name, node, fmt::format("'{}' is not a name for {}", node.text, what),
         "a name has letters, digits and '_', and does not begin with a digit");
    return false;
}

std::optional<bool> Reader::boolean(const Node& node) const {
    if (!expect_scalar(node, "a boolean")) return {};
    if (!node.quoted && node.text == "true") return true;
    if (!node.quoted && node.text == "false") return false;
    fail(code::not_a_boolean, node, fmt::format("'{}' is not a boolean", node.text),
         node.quoted ? "write it without quotes" : "write true or false");
    return {};
}

std::optional<Quantity> Reader::quantity(const Node& node, std::string expected) const {
    if (!expect_scalar(node, "a number")) return {};
    if (node.quoted) {
        fail(code::not_a_number, node, "a text in quotes is not a number",
             "write it without quotes");
        return {};
    }
    const auto result = parse_quantity(node.text);
    if (const auto* quantity = std::get_if<Quantity>(&result)) return *quantity;
    const QuantityError error = std::get<QuantityError>(result);
    if (error == QuantityError::out_of_range) {
        fail(code::number_out_of_range, node,
             fmt::format("'{}' is beyond a 64-bit number's range", node.text));
        return {};
    }
    const std::string unit =
        error == QuantityError::unknown_unit ? unknown_factor(node.text) : std::string();
    if (unit.empty() || unit.starts_with(','))
        fail(code::not_a_number, node, fmt::format("'{}' is not a number", node.text),
             number_help(node.text, std::move(expected)));
    else
        fail(code::unknown_unit, node,
             fmt::format("the unit '{}' in '{}' is not known", unit, node.text),
             unit_help(unit, expected));
    return {};
}

std::optional<Wide> Reader::whole(const Node& node, std::string help) const {
    const auto q = quantity(node, "expected a whole number");
    if (!q) return {};
    if (q->is_integer && !q->has_unit) return q->integer;
    if (!q->has_unit && node.text.find_first_of(".eE") == std::string::npos) {
        fail(code::number_out_of_range, node,
             fmt::format("'{}' is beyond a 64-bit number's range", node.text));
        return {};
    }
    if (!q->has_unit)
        help = "write it without point and exponent";
    else if (help.empty())
        help = "expected a whole number without a unit";
    fail(code::not_a_whole_number, node, fmt::format("'{}' is not a whole number", node.text),
         std::move(help));
    return {};
}

std::optional<std::int64_t> Reader::integer(const Node& node, std::string help) const {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    const auto number = whole(node, std::move(help));
    if (!number || *number <= most) return number;
    fail(code::number_out_of_range, node,
         fmt::format("'{}' is above {}, the greatest integer that has a sign", node.text, most));
    return {};
}

std::optional<double> Reader::real(const Node& node, const Unit& unit) const {
    const auto q =
        quantity(node, is_plain(unit) ? "expected a plain number"
                                      : fmt::format("expected a number in {}", unit.text));
    if (!q) return {};
    if (!q->has_unit && !is_plain(unit)) {
        fail(code::unit_is_missing, node, fmt::format("'{}' has no unit", node.text),
             fmt::format("did you mean '{} {}'?", node.text, unit.text));
        return {};
    }
    if (!q->unit.same_dimension(unit)) {
        fail(code::unit_measures_something_else, node,
             fmt::format("'{}' is {}, expected {}", node.text, given(*q), expected_in(unit)));
        return {};
    }
    const double value = convert(q->number, q->unit, unit);
    if (std::isfinite(value)) return value;
    fail(code::number_out_of_range, node,
         fmt::format("'{}' is beyond a 64-bit number's range", node.text));
    return {};
}

std::optional<std::int64_t> Reader::time(const Node& node) const {
    static constexpr const char* help = "expected a time such as 2 ms";
    const auto q = quantity(node, help);
    if (!q) return {};
    static const Unit second = *Unit::parse("s");
    if (!q->has_unit) {
        fail(code::unit_is_missing, node, fmt::format("'{}' has no time unit", node.text),
             fmt::format("did you mean '{} ms' or '{} s'?", node.text, node.text));
        return {};
    }
    if (!q->unit.same_dimension(second)) {
        fail(code::not_a_time, node, fmt::format("'{}' is {}, not a time", node.text, given(*q)),
             help);
        return {};
    }
    const auto ns = to_nanoseconds(*q);
    if (ns && *ns >= 0) return ns;
    const double nanoseconds = convert(q->number, q->unit, *Unit::parse("ns"));
    if (q->number < 0)
        fail(code::not_a_time, node, fmt::format("'{}' is below 0", node.text));
    else if (nanoseconds >= static_cast<double>(std::numeric_limits<std::int64_t>::max()))
        fail(code::not_a_time, node, fmt::format("'{}' is too long", node.text),
             "times are counted in ns, up to 292 years");
    else
        fail(code::not_a_time, node,
             fmt::format("'{}' is not a whole number of nanoseconds", node.text),
             "times are counted in ns");
    return {};
}

std::optional<std::int64_t> Reader::time_or_share(const Node& node, std::int64_t whole) const {
    if (!is_share(node)) return time(node);
    const auto share = real(node, Unit());
    if (!share) return {};
    if (*share >= 0 && *share <= 1) return std::llround(*share * static_cast<double>(whole));
    fail(code::number_out_of_range, node,
         fmt::format("'{}' is not between 0 % and 100 %", node.text));
    return {};
}

std::optional<double> Reader::real_or_share(const Node& node, const Unit& unit,
                                            double whole) const {
    if (!is_share(node)) return real(node, unit);
    const auto share = real(node, Unit());
    return share ? std::optional(*share * std::abs(whole)) : std::nullopt;
}

bool is_share(const Node& node) {
    return node.is_scalar() && node.text.ends_with('%');
}

}  // namespace lineshaft
