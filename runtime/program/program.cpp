#include "runtime/program/program.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "runtime/program/reader.hpp"

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

constexpr const char* expectation_help =
    "write it as {at: end, axis.position: 20 mm, within: 1e-9 mm}";
constexpr const char* block_help =
    "add blocks such as shaft: {type: virtual_axis, task: servo, ...}";
constexpr const char* task_help = "add tasks such as tasks: {servo: {every: 2 ms}}";

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

/// A parameter's text in force, and where a study sets it.
struct ParameterValue {
    Node node;
    Mark set_at;
};

using ParameterValues = std::map<std::string, ParameterValue>;

std::vector<std::string> names_of(const ParameterValues& values) {
    std::vector<std::string> names;
    for (const auto& [name, value] : values) names.push_back(name);
    return names;
}

/// Replaces `$name` by the parameter's text throughout a tree.
class Substitution {
  public:
    Substitution(const ParameterValues& values, const Reader& read)
        : values_(values), read_(read) {}

    void apply(Node& node) const {
        for (auto& [key, value] : node.entries) apply(value);
        for (Node& item : node.items) apply(item);
        if (!node.is_scalar() || node.quoted || !node.text.starts_with('$')) return;
        const std::string name = node.text.substr(1);
        const auto it = values_.find(name);
        if (it == values_.end()) return unknown(node, name);
        const auto& [value, set_at] = it->second;
        node.text = value.text;
        node.quoted = value.quoted;
        node.parameter = name;
        if (set_at.file) node.mark = set_at;
    }

  private:
    void unknown(Node& node, const std::string& name) const {
        read_.fail("L0207", node, fmt::format("unknown parameter '{}'", name),
                   values_.empty() ? "the program has no 'parameters:'"
                                   : suggest(name, names_of(values_)));
        node.parameter = name;
    }

    const ParameterValues& values_;
    const Reader& read_;
};

class ProgramReader {
  public:
    ProgramReader(const LoadOptions& options, Diagnostics& out) : options_(options), read_(out) {}

    Program read(std::shared_ptr<const SourceFile> file);

  private:
    void parameters(const Node& root);
    void settings(ParameterValues& values);
    void controller(const Node& node);
    void tasks(const Node& node);
    void task(const Node& name, const Node& body);
    void interval(TaskPlan& plan, const Node& name, const Node& body);
    void events(TaskPlan& plan, const Node& on, const Node& body);
    void check_task(const TaskPlan& plan, const Node& name, const Node& body);
    void blocks(const Node& node);
    void block(BlockPlan& plan, const Node& body);
    void inputs(const Node& node);
    void run(const Node& node);
    void stimuli(const Node& node);
    void trace(const Node& node);
    void traced(const Node& signals, TracePlan& plan);
    void expectations(const Node& node);
    void expectation(const Node& item);
    void bounds(const Node& map, ExpectPlan& plan);
    void at(const Node& node, ExpectPlan& plan);

    const LoadOptions& options_;
    Reader read_;
    Program program_;
    ParameterValues values_;
};

Program ProgramReader::read(std::shared_ptr<const SourceFile> file) {
    program_.file = file;
    auto root = parse_yaml(file, read_.diagnostics());
    if (!root || !check_kind(read_, *root, "lineshaft")) return std::move(program_);
    read_.only_keys(*root, "a program",
                    {"lineshaft", "title", "parameters", "controller", "tasks", "blocks", "inputs",
                     "run", "stimulus", "trace", "expect"});
    parameters(*root);
    Substitution(values_, read_).apply(*root);
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
    if (const Node* n = root->find("stimulus")) stimuli(*n);
    if (const Node* n = root->find("trace")) trace(*n);
    if (const Node* n = root->find("expect")) expectations(*n);
    return std::move(program_);
}

void ProgramReader::parameters(const Node& root) {
    const Node* node = root.find("parameters");
    if (node && read_.expect_map(*node, "'parameters'"))
        for (const auto& [key, value] : node->entries)
            if (read_.identifier(key, "a parameter") && read_.expect_scalar(value, "a parameter"))
                values_.emplace(key.text, ParameterValue{value, {}});
    settings(values_);
    if (node)
        for (const auto& [key, value] : node->entries)
            if (const auto it = values_.find(key.text); it != values_.end())
                program_.parameters.emplace_back(key.text, it->second.node.text);
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
        it->second.node.text = setting.value;
        it->second.node.quoted = false;
        it->second.set_at = setting.value_mark;
    }
}

