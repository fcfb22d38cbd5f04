#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "runtime/source/diagnostic.hpp"

namespace lineshaft::projects {

/// Has the texts in `.st` read as MatIEC's, or CODESYS', that stand in one folder with a text which
/// is: what shows it may be in another file, as a CONFIGURATION or a list of globals.
void read_as_neighbours(std::vector<std::shared_ptr<const SourceFile>>& sources);

/// CoDeSys 2.3 exports a project as one file, or each object in a file: of what stands in a larger
/// export as it is, or in an earlier one, nothing is left.
void leave_out_repeated_exports(std::vector<std::shared_ptr<const SourceFile>>& sources);

/// Has all texts in `.st` read as those whose names have another ending.
void read_plain_text_as(std::string_view ending,
                        std::vector<std::shared_ptr<const SourceFile>>& sources);

}  // namespace lineshaft::projects
