#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runtime/st/library/library.hpp"
#include "tools/lineshaft/new_tasks.hpp"

namespace lineshaft {

/// A block that is one of the program's, and the task that scans it.
struct NewBlock {
    std::string name, type, task;
    std::vector<std::pair<std::string, std::string>> given = {};  ///< axes and values, by path
    bool called = false;                                          ///< by the sources of others
    std::string note = {};                                        ///< what is otherwise than there
};

/// The programs that tasks call; of sources without a PROGRAM, or with data alone, an instance of
/// each FUNCTION_BLOCK that may stand alone. Empty: there is nothing that a task could run.
std::vector<NewBlock> programs_of(const st::Library& library, const projects::Project& project,
                                  const std::vector<NewTask>& tasks);

/// The programs with what they need, in front of them: blocks that they name, a block for each axis
/// that they keep, and lists of globals and called programs that keep axes, too.
std::vector<NewBlock> blocks_around(const st::Library& library, const projects::Project& project,
                                    const std::vector<NewBlock>& programs,
                                    const std::string& first_task);

}  // namespace lineshaft
