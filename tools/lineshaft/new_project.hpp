#pragma once

#include <filesystem>
#include <string>

#include "runtime/source/diagnostic.hpp"

namespace lineshaft {

/// The program around a project of another tool: its tasks, its PROGRAMs as blocks, a first trace.
/// `program` is the file that it will be, from whose folder paths count. What is wrong with the
/// project goes to `out`.
std::string program_around(const std::string& project, const std::filesystem::path& program,
                           Diagnostics& out);

/// A word as a shell takes it.
std::string shell_word(const std::string& word);

/// ` --include-dir FOLDER`, which the program around a project needs that lies outside of its own
/// one; empty for one that does not.
std::string include_option(const std::string& project, const std::filesystem::path& program);

}  // namespace lineshaft
