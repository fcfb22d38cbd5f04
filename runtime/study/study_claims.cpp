#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/formula.hpp"
#include "runtime/study/study_file_reader.hpp"

namespace lineshaft {

namespace {

bool has_paper(const CaseGroup& group) {
    return std::ranges::any_of(group.comparisons, [](const Comparison& comparison) {
        return comparison.statistic == Statistic::mean && comparison.bounds.paper.value_or(0) != 0;
    });
}

}  // namespace

void StudyFileReader::compare(const ComparisonPlan& plan, const Machine& machine,
                              CaseGroup& group) {
    if (plan.statistic == Statistic::spread && group.repeat < 2)
        read_.fail(code::entries_do_not_go_together, plan.signal,
                   "'spread' is the standard deviation over the repeats, and there is one run",
                   "write repeat: 4");
    if (const Signal* signal = machine.find(plan.signal.text)) {
        const Bounds made = bounds(plan.bounds, Unit::parse(signal->unit).value());
        group.comparisons.push_back({signal->name, signal->unit, made, plan.statistic});
        return;
    }
    std::vector<std::string> names;
    for (const Signal& s : machine.signals) names.push_back(s.name);
    read_.fail(code::unknown_port, plan.signal,
               fmt::format("the program has no signal '{}'", plan.signal.text),
               suggest(plan.signal.text, names));
    cases_known_ = false;
}

Bounds StudyFileReader::bounds(const BoundsPlan& plan, const Unit& unit) const {
    const auto number = [&](const std::optional<Node>& node) {
        return node ? read_.real(*node, unit) : std::nullopt;
    };
    Bounds bounds{.paper = number(plan.paper),
                  .within = {},
                  .at_least = number(plan.at_least),
                  .at_most = number(plan.at_most)};
    if (bounds.at_least && bounds.at_most && *bounds.at_least > *bounds.at_most)
        read_.fail(code::entries_do_not_go_together, *plan.at_least,
                   "'at_least' is above 'at_most': this never holds");
    if (bounds.paper)
        for (const Node& distance : plan.within) within(distance, unit, bounds);
    return bounds;
}

/// An absolute distance, a percentage of the paper's value, or `points` for a claim in percent.
void StudyFileReader::within(const Node& node, const Unit& unit, Bounds& bounds) const {
    std::optional<double> distance;
    if (node.is_scalar() && node.text.ends_with(" points")) {
        Node number = node;
        number.text.resize(number.text.size() - 7);
        distance = read_.real(number, Unit());
        if (distance) *distance /= 100;
    } else {
        distance = read_.real_or_share(node, unit, *bounds.paper);
    }
    if (distance && *distance < 0)
        read_.fail(code::number_out_of_range, node, fmt::format("'{}' is below 0", node.text));
    if (distance) bounds.within.push_back(*distance);
}

void StudyFileReader::claim(const ClaimPlan& plan) {
    static const Unit one;
    study_.claims.push_back({.text = plan.text.text,
                             .formula = plan.formula.text,
                             .percent = plan.percent,
                             .bounds = bounds(plan.bounds, one)});
    check_formula(plan.formula);
}

/// Evaluated with all names at 1, so that a misspelt name is known before the first run.
void StudyFileReader::check_formula(const Node& formula) const {
    std::vector<std::string> known;
    for (const CaseGroup& c : study_.groups) {
        if (c.name.empty() || c.comparisons.empty()) continue;
        known.push_back(c.name);
        for (const Comparison& k : c.comparisons) known.push_back(c.name + "." + k.name());
    }
    if (std::ranges::any_of(study_.groups, has_paper))
        known.insert(known.end(), {"mean_relative_error", "greatest_relative_error"});
    const auto result = evaluate(formula.text, [&](std::string_view name) {
        return std::ranges::find(known, name) == known.end() ? std::nullopt : std::optional(1.0);
    });
    const bool misspelt = !result.name.empty();
    if (result.error.empty() || (misspelt && !(cases_known_ && checkable_))) return;
    Node place = formula;
    const int quote = formula.quoted ? 1 : 0;
    const int length = static_cast<int>(formula.text.size());
    if (formula.mark.length == length + 2 * quote) {
        place.mark.column += static_cast<int>(result.position) + quote;
        place.mark.length = std::max(1, static_cast<int>(result.name.size()));
    }
    read_.fail(code::mistake_in_formula, place, result.error,
               misspelt ? suggest(result.name, known) : "");
}

}  // namespace lineshaft
