#pragma once

#include <nlohmann/json.hpp>

#include "runtime/model/catalog.hpp"

namespace lineshaft {

/// JSON schema (draft 7, as editors read it) of program, study and controller files, made from the
/// blocks' field tables. Values that are wires, parameters (`$name`) or quantities are texts there.
nlohmann::ordered_json program_schema(const Catalog& catalog);

}  // namespace lineshaft
