#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace lineshaft {

/// A JSON text of somebody else; null when it is none, or nested more than 64 deep, which would
/// take a hundred bytes of memory for each of its own.
nlohmann::ordered_json parse_json(std::string_view text);

/// The whole number at `key`, which must be within the limits; empty when it is not, or is none.
std::optional<std::int64_t> integer_at(const nlohmann::ordered_json& object, const char* key,
                                       std::int64_t least, std::int64_t most);

/// The text at `key`; empty when there is none.
std::string text_at(const nlohmann::ordered_json& object, const char* key);

}  // namespace lineshaft
