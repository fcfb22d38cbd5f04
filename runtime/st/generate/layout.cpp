#include "runtime/st/generate/layout.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/st/generate/images.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;

constexpr std::uint64_t most_slots = 1U << 26;

void check_size(Writing& w, std::uint64_t slots, Place place, std::string_view name) {
    if (slots <= most_slots) return;
    if (!place.source) return;
    w.out.add(code::too_deep_or_large, place.mark(),
              fmt::format("'{}' takes more than 512 MB", name), "make its arrays smaller");
}

void place_variables(Writing& w, Routine& routine, std::uint32_t& at, auto condition) {
    for (Variable& variable : routine.variables) {
        const bool elsewhere = variable.space == Space::constant ||
                               variable.space == Space::global || variable.space == Space::image;
        if (elsewhere || !condition(variable)) continue;
        w.place = variable.name.place;
        variable.slot = at;
        const std::uint64_t own = slots_of(w, *variable.type);  // also lays out what is referred to
        const std::uint64_t slots = variable.space != Space::reference ? own
                                    : variable.type->is_open           ? 2
                                                                       : 1;
        check_size(w, at + slots, variable.name.place, variable.text);
        if (at + slots > most_slots) return;
        at += static_cast<std::uint32_t>(slots);
    }
}

}  // namespace

std::uint32_t slots_of(Writing& w, const Type& type) {
    if (type.kind == Kind::block) return type.routine->frame;
    if (type.slots != 0) return type.slots;
    std::uint64_t slots = 0;
    if (type.kind == Kind::text) slots = 1 + (type.length + 7U) / 8;
    if (type.kind == Kind::array)
        slots =
            static_cast<std::uint64_t>(type.upper - type.lower + 1) * slots_of(w, *type.element);
    if (type.kind == Kind::structure)
        for (Variable* member : type.members) {
            member->slot = static_cast<std::uint32_t>(slots);
            slots += slots_of(w, *member->type);
        }
    if (slots > most_slots) check_size(w, slots, w.place, type.name);
    const_cast<Type&>(type).slots = static_cast<std::uint32_t>(std::min(slots, most_slots));
    return type.slots;
}

void lay_out(Writing& w, Routine& block) {
    if (block.variables_end != 0) return;
    std::uint32_t at = globals_slot + w.code.globals + 2 * block.depth;
    place_variables(w, block, at, [](const Variable& v) { return v.section != Section::temp; });
    block.temps_begin = at;
    place_variables(w, block, at, [](const Variable& v) { return v.section == Section::temp; });
    block.variables_end = block.frame = at;
    Writing::Image& image = w.images[block.type];
    image.assign(at, 0);
    for (const Variable& variable : block.variables) fill(w, image, variable.slot, variable);
}

void lay_out_call(Writing& w, Routine& routine) {
    Routine* block = routine.owner;
    if (block) lay_out(w, *block);
    std::uint32_t at = block ? block->frame : 0;
    const auto is_given = [](const Variable& v) {
        return v.section == Section::input || v.section == Section::in_out;
    };
    place_variables(w, routine, at, is_given);
    routine.temps_begin = at;
    place_variables(w, routine, at, [&](const Variable& v) { return !is_given(v); });
    routine.variables_end = at;
    Writing::Image& image = block ? w.images[block->type] : w.function_images[&routine];
    image.resize(at, 0);
    for (const Variable& variable : routine.variables) fill(w, image, variable.slot, variable);
}

}  // namespace lineshaft::st
