#include "runtime/st/generate/references.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/st/generate/calls.hpp"
#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/values.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;
using E = Expression::Kind;
using Mode = Location::Mode;

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

/// Where a part of the root is, if that began at slot 0.
Location path(Writing& w, const Expression& e, const Expression& root) {
    if (&e == &root) return {Mode::slot, 0};
    const Location of = path(w, *e.operands[0], root);
    return e.kind == E::member ? part(w, of, *e.variable) : element(w, of, e);
}

/// `base` moved on to a part of what it refers to.
Slot refer_to_part(Writing& w, Slot base, const Expression& part, const Expression& root) {
    const Location at = path(w, part, root);
    if (at.mode == Mode::slot && at.slot == 0) return base;
    Slot slots = w.constant_slot(at.slot);
    if (at.mode == Mode::indexed)
        slots = at.slot == 0 ? at.index : w.emit(Op::offset, none, at.index, at.slot);
    const Slot bytes = w.emit(Op::bytes_of_slots, none, slots, shape_number(w, *root.type));
    const Slot made = w.new_temporary(reference_slots);
    w.put(Op::move_reference, made, base, bytes);
    return made;
}

/// The instance itself, of a block's body and its methods.
std::uint32_t piece_number(Writing& w, const Type& own) {
    const auto number = static_cast<std::uint32_t>(w.code.pieces.size());
    const auto [it, added] = w.own_pieces.emplace(&own, number);
    if (added) w.code.pieces.push_back({.name = "THIS", .shape = shape_number(w, own)});
    return it->second;
}

std::uint32_t piece_number(Writing& w, const Variable& variable) {
    const auto number = static_cast<std::uint32_t>(w.code.pieces.size());
    const auto [it, added] = w.pieces.emplace(&variable, number);
    if (!added) return it->second;
    const Routine* routine = w.routine;
    if (routine->owner && variable.of != routine->pou) routine = routine->owner;
    Piece piece{.name = std::string(variable.text), .shape = shape_number(w, *variable.type)};
    if (variable.ends_with_call()) {
        piece.name = fmt::format("{}.{}", routine->name, variable.text);
        piece.ends = true;
        piece.routine = w.routine_number(*routine);
        piece.slot = variable.slot;
        piece.activation = routine->activation;
    }
    w.code.pieces.push_back(std::move(piece));
    return number;
}

/// What a VAR_IN_OUT was given; the reference stands behind its address.
Location given_reference(Writing& w, const Expression& root) {
    Location at{Mode::slot, root.variable->slot};
    if (root.kind == E::member) at = behind(locate(w, *root.operands[0]), root.variable->slot);
    return behind(at, root.variable->type->is_open ? 2 : 1);
}

Slot refer_to_variable(Writing& w, const Expression& root) {
    const Variable* variable = root.variable;
    const Slot address = address_of(w, locate(w, root));
    const Slot made = w.new_temporary(reference_slots);
    w.put(Op::lasting, made, address);
    const std::uint64_t piece = variable ? piece_number(w, *variable) : piece_number(w, *root.type);
    w.put(Op::move, made + 1, w.constant_slot((piece + 1) << 32));
    const bool ends = variable && variable->ends_with_call();
    w.put(Op::move, made + 2, ends ? w.routine->activation : w.constant_slot(0));
    return made;
}

/// How many bytes behind the first element of an ARRAY[*] the one of that index is.
Slot bytes_of_index(Writing& w, const Expression& e) {
    const Slot index = value(w, *e.operands[1]);
    w.land();
    const Slot lower = value(w, *e.arguments[0].value), upper = value(w, *e.arguments[1].value);
    w.put(Op::between, 0, index, lower, upper);
    const Slot place = w.emit(Op::sub_lint, none, index, lower);
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

void finish_shape(Writing& w, std::uint32_t number) {
    const Type& type = *w.code.shapes[number].type;
    Shape made{.type = &type};
    made.bytes = bytes_of(type);
    made.slots = slots_of(w, type);
    if (type.kind == Kind::array) {
        made.kind = Shape::Kind::array;
        made.element = shape_number(w, *type.element);
    } else if (type.kind == Kind::structure) {
        made.kind = Shape::Kind::structure;
        std::vector<ShapeMember> members;
        std::uint64_t byte = 0;
        for (const Variable* member : type.members) {
            members.push_back({byte, member->slot, shape_number(w, *member->type)});
            byte += bytes_of(*member->type);
        }
        made.first = static_cast<std::uint32_t>(w.code.members.size());
        made.count = static_cast<std::uint32_t>(members.size());
        w.code.members.insert(w.code.members.end(), members.begin(), members.end());
    }
    if (type.kind == Kind::block && type.routine->base)
        made.base = shape_number(w, *type.routine->base->type) + 1;
    w.code.shapes[number] = made;
}

}  // namespace

Slot reference(Writing& w, const Expression& e) {
    switch (e.kind) {
        case E::constant:
            return null_reference(w);
        case E::refer:
            return reference_to(w, *e.operands[0]);
        case E::converted:
            return reference(w, *e.operands[0]);
        case E::binary:
            return moved(w, e);
        case E::call:
            return call(w, e, none);
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

Location locate_target(Writing& w, const Expression& e) {
    slots_of(w, *e.type);  // lays it out: nothing else of its type may be there yet
    const Slot from = reference(w, *e.operands[0]);
    return {Mode::address, 0, w.emit(Op::reach, none, from, shape_number(w, *e.type))};
}

Slot compare_references(Writing& w, const Expression& e) {
    const Slot a = reference(w, *e.operands[0]), b = reference(w, *e.operands[1]);
    return w.emit(Op::compare_references, none, a, b);
}

Slot reference_distance(Writing& w, const Expression& e, Slot wanted) {
    const Slot a = reference(w, *e.operands[0]), b = reference(w, *e.operands[1]);
    return w.emit(Op::reference_distance, wanted, a, b);
}

std::uint32_t shape_number(Writing& w, const Type& type) {
    const auto is_same = [&](const Shape& shape) { return same_type(*shape.type, type); };
    const auto it = std::ranges::find_if(w.code.shapes, is_same);
    const auto number = static_cast<std::uint32_t>(it - w.code.shapes.begin());
    if (it == w.code.shapes.end()) w.code.shapes.push_back({.type = &type});
    return number;
}

void finish_shapes(Writing& w) {
    for (std::uint32_t i = 0; i < w.code.shapes.size(); ++i) finish_shape(w, i);
}

}  // namespace lineshaft::st
