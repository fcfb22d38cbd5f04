#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "runtime/source/diagnostic.hpp"

namespace lineshaft::projects {

/// A word of a project, and where it stands.
struct Name {
    std::string text;
    Mark mark;
};

/// A program that a task runs. A CONFIGURATION names its instance, and gives inputs their values.
struct TaskProgram : Name {
    std::string instance = {};
    std::string path = {};  ///< of the instance, with its RESOURCE: `R1.P1`
    std::vector<std::pair<std::string, std::string>> given = {};
    std::vector<std::pair<Name, std::string>> apart = {};  ///< blocks of it, and the tasks of these
};

/// What starts a task that is not cyclic.
struct TaskEvent : Name {
    bool is_edge =
        false;  ///< rising, of a BOOL of the project; else it may be none of its variables
};

/// A task: cyclic, free, or started by an event.
struct ProjectTask {
    Name name;                   ///< empty: of programs without a task
    std::string resource = {};   ///< of a CONFIGURATION
    std::int64_t every = 0;      ///< [ns] 0: not said, free, or started by an event
    std::int64_t priority = 0;   ///< as the project counts: the smallest is the most urgent
    TaskEvent event = {};        ///< that starts it; empty: none is said
    bool is_free = false;        ///< begins again as soon as it has ended
    bool is_background = false;  ///< again and again, when no other has to run
    bool counts_always = false;  ///< else one that is not said to be cyclic is left out
    std::vector<TaskProgram> programs = {};
};

/// Siemens' block that the operating system calls, or what stands for what that does itself.
struct OrganizationBlock {
    enum class Start : std::uint8_t {
        cycle,             ///< again and again, as OB1
        startup,           ///< once, before all others, as OB100
        cyclic_interrupt,  ///< in an interval of its own, as OB30
        event,             ///< an interrupt or a fault
        clock_memory,      ///< MemoryBytes, every 50 ms
        system_memory,     ///< MemoryBytes, in front of OB1
    };

    Name name;
    Start start = Start::cycle;
    std::int64_t number = 0;  ///< 0: not said
};

/// What a project brings along.
struct Project {
    std::vector<std::shared_ptr<const SourceFile>> sources;  ///< each of them once
    std::vector<ProjectTask> tasks;
    std::vector<OrganizationBlock> organization_blocks;
    std::vector<Name> libraries;  ///< that it refers to

    /// Unless it is there.
    void add(std::shared_ptr<const SourceFile> source);
};

/// The path of a file that a project names, or empty and told why.
using Resolve = std::function<std::optional<std::string>(const std::string& path, const Mark& where,
                                                         Diagnostics& out)>;

/// What reads files of projects takes along.
struct Reading {
    Project& project;
    Diagnostics& out;
    const Resolve& resolve;
};

/// Whether a file holds sources, or names those that do: by the ending of its name, of `.xml` by
/// its beginning too. Structured Text is one of the forms.
bool is_source(const std::filesystem::path& file);

/// Sources in any form below a folder, sorted, without files of tests. What a `.plcproj` stands
/// over is left to it.
std::vector<std::string> sources_below(const std::string& folder, std::error_code& error);

/// Reads a file of any form, or all below a folder, into `to.project`. Whatever is wrong goes to
/// `to.out`, at `where` if there is no other place for it. What could be read is there
/// nevertheless.
void read_sources(const Reading& to, const std::string& path, const Mark& where = {});

}  // namespace lineshaft::projects
