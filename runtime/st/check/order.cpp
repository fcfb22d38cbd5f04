#include <algorithm>
#include <functional>
#include <unordered_map>
#include <unordered_set>

#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/declarations.hpp"

namespace lineshaft::st {

namespace {

/// A way of calls that comes back.
struct Round {
    const Called* last = nullptr;
    std::string hops;
    bool recurs = false;  ///< else it is a mistake
};

struct Ordering {
    Checking& c;
    std::vector<const Called*> way = {};  ///< of calls, from a routine that nothing calls here on
    std::vector<Round> rounds = {};       ///< one for each routine that is come back to
    std::unordered_set<const Routine*> made = {};  ///< blocks whose parts are in order
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
/// whether it runs already. What consists of calls recurs. Else it is a mistake, once for each
/// routine.
void close_way(Ordering& o, const Called& last) {
    const auto first = std::ranges::find(o.way, last.routine, &Called::routine);
    std::vector<const Called*> round(first + 1, o.way.end());
    round.push_back(&last);
    bool is_loose = false;
    for (const Called* called : round)
        if (called->through_reference) is_loose = called->routine->is_looped = true;
    o.was_loosened |= is_loose;
    const auto is_told = [&](const Round& other) { return other.last->routine == last.routine; };
    if (is_loose || std::ranges::any_of(o.rounds, is_told)) return;
    const auto may_recur = [](const Called* called) { return called->may_recur(); };
    o.rounds.push_back({&last, hops_of(round), std::ranges::all_of(round, may_recur)});
}

void visit(Ordering& o, const Called& by);

/// What a block is made of comes before its methods: they are laid out behind it.
void visit_parts(Ordering& o, const Routine& block) {
    if (o.made.contains(&block)) return;
    for (const Called& part : block.calls)
        if (!part.is_call && !part.through_reference) visit(o, part);
    o.made.insert(&block);
}

void visit(Ordering& o, const Called& by) {
    Routine& routine = *by.routine;
    if (routine.state == Routine::State::done) return;
    if (routine.state == Routine::State::visiting) return close_way(o, by);
    routine.state = Routine::State::visiting;
    o.way.push_back(&by);
    if (routine.owner) visit_parts(o, *routine.owner);
    for (const Called& called : routine.calls)
        if (!is_found(called)) visit(o, called);
    o.way.pop_back();
    routine.state = Routine::State::done;
    o.c.checked.order.push_back(&routine);
}

/// False: a call was loosened, and it is to be done again.
bool order(Ordering& o) {
    o.was_loosened = false;
    o.rounds.clear(), o.made.clear(), o.c.checked.order.clear();
    for (Routine& routine : o.c.checked.routines) routine.state = Routine::State::fresh;
    for (Routine& routine : o.c.checked.routines)
        if (!routine.is_prototype()) visit(o, {&routine});
    return !o.was_loosened;
}

/// Numbers the rings of routines that call one another, by Tarjan's algorithm.
struct Rings {
    struct Visit {
        std::size_t number = 0, lowest = 0;
        bool is_open = true;
        bool runs_rings = false;
    };
    using Callees = std::function<std::vector<Routine*>(const Routine&)>;

    const Callees& callees;
    int Routine::*ring;
    std::unordered_map<Routine*, Visit> visits = {};
    std::vector<Routine*> open = {};
    int found = 0;

    const Visit& visit(Routine& routine) {
        Visit& own = visits[&routine];  // stays where it is
        own.number = own.lowest = visits.size();
        open.push_back(&routine);
        bool is_ring = false;
        for (Routine* called : callees(routine)) {
            is_ring |= called == &routine;
            const auto it = visits.find(called);
            const Visit& other = it != visits.end() ? it->second : visit(*called);
            if (other.is_open) own.lowest = std::min(own.lowest, other.lowest);
            own.runs_rings |= other.runs_rings;
        }
        if (own.lowest == own.number) close(routine, is_ring, own.runs_rings);
        return own;
    }

