#include <algorithm>

#include "runtime/st/generate/layout.hpp"

namespace lineshaft::st {

namespace {

const Routine& origin(const Routine& called) {
    const Routine* first = &called;
    while (first->overrides) first = first->overrides;
    return *first;
}

void prepare_recursion(Writing& w) {
    const auto& order = w.checked.order;
    const auto in_ring = [](const Routine* routine) { return routine->plain_ring != 0; };
    if (std::ranges::none_of(order, in_ring)) return;
    for (Routine* routine : order) {
        routine->may_recur = routine->plain_ring != 0 || routine->dispatches;
        for (const Called& called : routine->calls) routine->may_recur |= called.routine->may_recur;
    }
}

}  // namespace

void prepare_dispatch(Writing& w) {
    w.code.has_kinds = w.checked.dispatches;
    prepare_recursion(w);
    for (Routine* routine : w.checked.order) {
        routine->may_dispatch = routine->dispatches;
        for (const Called& called : routine->calls)
            routine->may_dispatch |= called.routine->may_dispatch;
        routine->levels = routine->depth + (routine->may_dispatch ? found_levels : 0) +
                          (routine->may_recur ? recurring_levels : 0);
        Routine* block = routine->owner ? routine->owner : routine;
        block->levels = std::max(block->levels, routine->levels);
    }
    for (Routine& routine : w.checked.routines)
        for (Routine* base = routine.base; base; base = base->base)
            base->levels = std::max(base->levels, routine.levels);
    for (Routine* routine : w.checked.order)
        if (routine->base) routine->levels = routine->base->levels;  // bases come first
}

std::uint32_t slot_in_signature(Writing& w, const Routine& method, const Variable& parameter) {
    std::uint32_t at = 0;
    for (const bool given : {true, false})
        for (const Variable& variable : method.variables) {
            if (!is_in_signature(method, variable, given)) continue;
            if (&variable == &parameter) return at;
            at += slots_in_frame(w, variable);
        }
    return at;
}

const Writing::Image& signature_image(Writing& w, const Routine& method) {
    Writing::Image& image = w.function_images[&method];
    if (!image.empty()) return image;
    std::uint32_t slots = 0;
    for (const Variable& variable : method.variables) slots += slots_in_frame(w, variable);
    image.resize(slots + 1, 0);
    for (const Variable& variable : method.variables)
        if (variable.section == Section::input)
            fill(w, image, slot_in_signature(w, method, variable), variable);
    return image;
}

std::uint32_t method_number(Writing& w, const Routine& called) {
    const auto next = static_cast<std::uint32_t>(w.method_numbers.size());
    return w.method_numbers.emplace(&origin(called), next).first->second;
}

bool may_meet_itself(const Writing& w, const Expression& call) {
    const int ring = w.routine->ring;
    if (ring == 0 || !call.is_dispatched) return ring != 0 && call.routine->ring == ring;
    return std::ranges::any_of(w.checked.order, [&](const Routine* block) {
        const Routine* found =
            block->has_instances() ? find_routine(*block, *call.routine) : nullptr;
        return found && found->ring == ring;
    });
}

/// As much as calls of those rings may take that have no plain one within.
std::uint32_t slots_of_pile(const Writing& w, const Routine& runs) {
    if (runs.may_recur) return pile_slots;
    std::uint32_t most = 0;
    for (const Routine* routine : w.checked.order) {
        if (!routine->is_met) continue;
        const CodeRoutine& code = w.code.routines[w.routine_number(*routine)];
        most = std::max(most, routine->is_function() ? code.frame : code.kept());
    }
    const Routine& block = runs.owner ? *runs.owner : runs;
    return std::min(block.levels * (most + record_end), pile_slots);
}

void finish_recursion(Writing& w) {
    for (const Routine* routine : w.checked.order) {
        const Routine& block = routine->owner ? *routine->owner : *routine;
        if (!routine->runs_rings || block.is_function()) continue;
        const std::uint32_t end = block.frame + slots_of_pile(w, *routine);
        Writing::Image& image = w.images[block.type];
        image.resize(std::max<std::size_t>(image.size(), end), 0);
        w.code.routines[w.routine_number(*routine)].pile = {block.frame, end};
    }
}

void finish_dispatch(Writing& w) {
    if (!w.code.has_kinds) return;
    w.code.methods = static_cast<std::uint32_t>(w.method_numbers.size());
    w.code.found.resize((w.kinds.size() + 1) * w.code.methods);  // of no kind too
    for (const auto& [block, kind] : w.kinds)
        for (const auto& [wanted, number] : w.method_numbers)
            if (const Routine* found = find_routine(*block, *wanted))
                w.code.found[kind * w.code.methods + number] = {
                    w.routine_number(*found), found->depth, found->owner ? found->first : 1};
}

}  // namespace lineshaft::st
