#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"

namespace lineshaft::st {

namespace {

constexpr std::string_view beginner = "FB_init.begins";

bool begins(const Routine* block) {
    return block && (!block->begins.empty() || begins(block->base));
}

}  // namespace

void begin_block(Checking& c, Routine& block) {
    const bool has_instances = block.pou->kind == PouKind::function_block && !block.pou->is_tests;
    if (!has_instances || !begins(&block)) return;
    Pou& pou = c.tree.pous.emplace_back();
    pou.kind = PouKind::method;
    pou.name = block.pou->name;
    pou.name.text = beginner;
    pou.place = block.pou->place;
    Routine& made = c.make_routine(pou, fmt::format("{}.{}", block.name, beginner));
    made.owner = &block;
    made.is_declared = true;
    block.methods.emplace(beginner, &made);
}

Routine* beginning_of(const Type& block) {
    return find_in(block.routine->methods, beginner);
}

Statement* begin_to_copy(Checking& c, const Expression& instance) {
    if (!beginning_of(*instance.type)) return nullptr;
    Expression* name = make_member(c, make_copy(c, instance), beginner);
    Statement* call = make_call_statement(c, make_call(c, instance, name, {}));
    check(c, call);
    return call;
}

}  // namespace lineshaft::st