    void close(Routine& first, bool is_ring, bool runs_rings) {
        is_ring |= open.back() != &first;
        runs_rings |= is_ring;
        found += is_ring;
        for (Routine* last = nullptr; last != &first; open.pop_back()) {
            last = open.back();
            visits[last].is_open = false;
            visits[last].runs_rings = last->runs_rings = runs_rings;
            last->*ring = is_ring ? found : 0;
        }
    }
};

void note_rings(const Checking& c, const Rings::Callees& callees, int Routine::*ring) {
    Rings rings{callees, ring};
    for (Routine* routine : c.checked.order)
        if (!rings.visits.contains(routine)) rings.visit(*routine);
}

std::vector<Routine*> plain_callees(const Routine& routine) {
    std::vector<Routine*> callees;
    for (const Called& called : routine.calls) callees.push_back(called.routine);
    return callees;
}

void note_plain_rings(Ordering& o) {
    note_rings(o.c, plain_callees, &Routine::plain_ring);
    for (const Routine* routine : o.c.checked.order)
        for (const Called& called : routine->calls)
            if (routine->plain_ring != 0 && called.routine->plain_ring == routine->plain_ring &&
                !called.may_recur())
                o.rounds.push_back({&called, hops_of({&called}), false});
}

/// The blocks that are each of these, by what they extend and implement.
using Kinds = std::unordered_map<const Routine*, std::vector<Routine*>>;

void add_kind(Kinds& kinds, Routine& block, const Routine& of) {
    auto& blocks = kinds[&of];
    if (!blocks.empty() && blocks.back() == &block) return;
    blocks.push_back(&block);
    if (of.base) add_kind(kinds, block, *of.base);
    for (const Routine* interface : of.interfaces) add_kind(kinds, block, *interface);
}

/// What its calls may find.
std::vector<Routine*> found_callees(const Kinds& kinds, const Routine& routine) {
    std::vector<Routine*> callees;
    for (const Routine* wanted : routine.finds) {
        const auto blocks = kinds.find(wanted->owner ? wanted->owner : wanted);
        if (blocks == kinds.end()) continue;
        for (const Routine* block : blocks->second)
            if (const Routine* found = find_routine(*block, *wanted))
                callees.push_back(const_cast<Routine*>(found));
    }
    return callees;
}

/// It is laid out behind what its block extends, which it need not call.
bool is_of_base(const Routine& routine, const Called& called) {
    const Routine& block = routine.owner ? *routine.owner : routine;
    const Routine& other = called.routine->owner ? *called.routine->owner : *called.routine;
    return !called.is_call && called.place.source == block.pou->name.place.source &&
           called.place.begin == block.pou->name.place.begin && is_a(block, other);
}

/// An instance that is declared stands for what is called of it; one that is only referred to does
/// not, nor does what a block extends.
std::vector<Routine*> all_callees(const Kinds& kinds, const Routine& routine) {
    std::vector<Routine*> callees = found_callees(kinds, routine);
    for (const Called& called : routine.calls)
        if (called.is_call || !(called.through_reference || is_of_base(routine, called)))
            callees.push_back(called.routine);
    return callees;
}

/// What instances find may lead back, too.
void note_all_rings(Checking& c) {
    Kinds kinds;
    for (Routine* routine : c.checked.order) {
        auto& finds = routine->finds;
        std::ranges::sort(finds);
        finds.erase(std::unique(finds.begin(), finds.end()), finds.end());
        if (routine->has_instances()) add_kind(kinds, *routine, *routine);
    }
    note_rings(
        c, [&](const Routine& routine) { return all_callees(kinds, routine); }, &Routine::ring);
    std::unordered_set<int> met;
    for (const Routine* routine : c.checked.order)
        for (const Routine* found : found_callees(kinds, *routine))
            if (routine->ring != 0 && found->ring == routine->ring) met.insert(routine->ring);
    for (Routine* routine : c.checked.order) routine->is_met = met.contains(routine->ring);
}

void tell_of_rounds(Checking& c, const std::vector<Round>& rounds) {
    for (const auto& [last, hops, recurs] : rounds) {
        const bool is_of_method = last->routine->owner && !last->is_call;
        const std::string text = fmt::format(
            "'{}' {}: {}", last->routine->name,
            is_of_method ? "would declare an instance that it is a part of" : "calls itself", hops);
        if (recurs)
            c.warn(code::calls_itself, last->place, text, "be sure that it ends soon");
        else
            c.fail(code::contains_itself, last->place, text,
                   last->is_call  ? "its instance has one body: write a method, which may do so"
                   : is_of_method ? "an instance has room for the variables of its methods: "
                                    "declare this one as VAR_IN_OUT or REFERENCE TO"
                                  : "what is in it has no end: use a reference");
    }
}

/// A call of a method or a body of an instance that is global.
bool is_of_global(const Expression& call) {
    if (call.kind != E::call || !call.routine || !call.routine->owner) return false;
    const Expression& callee = *call.operands[0];
    if (callee.kind != E::member) return false;
    const Variable* root = root_of(*callee.operands[0]).variable;
    return root && root->space == Space::global;
}

using Calls = std::unordered_set<const Expression*>;

/// A method of a global instance that another calls which it is made of: the frame of neither is
/// known before the other, so that the instance finds what is called. The calls that are so; empty
/// if nothing is wrong without.
Calls loosen_calls_of_globals(Checking& c, const Ordering& o) {
    Calls loosened;
    if (std::ranges::all_of(o.rounds, &Round::recurs)) return loosened;
    std::unordered_map<const Routine*, std::vector<const Expression*>> calls;
    for (const Expression& e : c.tree.expressions)
        if (is_of_global(e)) calls[e.routine].push_back(&e);
    for (Routine& routine : c.checked.routines)
        for (Called& called : routine.calls)
            for (const Expression* e : calls[called.routine])
                if (called.is_call && e->place.source == called.place.source &&
                    e->place.begin == called.place.begin) {
                    called.through_reference = true;
                    loosened.insert(e);
                }
    return loosened;
}

void find_by_instances(Checking& c, const Calls& loosened) {
    bool is_one = false;
    for (Routine& routine : c.checked.routines) {
        for (const Called& called : routine.calls)
            if (called.is_call && is_found(called)) routine.finds.push_back(called.routine);
        if (std::erase_if(routine.calls, is_found) > 0) routine.dispatches = is_one = true;
        for (Routine* r = routine.is_looped ? &routine : nullptr; r; r = r->overrides)
            r->is_dispatched = true;
    }
    if (!is_one) return;
    c.checked.dispatches = true;
    for (Expression& e : c.tree.expressions)
        if (e.kind == E::call && e.routine && e.routine->is_looped &&
            (is_through_reference(e) || loosened.contains(&e)))
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
    const Calls loosened = loosen_calls_of_globals(c, o);
    while (!loosened.empty() && !order(o)) continue;
    find_by_instances(c, loosened);
    const bool is_right = std::ranges::all_of(o.rounds, &Round::recurs);
    if (is_right && !o.rounds.empty()) note_plain_rings(o);
    if (c.checked.dispatches)
        note_all_rings(c);
    else
        for (Routine* routine : c.checked.order) routine->ring = routine->plain_ring;
    tell_of_rounds(c, o.rounds);
}

/// It is of a library of Automation Studio, whose bodies are compiled: a `.fun` alone declares it.
static bool is_declared_alone(const Pou& unit) {
    return unit.body.empty() && unit.methods.empty() && unit.place.source &&
           unit.place.source->has_no_bodies();
}

void warn_of_unused(Checking& c) {
    for (const Routine& routine : c.checked.routines)
        for (const Variable& variable : routine.variables)
            if (!variable.used && !routine.is_test() && !routine.pou->is_tests &&
                !is_declared_alone(*routine.pou) &&
                (variable.section == Section::local || variable.section == Section::temp))
                c.warn(code::variable_never_used, variable.name.place,
                       fmt::format("'{}' is declared and never used", variable.text), "remove it");
}

}  // namespace lineshaft::st
