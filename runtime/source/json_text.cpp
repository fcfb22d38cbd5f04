#include "runtime/source/json_text.hpp"

#include <algorithm>

namespace lineshaft {

using Json = nlohmann::ordered_json;

Json parse_json(std::string_view text) {
    constexpr int deepest = 64;
    bool too_deep = false;
    const auto look = [&](int depth, Json::parse_event_t, Json&) {
        too_deep = too_deep || depth > deepest;
        return !too_deep;
    };
    Json json = Json::parse(text, look, false);
    return too_deep || json.is_discarded() ? Json() : json;
}

std::optional<std::int64_t> integer_at(const Json& object, const char* key, std::int64_t least,
                                       std::int64_t most) {
    if (!object.is_object()) return {};
    const auto it = object.find(key);
    if (it == object.end() || !it->is_number_integer()) return {};
    if (it->is_number_unsigned() &&
        it->get<std::uint64_t>() > static_cast<std::uint64_t>(std::max(most, std::int64_t{0})))
        return {};
    const auto value = it->get<std::int64_t>();
    return value >= least && value <= most ? std::optional(value) : std::nullopt;
}

std::string text_at(const Json& object, const char* key) {
    if (!object.is_object()) return {};
    const auto it = object.find(key);
    return it != object.end() && it->is_string() ? it->get<std::string>() : std::string();
}

}  // namespace lineshaft
