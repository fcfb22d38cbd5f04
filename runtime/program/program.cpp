#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "runtime/program/program_reader.hpp"

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

constexpr const char* block_help =
    "add blocks such as shaft: {type: virtual_axis, task: servo, ...}";

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

bool lies_below(const fs::path& file, const fs::path& folder) {
    const auto relative = file.lexically_relative(folder);
    return !relative.empty() && *relative.begin() != "..";
}

std::vector<std::string> names_of(const ParameterValues& values) {
    std::vector<std::string> names;
    for (const auto& [name, value] : values) names.push_back(name);
    return names;
}

Node unreadable() {
    Node node;
    node.kind = Node::Kind::map;
    return node;
}

/// Replaces `$name` by the parameter's text throughout a tree.
class Substitution {
  public:
    Substitution(const ParameterValues& values, const Node* declared, const Reader& read)
        : values_(values), declared_(declared), read_(read) {}

    const std::set<std::string>& used() const { return used_; }

    void apply(Node& node) {
        for (auto& [key, value] : node.entries) apply(value);
        for (Node& item : node.items) apply(item);
        if (!node.is_scalar() || node.quoted || !node.text.starts_with('$')) return;
        const std::string name = node.text.substr(1);
        const auto it = values_.find(name);
        if (it == values_.end()) return unknown(node, name);
        const Node& value = it->second;
        used_.insert(name);
        node.parameter = name;
        if (!value.is_scalar()) return;
        node.text = value.text;
        node.quoted = value.quoted;
        if (!value.mark.file) return;
        node.used_in_line = value.mark.file == node.mark.file ? node.mark.line : 0;
        node.mark = value.mark;
    }

  private:
    void unknown(Node& node, const std::string& name) const {
        if (!declared_ || declared_->is_map())
            read_.fail("L0207", node, fmt::format("unknown parameter '{}'", name),
                       values_.empty() ? "the program has no 'parameters:'"
                                       : suggest(name, names_of(values_), "$"));
        node.parameter = name;
    }

    const ParameterValues& values_;
    const Node* declared_;  ///< `parameters:`, which may be something else than a map; null: none
    const Reader& read_;
    std::set<std::string> used_;
};

}  // namespace

Program ProgramReader::read(std::shared_ptr<const SourceFile> file) {
    program_.file = file;
    auto root = parse(file);
    if (!root || !check_kind(read_, *root, "lineshaft")) return std::move(program_);
    read_.only_keys(*root, "a program",
                    {"lineshaft", "title", "parameters", "controller", "tasks", "blocks", "inputs",
                     "outputs", "retain", "run", "stimulus", "force", "trace", "traces", "expect"});
    parameters(*root);
    Substitution substitution(values_, root->find("parameters"), read_);
    substitution.apply(*root);
    unused_parameters(*root, substitution.used());
    program_.title = fs::path(file->path).stem().string();
    if (const Node* n = root->find("title"); n && read_.expect_scalar(*n, "the title"))
        program_.title = n->text;
    if (const Node* n = root->find("controller")) controller(*n);
    if (const Node* n = root->find("tasks")) tasks(*n);
    if (!root->find("tasks") && !root->find("controller")) {
        read_.fail("L0202", *root, "a program has no 'tasks' and no 'controller'", task_help);
        program_.tasks_known = false;
    }
    if (const Node* n = read_.require(*root, "blocks", "a program", block_help)) blocks(*n);
    if (const Node* n = root->find("inputs")) inputs(*n);
    if (const Node* n =
            read_.require(*root, "run", "a program", "say how long to run: run: {for: 2 s}"))
        run(*n);
    if (const Node* n = root->find("outputs")) outputs(*n);
    if (const Node* n = root->find("retain")) retain(*n);
    if (const Node* n = root->find("stimulus")) stimuli(*n);
    if (const Node* n = root->find("force")) forces(*n);
    for (const std::string& text : options_.forces) force(text);
    if (const Node* n = root->find("trace")) trace({}, *n);
    if (const Node* n = root->find("traces")) traces(*n);
    if (const Node* n = root->find("expect")) expectations(*n);
    program_.root = std::move(*root);
    return std::move(program_);
}

std::optional<Node> ProgramReader::parse(const std::shared_ptr<const SourceFile>& file) const {
    return options_.files ? options_.files->parse(file, read_.diagnostics())
                          : parse_yaml(file, read_.diagnostics());
}

void ProgramReader::parameters(const Node& root) {
    const Node* node = root.find("parameters");
    if (node && read_.expect_map(*node, "'parameters'"))
        for (const auto& [key, value] : node->entries)
            if (read_.identifier(key, "a parameter"))
                values_.emplace(key.text,
                                read_.expect_scalar(value, "a parameter") ? value : unreadable());
    settings(values_);
    if (node)
        for (const auto& [key, value] : node->entries)
            if (const auto it = values_.find(key.text); it != values_.end())
                program_.parameters.emplace_back(key.text, it->second.text);
}

void ProgramReader::unused_parameters(const Node& root, const std::set<std::string>& used) {
    const Node* declared = root.find("parameters");
    if (!declared) return;
    for (const auto& [key, value] : declared->entries)
        if (values_.contains(key.text) && !used.contains(key.text))
            read_.diagnostics().warn(
                "L0803", key.mark, fmt::format("nothing uses the parameter '{}'", key.text),
                fmt::format("write ${} where it is meant, or remove it", key.text));
}

