#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"

namespace lineshaft::st {

namespace {

constexpr std::string_view beginner = "FB_init.parts", beginner_of_copies = "FB_init.copies";

/// Its FB_init is its own, and begins them.
bool begins_parts(const Routine& block) {
    const Routine* own = find_in(block.methods, "fb_init");
    return own && own->owner == &block;
}

/// An empty method, which what the block and its bases begin with comes before.
void add_beginning(Checking& c, Routine& block, std::string_view name) {
    Pou& pou = c.tree.pous.emplace_back();
    pou.kind = PouKind::method;
    pou.name = block.pou->name;
    pou.name.text = name;
    pou.place = block.pou->place;
    Routine& made = c.make_routine(pou, fmt::format("{}.{}", block.name, name));
    made.owner = &block;
    made.is_declared = true;
    block.methods.emplace(name, &made);
}

void begin_parts(Checking& c, Routine& block, std::unordered_set<const Routine*>& seen) {
    if (!seen.insert(&block).second) return;
    bool has_parts = false;
    const auto look_at = [&](const auto& self, const Type* type) -> void {
        if (!type) return;
        if (type->kind == Kind::array) self(self, type->element);
        if (type->kind == Kind::structure)
            for (const Variable* member : type->members) self(self, member->type);
        if (type->kind == Kind::block) begin_parts(c, *type->routine, seen);
    };
    for (const Variable* variable : all_variables(block)) {
        if (variable->space != Space::frame || variable->section == Section::temp) continue;
        look_at(look_at, variable->type);
        has_parts |= is_constructed(c, variable->type) || is_followed(c, variable->type);
    }
    if (has_parts && !begins_parts(block)) add_beginning(c, block, beginner);
}

bool begins(const Routine* block) {
    return block && (!block->begins.empty() || begins(block->base));
}

}  // namespace

Statement* begin_to_copy(Checking& c, const Expression& instance) {
    Routine& block = *instance.type->routine;
    if (!begins(&block)) return nullptr;
    if (!block.methods.contains(beginner_of_copies)) add_beginning(c, block, beginner_of_copies);
    Expression* name = make_member(c, make_copy(c, instance), beginner_of_copies);
    Statement* call = make_call_statement(c, make_call(c, instance, name, {}));
    check(c, call);
    return call;
}

Routine* beginning_of_parts(const Type& block) {
    return find_in(block.routine->methods, beginner);
}

void begin_parts_of_blocks(Checking& c) {
    std::unordered_set<const Routine*> seen;
    for (std::size_t i = 0, count = c.checked.routines.size(); i < count; ++i)
        if (Routine& routine = c.checked.routines[i];
            routine.pou->kind == PouKind::function_block && routine.type && !routine.owner)
            begin_parts(c, routine, seen);
}

}  // namespace lineshaft::st
