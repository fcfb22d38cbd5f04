#include <algorithm>

#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/net/linker.hpp"
#include "runtime/run/single_run.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

struct ShowCommand {
    CommonOptions common;
    std::string program;
    bool dot = false, signals = false;
};

/// A wire as it is written, with its ends taken apart.
struct Wire {
    std::string block, port;    ///< the input it feeds
    std::string source, value;  ///< `shaft`, `velocity`; `inputs` for what comes from outside
    std::string text;           ///< `NOT previous(shaft.velocity)`
    bool previous = false;
};

/// A program with the wires of each block.
struct Drawing {
    const Program& program;
    const Machine& machine;
    std::vector<Wire> wires;

    explicit Drawing(const Loaded& loaded);
    std::string task_of(const std::string& block) const;
    std::vector<const BlockPlan*> blocks_of(const std::string& task) const;
    std::vector<const Wire*> wires_of(const std::string& block) const;
};

Drawing::Drawing(const Loaded& loaded) : program(loaded.program), machine(loaded.linked.machine) {
    for (const BlockPlan& block : program.blocks)
        for (const auto& [key, value] : block.ports) {
            const auto wire = parse_wire(value);
            if (!wire) continue;
            const std::size_t dot = wire->signal.find('.');
            wires.push_back({.block = block.name.text,
                             .port = key.text,
                             .source = wire->signal.substr(0, dot),
                             .value = wire->signal.substr(dot + 1),
                             .text = value.text,
                             .previous = wire->previous});
        }
}

std::string Drawing::task_of(const std::string& block) const {
    const auto it = std::ranges::find_if(
        program.blocks, [&](const BlockPlan& plan) { return plan.name.text == block; });
    return it == program.blocks.end() ? "" : it->task.text;
}

std::vector<const BlockPlan*> Drawing::blocks_of(const std::string& task) const {
    std::vector<const BlockPlan*> found;
    for (const BlockPlan& block : program.blocks)
        if (block.task.text == task) found.push_back(&block);
    return found;
}

std::vector<const Wire*> Drawing::wires_of(const std::string& block) const {
    std::vector<const Wire*> found;
    for (const Wire& wire : wires)
        if (wire.block == block) found.push_back(&wire);
    return found;
}

std::string timing(const Drawing& drawing, const Task& task) {
    std::string text;
    if (task.on_event) {
        const auto plan = std::ranges::find(drawing.program.tasks, task.name, &TaskPlan::name);
        for (const Node& signal : plan->on) text += (text.empty() ? "on " : ", ") + signal.text;
    } else {
        text = "every " + format_time(task.every);
    }
    if (task.offset != 0) text += ", offset " + format_time(task.offset);
    if (task.jitter != 0) text += ", jitter " + format_time(task.jitter);
    text += fmt::format(", priority {}", task.priority);
    if (task.cost != 0) text += ", cost " + format_time(task.cost);
    if (task.cost_jitter != 0) text += ", cost jitter " + format_time(task.cost_jitter);
    return text;
}

void print_block(const Drawing& drawing, const BlockPlan& block, std::size_t number) {
    fmt::print("  {:>2} {:18} {}\n", number, block.name.text, block.type.text);
    for (const Wire* wire : drawing.wires_of(block.name.text)) {
        const std::string from = drawing.task_of(wire->source);
        const std::string task = from.empty() || from == block.task.text ? "" : "  of " + from;
        fmt::print("       {:18} <- {}{}\n", wire->port, wire->text, task);
    }
}

void print_text(const Drawing& drawing) {
    const Program& program = drawing.program;
    fmt::print("{}\n", program.title.empty() ? program.file->path : program.title);
    for (const auto& [name, value] : program.parameters) fmt::print("  {:20} {}\n", name, value);
    for (const Task& task : drawing.machine.tasks) {
        fmt::print("\ntask {}: {}\n", task.name, timing(drawing, task));
        std::size_t number = 0;
        for (const BlockPlan* block : drawing.blocks_of(task.name))
            print_block(drawing, *block, ++number);
        if (number == 0) fmt::print("     no blocks\n");
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
        std::size_t number = 0;
        for (const BlockPlan* block : drawing.blocks_of(task.name))
            fmt::print("    {} [label=\"{} {}\\n{}\"];\n", dot_text(block->name.text), ++number,
                       block->name.text, block->type.text);
        fmt::print("  }}\n");
    }
    if (!drawing.program.inputs.empty()) fmt::print("  inputs [shape=cds];\n");
    for (const Wire& wire : drawing.wires)
        fmt::print("  {} -> {} [label={}{}];\n", dot_text(wire.source), dot_text(wire.block),
                   dot_text(wire.value == wire.port ? wire.value : wire.value + " > " + wire.port),
                   wire.previous ? ", style=dashed" : "");
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
        for (const BlockPlan* block : drawing.blocks_of(task.name)) {
            auto wires = nlohmann::ordered_json::object();
            for (const Wire* wire : drawing.wires_of(block->name.text))
                wires[wire->port] = wire->text;
            blocks.push_back(
                {{"name", block->name.text}, {"type", block->type.text}, {"wires", wires}});
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

Exit execute(const ShowCommand& command) {
    Diagnostics out;
    const LoadOptions options = command.common.load_options(out);
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
    CLI::App* sub = app.add_subcommand("show", "Show a program's tasks, scan order and wires");
    sub->add_option("program", command->program, "The program, a YAML file")->required();
    CLI::Option* dot =
        sub->add_flag("--dot", command->dot, "Print a graph: ... --dot | dot -Tsvg -o program.svg");
    sub->add_flag("--signals", command->signals, "List the signals with types and units")
        ->excludes(dot);
    command->common.add_to(*sub);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
