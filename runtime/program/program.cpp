#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "runtime/program/meaning.hpp"
#include "runtime/program/program_form.hpp"
#include "runtime/program/program_reader.hpp"
#include "runtime/program/recording_form.hpp"
#include "runtime/program/shared_folder.hpp"
#include "runtime/program/templates.hpp"
#include "runtime/projects/foreign_files.hpp"
#include "runtime/projects/plain_text.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/paths.hpp"
#include "runtime/st/library/test_sources.hpp"
#include "runtime/st/syntax/dialect.hpp"

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

constexpr const char* force_help = "write signal=value@from..until, such as slave.ratio=2@1s..2s";

/// Without links and dots; empty, and why, when the path cannot be followed.
fs::path real_path(const fs::path& path, std::error_code& error) {
    const fs::path whole = fs::absolute(path, error);
    return error ? fs::path() : fs::weakly_canonical(whole, error);
}

fs::path project_root(const fs::path& file) {
    std::error_code unknown;  // then nothing lies below
    const fs::path own = real_path(file, unknown).parent_path();
    for (fs::path folder = own; folder != folder.root_path(); folder = folder.parent_path())
        if (fs::is_directory(folder / "config", unknown)) return folder;
    return own;
}

Node unreadable() {
    Node node;
    node.kind = Node::Kind::map;
    return node;
}

/// Whether all of them could be read.
bool are_known(const Node& tasks) {
    return !tasks.entries.empty() && std::ranges::all_of(tasks.entries, [](const auto& task) {
        return is_identifier(task.first.text) && task.second.is_map();
    });
}

/// What a source that is taken for a program is good for.
std::string use_of(const std::shared_ptr<const SourceFile>& source) {
    const std::string name = fs::path(source->path).filename().string();
    return st::is_test_file(source)
               ? fmt::format("'lineshaft test {}' runs its TESTs", name)
               : fmt::format(
                     "'lineshaft new NAME --from {}' writes a program around it; or name "
                     "it in the 'sources' of one",
                     name);
}

/// A file that no other word of it says to be a program.
bool has_another_name(const SourceFile& file) {
    constexpr std::string_view endings[] = {"", ".yaml", ".yml", ".json"};
    const std::string ending = extension_of(file.path);
    return std::ranges::find(endings, ending) == std::end(endings) && !file.has_key("lineshaft:");
}

}  // namespace

bool ProgramReader::refuse_foreign(const std::shared_ptr<const SourceFile>& file) {
    const Mark start{file, 1, 1, 1};
    if (const auto known = projects::foreign_file(file->path)) {
        read_.diagnostics().add(code::not_supported, start,
                                fmt::format("this is {}, which is not read", known->what),
                                known->help);
        return true;
    }
    if (!has_another_name(*file) || file->text.starts_with('<') || file->text.starts_with("PK"))
        return false;
    read_.diagnostics().add(
        code::unknown_kind_of_file, start, "this is neither a program nor a source",
        begins_with_unit(file->text)
            ? "it looks like Structured Text: give its name the ending .st"
            : "a program is YAML that begins with 'lineshaft: 1'; Structured Text stands in a "
              "file whose name ends in .st");
    return true;
}