void ProgramReader::controller(const Node& node) {
    program_.tasks_known = false;
    if (!read_.expect_scalar(node, "'controller'") || node.is_unknown_parameter()) return;
    Diagnostics& out = read_.diagnostics();
    const auto path =
        resolve_path(node.text, program_.file->path, options_.include_dirs, node.mark, out);
    if (!path) return;
    const auto file = read_source(*path, out, node.mark);
    if (!file) return;
    auto root = parse_yaml(file, out);
    if (!root || !check_kind(read_, *root, "lineshaft_controller")) return;
    program_.tasks_known = true;
    read_.only_keys(*root, "a controller", {"lineshaft_controller", "title", "tasks"});
    if (const Node* n = read_.require(*root, "tasks", "a controller")) tasks(*n);
}

void ProgramReader::tasks(const Node& node) {
    if (read_.expect_map(node, "'tasks'") && node.entries.empty())
        read_.fail("L0202", node, "'tasks' has no task", task_help);
    if (node.entries.empty()) program_.tasks_known = false;
    for (const auto& [name, body] : node.entries) {
        if (read_.identifier(name, "a task") && read_.expect_map(body, "a task"))
            task(name, body);
        else
            program_.tasks_known = false;
    }
}

void ProgramReader::task(const Node& name, const Node& body) {
    read_.only_keys(body, fmt::format("task '{}'", name.text),
                    {"every", "on", "offset", "priority", "jitter", "cost", "cost_jitter"});
    auto plan = std::ranges::find(program_.tasks, name.text, &TaskPlan::name);
    if (plan == program_.tasks.end())
        plan = program_.tasks.insert(plan, {.name = name.text, .mark = name.mark, .on = {}});
    if (const Node* on = body.find("on"))
        events(*plan, *on, body);
    else
        interval(*plan, name, body);
    if (const Node* n = body.find("cost")) plan->cost = read_.time(*n).value_or(plan->cost);
    if (const Node* n = body.find("cost_jitter"))
        plan->cost_jitter = read_.time_or_share(*n, plan->cost).value_or(plan->cost_jitter);
    if (const Node* n = body.find("priority"))
        plan->priority = read_.integer(*n).value_or(plan->priority);
    check_task(*plan, name, body);
}

/// Parts of it may come from the controller's file: then the name is the place.
void ProgramReader::check_task(const TaskPlan& plan, const Node& name, const Node& body) {
    const auto fail = [&](std::initializer_list<const char*> keys, std::string_view what) {
        const Node* place = nullptr;
        for (const char* key : keys)
            if (!place) place = body.find(key);
        read_.fail("L0305", place ? *place : name, fmt::format(fmt::runtime(what), name.text));
    };
    if (plan.every > 0 && plan.jitter >= plan.every)
        fail({"jitter", "every"}, "the jitter of task '{}' is not below its interval");
    if (plan.cost_jitter > plan.cost)
        fail({"cost_jitter", "cost"}, "the cost_jitter of task '{}' is above its cost");
    if (plan.every > 0 && plan.cost - plan.cost_jitter > plan.every)
        fail({"cost", "every"},
             "the cost of task '{}' is above its interval: it never ends in time");
}

void ProgramReader::interval(TaskPlan& plan, const Node& name, const Node& body) {
    const Node* every = body.find("every");
    if (!every && plan.every == 0 && plan.on.empty())
        read_.fail("L0202", name, fmt::format("task '{}' has no 'every' and no 'on'", name.text),
                   "write its interval, such as every: 2 ms, or the event that starts it, such as "
                   "on: inputs.start");
    if (every) plan.on.clear();
    if (every) plan.every = read_.time(*every).value_or(plan.every);
    if (every && plan.every == 0 && read_.time(*every))
        read_.fail("L0308", *every, "a task's interval must be above 0");
    if (const Node* n = body.find("offset")) plan.offset = read_.time(*n).value_or(plan.offset);
    if (const Node* n = body.find("jitter"))
        plan.jitter = read_.time_or_share(*n, plan.every).value_or(plan.jitter);
}

