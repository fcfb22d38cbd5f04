#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"

namespace lineshaft::st {

namespace {

using Members = std::span<Variable* const>;

bool has(Members members, std::string_view name) {
    return std::ranges::any_of(
        members, [&](const Variable* member) { return same_name(member->text, name); });
}

/// `ADR` of `ADR(a)` is no variable.
bool is_callee(const Expression& of, const Expression* operand) {
    return of.kind == E::call && operand == of.operands[0] && operand->kind == E::name;
}

template <class Visit>
void visit_parts(Expression& e, const Visit& visit) {
    for (Expression*& operand : e.operands)
        if (operand && !is_callee(e, operand)) visit(operand);
    for (Argument& argument : e.arguments)
        if (argument.value) visit(argument.value);
}

bool names_one(const Expression& e, Members members) {
    if (e.kind == E::name) return has(members, e.token.text);
    bool found = false;
    visit_parts(const_cast<Expression&>(e),
                [&](const Expression* part) { found |= names_one(*part, members); });
    return found;
}

/// A copy in which variables and values from beside the structure are known, and members of it are
/// names alone. True: there are such.
bool know_others(Checking& c, Expression*& e, Members members) {
    e = make_copy(c, *e);
    if (e->kind == E::name) {
        const bool is_other = find_variable(c, e->token) || c.look_up(&Names::values, e->token);
        if (is_other) check(c, e);
        return !is_other && has(members, e->token.text);
    }
    bool found = false;
    visit_parts(*e, [&](Expression*& part) { found |= know_others(c, part, members); });
    return found;
}

}  // namespace

void note_members_by_others(Checking& c, const Type& structure) {
    for (std::size_t i = 0; i < structure.members.size(); ++i) {
        const Members before = Members(structure.members).first(i);
        const Variable* member = structure.members[i];
        const bool is_list = member->initial && (member->initial->kind == E::list ||
                                                 member->initial->kind == E::repeated);
        if (member->initial && !is_list && names_one(*member->initial, before))
            c.members_before.emplace(member, before);
    }
}

bool begins_by_others(Checking& c, const Variable& member, Expression*& value) {
    const auto before = c.members_before.find(&member);
    if (before == c.members_before.end()) return false;
    Expression* known = value;
    if (!know_others(c, known, before->second)) return false;
    value = known;
    return true;
}

Expression* with_members(Checking& c, Expression* e, Members members,
                         const std::function<Expression*()>& structure) {
    if (e->type) return e;
    if (e->kind == E::name && has(members, e->token.text)) {
        Expression* made = make_member(c, structure(), e->token.text);
        made->token = e->token;
        made->place = e->place;
        return made;
    }
    e = make_copy(c, *e);
    visit_parts(*e, [&](Expression*& part) { part = with_members(c, part, members, structure); });
    return e;
}

}  // namespace lineshaft::st