Program ProgramReader::read(std::shared_ptr<const SourceFile> file) {
    program_.file = file;
    program_.title = fs::path(file->path).stem().string();
    if (projects::is_source(file->path)) {
        read_.diagnostics().add(code::unknown_kind_of_file, {file, 1, 1, 1},
                                "this is Structured Text, not a program", use_of(file));
        return std::move(program_);
    }
    const std::string ending = extension_of(file->path);
    if (ending == ".il") {
        read_.diagnostics().add(code::not_supported, {file, 1, 1, 1},
                                "this is an instruction list, which is not read from a text",
                                "export the project as PLCopen XML, where it is read");
        return std::move(program_);
    }
    if (ending == ".awl") {
        read_.diagnostics().add(code::not_supported, {file, 1, 1, 1},
                                "this is a source in STL (AWL) of STEP 7, which is not read",
                                "write its blocks in SCL, LAD or FBD");
        return std::move(program_);
    }
    if (refuse_foreign(file)) return std::move(program_);
    auto root = parse(file);
    if (!root || !check_kind(read_, *root, "lineshaft")) return std::move(program_);
    Substitution substitution(values_, root->find("parameters"), read_);
    parameters(*root, substitution);
    expand_templates(*root, substitution, read_);
    substitution.apply_to_program(*root);
    unused_parameters(*root, substitution.used());
    const Node* tasks = root->find("tasks");
    const Node* named = root->find("controller");
    if (named) controller(*named);
    program_.tasks_known =
        (named || tasks) && program_.tasks_known && (!tasks || are_known(*tasks));
    read_form(program_form(), read_, *root, program_);
    for (const std::string& text : options_.forces) force(text);
    for (const Node& source : program_.sources) note_project(source);
    for (const Node& source : program_.sources) find_source(source);
    settle_dialect();
    for (ReplayPlan& replay : program_.replays) find_file(replay);
    std::erase_if(program_.replays, [](const ReplayPlan& r) { return r.file.is_empty(); });
    for (const BlockPlan& block : program_.blocks) check_attached(block.task);
    for (const TracePlan& trace : program_.traces) check_attached(trace.task);
    program_.root = std::move(*root);
    if (!options_.recording.empty()) recording();
    return std::move(program_);
}

/// What `--source-dialect` says is for sources that no program names.
void ProgramReader::settle_dialect() {
    const auto names = st::dialect_names();
    const auto chosen = std::ranges::find(names, program_.dialect, &st::DialectName::name);
    projects::leave_out_repeated_exports(program_.texts);
    if (chosen == names.end()) projects::read_as_neighbours(program_.texts);
    projects::read_plain_text_as(chosen == names.end() ? ".st" : chosen->ending, program_.texts);
}

/// A program that has changed may make something else of the same recording.
void ProgramReader::recording() {
    program_.recording = read_recording(options_.recording, read_.diagnostics());
    if (program_.recording && !program_.recording->meaning.empty() &&
        program_.recording->meaning != meaning_of(program_).in_force)
        read_.diagnostics().warn(
            code::recording_of_another_program, {},
            fmt::format("'{}' was recorded from another program, or with other parameters",
                        options_.recording),
            "give the same program and --set as lineshaft serve had, and the same bytes come");
}

std::optional<Node> ProgramReader::parse(const std::shared_ptr<const SourceFile>& file) const {
    return options_.files ? options_.files->parse(file, read_.diagnostics())
                          : parse_yaml(file, read_.diagnostics());
}

/// What is wrong with them is told when the whole file is read.
void ProgramReader::parameters(const Node& root, Substitution& substitution) {
    const Node* node = root.find("parameters");
    if (node)
        for (const auto& [key, value] : node->entries)
            if (is_identifier(key.text))
                values_.emplace(key.text,
                                value.is_scalar() && !value.is_empty() ? value : unreadable());
    settings(values_);
    if (node)
        for (const auto& [key, value] : node->entries)
            if (const auto it = values_.find(key.text); it != values_.end()) {
                substitution.apply(it->second);
                program_.parameters.emplace_back(key.text, it->second.text);
            }
}

void ProgramReader::unused_parameters(const Node& root, const std::set<std::string>& used) {
    const Node* declared = root.find("parameters");
    if (!declared) return;
    for (const auto& [key, value] : declared->entries)
        if (values_.contains(key.text) && !used.contains(key.text))
            read_.diagnostics().warn(
                code::never_read, key.mark,
                fmt::format("nothing uses the parameter '{}'", key.text),
                fmt::format("write ${} where it is meant, or remove it", key.text));
}

void ProgramReader::settings(ParameterValues& values) {
    std::vector<std::string> known;
    for (const auto& [name, value] : values) known.push_back(name);
    for (const Setting& setting : options_.settings) {
        const auto it = values.find(setting.name);
        if (it == values.end()) {
            read_.diagnostics().add(
                code::setting_of_no_parameter, setting.mark,
                fmt::format("the program has no parameter '{}' to set", setting.name),
                values.empty() ? "it has no 'parameters:'" : suggest(setting.name, known));
            continue;
        }
        it->second = {};
        it->second.text = setting.value;
        it->second.mark = setting.value_mark;
    }
}

