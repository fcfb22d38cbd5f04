#include <algorithm>

#include <fmt/format.h>

#include "runtime/program/program.hpp"
#include "runtime/program/program_parts.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

using enum Rule::Kind;
using enum Rule::Place;

constexpr const char* expectation_help =
    "write it as {at: end, axis.position: 20 mm, within: 1e-9 mm}";

const Form& expected_bounds() {
    static const Form form = form_of<ExpectPlan>(
        {.name = "expected_bounds",
         .what = "an expectation's bounds",
         .doc = "what an expected signal keeps within",
         .keys = {key<&ExpectPlan::at_least>("at_least", a_value,
                                             "lower bound; what is smaller by rounding, by four "
                                             "units in the last place, is let pass"),
                  key<&ExpectPlan::at_most>("at_most", a_value,
                                            "upper bound; what is larger by rounding, by four "
                                            "units in the last place, is let pass")}});
    return form;
}

using When = ExpectPlan::When;

template <When when>
void read_time_of(const Reader& read, const Node& node, ExpectPlan& plan) {
    plan.when = when;
    plan.from = read.time(node).value_or(0);
}

template <When when>
void read_signal_of(const Reader&, const Node& node, ExpectPlan& plan) {
    plan.when = when;
    plan.signal = node;
}

void read_between(const Reader& read, const Node& node, ExpectPlan& plan) {
    plan.when = When::always;
    plan.from = read.time(node.items[0]).value_or(0);
    plan.until = read.time(node.items[1]).value_or(never);
    if (plan.until < plan.from)
        read.fail(code::entries_do_not_go_together, node.items[1],
                  "'between' ends before it begins");
}

/// `within 2 s of inputs.start: move.Done`
void read_answer(const Reader& read, const Node& name, const Node& value, ExpectPlan& plan) {
    constexpr std::string_view begin = "within ", middle = " of ";
    const auto of = name.text.find(middle);
    const auto part = [&](std::size_t from, std::size_t to) {
        Node node = name;
        node.text = name.text.substr(from, to == name.text.npos ? to : to - from);
        node.quoted = false;
        node.mark.column += static_cast<int>(from) + (name.quoted ? 1 : 0);
        node.mark.length = static_cast<int>(node.text.size());
        return node;
    };
    plan.when = When::answered;
    plan.signal = value;
    if (of == name.text.npos)
        return read.fail(code::unknown_key, name, fmt::format("'{}' names no signal", name.text),
                         "write within 2 s of inputs.start: move.Done");
    plan.cause = part(of + middle.size(), name.text.npos);
    const auto limit = read.time(part(begin.size(), of));
    if (accept(read, a_signal, value, "what answers") && limit) plan.until = *limit;
}

/// The keys that are no others: the signal, or who answers.
void read_expected(const Reader& read, const Node& item, ExpectPlan& plan) {
    for (const auto& [name, value] : item.entries) {
        if (expectation_form().find(name.text)) continue;
        if (expectation_form().is_phrase(name.text)) {
            read_answer(read, name, value, plan);
            continue;
        }
        if (!plan.signal.text.empty()) {
            read.fail(code::unknown_key, name,
                      fmt::format("an expectation has one signal, '{}' is a second", name.text));
            continue;
        }
        plan.signal = name;
        if (value.is_map())
            read_form(expected_bounds(), read, value, plan);
        else if (accept(read, a_value.as("an expected value"), value, {}))
            plan.equals = value;
    }
}

