#include "runtime/fit/fit_form.hpp"

#include <fmt/format.h>

// clang-format off: tables are laid out by hand

namespace lineshaft {

namespace {

const Form& parameter_form() {
    static const Form form = form_of<FitParameterPlan>(
        {.name = "fit_parameter",
         .what = "a parameter of a fit",
         .doc = "a parameter of the program whose value is looked for; its unit is that of 'from'",
         .keys = {
             key<&FitParameterPlan::from>("from", a_number, "lower bound").must(),
             key<&FitParameterPlan::to>("to", a_number, "upper bound").must(),
             key<&FitParameterPlan::start>("start", a_number,
                                           "of the first search; in the middle unless said"),
             key<&FitParameterPlan::step>(
                 "step", a_number, "of the difference quotients; 0.001 of the way unless said")}});
    return form;
}

void read_parameters(const Reader& read, const Node& node, FitFilePlan& fit) {
    for (const auto& [name, body] : node.entries) {
        FitParameterPlan plan{.name = name, .from = {}, .to = {}};
        if (read_form(parameter_form(), read, body, plan)) fit.parameters.push_back(plan);
    }
}

Key uncertainty_key() {
    return key<&ComparisonPlan::uncertainty>("uncertainty", a_number,
                                             "differences are counted in it, in the signal's unit "
                                             "or in %; may be left out where all values are of one "
                                             "unit");
}

const Form& spread_form() {
    static const Form form = form_of<ComparisonPlan>(Form{
        .name = "fit_spread",
        .what = "a spread",
        .doc = "a signal's standard deviation over the repeats of a case, as it was measured",
        .keys = {uncertainty_key()}}.with<&ComparisonPlan::bounds>(bounds_form()));
    return form;
}

const Form& comparison_form() {
    static const Form form = form_of<ComparisonPlan>(Form{
        .name = "fit_comparison",
        .what = "a comparison",
        .doc = "what was measured of a signal at the end of a case, or the samples of a trace",
        .keys = {uncertainty_key(),
                 key<&ComparisonPlan::column>("column", a_value,
                                              "of the trace; named as the signal unless said"),
                 spread_key(spread_form)}}.with<&ComparisonPlan::bounds>(bounds_form()));
    return form;
}

const Form& trace_form() {
    static const Form form = form_of<FitTracePlan>(
        {.name = "fit_trace",
         .what = "a trace",
         .doc = "what was measured, sample by sample",
         .keys = {
             key<&FitTracePlan::file>("file", a_value.as("the name of a trace"),
                                      "CSV, relative to this file")
                 .must(),
             key<&FitTracePlan::time>("time", a_value, "its column of times").by_default("time"),
             key<&FitTracePlan::offset>("offset", a_time, "time of the run at its time 0")
                 .by_default("0 s")}});
    return form;
}

void read_trace(const Reader& read, const Node& node, FitCasePlan& plan) {
    plan.trace.place = node;
    if (node.is_map())
        read_form(trace_form(), read, node, plan.trace);
    else if (read.expect_scalar(node, "the name of a trace"))
        plan.trace.file = node;
}

void check_case(const Reader&, const Node& node, FitCasePlan& plan) {
    plan.run.mark = plan.run.size_mark = node.mark;
}

const Form& case_form() {
    static const Key compare = key<&CasePlan::comparisons>("compare", compared(comparison_form),
                                                           "signals and what was measured of them")
                                   .must();
    static const Form form = form_of<FitCasePlan>(
        Form{.name = "fit_case",
             .what = "a case of a fit",
             .doc = "a run and what was measured of it",
             .keys = {key<&FitCasePlan::hold_out>("hold_out", a_boolean,
                                                  "takes no part in the search, is only compared")
                          .by_default("false"),
                      key<read_trace>(
                          "trace", either({a_form(trace_form), a_value.as("the name of a trace")}),
                          "a file, or more about it")},
             .check = by<check_case>}
            .behind<&FitCasePlan::run>(
                case_head().with({.name = {}, .what = {}, .doc = {}, .keys = {compare}})));
    return form;
}

}  // namespace

const Form& fit_form() {
    static const Form form = form_of<FitFilePlan>(Form{
        .name = "fit",
        .what = "a fit",
        .doc = "looks for the values of parameters that bring a program nearest to what was "
               "measured, by least "
               "squares of (ours - given) / uncertainty",
        .keys = {
            key("lineshaft_fit", a_version, "version of this form").must(),
            key<read_parameters>("parameters",
                                 named("a parameter", a_form(parameter_form))
                                     .filled("'parameters' names none to look for"),
                                 "of the program, whose "
                                 "values are looked for")
                .must("say what is looked for: parameters: {lag: {from: 0 ms, to: 50 ms}}"),
            key<&FitFilePlan::starts>("starts",
                                      an_integer.within(1, 1000, "'starts' must be from 1 to 1000"),
                                      "searches: the first at each 'start', the others at random")
                .by_default("1"),
            key<&FitFilePlan::seed>("seed", an_integer.at_least(0), "of these").by_default("1"),
            key<&FitFilePlan::hold_out>("hold_out", one_of("a way to hold out cases", {"each"}),
                                        "leaves each case out in turn, predicted from all others"),
            key<&FitFilePlan::cases>("cases",
                                     list_of(a_form(case_form)).filled("'cases' has no case"),
                                     "runs, and what was measured of them")
                .must()}}.behind<&FitFilePlan::study>(study_head()));
    return form;
}

}  // namespace lineshaft
