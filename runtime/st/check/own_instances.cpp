#include <fmt/format.h>

#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"

namespace lineshaft::st {

namespace {

Expression like_name(const Variable& variable) {
    return {.token = variable.name, .place = variable.name.place};
}

void assign_in_each_call(Checking& c, Routine& routine, Variable& to, Variable& from) {
    const Expression like = like_name(to);
    routine.call_begins.push_back(
        make_assignment(c, like.place, make_use(c, like, to), make_use(c, like, from)));
    routine.holds_instance = true;
}

Variable& keep_beside(Checking& c, const Variable& like, std::string text, const Type* type) {
    Variable& made =
        c.make_variable(like.name, c.checked.names.emplace_back(std::move(text)), type);
    made.used = true;
    keep_once(c, made);
    return made;
}

/// Whether an instance has room for what a section declares.
bool has_room(Section section) {
    return section != Section::in_out && section != Section::static_ &&
           section != Section::external && section != Section::global;
}

/// The block of the sources that a type is, or an array of; null: it is none.
const Pou* block_of(const Checking& c, const TypeText* text) {
    while (text && text->kind == TypeText::Kind::array) text = text->element;
    if (!text || text->kind != TypeText::Kind::name) return nullptr;
    const std::string_view name = text->name.text;
    const auto found = c.blocks_by_name->find(name.substr(name.rfind('.') + 1));
    return found == c.blocks_by_name->end() ? nullptr : found->second;
}

void note_blocks(Checking& c) {
    c.blocks_by_name.emplace();
    for (const Pou* unit : c.tree.units) {
        const std::string_view name = unit->name.text;
        if (unit->kind == PouKind::function_block)
            c.blocks_by_name->insert_or_assign(name.substr(name.rfind('.') + 1), unit);
    }
}

/// The blocks of what it declares, in its methods too, and what it extends.
std::vector<const Pou*> declared_in(const Checking& c, const Pou& block) {
    std::vector<const Pou*> found;
    const auto add = [&](const TypeText* text) {
        if (const Pou* part = block_of(c, text)) found.push_back(part);
    };
    const auto add_all = [&](const Pou& unit) {
        for (const DeclarationBlock& section : unit.blocks)
            if (has_room(section.section))
                for (const Declaration* declared : section.declarations) add(declared->type);
        add(unit.result);
    };
    add_all(block);
    for (const Pou* method : block.methods) add_all(*method);
    for (const Token& base : block.bases) {
        const TypeText text{.name = base};
        add(&text);
    }
    return found;
}

/// The blocks that an instance of it would have room for, by what they declare.
const std::unordered_set<const Pou*>& parts_of(Checking& c, const Pou& block) {
    if (!c.blocks_by_name) note_blocks(c);
    const auto [it, added] = c.parts_of_blocks.try_emplace(&block);
    if (!added) return it->second;
    std::vector<const Pou*> open = declared_in(c, block);
    while (!open.empty()) {
        const Pou* part = open.back();
        open.pop_back();
        if (!it->second.insert(part).second) continue;
        for (const Pou* next : declared_in(c, *part)) open.push_back(next);
    }
    return it->second;
}

/// An interface of `block` asks for a method of that name, and the other block has that interface.
bool share_interface_with(const Routine& block, std::string_view method, const Routine& other) {
    const auto asks = [&](const Routine* interface) {
        const auto is_it = [&](const Pou* own) { return same_name(own->name.text, method); };
        return (std::ranges::any_of(interface->pou->methods, is_it) && is_a(other, *interface)) ||
               share_interface_with(*interface, method, other);
    };
    return std::ranges::any_of(block.interfaces, asks) ||
           (block.base && share_interface_with(*block.base, method, other));
}

}  // namespace

bool is_its_own_block(Checking& c, const Routine& routine, const Type* type) {
    const bool is_method = routine.owner && !routine.is_test();
    if (!is_method || !type || type->kind != Type::Kind::block || !type->routine) return false;
    const Routine& other = *type->routine;
    if (routine.is_prototype()) return is_a(other, *routine.owner);
    return type == routine.owner->type || parts_of(c, *other.pou).contains(routine.owner->pou) ||
           share_interface_with(*routine.owner, routine.pou->name.text, other);
}

void begin_anew(Checking& c, Routine& routine, Variable& variable) {
    Variable& fresh =
        keep_beside(c, variable, fmt::format("{} as it begins", variable.text), variable.type);
    fresh.initial = variable.initial;
    fresh.constructed = variable.constructed;
    assign_in_each_call(c, routine, variable, fresh);
}

Variable& take_own_instance(Checking& c, Routine& routine, Variable& input) {
    input.section = Section::in_out;
    input.constant = input.used = true;
    input.space = Space::reference;
    if (routine.is_prototype()) return input;
    Variable& copy =
        keep_beside(c, input, fmt::format("{}.{}", routine.name, input.text), input.type);
    assign_in_each_call(c, routine, copy, input);
    return copy;
}

void give_own_instance(Checking& c, Routine& routine, Variable& result) {
    if (routine.is_prototype()) {
        result.type = &make_reference(c, Referring::alias, result.type);
        return;
    }
    Variable& given =
        keep_beside(c, result, fmt::format("{} of {}", result.text, routine.name), result.type);
    begin_anew(c, routine, given);
    result.type = &make_reference(c, Referring::alias, given.type);
    const Expression like = like_name(result);
    Statement* refer =
        make_assignment(c, like.place, make_use(c, like, result),
                        make_reference_to(c, make_use(c, like, given), *result.type));
    refer->op = Word::reference_assign;
    routine.call_begins.push_back(refer);
}

}  // namespace lineshaft::st