void check_expectation(const Reader& read, const Node& item, ExpectPlan& plan) {
    plan.mark = item.mark;
    const auto has = [&](std::string_view key) { return item.find(key) != nullptr; };
    const auto& names = expectation_form().rules.back().others;
    if (std::ranges::count_if(names, [&](auto name) {
            return expectation_form().find_in(item, name) != nullptr;
        }) != 1)
        return;
    read_expected(read, item, plan);
    const bool bounded = plan.at_least || plan.at_most;
    const bool of_boolean = has("always") || has("never");
    if ((has("count") && !has("rising")) || (has("equals") && !of_boolean)) return;
    if (plan.signal.text.empty())
        return read.fail(code::entry_is_missing, item, "an expectation names no signal",
                         expectation_help);
    if (plan.when == When::answered) {
        if (plan.equals || bounded)
            read.fail(code::entries_do_not_go_together, item,
                      "an answer is a signal that becomes true, without a value");
        return;
    }
    if (plan.when == When::counted && !plan.equals && !bounded)
        return read.fail(code::entry_is_missing, item, "an expectation has no count",
                         "write count: 3, at_least or at_most");
    if (!plan.equals && !bounded && !of_boolean)
        return read.fail(code::entry_is_missing, item, "an expectation has no value and no bound",
                         "write SIGNAL: VALUE, at_least or at_most");
    if (plan.within && !plan.equals)
        return read.fail(
            code::entry_is_missing, *plan.within, "'within' is for a value, and there is none",
            of_boolean ? "write equals: VALUE beside it" : "write SIGNAL: VALUE beside it");
    if (plan.equals && bounded)
        read.fail(code::entries_do_not_go_together, item,
                  "an expectation has a value or bounds, not both", "write two expectations");
}

}  // namespace

const Form& expectation_form() {
    constexpr std::string_view answer = "within TIME of SIGNAL";
    constexpr std::string_view two = "write two expectations";
    const auto apart = [&](std::string_view key, std::vector<std::string_view> others) {
        return Rule{not_with, key, std::move(others),
                    "an expectation says '{1}' or '{2}', not both", two};
    };
    static const Form form = form_of<ExpectPlan>(Form{
        .name = "expectation",
        .what = "an expectation",
        .doc = "what must hold of one signal: at a time, in every scan, or as often as it should",
        .keys = {key<read_time_of<When::at>>("at", a_time,
                                             "when, after all that is due then; or the end")
                     .or_word("end"),
                 key<read_signal_of<When::always>>(
                     "always", a_signal,
                     "judged in every scan; true, unless a value or bounds are said"),
                 key<read_signal_of<When::excluded>>(
                     "never", a_signal,
                     "judged in every scan; never true, or never this value or within these "
                     "bounds"),
                 key<read_between>("between",
                                   list_of(a_time).within(2, 2, "'between' takes two times",
                                                          "write between: [1 s, 2 s]"),
                                   "from when to when it is judged, then and in every scan"),
                 key<read_signal_of<When::counted>>("rising", a_signal,
                                                    "a boolean whose rising edges are counted"),
                 key<&ExpectPlan::equals>("count", a_value, "with 'rising': how many"),
                 key<&ExpectPlan::equals>("equals", a_value, "with 'always' or 'never': the value"),
                 key<&ExpectPlan::within>("within", a_value,
                                          "distance from the value, or a percentage of it, with "
                                          "room for rounding as a bound has; of 0: none"),
                 key<&ExpectPlan::because>("because", a_value.as("the reason"),
                                           "why it is expected, told with the verdict")},
        .rules = {apart("at", {"always", "never", "between", "rising", answer}),
                  apart("always", {"never", "between", "rising", answer}),
                  apart("never", {"between", "rising", answer}),
                  apart("between", {"rising", answer}),
                  apart("rising", {answer, "within", "equals"}),
                  {only_with, "count", {"rising"}, "'count' is for 'rising'"},
                  {only_with,
                   "equals",
                   {"always", "never"},
                   "'equals' is for 'always' and 'never'",
                   "write SIGNAL: VALUE"},
                  {at_least_one,
                   {},
                   {"at", "always", "never", "between", "rising", answer},
                   "an expectation does not say when it holds",
                   expectation_help}},
        .others = key("SIGNAL", either({a_form(expected_bounds), a_value}),
                      "with 'at' or 'between': its value, or its bounds"),
        .phrase = key(answer, a_signal,
                      "a boolean that is true within this time of each rising edge of another"),
        .check = by<check_expectation>}
                                                     .with(expected_bounds()));
    return form;
}

}  // namespace lineshaft
