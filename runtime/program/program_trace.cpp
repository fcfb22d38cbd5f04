#include <algorithm>

#include <fmt/format.h>

#include "runtime/program/program_reader.hpp"

namespace lineshaft {

namespace {

constexpr std::int64_t most_measurements = 1000;
constexpr const char* trigger_help =
    "write immediate, or {signal: a.b} with edge: rising, edge: falling, above: VALUE, below: "
    "VALUE, inside: [LOW, HIGH] or equals: VALUE";

struct Comparison {
    const char* key;
    TriggerKind kind;
};

constexpr Comparison comparisons[] = {{"above", TriggerKind::above},
                                      {"below", TriggerKind::below},
                                      {"inside", TriggerKind::inside},
                                      {"equals", TriggerKind::equals}};

}  // namespace

void ProgramReader::traces(const Node& node) {
    if (!read_.expect_map(node, "'traces'")) return;
    if (node.entries.empty()) read_.fail("L0202", node, "'traces' has no trace");
    for (const auto& [name, body] : node.entries) {
        if (!read_.identifier(name, "a trace")) continue;
        if (name.text == "events")
            read_.fail("L0210", name, "a trace cannot be called 'events'",
                       "NAME.events.csv has the events of the run");
        else
            trace(name, body);
    }
}

void ProgramReader::trace(const Node& name, const Node& node) {
    const std::string what = name.text.empty() ? "'trace'" : fmt::format("trace '{}'", name.text);
    if (!read_.expect_map(node, what)) return;
    read_.only_keys(
        node, what,
        {"task", "every", "signals", "trigger", "pre_trigger", "samples", "for", "repeat"});
    TracePlan plan;
    plan.name = name;
    if (const Node* n = read_.require(node, "task", what);
        n && read_.expect_scalar(*n, "a task's name"))
        plan.task = *n;
    check_attached(plan.task);
    plan.every = count(node, "every", 1,
                       "'every' counts scans: 1 records every scan of the task, 10 every tenth")
                     .value_or(1);
    const Node* signals = read_.require(node, "signals", what);
    if (signals && read_.expect_sequence(*signals, "'signals'")) traced(*signals, plan);
    if (const Node* n = node.find("trigger")) trigger(*n, plan.trigger);
    if (const Node* n = node.find("pre_trigger")) plan.ring = *n;
    plan.pre_trigger = count(node, "pre_trigger", 0).value_or(0);
    plan.samples = count(node, "samples", 1).value_or(0);
    plan.repeat = count(node, "repeat", 1).value_or(1);
    if (const Node* n = node.find("for")) {
        plan.duration = read_.time(*n).value_or(1);
        if (plan.duration == 0) read_.fail("L0308", *n, "a trace must be longer than 0 s");
    }
    check_trace(node, plan);
    program_.traces.push_back(std::move(plan));
}

std::optional<std::int64_t> ProgramReader::count(const Node& map, const char* key,
                                                 std::int64_t least, const char* help) {
    const Node* node = map.find(key);
    const auto number = node ? read_.integer(*node, help) : std::nullopt;
    if (!number || *number >= least) return number;
    read_.fail("L0305", *node, fmt::format("'{}' is below {}", node->text, least), help);
    return {};
}

void ProgramReader::check_trace(const Node& node, const TracePlan& plan) {
    const Node* begin = node.find("trigger");
    const bool immediate = !begin || (begin->is_scalar() && begin->text == "immediate");
    for (const char* key : {"pre_trigger", "repeat"})
        if (const Node* n = node.find(key); n && immediate)
            read_.fail("L0213", *n, fmt::format("'{}' is for a trace with a trigger", key),
                       "the start of the run has nothing before it, and comes once");
    if (plan.repeat > most_measurements)
        read_.fail("L0305", *node.find("repeat"),
                   fmt::format("'{}' is above {}", plan.repeat, most_measurements));
    if (plan.repeat > 1 && !node.find("samples") && !node.find("for"))
        read_.fail("L0202", *node.find("repeat"),
                   "a repeated trace says how long a measurement lasts",
                   "add samples: 1000 or for: 0.5 s");
}

void ProgramReader::trigger(const Node& node, TriggerPlan& plan) {
    if (node.is_scalar() && node.text == "immediate") return;
    if (!node.is_map())
        return read_.fail("L0306", node, fmt::format("'{}' is no trigger", node.text),
                          trigger_help);
    read_.only_keys(node, "'trigger'", {"signal", "edge", "above", "below", "inside", "equals"});
    if (node.entries.size() != 2 || !node.find("signal"))
        return read_.fail("L0213", node, "a trigger has a signal and one condition", trigger_help);
    if (!read_.expect_scalar(*node.find("signal"), "a signal")) return;
    plan.signal = *node.find("signal");
    if (const Node* n = node.find("edge")) return edge(*n, plan);
    for (const auto& [key, kind] : comparisons) {
        const Node* value = node.find(key);
        if (!value) continue;
        plan.kind = kind;
        if (kind != TriggerKind::inside) {
            plan.values = {*value};
            if (!read_.expect_scalar(*value, fmt::format("'{}'", key))) plan.values.clear();
            continue;
        }
        if (!read_.expect_sequence(*value, "'inside'")) continue;
        plan.values = value->items;
        if (plan.values.size() != 2)
            read_.fail("L0214", *value, "'inside' has two bounds", "write inside: [LOW, HIGH]");
    }
}

void ProgramReader::edge(const Node& node, TriggerPlan& plan) {
    if (!read_.expect_scalar(node, "'edge'")) return;
    plan.kind = node.text == "falling" ? TriggerKind::falling : TriggerKind::rising;
    if (node.text != "falling" && node.text != "rising")
        read_.fail("L0306", node, fmt::format("'{}' is no edge", node.text),
                   "known: rising, falling");
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

}  // namespace lineshaft
