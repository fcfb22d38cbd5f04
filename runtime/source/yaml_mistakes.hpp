#pragma once

#include <yaml-cpp/exceptions.h>

#include "runtime/source/yaml_builder.hpp"

namespace lineshaft {

/// Says what the library found, in our words and where a user would look: `builder` is as far as it
/// came.
void report_mistake(const YAML::Exception& fault, const YamlText& source,
                    const YamlBuilder& builder, Diagnostics& out);

}  // namespace lineshaft
