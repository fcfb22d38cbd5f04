#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace lineshaft {

/// What a JSON text may have: more would take too much memory for each of its bytes, and what a
/// program of the greatest size keeps has less.
constexpr std::size_t deepest_json = 64, most_json_values = 1 << 20;

/// A JSON text of somebody else; null when it is none, nested too deep, or has too many values. Of
/// keys that come twice the first is found.
nlohmann::ordered_json parse_json(std::string_view text);

/// The whole number at `key`, which must be within the limits; empty when it is not, or is none.
std::optional<std::int64_t> integer_at(const nlohmann::ordered_json& object, const char* key,
                                       std::int64_t least, std::int64_t most);

/// The text at `key`; empty when there is none.
std::string text_at(const nlohmann::ordered_json& object, const char* key);

}  // namespace lineshaft
