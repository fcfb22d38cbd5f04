#include "tools/lineshaft/new_blocks.hpp"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"

namespace lineshaft {

namespace {

/// The name, longer where a block has it.
std::string apart_from(const std::vector<NewBlock>& blocks, std::string name) {
    while (std::ranges::count(blocks, name, &NewBlock::name) > 0) name += '_';
    return name;
}

bool is_program(const BlockType& kind) {
    return kind.doc.starts_with("PROGRAM ");
}

/// All of it is of CoDeSys 2.3.
bool is_exported(const projects::Project& project) {
    return std::ranges::all_of(
        project.sources, [](const auto& source) { return lower(source->path).ends_with(".exp"); });
}

/// Null: there is none of that name.
const BlockType* program_called(const st::Library& library, std::string_view name) {
    const auto kinds = library.kinds();
    const auto found = std::ranges::find_if(kinds, [&](const BlockType& kind) {
        return is_program(kind) && same_letters(kind.name, name);
    });
    return found == kinds.end() ? nullptr : &*found;
}

/// The programs that tasks call; where none says so, in the first task PLC_PRG of an export of
/// CoDeSys 2.3, else all that no other calls.
std::vector<NewBlock> called_by_tasks(const st::Library& library, const std::vector<NewTask>& tasks,
                                      bool is_exported) {
    std::vector<NewBlock> blocks;
    const auto is_one_of_several = [&](const projects::TaskProgram& program) {
        std::ptrdiff_t count = 0;
        for (const NewTask& task : tasks)
            count += std::ranges::count_if(task.programs, [&](const projects::TaskProgram& other) {
                return lower(other.text) == lower(program.text);
            });
        return count > 1 && !program.instance.empty();
    };
    const auto add = [&](std::string_view given, const BlockType& kind, const std::string& task) {
        std::string name;
        for (const char c : given) name += is_letter(c) || is_digit(c) ? c : '_';
        if (is_digit(name.front())) name.insert(0, "_");
        if (std::ranges::count(blocks, name, &NewBlock::name) > 0) name += "_" + task;
        blocks.push_back({apart_from(blocks, name), std::string(kind.name), task});
    };
    for (const NewTask& task : tasks)
        for (const projects::TaskProgram& program : task.programs) {
            const BlockType* made = program_called(library, program.path);
            const BlockType* kind = made ? made : program_called(library, program.text);
            if (!kind) continue;
            const bool is_by_instance = made || is_one_of_several(program);
            add(is_by_instance ? program.instance : kind->name, *kind, task.name);
            blocks.back().given = program.given;
            for (const auto& [part, other] : program.apart)
                blocks.back().note +=
                    fmt::format("{}'{}' is of the task '{}' in the project",
                                blocks.back().note.empty() ? "" : "; ", part.text, other);
        }
    for (const BlockType& kind : library.kinds())
        if (blocks.empty() && is_exported && is_program(kind) && lower(kind.name) == "plc_prg")
            add(kind.name, kind, tasks.front().name);
    for (const bool with_called : {false, true}) {
        if (!blocks.empty()) break;
        for (const BlockType& kind : library.kinds())
            if (is_program(kind) && (with_called || !library.is_called(kind.name)))
                add(kind.name, kind, tasks.front().name);
    }
    return blocks;
}

/// For sources without a PROGRAM an instance of each FUNCTION_BLOCK that a program's file can have:
/// one that is given no variables of others but axes. `MyTimer` is my_timer.
std::vector<NewBlock> instances_of(const st::Library& library, const std::string& task) {
    std::vector<NewBlock> blocks;
    for (const BlockType& kind : library.kinds()) {
        const auto is_lent = [](const Field& field) {
            return field.required && field.refers != "axis";
        };
        if (!kind.doc.starts_with("FUNCTION_BLOCK ") || std::ranges::any_of(kind.fields, is_lent))
            continue;
        std::string name;
        for (std::size_t i = 0; i < kind.name.size(); ++i) {
            const char c = kind.name[i];
            const bool begins = i > 0 && c != lower(c) && is_letter(kind.name[i - 1]) &&
                                kind.name[i - 1] == lower(kind.name[i - 1]) &&
                                kind.name[i - 1] != '_';
            name += begins ? "_" : "";
            name += is_letter(c) || is_digit(c) ? lower(c) : '_';
        }
        blocks.push_back({apart_from(blocks, name), std::string(kind.name), task});
    }
    return blocks;
}

/// As on a controller: without power until the sources give it.
NewBlock axis(const std::string& name, const std::string& task) {
    return {name, "axis", task, {{"needs_power", "true"}}};
}

/// Blocks such as axes that the sources name, in the task of the first that does.
std::vector<NewBlock> named_blocks(const st::Library& library,
                                   const std::vector<NewBlock>& programs) {
    std::vector<NewBlock> blocks;
    for (const NewBlock& program : programs) {
        const auto kind = std::ranges::find(library.kinds(), program.type, &BlockType::name);
        for (const Field& field : kind->fields) {
            const auto is_own = [&](const auto& b) { return b.name == field.global; };
            const bool is_there = field.global.empty() ||
                                  std::ranges::any_of(library.kinds(), is_own) ||
                                  std::ranges::any_of(blocks, is_own);
            if (is_there) continue;
            const std::string name(field.global), type(field.refers);
            blocks.push_back(type == "axis" ? axis(name, program.task)
                                            : NewBlock{name, type, program.task});
        }
    }
    return blocks;
}

/// Three linear axes for each group that the sources leave to the device tree.
void fill_groups(const projects::Project& project, std::vector<NewBlock>& blocks) {
    const auto adds_axes = [](const auto& source) {
        return lower(source->text).find("mc_addaxistogroup") != std::string::npos;
    };
    if (std::ranges::any_of(project.sources, adds_axes)) return;
    std::vector<NewBlock> axes, members;
    for (NewBlock& group : blocks) {
        if (group.type != "axes_group") continue;
        group.note = "its axes are those of the device tree there: fit them, up to IdentInGroup 6";
        for (int place = 1; place <= 3; ++place) {
            const std::string name = fmt::format("{}_{}", group.name, "xyz"[place - 1]);
            axes.push_back(axis(name, group.task));
            members.push_back({name + "_member",
                               "MC_AddAxisToGroup",
                               group.task,
                               {{"AxesGroup", group.name},
                                {"Axis", name},
                                {"IdentInGroup", std::to_string(place)},
                                {"Execute", "true"}}});
        }
    }
    std::ranges::move(axes, std::back_inserter(blocks));
    std::ranges::move(members, std::back_inserter(blocks));
}

bool has_ending(const projects::Project& project, std::string_view ending) {
    return std::ranges::any_of(project.sources, [&](const auto& source) {
        const std::string path = lower(source->path);
        const std::size_t dot = path.rfind('.');
        return dot != path.npos && path.substr(dot).starts_with(ending);
    });
}

bool is_of_siemens(const projects::Project& project) {
    return has_ending(project, ".scl") || has_ending(project, ".s7") || has_ending(project, ".db");
}

/// The limits of axes are in a device tree that is not read: as much as no program asks for. What
/// TwinCAT and SCL leave open is the axis' own, so that those accelerations stay.
void widen_limits(const projects::Project& project, std::vector<NewBlock>& blocks) {
    if (is_of_siemens(project)) return;
    const std::pair<std::string, std::string> wide[] = {{"default_velocity", "10000 mm/s"},
                                                        {"default_acceleration", "100000 mm/s^2"},
                                                        {"default_deceleration", "100000 mm/s^2"},
                                                        {"default_jerk", "1e7 mm/s^3"}};
    const std::span given(wide, has_ending(project, ".tc") ? 1 : std::size(wide));
    for (NewBlock& block : blocks)
        if (block.type == "axis") block.given.insert(block.given.end(), given.begin(), given.end());
}

/// Whether an axis of Siemens has an absolute encoder is in its technology object.
void need_homing(const projects::Project& project, std::vector<NewBlock>& blocks) {
    if (!is_of_siemens(project)) return;
    for (NewBlock& block : blocks)
        if (block.type == "axis") block.given.emplace_back("needs_homing", "true");
}

/// A block for each axis that a program or a list of globals keeps for itself, as TwinCAT links
/// them to axes of its numerical control.
std::vector<NewBlock> axes_of(const st::Library& library, std::vector<NewBlock>& owners) {
    std::vector<NewBlock> axes;
    for (NewBlock& owner : owners) {
        const auto kind = std::ranges::find(library.kinds(), owner.type, &BlockType::name);
        for (const Field& field : kind->fields) {
            const bool is_axis = field.refers == "axis" && field.global.empty() &&
                                 (!field.required || !is_program(*kind));
            if (!is_axis) continue;
            std::string name = plain_name(fmt::format("{}_{}", owner.name, field.name));
            if (name.ends_with('_')) name.pop_back();
            owner.given.emplace_back(field.name, name);
            axes.push_back(axis(name, owner.task));
        }
    }
    return axes;
}

void keep_those_with_axes(const st::Library& library, std::vector<NewBlock>& blocks) {
    axes_of(library, blocks);
    std::erase_if(blocks, [](const NewBlock& block) { return block.given.empty(); });
    for (NewBlock& block : blocks) block.given.clear();
}

/// Lists of globals that keep axes, in the first task.
std::vector<NewBlock> lists_with_axes(const st::Library& library, const std::string& task) {
    std::vector<NewBlock> lists;
    for (const BlockType& kind : library.kinds())
        if (kind.single) lists.push_back({std::string(kind.name), std::string(kind.name), task});
    keep_those_with_axes(library, lists);
    return lists;
}

/// Programs that those of tasks name, and that keep axes.
std::vector<NewBlock> called_with_axes(const st::Library& library,
                                       const std::vector<NewBlock>& programs) {
    std::vector<NewBlock> called;
    for (const BlockType& kind : library.kinds()) {
        const std::string name(kind.name);
        const auto scans_it = [&](const NewBlock& block) { return block.type == name; };
        if (!is_program(kind) || std::ranges::any_of(programs, scans_it)) continue;
        const auto names_it = [&](const Field& field) { return field.global == kind.name; };
        const auto caller = std::ranges::find_if(programs, [&](const NewBlock& block) {
            const auto type = std::ranges::find(library.kinds(), block.type, &BlockType::name);
            return std::ranges::any_of(type->fields, names_it);
        });
        if (caller == programs.end()) continue;
        NewBlock& block = called.emplace_back(NewBlock{name, name, caller->task});
        block.called = true;
    }
    keep_those_with_axes(library, called);
    return called;
}

}  // namespace

std::vector<NewBlock> programs_of(const st::Library& library, const projects::Project& project,
                                  const std::vector<NewTask>& tasks) {
    std::vector<NewBlock> programs = called_by_tasks(library, tasks, is_exported(project));
    const auto& organization_blocks = project.organization_blocks;
    if (!organization_blocks.empty() && std::ranges::all_of(organization_blocks, is_memory))
        programs.clear();
    return programs.empty() ? instances_of(library, tasks.front().name) : programs;
}

std::vector<NewBlock> blocks_around(const st::Library& library, const projects::Project& project,
                                    const std::vector<NewBlock>& programs,
                                    const std::string& first_task) {
    std::vector<NewBlock> blocks = named_blocks(library, programs);
    fill_groups(project, blocks);
    std::vector<NewBlock> owners = lists_with_axes(library, first_task);
    std::ranges::move(called_with_axes(library, programs), std::back_inserter(owners));
    owners.insert(owners.end(), programs.begin(), programs.end());
    std::ranges::move(axes_of(library, owners), std::back_inserter(blocks));
    widen_limits(project, blocks);
    need_homing(project, blocks);
    std::ranges::move(owners, std::back_inserter(blocks));
    return blocks;
}

}  // namespace lineshaft