/// `s7_1515`: NAME.yaml beside the program or in config/ of its folder, then of each above it in
/// the project, then in lineshaft's own. Empty, and reported, when there is none.
std::optional<std::string> ProgramReader::named_controller(const Node& node) const {
    std::error_code unknown;
    std::vector<fs::path> folders;
    const fs::path root = project_root(program_.file->path);
    for (fs::path folder = real_path(program_.file->path, unknown).parent_path();;
         folder = folder.parent_path()) {
        folders.insert(folders.end(), {folder, folder / "config"});
        if (folder == root || folder == folder.root_path()) break;
    }
    if (!shared_folder().empty()) folders.push_back(shared_folder() / "config");
    for (const fs::path& folder : folders)
        if (const fs::path file = folder / (node.text + ".yaml");
            fs::is_regular_file(file, unknown))
            return file.string();
    std::vector<std::string> known;
    for (const auto& entry : fs::directory_iterator(folders.back(), unknown))
        if (entry.path().extension() == ".yaml") known.push_back(entry.path().stem().string());
    std::ranges::sort(known);
    read_.fail(code::file_cannot_be_read, node,
               fmt::format("there is no controller '{}'", node.text), suggest(node.text, known));
    return {};
}

void ProgramReader::controller(const Node& node) {
    program_.tasks_known = false;
    if (!read_.expect_scalar(node, "'controller'") || node.is_unknown_parameter()) return;
    Diagnostics& out = read_.diagnostics();
    std::error_code unknown;
    const bool is_name =
        node.text.find_first_of("./") == std::string::npos &&
        !fs::exists(fs::path(program_.file->path).parent_path() / node.text, unknown);
    const auto path = is_name ? named_controller(node)
                              : resolve_path(node.text, program_.file->path, options_.include_dirs,
                                             node.mark, out);
    if (!path) return;
    const auto file = options_.files ? options_.files->source(*path, out, node.mark)
                                     : read_source(*path, out, node.mark);
    if (!file) return;
    auto root = parse(file);
    if (!root || !check_kind(read_, *root, "lineshaft_controller")) return;
    const Node* tasks = root->find("tasks");
    program_.tasks_known = tasks && are_known(*tasks);
    Program controller;
    read_form(controller_form(), read_, *root, controller);
    program_.tasks = std::move(controller.tasks);
    program_.notes = std::move(controller.notes);
    program_.instruction_times = controller.instruction_times;
    program_.controller_name = node;
    program_.controller = std::move(*root);
}

void ProgramReader::check_attached(const Node& task) const {
    const auto plan = std::ranges::find(program_.tasks, task.text, &TaskPlan::name);
    if (plan == program_.tasks.end() || !plan->unattached) return;
    read_.fail(
        code::entry_is_missing, task,
        fmt::format("the controller's task '{}' never runs: nothing starts it", task.text),
        fmt::format("attach it to an event: tasks: {{{}: {{on: inputs.start}}}}", task.text));
}

/// A replay without a file that could be looked for is none.
void ProgramReader::find_file(ReplayPlan& replay) const {
    if (replay.file.is_unknown_parameter()) replay.file = {};
    if (replay.file.is_empty()) return;
    const auto path = resolve_path(replay.file.text, program_.file->path, options_.include_dirs,
                                   replay.file.mark, read_.diagnostics());
    std::error_code unknown;
    if (path && fs::is_regular_file(*path, unknown))
        replay.path = *path;
    else if (path)
        read_.fail(code::file_cannot_be_read, replay.file,
                   fmt::format("there is no file '{}'", *path));
}

/// What a project is called, so that one that comes before it may refer to it as its library, too.
void ProgramReader::note_project(const Node& named) {
    Diagnostics told;  // by find_source
    if (named.is_unknown_parameter()) return;
    const auto path =
        resolve_path(named.text, program_.file->path, options_.include_dirs, named.mark, told);
    if (path && fs::path(*path).extension() == ".plcproj")
        projects_.push_back(projects::names_of_plcproj(*path));
}

