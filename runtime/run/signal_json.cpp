#include "runtime/run/signal_json.hpp"

#include <cmath>

namespace lineshaft {

nlohmann::ordered_json json_number(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json to_json(const Signal& signal, const Value& value) {
    if (const auto* b = std::get_if<bool>(&value)) return *b;
    if (signal.type == Type::enumeration)
        if (const auto name = signal.names.of(std::get<std::int64_t>(value)); !name.empty())
            return name;
    if (const auto* i = std::get_if<std::int64_t>(&value)) return *i;
    if (const auto* i = std::get_if<std::uint64_t>(&value)) return *i;
    const double real = std::get<double>(value);
    return json_number(real);
}

}  // namespace lineshaft
