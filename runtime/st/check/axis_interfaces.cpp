#include <utility>

#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/syntax/words.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

/// The call of `AXIS_REF.PlcToNc` in `axis.PlcToNc.ControlDWord.0`; null: there is none.
const Expression* interface_of(const Expression* target) {
    while (target->kind == E::member || target->kind == E::bit || target->kind == E::index)
        target = target->operands[0];
    return target->kind == E::call && target->routine ? target : nullptr;
}

/// A copy to be checked anew, of `whole` instead of what the interface's call gives.
Expression* part_of(Checking& c, const Expression& part, Expression* whole) {
    if (part.kind == E::call) return whole;
    Expression* made = make_copy(c, part);
    made->type = nullptr;
    made->variable = nullptr;
    made->operands[0] = part_of(c, *part.operands[0], whole);
    return made;
}

/// `Tc2_MC2.PlcToNcWriter` of `Tc2_MC2.AXIS_REF.PlcToNc`; null: it is only read.
Routine* writer_of(Checking& c, const Routine& interface) {
    constexpr std::string_view axis = "AXIS_REF.";
    const std::string_view name = interface.name;
    const std::size_t at = name.find(axis);
    return at == name.npos ? nullptr
                           : find_in(c.users.routines, fmt::format("{}{}Writer", name.substr(0, at),
                                                                   name.substr(at + axis.size())));
}

/// An instance of the block for the statement; a method's stands in its block.
Variable& add_writer(Checking& c, const Expression& like, const Routine& writer) {
    Routine& of = c.routine->owner ? *c.routine->owner : *c.routine;
    Variable& made = c.make_variable(
        of, like.token,
        c.checked.names.emplace_back(fmt::format("{} {}", writer.name, of.variables.size())),
        writer.type);
    of.names.emplace(made.text, &made);
    Routine* const here = std::exchange(c.routine, &of);
    depend(c, made.type, like.place);
    c.routine = here;
    return made;
}

void warn_of_no_effect(Checking& c, const Expression& target) {
    const Expression* member = &target;
    while (member->operands[0]->kind != E::call) member = member->operands[0];
    if (member->kind == E::member && !counts_for_axis(member->token.text))
        c.warn(code::not_supported, member->token.place,
               fmt::format("'{}' has no effect on an axis here", member->token.text),
               "ControlDWord and Override count, as MC_Power's and MC_SetOverride's");
}

}  // namespace

bool rewrite_axis_interface(Checking& c, Statement*& s) {
    const Expression* whole = interface_of(s->target);
    if (!whole || whole == s->target || !c.routine) return false;
    Routine* writer = writer_of(c, *whole->routine);
    const Routine& block = c.routine->owner ? *c.routine->owner : *c.routine;
    if (!writer || !writer->type || !block.has_instances()) return false;
    warn_of_no_effect(c, *s->target);
    const Expression& like = *s->target;
    Variable& made = add_writer(c, like, *writer);
    const auto input = [&](std::string_view name) { return find_in(writer->names, name); };
    const auto instance = [&] { return make_name(c, like, made.text); };
    const auto value = [&] { return make_member(c, instance(), input("value")->text); };
    Expression* given = s->value;
    if (s->op != Word::assign)
        given = make_binary(c, s->place, s->place, operator_of(s->op), s->target, given);
    Expression* axis = make_copy(c, *whole->arguments.front().value);
    s = make_sequence(
        c, s->place,
        {make_assignment(c, s->place, value(), make_copy(c, *whole)),
         make_assignment(c, s->place, part_of(c, *s->target, value()), given),
         make_call_statement(
             c, make_call(c, like, instance(), {{.name = input("axis")->name, .value = axis}}))});
    check(c, s);
    return true;
}

}  // namespace lineshaft::st