/// A file, or a folder with all that lie below it, other than files of tests.
void ProgramReader::find_source(const Node& named) {
    const auto path = named.is_unknown_parameter()
                          ? std::nullopt
                          : resolve_path(named.text, program_.file->path, options_.include_dirs,
                                         named.mark, read_.diagnostics());
    program_.sources_known = program_.sources_known && path;
    if (!path) return;
    std::error_code unknown;
    if (!fs::is_directory(*path, unknown)) return read_source_file(*path, named.mark);
    std::error_code error;
    const std::vector<std::string> files = projects::sources_below(*path, error);
    if (error)
        read_.fail(code::file_cannot_be_read, named,
                   fmt::format("cannot read the folder '{}': {}", named.text, error.message()));
    else if (files.empty())
        read_.fail(code::file_cannot_be_read, named,
                   fmt::format("the folder '{}' has no file of Structured Text", named.text),
                   "their names end with .st, .scl, .s7dcl, .udt, .db, .TcPOU, .TcDUT, .TcGVL, "
                   ".TcIO, .TcTLEO, .plcproj, .xml (PLCopen, SimaticML), .exp, .typ, .var or .fun");
    program_.sources_known = program_.sources_known && !error && !files.empty();
    for (const std::string& file : files) read_source_file(file, named.mark);
}

/// The namespace of a `.plcproj` that another refers to as its library; empty: it is none.
std::string ProgramReader::namespace_of(const std::string& path) {
    if (fs::path(path).extension() != ".plcproj") return {};
    const projects::ProjectNames& own = projects_.emplace_back(projects::names_of_plcproj(path));
    for (const projects::ProjectNames& other : projects_)
        for (const auto& library : other.libraries)
            if (&other != &own && own.is_called(library.name)) return library.space;
    return {};
}

void ProgramReader::read_source_file(const std::string& path, const Mark& mark) {
    Diagnostics& out = read_.diagnostics();
    const std::size_t before = out.count();
    const auto resolve = [&](const std::string& named, const Mark& where, Diagnostics& to) {
        const fs::path own = fs::path(program_.file->path).parent_path();
        return resolve_path(fs::path(named).lexically_proximate(own).string(), program_.file->path,
                            options_.include_dirs, where, to);
    };
    const auto read = [&] {
        projects::Project project;
        projects::read_sources({project, out, resolve}, path, mark);
        return project.sources;
    };
    auto texts = options_.files ? options_.files->texts(path, read, out) : read();
    if (out.count() != before) program_.sources_known = false;
    if (const std::string space = namespace_of(path); !space.empty())
        for (auto& text : texts) text = projects::in_namespace(text, space);
    for (const auto& text : texts)
        if (std::ranges::none_of(program_.texts,
                                 [&](const auto& other) { return other->is_same_text(*text); }))
            program_.texts.push_back(text);
}

/// `signal=value`, then `@from..until`; without one of the times from the start or to the end.
void ProgramReader::force(const std::string& text) {
    const auto equals = text.find('=');
    const auto at = std::min(text.find('@'), text.size());
    const std::string times = at < text.size() ? text.substr(at + 1) : "..";
    const auto dots = times.find("..");
    if (equals == std::string::npos || equals == 0 || equals + 1 >= at || dots == std::string::npos)
        return read_.fail(code::not_a_force, node_of(text),
                          fmt::format("'{}' forces nothing", text), force_help);
    ForcePlan plan;
    plan.signal = node_of(text.substr(0, equals));
    plan.value = node_of(text.substr(equals + 1, at - equals - 1));
    const auto time = [&](const std::string& part, std::int64_t otherwise) {
        return part.empty() ? otherwise : read_.time(node_of(part)).value_or(otherwise);
    };
    plan.from = time(times.substr(0, dots), 0);
    plan.until = time(times.substr(dots + 2), never);
    if (plan.until <= plan.from)
        return read_.fail(code::not_a_force, node_of(text),
                          fmt::format("'{}' ends before it begins", text), force_help);
    program_.forces.push_back(std::move(plan));
}

