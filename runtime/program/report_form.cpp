#include "runtime/program/program.hpp"
#include "runtime/program/program_parts.hpp"

namespace lineshaft {

namespace {

using enum Rule::Kind;
using enum Rule::Place;

Shape drawn() {
    return list_of(either({a_signal, a_name})).unique("'{}' stands in this list already");
}

}  // namespace

const Form& report_form() {
    static const Form form = form_of<ReportPlan>(
        {.name = "report",
         .what = "'report'",
         .doc =
             "the page that 'lineshaft report' makes of the program's traces, as it is when it is "
             "opened: whoever looks at it may arrange it in another way",
         .keys = {key<&ReportPlan::plots>(
                      "plots", list_of(drawn().filled("a plot has no signal")),
                      "signals and curves of each plot over time, from the top; what no plot names "
                      "follows, grouped by units"),
                  key<&ReportPlan::own_axis>("own_axis", drawn(),
                                             "signals and curves that have an axis of their own"),
                  key<&ReportPlan::hide>("hide", drawn(),
                                         "signals and curves that are not drawn until asked for"),
                  key<&ReportPlan::curves>(
                      "curves", named("a curve", a_value.as("a formula")),
                      "further curves: + - * /, parentheses, abs, sqrt, min, max, mean and "
                      "derivative(x), by time, over recorded signals"),
                  key<&ReportPlan::paths>(
                      "paths",
                      list_of(list_of(a_signal).within(2, 2)).filled("'paths' has no path"),
                      "pairs of signals, the second drawn over the first"),
                  key<&ReportPlan::circle>(
                      "circle", list_of(a_number).within(3, 3),
                      "x, y and radius of the circle that the paths are compared with; else one "
                      "that is found in them"),
                  key<&ReportPlan::band>(
                      "band", list_of(a_value).within(2, 2),
                      "a path_table, and how far from it: a band that is drawn along its points, "
                      "beneath the paths"),
                  key<&ReportPlan::condition>(
                      "while", a_signal,
                      "a boolean signal: a path is compared with the circle while it is true")},
         .rules = {{only_with,
                    "circle",
                    {"paths"},
                    "'circle' is for paths, and there are none",
                    "write paths: [[x.position, y.position]] beside it",
                    the_key},
                   {only_with,
                    "band",
                    {"paths"},
                    "'band' is for paths, and there are none",
                    "write paths: [[x.position, y.position]] beside it",
                    the_key},
                   {only_with,
                    "while",
                    {"paths"},
                    "'while' is for paths, and there are none",
                    "write paths: [[x.position, y.position]] beside it",
                    the_key}}});
    return form;
}

void read_report(const Reader& read, const Node& node, Program& program) {
    read_form(report_form(), read, node, program.report.emplace());
}

}  // namespace lineshaft
