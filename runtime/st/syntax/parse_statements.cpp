#include <utility>

#include "runtime/st/syntax/grammar.hpp"

namespace lineshaft::st {

namespace {

bool is_assignment(Word op) {
    return (op >= Word::assign && op <= Word::divided_assign) || op == Word::reference_assign ||
           op == Word::attempt_assign;
}

/// Assign_Stmt : Variable_Access ( Assign_Op Init ) + ';'
/// Assign_Op : ':=' | '+=' | '-=' | '*=' | '/=' | 'REF=' | '?='
/// `a := b := 0;` is `b := 0; a := b;`, whose two `b` are read each. In CODESYS a value is no list.
void parse_assignment(Parsing& p, Expression* target, Block& to) {
    const Level level(p);
    Statement* statement = p.make(Statement::Kind::assign, p.here());
    statement->op = p.take().word;
    statement->target = target;
    const auto parse_value = p.source->dialect.is_loose ? parse_expression : parse_initial;
    const std::size_t before = p.at;
    statement->value = parse_value(p);
    statement->place = target->place.to(p.last().place);
    if (p.panic || !is_assignment(p.here().word)) {
        end_statement(p);
    } else {
        Expression* inner = statement->value;
        p.at = before;
        const std::size_t done = to.size();
        statement->value = parse_value(p);
        to.resize(done);  // what stands in it was assigned
        parse_assignment(p, inner, to);
    }
    to.push_back(statement);
}

/// Latch_Stmt : ( Variable_Access ( 'S=' | 'R=' ) ) + Expression ';'
/// `lamp S= off R= start;` is `IF start THEN lamp := TRUE; off := FALSE; END_IF`.
void parse_latch(Parsing& p, Expression* target, Block& to) {
    Statement* statement = p.make(Statement::Kind::if_, p.here());
    Branch& branch = statement->branches.emplace_back();
    branch.condition = target;
    do {
        const Token op = p.take();
        Statement* latched = p.make(Statement::Kind::assign, op);
        latched->target = branch.condition;
        latched->value = p.make(Expression::Kind::name, op);
        latched->value->token.text = op.word == Word::set_assign ? "true" : "false";
        branch.condition = parse_expression(p);
        latched->place = statement->place = target->place.to(p.last().place);
        branch.body.push_back(latched);
    } while (!p.panic && (p.is(Word::set_assign) || p.is(Word::reset_assign)));
    to.push_back(statement);
    end_statement(p);
}

/// Access_Stmt : Variable_Access 'ACCESS' Expression ';'
/// B&R has it: `r ACCESS ADR(x);` is `r REF= ADR(x);`.
void parse_access_statement(Parsing& p, Expression* target, Block& to) {
    Statement* statement = p.make(Statement::Kind::assign, p.take());
    statement->op = Word::reference_assign;
    statement->target = target;
    statement->value = parse_expression(p);
    statement->place = target->place.to(p.last().place);
    to.push_back(statement);
    end_statement(p);
}

/// A part of Invocation: a value alone names an action, `a;`, or is a mistake.
void parse_value_alone(Parsing& p, Expression* value, Block& to) {
    using Kind = Expression::Kind;
    const bool is_place = value->kind == Kind::name || value->kind == Kind::member ||
                          value->kind == Kind::index || value->kind == Kind::bit;
    if (!is_place || !p.is(Word::semicolon)) return refuse_value(p, *value);
    to.push_back(p.make(Statement::Kind::action, value));
    p.take();
}

/// SCL has `x * = 2;` for `x *= 2;`.
void join_assignment(Parsing& p) {
    static constexpr std::pair<Word, Word> all[] = {{Word::plus, Word::plus_assign},
                                                    {Word::minus, Word::minus_assign},
                                                    {Word::times, Word::times_assign},
                                                    {Word::divided, Word::divided_assign}};
    for (const auto& [sign, joined] : all)
        if (p.is(sign) && p.next().word == Word::equal) {
            p.take();
            p.tokens[p.at].word = joined;
            return;
        }
}

/// Simple_Stmt : Assign_Stmt | Latch_Stmt | Access_Stmt | Invocation
/// Invocation : Variable_Access ';'
/// It begins with a Name; an Invocation ends with the ')' of a call, or names an action.
void parse_simple(Parsing& p, Block& to) {
    if (refuse_other_language(p)) return;
    if (!p.is_name() && !p.is(Word::direct) && !at_name_behind_point(p))
        return expected(p, "a statement");
    if (p.is_in_test && p.at_test_statement()) return parse_test_statement(p, to);
    Expression* target = parse_access(p);
    if (p.panic) return;
    join_assignment(p);
    const Word op = p.here().word;
    if (is_assignment(op)) return parse_assignment(p, target, to);
    if (op == Word::set_assign || op == Word::reset_assign) return parse_latch(p, target, to);
    if (op == Word::equal) return refuse_comparison(p);
    if (p.is(Word::name) && p.says("access") && (p.is_name(1) || p.next().word == Word::open))
        return parse_access_statement(p, target, to);
    if (target->kind != Expression::Kind::call) return parse_value_alone(p, target, to);
    to.push_back(p.make(Statement::Kind::call, target));
    end_statement(p);
}

/// A part of IF_Stmt, Case_Stmt and While_Stmt: a condition or selector, and the word behind it.
Expression* parse_condition(Parsing& p, Word end, std::string_view where) {
    Expression* condition = parse_assigned(p);
    if (p.panic || expect(p, end, where)) return condition;
    p.panic = false;
    if (p.is(Word::then_) || p.is(Word::do_) || p.is(Word::of_)) p.take();
    return condition;
}

/// A part of IF_Stmt: the condition of an ELSIF. What it assigns is assigned where those above are
/// not fulfilled, so it is the IF of an ELSE then, which it makes the one at hand.
void parse_else_if(Parsing& p, Statement*& at_hand) {
    Block assigned;
    p.before = &assigned;
    p.targets.assign(1, p.at);
    const Token first = p.here();
    Branch branch;
    branch.condition = parse_condition(p, Word::then_, "after the condition");
    if (!assigned.empty()) {
        at_hand->body = std::move(assigned);
        at_hand->body.push_back(p.make(Statement::Kind::if_, first));
        at_hand = at_hand->body.back();
    }
    at_hand->branches.push_back(std::move(branch));
}

/// IF_Stmt : 'IF' Assigned 'THEN' Stmt_List ( 'ELSIF' Assigned 'THEN' Stmt_List ) *
///           ( 'ELSE' Stmt_List ) ? 'END_IF'
void parse_if(Parsing& p, Statement& statement) {
    const Token opener = p.take();
    const std::size_t else_ifs = p.else_ifs.size();
    Statement* at_hand = &statement;
    statement.branches.emplace_back().condition =
        parse_condition(p, Word::then_, "after the condition");
    for (;;) {
        if (p.panic) skip_to_statement(p);
        parse_statements(p, at_hand->branches.back().body, Word::end_if_);
        if (!p.accept(Word::elsif_)) break;
        parse_else_if(p, at_hand);
    }
    if (p.is(Word::else_)) {
        const Token word = p.take();
        if (p.is(Word::if_) && !p.here().first_in_line)
            p.else_ifs.push_back(word.place.to(p.here().place));
        parse_statements(p, at_hand->body, Word::end_if_);
    }
    close(p, Word::end_if_, opener);
    p.else_ifs.resize(else_ifs);
}

/// Case_Selection : Case_List ':' Stmt_List
/// Case_List : Case_List_Elem ( ',' Case_List_Elem ) *
/// Case_List_Elem : Expression ( '..' Expression ) ?
Branch parse_selection(Parsing& p) {
    Branch branch;
    do {
        Expression* from = parse_expression(p);
        Expression* to = p.accept(Word::range) ? parse_expression(p) : nullptr;
        branch.labels.emplace_back(from, to);
    } while (p.accept(Word::comma));
    expect(p, Word::colon, "after the values");
    if (p.panic) skip_to_statement(p);
    parse_statements(p, branch.body, Word::end_case_, true);
    return branch;
}

/// Case_Stmt : 'CASE' Assigned 'OF' Case_Selection * ( 'ELSE' ':' ? Stmt_List ) ? 'END_CASE'
void parse_case(Parsing& p, Statement& statement) {
    const Token opener = p.take();
    statement.value = parse_condition(p, Word::of_, "after the selector");
    if (p.panic) skip_to_statement(p);
    ++p.cases;
    const auto at_first = [&] { return statement.branches.empty() && p.is(Word::name); };
    while (!p.panic && (p.at_label() || at_first()))
        statement.branches.push_back(parse_selection(p));
    --p.cases;
    if (p.accept(Word::else_)) {
        p.accept(Word::colon);
        parse_statements(p, statement.body, Word::end_case_);
    }
    close(p, Word::end_case_, opener);
}

/// For_Stmt : 'FOR' Variable_Access ':=' For_List 'DO' Stmt_List 'END_FOR'
/// For_List : Expression 'TO' Expression ( 'BY' Expression ) ?
void parse_for(Parsing& p, Statement& statement) {
    const Token opener = p.take();
    statement.target = parse_access(p);
    expect(p, Word::assign, "after the loop's variable");
    statement.value = parse_expression(p);
    expect(p, Word::to_, "after the first value");
    statement.limit = parse_expression(p);
    if (p.accept(Word::by_)) statement.step = parse_expression(p);
    expect(p, Word::do_, "after the last value");
    if (p.panic) skip_to_statement(p);
    parse_statements(p, statement.body, Word::end_for_);
    close(p, Word::end_for_, opener);
}

/// While_Stmt : 'WHILE' Expression 'DO' Stmt_List 'END_WHILE'
void parse_while(Parsing& p, Statement& statement) {
    const Token opener = p.take();
    p.before = nullptr;
    statement.value = parse_condition(p, Word::do_, "after the condition");
    if (p.panic) skip_to_statement(p);
    parse_statements(p, statement.body, Word::end_while_);
    close(p, Word::end_while_, opener);
}

/// Repeat_Stmt : 'REPEAT' Stmt_List 'UNTIL' Expression ';' ? 'END_REPEAT'
void parse_repeat(Parsing& p, Statement& statement) {
    const Token opener = p.take();
    parse_statements(p, statement.body, Word::until_);
    if (close(p, Word::until_, opener)) {
        statement.value = parse_assigned(p);
        p.accept(Word::semicolon);
    }
    if (p.panic) skip_to_statement(p);
    close(p, Word::end_repeat_, opener);
}

/// Try_Stmt : '__TRY' Stmt_List '__CATCH' ( '(' Variable_Access ')' ) ? Stmt_List
///            ( '__FINALLY' Stmt_List ) ? '__ENDTRY'
void parse_try(Parsing& p, Statement& statement) {
    const Token opener = p.take();
    statement.branches.resize(2);
    parse_statements(p, statement.body, Word::endtry_);
    if (expect(p, Word::catch_) && p.accept(Word::open)) {
        statement.target = parse_access(p);
        expect(p, Word::close);
        if (p.panic) skip_to_statement(p);
    }
    if (p.is(Word::endtry_) || p.is(Word::finally_)) p.panic = false;
    parse_statements(p, statement.branches[0].body, Word::endtry_);
    if (p.accept(Word::finally_)) parse_statements(p, statement.branches[1].body, Word::endtry_);
    close(p, Word::endtry_, opener);
}

/// In the line of a word that has none.
bool begins_value(const Parsing& p) {
    if (p.panic || p.here().first_in_line) return false;
    const Word word = p.here().word;
    return p.is_name() || word == Word::open || word == Word::minus || word == Word::not_ ||
           (word >= Word::prefix && word <= Word::direct);
}

/// Jump_Stmt : ( 'EXIT' | 'CONTINUE' | 'RETURN' ) ';'
/// `RETURN(n > 0);` of CODESYS leaves if that holds, `RETURN n > 0;` of SCL is `ENO := n > 0;
/// RETURN;`.
void parse_jump(Parsing& p, Statement::Kind kind, Block& to) {
    const Token word = p.take();
    Statement* jump = p.make(kind, word);
    const bool gives_eno = p.source->dialect.return_gives_eno;
    if (kind == Statement::Kind::return_ && gives_eno && !p.is(Word::semicolon)) {
        Statement* told = p.make(Statement::Kind::assign, word);
        told->target = p.make(Expression::Kind::name, word);
        told->target->token.text = "ENO";
        told->value = parse_expression(p);
        to.push_back(told);
    }
    if (kind == Statement::Kind::return_ && p.source->dialect.is_loose && p.is(Word::open)) {
        Statement* test = p.make(Statement::Kind::if_, p.take());
        Branch& branch = test->branches.emplace_back();
        branch.condition = parse_assigned(p);
        branch.body = {jump};
        jump = test;
        expect(p, Word::close);
    }
    if (kind == Statement::Kind::return_ && begins_value(p)) return refuse_returned(p);
    to.push_back(jump);
    end_statement(p);
}

/// Within a CASE what stands in a line is one of its values.
bool at_goto_label(const Parsing& p) {
    const Token& behind = p.next(2);
    return p.is(Word::name) && (p.here().first_in_line || p.cases == 0) &&
           p.next().word == Word::colon &&
           (behind.first_in_line || behind.word == Word::semicolon || is_name(behind.word));
}

/// Goto_Stmt : ( 'GOTO' | 'JMP' ) Name ';'
/// Label : Name ':'
/// CODESYS says JMP.
void parse_goto(Parsing& p, Statement::Kind kind, Block& to) {
    if (kind == Statement::Kind::goto_) p.take();
    Statement* statement = p.make(kind, p.here());
    statement->value = p.make(Expression::Kind::name, expect_name(p, "a label"));
    to.push_back(statement);
    if (kind == Statement::Kind::goto_)
        end_statement(p);
    else
        p.take();
}

/// Region : ( 'REGION' | 'END_REGION' | 'NETWORK' | 'END_NETWORK' ) ';' ?
/// The lexer leaves a region's title out.
void parse_region(Parsing& p) {
    const Token word = p.take();
    if (word.word == Word::region_) p.regions.push_back(word);
    if (word.word == Word::end_region_ && !p.regions.empty()) p.regions.pop_back();
    p.accept(Word::semicolon);
}

/// A part of Stmt: a loop without its condition, which was told, is left out.
void parse_structured(Parsing& p, Statement::Kind kind, Block& to,
                      void (*read)(Parsing&, Statement&)) {
    Statement* statement = p.make(kind, p.here());
    read(p, *statement);
    if (statement->value || kind != Statement::Kind::repeat) to.push_back(statement);
    p.accept(Word::semicolon);
}

/// A variable called Network, which is written or called.
bool at_variable_network(const Parsing& p) {
    using enum Word;
    static constexpr Word behind[] = {assign, plus_assign,  minus_assign, set_assign, reset_assign,
                                      open,   open_bracket, dot,          caret};
    return !p.next().first_in_line && std::ranges::find(behind, p.next().word) != std::end(behind);
}

/// Stmt : ';' | Region
///      | ( IF_Stmt | Case_Stmt | For_Stmt | While_Stmt | Repeat_Stmt | Try_Stmt ) ';' ?
///      | Jump_Stmt | Goto_Stmt | Label | Simple_Stmt | Test_Stmt
void parse_statement(Parsing& p, Block& to) {
    const Level level(p);
    if (p.panic) return;
    p.before = &to;
    p.targets.assign(1, p.at);
    p.assigned = 0;
    using Kind = Statement::Kind;
    switch (p.here().word) {
        case Word::semicolon:
            return void(p.take());
        case Word::network_:
            return at_variable_network(p) ? parse_simple(p, to) : parse_region(p);
        case Word::region_:
        case Word::end_region_:
        case Word::end_network_:
            return parse_region(p);
        case Word::exit_:
            return parse_jump(p, Kind::exit, to);
        case Word::continue_:
            return parse_jump(p, Kind::continue_, to);
        case Word::return_:
            return parse_jump(p, Kind::return_, to);
        case Word::goto_:
            return parse_goto(p, Kind::goto_, to);
        case Word::if_:
            return parse_structured(p, Kind::if_, to, parse_if);
        case Word::case_:
            return parse_structured(p, Kind::case_, to, parse_case);
        case Word::for_:
            return parse_structured(p, Kind::for_, to, parse_for);
        case Word::while_:
            return parse_structured(p, Kind::while_, to, parse_while);
        case Word::repeat_:
            return parse_structured(p, Kind::repeat, to, parse_repeat);
        case Word::try_:
            return parse_structured(p, Kind::try_, to, parse_try);
        default:
            if (p.says("jmp") && p.is_name(1) && p.next(2).word == Word::semicolon)
                return parse_goto(p, Kind::goto_, to);
            if (at_goto_label(p)) return parse_goto(p, Kind::label, to);
            return parse_simple(p, to);
    }
}

/// The name stands before a ':' or ',' or behind ACTION, METHOD or FUNCTION somewhere.
bool is_declared_somewhere(const Parsing& p, std::string_view name) {
    for (std::size_t i = 1; i + 1 < p.tokens.size(); ++i) {
        if (p.tokens[i].word != Word::name || !same_name(p.tokens[i].text, name)) continue;
        const Word before = p.tokens[i - 1].word, behind = p.tokens[i + 1].word;
        if (before == Word::action_ || before == Word::method_ || before == Word::function_ ||
            behind == Word::colon || behind == Word::comma)
            return true;
    }
    return false;
}

/// A name that is not declared is meant as a word, one that ends with ';' as one that may.
bool respell_statement(Parsing& p) {
    using enum Word;
    static constexpr Word alone[] = {exit_,       return_,       continue_,           end_if_,
                                     end_case_,   end_for_,      end_while_,          end_repeat_,
                                     end_region_, end_function_, end_function_block_, end_program_,
                                     end_method_};
    if (p.next().word != semicolon) return respell(p, statement_words);
    return !is_declared_somewhere(p, p.here().text) && respell(p, alone);
}

}  // namespace

/// Stmt_List : Stmt *
/// One with a mistake is left out.
void parse_statements(Parsing& p, Block& to, Word end, bool in_case) {
    while (!p.panic && !p.is(end) && !at_end_of_statements(p) &&
           !(in_case ? p.at_label() : at_label_of_case(p))) {
        if (p.at_chart() || p.at_end_of_step()) break;
        if (at_doomed_name(p) && !p.at_test_statement() && respell_statement(p)) continue;
        const std::size_t before = p.at, statements = to.size();
        parse_statement(p, to);
        if (p.panic) {
            to.resize(statements);
            skip_to_statement(p);
        }
        if (p.at == before) p.take();
    }
    p.before = nullptr;
}

}  // namespace lineshaft::st