projects::Project read_project(const std::string& path,
                               const std::vector<std::string>& include_dirs, Diagnostics& out) {
    projects::Project project;
    std::error_code error;
    std::vector<std::string> files{path}, allowed = include_dirs;
    if (fs::is_directory(path, error)) {
        files = projects::sources_below(path, error);
        if (const std::string left = projects::foreign_files_below(path); !left.empty())
            out.warn(code::not_supported, {}, fmt::format("in '{}' are not read: {}", path, left),
                     "'lineshaft check' of one of them says what to do with it");
        allowed.push_back(path);
    }
    if (error) files = {path};
    for (const std::string& file : files) {
        const fs::path own = fs::path(file).parent_path();
        const auto resolve = [&](const std::string& named, const Mark& where, Diagnostics& to) {
            return resolve_path(fs::path(named).lexically_proximate(own).string(), file, allowed,
                                where, to);
        };
        projects::read_sources({project, out, resolve}, file);
    }
    projects::leave_out_repeated_exports(project.sources);
    if (st::plain_text_ending().empty()) projects::read_as_neighbours(project.sources);
    return project;
}

bool check_kind(const Reader& read, const Node& root, std::string_view kind) {
    struct Kind {
        std::string_view key, what;
    };
    static constexpr Kind kinds[] = {{"lineshaft", "a program"},
                                     {"lineshaft_study", "a study"},
                                     {"lineshaft_fit", "a fit"},
                                     {"lineshaft_controller", "a controller"},
                                     {"lineshaft_recording", "a recording"}};
    const std::string_view wanted = std::ranges::find(kinds, kind, &Kind::key)->what;
    const std::string begin = fmt::format("{} begins with '{}: 1'", wanted, kind);
    if (const Node* version = root.find(kind)) {
        if (version->text == "1") return true;
        read.fail(code::unknown_kind_of_file, *version,
                  fmt::format("version '{}' of {} is not known", version->text, wanted), begin);
        return false;
    }
    for (const auto& [key, value] : root.entries)
        for (const auto& [other, what] : kinds)
            if (key.text == other) {
                read.fail(code::unknown_kind_of_file, key,
                          fmt::format("this is {}, not {}", what, wanted), begin);
                return false;
            }
    read.fail(code::unknown_kind_of_file, root,
              fmt::format("this file does not say that it is {}", wanted), begin);
    return false;
}

Program read_program(std::shared_ptr<const SourceFile> file, const LoadOptions& options,
                     Diagnostics& out) {
    return ProgramReader(options, out).read(std::move(file));
}

std::optional<std::string> resolve_path(const std::string& named, const std::string& from,
                                        const std::vector<std::string>& include_dirs, Mark where,
                                        Diagnostics& out) {
    const fs::path whole = fs::path(from).parent_path() / named, normal = whole.lexically_normal();
    std::error_code error;
    const fs::path real = real_path(whole, error);
    std::error_code unknown;
    // `..` of a linked folder is the folder around what it is a link to.
    const fs::path& path = real_path(normal, unknown) == real ? normal : whole;
    if (error) {
        out.add(code::file_cannot_be_read, std::move(where),
                fmt::format("cannot read '{}': {}", named, error.message()));
        return {};
    }
    bool allowed = lies_below(real, project_root(from));
    for (const std::string& folder : include_dirs)
        allowed = allowed || lies_below(real, real_path(folder, error));
    const fs::file_status status = fs::status(real, error);
    if (allowed && fs::exists(status) && !fs::is_regular_file(status) &&
        !fs::is_directory(status)) {
        out.add(code::file_cannot_be_read, std::move(where),
                fmt::format("'{}' is not a regular file", named),
                "only the command line may name a pipe or a device");
        return {};
    }
    if (allowed) return path.string();
    out.add(code::file_outside_project, std::move(where),
            fmt::format("'{}' lies outside of the program's project", named),
            "a project is the nearest folder above that holds config/; allow others with "
            "--include-dir");
    return {};
}

}  // namespace lineshaft
