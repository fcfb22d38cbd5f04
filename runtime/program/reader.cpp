#include "runtime/program/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lineshaft {

namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view name_of(Node::Kind kind) {
    constexpr std::string_view names[] = {"a single value", "a map", "a list"};
    return names[static_cast<std::size_t>(kind)];
}

}  // namespace

bool is_plain(const Unit& unit) {
    return unit.same_dimension({}) && unit.numerator == unit.denominator;
}

bool is_identifier(std::string_view text) {
    return !text.empty() && is_letter(text.front()) &&
           std::ranges::all_of(text, [](char c) { return is_letter(c) || is_digit(c); });
}

bool is_signal_name(std::string_view text) {
    const auto dot = text.find('.');
    return dot != std::string_view::npos && is_identifier(text.substr(0, dot)) &&
           is_identifier(text.substr(dot + 1));
}

void Reader::fail(const char* code, const Node& node, std::string message, std::string help) const {
    if (!node.parameter.empty())
        message += fmt::format(" (parameter '{}' is '{}')", node.parameter, node.text);
    out_.add(code, node.mark, std::move(message), std::move(help));
}

bool Reader::expect_map(const Node& node, std::string_view what) const {
    if (!node.is_map())
        fail("L0209", node, fmt::format("{} is a map, not {}", what, name_of(node.kind)));
    return node.is_map();
}

bool Reader::expect_sequence(const Node& node, std::string_view what) const {
    if (!node.is_sequence())
        fail("L0209", node, fmt::format("{} is a list, not {}", what, name_of(node.kind)));
    return node.is_sequence();
}

bool Reader::expect_scalar(const Node& node, std::string_view what) const {
    if (!node.is_scalar())
        fail("L0209", node, fmt::format("{} is a single value, not {}", what, name_of(node.kind)));
    else if (node.is_empty())
        fail("L0209", node, fmt::format("{} has no value", what));
    return node.is_scalar() && !node.is_empty();
}

void Reader::only_keys(const Node& map, std::string_view what,
                       std::initializer_list<std::string_view> allowed) const {
    for (const auto& [key, value] : map.entries)
        if (std::ranges::find(allowed, key.text) == allowed.end())
            fail("L0201", key, fmt::format("unknown key '{}' in {}", key.text, what),
                 suggest(key.text, {allowed.begin(), allowed.end()}));
}

const Node* Reader::require(const Node& map, std::string_view key, std::string_view what) const {
    const Node* value = map.find(key);
    if (!value) fail("L0202", map, fmt::format("{} has no '{}'", what, key));
    return value;
}

bool Reader::identifier(const Node& node, std::string_view what) const {
    if (node.is_scalar() && is_identifier(node.text)) return true;
    fail("L0210", node, fmt::format("'{}' is no name for {}", node.text, what),
         "a name has letters, digits and '_', and does not begin with a digit");
    return false;
}

std::optional<bool> Reader::boolean(const Node& node) const {
    if (!expect_scalar(node, "a boolean")) return {};
    if (!node.quoted && node.text == "true") return true;
    if (!node.quoted && node.text == "false") return false;
    fail("L0307", node, fmt::format("'{}' is no boolean", node.text), "write true or false");
    return {};
}

std::optional<Quantity> Reader::quantity(const Node& node) const {
    if (!expect_scalar(node, "a number")) return {};
    if (node.quoted) {
        fail("L0301", node, "a text in quotes is no number", "write it without quotes");
        return {};
    }
    const auto result = parse_quantity(node.text);
    if (const auto* quantity = std::get_if<Quantity>(&result)) return *quantity;
    switch (std::get<QuantityError>(result)) {
        case QuantityError::not_a_number:
            fail("L0301", node, fmt::format("'{}' is no number", node.text));
            break;
        case QuantityError::out_of_range:
            fail("L0305", node, fmt::format("'{}' is beyond a 64-bit number's range", node.text));
            break;
        case QuantityError::unknown_unit: {
            const auto start = node.text.find_first_of(' ');
            const std::string unit =
                start == std::string::npos ? node.text : node.text.substr(start + 1);
            fail("L0304", node, fmt::format("unknown unit in '{}'", node.text),
                 suggest(unit, unit_names()));
        }
    }
    return {};
}

std::optional<std::int64_t> Reader::integer(const Node& node) const {
    const auto q = quantity(node);
    if (!q) return {};
    if (q->is_integer && !q->has_unit) return q->integer;
    fail("L0309", node, fmt::format("'{}' is no whole number", node.text));
    return {};
}

std::optional<double> Reader::real(const Node& node, const Unit& unit) const {
    const auto q = quantity(node);
    if (!q) return {};
    if (!q->has_unit && !is_plain(unit)) {
        fail("L0302", node, fmt::format("'{}' has no unit", node.text),
             fmt::format("did you mean '{} {}'?", node.text, unit.text));
        return {};
    }
    if (!q->unit.same_dimension(unit)) {
        const std::string due = unit.text.empty() ? "a plain number is" : unit.text + " is";
        fail("L0303", node,
             fmt::format("'{}' is {}, where {} due", node.text, q->unit.dimension_name(), due));
        return {};
    }
    const double value = convert(q->number, q->unit, unit);
    if (std::isfinite(value)) return value;
    fail("L0305", node, fmt::format("'{}' is beyond a 64-bit number's range", node.text));
    return {};
}

std::optional<std::int64_t> Reader::time(const Node& node) const {
    const auto q = quantity(node);
    if (!q) return {};
    static const Unit second = *Unit::parse("s");
    if (!q->has_unit) {
        fail("L0302", node, fmt::format("'{}' has no time unit", node.text),
             fmt::format("did you mean '{} ms' or '{} s'?", node.text, node.text));
        return {};
    }
    if (!q->unit.same_dimension(second)) {
        fail("L0308", node, fmt::format("'{}' is {}, no time", node.text, q->unit.dimension_name()),
             "write a time such as 2 ms");
        return {};
    }
    const auto ns = to_nanoseconds(*q);
    if (ns && *ns >= 0) return ns;
    fail("L0308", node, fmt::format("'{}' is no time that can be kept", node.text),
         "a time is a whole number of nanoseconds, not negative, at most 292 years");
    return {};
}

std::optional<std::int64_t> Reader::time_or_share(const Node& node, std::int64_t whole) const {
    if (!node.is_scalar() || node.text.find('%') == std::string::npos) return time(node);
    static const Unit one;
    const auto share = real(node, one);
    if (!share) return {};
    if (*share >= 0 && *share <= 1)
        return std::llround(*share * static_cast<double>(whole));
    fail("L0305", node, fmt::format("'{}' is not between 0 % and 100 %", node.text));
    return {};
}

}  // namespace lineshaft
