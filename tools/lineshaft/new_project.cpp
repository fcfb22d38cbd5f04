#include "tools/lineshaft/new_project.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "blocks/catalog.hpp"
#include "runtime/program/whole_project.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"
#include "runtime/source/yaml_text.hpp"
#include "runtime/st/library/used_sources.hpp"
#include "runtime/st/syntax/dialect.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/new_blocks.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t most_signals = 8;

std::string time_text(std::int64_t ns) {
    if (ns % 1'000'000 == 0) return fmt::format("{} ms", ns / 1'000'000);
    return ns % 1000 == 0 ? fmt::format("{} us", ns / 1000) : fmt::format("{} ns", ns);
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

/// The folder of the solution that a `.plcproj` is of, where its libraries may be; else none.
std::optional<std::string> solution_of(const std::string& path) {
    constexpr int most_above = 3;
    namespace fs = std::filesystem;
    if (extension_of(path) != ".plcproj") return {};
    fs::path folder = fs::path(path).parent_path();
    for (int i = 0; i <= most_above; ++i, folder /= "..") {
        const fs::path here = folder.empty() ? "." : folder.lexically_normal();
        std::error_code error;
        for (const fs::directory_entry& entry : fs::directory_iterator(here, error))
            if (extension_of(entry.path()) == ".sln") return here.string();
    }
    return {};
}

/// The project of several that has tasks, or that no other is built on.
std::optional<WholeProject> chosen_project(const std::string& path, Diagnostics& out) {
    std::vector<std::string> folders;
    if (const auto solution = solution_of(path)) folders.push_back(*solution);
    std::vector<WholeProject> all = read_projects(path, folders, out);
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

/// What runs of it; a run tells the warnings, too.
std::optional<st::Library> library_of(const projects::Project& project, Diagnostics& out) {
    Diagnostics found;
    auto library = st::compile_used(project.sources, task_programs(project), standard_blocks(),
                                    found, {.references = references_of(project)});
    for (const Diagnostic& d : found.list()) out.add(d.code, d.mark, d.message, d.help);
    return library;
}

/// A first trace: of axes, of the first program, of addresses.
std::vector<std::string> traced_signals(const st::Library& library, const NewBlock& program,
                                        const std::vector<NewBlock>& blocks,
                                        const std::vector<Field>& addresses) {
    std::vector<std::string> signals = motions_of(blocks);
    const bool moves = !signals.empty();
    std::ranges::move(signals_of(library, program, moves), std::back_inserter(signals));
    add_addresses(addresses, signals);
    return signals;
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
    const std::string whole = solution_of(project).value_or(project);
    if (resolve_path(path_from(program, whole), program.string(), {}, {}, unread)) return {};
    std::error_code error;
    std::filesystem::path folder = std::filesystem::absolute(whole).lexically_normal();
    if (!std::filesystem::is_directory(folder, error)) folder = folder.parent_path();
    return " --include-dir " + shell_word(folder.string());
}

std::string program_around(const std::string& path, const std::filesystem::path& file,
                           Diagnostics& out) {
    const auto chosen = chosen_project(path, out);
    if (!chosen) return {};
    projects::Project project = chosen->project;
    if (project.sources.empty() && out.empty()) return tell_no_source(path, out), std::string();
    const auto library = out.empty() ? library_of(project, out) : std::optional<st::Library>();
    if (!library) return {};
    forget_lost_events(library->kinds(), project);
    const std::vector<NewTask> tasks = tasks_of(project);
    const std::vector<NewBlock> programs = programs_of(*library, project, tasks);
    if (programs.empty()) {
        out.add(code::entry_is_missing, {},
                fmt::format("'{}' has no PROGRAM that a task could run", path),
                "write a PROGRAM that calls its functions and function blocks");
        return {};
    }
    const std::vector<NewBlock> blocks =
        blocks_around(*library, project, programs, tasks.front().name);
    const std::vector<Field> addresses = addresses_of(*library);
    const auto signals = traced_signals(*library, programs.front(), blocks, addresses);
    const std::string name = file.stem().string();
    std::string text = fmt::format(
        "# Around a project of another tool. Try, and then change:\n"
        "#   lineshaft run {6}{5}{1}\n"
        "#   lineshaft check {6}{1}\n"
        "lineshaft: 1\ntitle: {0}\nsources: [{2}]\n{3}{4}run: {{for: 1 s}}\n",
        name, include_option(path, file), sources_text(*chosen, file), dialect_text(),
        text_of(project, tasks, blocks) + inputs_text(addresses, tasks),
        signals.empty() ? std::string() : " --trace " + shell_word(name + ".csv"),
        shell_word(name + ".yaml"));
    if (!signals.empty())
        text += fmt::format("trace: {{task: {}, signals: [{}]}}\n", programs.front().task,
                            fmt::join(signals, ", "));
    return text;
}

}  // namespace lineshaft
