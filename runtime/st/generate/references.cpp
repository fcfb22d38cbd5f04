#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/values.hpp"
#include "runtime/st/types/packed.hpp"

namespace lineshaft::st {

namespace {

Slot null_reference(Writing& w) {
    const auto first = static_cast<Slot>(w.constants.size());
    w.constants.insert(w.constants.end(), reference_slots, 0);
    return Region::constant + first;
}

Slot copied(Writing& w, const Location& from) {
    const Slot made = w.new_temporary(reference_slots);
    copy(w, {Mode::slot, made}, from, reference_slots);
    return made;
}

/// Where a part of the root is, if that began at `begin`.
Location path(Writing& w, const Expression& e, const Expression& root, const Location& begin) {
    if (&e == &root) return begin;
    const Location of = path(w, *e.operands[0], root, begin);
    return e.kind == E::member ? part(w, of, *e.variable) : element(w, of, e);
}

/// Seen by bytes, through references that reckon in them.
bool has_bytes(const Type& type) {
    return packed_bits(type, iec) > 0;
}

/// `of` at that part of it.
Location packed_path(Writing& w, const Expression& e, const Expression& root, const Location& of) {
    if (&e == &root) return of;
    const Location at = packed_path(w, *e.operands[0], root, of);
    return e.kind == E::member ? packed_member(at, *e.variable) : packed_element(w, at, e);
}

/// How many slots a part of the root is behind it.
Slot slots_to_part(Writing& w, const Expression& part, const Expression& root) {
    const Routine* own = w.routine->owner ? w.routine->owner : w.routine;
    if (is_growing(w, *root.type) && root.type->routine != own)
        return address_of(w, path(w, part, root, {Mode::address, 0, w.constant_slot(0)}));
    slots_of(w, *root.type);
    const Location at = path(w, part, root, {Mode::slot, 0});
    if (at.mode == Mode::slot) return w.constant_slot(at.slot);
    return at.slot == 0 ? at.index : w.emit(Op::offset, none, at.index, at.slot);
}

bool is_in_image(const Variable* variable) {
    return variable && variable->space == Space::image;
}

/// `base` moved on to a part of what it refers to.
Slot refer_to_part(Writing& w, Slot base, const Expression& part, const Expression& root) {
    if (has_bytes(*root.type)) {
        const Dialect& dialect = is_in_image(root.variable) ? root.place.dialect() : iec;
        const Location whole = locate_through(base, *root.type, dialect);
        return reference_to_packed(w, packed_path(w, part, root, whole));
    }
    if (&part == &root) return base;
    const Slot slots = slots_to_part(w, part, root);
    const Slot bytes = w.emit(Op::bytes_of_slots, none, slots, shape_number(w, *root.type));
    const Slot made = w.new_temporary(reference_slots);
    w.put(Op::move_reference, made, base, bytes);
    return made;
}

/// The piece that something is, which `make` makes the first time, from its first byte on.
ByteOfPiece piece_of(Writing& w, Writing::Pieces& known, const void* of, const auto& make) {
    const auto [it, added] = known.emplace(of, static_cast<std::uint32_t>(w.code.pieces.size()));
    if (added) w.code.pieces.push_back(make());
    return {it->second + 1};
}

/// The instance itself, of a block's body and its methods.
ByteOfPiece piece_of(Writing& w, const Type& own) {
    return piece_of(w, w.pieces, &own,
                    [&] { return Piece{.name = "THIS", .shape = shape_number(w, own)}; });
}

/// A boolean of a standard block is a byte of its slot.
std::uint32_t shape_of(Writing& w, const Variable& variable) {
    if (!variable.is_byte) return shape_number(w, *variable.type);
    const auto byte = static_cast<std::uint8_t>(variable.byte % 8);
    const auto it = std::ranges::find(w.code.shapes, byte, &Shape::byte);
    if (it != w.code.shapes.end()) return static_cast<std::uint32_t>(it - w.code.shapes.begin());
    w.code.shapes.push_back({.type = variable.type, .byte = byte});
    return static_cast<std::uint32_t>(w.code.shapes.size() - 1);
}

ByteOfPiece piece_of(Writing& w, const Variable& variable) {
    const Routine* routine = w.routine;
    if (routine->owner && variable.of != routine->pou) routine = routine->owner;
    return piece_of(w, w.pieces, &variable, [&] {
        Piece piece{.name = std::string(variable.text), .shape = shape_of(w, variable)};
        if (!variable.ends_with_call()) return piece;
        piece.name = fmt::format("{}.{}", routine->name, variable.text);
        piece.ends = true;
        piece.routine = w.routine_number(*routine);
        piece.slot = variable.slot;
        piece.activation = routine->activation;
        return piece;
    });
}

/// What a VAR_IN_OUT was given; the reference stands behind its address.
Location given_reference(Writing& w, const Expression& root) {
    Location at{Mode::slot, root.variable->slot};
    if (root.kind == E::member) at = behind(locate(w, *root.operands[0]), root.variable->slot);
    return behind(at, root.variable->type->is_open ? 2 : 1);
}

/// What stands at an address is a part of the process image, as a whole one variable.
Slot refer_to_image(Writing& w, const Variable& variable) {
    const Image& image = w.checked.image;
    const Slot made = w.new_temporary(reference_slots);
    w.put(Op::lasting, made, w.emit(Op::set_global, none, static_cast<Slot>(image.global)));
    ByteOfPiece to = piece_of(w, w.pieces, &image, [&] {
        return Piece{.name = std::string(image_name),
                     .shape = shape_number(w, *w.checked.bytes_of_image)};
    });
    to.byte = static_cast<std::int32_t>(image.bit_of(variable.address) / 8);
    w.put(Op::move, made + 1, w.constant_slot(to.word()));
    w.put(Op::move, made + 2, w.constant_slot(0));
    return made;
}

Slot refer_to_piece(Writing& w, const Location& at, ByteOfPiece to, bool ends) {
    const Slot made = w.new_temporary(reference_slots);
    w.put(Op::lasting, made, address_of(w, at));
    w.put(Op::move, made + 1, w.constant_slot(to.word()));
    w.put(Op::move, made + 2, ends ? w.routine->activation : w.constant_slot(0));
    return made;
}

Slot refer_to_variable(Writing& w, const Expression& root) {
    const Variable* variable = root.variable;
    if (is_in_image(variable)) return refer_to_image(w, *variable);
    const Location at = locate(w, root);
    return refer_to_piece(w, at.byte ? behind(at, *at.byte / 8) : at,
                          variable ? piece_of(w, *variable) : piece_of(w, *root.type),
                          variable && variable->ends_with_call());
}

/// How many bytes an index of an ARRAY[*] is behind the first one of its dimension.
Slot bytes_of_index(Writing& w, const Expression& e) {
    const Slot index = value(w, *e.operands[1]);
    w.land();
    const Slot lower = value(w, *e.arguments[0].value), upper = value(w, *e.arguments[1].value);
    w.put(Op::between, 0, index, lower, upper);
    Slot place = w.emit(Op::sub_lint, none, index, lower);
    for (std::size_t i = 2; i < e.arguments.size(); i += 2) {
        const Slot first = value(w, *e.arguments[i].value);
        const Slot last = value(w, *e.arguments[i + 1].value);
        const Slot more = w.emit(Op::sub_lint, none, last, first);
        place =
            w.emit(Op::mul_lint, none, place, w.emit(Op::add_lint, none, more, w.constant_slot(1)));
    }
    const auto size = static_cast<std::uint64_t>(e.constant.integer);
    return w.emit(Op::mul_lint, none, place, w.constant_slot(size));
}

Slot moved(Writing& w, const Expression& e) {
    const Slot base = reference(w, *e.operands[0]);
    Slot by = e.arguments.empty() ? value(w, *e.operands[1]) : bytes_of_index(w, e);
    if (e.op == Word::minus) by = w.emit(Op::neg_lint, none, by);
    const Slot made = w.new_temporary(reference_slots);
    w.put(Op::move_reference, made, base, by);
    return made;
}

/// Both references; what the second one calls may write the variable of the first.
std::pair<Slot, Slot> operands(Writing& w, const Expression& e) {
    const Slot first = reference(w, *e.operands[0]);
    const bool is_called = has_call(*e.operands[1]);
    const Slot kept = is_called ? copied(w, {Mode::slot, first}) : first;
    return {kept, reference(w, *e.operands[1])};
}

void add_members(Writing& w, Shape& made) {
    const Dialect& dialect = made.is_s7 ? scl : iec;
    const bool is_packed = packed_bits(*made.type, dialect) > 0;
    std::vector<ShapeMember> members;
    std::uint64_t end = 0;
    for (const Variable* member : made.type->members) {
        const std::uint64_t begin = is_packed ? packed_offset(*made.type, *member, dialect)
                                              : begin_behind(end, *member->type, *made.type);
        members.push_back({begin, member->slot, shape_number(w, *member->type, made.is_s7)});
        end = end_behind(end, *member->type, *made.type);
    }
    made.first = static_cast<std::uint32_t>(w.code.members.size());
    made.count = static_cast<std::uint32_t>(members.size());
    w.code.members.insert(w.code.members.end(), members.begin(), members.end());
}

/// Variables that stay from call to call, of a block and of those that it extends.
void add_variables(Writing& w, Shape& made) {
    std::vector<ShapeMember> members;
    for (const Routine* block = made.type->routine; block; block = block->base)
        for (const Variable& variable : block->variables) {
            const bool stays = variable.space == Space::frame && variable.section != Section::temp;
            if (stays && variable.type && variable.slot != unplaced)
                members.push_back({0, variable.slot, shape_number(w, *variable.type, made.is_s7)});
        }
    made.first = static_cast<std::uint32_t>(w.code.members.size());
    made.count = static_cast<std::uint32_t>(members.size());
    w.code.members.insert(w.code.members.end(), members.begin(), members.end());
}

void finish_shape(Writing& w, std::uint32_t number) {
    Shape made = w.code.shapes[number];
    const Type& type = *made.type;
    const Dialect& dialect = made.is_s7 ? scl : iec;
    const std::uint64_t bits = packed_bits(type, dialect);
    made.bits = bits > 0 ? bits : 8 * bytes_of(type);
    made.slots = slots_of(w, type);
    const bool is_value = type.kind == Kind::enumeration && type.base;
    const auto format = packed_format(is_value ? *type.base : type, dialect);
    if (format) {
        made.kind = Shape::Kind::scalar;
        made.format = *format;
    } else if (type.kind == Kind::text && !type.is_open) {
        made.kind = Shape::Kind::text;
    } else if (type.kind == Kind::union_) {
        made.kind = Shape::Kind::raw;
    } else if (type.kind == Kind::array) {
        made.kind = Shape::Kind::array;
        made.count = static_cast<std::uint32_t>(type.count());
        made.stride = bits > 0 ? packed_stride(type, dialect) : 8 * bytes_of(*type.element);
        made.element = shape_number(w, *type.element, made.is_s7);
    } else if (type.kind == Kind::structure) {
        made.kind = Shape::Kind::structure;
        add_members(w, made);
    } else if (type.kind == Kind::block) {
        add_variables(w, made);
    }
    if (type.kind == Kind::block && type.routine->base)
        made.base = shape_number(w, *type.routine->base->type) + 1;
    w.code.shapes[number] = made;
}

/// `?=` makes one to the instance itself, or NULL.
Slot attempted_reference(Writing& w, const Expression& e) {
    const Slot made = w.new_temporary(reference_slots);
    const Slot at = attempted(w, e, made);
    if (at != made) w.put(Op::move, made, at);
    const ByteOfPiece to = piece_of(w, *e.type->element);
    const Slot is_there = w.emit(Op::ne_word, none, made, w.constant_slot(0));
    w.put(Op::mul_lint, made + 1, is_there, w.constant_slot(to.word()));
    w.put(Op::move, made + 2, w.constant_slot(0));
    return made;
}

/// An overlay sees a variable as another type.
bool is_view(const Expression& refer) {
    const Expression& place = *refer.operands[0];
    return &root_of(place) == &place && place.kind != E::deref && !is_in_image(place.variable);
}

/// A second view of a variable, which is used at once, and stays as long as it is seen so.
Slot view_of(Writing& w, const Expression& place, bool is_s7) {
    const Slot made = w.new_temporary(reference_slots);
    const Slot address = address_of(w, locate(w, place));
    w.put(Op::move, made, address);
    const Variable& variable = *place.variable;
    const ByteOfPiece to = piece_of(w, w.views, &variable, [&] {
        return Piece{.name = std::string(variable.text),
                     .shape = shape_number(w, *variable.type, is_s7)};
    });
    w.put(Op::move, made + 1, w.constant_slot(to.word()));
    return made;
}

/// Where they are that code/addresses.hpp is about.
std::pair<Slot, Slot> numbered_addresses(Writing& w) {
    const auto where = [&](const Variable& variable) {
        const Slot list = w.new_temporary();
        w.put(Op::set_global, list, static_cast<Slot>(variable.global));
        return address_of(w, part(w, {Mode::address, 0, list, 0}, variable));
    };
    const Slot known = where(*w.checked.numbered);
    return {known, where(*w.checked.numbers)};
}

Slot reference_of_number(Writing& w, const Expression& number) {
    const Slot from = value(w, number);
    const auto [known, numbers] = numbered_addresses(w);
    const Slot made = w.new_temporary(reference_slots);
    w.put(Op::reference_of_number, made, from, known, numbers);
    return made;
}

}  // namespace

Slot reference(Writing& w, const Expression& e) {
    switch (e.kind) {
        case E::constant:
            return null_reference(w);
        case E::refer:
            return reference_to(w, *e.operands[0]);
        case E::converted:
            if (e.operands[0]->type->is_number() || e.operands[0]->type->is_bits())
                return reference_of_number(w, *e.operands[0]);
            return e.conversion.is_attempt ? attempted_reference(w, e)
                                           : reference(w, *e.operands[0]);
        case E::binary:
            return moved(w, e);
        case E::call:
            return e.routine ? call(w, e, none)
                             : copied(w, {Mode::address, 0, standard(w, e, none)});
        default: {
            const Location at = locate(w, e);
            return at.mode == Mode::slot ? at.slot : copied(w, at);
        }
    }
}

Slot reference_to(Writing& w, const Expression& place) {
    const Expression& root = root_of(place);
    if (root.kind == E::deref)
        return refer_to_part(w, reference(w, *root.operands[0]), place, root);
    if (root.variable && root.variable->space == Space::reference)
        return refer_to_part(w, copied(w, given_reference(w, root)), place, root);
    return refer_to_part(w, refer_to_variable(w, root), place, root);
}

Slot reference_to(Writing& w, const Variable& variable) {
    return refer_to_piece(w, locate_variable(w, variable), piece_of(w, variable),
                          variable.ends_with_call());
}

Location locate_target(Writing& w, const Expression& e) {
    if (!is_growing(w, *e.type))
        slots_of(w, *e.type);  // lays it out: nothing else of its type may be there yet
    const Expression& pointer = *e.operands[0];
    if (pointer.kind == E::refer && is_view(pointer)) {
        const Dialect& dialect = e.place.dialect();
        const Slot view = view_of(w, *pointer.operands[0], dialect.packs_as_s7);
        return locate_through(view, *e.type, dialect);
    }
    const Slot from = reference(w, pointer);
    if (has_bytes(*e.type)) return locate_through(from, *e.type, iec);
    return {Mode::address, 0, w.emit(Op::reach, none, from, shape_number(w, *e.type))};
}

Location locate_instance(Writing& w, const Location& from, const Type& instance) {
    const Slot reference = from.mode == Mode::slot ? from.slot : copied(w, from);
    return {Mode::address, 0, w.emit(Op::reach, none, reference, shape_number(w, instance))};
}

bool is_element_of_target(const Expression& e) {
    if (e.kind != E::index || e.operands[0]->kind != E::deref) return false;
    const Expression& array = *e.operands[0];
    return array.type->kind == Kind::array && !has_bytes(*array.type) &&
           array.operands[0]->kind != E::refer;
}

Location locate_element_of_target(Writing& w, const Expression& e) {
    const Expression& array = *e.operands[0];
    const bool calls = std::ranges::any_of(
        e.arguments, [](const Argument& index) { return has_call(*index.value); });
    Slot at = reference(w, *array.operands[0]);
    if (calls) at = copied(w, {Mode::slot, at});
    std::uint64_t first = 0;
    Slot bytes = none;
    const Type* type = array.type;
    for (const Argument& argument : e.arguments) {
        const std::uint64_t stride = bytes_of(*type->element);
        const Expression& number = *argument.value;
        if (number.kind == E::constant) {
            first += static_cast<std::uint64_t>(number.constant.integer - type->lower) * stride;
        } else {
            const IndexTable made{type->lower, type->count(), stride};
            const Slot more = w.emit(Op::index, none, looked_at(w, number), w.table(made));
            bytes = bytes == none ? more : w.emit(Op::add_lint, none, bytes, more);
        }
        type = type->element;
    }
    if (bytes == none)
        bytes = w.constant_slot(first);
    else if (first != 0)
        bytes = w.emit(Op::add_lint, none, bytes, w.constant_slot(first));
    if (!is_growing(w, *e.type)) slots_of(w, *e.type);
    const Slot element = w.new_temporary(reference_slots);
    w.put(Op::move_reference, element, at, bytes);
    return {Mode::address, 0, w.emit(Op::reach, none, element, shape_number(w, *e.type))};
}

Slot compare_references(Writing& w, const Expression& e) {
    const auto [a, b] = operands(w, e);
    return w.emit(Op::compare_references, none, a, b);
}

Slot reference_distance(Writing& w, const Expression& e, Slot wanted) {
    const auto [a, b] = operands(w, e);
    return w.emit(Op::reference_distance, wanted, a, b);
}

Slot address_number(Writing& w, const Expression& e) {
    const Slot from = reference(w, e);
    const auto [known, numbers] = numbered_addresses(w);
    const Slot made = w.new_temporary();
    w.put(Op::number_of_reference, made, from, known, numbers);
    return made;
}

/// TIME and LTIME are alike but for their bytes, and pointers whatever they are to.
std::uint32_t shape_number(Writing& w, const Type& type, bool is_s7) {
    const auto is_same = [&](const Shape& shape) {
        const bool are_pointers = shape.type->is_pointer() && type.is_pointer();
        return shape.is_s7 == is_s7 && !shape.byte &&
               (are_pointers || same_type(*shape.type, type)) &&
               bytes_of(*shape.type) == bytes_of(type);
    };
    const auto it = std::ranges::find_if(w.code.shapes, is_same);
    const auto number = static_cast<std::uint32_t>(it - w.code.shapes.begin());
    if (it == w.code.shapes.end()) w.code.shapes.push_back({.type = &type, .is_s7 = is_s7});
    return number;
}

void finish_shapes(Writing& w) {
    for (std::uint32_t i = 0; i < w.code.shapes.size(); ++i) finish_shape(w, i);
}

}  // namespace lineshaft::st
