#include "runtime/serve/desk.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

Node node_of(std::string text) {
    Node node;
    node.text = std::move(text);
    return node;
}

std::optional<Target> target_of(const Connecting& to, Change::Kind kind, const Node& signal) {
    switch (kind) {
        case Change::Kind::set:
            return find_settable(to, signal);
        case Change::Kind::force:
            return find_forceable(to, signal);
        case Change::Kind::lift_force:
            break;
    }
    return find_target(to, signal);
}

}  // namespace

std::vector<Change> Desk::changes(Change::Kind kind, const std::vector<Wanted>& wanted,
                                  Diagnostics& out) {
    const std::lock_guard lock(mutex_);
    const Connecting to{loaded_.program, loaded_.linked.net, loaded_.linked.machine, Reader(out)};
    std::vector<Change> changes;
    for (const Wanted& each : wanted) changes.push_back(change(to, kind, each));
    if (changes.empty()) out.add(code::entry_is_missing, {}, "the request names no signal");
    return changes;
}

/// The text that is recorded is read again as the same value.
Change Desk::change(const Connecting& to, Change::Kind kind, const Wanted& wanted) {
    Change change{.kind = kind, .name = wanted.signal, .text = {}};
    const auto target = target_of(to, kind, node_of(wanted.signal));
    if (!target) return change;
    if (kind == Change::Kind::lift_force) {
        change.live = target->live;
        return change;
    }
    const std::string& unit = target->signal.unit;
    const bool lacks_unit = wanted.is_number && !unit.empty();
    const auto value =
        read_value(to, *target, node_of(lacks_unit ? wanted.value + " " + unit : wanted.value));
    if (!value) return change;
    change.text = describe(*value, target->field.type, target->field.names, unit);
    if (kind == Change::Kind::set)
        change.stimulus = stimulus_of(*target, *value, change.name, change.text);
    else
        change.force = force_of(to.machine, *target, *value, change.text);
    return change;
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
