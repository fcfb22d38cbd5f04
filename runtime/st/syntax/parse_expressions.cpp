#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "runtime/st/syntax/grammar.hpp"

namespace lineshaft::st {

namespace {

// IEC 61131-3:2013, table 71: what binds as strong, from the weakest on.
constexpr std::initializer_list<Word> operators[] = {
    {Word::or_, Word::or_else_},
    {Word::xor_},
    {Word::and_, Word::ampersand, Word::and_then_},
    {Word::equal, Word::unequal},
    {Word::less, Word::less_or_equal, Word::greater, Word::greater_or_equal},
    {Word::plus, Word::minus},
    {Word::times, Word::divided, Word::mod_},
    {Word::power}};
constexpr int power_binding = std::size(operators);

/// In one statement. Each is looked for in what stands before it.
constexpr int most_assignments = 100;

/// How strong a word binds as an operator; 0: it is none.
constexpr auto bindings = [] {
    std::array<int, 256> made{};
    for (int binding = 1; binding <= power_binding; ++binding)
        for (const Word word : operators[binding - 1])
            made[static_cast<std::size_t>(word)] = binding;
    return made;
}();

/// SCL's DIV is no word of the standard, where it is a function.
Word operator_here(const Cursor& p) {
    const bool divides = p.is(Word::name) && same_name(p.here().place.text(), "div");
    return divides ? Word::divided : p.here().word;
}

/// `AND(a, b)`: of the functions that share their names with operators.
bool at_operator_call(const Cursor& p) {
    return (p.is(Word::and_) || p.is(Word::or_) || p.is(Word::xor_) || p.is(Word::mod_)) &&
           p.next().word == Word::open;
}

/// Variable_Name : ( 'THIS' | 'SUPER' ) '^' ? | Name
///               | 'AND' | 'OR' | 'XOR' | 'MOD'
/// AND and its like are names before a '('. THIS and SUPER are an instance with and without '^'.
/// CODESYS writes a '.' before the Name of a global variable, which is a part of it then.
Expression* parse_name(Parsing& p) {
    if (at_name_behind_point(p)) {
        const Place point = p.take().place;
        Expression* name = p.make(Expression::Kind::name, p.take());
        name->token.text = p.tree.names.emplace_back(fmt::format(".{}", name->token.text));
        name->place = point.to(name->place);
        return name;
    }
    const bool is_own = p.is(Word::super_) || (p.is(Word::name) && p.says("this"));
    Expression* name = p.make(Expression::Kind::name, p.take());
    if (is_own && p.is(Word::caret)) name->place = name->place.to(p.take().place);
    return name;
}

Expression* parse_primary(Parsing& p);

/// Signed_Primary : ( '-' | '+' ) ? Primary_Expr
Expression* parse_signed_primary(Parsing& p) {
    if (!p.is(Word::minus) && !p.is(Word::plus)) return parse_primary(p);
    Expression* made = p.make(Expression::Kind::unary, p.take());
    made->op = made->token.word;
    made->operands[0] = parse_primary(p);
    made->place = made->place.to(made->operands[0]->place);
    return made;
}

/// Type_Name : ( Name '.' ) * Type_Prefix
Token parse_type_name(Parsing& p) {
    if (p.is(Word::prefix)) return p.take();
    const Token first = p.here();
    std::string text;
    for (; !p.is(Word::prefix); p.take()) text += p.is(Word::dot) ? "." : p.here().text;
    text += p.here().text;
    Token name = p.take();
    name.place = first.place.to(name.place);
    name.text = p.tree.names.emplace_back(std::move(text));
    return name;
}

/// Typed_Literal : Type_Name '#' ( Duration | Signed_Primary )
Expression* parse_typed_literal(Parsing& p) {
    const Token prefix = parse_type_name(p);
    if (p.is(Word::duration)) {
        Expression* time = p.make(Expression::Kind::constant, p.take());
        time->place = prefix.place.to(time->place);
        return time;
    }
    Expression* typed = p.make(Expression::Kind::typed, prefix);
    Expression* value = parse_signed_primary(p);
    typed->operands[0] = value;
    typed->place = typed->place.to(value->place);
    return typed;
}

/// In_Parentheses : '(' Assigned ')'
Expression* parse_in_parentheses(Parsing& p) {
    p.take();
    Expression* inner = parse_assigned(p);
    expect(p, Word::close);
    return inner;
}

/// Primary_Expr : Unsigned_Int | Real | Text | Typed_Literal | In_Parentheses | Variable_Name
///              | Array_Init
/// The checker refuses an Array_Init here.
Expression* parse_primary(Parsing& p) {
    const Level level(p);
    if (!p.panic) {
        switch (p.here().word) {
            case Word::integer:
            case Word::real:
            case Word::text:
                return p.make(Expression::Kind::constant, p.take());
            case Word::prefix:
                return parse_typed_literal(p);
            case Word::open_bracket:
                return parse_initial(p);
            case Word::open:
                return parse_in_parentheses(p);
            default:
                if (p.at_qualified_prefix()) return parse_typed_literal(p);
                if (p.is(Word::direct)) return p.make(Expression::Kind::name, p.take());
                if (p.is_name() || at_operator_call(p) || at_name_behind_point(p))
                    return parse_name(p);
        }
    }
    expected(p, "a value");
    return p.make(Expression::Kind::constant, p.here());
}

/// Member : Name | Direct | Unsigned_Int
Expression* parse_member(Parsing& p, Expression* of) {
    const bool is_bit = p.is(Word::direct) || p.is(Word::integer);
    const bool is_part = is_bit || p.is(Word::name);
    if (!is_part) expected(p, "a name", "after '.'");
    Expression* member = p.make(is_bit ? Expression::Kind::bit : Expression::Kind::member,
                                is_part ? p.take() : p.here());
    p.add_operand(*member, 0, of);
    return member;
}

Expression* parse_binary(Parsing& p, int binding);

/// Unary_Expr : ( '-' | '+' | 'NOT' ) Unary_Expr | Variable_Access
/// Where a sign does not precede a power:
/// Unary_Expr : ( '-' | '+' ) Power_Expr | 'NOT' Unary_Expr | Variable_Access
Expression* parse_unary(Parsing& p) {
    if (!p.is(Word::minus) && !p.is(Word::plus) && !p.is(Word::not_)) return parse_access(p);
    const Level level(p);
    Expression* made = p.make(Expression::Kind::unary, p.take());
    made->op = made->token.word;
    const bool precedes = made->op == Word::not_ || p.source->dialect.sign_precedes_power;
    Expression* operand = precedes ? parse_unary(p) : parse_binary(p, power_binding);
    made->operands[0] = operand;
    made->place = made->place.to(operand->place);
    p.grow(*made, *operand);
    return made;
}

/// Xor_Expr : And_Expr ( 'XOR' And_Expr ) *
/// And_Expr : Compare_Expr ( ( 'AND' | '&' | '&&' | 'AND_THEN' ) Compare_Expr ) *
/// Compare_Expr : Equ_Expr ( ( '=' | '<>' ) Equ_Expr ) *
/// Equ_Expr : Add_Expr ( ( '<' | '>' | '<=' | '>=' ) Add_Expr ) *
/// Add_Expr : Term ( ( '+' | '-' ) Term ) *
/// Term : Power_Expr ( ( '*' | '/' | 'DIV' | 'MOD' ) Power_Expr ) *
/// Power_Expr : Unary_Expr ( '**' Unary_Expr ) *
/// With operators that bind as strong as `binding` or stronger.
Expression* parse_binary(Parsing& p, int binding) {
    Expression* left = parse_unary(p);
    for (;;) {
        const Word op = operator_here(p);
        const int binds = bindings[static_cast<std::size_t>(op)];
        if (p.panic || binds < binding) return left;
        Expression* made = p.make(Expression::Kind::binary, p.take());
        made->op = op == Word::ampersand ? Word::and_ : op;
        const bool is_always_done = op != Word::and_then_ && op != Word::or_else_;
        const KeepBefore kept(p, is_always_done);
        p.add_operand(*made, 0, left);
        p.add_operand(*made, 1, parse_binary(p, binds + 1));
        left = made;
    }
}

/// `SIZEOF(ARRAY[0..3] OF INT)`, `__NEW(INT)`: the function takes a type.
bool takes_type(const Parsing& p, const Expression& function) {
    const auto is = [&](std::string_view name) { return same_name(function.token.text, name); };
    const auto follows = [&](std::string_view word) { return same_name(p.next().text, word); };
    if (function.kind != Expression::Kind::name) return false;
    const bool is_to = p.next(2).word == Word::to_;
    const bool has_length = p.next(2).word == Word::open || p.next(2).word == Word::open_bracket;
    const bool is_written = p.next().word == Word::array_ || (follows("pointer") && is_to) ||
                            (follows("reference") && is_to) ||
                            ((follows("string") || follows("wstring")) && has_length);
    return is("__new") || (is_written && (is("sizeof") || is("xsizeof")));
}

/// The token belongs to an assignment that is done before the statement.
bool is_done_before(const Parsing& p, const Token& token) {
    const auto first = p.tokens[p.targets.front()].place.begin;
    for (auto it = p.before->rbegin(); it != p.before->rend() && (*it)->place.begin >= first; ++it)
        if ((*it)->place.begin <= token.place.begin && token.place.begin < (*it)->place.end)
            return true;
    return false;
}

/// What stands before the target in the statement is done after the assignment: it must neither
/// name what is assigned, nor have called something.
bool comes_too_late(const Parsing& p, std::size_t target) {
    std::vector<bool> calls;
    for (std::size_t i = p.targets.front(); i < target; ++i) {
        const Token& token = p.tokens[i];
        const Word last = i == 0 ? Word::end_of_file : p.tokens[i - 1].word;
        const bool is_part = last == Word::dot;
        const bool is_open = std::ranges::find(p.targets, i) != p.targets.end();
        if (!is_open && !is_part && same_name(token.text, p.tokens[target].text)) return true;
        if (token.word == Word::open) {
            calls.push_back(is_name(last) || last == Word::caret || last == Word::close_bracket);
        } else if (token.word == Word::close && !calls.empty()) {
            if (calls.back() && !is_done_before(p, token)) return true;
            calls.pop_back();
        }
    }
    return false;
}

}  // namespace

bool at_name_behind_point(const Parsing& p) {
    return p.is(Word::dot) && p.is_name(1) && p.source->dialect.is_loose;
}

/// Expression : Xor_Expr ( ( 'OR' | 'OR_ELSE' ) Xor_Expr ) *
Expression* parse_expression(Parsing& p) {
    return parse_binary(p, 1);
}

/// Assigned : Expression ( ':=' Assigned ) ?
/// CODESYS: what is assigned is the value. It is assigned before the statement, and read there.
Expression* parse_assigned(Parsing& p) {
    const std::size_t start = p.at;
    Expression* value = parse_expression(p);
    if (p.panic || !p.is(Word::assign)) return value;
    if (!p.before || !p.source->dialect.is_loose || comes_too_late(p, start))
        return refuse_assignment(p), value;
    if (++p.assigned > most_assignments)
        return fail(p, code::not_supported, p.here().place,
                    fmt::format("a statement has at most {} assignments", most_assignments),
                    "assign them in statements of their own"),
               value;
    Statement* assignment = p.make(Statement::Kind::assign, p.take());
    assignment->target = value;
    p.targets.push_back(start);
    assignment->value = parse_assigned(p);
    p.targets.pop_back();
    assignment->place = value->place.to(p.last().place);
    p.before->push_back(assignment);
    const std::size_t behind = std::exchange(p.at, start), done = p.before->size();
    value = parse_access(p);
    p.before->resize(done);  // what stands in it was assigned
    p.at = behind;
    return value;
}

/// Of_Type : Name '(' Data_Type ( ',' Expression ) ? ')'
Expression* parse_of_type(Parsing& p, Expression* name) {
    Expression* call = p.make(Expression::Kind::call, p.take());
    call->of = parse_type(p);
    if (p.accept(Word::comma)) call->arguments.push_back({.value = parse_expression(p)});
    expect(p, Word::close);
    p.add_operand(*call, 0, name);
    call->place = name->place.to(p.last().place);
    return call;
}

/// Variable_Access : ( Primary_Expr | Of_Type )
///                   ( '(' Params ')' | '[' Subscripts ']' | '.' Member | '^' ) *
/// Subscripts : Param_Assign ( ',' Param_Assign ) *
/// Their values are expressions; those of a declaration may be structures: `[COUNT((x := 1))]`.
Expression* parse_access(Parsing& p) {
    Expression* left = parse_primary(p);
    while (!p.panic) {
        if (p.is(Word::open) && takes_type(p, *left)) {
            left = parse_of_type(p, left);
        } else if (p.is(Word::open)) {
            const bool is_initial =
                !p.before && p.next().word == Word::open && p.at_argument_name(2);
            Expression* call = p.make(Expression::Kind::call, p.take());
            parse_arguments(p, *call, Word::close, is_initial ? parse_initial : parse_expression);
            p.add_operand(*call, 0, left);
            left = call;
        } else if (p.is(Word::open_bracket)) {
            Expression* index = p.make(Expression::Kind::index, p.take());
            if (p.is(Word::close_bracket)) expected(p, "an index", "after '['");
            parse_arguments(p, *index, Word::close_bracket, parse_expression);
            p.add_operand(*index, 0, left);
            left = index;
        } else if (p.is(Word::caret) && !at_power(p)) {
            Expression* target = p.make(Expression::Kind::deref, p.take());
            p.add_operand(*target, 0, left);
            left = target;
        } else if (p.accept(Word::dot)) {
            left = parse_member(p, left);
        } else {
            break;
        }
    }
    return left;
}

}  // namespace lineshaft::st
