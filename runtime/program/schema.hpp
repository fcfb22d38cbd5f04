#pragma once

#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "runtime/model/catalog.hpp"
#include "runtime/program/form.hpp"

namespace lineshaft {

/// JSON schema (draft 7, as editors read it) of files of these forms, told apart by their first
/// keys; a file with none of them is of the first form, in which parameters (`$name`) may stand.
/// Wires, parameters and quantities are texts there. Made from the keys of the forms and the field
/// tables of the blocks.
nlohmann::ordered_json file_schema(const Catalog& catalog, std::span<const FormOf> files);

/// What a key is for, and its default.
std::string description_of(const Key& key);

}  // namespace lineshaft
