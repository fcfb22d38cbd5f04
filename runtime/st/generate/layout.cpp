#include "runtime/st/generate/layout.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/st/generate/places.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

namespace {

constexpr std::uint64_t most_slots = 1U << 26;

/// Nothing is put into images from then on: not all of it has a place.
void check_size(Writing& w, std::uint64_t slots, Place place, std::string_view what) {
    if (slots <= most_slots) return;
    w.is_too_large = true;
    if (!place.source) place = w.place;
    w.out.add(code::too_deep_or_large, place.mark(), fmt::format("{} more than 512 MB", what),
              "make arrays smaller");
}

/// A variable, or what stands before it as well.
std::string takes(std::string_view name, bool alone) {
    return fmt::format("'{}' {}", name, alone ? "takes" : "and what stands before it take");
}

/// Its address, what a text of any length holds, and a reference where something refers to it.
std::uint32_t slots_of_in_out(const Writing& w, const Variable& variable) {
    return 1 + (variable.type->is_open ? 1 : 0) +
           (w.checked.refers_to_in_outs ? reference_slots : 0);
}

void note_activation(const Writing& w, Routine& routine, std::uint32_t& at) {
    if (w.checked.has_references && routine.lends) routine.activation = at++;
}

/// Where they are too large together no memory is taken for them.
void place_variables(Writing& w, Routine& routine, std::uint32_t& at, auto condition) {
    const std::uint32_t begin = at;
    for (Variable& variable : routine.variables) {
        const bool elsewhere = variable.space == Space::constant ||
                               variable.space == Space::global || variable.space == Space::image ||
                               variable.space == Space::overlay;
        if (elsewhere || !condition(variable)) continue;
        w.place = variable.name.place;
        variable.slot = at;
        const std::uint64_t slots = slots_in_frame(w, variable);
        check_size(w, at + slots, variable.name.place, takes(variable.text, slots > most_slots));
        if (at + slots > most_slots) {
            at = begin;
            return;
        }
        at += static_cast<std::uint32_t>(slots);
    }
}

/// A block that extends another has that whole in front.
std::uint32_t begin_block(Writing& w, Routine& block, Writing::Image& image) {
    if (!block.base) return w.code.calls_slot() + 2 * block.levels;
    image = w.images[block.base->type];
    return block.base->frame;
}

bool has_block(const Type& type) {
    if (type.kind == Kind::array) return has_block(*type.element);
    return type.kind == Kind::block || (type.kind == Kind::structure &&
                                        std::ranges::any_of(type.members, [](const Variable* m) {
                                            return has_block(*m->type);
                                        }));
}

bool waits_for_blocks(const Type& type) {
    return type.kind == Kind::structure && type.slots == 0 && has_block(type);
}

void fill_all(Writing& w, Writing::Image& image, const Routine& routine) {
    if (w.is_too_large) return;
    for (const Variable& variable : routine.variables) fill(w, image, variable.slot, variable);
}

/// A slot that says that the routine runs.
void place_mark(Routine& routine, std::uint32_t& at) {
    if (routine.is_met && !routine.is_function()) routine.mark = at++;
}

}  // namespace

std::uint32_t slots_in_frame(Writing& w, const Variable& variable) {
    if (variable.space == Space::constant || variable.space == Space::global) return 0;
    const bool is_reference = variable.space == Space::reference;
    if (is_reference && variable.type->kind == Kind::block) return slots_of_in_out(w, variable);
    const std::uint32_t own = slots_of(w, *variable.type);  // also lays out what is referred to
    return is_reference ? slots_of_in_out(w, variable) : own;
}

bool is_in_signature(const Routine& method, const Variable& variable, bool is_given) {
    const Section section = variable.section;
    return is_given ? section == Section::input || section == Section::in_out
                    : section == Section::result || section == Section::output ||
                          &variable == method.eno;
}

void forget_places(Writing& w) {
    for (Routine& routine : w.checked.routines)
        for (Variable& variable : routine.variables)
            if (variable.space == Space::frame || variable.space == Space::reference)
                variable.slot = unplaced;
    for (const Type& type : w.checked.types)
        if (waits_for_blocks(type))
            for (Variable* member : type.members) member->slot = unplaced;
    for (const Routine* routine : w.checked.order)
        ++w.unwritten_parts[routine->owner ? routine->owner : routine];
}

bool is_growing(const Writing& w, const Type& type) {
    if (type.kind == Kind::array) return is_growing(w, *type.element);
    if (type.kind == Kind::structure)
        return std::ranges::any_of(type.members,
                                   [&](const Variable* m) { return is_growing(w, *m->type); });
    if (type.kind != Kind::block) return false;
    const auto it = w.unwritten_parts.find(type.routine);
    return it != w.unwritten_parts.end() && it->second > 0;
}