void ProgramReader::settings(ParameterValues& values) {
    for (const Setting& setting : options_.settings) {
        const auto it = values.find(setting.name);
        if (it == values.end()) {
            read_.diagnostics().add(
                "L0501", setting.mark,
                fmt::format("the program has no parameter '{}' to set", setting.name),
                values.empty() ? "it has no 'parameters:'"
                               : suggest(setting.name, names_of(values)));
            continue;
        }
        it->second = {};
        it->second.text = setting.value;
        it->second.mark = setting.value_mark;
    }
}

void ProgramReader::controller(const Node& node) {
    program_.tasks_known = false;
    if (!read_.expect_scalar(node, "'controller'") || node.is_unknown_parameter()) return;
    Diagnostics& out = read_.diagnostics();
    const auto path =
        resolve_path(node.text, program_.file->path, options_.include_dirs, node.mark, out);
    if (!path) return;
    const auto file = options_.files ? options_.files->source(*path, out, node.mark)
                                     : read_source(*path, out, node.mark);
    if (!file) return;
    auto root = parse(file);
    if (!root || !check_kind(read_, *root, "lineshaft_controller")) return;
    program_.tasks_known = true;
    read_.only_keys(*root, "a controller", {"lineshaft_controller", "title", "tasks"});
    if (const Node* n = read_.require(*root, "tasks", "a controller")) {
        in_controller_ = true;
        tasks(*n);
        in_controller_ = false;
    }
    program_.controller_name = node;
    program_.controller = std::move(*root);
}

void ProgramReader::blocks(const Node& node) {
    if (!read_.expect_map(node, "'blocks'",
                          "write the block's name as a key: delay: {type: ton, task: servo, ...}"))
        return;
    if (node.entries.empty()) read_.fail("L0202", node, "'blocks' has no block", block_help);
    for (const auto& [name, body] : node.entries) {
        if (!read_.identifier(name, "a block")) continue;
        if (name.text == "inputs" || name.text == "outputs") {
            read_.fail("L0210", name, fmt::format("a block cannot be called '{}'", name.text),
                       fmt::format("{0}.x names the program's own {0}", name.text));
            continue;
        }
        program_.blocks.push_back({.name = name, .type = {}, .task = {}, .cost = {}, .ports = {}});
        if (read_.expect_map(body, "a block")) block(program_.blocks.back(), body);
    }
}

void ProgramReader::block(BlockPlan& plan, const Node& body) {
    const std::string what = fmt::format("block '{}'", plan.name.text);
    const Node* type = body.find("type");
    const Node* task = body.find("task");
    if (!type)
        read_.fail("L0202", plan.name, what + " has no 'type'",
                   "'lineshaft blocks' lists the types");
    else if (read_.expect_scalar(*type, "a type"))
        plan.type = *type;
    if (!task)
        read_.fail("L0202", plan.name, what + " has no 'task'", "say which task scans it");
    else if (read_.expect_scalar(*task, "a task's name"))
        plan.task = *task;
    check_attached(plan.task);
    for (const auto& [key, value] : body.entries) {
        if (key.text == "cost")
            plan.cost = value;
        else if (key.text != "type" && key.text != "task")
            plan.ports.emplace_back(key, value);
    }
}

bool check_kind(const Reader& read, const Node& root, std::string_view kind) {
    struct Kind {
        std::string_view key, what;
    };
    static constexpr Kind kinds[] = {{"lineshaft", "a program"},
                                     {"lineshaft_study", "a study"},
                                     {"lineshaft_fit", "a fit"},
                                     {"lineshaft_controller", "a controller"}};
    const std::string_view wanted = std::ranges::find(kinds, kind, &Kind::key)->what;
    const std::string begin = fmt::format("{} begins with '{}: 1'", wanted, kind);
    if (const Node* version = root.find(kind)) {
        if (version->text == "1") return true;
        read.fail("L0211", *version,
                  fmt::format("version '{}' of {} is not known", version->text, wanted), begin);
        return false;
    }
    for (const auto& [key, value] : root.entries)
        for (const auto& [other, what] : kinds)
            if (key.text == other) {
                read.fail("L0211", key, fmt::format("this is {}, not {}", what, wanted), begin);
                return false;
            }
    read.fail("L0211", root, fmt::format("this file does not say that it is {}", wanted), begin);
    return false;
}

Program read_program(std::shared_ptr<const SourceFile> file, const LoadOptions& options,
                     Diagnostics& out) {
    return ProgramReader(options, out).read(std::move(file));
}

std::optional<std::string> resolve_path(const std::string& named, const std::string& from,
                                        const std::vector<std::string>& include_dirs, Mark where,
                                        Diagnostics& out) {
    const fs::path path = (fs::path(from).parent_path() / named).lexically_normal();
    std::error_code error;
    const fs::path real = real_path(path, error);
    if (error) {
        out.add("L0001", std::move(where),
                fmt::format("cannot read '{}': {}", named, error.message()));
        return {};
    }
    bool allowed = lies_below(real, project_root(from));
    for (const std::string& folder : include_dirs)
        allowed = allowed || lies_below(real, real_path(folder, error));
    const fs::file_status status = fs::status(real, error);
    if (allowed && fs::exists(status) && !fs::is_regular_file(status) &&
        !fs::is_directory(status)) {
        out.add("L0001", std::move(where), fmt::format("'{}' is not a regular file", named),
                "only the command line may name a pipe or a device");
        return {};
    }
    if (allowed) return path.string();
    out.add("L0002", std::move(where),
            fmt::format("'{}' lies outside of the program's project", named),
            "a project is the nearest folder above that holds config/; allow others with "
            "--include-dir");
    return {};
}

}  // namespace lineshaft
