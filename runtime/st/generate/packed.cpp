#include "runtime/st/generate/packed.hpp"

#include "runtime/st/generate/images.hpp"
#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/values.hpp"
#include "runtime/st/types/packed.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;
using Mode = Location::Mode;

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
void put(Writing& w, Op op, Slot value, const Location& at) {
    const Location::Packed& packed = *at.packed;
    const Location base = as_address(w, at);
    const std::uint64_t first = packed.first + std::uint64_t{64} * base.offset;
    const Slot index = packed.index == none ? w.constant_slot(0) : packed.index;
    w.put(op, value, base.index, 0, index);
    w.code.instructions.back().c = first | std::uint64_t{format_of(packed).number()} << 32;
}

/// The same place as a value of a part of it.
Location at_bit(Location of, std::uint64_t bit, const Type& type) {
    of.packed->first += static_cast<std::uint32_t>(bit);
    of.packed->type = &type;
    return of;
}

void fill_packed(std::byte* bytes, std::uint64_t bit, const Type& type, const Dialect& dialect,
                 const std::uint64_t* slots) {
    if (type.is_scalar())
        return st::store_packed(bytes, bit, packed_format(type, dialect).value(), *slots);
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

}  // namespace

Location locate_in_image(Writing& w, const Variable& variable) {
    const Slot address = w.emit(Op::set_global, none, static_cast<Slot>(w.checked.image.global));
    const ImageAddress& at = variable.address;
    Location made{Mode::address, 0, address, 0};
    made.packed = {8 * (w.checked.image.begin(at.area) + at.byte) + at.bit, none,
                   &variable.name.place.dialect(), variable.type, at.bits == 1};
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
        const IndexTable made{array.lower,
                              static_cast<std::uint64_t>(array.upper - array.lower) + 1, stride};
        const Slot given = value(w, number), before = at.packed->index;
        at.packed->index = w.emit(Op::index, none, given, w.table(made));
        if (before != none)
            at.packed->index = w.emit(Op::offset_by, none, before, at.packed->index);
    }
    return at;
}

Slot load_packed(Writing& w, const Location& from, Slot wanted) {
    const Slot to = w.result(wanted);
    put(w, Op::load_packed, to, from);
    const Type& type = *from.packed->type;
    if (type.kind == Kind::enumeration)
        w.put(Op::within, 0, to, w.table({0, type.values.size(), 1}));
    return type.is_subrange ? within(w, type, to) : to;
}

void store_packed(Writing& w, const Location& to, Slot from) {
    put(w, Op::store_packed, from, to);
}

void copy_packed(Writing& w, const Location& to, const Location& from, const Type& type) {
    if (type.is_scalar()) return store(w, to, load(w, from));
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

void fill_process_image(Writing& w, Writing::Image& image) {
    auto* const bytes = reinterpret_cast<std::byte*>(image.data());
    for (const Variable* variable : w.checked.image.variables) {
        if (!variable->initial && !variable->type->initial_value) continue;
        const Type& type = *variable->type;
        Writing::Image slots(slots_of(w, type), 0);
        fill_default(w, slots, 0, type);
        if (variable->initial) fill(w, slots, 0, type, *variable->initial);
        const ImageAddress& at = variable->address;
        const std::uint64_t bit =
            std::uint64_t{8} * (w.checked.image.begin(at.area) + at.byte) + at.bit;
        if (type.is_scalar())
            st::store_packed(bytes, bit, format_of(*variable), slots[0]);
        else
            fill_packed(bytes, bit, type, variable->name.place.dialect(), slots.data());
    }
}

}  // namespace lineshaft::st
