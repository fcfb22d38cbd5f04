#include <utility>

#include "runtime/st/syntax/grammar.hpp"

namespace lineshaft::st {

namespace {

Pou& fixture_of(Parsing& p, const Token& first) {
    if (p.fixture) return *p.fixture;
    p.fixture = &p.tree.pous.emplace_back();
    p.fixture->kind = PouKind::function_block;
    p.fixture->is_tests = true;
    p.fixture->place = first.place;
    p.fixture->name = first;
    p.fixture->name.text = "the tests";
    return *p.fixture;
}

Word end_of_test(Word opener) {
    if (opener == Word::test_) return Word::end_test_;
    return opener == Word::setup_ ? Word::end_setup_ : Word::end_teardown_;
}

}  // namespace

/// Test : 'TEST' Title Test_Body 'END_TEST' ';' ?
///      | 'SETUP' Test_Body 'END_SETUP' ';' ? | 'TEARDOWN' Test_Body 'END_TEARDOWN' ';' ?
/// Test_Body : Var_Sections Stmt_List
/// Title : Text | Quoted_Name
/// What SETUP and TEARDOWN declare all tests see.
void parse_test(Parsing& p) {
    const Token opener = p.take();
    const bool is_test = opener.word == Word::test_;
    Pou& fixture = fixture_of(p, opener);
    Pou& test = p.tree.pous.emplace_back();
    test.kind = PouKind::method;
    test.name = opener;
    if (is_test && (p.is(Word::text) || p.here().quoted))
        test.name = p.take();
    else if (is_test)
        expected(p, "a text in quotes", "after TEST");
    if (p.panic) skip_to_statement(p);
    test.place = opener.place.to(test.name.place);
    if (is_test) test.name.text = test.place.text();
    const Word end = end_of_test(opener.word);
    parse_sections(p, test, end);
    if (!is_test)
        for (DeclarationBlock& block : std::exchange(test.blocks, {}))
            fixture.blocks.push_back(std::move(block));
    p.is_in_body = p.is_in_test = true;
    parse_statements(p, test.body, end);
    close(p, end, opener);
    p.is_in_body = p.is_in_test = false;
    p.accept(Word::semicolon);
    if (p.panic) skip_past(p, end);
    fixture.methods.push_back(&test);
}

/// Test_Stmt : ( 'MOCK' | 'ADVANCE_TIME' ) Variable_Access ';'
///           | 'MOCK_FUNCTION' Variable_Access 'RETURNS' Expression ';'
/// It becomes a call.
void parse_test_statement(Parsing& p, Block& to) {
    Expression* name = p.make(Expression::Kind::name, p.take());
    Expression* call = p.make(Expression::Kind::call, name->token);
    call->operands[0] = name;
    call->arguments.push_back({{}, false, parse_access(p), nullptr});
    if (same_name(name->token.text, "mock_function")) {
        if (!p.says("returns")) expected(p, "RETURNS", "after the function");
        if (p.panic) return;
        p.take();
        call->arguments.push_back({{}, false, parse_expression(p), nullptr});
    }
    call->place = call->place.to(p.last().place);
    to.push_back(p.make(Statement::Kind::call, call));
    end_statement(p);
}

}  // namespace lineshaft::st
