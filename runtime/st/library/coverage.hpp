#pragma once

#include <string>

#include "runtime/st/code/code.hpp"

namespace lineshaft::st {

/// From now on all that this process compiles counts what it executes of its sources, other than
/// of files of tests.
void start_coverage();
bool is_covered();

/// Adds what `code` has counted; of the same place in the same file to what other code has.
void record(const Code& code);

/// All that was recorded, as lcov's geninfo(1) describes it: functions, lines, and the branches of
/// IF and CASE (the last one ELSE, whether it is written or not) and of loops (a pass, the end).
std::string lcov_text();

}  // namespace lineshaft::st
