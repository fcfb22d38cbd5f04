#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/st/types/types.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

struct ShowCommand {
    CommonOptions common;
    std::string program;
    bool dot = false, signals = false;
};

/// A program with its net.
struct Drawing {
    const Program& program;
    const Net& net;
    const Machine& machine;

    explicit Drawing(const Loaded& loaded)
        : program(loaded.program), net(loaded.linked.net), machine(loaded.linked.machine) {}

    std::vector<int> blocks_of(const Task& task) const;
    std::string_view source(const Wire& wire) const;
    std::string_view value(const Wire& wire) const;
    std::string_view input(const Wire& wire) const { return net.field(wire.to).name; }
    std::string text(const Wire& wire) const;
    /// The names of a block's references and of the blocks that they name: `Axis`, `x`.
    std::vector<std::pair<std::string_view, std::string_view>> references_of(int block) const;
};

std::vector<int> Drawing::blocks_of(const Task& task) const {
    std::vector<int> found;
    for (int i = 0; i < static_cast<int>(net.instances.size()); ++i)
        if (machine.tasks[static_cast<std::size_t>(net.instance(i).task)].name == task.name)
            found.push_back(i);
    return found;
}

/// `shaft`; `inputs` for what comes from outside.
std::string_view Drawing::source(const Wire& wire) const {
    return wire.from.instance < 0 ? "inputs" : std::string_view(net.instance(wire.from).name);
}

/// `velocity`
std::string_view Drawing::value(const Wire& wire) const {
    if (wire.from.instance >= 0) return net.field(wire.from).name;
    return net.inputs[static_cast<std::size_t>(wire.from.field)].name;
}

/// `NOT previous(shaft.velocity)`
std::string Drawing::text(const Wire& wire) const {
    const bool previous = wire.late == Late::previous;
    const bool is_address = source(wire) == st::image_name;
    return fmt::format("{}{}{}{}{}{}", wire.negated ? "NOT " : "", previous ? "previous(" : "",
                       is_address ? "" : source(wire), is_address ? "" : ".", value(wire),
                       previous ? ")" : "");
}

std::vector<std::pair<std::string_view, std::string_view>> Drawing::references_of(int block) const {
    std::vector<std::pair<std::string_view, std::string_view>> found;
    for (const Reference& reference : net.references)
        if (reference.from.instance == block && reference.to >= 0)
            found.emplace_back(net.field(reference.from).name, net.instance(reference.to).name);
    return found;
}

/// Below a second in ms, as tasks are thought of.
std::string interval(std::int64_t time) {
    constexpr std::int64_t second = 1'000'000'000;
    if (time >= second) return format_time(time);
    return fmt::format("{} ms", static_cast<double>(time) / 1e6);
}

std::string timing(const Drawing& drawing, const Task& task) {
    std::string text;
    if (task.once) return "once, before all others";
    if (task.on_event) {
        const auto plan = std::ranges::find(drawing.program.tasks, task.name, &TaskPlan::name);
        for (const Node& signal : plan->on) text += (text.empty() ? "on " : ", ") + signal.text;
    } else {
        text = "every " + interval(task.every);
    }
    if (task.offset != 0) text += ", offset " + interval(task.offset);
    if (task.jitter != 0) text += ", jitter " + interval(task.jitter);
    text += fmt::format(", priority {}", task.priority);
    if (task.cost != 0) text += ", cost " + interval(task.cost);
    if (task.cost_jitter != 0) text += ", cost jitter " + interval(task.cost_jitter);
    return text;
}

void print_block(const Drawing& drawing, int number, std::size_t place) {
    const Instance& block = drawing.net.instance(number);
    fmt::print("  {:>2} {:18} {}\n", place, block.name, block.type->name);
    for (const auto& [name, target] : drawing.references_of(number))
        fmt::print("       {:18} -> {}\n", name, target);
    for (const Wire& wire : drawing.net.wires_to(number)) {
        const int from = wire.from.instance < 0 ? -1 : drawing.net.instance(wire.from).task;
        const std::string task =
            from < 0 || from == block.task
                ? ""
                : "  of " + drawing.machine.tasks[static_cast<std::size_t>(from)].name;
        fmt::print("       {:18} <- {}{}\n", drawing.input(wire), drawing.text(wire), task);
    }
}

void print_text(const Drawing& drawing) {
    const Program& program = drawing.program;
    fmt::print("{}\n", program.title.empty() ? program.file->path : program.title);
    for (const auto& [name, value] : program.parameters) fmt::print("  {:20} {}\n", name, value);
    for (const Task& task : drawing.machine.tasks) {
        fmt::print("\ntask {}: {}\n", task.name, timing(drawing, task));
        std::size_t place = 0;
        for (const int block : drawing.blocks_of(task)) print_block(drawing, block, ++place);
        if (place == 0) fmt::print("     no blocks\n");
    }
    if (!program.inputs.empty()) fmt::print("\ninputs from outside\n");
    for (const auto& [name, value] : program.inputs)
        fmt::print("     {:18} {}\n", "inputs." + name.text, value.text);
    fmt::print(
        "\nrun: {}{}\n",
        drawing.machine.until ? "until " + drawing.machine.until->name + ", at most " : "for ",
        format_time(drawing.machine.duration));
}