void lay_out_members(Writing& w, const Type& list, bool with_blocks) {
    std::uint64_t slots = with_blocks ? list.slots : 0;
    for (Variable* member : list.members) {
        if (has_block(*member->type) != with_blocks) continue;
        member->slot = static_cast<std::uint32_t>(std::min(slots, most_slots));
        const std::uint64_t own = slots_of(w, *member->type);
        slots += own;
        check_size(w, slots, member->name.place, takes(member->text, own > most_slots));
    }
    const_cast<Type&>(list).slots = static_cast<std::uint32_t>(std::min(slots, most_slots));
}

void finish_late(Writing& w) {
    for (const Type& type : w.checked.types)
        if (waits_for_blocks(type)) slots_of(w, type);
    for (const Writing::Late& late : w.late) {
        const std::uint64_t one = late.member ? late.member->slot : slots_of(w, *late.type);
        if (late.is_stride)
            w.code.tables[late.at].stride = static_cast<std::uint32_t>(one);
        else
            w.code.instructions[late.at].c = late.times * one;
    }
}

std::uint32_t slots_of(Writing& w, const Type& type) {
    if (type.kind == Kind::block) return type.routine->frame;
    if (type.slots != 0) return type.slots;
    std::uint64_t slots = 0;
    if (type.kind == Kind::text) slots = type.text_slots();
    if (type.kind == Kind::array) slots = type.count() * slots_of(w, *type.element);
    if (type.kind == Kind::structure)
        for (Variable* member : type.members) {
            member->slot = static_cast<std::uint32_t>(slots);
            slots += slots_of(w, *member->type);
        }
    if (type.kind == Kind::union_) {
        for (const Variable* member : type.members) slots_of(w, *member->type);
        slots = (bytes_of(type) + 7) / 8;
    }
    if (slots > most_slots) check_size(w, slots, w.place, describe(type) + " takes");
    const_cast<Type&>(type).slots = static_cast<std::uint32_t>(std::min(slots, most_slots));
    return type.slots;
}

void lay_out(Writing& w, Routine& block) {
    if (block.variables_end != 0) return;
    Writing::Image begun;
    std::uint32_t at = begin_block(w, block, begun);
    place_mark(block, at);
    place_variables(w, block, at, [](const Variable& v) { return v.section != Section::temp; });
    block.temps_begin = at;
    place_variables(w, block, at, [](const Variable& v) { return v.section == Section::temp; });
    note_activation(w, block, at);
    block.variables_end = block.frame = at;
    Writing::Image& image = w.images[block.type];
    image = std::move(begun);
    image.resize(at, 0);
    if (w.code.has_kinds)
        image[w.code.kind_slot()] = w.kinds.emplace(&block, w.kinds.size() + 1).first->second;
    fill_all(w, image, block);
    if (!w.is_too_large) fill_assigned(w, image, block.initials);
}

void lay_out_call(Writing& w, Routine& routine) {
    if (w.laid_out.contains(&routine)) return;
    Routine* block = routine.owner;
    if (block) lay_out(w, *block);
    std::uint32_t at = block ? block->frame : 0;
    const auto is_given = [&](const Variable& v) { return is_in_signature(routine, v, true); };
    const auto is_kept = [](const Variable& v) { return v.section == Section::kept; };
    const auto is_taken = [&](const Variable& v) {
        return routine.is_dispatched && is_in_signature(routine, v, false);
    };
    place_variables(w, routine, at, is_kept);
    place_mark(routine, at);
    routine.first = at;
    place_variables(w, routine, at, is_given);
    routine.temps_begin = at;
    place_variables(w, routine, at, is_taken);
    place_variables(w, routine, at,
                    [&](const Variable& v) { return !is_given(v) && !is_kept(v) && !is_taken(v); });
    note_activation(w, routine, at);
    routine.variables_end = at;
    Writing::Image& image = block ? w.images[block->type] : w.function_images[&routine];
    image.resize(at, 0);
    fill_all(w, image, routine);
}

void lay_out_ring(Writing& w, int ring) {
    for (Routine* routine : w.checked.order) {
        if (routine->plain_ring != ring || w.laid_out.contains(routine)) continue;
        lay_out_call(w, *routine);
        w.laid_out.insert(routine);
        if (routine->owner) routine->owner->frame = routine->variables_end;
    }
}

}  // namespace lineshaft::st
