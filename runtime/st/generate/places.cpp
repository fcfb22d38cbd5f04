#include "runtime/st/generate/places.hpp"

#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/values.hpp"

namespace lineshaft::st {

namespace {

/// What a reference refers to.
Location locate_object(Writing& w, const Expression& e) {
    const Slot address = w.emit(Op::address_of_number, none, value(w, *e.operands[0]));
    w.put(Op::bound, 0, address);
    return {Mode::address, 0, address, 0};
}

/// An array, a structure, a text.
void copy_value(Writing& w, const Location& to, const Type& type, const Expression& from) {
    if (type.kind == Kind::text) {
        const Slot text = text_address(w, from);
        if (to.packed) return store_packed_text(w, to, text);
        return w.put(Op::text_copy, address_of(w, to), text, capacity_of(w, to, type));
    }
    if (type.is_reference()) return copy(w, to, {Mode::slot, reference(w, from)}, reference_slots);
    if (from.kind == E::call) {
        const Location made = from.routine ? Location{Mode::slot, call(w, from, none)}
                                           : Location{Mode::address, 0, standard(w, from, none)};
        return copy_value(w, to, made, type);
    }
    copy_value(w, to, locate(w, from), type);
}

/// Where the size of elements is not known yet it is no other's.
std::uint32_t table_of(Writing& w, const IndexTable& made, bool is_late, const Type* array) {
    if (!is_late) return w.table(made);
    const auto number = static_cast<std::uint32_t>(w.code.tables.size());
    w.code.tables.push_back(made);
    w.late.push_back({.type = array->element, .is_stride = true, .at = number});
    return number;
}

}  // namespace

void store_bits(Writing& w, const Expression& target, Slot bits) {
    const Location whole = locate(w, *target.operands[0]);
    w.land();
    const Type& type = *target.operands[0]->type;
    const Slot slot = load(w, whole);
    w.put(Op::set_bits, slot, bits, packed(target.bits));
    if (type.is_signed && type.bits < 64) w.put(of_type(Op::wrap_sint, type), slot, slot);
    if (whole.mode != Mode::slot) store(w, whole, slot);
}

Location locate(Writing& w, const Expression& e) {
    if (e.variable && e.variable->space == Space::image) return locate_in_image(w, *e.variable);
    if (e.kind == E::member) {
        Location of = locate(w, *e.operands[0]);
        const Type& whole = *e.operands[0]->type;
        if (whole.kind == Kind::union_ && !of.packed) of = as_packed(w, of, whole);
        return of.packed ? packed_member(of, *e.variable) : part(w, of, *e.variable);
    }
    if (is_element_of_target(e)) return locate_element_of_target(w, e);
    if (e.kind == E::index) {
        const Location of = locate(w, *e.operands[0]);
        return of.packed ? packed_element(w, of, e) : element(w, of, e);
    }
    if (e.kind == E::deref) return locate_target(w, e);
    if (e.kind == E::call) return {Mode::slot, call(w, e, none)};
    if (e.kind == E::converted) return locate_object(w, e);
    if (e.kind == E::self) return {Mode::slot, 0};
    const Variable& variable = *e.variable;
    if (variable.space == Space::reference) {
        const bool of_block = w.routine->owner && variable.of != w.routine->pou;
        if (of_block) w.put(Op::bound, 0, variable.slot);
        return {.mode = Mode::address, .index = variable.slot, .capacity = variable.slot + 1};
    }
    if (variable.space == Space::global) {
        const Slot address = w.new_temporary();
        w.put(Op::set_global, address, static_cast<Slot>(variable.global));
        return part(w, {Mode::address, 0, address, 0}, variable);
    }
    return {Mode::slot, variable.slot};
}

Location part(Writing& w, Location of, const Variable& member) {
    if (member.slot == unplaced) return behind(w, of, {.member = &member});
    if (member.is_byte) {
        if (of.mode == Mode::indexed) of = as_address(w, of);
        of.byte = member.byte;
        return of;
    }
    if (member.space == Space::reference) {
        const Slot address = load(w, behind(of, member.slot));
        w.put(Op::bound, 0, address);
        Location made{.mode = Mode::address, .index = address};
        if (member.type->is_open) made.capacity = load(w, behind(of, member.slot + 1));
        return made;
    }
    return behind(of, member.slot);
}

Location element(Writing& w, Location at, const Expression& e) {
    const Type* type = e.operands[0]->type;
    Slot index = none;
    for (const Argument& argument : e.arguments) {
        const bool is_late = is_growing(w, *type->element);
        const std::uint32_t stride = is_late ? 1 : slots_of(w, *type->element);
        const Expression& number = *argument.value;
        if (number.kind == E::constant) {
            const auto place = static_cast<std::uint32_t>(number.constant.integer - type->lower);
            at = is_late ? behind(w, at, {.type = type->element, .times = place})
                         : behind(at, place * stride);
        } else {
            const IndexTable made{type->lower, type->count(), stride};
            const Slot given = looked_at(w, number);
            if (index == none)
                index = w.emit(Op::index, none, given, table_of(w, made, is_late, type));
            else
                w.put(Op::index_more, index, given, table_of(w, made, is_late, type));
        }
        type = type->element;
    }
    if (index == none) return at;
    if (at.mode == Mode::slot) return {Mode::indexed, at.slot, index};
    if (at.mode == Mode::indexed) {
        const Slot sum = w.emit(Op::offset_by, none, at.index, index);
        return {Mode::indexed, at.slot, sum};
    }
    return {Mode::address, 0, w.emit(Op::offset_by, none, at.index, index), at.offset};
}

Location behind(Location of, std::uint32_t slots) {
    (of.mode == Mode::address ? of.offset : of.slot) += slots;
    return of;
}

Location behind(Writing& w, const Location& of, Writing::Late distance) {
    const Slot from = address_of(w, of);
    w.land();
    const Slot to = w.emit(Op::offset, none, from, 0);
    distance.at = w.next() - 1;
    w.late.push_back(distance);
    w.land();
    return {Mode::address, 0, to, 0};
}

Location as_address(Writing& w, Location location) {
    if (location.packed && location.packed->through != none) {
        const Type& type = *location.packed->type;
        const Slot reference = reference_to_packed(w, location);
        return {Mode::address, 0, w.emit(Op::reach, none, reference, shape_number(w, type))};
    }
    if (location.mode == Mode::address) return location;
    Slot address = w.emit(Op::set_address, none, location.slot);
    if (location.mode == Mode::indexed)
        address = w.emit(Op::offset_by, none, address, location.index);
    Location made{Mode::address, 0, address, 0};
    made.byte = location.byte;
    return made;
}

Slot address_of(Writing& w, Location location) {
    const Location at = as_address(w, location);
    return at.offset == 0 ? at.index : w.emit(Op::offset, none, at.index, at.offset);
}

Slot capacity_of(Writing& w, const Location& text, const Type& type) {
    return type.is_open ? text.capacity : w.constant_slot(type.room().number());
}

Slot load(Writing& w, const Location& from, Slot wanted) {
    if (from.packed) return load_packed(w, from, wanted);
    if (from.byte && from.mode == Mode::slot)
        return w.emit(Op::get_byte, wanted, from.slot, *from.byte);
    if (from.byte) return w.emit(Op::load_byte, wanted, from.index, from.offset * 8 + *from.byte);
    if (from.mode == Mode::slot) return from.slot;
    if (from.mode == Mode::indexed) return w.emit(Op::load_at, wanted, from.slot, from.index);
    return w.emit(Op::load, wanted, from.index, from.offset);
}

void store(Writing& w, const Location& to, Slot from) {
    if (to.packed) return store_packed(w, to, from);
    if (to.byte && to.mode == Mode::slot) return w.put(Op::set_byte, from, to.slot, *to.byte);
    if (to.byte) return w.put(Op::store_byte, from, to.index, to.offset * 8 + *to.byte);
    if (to.mode == Mode::indexed) return w.put(Op::store_at, from, to.slot, to.index);
    if (to.mode == Mode::address) return w.put(Op::store, from, to.index, to.offset);
    if (to.slot != from) w.put(Op::move, to.slot, from);
}

void copy(Writing& w, const Location& to, const Location& from, std::uint32_t slots) {
    const bool direct_to = to.mode == Mode::slot, direct_from = from.mode == Mode::slot;
    if (direct_to && direct_from) return w.put(Op::copy, to.slot, from.slot, slots);
    if (direct_to) return w.put(Op::copy_from, to.slot, address_of(w, from), slots);
    if (direct_from) return w.put(Op::copy_to, address_of(w, to), from.slot, slots);
    w.put(Op::copy_between, address_of(w, to), address_of(w, from), slots);
}

void copy_value(Writing& w, const Location& to, const Location& from, const Type& type) {
    if (to.packed || from.packed) return copy_packed(w, to, from, type);
    copy(w, to, from, slots_of(w, type));
}

void assign(Writing& w, const Location& to, const Type& type, const Expression& from) {
    if (!type.is_scalar()) return copy_value(w, to, type, from);
    if (to.mode == Mode::slot && !to.byte && !to.packed) return value_to(w, from, to.slot);
    store(w, to, value(w, from));
}

Location locate_variable(Writing& w, const Variable& variable) {
    Expression name;
    name.kind = Expression::Kind::name;
    name.variable = const_cast<Variable*>(&variable);
    name.type = variable.type;
    return locate(w, name);
}

}  // namespace lineshaft::st