void ProgramReader::events(TaskPlan& plan, const Node& on, const Node& body) {
    plan.on.clear();
    plan.every = plan.offset = plan.jitter = 0;
    if (on.is_sequence())
        plan.on = on.items;
    else
        plan.on.push_back(on);
    if (plan.on.empty()) read_.fail("L0202", on, "'on' names no signal");
    for (const Node& signal : plan.on)
        if (!read_.expect_scalar(signal, "a signal")) return plan.on.clear();
    for (const char* key : {"every", "offset", "jitter"})
        if (const Node* n = body.find(key))
            read_.fail("L0213", *n, fmt::format("a task says 'on' or '{}', not both", key),
                       "an event task has no interval");
}

void ProgramReader::blocks(const Node& node) {
    if (!read_.expect_map(node, "'blocks'")) return;
    if (node.entries.empty()) read_.fail("L0202", node, "'blocks' has no block", block_help);
    for (const auto& [name, body] : node.entries) {
        if (!read_.identifier(name, "a block")) continue;
        if (name.text == "inputs") {
            read_.fail("L0210", name, "a block cannot be called 'inputs'",
                       "inputs.x names the program's own inputs");
            continue;
        }
        program_.blocks.push_back({.name = name, .type = {}, .task = {}, .ports = {}});
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
    for (const auto& [key, value] : body.entries)
        if (key.text != "type" && key.text != "task") plan.ports.emplace_back(key, value);
}

void ProgramReader::inputs(const Node& node) {
    if (!read_.expect_map(node, "'inputs'")) return;
    for (const auto& [name, value] : node.entries)
        if (read_.identifier(name, "an input") && read_.expect_scalar(value, "an input"))
            program_.inputs.emplace_back(name, value);
}

void ProgramReader::run(const Node& node) {
    RunPlan& run = program_.run;
    run.mark = node.mark;
    if (!read_.expect_map(node, "'run'")) return;
    read_.only_keys(node, "'run'", {"for", "until", "seed", "on_error"});
    if (const Node* n = node.find("for")) {
        const auto duration = read_.time(*n);
        if (duration == 0) read_.fail("L0308", *n, "a run must be longer than 0 s");
        run.duration = duration.value_or(0);
    }
    if (const Node* n = node.find("until"); n && read_.expect_scalar(*n, "'until'")) run.until = *n;
    if (!node.find("for"))
        read_.fail("L0202", node, "'run' has no 'for'",
                   "say how long to run, such as for: 2 s; with 'until' it is the limit");
    if (const Node* n = node.find("seed")) {
        const std::int64_t seed = read_.integer(*n).value_or(1);
        if (seed < 0) read_.fail("L0305", *n, fmt::format("'{}' is below 0", n->text));
        run.seed = static_cast<std::uint64_t>(seed);
    }
    const Node* on_error = node.find("on_error");
    if (!on_error || !read_.expect_scalar(*on_error, "'on_error'")) return;
    run.continue_on_error = on_error->text == "continue";
    if (!run.continue_on_error && on_error->text != "stop")
        read_.fail("L0306", *on_error, fmt::format("'{}' is no way to go on", on_error->text),
                   "known: stop, continue");
}

void ProgramReader::stimuli(const Node& node) {
    if (!read_.expect_sequence(node, "'stimulus'")) return;
    for (const Node& item : node.items) {
        if (!read_.expect_map(item, "a stimulus")) continue;
        read_.only_keys(item, "a stimulus", {"at", "set"});
        StimulusPlan plan;
        if (const Node* n = read_.require(item, "at", "a stimulus"))
            plan.at = read_.time(*n).value_or(0);
        if (const Node* n = read_.require(item, "set", "a stimulus");
            n && read_.expect_map(*n, "'set'"))
            plan.set = n->entries;
        program_.stimuli.push_back(std::move(plan));
    }
    std::ranges::stable_sort(program_.stimuli, {}, &StimulusPlan::at);
}

void ProgramReader::trace(const Node& node) {
    if (!read_.expect_map(node, "'trace'")) return;
    read_.only_keys(node, "'trace'", {"task", "every", "signals"});
    TracePlan plan;
    if (const Node* n = read_.require(node, "task", "'trace'");
        n && read_.expect_scalar(*n, "a task's name"))
        plan.task = *n;
    if (const Node* n = node.find("every")) {
        plan.every = read_.integer(*n).value_or(1);
        if (plan.every < 1)
            read_.fail("L0305", *n, fmt::format("'{}' is below 1", n->text),
                       "1 records every scan, 10 every tenth");
    }
    const Node* signals = read_.require(node, "signals", "'trace'");
    if (signals && read_.expect_sequence(*signals, "'signals'")) traced(*signals, plan);
    program_.trace = std::move(plan);
}

void ProgramReader::traced(const Node& signals, TracePlan& plan) {
    if (signals.items.empty()) read_.fail("L0202", signals, "'signals' has no signal");
    for (const Node& signal : signals.items) {
        if (!read_.expect_scalar(signal, "a signal")) continue;
        const auto same = [&](const Node& other) { return other.text == signal.text; };
        if (std::ranges::any_of(plan.signals, same))
            read_.fail("L0212", signal, fmt::format("'{}' is in this trace already", signal.text));
        plan.signals.push_back(signal);
    }
}

void ProgramReader::expectations(const Node& node) {
    if (!read_.expect_sequence(node, "'expect'")) return;
    for (const Node& item : node.items)
        if (read_.expect_map(item, "an expectation")) expectation(item);
}

void ProgramReader::expectation(const Node& item) {
    ExpectPlan plan;
    plan.mark = item.mark;
    const Node* always = item.find("always");
    const Node* when = item.find("at");
    if (always && when)
        return read_.fail("L0213", item, "an expectation says 'at' or 'always', not both",
                          "write two expectations");
    if (!always && !when)
        return read_.fail("L0202", item, "an expectation says neither 'at' nor 'always'",
                          expectation_help);
    bounds(item, plan);
    plan.always = always != nullptr;
    if (always && read_.expect_scalar(*always, "a signal")) plan.signal = *always;
    if (when) at(*when, plan);
    for (const auto& [key, value] : item.entries) {
        if (key.text == "at" || key.text == "always" || key.text == "within" ||
            key.text == "at_least" || key.text == "at_most")
            continue;
        if (always || !plan.signal.text.empty()) {
            read_.fail("L0201", key,
                       fmt::format("an expectation has one signal, '{}' is a second", key.text));
            continue;
        }
        plan.signal = key;
        if (!value.is_map()) {
            plan.equals = value;
            continue;
        }
        read_.only_keys(value, "an expectation's bounds", {"at_least", "at_most"});
        bounds(value, plan);
    }
    if (plan.signal.text.empty())
        return read_.fail("L0202", item, "an expectation names no signal", expectation_help);
    if (!plan.equals && !plan.at_least && !plan.at_most)
        return read_.fail("L0202", item, "an expectation has no value and no bound",
                          "write SIGNAL: VALUE, at_least or at_most");
    if (plan.within && !plan.equals)
        return read_.fail("L0202", *plan.within, "'within' is for a value, and there is none",
                          "write SIGNAL: VALUE beside it");
    if (plan.equals && (plan.at_least || plan.at_most))
        return read_.fail("L0213", item, "an expectation has a value or bounds, not both",
                          "write two expectations");
    program_.expectations.push_back(std::move(plan));
}

void ProgramReader::bounds(const Node& map, ExpectPlan& plan) {
    if (const Node* n = map.find("within")) plan.within = *n;
    if (const Node* n = map.find("at_least")) plan.at_least = *n;
    if (const Node* n = map.find("at_most")) plan.at_most = *n;
}

void ProgramReader::at(const Node& node, ExpectPlan& plan) {
    if (node.is_scalar() && node.text == "end") return;
    plan.at = read_.time(node);
}

}  // namespace

bool check_kind(const Reader& read, const Node& root, std::string_view kind) {
    struct Kind {
        std::string_view key, what;
    };
    static constexpr Kind kinds[] = {{"lineshaft", "a program"},
                                     {"lineshaft_study", "a study"},
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
    if (allowed) return path.string();
    out.add("L0002", std::move(where),
            fmt::format("'{}' lies outside of the program's project", named),
            "a project is the nearest folder above that holds config/; allow others with "
            "--include-dir");
    return {};
}

}  // namespace lineshaft
