#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "runtime/study/formula.hpp"
#include "runtime/study/study_file_reader.hpp"

namespace lineshaft {

namespace {

bool has_paper(const CaseGroup& group) {
    return std::ranges::any_of(group.comparisons, [](const Comparison& comparison) {
        return comparison.statistic == Statistic::mean && comparison.bounds.paper.value_or(0) != 0;
    });
}

}  // namespace

void StudyFileReader::comparisons(const Node& node, std::vector<PendingComparison>& into) const {
    if (node.is_sequence()) {
        for (const Node& item : node.items)
            if (read_.expect_scalar(item, "a signal")) into.push_back({item, {}});
        return;
    }
    if (!read_.expect_map(node, "'compare'")) return;
    for (const auto& [signal, body] : node.entries) {
        if (!body.is_empty() && !read_.expect_map(body, "a comparison")) continue;
        read_.only_keys(body, "a comparison", {"paper", "within", "at_least", "at_most", "spread"});
        into.push_back({signal, body});
        const Node* spread = body.find("spread");
        if (!spread || !(spread->is_empty() || read_.expect_map(*spread, "a spread"))) continue;
        read_.only_keys(*spread, "a spread", {"paper", "within", "at_least", "at_most"});
        into.push_back({signal, *spread, Statistic::spread});
    }
}

std::optional<Comparison> StudyFileReader::compare(const PendingComparison& pending,
                                                   const Machine& machine, std::int64_t repeat) {
    if (pending.statistic == Statistic::spread && repeat < 2)
        read_.fail("L0213", pending.signal,
                   "'spread' is the standard deviation over the repeats, and there is one run",
                   "write repeat: 4");
    const Signal* signal = machine.find(pending.signal.text);
    if (!signal) {
        std::vector<std::string> names;
        for (const Signal& s : machine.signals) names.push_back(s.name);
        read_.fail("L0203", pending.signal,
                   fmt::format("the program has no signal '{}'", pending.signal.text),
                   suggest(pending.signal.text, names));
        return {};
    }
    Comparison comparison{
        .signal = signal->name, .unit = signal->unit, .bounds = {}, .statistic = pending.statistic};
    if (pending.body.is_map())
        comparison.bounds = bounds(pending.body, Unit::parse(signal->unit).value());
    return comparison;
}

Bounds StudyFileReader::bounds(const Node& map, const Unit& unit) const {
    Bounds bounds;
    if (const Node* n = map.find("paper")) bounds.paper = read_.real(*n, unit);
    if (const Node* n = map.find("at_least")) bounds.at_least = read_.real(*n, unit);
    if (const Node* n = map.find("at_most")) bounds.at_most = read_.real(*n, unit);
    if (bounds.at_least && bounds.at_most && *bounds.at_least > *bounds.at_most)
        read_.fail("L0213", *map.find("at_least"),
                   "'at_least' is above 'at_most': this never holds");
    const Node* n = map.find("within");
    if (!n) return bounds;
    if (!map.find("paper"))
        read_.fail("L0202", *n, "'within' is for the paper's value, and there is none",
                   "write paper: VALUE beside it");
    if (!bounds.paper) return bounds;
    if (n->is_sequence())
        for (const Node& item : n->items) within(item, unit, bounds);
    else
        within(*n, unit, bounds);
    return bounds;
}

/// An absolute distance, a percentage of the paper's value, or `points` for a claim in percent.
void StudyFileReader::within(const Node& node, const Unit& unit, Bounds& bounds) const {
    static const Unit one;
    const bool share = node.is_scalar() && node.text.ends_with('%');
    std::optional<double> distance;
    if (node.is_scalar() && node.text.ends_with(" points")) {
        Node number = node;
        number.text.resize(number.text.size() - 7);
        distance = read_.real(number, one);
        if (distance) *distance /= 100;
    } else {
        distance = read_.real(node, share ? one : unit);
        if (distance && share) *distance *= std::abs(*bounds.paper);
    }
    if (distance && *distance < 0)
        read_.fail("L0305", node, fmt::format("'{}' is below 0", node.text));
    if (distance) bounds.within.push_back(*distance);
}

void StudyFileReader::claims(const Node& node) {
    if (!read_.expect_sequence(node, "'claims'")) return;
    for (const Node& item : node.items)
        if (read_.expect_map(item, "a claim")) claim(item);
}

void StudyFileReader::claim(const Node& node) {
    static const Unit one;
    read_.only_keys(node, "a claim",
                    {"claim", "formula", "unit", "paper", "within", "at_least", "at_most"});
    const Node* text = read_.require(node, "claim", "a claim");
    const Node* formula = read_.require(node, "formula", "a claim");
    if (!text || !formula || !read_.expect_scalar(*formula, "a formula")) return;
    Claim made;
    made.text = text->text;
    made.formula = formula->text;
    made.bounds = bounds(node, one);
    check_formula(*formula);
    const Node* unit = node.find("unit");
    made.percent = unit && unit->text == "%";
    if (unit && !made.percent)
        read_.fail("L0304", *unit,
                   fmt::format("a claim is a plain number or in %, not in '{}'", unit->text));
    study_.claims.push_back(std::move(made));
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
    read_.fail("L0602", place, result.error, misspelt ? suggest(result.name, known) : "");
}

}  // namespace lineshaft
