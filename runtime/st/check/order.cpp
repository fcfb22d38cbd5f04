#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/declarations.hpp"

namespace lineshaft::st {

namespace {

struct Ordering {
    Checking& c;
    std::vector<const Called*> way = {};  ///< of calls, from a routine that nothing calls here on
    std::vector<const Called*> mistakes = {};
    std::vector<std::string> hops = {};  ///< of each of them
    bool was_loosened = false;
};

bool is_found(const Called& called) {
    return called.through_reference && called.routine->is_looped;
}

constexpr std::size_t most_hops = 6;

/// `a -> b -> ... -> a`
std::string hops_of(const std::vector<const Called*>& round) {
    std::string hops = round.back()->routine->name;
    for (std::size_t i = 0; i < round.size(); ++i) {
        const bool is_left_out = i + 1 < round.size() && i >= most_hops;
        if (!is_left_out)
            hops += " -> " + round[i]->routine->name;
        else if (i == most_hops)
            hops += fmt::format(" -> {} more", round.size() - 1 - most_hops);
    }
    return hops;
}

/// What goes through a reference on a way back to itself is found by the instance, which says
/// whether it runs already. Else it is a mistake, once for each routine.
void close_way(Ordering& o, const Called& last) {
    const auto first = std::ranges::find(o.way, last.routine, &Called::routine);
    std::vector<const Called*> round(first + 1, o.way.end());
    round.push_back(&last);
    bool is_loose = false;
    for (const Called* called : round)
        if (called->through_reference) is_loose = called->routine->is_looped = true;
    o.was_loosened |= is_loose;
    const auto is_told = [&](const Called* other) { return other->routine == last.routine; };
    if (is_loose || std::ranges::any_of(o.mistakes, is_told)) return;
    o.mistakes.push_back(&last);
    o.hops.push_back(hops_of(round));
}

void visit(Ordering& o, const Called& by) {
    Routine& routine = *by.routine;
    if (routine.state == Routine::State::done) return;
    if (routine.state == Routine::State::visiting) return close_way(o, by);
    routine.state = Routine::State::visiting;
    o.way.push_back(&by);
    for (const Called& called : routine.calls)
        if (!is_found(called)) visit(o, called);
    o.way.pop_back();
    routine.state = Routine::State::done;
    o.c.checked.order.push_back(&routine);
}

/// False: a call was loosened, and it is to be done again.
bool order(Ordering& o) {
    o.was_loosened = false;
    o.mistakes.clear(), o.hops.clear(), o.c.checked.order.clear();
    for (Routine& routine : o.c.checked.routines) routine.state = Routine::State::fresh;
    for (Routine& routine : o.c.checked.routines)
        if (!routine.is_prototype()) visit(o, {&routine});
    return !o.was_loosened;
}

void find_by_instances(Checking& c) {
    bool is_one = false;
    for (Routine& routine : c.checked.routines) {
        if (std::erase_if(routine.calls, is_found) > 0) routine.dispatches = is_one = true;
        for (Routine* r = routine.is_looped ? &routine : nullptr; r; r = r->overrides)
            r->is_dispatched = true;
    }
    if (!is_one) return;
    c.checked.dispatches = true;
    for (Expression& e : c.tree.expressions)
        if (e.kind == E::call && e.routine && e.routine->is_looped && is_through_reference(e))
            e.is_dispatched = true;
}

}  // namespace

void depend(Checking& c, const Type* type, Place place, bool through_reference) {
    if (!type || !c.routine) return;
    if (type->kind == Kind::array) return depend(c, type->element, place, through_reference);
    if (type->kind == Kind::structure || type->kind == Kind::union_)
        for (const Variable* member : type->members)
            depend(c, member->type, place, through_reference);
    if (type->kind != Kind::block) return;
    const auto add_call = [&](Routine* routine) {
        c.routine->calls.push_back({routine, place, through_reference});
    };
    add_call(type->routine);
    for (Routine* method : type->routine->own_methods) add_call(method);
}

void order_routines(Checking& c) {
    Ordering o{c};
    while (!order(o)) continue;
    for (std::size_t i = 0; i < o.mistakes.size(); ++i)
        c.fail(code::contains_itself, o.mistakes[i]->place,
               fmt::format("'{}' calls itself: {}", o.mistakes[i]->routine->name, o.hops[i]),
               "a PLC has no stack that grows: write a loop");
    find_by_instances(c);
}

void warn_of_unused(Checking& c) {
    for (const Routine& routine : c.checked.routines)
        for (const Variable& variable : routine.variables)
            if (!variable.used && !routine.is_test() && !routine.pou->is_tests &&
                (variable.section == Section::local || variable.section == Section::temp))
                c.warn(code::variable_never_used, variable.name.place,
                       fmt::format("'{}' is declared and never used", variable.text), "remove it");
}

}  // namespace lineshaft::st
