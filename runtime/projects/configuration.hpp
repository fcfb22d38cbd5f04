#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// How long `PT0.02S`, `T#20ms` or `t#1m2s` is [ns]; a bare number is in seconds, as CODESYS writes
/// it. 0: none of these.
std::int64_t interval_of(std::string_view text);

/// The tasks of each CONFIGURATION in a file of Structured Text, with their programs.
void read_configuration(const Reading& to, const std::shared_ptr<const SourceFile>& source);

/// The tasks that CoDeSys 2.3 exports between RESOURCE and END_RESOURCE, which is no source. One
/// without INTERVAL and EVENT is free.
void read_tasks_of_export(const Reading& to, const SourceFile& source);

}  // namespace lineshaft::projects
