#pragma once

#include <string>
#include <vector>

#include "runtime/study/result_file.hpp"

namespace lineshaft {

/// The chunks in a folder, in order: every `*.csv` whose sidecar says that it is one. Empty, and
/// diagnostics: L0611 chunks are missing (says which and how to compute them), L0612 a chunk of
/// another plan or program, or of another number of chunks, L0613 rows that their sidecar does not
/// describe.
std::vector<std::string> find_chunks(const std::string& folder, const Study& study,
                                     const StudyCsv& csv, Diagnostics& out);

}  // namespace lineshaft
