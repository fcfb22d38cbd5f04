#include <utility>
#include <vector>

#include <fmt/format.h>

#include "runtime/program/program.hpp"
#include "runtime/program/program_parts.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

using enum Rule::Kind;
using enum Rule::Place;

constexpr const char* trigger_help =
    "write immediate, or {signal: a.b} with edge: rising, edge: falling, above: VALUE, below: "
    "VALUE, inside: [LOW, HIGH] or equals: VALUE";

void check_trigger(const Reader&, const Node& body, TriggerPlan& trigger) {
    struct Condition {
        const char* key;
        TriggerKind kind;
    };
    static constexpr Condition conditions[] = {{"edge", TriggerKind::rising},
                                               {"above", TriggerKind::above},
                                               {"below", TriggerKind::below},
                                               {"inside", TriggerKind::inside},
                                               {"equals", TriggerKind::equals}};
    for (const auto& [name, kind] : conditions)
        if (body.find(name)) trigger.kind = kind;
    const Node* edge = body.find("edge");
    if (edge && edge->text == "falling") trigger.kind = TriggerKind::falling;
}

Rule in_trigger(Rule::Kind kind, std::vector<std::string_view> keys) {
    return {kind,
            {},
            std::move(keys),
            "a trigger has a signal and one condition",
            trigger_help,
            the_map,
            code::entries_do_not_go_together};
}

Rule beside_trigger(std::string_view key) {
    return {only_with,
            key,
            {"trigger"},
            "'{1}' is for a trace with a trigger",
            "the start of the run has nothing before it, and comes once",
            the_key,
            code::entries_do_not_go_together};
}

const Form& trigger_form() {
    static const Form form = form_of<TriggerPlan>(
        {.name = "trigger",
         .what = "'trigger'",
         .doc = "when a measurement begins: when the condition begins to hold, or holds in the "
                "first scan. It is "
                "time 0, and looked at after every scan of the trace's task",
         .keys = {key<&TriggerPlan::signal>("signal", a_signal, "of any task"),
                  key("edge", one_of("an edge", {"rising", "falling"}), "of a boolean"),
                  key<&TriggerPlan::values>("above", a_value, "of a number"),
                  key<&TriggerPlan::values>("below", a_value, "of a number"),
                  key<&TriggerPlan::values>(
                      "inside",
                      list_of(a_value.as("a bound"))
                          .within(2, 2, "'inside' has two bounds", "write inside: [LOW, HIGH]"),
                      "of a number: the lower and the upper bound"),
                  key<&TriggerPlan::values>("equals", a_value, "of any type")},
         .rules = {in_trigger(at_least_one, {"signal"}),
                   in_trigger(exactly_one, {"edge", "above", "below", "inside", "equals"})},
         .check = by<check_trigger>});
    return form;
}

void read_trigger(const Reader& read, const Node& node, TracePlan& trace) {
    if (node.is_map())
        read_form(trigger_form(), read, node, trace.trigger);
    else
        read.fail(code::no_allowed_name, node, fmt::format("'{}' is not a trigger", node.text),
                  trigger_help);
}

/// The ring's size in memory is checked where the signals are known.
void read_pre_trigger(const Reader& read, const Node& node, TracePlan& trace) {
    trace.ring = node;
    put(read, *trace_form().find("pre_trigger"), node, trace.pre_trigger);
}

}  // namespace

const Form& trace_form() {
    static const Form form = form_of<TracePlan>(
        {.name = "trace",
         .what = "'trace'",
         .doc = "a recording of signals, one row a scan. Rows before a trigger are kept in memory, "
                "8 bytes a signal "
                "and 16 more, at most 256 MiB for all traces",
         .keys =
             {key<&TracePlan::task>("task", a_task, "whose scans are recorded").must(),
              key<&TracePlan::every>(
                  "every",
                  an_integer.at_least(
                      1, {},
                      "'every' counts scans: 1 records every scan of the task, 10 every tenth"),
                  "records every n-th scan")
                  .by_default("1"),
              key<&TracePlan::signals>("signals",
                                       list_of(a_signal)
                                           .filled("'signals' has no signal")
                                           .unique("'{}' is in this trace already"),
                                       "columns")
                  .must(),
              key<read_trigger>("trigger", a_form(trigger_form), "when a measurement begins")
                  .or_word("immediate"),
              key<read_pre_trigger>("pre_trigger", an_integer.at_least(0),
                                    "rows kept from before the trigger")
                  .by_default("0"),
              key<&TracePlan::samples>("samples", an_integer.at_least(1),
                                       "rows from the trigger on, at most"),
              key<&TracePlan::duration>("for", a_time.above_zero("a trace must be longer than 0 s"),
                                        "time from the trigger on, at most"),
              key<&TracePlan::repeat>(
                  "repeat", an_integer.within(1, 1000),
                  "measurements at most; of several, each in a file of its own: out.change.1.csv")
                  .by_default("1")},
         .rules = {beside_trigger("pre_trigger"),
                   beside_trigger("repeat"),
                   {only_with,
                    "repeat",
                    {"samples", "for"},
                    "a repeated trace says how long a measurement lasts",
                    "add samples: 1000 or for: 0.5 s",
                    the_key}}});
    return form;
}

void read_trace(const Reader& read, const Node& node, Program& program) {
    read_form(trace_form(), read, node, program.traces.emplace_back());
}

void read_traces(const Reader& read, const Node& node, Program& program) {
    for (const auto& [name, body] : node.entries) {
        if (!read.identifier(name, "a trace")) continue;
        if (name.text == "events") {
            read.fail(code::unusable_name, name, "a trace cannot be called 'events'",
                      "NAME.events.csv has the events of the run");
            continue;
        }
        TracePlan& trace = program.traces.emplace_back();
        trace.name = name;
        read_form(trace_form(), read, body, trace, fmt::format("trace '{}'", name.text));
    }
}

}  // namespace lineshaft
