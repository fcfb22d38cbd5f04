#include <span>
#include <utility>

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

/// How many tokens `lamps.red` has from here on.
std::size_t length_of_path(const Parsing& p) {
    std::size_t length = 1;
    while (p.next(length).word == Word::dot && p.is_name(length + 1)) length += 2;
    return length;
}

/// Action_Association : Name ( '.' Name ) * ( '(' ( Name ( ',' Expression ) ? ) ? ')' ) ?
/// The last Name is a qualifier: N, S, R, P, P0, P1, or with a time L, D, SD, DS, SL.
/// CODESYS keeps actions at the step: _ENTRY, _ACTIVE and _EXIT of it.
ChartAssociation parse_association(Parsing& p) {
    ChartAssociation made;
    made.action = expect_name(p, "the name of an action");
    while (!p.panic && p.accept(Word::dot)) {
        const Token part = expect_name(p, "a name behind the '.'");
        made.action.place = made.action.place.to(part.place);
        made.action.text =
            p.tree.names.emplace_back(fmt::format("{}.{}", made.action.text, part.text));
    }
    if (!p.accept(Word::open)) return made;
    if (p.is_name()) made.qualifier = p.take();
    if (p.accept(Word::comma)) made.time = parse_expression(p);
    expect(p, Word::close, "after the qualifier");
    return made;
}

/// `Name;`, `lamps.red;`, `Name(N);`, `Name(L, T#1s);`, where statements may stand, too.
bool at_association(const Parsing& p) {
    if (!p.is_name()) return false;
    const std::size_t length = length_of_path(p);
    if (p.next(length).word != Word::open) return p.next(length).word == Word::semicolon;
    constexpr std::string_view plain[] = {"N",  "S",      "R",       "P",    "P0",
                                          "P1", "_ENTRY", "_ACTIVE", "_EXIT"};
    constexpr std::string_view timed[] = {"L", "D", "SD", "DS", "SL"};
    const Word behind = p.next(length + 2).word;
    const auto is_among = [&](std::span<const std::string_view> names) {
        return find_called(names, p.next(length + 1).text) != nullptr;
    };
    return behind == Word::close ? is_among(plain) : behind == Word::comma && is_among(timed);
}

/// A part of Chart_Step: CoDeSys 2.3 has what a step does itself as a Stmt_List in it: an action
/// without a name.
void parse_step_action(Parsing& p, Pou& pou, ChartStep& step) {
    Pou& action = p.tree.pous.emplace_back();
    action.kind = PouKind::method;
    action.is_action = true;
    const std::string within = pou.is_action ? fmt::format("{}.", pou.name.text) : "";
    action.name = step.name;
    action.name.text =
        p.tree.names.emplace_back(fmt::format("{}{}._active", within, step.name.text));
    action.place = step.name.place;
    const bool is_in_body = std::exchange(p.is_in_body, true);
    parse_statements(p, action.body, Word::end_of_file);
    p.is_in_body = is_in_body;
    step.associations.push_back({.action = action.name, .qualifier = action.name});
    step.associations.back().qualifier.text = "_ACTIVE";
    pou.methods.push_back(&action);
}

/// Chart_Step : ( 'INITIAL_STEP' | 'STEP' ) Name ':' ( Action_Association ';' ) * 'END_STEP' ';' ?
void parse_step(Parsing& p, Pou& pou) {
    const Token opener = p.take();
    ChartStep& step = pou.chart->steps.emplace_back();
    step.is_initial = same_name(opener.text, "initial_step");
    step.name = expect_name(p, "the name of the step");
    expect(p, Word::colon, "after the name");
    const bool has_statements = p.source->dialect.charts == ChartRules::codesys;
    while (!p.panic && !p.says("end_step") && !p.at_chart() &&
           (p.is_name() || (has_statements && !is_end(p.here().word)))) {
        if (has_statements && !at_association(p)) {
            parse_step_action(p, pou, step);
            break;
        }
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
/// CoDeSys 2.3 has no ';' behind the expression.
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
    const bool is_open =
        p.says("end_transition") && p.source->dialect.charts == ChartRules::codesys;
    if (!p.panic && !is_open) end_statement(p);
    end_part(p, "end_transition", opener);
}

}  // namespace

/// Chart_Element : Chart_Step | Chart_Transition
void parse_chart_element(Parsing& p, Pou& pou) {
    if (!pou.chart) pou.chart = &p.tree.charts.emplace_back();
    if (p.says("transition"))
        parse_transition(p, *pou.chart);
    else
        parse_step(p, pou);
}

}  // namespace lineshaft::st
