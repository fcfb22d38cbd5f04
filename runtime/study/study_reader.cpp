#include "runtime/study/study_reader.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "runtime/program/link.hpp"
#include "runtime/program/reader.hpp"
#include "runtime/study/formula.hpp"

namespace lineshaft {

namespace {

/// No further case is checked: a grid may make a million of one mistake.
constexpr std::size_t enough_mistakes = 100;

/// A comparison whose numbers wait for the signal's unit.
struct PendingComparison {
    Node signal;
    Node body;  ///< map, or empty for a bare report
};

struct PendingCase {
    Node place;
    StudyCase made;
    std::vector<PendingComparison> comparisons;
};

bool has_paper(const StudyCase& c) {
    return std::ranges::any_of(c.comparisons, [](const Comparison& comparison) {
        return comparison.bounds.paper.value_or(0) != 0;
    });
}

class StudyReader {
  public:
    StudyReader(const LoadOptions& options, const Catalog& catalog, Diagnostics& out)
        : options_(options), catalog_(catalog), read_(out) {}

    Study read(std::shared_ptr<const SourceFile> file);

  private:
    void program(const Node& root);
    void notes(const Node& node);
    void cases(const Node& node);
    void one_case(const Node& node);
    std::string name(const Node& node);
    std::int64_t repeat(const Node& node) const;
    void settings(const Node& node, std::vector<Setting>& into) const;
    void comparisons(const Node& node, PendingCase& pending) const;
    void grid(const Node& node, const PendingCase& common);
    void check(PendingCase& pending);
    std::optional<Comparison> compare(const PendingComparison& pending, const Machine& machine);
    void claims(const Node& node);
    void claim(const Node& node);
    void check_formula(const Node& formula) const;
    Bounds bounds(const Node& map, const Unit& unit) const;
    void within(const Node& node, const Unit& unit, Bounds& bounds) const;

