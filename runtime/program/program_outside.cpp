#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "runtime/program/program_reader.hpp"

namespace lineshaft {

namespace {

constexpr const char* force_help = "write signal=value@from..until, such as slave.ratio=2@1s..2s";

/// A text from the command line: it has no place.
Node node_of(std::string_view text) {
    Node node;
    node.text = text;
    return node;
}

}  // namespace

void ProgramReader::inputs(const Node& node) {
    if (!read_.expect_map(node, "'inputs'")) return;
    for (const auto& [name, value] : node.entries)
        if (read_.identifier(name, "an input") && read_.expect_scalar(value, "an input"))
            program_.inputs.emplace_back(name, value);
}

void ProgramReader::outputs(const Node& node) {
    if (!read_.expect_map(node, "'outputs'")) return;
    for (const auto& [name, signal] : node.entries)
        if (read_.identifier(name, "an output") && read_.expect_scalar(signal, "a signal"))
            program_.outputs.emplace_back(name, signal);
}

void ProgramReader::retain(const Node& node) {
    if (!read_.expect_sequence(node, "'retain'")) return;
    for (const Node& signal : node.items) {
        if (!read_.expect_scalar(signal, "a signal")) continue;
        if (std::ranges::find(program_.retain, signal.text, &Node::text) != program_.retain.end())
            read_.fail("L0212", signal, fmt::format("'{}' is retained already", signal.text));
        program_.retain.push_back(signal);
    }
}

void ProgramReader::stimuli(const Node& node) {
    if (!read_.expect_sequence(node, "'stimulus'")) return;
    for (const Node& item : node.items)
        if (!read_.expect_map(item, "a stimulus"))
            continue;
        else if (item.find("file"))
            replay(item);
        else
            stimulus(item);
    std::ranges::stable_sort(program_.stimuli, {}, &StimulusPlan::at);
}

void ProgramReader::stimulus(const Node& item) {
    read_.only_keys(item, "a stimulus", {"at", "scan", "task", "set", "cost"});
    StimulusPlan plan{.mark = item.mark};
    const Node* scan = item.find("scan");
    const Node* task = item.find("task");
    const Node* cost = item.find("cost");
    const Node* set = item.find("set");
    if (const Node* at = item.find("at"); at && (scan || task || cost))
        return read_.fail("L0213", item, "a stimulus has a time or a scan, not both",
                          "write {at: 1 s, set: {...}} or {scan: 100, task: servo, set: {...}}");
    if (!scan && !task && !cost) {
        if (const Node* at = read_.require(item, "at", "a stimulus"))
            plan.at = read_.time(*at).value_or(0);
    } else if (read_.require(item, "scan", "a stimulus of a scan") &&
               read_.require(item, "task", "a stimulus of a scan")) {
        plan.at = read_.integer(*scan).value_or(0);
        if (plan.at < 0) read_.fail("L0305", *scan, fmt::format("'{}' is below 0", scan->text));
        if (read_.expect_scalar(*task, "a task's name")) plan.task = *task;
    }
    if (cost) plan.cost = read_.time(*cost);
    if (!set && !cost) read_.require(item, "set", "a stimulus");
    if (set && read_.expect_map(*set, "'set'")) plan.set = set->entries;
    program_.stimuli.push_back(std::move(plan));
}

/// `{file: run.csv, set: {inputs.x: shaft.position}, at: 1 s, between: interpolated}`.
void ProgramReader::replay(const Node& item) {
    read_.only_keys(item, "a replay", {"file", "set", "at", "between"});
    ReplayPlan plan;
    plan.file = *item.find("file");
    if (const Node* at = item.find("at")) plan.at = read_.time(*at).value_or(0);
    if (const Node* between = item.find("between")) plan.interpolated = interpolated(*between);
    const Node* set = read_.require(item, "set", "a replay", "set: {inputs.x: COLUMN}");
    if (set && read_.expect_map(*set, "'set'"))
        for (const auto& [key, column] : set->entries)
            if (read_.expect_scalar(column, "a column's name") && !column.is_unknown_parameter())
                plan.set.emplace_back(key, column);
    if (set && set->is_map() && set->entries.empty())
        read_.fail("L0202", *set, "'set' has no input", "write set: {inputs.x: COLUMN}");
    if (!read_.expect_scalar(plan.file, "the name of a file") || plan.file.is_unknown_parameter())
        return;
    const auto path = resolve_path(plan.file.text, program_.file->path, options_.include_dirs,
                                   plan.file.mark, read_.diagnostics());
    std::error_code unknown;
    if (path && std::filesystem::is_regular_file(*path, unknown))
        plan.path = *path;
    else if (path)
        read_.fail("L0001", plan.file, fmt::format("there is no file '{}'", *path));
    program_.replays.push_back(std::move(plan));
}

bool ProgramReader::interpolated(const Node& between) const {
    if (!read_.expect_scalar(between, "'between'")) return false;
    if (between.text != "held" && between.text != "interpolated")
        read_.fail("L0306", between, fmt::format("'{}' is no way from row to row", between.text),
                   "known: held, interpolated");
    return between.text == "interpolated";
}

void ProgramReader::forces(const Node& node) {
    if (!read_.expect_sequence(node, "'force'")) return;
    for (const Node& item : node.items) {
        if (!read_.expect_map(item, "a force")) continue;
        read_.only_keys(item, "a force", {"from", "until", "set"});
        ForcePlan plan{.mark = item.mark, .signal = {}, .value = {}};
        const Node* from = item.find("from");
        const Node* until = item.find("until");
        if (from) plan.from = read_.time(*from).value_or(0);
        if (until) plan.until = read_.time(*until).value_or(never);
        if (plan.until <= plan.from)
            read_.fail("L0213", *until, "'until' is not after 'from': this never forces");
        const Node* set = read_.require(item, "set", "a force");
        if (!set || !read_.expect_map(*set, "'set'")) continue;
        for (const auto& [signal, value] : set->entries) {
            plan.signal = signal;
            plan.value = value;
            program_.forces.push_back(plan);
        }
    }
}

/// `signal=value`, then `@from..until`; without one of the times from the start or to the end.
void ProgramReader::force(const std::string& text) {
    const auto equals = text.find('=');
    const auto at = std::min(text.find('@'), text.size());
    const std::string times = at < text.size() ? text.substr(at + 1) : "..";
    const auto dots = times.find("..");
    if (equals == std::string::npos || equals == 0 || equals + 1 >= at || dots == std::string::npos)
        return read_.fail("L0505", node_of(text), fmt::format("'{}' forces nothing", text),
                          force_help);
    ForcePlan plan;
    plan.signal = node_of(text.substr(0, equals));
    plan.value = node_of(text.substr(equals + 1, at - equals - 1));
    const auto time = [&](const std::string& part, std::int64_t otherwise) {
        return part.empty() ? otherwise : read_.time(node_of(part)).value_or(otherwise);
    };
    plan.from = time(times.substr(0, dots), 0);
    plan.until = time(times.substr(dots + 2), never);
    if (plan.until <= plan.from)
        return read_.fail("L0505", node_of(text), fmt::format("'{}' ends before it begins", text),
                          force_help);
    program_.forces.push_back(std::move(plan));
}

}  // namespace lineshaft
