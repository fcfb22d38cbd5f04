#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/names/net.hpp"
#include "runtime/program/program.hpp"

namespace lineshaft {

/// What a program was understood as, however much is wrong with it.
struct CheckedProgram {
    Program program;
    Net net;
};

/// Says what is wrong with a program, study, fit, controller or recording. The program, if it is
/// one.
std::optional<CheckedProgram> check_file(const std::string& path, const LoadOptions& options,
                                         Diagnostics& out);

}  // namespace lineshaft
