#include "runtime/st/types/packed.hpp"

#include <cstring>

#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/values.hpp"

namespace lineshaft::st {

namespace {

/// A bit of an address, else as it stands in packed memory of the dialect.
PackedFormat format_of(const Variable& variable) {
    const Dialect& dialect = variable.name.place.dialect();
    if (variable.address.bits == 1) return {PackedFormat::Coding::bit, 1, false, 0};
    return packed_format(*variable.type, dialect).value();
}

PackedFormat format_of(const Location::Packed& packed) {
    if (packed.is_bit) return {PackedFormat::Coding::bit, 1, false, 0};
    return packed_format(*packed.type, *packed.dialect).value();
}

/// The instruction of which c is put together here.
void put(Writing& w, Op op, Slot value, const Location& at, std::uint32_t form) {
    const Location::Packed& packed = *at.packed;
    const Location base = as_address(w, at);
    const std::uint64_t first = packed.first + std::uint64_t{64} * base.offset;
    const Slot index = packed.index == none ? w.constant_slot(0) : packed.index;
    w.put(op, value, base.index, 0, index);
    w.code.instructions.back().c = first | std::uint64_t{form} << 32;
}

/// The same of what is reached through a reference.
void put_through(Writing& w, Op op, Slot value, const Location& at) {
    const Location::Packed& packed = *at.packed;
    const Slot index = packed.index == none ? w.constant_slot(0) : packed.index;
    const std::uint64_t shape = shape_number(w, *packed.type, packed.dialect->packs_as_s7);
    w.put(op, value, packed.through, 0, index);
    w.code.instructions.back().c = packed.first | shape << 32;
}

bool is_through(const Location& at) {
    return at.packed && at.packed->through != none;
}

/// The same place as a value of a part of it.
Location at_bit(Location of, std::uint64_t bit, const Type& type) {
    of.packed->first += static_cast<std::uint32_t>(bit);
    of.packed->type = &type;
    return of;
}

}  // namespace

/// A number that has the bytes as they are.
static PackedFormat raw_format(RawBytes part) {
    return {PackedFormat::Coding::whole, part.bytes, false, 0};
}

static const Dialect& dialect_of_union(const Type& type) {
    return type.members.front()->name.place.dialect();
}

Location as_packed(Writing& w, const Location& of, const Type& type) {
    Location made = as_address(w, of);
    made.packed = {0, none, &dialect_of_union(type), &type, false};
    return made;
}

Location locate_in_image(Writing& w, const Variable& variable) {
    const Slot address = w.emit(Op::set_global, none, static_cast<Slot>(w.checked.image.global));
    const ImageAddress& at = variable.address;
    Location made{Mode::address, 0, address, 0};
    made.packed = {static_cast<std::uint32_t>(w.checked.image.bit_of(at)), none,
                   &variable.name.place.dialect(), variable.type, at.bits == 1};
    return made;
}

Location locate_through(Slot reference, const Type& type, const Dialect& dialect) {
    Location made{.mode = Mode::address};
    made.packed = {0, none, &dialect, &type, false, reference};
    return made;
}

Slot reference_to_packed(Writing& w, const Location& at) {
    const Location::Packed& packed = *at.packed;
    if (packed.first == 0 && packed.index == none) return packed.through;
    Slot bytes = w.constant_slot(packed.first / 8);
    if (packed.index != none) {
        const Slot more = w.emit(Op::div_lint, none, packed.index, w.constant_slot(8));
        bytes = packed.first < 8 ? more : w.emit(Op::add_lint, none, more, bytes);
    }
    const Slot made = w.new_temporary(reference_slots);
    w.put(Op::move_reference, made, packed.through, bytes);
    return made;
}

Location unpacked(Writing& w, const Location& at, const Type& type) {
    const std::uint32_t slots = slots_of(w, type);
    const Location made{Mode::slot, w.new_temporary(slots)};
    // Nothing in the last slot of a UNION's bytes is left as it was.
    if (type.kind == Kind::union_) w.put(Op::move, made.slot + slots - 1, w.constant_slot(0));
    copy_packed(w, made, at, type);
    return made;
}

Location packed_member(Location of, const Variable& member) {
    const std::uint64_t bit = packed_offset(*of.packed->type, member, *of.packed->dialect);
    return at_bit(of, bit, *member.type);
}

Location packed_element(Writing& w, Location at, const Expression& e) {
    for (const Argument& argument : e.arguments) {
        const Type& array = *at.packed->type;
        const std::uint64_t stride = packed_stride(array, *at.packed->dialect);
        const Expression& number = *argument.value;
        at = at_bit(at, 0, *array.element);
        if (number.kind == Expression::Kind::constant) {
            at.packed->first +=
                static_cast<std::uint32_t>((number.constant.integer - array.lower) * stride);
            continue;
        }
        const IndexTable made{array.lower, array.count(), stride};
        const Slot given = looked_at(w, number), before = at.packed->index;
        at.packed->index = w.emit(Op::index, none, given, w.table(made));
        if (before != none)
            at.packed->index = w.emit(Op::offset_by, none, before, at.packed->index);
    }
    return at;
}

Slot load_packed(Writing& w, const Location& from, Slot wanted) {
    const Slot to = w.result(wanted);
    if (is_through(from)) {
        put_through(w, Op::load_through, to, from);
        return to;
    }
    put(w, Op::load_packed, to, from, format_of(*from.packed).number());
    const Type& type = *from.packed->type;
    if (type.kind == Kind::enumeration && !type.is_unchecked)
        w.put(Op::within, 0, to, w.table({0, type.values.size(), 1}));
    return type.in_a_run().is_subrange ? within(w, type, to) : to;
}

void store_packed(Writing& w, const Location& to, Slot from) {
    if (is_through(to)) return put_through(w, Op::store_through, from, to);
    put(w, Op::store_packed, from, to, format_of(*to.packed).number());
}

Slot load_packed_text(Writing& w, const Location& from) {
    const Type& type = *from.packed->type;
    const Slot text = w.emit(Op::set_address, none, w.new_temporary(slots_of(w, type)));
    if (is_through(from)) {
        put_through(w, Op::load_text_through, text, from);
        return text;
    }
    put(w, Op::load_packed_text, text, from, packed_text(type, *from.packed->dialect).number());
    return text;
}

void store_packed_text(Writing& w, const Location& to, Slot text) {
    if (is_through(to)) return put_through(w, Op::store_text_through, text, to);
    put(w, Op::store_packed_text, text, to,
        packed_text(*to.packed->type, *to.packed->dialect).number());
}

std::vector<RawBytes> raw_parts(const Type& of_union) {
    std::vector<RawBytes> parts;
    std::uint64_t first = 0, end = packed_bits(of_union, dialect_of_union(of_union)) / 8;
    while (first < end) {
        const std::uint64_t bytes = std::bit_floor(std::min<std::uint64_t>(end - first, 8));
        parts.push_back({first, static_cast<std::uint8_t>(bytes)});
        first += bytes;
    }
    return parts;
}

Slot load_raw(Writing& w, const Location& from, RawBytes part) {
    const Slot slot = w.new_temporary();
    put(w, Op::load_packed, slot, at_bit(from, 8 * part.first, *from.packed->type),
        raw_format(part).number());
    return slot;
}

/// A UNION is packed on either side.
static void copy_bytes(Writing& w, Location to, Location from, const Type& type) {
    if (!to.packed) to = as_packed(w, to, type);
    if (!from.packed) from = as_packed(w, from, type);
    for (const RawBytes& part : raw_parts(type))
        put(w, Op::store_packed, load_raw(w, from, part), at_bit(to, 8 * part.first, type),
            raw_format(part).number());
}

void copy_packed(Writing& w, const Location& to, const Location& from, const Type& type) {
    if (type.is_scalar()) return store(w, to, load(w, from));
    if (is_through(from) && type.kind != Kind::text) {
        if (is_through(to) || (to.packed && to.packed->type->kind != Kind::union_))
            return copy_packed(w, to, unpacked(w, from, type), type);
        return put_through(w, Op::copy_from_through, address_of(w, to), from);
    }
    if (is_through(to) && type.kind != Kind::text) {
        const Location slots = from.packed ? unpacked(w, from, type) : from;
        return put_through(w, Op::copy_to_through, address_of(w, slots), to);
    }
    if (type.kind == Kind::union_) return copy_bytes(w, to, from, type);
    if (type.kind == Kind::text) {
        const Slot text = from.packed ? load_packed_text(w, from) : address_of(w, from);
        if (to.packed) return store_packed_text(w, to, text);
        return w.put(Op::text_copy, address_of(w, to), text, capacity_of(w, to, type));
    }
    // What an index leads to is read more than once.
    if (from.mode == Mode::indexed) return copy_packed(w, to, as_address(w, from), type);
    if (to.mode == Mode::indexed) return copy_packed(w, as_address(w, to), from, type);
    const auto element = [&](const Location& of, const Type& array, std::int64_t i) {
        const auto place = static_cast<std::uint64_t>(i - array.lower);
        if (of.packed)
            return at_bit(of, place * packed_stride(array, *of.packed->dialect), *array.element);
        return behind(of, static_cast<std::uint32_t>(place) * slots_of(w, *array.element));
    };
    const auto member = [&](const Location& of, const Variable& variable) {
        return of.packed ? packed_member(of, variable) : part(w, of, variable);
    };
    if (type.kind == Kind::structure)
        for (const Variable* part : type.members)
            copy_packed(w, member(to, *part), member(from, *part), *part->type);
    for (std::int64_t i = type.lower; type.kind == Kind::array && i <= type.upper; ++i)
        copy_packed(w, element(to, type, i), element(from, type, i), *type.element);
}

void fill_packed(std::byte* bytes, std::uint64_t bit, const Type& type, const Dialect& dialect,
                 const std::uint64_t* slots) {
    const auto* const whole = reinterpret_cast<const std::byte*>(slots);
    if (type.is_scalar())
        return st::store_packed(bytes, bit, packed_format(type, dialect).value(), *slots);
    if (type.kind == Kind::text)
        return st::store_packed_text(bytes, bit, packed_text(type, dialect), whole);
    if (type.kind == Kind::union_)
        std::memcpy(bytes + bit / 8, whole, packed_bits(type, dialect) / 8);
    if (type.kind == Kind::structure)
        for (const Variable* member : type.members)
            fill_packed(bytes, bit + packed_offset(type, *member, dialect), *member->type, dialect,
                        slots + member->slot);
    if (type.kind != Kind::array) return;
    for (std::int64_t i = type.lower; i <= type.upper; ++i) {
        fill_packed(bytes, bit, *type.element, dialect, slots);
        bit += packed_stride(type, dialect);
        slots += type.element->slots;
    }
}

void fill_process_image(Writing& w, Writing::Image& image) {
    auto* const bytes = reinterpret_cast<std::byte*>(image.data());
    for (const Variable* variable : w.checked.image.variables) {
        if (!variable->initial && !variable->type->initial_value) continue;
        const Type& type = *variable->type;
        Writing::Image slots(slots_of(w, type), 0);
        fill_default(w, slots, 0, type);
        if (variable->initial) fill(w, slots, 0, type, *variable->initial);
        const std::uint64_t bit = w.checked.image.bit_of(variable->address);
        if (type.is_scalar())
            st::store_packed(bytes, bit, format_of(*variable), slots[0]);
        else
            fill_packed(bytes, bit, type, variable->name.place.dialect(), slots.data());
    }
}

}  // namespace lineshaft::st
