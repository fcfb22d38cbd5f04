#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "runtime/model/catalog.hpp"

namespace lineshaft {

/// A kind of block as `lineshaft blocks TYPE` shows it: its parameters, references, inputs,
/// outputs, locals and lists, with units, limits and defaults.
std::string block_text(const BlockType& type);

/// A line of `blocks:` with what must be said and what the block is for, beside axes `x` and
/// `line`, a cam `my_cam_table` and an input `go`; empty for a kind that another block calls.
std::string block_example(const BlockType& type);

/// The same for machines.
nlohmann::ordered_json block_json(const BlockType& type);

}  // namespace lineshaft