std::string dot_text(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

void print_dot(const Drawing& drawing) {
    fmt::print(
        "digraph program {{\n  rankdir=LR;\n  label={};\n  labelloc=t;\n  node [shape=box];\n",
        dot_text(drawing.program.title));
    for (const Task& task : drawing.machine.tasks) {
        fmt::print("  subgraph {} {{\n    label={};\n", dot_text("cluster_" + task.name),
                   dot_text(task.name + ": " + timing(drawing, task)));
        std::size_t place = 0;
        for (const int number : drawing.blocks_of(task)) {
            const Instance& block = drawing.net.instance(number);
            fmt::print("    {} [label=\"{} {}\\n{}\"];\n", dot_text(block.name), ++place,
                       block.name, block.type->name);
        }
        fmt::print("  }}\n");
    }
    if (!drawing.program.inputs.empty()) fmt::print("  inputs [shape=cds];\n");
    for (const Reference& reference : drawing.net.references)
        if (reference.to >= 0)
            fmt::print("  {} -> {} [label={}, style=dotted, arrowhead=open];\n",
                       dot_text(drawing.net.instance(reference.from).name),
                       dot_text(drawing.net.instance(reference.to).name),
                       dot_text(drawing.net.field(reference.from).name));
    for (const Wire& wire : drawing.net.wires) {
        const std::string value(drawing.value(wire)), input(drawing.input(wire));
        fmt::print("  {} -> {} [label={}{}];\n", dot_text(drawing.source(wire)),
                   dot_text(drawing.net.instance(wire.to).name),
                   dot_text(value == input ? value : value + " > " + input),
                   wire.late == Late::previous ? ", style=dashed" : "");
    }
    fmt::print("}}\n");
}

void print_signals(const Machine& machine) {
    for (const Signal& signal : machine.signals)
        fmt::print("{:28} {:12} {}\n", signal.name, name_of(signal.type), signal.unit);
}

nlohmann::ordered_json to_json(const Drawing& drawing) {
    auto tasks = nlohmann::ordered_json::array();
    for (const Task& task : drawing.machine.tasks) {
        auto blocks = nlohmann::ordered_json::array();
        for (const int number : drawing.blocks_of(task)) {
            const Instance& block = drawing.net.instance(number);
            auto wires = nlohmann::ordered_json::object();
            for (const Wire& wire : drawing.net.wires_to(number))
                wires[std::string(drawing.input(wire))] = drawing.text(wire);
            blocks.push_back({{"name", block.name}, {"type", block.type->name}, {"wires", wires}});
            for (const auto& [name, target] : drawing.references_of(number))
                blocks.back()["references"][std::string(name)] = target;
        }
        tasks.push_back(
            {{"name", task.name}, {"timing", timing(drawing, task)}, {"blocks", blocks}});
    }
    auto signals = nlohmann::ordered_json::array();
    for (const Signal& signal : drawing.machine.signals)
        signals.push_back(
            {{"name", signal.name}, {"type", name_of(signal.type)}, {"unit", signal.unit}});
    return {{"title", drawing.program.title}, {"tasks", tasks}, {"signals", signals}};
}

/// What is read of a project, as one would write it in files of Structured Text.
Exit print_sources(const ShowCommand& command, const LoadOptions& options, Diagnostics& out) {
    const auto project = read_project(command.program, options.include_dirs, out);
    for (const auto& source : project.sources)
        for (const Diagnostic& mistake : source->mistakes) out.add(mistake);
    for (const auto& source : project.sources) {
        if (command.common.json) continue;
        fmt::print("{}", source->text);
        if (!source->text.ends_with('\n')) fmt::print("\n");
    }
    if (command.common.json) {
        auto texts = nlohmann::ordered_json::array();
        for (const auto& source : project.sources)
            texts.push_back(
                {{"file", source->path}, {"name", source->part}, {"text", source->text}});
        fmt::print("{}\n", nlohmann::ordered_json{{"sources", texts}}.dump(2));
    }
    return out.empty() ? Exit::fine : report(out, false);
}

Exit execute(const ShowCommand& command) {
    Diagnostics out;
    const LoadOptions options = command.common.load_options(out);
    if (std::error_code error; projects::is_source(command.program) ||
                               std::filesystem::is_directory(command.program, error))
        return print_sources(command, options, out);
    const auto loaded = load_program(command.program, options, standard_blocks(), out);
    if (!out.empty()) return report(out, command.common.json);
    const Drawing drawing(*loaded);
    if (command.common.json)
        fmt::print("{}\n", to_json(drawing).dump(2));
    else if (command.dot)
        print_dot(drawing);
    else if (command.signals)
        print_signals(drawing.machine);
    else
        print_text(drawing);
    return Exit::fine;
}

}  // namespace

void add_show(CLI::App& app, Exit& result) {
    auto command = std::make_shared<ShowCommand>();
    CLI::App* sub = app.add_subcommand(
        "show", "Show a program's tasks, scan order and wires, or the text of a project's sources");
    sub->add_option("program", command->program,
                    "The program, a YAML file; a project of others, or a file of one")
        ->required();
    CLI::Option* dot =
        sub->add_flag("--dot", command->dot, "Print a graph: ... --dot | dot -Tsvg -o program.svg");
    sub->add_flag("--signals", command->signals, "List the signals with types and units")
        ->excludes(dot);
    command->common.add_to(*sub);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
