#include "runtime/model/value.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

/// a is within 64 bits, with or without a sign.
std::partial_ordering compare(Wide a, double b) {
    constexpr double beyond = 0x1p64;
    if (std::isnan(b)) return std::partial_ordering::unordered;
    if (b >= beyond) return std::partial_ordering::less;
    if (b < -beyond) return std::partial_ordering::greater;
    const double whole = std::trunc(b);
    const auto same = a <=> static_cast<Wide>(whole);
    return same != 0 ? std::partial_ordering(same) : whole <=> b;
}

}  // namespace

Value load(Type type, const std::byte* slot) {
    switch (type) {
        case Type::boolean:
            return read<bool>(slot);
        case Type::real:
            return read<double>(slot);
        case Type::unsigned_integer:
            return read<std::uint64_t>(slot);
        default:
            return read<std::int64_t>(slot);
    }
}

void store(Type, std::byte* slot, const Value& value) {
    std::visit([slot](auto v) { std::memcpy(slot, &v, sizeof v); }, value);
}

std::optional<Wide> whole(const Value& value) {
    if (std::holds_alternative<double>(value)) return {};
    return std::visit([](auto v) { return static_cast<Wide>(v); }, value);
}

std::optional<Value> whole_value(Wide number, Type type) {
    const auto as = [number]<class T>(T) -> std::optional<Value> {
        using Limits = std::numeric_limits<T>;
        if (number < Wide{Limits::min()} || number > Wide{Limits::max()}) return {};
        return static_cast<T>(number);
    };
    return type == Type::unsigned_integer ? as(std::uint64_t{}) : as(std::int64_t{});
}

std::string format(const Value& value) {
    if (const auto* real = std::get_if<double>(&value)) return format_number(*real);
    return fmt::format("{}", *whole(value));
}

std::string describe(const Value& value, Type type, const ValueNames& names,
                     std::string_view unit) {
    if (type == Type::boolean) return std::get<bool>(value) ? "true" : "false";
    if (type == Type::enumeration) {
        const auto number = std::get<std::int64_t>(value);
        const std::string_view name = names.of(number);
        const bool is_of_no_letters = !names.may_be_written_as_numbers() && names.takes(number);
        return name.empty() && !is_of_no_letters ? fmt::format("{}", names.whole(number))
                                                 : std::string(name);
    }
    std::string text = format(value);
    if (!unit.empty()) text.append(" ").append(unit);
    return text;
}

double as_real(const Value& value) {
    return std::visit([](auto v) { return static_cast<double>(v); }, value);
}

std::partial_ordering compare(const Value& a, const Value& b) {
    const auto x = whole(a), y = whole(b);
    if (x && y) return *x <=> *y;
    if (x) return compare(*x, std::get<double>(b));
    if (y) return 0 <=> compare(*y, std::get<double>(a));
    return std::get<double>(a) <=> std::get<double>(b);
}

}  // namespace lineshaft
