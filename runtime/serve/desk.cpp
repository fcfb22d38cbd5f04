#include "runtime/serve/desk.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace lineshaft {

namespace {

Node node_of(std::string text) {
    Node node;
    node.text = std::move(text);
    return node;
}

std::optional<Target> target_of(Connecting& to, Change::Kind kind, const Node& signal) {
    return kind == Change::Kind::set ? find_settable(to, signal) : find_target(to, signal);
}

}  // namespace

std::vector<Change> Desk::changes(Change::Kind kind, const std::vector<Wanted>& wanted,
                                  Diagnostics& out) {
    const std::lock_guard lock(mutex_);
    Connecting to{loaded_.program, loaded_.linked.net, loaded_.linked.machine, Reader(out)};
    std::vector<Change> changes;
    for (const Wanted& each : wanted) changes.push_back(change(to, kind, each));
    if (changes.empty()) out.add("L0202", {}, "the request names no signal");
    return changes;
}

Change Desk::change(Connecting& to, Change::Kind kind, const Wanted& wanted) {
    Change change{.kind = kind, .name = wanted.signal, .text = {}};
    const auto target = target_of(to, kind, node_of(wanted.signal));
    if (!target) return change;
    if (kind == Change::Kind::release) {
        change.live = target->live;
        return change;
    }
    const std::string& unit = target->signal.unit;
    find_value(
        to, change,
        node_of(wanted.is_number && !unit.empty() ? wanted.value + " " + unit : wanted.value));
    if (!to.read.diagnostics().empty()) return change;
    const Value value = kind == Change::Kind::set ? change.stimulus.value : change.force.value;
    change.text = describe(value, target->field.type, target->field.names, unit);
    find_value(to, change, node_of(change.text));
    return change;
}

/// Found again from the text that is recorded, a value is what it will be when it is played back.
void Desk::find_value(Connecting& to, Change& change, const Node& value) {
    const Node signal = node_of(change.name);
    if (change.kind == Change::Kind::set) {
        if (auto stimulus = find_stimulus(to, signal, value)) change.stimulus = *stimulus;
    } else if (auto force = find_force(to, signal, value)) {
        change.force = *force;
    }
}

std::vector<const Signal*> Desk::signals(const std::vector<std::string>& names, Diagnostics& out) {
    std::vector<const Signal*> found;
    const Machine& machine = loaded_.linked.machine;
    if (names.empty())
        for (const Signal& signal : machine.signals) found.push_back(&signal);
    const std::lock_guard lock(mutex_);
    for (const std::string& name : names)
        if (const Signal* signal = machine.find(name))
            found.push_back(signal);
        else if (const auto other = loaded_.linked.net.find(Reader(out), node_of(name), name))
            found.push_back(machine.find(other->name));
    return found;
}

bool Desk::is_settable(const std::string& signal) {
    const std::lock_guard lock(mutex_);
    Diagnostics ignored;
    const Connecting to{loaded_.program, loaded_.linked.net, loaded_.linked.machine,
                        Reader(ignored)};
    return find_settable(to, node_of(signal)).has_value();
}

}  // namespace lineshaft
