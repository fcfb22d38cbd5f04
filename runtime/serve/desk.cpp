#include "runtime/serve/desk.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft {

namespace {

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

/// `T#2s`, `TOD#12:30:00` in ns.
std::optional<st::Wide> read_time(const std::string& type, std::string_view text) {
    using Kind = st::Type::Kind;
    static constexpr std::pair<std::string_view, Kind> kinds[] = {
        {"t", Kind::time},    {"time", Kind::time},           {"d", Kind::date},
        {"date", Kind::date}, {"tod", Kind::clock},           {"time_of_day", Kind::clock},
        {"dt", Kind::moment}, {"date_and_time", Kind::moment}};
    for (const auto& [name, kind] : kinds)
        if (type == name || (type == "l" + std::string(name))) return st::read_time(text, kind);
    return {};
}

}  // namespace

std::string as_in_a_program(std::string_view text, const Field& field) {
    const bool has_type = !text.empty() && is_letter(text.front());
    const std::size_t sharp = has_type ? text.find('#') : text.npos;
    const std::string type = lower(text.substr(0, sharp == text.npos ? 0 : sharp));
    const std::string_view bare = sharp == text.npos ? text : text.substr(sharp + 1);
    if (field.type == Type::enumeration) {
        const std::string_view value = bare.substr(bare.rfind('.') + 1);
        for (const std::string_view name : field.names)
            if (same_letters(name, value)) return std::string(name);
    } else if (field.type == Type::boolean) {
        const std::string truth = lower(bare);
        if (truth == "true" || truth == "1") return "true";
        if (truth == "false" || truth == "0") return "false";
    } else if (field.type == Type::real) {
        if (const auto real = st::read_real(bare)) return fmt::format("{}", *real);
    } else if (field.is_time()) {
        if (const auto time = read_time(type, bare)) return st::to_string(*time) + " ns";
    } else {
        const std::size_t sign = bare.starts_with('-') ? 1 : 0;
        if (const auto whole = st::read_integer(bare.substr(sign)))
            return st::to_string(sign == 0 ? *whole : -*whole);
    }
    return std::string(text);
}

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
    const Node node = node_of(wanted.signal);
    const auto target = target_of(to, kind, node);
    if (!target) return change;
    if (kind == Change::Kind::lift_force) {
        change.live = target->live;
        return change;
    }
    const std::string& unit = target->signal.unit;
    const bool lacks_unit = wanted.is_number && !unit.empty();
    const std::string text = lacks_unit         ? wanted.value + " " + unit
                             : wanted.is_number ? wanted.value
                                                : as_in_a_program(wanted.value, target->field);
    const auto value = read_value(to, *target, node_of(text));
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
    const Node node = node_of(signal);
    return find_settable(to, node).has_value();
}

}  // namespace lineshaft
