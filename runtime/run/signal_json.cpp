#include "runtime/run/signal_json.hpp"

#include <cmath>

#include "runtime/source/units.hpp"

namespace lineshaft {

nlohmann::ordered_json json_number(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json real_json(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value)
                                : nlohmann::ordered_json(format_number(value));
}

nlohmann::ordered_json stored_json(const ValueNames& names, std::int64_t stored) {
    if (names.has_sign()) return stored;
    return static_cast<std::uint64_t>(stored);
}

nlohmann::ordered_json to_json(const Signal& signal, const Value& value) {
    if (const auto* b = std::get_if<bool>(&value)) return *b;
    if (signal.type == Type::enumeration) {
        const auto stored = std::get<std::int64_t>(value);
        if (const auto name = signal.names.of(stored); !name.empty()) return name;
        return stored_json(signal.names, stored);
    }
    if (const auto* i = std::get_if<std::int64_t>(&value)) return *i;
    if (const auto* i = std::get_if<std::uint64_t>(&value)) return *i;
    return real_json(std::get<double>(value));
}

}  // namespace lineshaft
