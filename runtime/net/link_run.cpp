#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/model/literal.hpp"
#include "runtime/net/linker.hpp"

namespace lineshaft {

namespace {

/// value + sign * slack; of a whole number exact, and at most as far as whole numbers go.
Value moved(const Value& value, const Value& slack, int sign) {
    constexpr double most = 0x1p63;
    const auto* whole = std::get_if<std::int64_t>(&value);
    const double size = as_real(slack);
    if (!whole || size >= most) return as_real(value) + sign * size;
    const auto* exact = std::get_if<std::int64_t>(&slack);
    const std::int64_t way = sign * (exact ? *exact : static_cast<std::int64_t>(size));
    std::int64_t sum = 0;
    if (!__builtin_add_overflow(*whole, way, &sum)) return sum;
    using Limits = std::numeric_limits<std::int64_t>;
    return sign > 0 ? Limits::max() : Limits::min();
}

}  // namespace

void Linker::connect_events() {
    for (const TaskPlan& plan : program_.tasks) {
        const auto it = std::ranges::find(task_names_, plan.name);
        for (const Node& node : plan.on) {
            const auto event = signal(node);
            if (!event) continue;
            if (event->type == Type::boolean)
                out_.machine.triggers.push_back(
                    {.signal = reinterpret_cast<const bool*>(event->slot),
                     .task = static_cast<int>(it - task_names_.begin())});
            else
                read_.fail("L0401", node,
                           fmt::format("'on' takes a boolean, '{}' is {}", event->name,
                                       name_of(event->type)));
        }
    }
}

void Linker::connect_overruns() {
    for (const TaskPlan& plan : program_.tasks) {
        const auto handler = std::ranges::find(task_names_, plan.name) - task_names_.begin();
        for (const Node& node : plan.on_overrun) {
            const int index = find_task(node);
            if (index < 0) continue;
            Task& task = out_.machine.tasks[static_cast<std::size_t>(index)];
            if (task.motion || index == handler)
                read_.fail("L0410", node,
                           fmt::format("'{}' {}", node.text,
                                       task.motion ? "is a motion task: its overrun is STOP"
                                                   : "cannot handle its own overrun"));
            else if (task.on_overrun >= 0)
                read_.fail("L0212", node,
                           fmt::format("the overrun of '{}' starts '{}' already", node.text,
                                       task_names_[static_cast<std::size_t>(task.on_overrun)]));
            else
                task.on_overrun = static_cast<int>(handler);
        }
    }
}

void Linker::connect_run() {
    Machine& machine = out_.machine;
    machine.duration = program_.run.duration;
    machine.seed = program_.run.seed;
    machine.continue_on_error = program_.run.continue_on_error;
    if (!program_.run.until) return;
    machine.until = signal(*program_.run.until);
    if (machine.until && machine.until->type != Type::boolean)
        read_.fail("L0401", *program_.run.until,
                   fmt::format("'until' takes a boolean, '{}' is {}", machine.until->name,
                               name_of(machine.until->type)));
}

std::optional<Value> Linker::bound(const Signal& signal, const Node& node) {
    Field field;
    field.name = signal.name;
    field.type = signal.type;
    field.names = signal.names;
    return read_literal(read_, node, field, parsed(signal.unit));
}

/// Whole where the signal and the text are.
std::optional<Value> Linker::tolerance(const Signal& signal, const Node& node,
                                       const Value& around) {
    static const Unit one;
    if (signal.type == Type::boolean || signal.type == Type::enumeration) {
        read_.fail("L0213", node,
                   fmt::format("'within' is for numbers, '{}' is {}", signal.name,
                               kind(signal.type, signal.names)));
        return {};
    }
    const bool share = node.is_scalar() && node.text.ends_with('%');
    const bool time = signal.type == Type::integer && signal.unit == "ns" && !share;
    const auto given = parse_quantity(node.text);
    const auto* quantity = std::get_if<Quantity>(&given);
    const bool whole = signal.type == Type::integer && signal.unit.empty() && quantity &&
                       quantity->is_integer && !quantity->has_unit;
    std::optional<Value> value;
    if (whole || time)
        value = whole ? read_.integer(node) : read_.time(node);
    else
        value = read_.real(node, share ? one : parsed(signal.unit));
    if (!value) return {};
    if (compare(*value, 0.0) >= 0)
        return share ? Value(as_real(*value) * std::abs(as_real(around))) : value;
    read_.fail("L0305", node, fmt::format("'{}' is below 0", node.text));
    return {};
}

void Linker::connect_expectations() {
    for (const ExpectPlan& plan : program_.expectations) {
        const auto target = signal(plan.signal);
        if (!target) continue;
        Expectation e{
            .text = {}, .signal = *target, .always = plan.always, .at = plan.at, .wanted = {}};
        if (plan.equals) {
            e.low = e.high = bound(*target, *plan.equals).value_or(0.0);
            const auto slack = plan.within ? tolerance(*target, *plan.within, e.low) : std::nullopt;
            if (slack) {
                e.high = moved(e.low, *slack, 1);
                e.low = moved(e.low, *slack, -1);
            }
            e.wanted = plan.equals->text;
            if (plan.within) e.wanted += " within " + plan.within->text;
        }
        const auto side = [&](const std::optional<Node>& node, const char* word, Value& limit) {
            if (!node) return;
            limit = bound(*target, *node).value_or(0.0);
            e.wanted += fmt::format("{}{} {}", e.wanted.empty() ? "" : ", ", word, node->text);
        };
        side(plan.at_least, "at least", e.low);
        side(plan.at_most, "at most", e.high);
        if (plan.at_least && plan.at_most && compare(e.low, e.high) > 0)
            read_.fail("L0213", *plan.at_least, "'at_least' is above 'at_most': this never holds");
        const std::string when = plan.always ? "always"
                                 : plan.at   ? "at " + format_time(*plan.at)
                                             : "at the end";
        e.text = fmt::format("{}: {} {}{}", when, target->name, plan.equals ? "= " : "", e.wanted);
        out_.expectations.push_back(std::move(e));
    }
}

}  // namespace lineshaft
