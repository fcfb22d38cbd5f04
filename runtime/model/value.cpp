#include "runtime/model/value.hpp"

#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

template <class T>
T read(const std::byte* slot) {
    T value;
    std::memcpy(&value, slot, sizeof value);
    return value;
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

}  // namespace lineshaft
