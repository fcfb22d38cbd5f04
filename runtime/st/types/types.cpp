#include "runtime/st/types/types.hpp"

#include <algorithm>

#include "runtime/source/letters.hpp"

namespace lineshaft::st {

const Expression& root_of(const Expression& place) {
    const bool is_part =
        place.kind == Expression::Kind::index ||
        (place.kind == Expression::Kind::member && !place.operands[0]->type->is_instance());
    return is_part ? root_of(*place.operands[0]) : place;
}

bool lacks_base(const Type& type) {
    return type.has_unknown_base || (type.routine && type.routine->has_unknown_base);
}

namespace {

std::uint64_t whole_bytes(std::uint64_t bits) {
    return (bits + 7) / 8;
}

/// A block of CODESYS begins with where its methods are. One that is in itself has no end, which is
/// told in the end.
std::uint64_t bytes_of_block(const Type& type) {
    Routine& block = *type.routine;
    if (block.is_measured) return 0;
    block.is_measured = true;
    const bool has_methods = block.pou->name.place.dialect().blocks_begin_with_methods;
    std::uint64_t bits = 8 * (block.base ? bytes_of(*block.base->type) : has_methods ? 8U : 0U);
    for (const Variable& variable : block.variables)
        if (variable.type && variable.space == Space::frame && variable.section != Section::temp)
            bits = end_behind(bits, *variable.type, type);
    block.is_measured = false;
    return rounded_up(std::max<std::uint64_t>(whole_bytes(bits), 1), alignment_of(type));
}

}  // namespace

std::uint64_t alignment_of(const Type& type) {
    std::uint64_t most = 1;
    switch (type.kind) {
        case Type::Kind::text:
            return type.is_wide ? 2 : 1;
        case Type::Kind::array:
            return type.element ? alignment_of(*type.element) : 1;
        case Type::Kind::structure:
        case Type::Kind::union_:
            for (const Variable* member : type.members)
                if (member->type) most = std::max(most, alignment_of(*member->type));
            return std::min<std::uint64_t>(most, type.pack);
        case Type::Kind::block:
            return type.pack;
        case Type::Kind::standard:
            return 8;
        default:
            return std::max<std::uint64_t>(bytes_of(type), 1);
    }
}

std::uint64_t begin_behind(std::uint64_t bits, const Type& member, const Type& whole) {
    if (member.is_one_bit) return bits;
    return 8 *
           rounded_up(whole_bytes(bits), std::min<std::uint64_t>(alignment_of(member), whole.pack));
}

std::uint64_t end_behind(std::uint64_t bits, const Type& member, const Type& whole) {
    return begin_behind(bits, member, whole) + (member.is_one_bit ? 1 : 8 * bytes_of(member));
}

std::uint64_t place_in_union(const Variable& member) {
    return 8 * std::uint64_t{member.address.byte} + member.address.bit;
}

std::uint64_t bytes_of(const Type& type) {
    std::uint64_t bytes = 0, bits = 0;
    switch (type.kind) {
        case Type::Kind::boolean:
            return 1;
        case Type::Kind::time:
        case Type::Kind::date:
        case Type::Kind::clock:
        case Type::Kind::moment:
            return type.counts_ns ? 8 : 4;
        case Type::Kind::text:
            return (type.length + 1) * (type.is_wide ? 2 : 1);
        case Type::Kind::enumeration:
            return type.base ? bytes_of(*type.base) : 0;
        case Type::Kind::array:
            return type.count() * bytes_of(*type.element);
        case Type::Kind::structure:
            for (const Variable* member : type.members)
                if (member->type)  // told, if it has none
                    bits = end_behind(bits, *member->type, type);
            return rounded_up(whole_bytes(bits), alignment_of(type));
        case Type::Kind::union_:
            for (const Variable* member : type.members)
                if (member->type)
                    bytes = std::max(bytes, place_in_union(*member) / 8 + bytes_of(*member->type));
            return rounded_up(bytes, alignment_of(type));
        case Type::Kind::block:
            return bytes_of_block(type);
        case Type::Kind::standard:
            return type.standard->size;
        case Type::Kind::reference:
            return type.pointer_bytes;
        case Type::Kind::handle:
            return 8;
        default:
            return static_cast<std::uint64_t>(type.bits) / 8;
    }
}

bool has_call(const Expression& e) {
    if (e.kind == Expression::Kind::call && e.routine) return true;
    for (const Expression* operand : e.operands)
        if (operand && has_call(*operand)) return true;
    return std::ranges::any_of(e.arguments, [](const Argument& a) { return has_call(*a.value); });
}

bool Called::may_recur() const {
    return is_call && !through_reference && (routine->owner || routine->is_function());
}

std::vector<Variable*> all_variables(const Routine& block) {
    std::vector<Variable*> all;
    if (block.base) all = all_variables(*block.base);
    for (const Variable& variable : block.variables)
        all.push_back(const_cast<Variable*>(&variable));
    return all;
}

Wide count_parts(const Type& type) {
    if (type.kind == Type::Kind::array)
        return (Wide{type.upper} - type.lower + 1) * count_parts(*type.element);
    if (type.kind != Type::Kind::structure) return 1;
    Wide count = 0;
    for (const Variable* member : type.members)
        if (member->type) count += count_parts(*member->type);
    return count;
}

bool has_handle(const Type& type) {
    const auto has = [](const Variable* part) { return part->type && has_handle(*part->type); };
    if (type.kind == Type::Kind::array) return has_handle(*type.element);
    if (type.kind == Type::Kind::structure) return std::ranges::any_of(type.members, has);
    if (type.kind == Type::Kind::block)
        return std::ranges::any_of(all_variables(*type.routine), has);
    return type.kind == Type::Kind::handle;
}

bool declares(const Routine& block, std::string_view name) {
    return std::ranges::any_of(all_variables(block), is_called(name), &Variable::text);
}

std::string signature_of(const Pou& routine) {
    std::string signature;
    for (const Section section : {Section::input, Section::in_out, Section::output})
        for (const DeclarationBlock& block : routine.blocks)
            for (const Declaration* declared : block.declarations) {
                if (block.section != section || !declared->type) continue;
                if (!signature.empty()) signature += ',';
                for (const char letter : declared->type->place.text())
                    if (letter != ' ' && letter != '\t') signature += lower(letter);
            }
    return signature;
}

Routine* find_method(const Routine& block, const Routine& like) {
    const Accessor accessor = like.pou->accessor;
    const auto& known = accessor == Accessor::get   ? block.getters
                        : accessor == Accessor::set ? block.setters
                                                    : block.methods;
    Routine* first = find_in(known, like.pou->name.text);
    if (!first) return nullptr;
    const std::vector<Routine*>* several = find_in(block.overloads, like.pou->name.text);
    const bool is_one =
        accessor != Accessor::none ||
        (!several && !(like.owner && like.owner->overloads.contains(like.pou->name.text)));
    if (is_one) return first;
    const std::string wanted = signature_of(*like.pou);
    const auto is_like = [&](const Routine* r) { return signature_of(*r->pou) == wanted; };
    if (!several) return is_like(first) ? first : nullptr;
    const auto found = std::ranges::find_if(*several, is_like);
    return found == several->end() ? nullptr : *found;
}

const Routine* find_routine(const Routine& block, const Routine& wanted) {
    const bool is_body = !wanted.owner;
    if (!is_a(block, is_body ? wanted : *wanted.owner)) return nullptr;
    return is_body ? &block : find_method(block, wanted);
}

bool is_a(const Routine& block, const Routine& other) {
    if (&block == &other || (block.base && is_a(*block.base, other))) return true;
    return std::ranges::any_of(block.interfaces,
                               [&](const Routine* base) { return is_a(*base, other); });
}

}  // namespace lineshaft::st
