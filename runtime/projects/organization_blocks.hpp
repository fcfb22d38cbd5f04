#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// What starts an organization block of this number and, where a document says it, of this
/// `SecondaryType`; 0 and empty: not known. Else its name says it: `OB35`, or what TIA Portal calls
/// a new one, such as `Cyclic interrupt_1`.
OrganizationBlock organization_block(Name name, std::int64_t number, std::string_view type = {});

/// Those of a file in SCL or SIMATIC SD. Beside the name the title counts, and what the operating
/// system gives to them: LostRetentive to a startup, Event_Count to a cyclic interrupt.
void read_organization_blocks(const Reading& to, const std::shared_ptr<const SourceFile>& source);

}  // namespace lineshaft::projects