    const LoadOptions& options_;
    const Catalog& catalog_;
    Reader read_;
    Study study_;
    std::shared_ptr<const SourceFile> program_file_;
    std::vector<Setting> common_;
    std::vector<PendingComparison> common_comparisons_;
    std::int64_t common_repeat_ = 1;
    std::int64_t runs_ = 0;
    bool checkable_ = true;    ///< there is a program, and the runs are not too many
    bool cases_known_ = true;  ///< every case so far is without mistakes
    std::set<std::string> names_;
};

Study StudyReader::read(std::shared_ptr<const SourceFile> file) {
    study_.file = file;
    study_.include_dirs = options_.include_dirs;
    auto root = parse_yaml(file, read_.diagnostics());
    if (!root || !check_kind(read_, *root, "lineshaft_study")) return std::move(study_);
    read_.only_keys(*root, "a study",
                    {"lineshaft_study", "title", "program", "notes", "set", "repeat", "compare",
                     "cases", "claims"});
    if (const Node* n = root->find("title"); n && read_.expect_scalar(*n, "the title"))
        study_.title = n->text;
    program(*root);
    if (const Node* n = root->find("notes")) notes(*n);
    if (const Node* n = root->find("set")) settings(*n, common_);
    common_.insert(common_.end(), options_.settings.begin(), options_.settings.end());
    if (const Node* n = root->find("repeat")) common_repeat_ = repeat(*n);
    if (const Node* n = root->find("compare")) {
        PendingCase common;
        comparisons(*n, common);
        common_comparisons_ = std::move(common.comparisons);
    }
    if (const Node* n = read_.require(*root, "cases", "a study")) cases(*n);
    if (const Node* n = root->find("claims")) claims(*n);
    return std::move(study_);
}

void StudyReader::program(const Node& root) {
    const Node* node = read_.require(root, "program", "a study");
    checkable_ = false;
    if (!node || !read_.expect_scalar(*node, "'program'")) return;
    Diagnostics& out = read_.diagnostics();
    const auto path =
        resolve_path(node->text, study_.file->path, options_.include_dirs, node->mark, out);
    if (!path) return;
    study_.program = *path;
    program_file_ = read_source(*path, out, node->mark);
    checkable_ = program_file_ != nullptr;
}

void StudyReader::notes(const Node& node) {
    if (node.is_scalar()) return study_.notes.push_back(node.text);
    if (!read_.expect_sequence(node, "'notes'")) return;
    for (const Node& item : node.items)
        if (read_.expect_scalar(item, "a note")) study_.notes.push_back(item.text);
}

void StudyReader::cases(const Node& node) {
    if (!read_.expect_sequence(node, "'cases'")) return;
    if (node.items.empty()) read_.fail("L0202", node, "'cases' has no case");
    for (const Node& item : node.items)
        if (read_.expect_map(item, "a case")) one_case(item);
}

void StudyReader::one_case(const Node& node) {
    read_.only_keys(node, "a case", {"name", "set", "grid", "compare", "repeat"});
    PendingCase pending;
    pending.made.settings = common_;
    pending.made.repeat = common_repeat_;
    pending.place.mark = node.mark;
    if (const Node* n = node.find("name"); n && read_.identifier(*n, "a case"))
        pending.made.name = name(*n);
    if (const Node* n = node.find("set")) settings(*n, pending.made.settings);
    if (const Node* n = node.find("repeat")) pending.made.repeat = repeat(*n);
    pending.comparisons = common_comparisons_;
    if (const Node* n = node.find("compare")) comparisons(*n, pending);
    const Node* values = node.find("grid");
    if (values && node.find("name"))
        read_.fail("L0213", *node.find("name"),
                   "a grid makes many cases, which cannot share a name",
                   "leave the name out, or write the cases one by one");
    if (values) return grid(*values, pending);
    check(pending);
}

std::string StudyReader::name(const Node& node) {
    const auto [it, added] = names_.insert(node.text);
    if (!added) read_.fail("L0212", node, fmt::format("a case before has the name '{}'", *it));
    cases_known_ = cases_known_ && added;
    return *it;
}

std::int64_t StudyReader::repeat(const Node& node) const {
    const std::int64_t times = read_.integer(node).value_or(1);
    if (times >= 1) return times;
    read_.fail("L0305", node, fmt::format("'{}' is below 1: a case runs at least once", node.text));
    return 1;
}

void StudyReader::settings(const Node& node, std::vector<Setting>& into) const {
    if (!read_.expect_map(node, "'set'")) return;
    for (const auto& [key, value] : node.entries) {
        if (!read_.expect_scalar(value, "a setting")) continue;
        std::erase_if(into, [&name = key.text](const Setting& s) { return s.name == name; });
        into.push_back({key.text, value.text, key.mark, value.mark});
    }
}

void StudyReader::comparisons(const Node& node, PendingCase& pending) const {
    if (node.is_sequence()) {
        for (const Node& item : node.items)
            if (read_.expect_scalar(item, "a signal")) pending.comparisons.push_back({item, {}});
        return;
    }
    if (!read_.expect_map(node, "'compare'")) return;
    for (const auto& [signal, body] : node.entries) {
        if (!body.is_empty() && !read_.expect_map(body, "a comparison")) continue;
        read_.only_keys(body, "a comparison", {"paper", "within", "at_least", "at_most"});
        pending.comparisons.push_back({signal, body});
    }
}

/// Every combination, the last name varying fastest.
void StudyReader::grid(const Node& node, const PendingCase& common) {
    if (!read_.expect_map(node, "'grid'")) return;
    std::int64_t product = common.made.repeat;
    for (const auto& [name, values] : node.entries) {
        if (!read_.expect_sequence(values, "the values of a grid")) return;
        for (const Node& value : values.items)
            if (!read_.expect_scalar(value, "a value of a grid")) return;
        const auto count = static_cast<std::int64_t>(values.items.size());
        if (count == 0)
            return read_.fail("L0202", values,
                              fmt::format("the grid has no value of '{}'", name.text));
        if (product > most_runs / count)
            return read_.fail("L0601", name,
                              fmt::format("the grid makes {} runs or more", product * count),
                              fmt::format("a study makes at most {}", most_runs));
        product *= count;
    }
    for (std::int64_t i = 0; i < product / common.made.repeat; ++i) {
        PendingCase pending = common;
        std::int64_t rest = i;
        std::vector<Setting> chosen;
        for (auto axis = node.entries.rbegin(); axis != node.entries.rend(); ++axis) {
            const auto& values = axis->second.items;
            const auto count = static_cast<std::int64_t>(values.size());
            const Node& value = values[static_cast<std::size_t>(rest % count)];
            chosen.insert(chosen.begin(),
                          {axis->first.text, value.text, axis->first.mark, value.mark});
            rest /= count;
        }
        for (const Setting& s : chosen)
            std::erase_if(pending.made.settings,
                          [&](const Setting& old) { return old.name == s.name; });
        pending.made.settings.insert(pending.made.settings.end(), chosen.begin(), chosen.end());
        check(pending);
    }
}

/// Loads the program once with the case's settings, so that every mistake is known before the first
/// run.
void StudyReader::check(PendingCase& pending) {
    runs_ += pending.made.repeat;
    if (runs_ > most_runs) {
        if (checkable_)
            read_.fail("L0601", pending.place,
                       fmt::format("with this case the study makes {} runs or more", runs_),
                       fmt::format("a study makes at most {}", most_runs));
        checkable_ = false;
    }
    if (!checkable_ || read_.diagnostics().list().size() > enough_mistakes) return;
    LoadOptions options{.settings = pending.made.settings, .include_dirs = options_.include_dirs};
    const std::size_t before = read_.diagnostics().list().size();
    const Program program = read_program(program_file_, options, read_.diagnostics());
    const Linked linked = link(program, catalog_, read_.diagnostics());
    if (read_.diagnostics().list().size() > before) {
        cases_known_ = false;
        return;
    }
    for (const PendingComparison& comparison : pending.comparisons) {
        auto made = compare(comparison, linked.machine);
        if (!made)
            cases_known_ = false;
        else
            pending.made.comparisons.push_back(std::move(*made));
    }
    study_.cases.push_back(std::move(pending.made));
}

std::optional<Comparison> StudyReader::compare(const PendingComparison& pending,
                                               const Machine& machine) {
    const Signal* signal = machine.find(pending.signal.text);
    if (!signal) {
        std::vector<std::string> names;
        for (const Signal& s : machine.signals) names.push_back(s.name);
        read_.fail("L0203", pending.signal,
                   fmt::format("the program has no signal '{}'", pending.signal.text),
                   suggest(pending.signal.text, names));
        return {};
    }
    Comparison comparison{.signal = signal->name, .unit = signal->unit, .bounds = {}};
    if (pending.body.is_map())
        comparison.bounds = bounds(pending.body, Unit::parse(signal->unit).value());
    return comparison;
}

Bounds StudyReader::bounds(const Node& map, const Unit& unit) const {
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
void StudyReader::within(const Node& node, const Unit& unit, Bounds& bounds) const {
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

void StudyReader::claims(const Node& node) {
    if (!read_.expect_sequence(node, "'claims'")) return;
    for (const Node& item : node.items)
        if (read_.expect_map(item, "a claim")) claim(item);
}

void StudyReader::claim(const Node& node) {
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
void StudyReader::check_formula(const Node& formula) const {
    std::vector<std::string> known;
    for (const StudyCase& c : study_.cases) {
        if (c.name.empty() || c.comparisons.empty()) continue;
        known.push_back(c.name);
        for (const Comparison& k : c.comparisons) known.push_back(c.name + "." + k.signal);
    }
    if (std::ranges::any_of(study_.cases, has_paper))
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

/// At the beginning of a line.
bool has_key(const std::string& text, const std::string& key) {
    return text.starts_with(key) || text.find("\n" + key) != std::string::npos;
}

}  // namespace

bool is_study(const SourceFile& file) {
    return has_key(file.text, "lineshaft_study:");
}
bool is_program(const SourceFile& file) {
    return has_key(file.text, "lineshaft:");
}

Study read_study(std::shared_ptr<const SourceFile> file, const LoadOptions& options,
                 const Catalog& catalog, Diagnostics& out) {
    return StudyReader(options, catalog, out).read(std::move(file));
}

}  // namespace lineshaft
