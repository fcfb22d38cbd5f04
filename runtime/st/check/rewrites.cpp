#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/dynamic_memory.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/syntax/literals.hpp"

namespace lineshaft::st {

namespace {

const Argument* find_argument(const Expression& call, std::string_view name) {
    return find_called(call.arguments, name, &Argument::name);
}

/// A block of the standard that has a preset time.
bool is_timer(const Type& type) {
    if (type.kind == Kind::block)
        return type.routine->pou->place.source->is_prelude() && type.routine->names.contains("pt");
    return type.kind == Kind::standard &&
           std::ranges::any_of(type.members, [](const Variable* m) { return m->text == "pt"; });
}

/// What a function of MatIEC gives where EN is FALSE.
void assign_initial_value(Checking& c, const Statement& s, Block& to) {
    if (s.kind != S::assign || !s.place.dialect().disabled_calls_give_zero) return;
    Expression* target = s.target;
    const Type* type = check(c, target);
    const bool is_elementary = type && (type->kind <= Kind::time ||
                                        (type->kind >= Kind::date && type->kind <= Kind::text));
    if (!is_elementary || type->kind == Kind::interface) return;
    to.push_back(make_assignment(c, s.place, target, make_constant(c, *s.value, *type, {})));
}

/// `y := f(EN := go, a := x, ENO => ok);` is an IF around `y := f(a := x, ENO => ok);`
Statement* if_enabled(Checking& c, const Statement& s, bool has_eno) {
    const Expression& call = *s.value;
    const Argument* enable = find_argument(call, "en");
    const Argument* enabled = find_argument(call, "eno");
    std::vector<Argument> others;
    std::ranges::copy_if(call.arguments, std::back_inserter(others), [&](const Argument& a) {
        return !same_name(a.name.text, "en") && (has_eno || !same_name(a.name.text, "eno"));
    });
    const auto eno_is = [&](Expression* value) {
        return make_assignment(c, s.place, enabled->value, value);
    };
    Expression* condition = enable ? enable->value : make_boolean(c, call, true);
    Block then, otherwise;
    const bool is_told = enabled && !has_eno;
    Expression* succeeds = is_told ? enable_output(c, s, others, then) : nullptr;
    if (succeeds) then.push_back(eno_is(succeeds));
    then.push_back(make_with(c, s, make_with(c, call, std::move(others))));
    if (is_told && !succeeds) then.push_back(eno_is(make_boolean(c, call, true)));
    if (enabled) otherwise.push_back(eno_is(make_boolean(c, call, false)));
    if (Variable* flag = enable ? enable_flag(c, *call.operands[0]) : nullptr) {
        const auto flag_is = [&](bool value) {
            return make_assignment(c, s.place, make_use(c, call, *flag),
                                   make_boolean(c, call, value));
        };
        then.push_back(flag_is(true));
        otherwise.push_back(flag_is(false));
    }
    assign_initial_value(c, s, otherwise);
    return make_if(c, s.place, condition, std::move(then), std::move(otherwise));
}

/// `word.3`, or of a slice `word.%W1` the same bit of the whole: `word.19`.
Expression* bit_of(Checking& c, Expression* word, std::size_t number) {
    if (word->kind == E::bit) {
        number += word->bits.first;
        word = word->operands[0];
    }
    return make_bit(c, word, c.checked.names.emplace_back(std::to_string(number)));
}

/// SCATTER and GATHER: an assignment for each bit.
void rewrite_bits(Checking& c, Statement*& s) {
    const std::string_view name = s->value->standard->name;
    const bool scatters = s->value->standard->rewriting == Rewriting::scatter;
    Expression*& word = s->value->arguments[scatters ? 0 : 1].value;
    Expression*& flags = s->value->arguments[scatters ? 1 : 0].value;
    const Type *bits = check(c, word), *type = check(c, flags);
    if (!bits || !type) return;
    const auto is_bool = [](const Type* t) { return t && t->kind == Kind::boolean; };
    const bool array = type->kind == Kind::array && is_bool(type->element);
    const std::size_t count = array ? type->count() : type->members.size();
    const bool fits = bits->kind == Kind::bits && count == static_cast<std::size_t>(bits->bits) &&
                      (array || std::ranges::all_of(type->members, is_bool, &Variable::type));
    const bool is_word = is_place(word->kind == E::bit ? *word->operands[0] : *word);
    if (!fits || !is_word || !is_place(*flags))
        return void(c.fail(
            code::type_does_not_fit, s->place,
            fmt::format("{} does not go with {} and {}", name, describe(*bits), describe(*type)),
            "it takes a variable or a slice, of BYTE to LWORD, and as many BOOL in an array or a "
            "structure"));
    Block assignments;
    for (std::size_t i = 0; i < count; ++i) {
        Expression* bit = bit_of(c, word, i);
        Expression* flag = array ? make_element(c, flags, type->lower + static_cast<int>(i))
                                 : make_member(c, flags, type->members[i]->text);
        assignments.push_back(
            make_assignment(c, s->place, scatters ? flag : bit, scatters ? bit : flag));
        check_assignment(c, assignments.back());
    }
    s = make_sequence(c, s->place, std::move(assignments));
}

void check_timer(Checking& c, Expression*& timer, std::string_view function) {
    const Type* type = check(c, timer);
    if (!type || is_timer(*type)) return;
    c.fail(code::type_does_not_fit, timer->place,
           fmt::format("{} takes a timer, not {}", function, describe(*type)),
           "timers are instances of TON, TOF, TP and TONR");
}

void preset_timer(Checking& c, Statement*& s) {
    Expression& call = *s->value;
    Expression*& timer = call.arguments[1].value;
    check_timer(c, timer, call.standard->name);
    if (!timer->type) return;
    Block assignments{
        make_assignment(c, s->place, make_member(c, timer, "pt"), call.arguments[0].value)};
    check_assignment(c, assignments.back());
    if (s->place.dialect().has_s7_instructions) {  // it counts for a time that runs, too
        assignments.push_back(make_assignment(c, s->place, make_member(c, timer, "preset"),
                                              make_member(c, timer, "pt")));
        check(c, assignments.back()->target);
        check(c, assignments.back()->value);
    }
    s = make_sequence(c, s->place, std::move(assignments));
}

void check_special(Checking& c, Statement*& s) {
    const StandardFunction& f = *s->value->standard;
    if (f.rewriting == Rewriting::demux) return rewrite_demux(c, s);
    if (!check_count(c, *s->value, f) || !order_arguments(c, s->value, f)) return;
    Expression& call = *s->value;
    call.type = &bool_type;  // which nothing takes
    switch (f.rewriting) {
        case Rewriting::reset_timer:
            return check_timer(c, call.arguments[0].value, f.name);
        case Rewriting::preset_timer:
            return preset_timer(c, s);
        case Rewriting::scatter:
        case Rewriting::gather:
            return rewrite_bits(c, s);
        case Rewriting::scatter_block:
        case Rewriting::gather_block:
            return rewrite_bit_block(c, s);
        case Rewriting::move_block:
        case Rewriting::fill_block:
            return rewrite_block_move(c, s);
        case Rewriting::stays:
        case Rewriting::demux:
            break;
    }
}

/// The routine of that name, or that of an instance.
Routine* named_routine(Checking& c, const Token& name) {
    const Variable* variable = find_variable(c, name);
    if (!variable) return c.find_routine(name);
    return variable->type ? variable->type->routine : nullptr;
}

/// The method that is called, or the routine of the instance: `s.motor`, `motors[i]`, `p^`, a
/// reference.
Routine* reached_routine(Checking& c, Expression*& callee) {
    if (callee->kind == E::member) {
        const Type* of = check(c, callee->operands[0]);
        if (!of) return nullptr;
        if (of->routine)
            if (Routine* method = find_in(of->routine->methods, callee->token.text)) return method;
    }
    const Type* type = check(c, callee);
    return type ? type->routine : nullptr;
}

}  // namespace

bool rewrite(Checking& c, Statement*& s) {
    if ((s->kind != S::assign && s->kind != S::call) || s->value->kind != E::call) return false;
    if (rewrite_new(c, s) || rewrite_delete(c, s) || rewrite_init(c, s)) return true;
    Expression& call = *s->value;
    const Expression& callee = *call.operands[0];
    Routine* routine = callee.kind == E::name ? named_routine(c, callee.token) : nullptr;
    const bool is_reached = callee.kind != E::name || find_variable(c, callee.token);
    if (!routine && is_reached && (find_argument(call, "en") || find_argument(call, "eno")))
        routine = reached_routine(c, call.operands[0]);
    const StandardFunction* special = nullptr;
    if (callee.kind == E::name) {
        const StandardFunction* standard = find_standard_function(callee.token.text);
        const bool is_known = find_variable(c, callee.token) || routine ||
                              block_with_method(c, callee.token) || callee.token.quoted ||
                              callee.token.local;
        if (s->kind == S::call && standard && !is_known && standard->typing == Typing::statement)
            special = standard;
    }
    const auto is_switched = [&](std::string_view name) {
        return find_argument(call, name) && !(routine && declares(*routine, name));
    };
    const bool standard_eno = is_switched("eno") && !routine;
    if (special && !is_switched("en") && !standard_eno) {
        call.standard = special;
        check_special(c, s);
        return true;
    }
    if (!is_switched("en") && !standard_eno) {
        const bool has_bytes = s->place.dialect().has_s7_instructions;
        return has_bytes && routine && rewrite_bytes(c, s, *routine);
    }
    s = if_enabled(c, *s, routine != nullptr);
    check(c, s);
    return true;
}

Variable* enable_flag(Checking& c, const Expression& instance) {
    const bool is_name = c.routine && c.routine->has_instances() && instance.kind == E::name;
    const Variable* of = is_name ? find_variable(c, instance.token) : nullptr;
    if (!of || of->space != Space::frame || of->of != c.routine->pou || !of->type ||
        !of->type->is_instance())
        return nullptr;
    const std::string name = fmt::format("{} ENO", of->text);
    if (Variable* known = find_in(c.routine->names, name)) return known;
    Variable& made =
        c.make_variable(*c.routine, of->name, c.checked.names.emplace_back(name), &bool_type);
    made.initial = make_boolean(c, instance, true);
    c.routine->names.emplace(made.text, &made);
    return &made;
}

Variable& eno_of(Checking& c, Routine& routine) {
    if (Variable* known = find_in(routine.names, "eno")) return *known;
    Variable& variable = c.make_variable(routine, routine.pou->name, "ENO", &bool_type);
    variable.section = Section::temp;
    variable.initial = make_boolean(c, {}, true);
    routine.names.emplace(variable.text, &variable);
    return *(routine.eno = &variable);
}

void share_eno(Checking& c) {
    NameSet asked;
    for (const Routine& routine : c.checked.routines)
        if (routine.eno && routine.owner) asked.emplace(routine.pou->name.text);
    if (asked.empty()) return;
    for (Routine& routine : c.checked.routines)
        if (routine.is_dispatched && routine.owner && asked.contains(routine.pou->name.text))
            eno_of(c, routine).used = true;
}

Block edge_calls(Checking& c, Routine& routine) {
    Block calls;
    for (Variable& variable : routine.variables) {
        if (!variable.edge) continue;
        const Expression like{.token = variable.name, .place = variable.name.place};
        Expression* input = make(c, E::name, like);
        input->type = use(c, input, variable);
        const Token clk{.word = Word::name, .place = input->place, .text = "clk"};
        Expression* call = make_call(c, like, make_name(c, like, variable.edge->text),
                                     {{.name = clk, .value = input}});
        calls.push_back(make_call_statement(c, call));
    }
    return calls;
}

const Type* use_edge(Checking& c, Expression*& e, Variable& input) {
    input.used = true;
    e = make_member(c, make_name(c, *e, input.edge->text), "q");
    return check_member(c, e);
}

}  // namespace lineshaft::st
