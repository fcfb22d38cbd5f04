#include "runtime/st/check/declarations.hpp"

namespace lineshaft::st {

namespace {

void visit(Checking& c, Routine& routine, std::vector<const Routine*>& path) {
    if (routine.state == Routine::State::done) return;
    routine.state = Routine::State::visiting;
    path.push_back(&routine);
    for (std::size_t i = 0; i < routine.calls.size(); ++i) {
        Routine& called = *routine.calls[i];
        if (called.state != Routine::State::visiting) {
            visit(c, called, path);
            continue;
        }
        std::string hops;
        for (auto it = std::ranges::find(path, &called); it != path.end(); ++it)
            hops += fmt::format("{} -> ", (*it)->name);
        c.fail(code::contains_itself, routine.call_places[i],
               fmt::format("'{}' calls itself: {}{}", called.name, hops, called.name),
               "a PLC has no stack that grows: write a loop");
    }
    path.pop_back();
    routine.state = Routine::State::done;
    c.checked.order.push_back(&routine);
}

}  // namespace

void depend(Checking& c, const Type* type, Place place) {
    if (!type || !c.routine) return;
    if (type->kind == Kind::array) return depend(c, type->element, place);
    if (type->kind == Kind::structure || type->kind == Kind::union_)
        for (const Variable* member : type->members) depend(c, member->type, place);
    if (type->kind != Kind::block) return;
    const auto add_call = [&](Routine* routine) {
        c.routine->calls.push_back(routine);
        c.routine->call_places.push_back(place);
    };
    add_call(type->routine);
    for (Routine* method : type->routine->own_methods) add_call(method);
}

void order_routines(Checking& c) {
    std::vector<const Routine*> path;
    for (Routine& routine : c.checked.routines)
        if (!routine.is_prototype()) visit(c, routine, path);
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
