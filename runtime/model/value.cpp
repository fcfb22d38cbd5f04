#include "runtime/model/value.hpp"

#include <cmath>
#include <optional>

#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

std::partial_ordering compare(std::int64_t a, double b) {
    constexpr double beyond = 0x1p63;
    if (std::isnan(b)) return std::partial_ordering::unordered;
    if (b >= beyond) return std::partial_ordering::less;
    if (b < -beyond) return std::partial_ordering::greater;
    const double whole = std::trunc(b);
    const auto same = a <=> static_cast<std::int64_t>(whole);
    return same != 0 ? std::partial_ordering(same) : whole <=> b;
}

/// Empty for a real.
std::optional<std::int64_t> as_integer(const Value& value) {
    if (const auto* b = std::get_if<bool>(&value)) return *b ? 1 : 0;
    if (const auto* i = std::get_if<std::int64_t>(&value)) return *i;
    return {};
}

}  // namespace

Value load(Type type, const std::byte* slot) {
    switch (type) {
        case Type::boolean:
            return read<bool>(slot);
        case Type::real:
            return read<double>(slot);
        default:
            return read<std::int64_t>(slot);
    }
}

void store(Type, std::byte* slot, const Value& value) {
    std::visit([slot](auto v) { std::memcpy(slot, &v, sizeof v); }, value);
}

std::string format(const Value& value) {
    if (const auto* b = std::get_if<bool>(&value)) return *b ? "1" : "0";
    if (const auto* i = std::get_if<std::int64_t>(&value)) return std::to_string(*i);
    return format_number(std::get<double>(value));
}

std::string describe(const Value& value, Type type, std::span<const std::string_view> names,
                     std::string_view unit) {
    if (type == Type::boolean) return std::get<bool>(value) ? "true" : "false";
    if (type == Type::enumeration) {
        const auto index = static_cast<std::size_t>(std::get<std::int64_t>(value));
        return index < names.size() ? std::string(names[index]) : format(value);
    }
    std::string text = format(value);
    if (!unit.empty()) text.append(" ").append(unit);
    return text;
}

double as_real(const Value& value) {
    return std::visit([](auto v) { return static_cast<double>(v); }, value);
}

std::partial_ordering compare(const Value& a, const Value& b) {
    const auto x = as_integer(a), y = as_integer(b);
    if (x && y) return *x <=> *y;
    if (x) return compare(*x, std::get<double>(b));
    if (y) return 0 <=> compare(*y, std::get<double>(a));
    return std::get<double>(a) <=> std::get<double>(b);
}

}  // namespace lineshaft
