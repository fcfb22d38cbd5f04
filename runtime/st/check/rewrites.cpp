#include "runtime/st/check/rewrites.hpp"

#include <algorithm>

#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/places.hpp"
#include "runtime/st/check/standard_calls.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/check/test_statements.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/syntax/literals.hpp"

namespace lineshaft::st {

namespace {

Argument* find_argument(Expression& call, std::string_view name) {
    const auto it = std::ranges::find_if(
        call.arguments, [&](const Argument& a) { return same_name(a.name.text, name); });
    return it == call.arguments.end() ? nullptr : &*it;
}

bool is_timer(const Type& type) {
    if (type.kind == Kind::block)
        return type.name == "TONR" && type.routine->pou->place.source->is_prelude();
    return type.kind == Kind::standard &&
           std::ranges::any_of(type.members, [](const Variable* m) { return m->text == "pt"; });
}

/// `0` to `63`, which tokens refer to.
std::string_view number_text(std::size_t number) {
    static const auto texts = [] {
        std::vector<std::string> made;
        for (int i = 0; i < 64; ++i) made.push_back(std::to_string(i));
        return made;
    }();
    return texts[number];
}

/// `y := f(EN := go, a := x, ENO => ok);` is an IF around `y := f(a := x, ENO => ok);`
void rewrite_enabled(Checking& c, Statement& s, bool has_eno) {
    Expression& call = *s.value;
    const auto constant = [&](bool value) {
        Expression* made = make(c, E::constant, call);
        become_boolean(*made, value);
        return made;
    };
    const auto assigned = [&](Expression* target, bool value) {
        Statement& made = c.tree.statements.emplace_back();
        made.place = s.place;
        made.target = target;
        made.value = constant(value);
        return &made;
    };
    const Argument* enable = find_argument(call, "en");
    const Argument* enabled = find_argument(call, "eno");
    Branch branch;
    branch.condition = enable ? enable->value : constant(true);
    Expression* eno = enabled ? enabled->value : nullptr;
    std::erase_if(call.arguments, [&](const Argument& a) {
        return same_name(a.name.text, "en") || (!has_eno && same_name(a.name.text, "eno"));
    });
    branch.body.push_back(&c.tree.statements.emplace_back(s));
    if (eno && !has_eno) branch.body.push_back(assigned(eno, true));
    s.kind = S::if_;
    s.target = s.value = nullptr;
    if (eno) s.body.push_back(assigned(eno, false));
    s.branches.push_back(std::move(branch));
}

/// SCATTER and GATHER: an assignment for each bit.
void rewrite_bits(Checking& c, Statement& s, bool scatters) {
    const std::string_view name = scatters ? "SCATTER" : "GATHER";
    Expression* word = s.value->arguments[scatters ? 0 : 1].value;
    Expression* flags = s.value->arguments[scatters ? 1 : 0].value;
    const Type *bits = check(c, *word), *type = check(c, *flags);
    if (!bits || !type) return;
    const auto is_bool = [](const Type* t) { return t && t->kind == Kind::boolean; };
    const bool array = type->kind == Kind::array && is_bool(type->element);
    const std::size_t count =
        array ? static_cast<std::size_t>(type->upper - type->lower + 1) : type->members.size();
    const bool fits = bits->kind == Kind::bits && count == static_cast<std::size_t>(bits->bits) &&
                      (array || std::ranges::all_of(type->members, is_bool, &Variable::type));
    const auto is_place = [](const Expression& e) {
        return e.kind == E::name || e.kind == E::member || e.kind == E::index;
    };
    if (!fits || !is_place(*word) || !is_place(*flags)) {
        c.fail("L0905", s.place,
               fmt::format("{} does not go with {} and {}", name, describe(*bits), describe(*type)),
               "it takes a variable of BYTE to LWORD, and as many BOOL in an array or a structure");
        return;
    }
    s.kind = S::if_;
    s.value = nullptr;
    for (std::size_t i = 0; i < count; ++i) {
        Expression* bit = make(c, E::bit, *word);
        bit->token.word = Word::integer;
        bit->token.text = number_text(i);
        bit->operands[0] = word;
        Expression* flag = make(c, array ? E::index : E::member, *flags);
        flag->operands[0] = flags;
        if (array) {
            Expression* index = make(c, E::constant, *flags);
            become(*index, lint_type, {.integer = type->lower + static_cast<Wide>(i)});
            flag->arguments.push_back({{}, false, index, nullptr});
        } else {
            flag->token.text = type->members[i]->text;
        }
        Statement& one = c.tree.statements.emplace_back();
        one.place = s.place;
        one.target = scatters ? flag : bit;
        one.value = scatters ? bit : flag;
        check_assignment(c, one);
        s.body.push_back(&one);
    }
}

void check_timer(Checking& c, Expression& timer, std::string_view function) {
    const Type* type = check(c, timer);
    if (!type || is_timer(*type)) return;
    c.fail("L0905", timer.place, fmt::format("{} takes a timer, not {}", function, describe(*type)),
           "timers are instances of TON, TOF, TP and TONR");
}

void check_special(Checking& c, Statement& s) {
    Expression& call = *s.value;
    const StandardFunction& f = *call.standard;
    if (!check_count(c, call, f) || !order_arguments(c, call, f)) return;
    call.type = &bool_type;  // which nothing takes
    if (f.least == 1) return check_timer(c, *call.arguments[0].value, f.name);
    if (f.name == "SCATTER" || f.name == "GATHER") return rewrite_bits(c, s, f.name == "SCATTER");
    Expression& timer = *call.arguments[1].value;
    check_timer(c, timer, f.name);
    if (!timer.type) return;
    s.kind = S::assign;
    s.target = make(c, E::member, timer);
    s.target->token.text = "pt";
    s.target->operands[0] = &timer;
    s.value = call.arguments[0].value;
    check_assignment(c, s);
}

}  // namespace

bool rewrite(Checking& c, Statement& s) {
    if ((s.kind != S::assign && s.kind != S::call) || s.value->kind != E::call) return false;
    Expression& call = *s.value;
    const Expression& callee = *call.operands[0];
    const Routine* routine = nullptr;
    if (callee.kind == E::name) {
        const Variable* variable = find_variable(c, callee.token);
        routine = c.find_routine(callee.token);
        if (variable && variable->type) routine = variable->type->routine;
        const StandardFunction* standard = find_standard_function(callee.token.text);
        const bool is_known = variable || routine || callee.token.quoted || callee.token.local;
        if (s.kind == S::call && standard && !is_known && standard->typing == Typing::statement) {
            call.standard = standard;
            check_special(c, s);
            return true;
        }
    }
    const auto is_switched = [&](std::string_view name) {
        return find_argument(call, name) && !(routine && routine->names.contains(name));
    };
    const bool standard_eno = is_switched("eno") && !routine;
    if (!is_switched("en") && !standard_eno) return false;
    rewrite_enabled(c, s, routine != nullptr);
    check(c, s);
    return true;
}

Variable& eno_of(Checking& c, Routine& routine) {
    if (const auto it = routine.names.find("eno"); it != routine.names.end()) return *it->second;
    Variable& variable = routine.variables.emplace_back();
    variable.text = "ENO";
    variable.name = routine.pou->name;
    variable.type = &bool_type;
    variable.section = Section::temp;
    variable.of = routine.pou;
    variable.used = true;
    Expression& initial = c.tree.expressions.emplace_back();
    become_boolean(initial, true);
    variable.initial = &initial;
    routine.names.emplace(variable.text, &variable);
    return variable;
}

void call_edges(Checking& c, Routine& routine) {
    Block calls;
    for (Variable& variable : routine.variables) {
        if (!variable.edge) continue;
        Expression* input = &c.tree.expressions.emplace_back();
        input->kind = E::name;
        input->token = variable.name;
        input->place = variable.name.place;
        input->type = use(c, *input, variable);
        Statement& statement = c.tree.statements.emplace_back();
        statement.kind = S::call;
        statement.place = input->place;
        statement.value = make(c, E::call, *input);
        statement.value->operands[0] = make(c, E::name, *input);
        statement.value->operands[0]->token.text = variable.edge->text;
        const Token clk{.word = Word::name, .place = input->place, .text = "clk"};
        statement.value->arguments.push_back({.name = clk, .value = input});
        calls.push_back(&statement);
    }
    Block& body = const_cast<Pou*>(routine.pou)->body;
    body.insert(body.begin(), calls.begin(), calls.end());
}

const Type* use_edge(Checking& c, Expression& e, Variable& input) {
    input.used = true;
    e.operands[0] = make(c, E::name, e);
    e.operands[0]->token.text = input.edge->text;
    e.kind = E::member;
    e.token.text = "q";
    return check_member(c, e);
}

}  // namespace lineshaft::st
