#include "runtime/study/study_form.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "runtime/program/program_form.hpp"
#include "runtime/source/codes.hpp"

// clang-format off: tables are laid out by hand

namespace lineshaft {

namespace {

using enum Rule::Kind;
using enum Rule::Place;

/// Whole numbers that a double holds.
constexpr double greatest_integer = 0x1p53;

// What is drawn

constexpr std::string_view name_of(Distribution distribution) {
    constexpr std::string_view names[] = {"uniform", "log_uniform", "normal", "integer", "choice"};
    return names[static_cast<std::size_t>(distribution)];
}

void check_limits(const Reader& read, const Node& values, const RandomParameter& p) {
    const Node& first = values.items[0];
    const Node& second = values.items[1];
    if (p.distribution == Distribution::normal) {
        if (p.b < 0)
            read.fail(code::number_out_of_range, second,
                      fmt::format("'{}' is below 0", second.text));
        return;
    }
    if (p.b < p.a)
        return read.fail(code::number_out_of_range, second,
                         fmt::format("'{}' is below '{}'", second.text, first.text),
                         "write the least value first");
    if (p.distribution == Distribution::log_uniform && !(p.a > 0))
        return read.fail(code::number_out_of_range, first,
                         fmt::format("'{}' is not above 0 and has no logarithm", first.text));
    if (p.distribution != Distribution::integer) return;
    for (const auto& [node, value] : {std::pair(&first, p.a), std::pair(&second, p.b)})
        if (value != std::trunc(value) || std::abs(value) > greatest_integer)
            return read.fail(code::not_a_whole_number, *node,
                             fmt::format("'{}' is not a whole number", node->text));
}

/// Two numbers of one unit; a standard deviation may be in % of the mean.
template <Distribution distribution>
void read_limits(const Reader& read, const Node& values, RandomParameter& p) {
    constexpr bool normal = distribution == Distribution::normal;
    p.distribution = distribution;
    if (values.items.size() != 2)
        return read.fail(code::entry_is_missing, values,
                         fmt::format("'{}' takes two numbers", name_of(distribution)),
                         normal ? "they are the mean and the standard deviation"
                                : "they are the least and the greatest");
    const auto a = read.quantity(values.items[0]);
    if (!a) return;
    static const Unit one;
    const Node& second = values.items[1];
    const bool share =
        normal && !is_plain(a->unit) && second.is_scalar() && second.text.ends_with('%');
    const auto b = read.real(second, share ? one : a->unit);
    if (!b) return;
    p.unit = a->unit;
    p.a = a->number;
    p.b = share ? *b * std::abs(p.a) : *b;
    check_limits(read, values, p);
}

void read_choices(const Reader& read, const Node& values, RandomParameter& p) {
    p.distribution = Distribution::choice;
    for (const Node& value : values.items)
        if (read.expect_scalar(value, "a choice")) p.choices.push_back(value.text);
}

Shape two_numbers() {
    return list_of(a_number).within(2, 2);
}

const Form& distribution_form() {
    static const Form form = form_of<RandomParameter>(
        {.name = "distribution",
         .what = "a random value",
         .doc = "how a parameter's value is drawn. A draw depends on the seed, the parameter's "
                "name and its number "
                "only",
         .keys = {key<read_limits<Distribution::uniform>>("uniform", two_numbers(),
                                                          "[least, greatest]"),
                  key<read_limits<Distribution::log_uniform>>("log_uniform", two_numbers(),
                                                              "[least, greatest], both above 0"),
                  key<read_limits<Distribution::normal>>(
                      "normal", two_numbers(), "[mean, standard deviation], which may be in %"),
                  key<read_limits<Distribution::integer>>(
                      "integer", two_numbers(), "[least, greatest], whole numbers, both included"),
                  key<read_choices>(
                      "choice",
                      list_of(a_value.as("a choice")).filled("there is nothing to choose from"),
                      "one of these")},
         .rules = {{exactly_one,
                    {},
                    {"uniform", "log_uniform", "normal", "integer", "choice"},
                    "a random value has one distribution",
                    "write it as {uniform: [5 mm/s, 10 mm/s]}",
                    the_map,
                    code::entry_is_missing}},
         .unknown = "'{}' is not a distribution",
         .unknown_code = code::no_allowed_name});
    return form;
}

// Cases

void read_random(const Reader& read, const Node& node, CasePlan& plan) {
    for (const auto& [name, body] : node.entries) {
        if (std::ranges::find(plan.grid, name.text, &GridAxis::name) != plan.grid.end())
            read.fail(code::entries_do_not_go_together, name,
                      fmt::format("'{}' is drawn here, and a part of the grid as well", name.text));
        RandomParameter made;
        made.name = name.text;
        if (!read_form(distribution_form(), read, body, made)) continue;
        made.mark = body.entries.front().second.mark;
        plan.random.push_back(std::move(made));
    }
}

void read_grid(const Reader& read, const Node& node, CasePlan& plan) {
    for (const auto& [name, values] : node.entries) {
        if (!read.expect_sequence(values, "the values of a grid")) return;
        GridAxis axis{.name = name.text, .mark = name.mark, .values = {}};
        for (const Node& value : values.items) {
            if (!read.expect_scalar(value, "a value of a grid")) return;
            axis.values.push_back({name.text, value.text, name.mark, value.mark});
        }
        if (axis.values.empty())
            return read.fail(code::entry_is_missing, values,
                             fmt::format("the grid has no value of '{}'", name.text));
        plan.grid.push_back(std::move(axis));
    }
}

void check_case(const Reader&, const Node& node, CasePlan& plan) {
    const Node* grid = node.find("grid");
    plan.mark = node.mark;
    plan.size_mark = grid ? grid->mark : node.mark;
}

const Form& spread_form() {
    static const Form form = form_of<ComparisonPlan>(
        Form{.name = "spread",
             .what = "a spread",
             .doc = "a signal's standard deviation over the repeats of a case"}
            .with<&ComparisonPlan::bounds>(bounds_form()));
    return form;
}

const Form& comparison_form() {
    static const Form form = form_of<ComparisonPlan>(Form{
        .name = "comparison",
        .what = "a comparison",
        .doc = "a signal at the end of a case",
        .keys = {spread_key(spread_form)}}.with<&ComparisonPlan::bounds>(bounds_form()));
    return form;
}

constexpr const char* not_drawn = "there is no 'random' whose values could be drawn";
constexpr const char* draw_help = "write random: {speed: {uniform: [5 mm/s, 10 mm/s]}}";

const Form& case_form() {
    static const Form form = form_of<CasePlan>(Form{
        .name = "case",
        .what = "a case",
        .doc = "one run, or every combination of the grid's values, each with the same draws. A "
               "value that is "
               "wrong only together with others is told in the case's row",
        .keys =
            {key<&CasePlan::comparisons>("compare", compared(comparison_form),
                                         "signals at the end, beside those of all cases"),
             key<read_grid>(
                 "grid", named("a parameter", list_of(a_value.as("a value of a grid")).at_least(1)),
                 "every combination of these values is a case"),
             key<read_random>("random", named("a parameter", a_form(distribution_form)),
                              "parameters whose values are drawn for each case"),
             key<&CasePlan::draws>("draws",
                                   an_integer.at_least(1, "'{}' is below 1: each draw is a case"),
                                   "how often; each is a case"),
             key<&CasePlan::seed>("seed", an_integer.at_least(0), "of the draws").by_default("1")},
        .rules = {{only_with,
                   "random",
                   {"draws"},
                   "'random' says how values are drawn, but not how often",
                   "write beside it, for instance, draws: 100",
                   the_key},
                  {only_with, "draws", {"random"}, not_drawn, draw_help, the_key},
                  {only_with, "seed", {"random"}, not_drawn, draw_help, the_key},
                  {not_with,
                   "name",
                   {"grid", "random"},
                   "a grid or random values make many cases, which cannot share a name",
                   "leave the name out, or write the cases one by one",
                   the_key}},
        .check = by<check_case>}
                                                   .behind(case_head()));
    return form;
}

void read_cases(const Reader& read, const Node& node, StudyPlan& study) {
    for (const Node& item : node.items) {
        CasePlan& plan = study.cases.emplace_back();
        plan.usable = read_form(case_form(), read, item, plan);
    }
}

// Claims

void read_unit(const Reader& read, const Node& node, ClaimPlan& claim) {
    claim.percent = node.text == "%";
    if (!claim.percent)
        read.fail(code::unknown_unit, node,
                  fmt::format("a claim is a plain number or in %, not in '{}'", node.text));
}

const Form& claim_form() {
    static const Form form = form_of<ClaimPlan>(
        Form{.name = "claim",
             .what = "a claim",
             .doc = "a formula over the values of named cases, and its bounds",
             .keys = {key<&ClaimPlan::text>("claim", a_value, "what is claimed").must(),
                      key<&ClaimPlan::formula>("formula", a_value.as("a formula"),
                                               "of + - * /, parentheses, abs, sqrt, min, max, mean "
                                               "over names: CASE is its first signal, "
                                               "CASE.b.q another; mean_relative_error and "
                                               "greatest_relative_error are those of all rows "
                                               "with a paper's value but a spread's, and but 0")
                          .must(),
                      key<read_unit>("unit", one_of("a unit", {"%"}), "shown in percent")}}
            .with<&ClaimPlan::bounds>(bounds_form()));
    return form;
}

Shape settings_shape() {
    return named("a parameter", a_value.as("a setting"));
}

Shape repeat_shape() {
    return an_integer.at_least(1, "'{}' is below 1: a case runs at least once");
}

}  // namespace

const Form& study_head() {
    static const Form form = form_of<StudyPlan>(
        {.name = "study_head",
         .what = "a study",
         .doc = {},
         .keys = {key<&StudyPlan::title>("title", a_value.as("the title"), "shown above the table"),
                  key<&StudyPlan::program>("program", a_value, "the program, relative to this file")
                      .must(),
                  key<&StudyPlan::notes>("notes", one_or_list(a_value.as("a note")),
                                         "said below the table"),
                  slow_key(),
                  key<&StudyPlan::settings>("set", settings_shape(),
                                            "parameters of the program and values, in all cases"),
                  key<&StudyPlan::repeat>(
                      "repeat", repeat_shape(),
                      "runs of each case with seeds that follow each other; ours is the mean")
                      .by_default("1")}});
    return form;
}

const Form& case_head() {
    static const Form form = form_of<CasePlan>(
        {.name = "case_head",
         .what = "a case",
         .doc = {},
         .keys = {key<&CasePlan::name>("name", a_name.as("a case"), "in the table and in formulas"),
                  key<&CasePlan::settings>("set", settings_shape(),
                                           "parameters of the program and their values"),
                  key<&CasePlan::repeat>("repeat", repeat_shape(),
                                         "runs of this case; that of all cases unless said")}});
    return form;
}

const Form& bounds_form() {
    static const Form form = form_of<BoundsPlan>(
        {.name = "bounds",
         .what = "a comparison",
         .doc = "a value holds within one of the distances of the paper's, and in both limits",
         .keys = {key<&BoundsPlan::paper>("paper", a_number, "the paper's value"),
                  key<&BoundsPlan::within>("within", one_or_list(a_number),
                                           "distance from it, in the value's unit, in % of it or, "
                                           "of a claim, in points; of a list one is "
                                           "enough"),
                  key<&BoundsPlan::at_least>("at_least", a_number, "lower limit"),
                  key<&BoundsPlan::at_most>("at_most", a_number, "upper limit")},
         .rules = {{only_with,
                    "within",
                    {"paper"},
                    "'within' is for the paper's value, and there is none",
                    "write paper: VALUE beside it",
                    the_key}}});
    return form;
}

const Form& study_form() {
    static const Form form = form_of<StudyPlan>(Form{
        .name = "study",
        .what = "a study",
        .doc = "runs of one program, and the paper's figures beside ours",
        .keys = {key("lineshaft_study", a_version, "version of this form").must(),
                 key<&StudyPlan::comparisons>("compare", compared(comparison_form),
                                              "signals at the end of every case"),
                 key<read_cases>("cases", list_of(a_form(case_form)).filled("'cases' has no case"),
                                 "runs")
                     .must(),
                 key<&StudyPlan::claims>(
                     "claims", list_of(a_form(claim_form)),
                     "formulas over the cases")}}.behind(study_head()));
    return form;
}

Key spread_key(FormOf spread) {
    return key<&ComparisonPlan::spread>("spread", either({nothing, a_form(spread)}),
                                        "of the values of the repeats: their standard deviation");
}

Shape compared(FormOf comparison) {
    return either({list_of(a_signal), signals_to(either({nothing, a_form(comparison)}))});
}

void put(const Reader& read, const Key&, const Node& node, std::vector<Setting>& settings) {
    if (!read.expect_map(node, "'set'")) return;
    for (const auto& [name, value] : node.entries)
        if (read.expect_scalar(value, "a setting"))
            settings.push_back({name.text, value.text, name.mark, value.mark});
}

void put(const Reader& read, const Key& key, const Node& node, std::vector<ComparisonPlan>& plans) {
    for (const Node& item : node.items)
        if (read.expect_scalar(item, "a signal")) plans.push_back({.signal = item, .bounds = {}});
    if (node.is_sequence() || !read.expect_map(node, "'compare'")) return;
    const Form& form = key.shape.of.back().of[0].of.back().form();
    for (const auto& [signal, body] : node.entries) {
        ComparisonPlan plan{.signal = signal, .bounds = {}};
        if (!body.is_empty()) read_form(form, read, body, plan);
        const auto spread = std::exchange(plan.spread.plans, {});
        plans.push_back(std::move(plan));
        for (const ComparisonPlan& more : spread) plans.push_back(more);
        if (!spread.empty()) plans.back().signal = signal;
    }
}

void put(const Reader& read, const Key& key, const Node& node, SpreadPlan& spread) {
    ComparisonPlan& plan = spread.plans.emplace_back();
    plan.statistic = Statistic::spread;
    if (!node.is_empty()) read_form(key.shape.of.back().form(), read, node, plan);
}

}  // namespace lineshaft
