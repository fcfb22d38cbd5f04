#pragma once

#include "runtime/program/form.hpp"
#include "runtime/program/program.hpp"

namespace lineshaft {

/// What came from outside while a machine was served, see runtime/serve/README.md.
const Form& recording_form();

/// What a file of that form holds. An unfinished last line, of a machine that was killed, is none.
/// L0001, L0101 and so on when there is no such file, or something else is in it; L0106 when it has
/// more than a megabyte and is not written as `serve` does it, an entry a line.
std::optional<RecordingPlan> read_recording(const std::string& path, Diagnostics& out);

}  // namespace lineshaft
