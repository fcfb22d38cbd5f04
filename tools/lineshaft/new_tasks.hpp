#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/model/catalog.hpp"
#include "runtime/projects/project.hpp"

namespace lineshaft {

/// A task of the program around a project of another tool.
struct NewTask {
    std::string name;
    std::int64_t every, priority;  ///< `every` 0: once, before all others
    std::vector<projects::TaskProgram> programs;
    std::string note = {};  ///< what the project does not say of it
    std::string on = {};    ///< the signal that starts it, instead of `every`
};

/// A name of a task as a program may have it.
std::string plain_name(std::string_view text);

/// The project says what starts it, so that it becomes a task.
bool is_taken(const projects::ProjectTask& task);

/// Which programs an event starts that is not known here.
std::string remark_on_event(const projects::ProjectTask& task);

/// An event is not known of which no list of globals is left: of many projects in a folder what no
/// program names may be left out.
void forget_lost_events(std::span<const BlockType> kinds, projects::Project& project);

/// It is none that runs code of the project.
bool is_memory(const projects::OrganizationBlock& block);

/// At least one. A project's smallest priority is the most urgent, here the largest.
std::vector<NewTask> tasks_of(const projects::Project& project);

}  // namespace lineshaft
