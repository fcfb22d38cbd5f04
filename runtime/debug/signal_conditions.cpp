#include "runtime/debug/signal_conditions.hpp"

#include <compare>
#include <utility>

#include "runtime/serve/desk.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::debug {

std::vector<std::string> SignalConditions::set(const std::vector<std::string>& texts) {
    conditions_.clear();
    std::vector<std::string> errors;
    for (const std::string& text : texts) {
        Diagnostics wrong;
        Condition condition{.text = text};
        read(condition, wrong);
        errors.push_back(wrong.empty() ? "" : wrong.list().front().message);
        if (wrong.empty()) conditions_.push_back(std::move(condition));
    }
    return errors;
}

void SignalConditions::read(Condition& condition, Diagnostics& out) {
    static constexpr std::pair<std::string_view, Is> signs[] = {
        {">=", Is::at_least}, {"<=", Is::at_most}, {"<>", Is::unequal},
        {">", Is::above},     {"<", Is::below},    {"=", Is::equal}};
    std::string name(trimmed(condition.text, " ")), value;
    std::size_t nearest = name.size();
    for (const auto& [sign, is] : signs)
        if (const std::size_t at = name.find(sign); at < nearest) {
            nearest = at;
            condition.is = is;
            value = trimmed(std::string_view(name).substr(at + sign.size()), " ");
        }
    name = trimmed(name.substr(0, nearest), " ");
    if (name == "time") {
        condition.is_of_time = true;
        condition.wanted = Reader(out).time(node_of(value)).value_or(0);
        return;
    }
    const bool is_negated = value.empty() && name.starts_with("NOT ");
    if (is_negated) name = trimmed(name.substr(4), " ");
    Machine& machine = loaded_.linked.machine;
    const Connecting to{loaded_.program, loaded_.linked.net, machine, Reader(out)};
    const Node node = node_of(name);
    const auto target = find_target(to, node);
    if (!target) return;
    condition.signal = machine.placed(target->signal);
    if (value.empty()) value = is_negated ? "false" : "true";
    condition.wanted = read_value(to, *target, node_of(as_in_a_program(value, target->field)))
                           .value_or(condition.wanted);
}

bool SignalConditions::holds(const Condition& condition, std::int64_t time) {
    const auto order = condition.is_of_time ? compare(Value(time), condition.wanted)
                                            : compare(condition.signal.value(), condition.wanted);
    switch (condition.is) {
        case Is::below:
            return order < 0;
        case Is::at_most:
            return order <= 0;
        case Is::above:
            return order > 0;
        case Is::at_least:
            return order >= 0;
        case Is::equal:
            return order == 0;
        case Is::unequal:
            return order != 0;
    }
    return false;
}

void SignalConditions::begin(std::int64_t time) {
    for (Condition& condition : conditions_) condition.level = holds(condition, time);
}

std::string SignalConditions::risen(std::int64_t time) {
    std::string found;
    for (Condition& condition : conditions_)
        if (rising_edge(holds(condition, time), condition.level) && found.empty())
            found = condition.text;
    return found;
}

}  // namespace lineshaft::debug
