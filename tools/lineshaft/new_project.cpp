#include "tools/lineshaft/new_project.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "blocks/catalog.hpp"
#include "runtime/program/whole_project.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/yaml_text.hpp"
#include "runtime/st/library/used_sources.hpp"
#include "runtime/st/syntax/dialect.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/new_tasks.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t most_signals = 8;

/// A block that is one of the program's, and the task that scans it.
struct NewBlock {
    std::string name, type, task;
    std::vector<std::pair<std::string, std::string>> given = {};  ///< axes and values, by path
    bool called = false;                                          ///< by the sources of others
    std::string note = {};                                        ///< what is otherwise than there
};

/// The name, longer where a block has it.
std::string apart_from(const std::vector<NewBlock>& blocks, std::string name) {
    while (std::ranges::count(blocks, name, &NewBlock::name) > 0) name += '_';
    return name;
}

std::string time_text(std::int64_t ns) {
    if (ns % 1'000'000 == 0) return fmt::format("{} ms", ns / 1'000'000);
    return ns % 1000 == 0 ? fmt::format("{} us", ns / 1000) : fmt::format("{} ns", ns);
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
std::vector<NewBlock> programs_of(const st::Library& library, const std::vector<NewTask>& tasks,
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

/// Of sources without a PROGRAM an instance of each FUNCTION_BLOCK that a program's file can have:
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

/// The limits of axes are in a device tree that is not read: as much as no program asks for. What
/// TwinCAT and SCL leave open is the axis' own, so that those accelerations stay.
void widen_limits(const projects::Project& project, std::vector<NewBlock>& blocks) {
    const auto ends = [&](std::string_view ending) {
        return std::ranges::any_of(project.sources, [&](const auto& source) {
            const std::string path = lower(source->path);
            const std::size_t dot = path.rfind('.');
            return dot != path.npos && path.substr(dot).starts_with(ending);
        });
    };
    if (ends(".scl") || ends(".s7") || ends(".db")) return;
    const std::pair<std::string, std::string> wide[] = {{"default_velocity", "10000 mm/s"},
                                                        {"default_acceleration", "100000 mm/s^2"},
                                                        {"default_deceleration", "100000 mm/s^2"},
                                                        {"default_jerk", "1e7 mm/s^3"}};
    const std::span given(wide, ends(".tc") ? 1 : std::size(wide));
    for (NewBlock& block : blocks)
        if (block.type == "axis") block.given.insert(block.given.end(), given.begin(), given.end());
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

/// Where each axis is and how fast.
std::vector<std::string> motions_of(const std::vector<NewBlock>& blocks) {
    std::vector<std::string> signals;
    for (const NewBlock& block : blocks)
        if (block.type == "axis")
            for (const char* field : {"position", "velocity"})
                signals.push_back(fmt::format("{}.{}", block.name, field));
    return signals;
}

/// What is plainly named, outputs before all others; `own`: without the parts of blocks in it.
std::vector<std::string> signals_of(const st::Library& library, const NewBlock& block, bool own) {
    std::vector<std::string> signals;
    const auto kind = std::ranges::find(library.kinds(), block.type, &BlockType::name);
    for (const bool outputs : {true, false})
        for (const Field& field : kind->fields) {
            const bool is_output = field.direction == Direction::output;
            const bool is_read = is_output || field.direction == Direction::local;
            const bool is_plain = std::ranges::all_of(field.name, [&](char c) {
                return is_letter(c) || is_digit(c) || (c == '.' && !own);
            });
            const bool is_own_error = field.name == "error" || field.name == "error_id";
            if (is_read && is_plain && !is_own_error && is_output == outputs &&
                signals.size() < most_signals)
                signals.push_back(fmt::format("{}.{}", block.name, field.name));
        }
    return signals;
}

/// What its sources name of the process image.
std::vector<Field> addresses_of(const st::Library& library) {
    const auto image = std::ranges::find(library.kinds(), st::image_name, &BlockType::name);
    if (image == library.kinds().end()) return {};
    return {image->fields.begin(), image->fields.end()};
}

/// An input from outside for each address of the area I: `%IX0.3` is inputs.IX0_3. One that starts
/// a task may be named nowhere else.
std::string inputs_text(const std::vector<Field>& addresses, const std::vector<NewTask>& tasks) {
    std::string inputs, wires;
    std::set<std::string> names;
    for (const Field& field : addresses) {
        const bool is_number = field.unit.empty();
        if (field.direction != Direction::input || !field.name.starts_with("%I") || !is_number)
            continue;
        const std::string name = plain_name(field.name.substr(1));
        const std::string_view value = field.type == Type::boolean ? "false" : "0";
        const std::string note =
            field.doc.empty() ? ""
                              : fmt::format("  # {}", field.doc.substr(0, field.doc.find('\n')));
        names.insert("inputs." + name);
        inputs += fmt::format("  {}: {}{}\n", name, value, note);
        wires += fmt::format("  \"{}\": inputs.{}\n", field.name, name);
    }
    for (const NewTask& task : tasks)
        if (task.on.starts_with("inputs.") && names.insert(task.on).second)
            inputs += fmt::format("  {}: false  # starts the task {}\n",
                                  task.on.substr(task.on.find('.') + 1), task.name);
    if (inputs.empty()) return {};
    if (!wires.empty()) wires.insert(0, "io:\n");
    return "inputs:                          # stimuli change them: lineshaft form stimulus\n" +
           inputs + wires;
}

/// Addresses after what a program names itself, outputs before all others.
void add_addresses(const std::vector<Field>& addresses, std::vector<std::string>& signals) {
    const std::size_t most = signals.size() + most_signals;
    for (const Direction direction : {Direction::output, Direction::input, Direction::local})
        for (const Field& field : addresses) {
            const bool is_input = field.name.starts_with("%I");
            const bool is_meant =
                field.direction == direction && is_input == (direction == Direction::input);
            if (is_meant && signals.size() < most)
                signals.push_back(fmt::format("\"{}\"", field.name));
        }
}

std::string comment_of(std::string_view note) {
    return note.empty() ? "" : fmt::format("  # {}", note);
}

std::string text_of(const projects::Project& project, const std::vector<NewTask>& tasks,
                    const std::vector<NewBlock>& blocks) {
    std::string text = "tasks:                           # the larger priority runs first\n";
    for (const NewTask& task : tasks)
        text += task.every == 0 ? fmt::format("  {}: {{once: true}}\n", task.name)
                                : fmt::format("  {}: {{{}, priority: {}}}{}\n", task.name,
                                              task.on.empty() ? "every: " + time_text(task.every)
                                                              : fmt::format("on: [{}]", task.on),
                                              task.priority, comment_of(task.note));
    for (const projects::OrganizationBlock& block : project.organization_blocks)
        if (block.start == projects::OrganizationBlock::Start::event)
            text +=
                fmt::format("  # '{}' is of an event: give it a task such as x: {{on: a.signal}}\n",
                            block.name.text);
    for (const projects::ProjectTask& task : project.tasks)
        if (!is_taken(task)) text += remark_on_event(task);
    text += "blocks:\n";
    for (const NewBlock& block : blocks) {
        text += fmt::format("  {}: {{type: {}, task: {}", block.name, yaml_name(block.type),
                            block.task);
        if (block.called) text += ", called: true";
        for (const auto& [path, value] : block.given) {
            const std::string_view mark = path.find('[') == path.npos ? "" : "\"";
            text += fmt::format(", {0}{1}{0}: {2}", mark, path, value);
        }
        text += "}" + comment_of(block.note) + "\n";
    }
    return text;
}

/// From the folder of `file`.
std::string path_from(const std::filesystem::path& file, const std::string& path) {
    return std::filesystem::absolute(path)
        .lexically_normal()
        .lexically_proximate(std::filesystem::absolute(file).lexically_normal().parent_path())
        .string();
}

/// Of several the one that has tasks, or that no other is built on.
std::optional<WholeProject> chosen_project(const std::string& path, Diagnostics& out) {
    std::vector<WholeProject> all = read_projects(path, {}, out);
    if (all.size() == 1) return all.front();
    const auto keep_if = [&](auto wanted) {
        std::vector<WholeProject> kept;
        std::ranges::copy_if(all, std::back_inserter(kept), wanted);
        if (!kept.empty()) all = std::move(kept);
    };
    std::set<std::string> libraries;
    for (const WholeProject& project : all)
        libraries.insert(project.library_paths.begin(), project.library_paths.end());
    keep_if([](const WholeProject& project) { return !project.project.tasks.empty(); });
    keep_if([&](const WholeProject& project) { return !libraries.contains(project.path); });
    if (all.size() == 1) return all.front();
    std::vector<std::string> paths;
    for (const WholeProject& project : all) paths.push_back(project.path);
    out.add(code::entry_is_missing, {}, fmt::format("'{}' has several projects", path),
            fmt::format("name one of them: {}", fmt::join(paths, ", ")));
    return {};
}

/// Where its sources are: its own, then its libraries.
std::string sources_text(const WholeProject& project, const std::filesystem::path& file) {
    std::string text = fmt::format("\"{}\"", path_from(file, project.path));
    for (const std::string& path : project.library_paths)
        text += fmt::format(", \"{}\"", path_from(file, path));
    return text;
}

/// As `--source-dialect` says.
std::string dialect_text() {
    const auto names = st::dialect_names();
    const auto chosen = std::ranges::find(names, st::plain_text_ending(), &st::DialectName::ending);
    return chosen == names.end() ? "" : fmt::format("dialect: {}\n", chosen->name);
}

}  // namespace

std::string shell_word(const std::string& word) {
    const bool is_plain = std::ranges::all_of(word, [](char c) {
        return is_letter(c) || is_digit(c) || std::string_view("_-./").find(c) != std::string::npos;
    });
    if (is_plain) return word;
    std::string made = "'";
    for (const char c : word) made += c == '\'' ? "'\\''" : std::string(1, c);
    return made + "'";
}

std::string include_option(const std::string& project, const std::filesystem::path& program) {
    Diagnostics unread;
    if (resolve_path(path_from(program, project), program.string(), {}, {}, unread)) return {};
    std::error_code error;
    std::filesystem::path folder = std::filesystem::absolute(project).lexically_normal();
    if (!std::filesystem::is_directory(folder, error)) folder = folder.parent_path();
    return " --include-dir " + shell_word(folder.string());
}

std::string program_around(const std::string& path, const std::filesystem::path& file,
                           Diagnostics& out) {
    const auto chosen = chosen_project(path, out);
    if (!chosen) return {};
    projects::Project project = chosen->project;
    if (project.sources.empty() && out.empty()) return tell_no_source(path, out), std::string();
    Diagnostics found;  // of which a run tells the warnings
    const auto library =
        out.empty() ? st::compile_used(project.sources, task_programs(project), standard_blocks(),
                                       found, {.references = references_of(project)})
                    : std::optional<st::Library>();
    for (const Diagnostic& d : found.list()) out.add(d.code, d.mark, d.message, d.help);
    if (!library) return {};
    forget_lost_events(library->kinds(), project);
    const std::vector<NewTask> tasks = tasks_of(project);
    std::vector<NewBlock> programs = programs_of(*library, tasks, is_exported(project));
    const auto& organization_blocks = project.organization_blocks;
    const bool has_memory = std::ranges::any_of(organization_blocks, is_memory);
    if (has_memory && std::ranges::all_of(organization_blocks, is_memory)) programs.clear();
    if (programs.empty()) programs = instances_of(*library, tasks.front().name);
    if (programs.empty()) {
        out.add(code::entry_is_missing, {},
                fmt::format("'{}' has no PROGRAM that a task could run", path),
                "write a PROGRAM that calls its functions and function blocks");
        return {};
    }
    std::vector<NewBlock> blocks = named_blocks(*library, programs);
    fill_groups(project, blocks);
    std::vector<NewBlock> owners = lists_with_axes(*library, tasks.front().name);
    std::ranges::move(called_with_axes(*library, programs), std::back_inserter(owners));
    owners.insert(owners.end(), programs.begin(), programs.end());
    std::ranges::move(axes_of(*library, owners), std::back_inserter(blocks));
    widen_limits(project, blocks);
    std::ranges::move(owners, std::back_inserter(blocks));
    const std::string name = file.stem().string();
    const std::vector<Field> addresses = addresses_of(*library);
    std::vector<std::string> signals = motions_of(blocks);
    const bool moves = !signals.empty();
    std::ranges::move(signals_of(*library, programs.front(), moves), std::back_inserter(signals));
    add_addresses(addresses, signals);
    std::string text = fmt::format(
        "# Around a project of another tool. Try, and then change:\n"
        "#   lineshaft run {0}.yaml{5}{1}\n"
        "#   lineshaft check {0}.yaml{1}\n"
        "lineshaft: 1\ntitle: {0}\nsources: [{2}]\n{3}{4}run: {{for: 1 s}}\n",
        name, include_option(path, file), sources_text(*chosen, file), dialect_text(),
        text_of(project, tasks, blocks) + inputs_text(addresses, tasks),
        signals.empty() ? std::string() : fmt::format(" --trace {}.csv", name));
    if (!signals.empty())
        text += fmt::format("trace: {{task: {}, signals: [{}]}}\n", programs.front().task,
                            fmt::join(signals, ", "));
    return text;
}

}  // namespace lineshaft
