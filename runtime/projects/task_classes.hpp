#pragma once

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// `Cpu.sw` of a project of B&R, below `Physical`: which program is in which task class.
bool is_software_of_cpu(const std::filesystem::path& file);

/// Each cyclic task class with programs is a task, the first the most urgent. `Hardware.hw` in the
/// folder above says how often it runs, where that is not as the tools set it. The first
/// configuration of a project counts.
void read_task_classes(const Reading& to, const std::string& path, const Mark& where);

}  // namespace lineshaft::projects
