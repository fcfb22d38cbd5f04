#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/grammar.hpp"

namespace lineshaft::st {

namespace {

/// END_STEP and END_TRANSITION are names elsewhere.
void end_part(Parsing& p, std::string_view end, const Token& opener) {
    if (p.panic) {
        p.panic = false;
        while (!p.is(Word::end_of_file) && !p.says(end) && !p.at_chart() && !is_end(p.here().word))
            p.take();
    } else if (!p.says(end)) {
        tell(p, code::something_else_expected, opener.place,
             fmt::format("the {} does not end", opener.place.text()),
             fmt::format("it ends with {}", upper(end)));
    }
    if (p.says(end)) p.take();
    p.accept(Word::semicolon);
}

/// Action_Association : Name '(' ( Name ( ',' Expression ) ? ) ? ')'
/// The second Name is a qualifier: N, S, R, P, P0, P1, or with a time L, D, SD, DS, SL.
/// CODESYS keeps actions at the step: _ENTRY, _ACTIVE and _EXIT of it.
ChartAssociation parse_association(Parsing& p) {
    ChartAssociation made;
    made.action = expect_name(p, "the name of an action");
    if (!p.accept(Word::open)) return made;
    if (p.is_name()) made.qualifier = p.take();
    if (p.accept(Word::comma)) made.time = parse_expression(p);
    expect(p, Word::close, "after the qualifier");
    return made;
}

/// Chart_Step : ( 'INITIAL_STEP' | 'STEP' ) Name ':' ( Action_Association ';' ) * 'END_STEP' ';' ?
void parse_step(Parsing& p, Chart& chart) {
    const Token opener = p.take();
    ChartStep& step = chart.steps.emplace_back();
    step.is_initial = same_name(opener.text, "initial_step");
    step.name = expect_name(p, "the name of the step");
    expect(p, Word::colon, "after the name");
    while (!p.panic && p.is_name() && !p.says("end_step") && !p.at_chart()) {
        step.associations.push_back(parse_association(p));
        end_statement(p);
    }
    end_part(p, "end_step", opener);
}

/// Chart_Steps : Name | '(' Name ( ',' Name ) * ')'
std::vector<Token> parse_steps(Parsing& p) {
    std::vector<Token> steps;
    const bool has_several = p.accept(Word::open);
    do steps.push_back(expect_name(p, "the name of a step"));
    while (has_several && p.accept(Word::comma));
    if (has_several) expect(p, Word::close, "after the steps");
    return steps;
}

/// Chart_Transition : 'TRANSITION' Name ? ( '(' 'PRIORITY' ':=' Unsigned_Int ')' ) ?
///                    'FROM' Chart_Steps 'TO' Chart_Steps ':=' Expression ';' 'END_TRANSITION' ';'
///                    ?
void parse_transition(Parsing& p, Chart& chart) {
    const Token opener = p.take();
    ChartTransition& made = chart.transitions.emplace_back();
    made.place = opener.place;
    if (p.is_name() && !p.says("from")) p.take();
    if (p.accept(Word::open)) {
        if (p.says("priority")) p.take();
        expect(p, Word::assign, "after PRIORITY");
        if (p.is(Word::integer)) made.priority = p.take();
        expect(p, Word::close, "after the priority");
    }
    if (p.says("from"))
        p.take();
    else
        expected(p, "FROM", "before the steps that are left");
    made.from = parse_steps(p);
    expect(p, Word::to_, "before the steps that follow");
    made.to = parse_steps(p);
    expect(p, Word::assign, "before the condition");
    made.condition = parse_expression(p);
    if (!p.panic) end_statement(p);
    end_part(p, "end_transition", opener);
}

}  // namespace

/// Chart_Element : Chart_Step | Chart_Transition
void parse_chart_element(Parsing& p, Pou& pou) {
    if (!pou.chart) pou.chart = &p.tree.charts.emplace_back();
    if (p.says("transition"))
        parse_transition(p, *pou.chart);
    else
        parse_step(p, *pou.chart);
}

}  // namespace lineshaft::st
