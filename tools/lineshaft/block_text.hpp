#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "runtime/model/catalog.hpp"

namespace lineshaft {

/// A kind of block as `lineshaft blocks TYPE` shows it: its parameters, references, inputs,
/// outputs, locals and lists, with units, limits and defaults.
std::string block_text(const BlockType& type);

/// The same for machines.
nlohmann::ordered_json block_json(const BlockType& type);

}  // namespace lineshaft
