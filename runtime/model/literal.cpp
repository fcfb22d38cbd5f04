#include "runtime/model/literal.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft {

namespace {

/// `Run` of `E_State.Run` and `E_State#Run`.
std::string_view name_in(std::string_view text, std::string_view type) {
    const std::size_t end = text.find_last_of(".#");
    const bool is_its = end != text.npos && same_letters(text.substr(0, end), type);
    return is_its ? text.substr(end + 1) : text;
}

template <class T>
std::optional<Wide> read_number(std::string_view text) {
    T number = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc{} || stop != end) return {};
    return number;
}

/// As it is stored.
std::optional<std::int64_t> read_number(std::string_view text, const ValueNames& names) {
    const auto number =
        names.has_sign() ? read_number<std::int64_t>(text) : read_number<std::uint64_t>(text);
    return number ? names.stored(*number) : std::nullopt;
}

/// `Idle (0), Run (10)`
std::string list_of(const ValueNames& names) {
    std::string text;
    std::size_t place = 0;
    for (const std::string_view name : names) {
        text += fmt::format("{}{} ({})", place == 0 ? "" : ", ", name,
                            names.whole(names.number(place)));
        ++place;
    }
    return text;
}

std::optional<Value> read_name(const Reader& read, const Node& node, const Field& field) {
    if (!read.expect_scalar(node, "a name")) return {};
    if (const auto number = field.names.find(name_in(node.text, field.names.type())))
        return Value(*number);
    const auto number = read_number(node.text, field.names);
    const bool is_number = number && field.names.may_be_written_as_numbers();
    if (is_number && field.names.takes(*number)) return Value(*number);
    std::vector<std::string> names(field.names.begin(), field.names.end());
    std::erase(names, "");
    read.fail(code::no_allowed_name, node,
              fmt::format("'{}' is not a value of '{}'", node.text, field.name),
              is_number ? "its values are " + list_of(field.names) : suggest(node.text, names));
    return {};
}

void out_of_range(const Reader& read, const Node& node, const Field& field, const Unit& unit) {
    using Limits = std::numeric_limits<std::int64_t>;
    std::string limits = describe_limits(field, unit.text);
    if (limits.empty()) limits = fmt::format("from {} to {}", Limits::min(), Limits::max());
    read.fail(code::number_out_of_range, node,
              fmt::format("'{}' is out of range for '{}'", node.text, field.name),
              "it must be " + limits);
}

std::optional<Value> read_integer(const Reader& read, const Node& node, const Field& field,
                                  const Unit& unit) {
    std::optional<Wide> number;
    if (unit.text.empty()) {
        number = read.whole(node);
    } else if (is_time(field.type, unit.text)) {
        number = read.time(node);
    } else if (const auto value = read.real(node, unit)) {
        if (*value == std::trunc(*value) && std::abs(*value) < 9e15)
            number = static_cast<std::int64_t>(*value);
        else
            read.fail(code::not_a_whole_number, node,
                      fmt::format("'{}' is not a whole number of {} for '{}'", node.text, unit.text,
                                  field.name));
    }
    if (!number) return {};
    const auto value = whole_value(*number, field.type);
    if (!value) out_of_range(read, node, field, unit);
    return value;
}

}  // namespace

std::string describe_limits(const Field& field, const std::string& unit) {
    const auto number = [](double limit) {
        const bool whole = limit == std::trunc(limit) && std::abs(limit) < 9e15;
        return whole ? std::to_string(static_cast<std::int64_t>(limit)) : format_number(limit);
    };
    const std::string suffix = unit.empty() ? "" : " " + unit;
    std::string text;
    if (std::isfinite(field.minimum))
        text = fmt::format("{} {}{}", field.minimum_excluded ? "above" : "at least",
                           number(field.minimum), suffix);
    if (std::isfinite(field.maximum))
        text += fmt::format("{}{} {}{}", text.empty() ? "" : ", ",
                            field.maximum_excluded ? "below" : "at most", number(field.maximum),
                            suffix);
    return text;
}

std::optional<Value> read_literal(const Reader& read, const Node& node, const Field& field,
                                  const Unit& unit) {
    std::optional<Value> value;
    if (field.type == Type::enumeration) return read_name(read, node, field);
    if (field.type == Type::boolean) {
        if (const auto b = read.boolean(node)) value = *b;
        return value;
    }
    if (is_integer(field.type))
        value = read_integer(read, node, field, unit);
    else if (const auto number = read.real(node, unit))
        value = *number;
    if (!value || field.admits(*value)) return value;
    out_of_range(read, node, field, unit);
    return {};
}

}  // namespace lineshaft
