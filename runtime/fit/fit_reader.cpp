#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include <fmt/format.h>

#include "runtime/csv/csv_time.hpp"
#include "runtime/fit/fit.hpp"
#include "runtime/source/reader.hpp"
#include "runtime/study/study_reader.hpp"

namespace lineshaft {

namespace {

constexpr std::int64_t most_starts = 1000;
constexpr double default_step = 1e-3;  // of the way between the bounds

/// What a plan's case says beyond a study's.
struct PendingTarget {
    Node signal;
    Statistic statistic = Statistic::mean;
    Node uncertainty = {}, column = {};  ///< empty where it says nothing
};

struct PendingCell {
    Node place;
    bool hold_out = false;
    Node trace;  ///< a file's name, or a map
    std::vector<PendingTarget> targets;
};

/// Takes the value at `key` out of a map; an empty node when there is none.
Node take(Node& map, std::string_view key) {
    const auto it = std::ranges::find_if(
        map.entries, [&](const auto& entry) { return entry.first.text == key; });
    if (it == map.entries.end()) return {};
    Node value = std::move(it->second);
    map.entries.erase(it);
    return value;
}

/// By default named as the signal.
std::string column_name(const PendingTarget& target) {
    return target.column.is_empty() ? target.signal.text : target.column.text;
}

/// Reports what is not allowed, and takes it out, so that it is not reported once more.
void keep_only(const Reader& read, Node& map, std::string_view what,
               std::initializer_list<std::string_view> allowed) {
    read.only_keys(map, what, allowed);
    std::erase_if(map.entries, [&](const auto& entry) {
        return std::ranges::find(allowed, entry.first.text) == allowed.end();
    });
}

/// A plan is a study with some entries more. They are taken out of it, what is left is read as a
/// study, and the two are put together.
class FitReader {
  public:
    FitReader(const LoadOptions& options, const Catalog& catalog, Diagnostics& out)
        : options_(options), catalog_(catalog), read_(out) {}

    FitPlan read(std::shared_ptr<const SourceFile> file);

  private:
    void parameters(const Node& node);
    void parameter(const Node& name, const Node& body);
    std::optional<double> number(const Node& map, std::string_view key, const Unit& unit) const;
    void starts(const Node& starts, const Node& seed);
    void hold_out(const Node& node);
    void take_cell(Node& node);
    void forbid_settings(const Node& map) const;
    void join(Study&& study);
    FitCell cell(const PendingCell& pending, StudyCase&& run);
    void figures(const PendingCell& pending, FitCell& cell) const;
    std::optional<double> uncertainty(const PendingTarget& pending, const Comparison& comparison,
                                      std::optional<double> whole) const;
    void trace(const PendingCell& pending, FitCell& cell) const;
    Unit unit_of(const CsvColumn& column, const std::string& wanted, const Node& place) const;
    void samples(const PendingCell& pending, const CsvTable& table, const CsvColumn& time,
                 FitCell& cell) const;
    void check_times(const Node& place, const std::vector<std::int64_t>& times) const;
    void check_units() const;
    void check_count() const;

    LoadOptions options_;
    const Catalog& catalog_;
    Reader read_;
    FitPlan plan_;
    Node parameters_;
    std::vector<PendingCell> pending_;
};

FitPlan FitReader::read(std::shared_ptr<const SourceFile> file) {
    plan_.file = file;
    auto root = parse_yaml(file, read_.diagnostics());
    if (!root || !check_kind(read_, *root, "lineshaft_fit")) return std::move(plan_);
    keep_only(read_, *root, "a fit",
              {"lineshaft_fit", "title", "program", "notes", "set", "repeat", "parameters",
               "starts", "seed", "hold_out", "cases"});
    take(*root, "lineshaft_fit");
    starts(take(*root, "starts"), take(*root, "seed"));
    hold_out(take(*root, "hold_out"));
    read_.require(*root, "parameters", "a fit",
                  "say what is looked for: parameters: {lag: {from: 0 ms, to: 50 ms}}");
    parameters_ = take(*root, "parameters");
    if (!parameters_.is_empty()) parameters(parameters_);
    if (const Node* set = root->find("set"); set && set->is_map()) forbid_settings(*set);
    for (auto& [key, value] : root->entries)
        if (key.text == "cases" && value.is_sequence())
            for (Node& item : value.items) take_cell(item);
    const std::size_t before = read_.diagnostics().list().size();
    Study study = read_study(file, *root, options_, catalog_, read_.diagnostics());
    if (before == 0 && read_.diagnostics().empty()) join(std::move(study));
    return std::move(plan_);
}

void FitReader::starts(const Node& starts, const Node& seed) {
    if (!starts.is_empty()) plan_.starts = read_.integer(starts).value_or(1);
    if (plan_.starts < 1 || plan_.starts > most_starts)
        read_.fail("L0305", starts, fmt::format("'starts' is 1 to {}", most_starts));
    const std::int64_t value = seed.is_empty() ? 1 : read_.integer(seed).value_or(1);
    if (value < 0) read_.fail("L0305", seed, fmt::format("'{}' is below 0", seed.text));
    plan_.seed = static_cast<std::uint64_t>(value);
}

void FitReader::hold_out(const Node& node) {
    if (node.is_empty() || !read_.expect_scalar(node, "'hold_out'")) return;
    plan_.hold_out_each = node.text == "each";
    if (!plan_.hold_out_each)
        read_.fail("L0306", node, fmt::format("'{}' is not a way to hold out cases", node.text),
                   "write hold_out: each, or hold_out: true at a case");
}

void FitReader::parameters(const Node& node) {
    if (!read_.expect_map(node, "'parameters'")) return;
    if (node.entries.empty()) read_.fail("L0202", node, "'parameters' names none to look for");
    for (const auto& [name, body] : node.entries)
        if (read_.expect_map(body, fmt::format("parameter '{}'", name.text))) parameter(name, body);
}

/// The unit of `from` is the parameter's.
void FitReader::parameter(const Node& name, const Node& body) {
    read_.only_keys(body, "a parameter of a fit", {"from", "to", "start", "step"});
    const Node* from = read_.require(body, "from", "a parameter of a fit");
    const Node* to = read_.require(body, "to", "a parameter of a fit");
    if (!from || !to) return;
    const auto low = read_.quantity(*from, "a bound with its unit, as 0 ms");
    if (!low) return;
    FitParameter made{.name = name.text, .unit = low->unit};
    const auto high = read_.real(*to, made.unit);
    if (!high) return;
    made.from = low->number;
    made.to = *high;
    if (!(made.from < made.to))
        return read_.fail("L0305", *to, fmt::format("'to' is not above 'from' ({})", from->text));
    made.start = number(body, "start", made.unit).value_or((made.from + made.to) / 2);
    if (made.start < made.from || made.start > made.to)
        read_.fail("L0305", *body.find("start"), "'start' is outside of 'from' and 'to'");
    made.step = number(body, "step", made.unit).value_or((made.to - made.from) * default_step);
    if (!(made.step > 0 && made.step <= (made.to - made.from) / 2))
        read_.fail("L0305", *body.find("step"),
                   "'step' is above 0 and at most half of the way from 'from' to 'to'");
    const Mark value_mark = body.find("start") ? body.find("start")->mark : from->mark;
    options_.settings.push_back({made.name, made.text(made.start), name.mark, value_mark});
    plan_.parameters.push_back(std::move(made));
}

std::optional<double> FitReader::number(const Node& map, std::string_view key,
                                        const Unit& unit) const {
    const Node* node = map.find(key);
    return node ? read_.real(*node, unit) : std::nullopt;
}

void FitReader::take_cell(Node& node) {
    PendingCell pending;
    pending.place.mark = node.mark;
    if (!node.is_map()) return;
    keep_only(read_, node, "a case of a fit",
              {"name", "set", "repeat", "compare", "hold_out", "trace"});
    if (const Node hold_out = take(node, "hold_out"); !hold_out.is_empty())
        pending.hold_out = read_.boolean(hold_out).value_or(false);
    pending.trace = take(node, "trace");
    if (const Node* set = node.find("set"); set && set->is_map()) forbid_settings(*set);
    if (!read_.require(node, "compare", "a case of a fit")) return;
    for (auto& [key, value] : node.entries) {
        if (key.text != "compare") continue;
        for (const Node& signal : value.items) pending.targets.push_back({.signal = signal});
        for (auto& [signal, body] : value.entries) {
            PendingTarget target{.signal = signal};
            target.uncertainty = take(body, "uncertainty");
            target.column = take(body, "column");
            pending.targets.push_back(std::move(target));
            for (auto& [key_of_body, spread] : body.entries)
                if (key_of_body.text == "spread")
                    pending.targets.push_back({.signal = signal,
                                               .statistic = Statistic::spread,
                                               .uncertainty = take(spread, "uncertainty")});
        }
    }
    pending_.push_back(std::move(pending));
}

void FitReader::forbid_settings(const Node& map) const {
    for (const auto& [name, value] : map.entries)
        if (parameters_.find(name.text))
            read_.fail("L0213", name,
                       fmt::format("'{}' is set here, and looked for as well", name.text),
                       "leave it out, or take it out of 'parameters'");
}

void FitReader::join(Study&& study) {
    plan_.title = std::move(study.title);
    plan_.program = std::move(study.program);
    plan_.notes = std::move(study.notes);
    plan_.include_dirs = std::move(study.include_dirs);
    for (std::size_t i = 0; i < pending_.size(); ++i)
        plan_.cells.push_back(cell(pending_[i], study.make_case(static_cast<std::int64_t>(i))));
    if (!read_.diagnostics().empty()) return;
    check_units();
    check_count();
}

FitCell FitReader::cell(const PendingCell& pending, StudyCase&& run) {
    FitCell made{.run = std::move(run), .hold_out = pending.hold_out};
    std::erase_if(made.run.settings,
                  [this](const Setting& s) { return parameters_.find(s.name) != nullptr; });
    if (pending.trace.is_empty())
        figures(pending, made);
    else
        trace(pending, made);
    return made;
}

void FitReader::figures(const PendingCell& pending, FitCell& cell) const {
    for (std::size_t k = 0; k < pending.targets.size(); ++k) {
        const PendingTarget& p = pending.targets[k];
        const Comparison& comparison = cell.run.comparisons[k];
        if (!p.column.is_empty())
            read_.fail("L0202", p.column, "a column of which file? The case has no 'trace'",
                       "name the file in the case: trace: measured.csv");
        else if (!comparison.bounds.paper)
            read_.fail("L0202", p.signal,
                       fmt::format("'{}' has nothing to be compared with", comparison.name()),
                       "write what was measured, {paper: VALUE}, or the case's trace: FILE");
        else if (const auto u = uncertainty(p, comparison, comparison.bounds.paper))
            cell.targets.push_back({{*comparison.bounds.paper}, *u});
    }
}

/// 1 where it is not given; a percentage is of `whole`.
std::optional<double> FitReader::uncertainty(const PendingTarget& pending,
                                             const Comparison& comparison,
                                             std::optional<double> whole) const {
    static const Unit one;
    const Node& node = pending.uncertainty;
    if (node.is_empty()) return 1;
    const bool share = whole && node.is_scalar() && node.text.ends_with('%');
    auto size = read_.real(node, share ? one : Unit::parse(comparison.unit).value());
    if (size && share) *size *= std::abs(*whole);
    if (!size || *size > 0) return size;
    read_.fail("L0305", node, fmt::format("an uncertainty of '{}' is not above 0", node.text));
    return {};
}

/// `trace: FILE`, or `trace: {file: FILE, time: COLUMN, offset: 10 ms}`.
void FitReader::trace(const PendingCell& pending, FitCell& cell) const {
    Diagnostics& out = read_.diagnostics();
    const Node& node = pending.trace;
    if (node.is_map()) read_.only_keys(node, "a trace", {"file", "time", "offset"});
    const Node* name = node.is_map() ? read_.require(node, "file", "a trace") : &node;
    if (!name || !read_.expect_scalar(*name, "the name of a trace")) return;
    const auto path =
        resolve_path(name->text, plan_.file->path, plan_.include_dirs, name->mark, out);
    if (!path) return;
    if (!std::filesystem::exists(*path))
        return read_.fail("L0001", *name, fmt::format("there is no file '{}'", *path));
    const Node* time = node.find("time");
    const std::string time_name = time ? time->text : "time";
    CsvOptions csv{.columns = {time_name}};
    for (const PendingTarget& p : pending.targets) csv.columns.push_back(column_name(p));
    const auto table = read_csv(*path, out, csv);
    if (!table) return;
    if (const CsvColumn* column = table->require(time_name, out, time ? time->mark : name->mark))
        samples(pending, *table, *column, cell);
}

/// What the file says, else `wanted`; both measure the same.
Unit FitReader::unit_of(const CsvColumn& column, const std::string& wanted,
                        const Node& place) const {
    const Unit due = Unit::parse(wanted).value();
    if (column.unit.empty()) return due;
    const auto found = Unit::parse(column.unit);
    if (found && found->same_dimension(due)) return *found;
    read_.fail("L0303", place,
               fmt::format("column '{}' is in {}, not in {}", column.name, column.unit,
                           wanted.empty() ? "plain numbers" : wanted));
    return due;
}

void FitReader::samples(const PendingCell& pending, const CsvTable& table, const CsvColumn& time,
                        FitCell& cell) const {
    Diagnostics& out = read_.diagnostics();
    std::vector<const CsvColumn*> columns;
    std::vector<Unit> units;
    for (std::size_t k = 0; k < pending.targets.size(); ++k) {
        const PendingTarget& p = pending.targets[k];
        const Comparison& comparison = cell.run.comparisons[k];
        if (comparison.bounds.paper || comparison.bounds.judged() ||
            p.statistic == Statistic::spread)
            read_.fail("L0213", p.signal, "a signal of a trace is compared sample by sample",
                       "leave out paper, within, at_least, at_most and spread");
        const Node& place = p.column.is_empty() ? p.signal : p.column;
        const CsvColumn* column = table.require(column_name(p), out, place.mark);
        if (!column) continue;
        columns.push_back(column);
        units.push_back(unit_of(*column, comparison.unit, place));
        cell.targets.push_back({{}, uncertainty(p, comparison, {}).value_or(1)});
    }
    const Unit seconds = unit_of(time, "s", pending.trace);
    if (!out.empty()) return;
    const Node* const named = pending.trace.find("file");
    const Node* offset = pending.trace.find("offset");
    const std::int64_t shift = offset ? read_.time(*offset).value_or(0) : 0;
    for (std::size_t row = 0; row < table.rows; ++row) {
        const auto missing = [row](const CsvColumn* c) { return c->is_missing(row); };
        if (time.is_missing(row) || std::ranges::any_of(columns, missing)) continue;
        const auto at = time_of(time, row, seconds, shift, read_, named ? *named : pending.trace);
        if (!at) return;
        cell.times.push_back(*at);
        for (std::size_t k = 0; k < columns.size(); ++k)
            cell.targets[k].given.push_back(
                convert(columns[k]->values[row], units[k],
                        Unit::parse(cell.run.comparisons[k].unit).value()));
    }
    check_times(pending.trace, cell.times);
}

void FitReader::check_times(const Node& place, const std::vector<std::int64_t>& times) const {
    const char* help = "time counts from the start of the run; offset: TIME moves the trace";
    if (times.empty())
        read_.fail("L0605", place, "the trace has no row with all of the columns");
    else if (times.front() < 0)
        read_.fail("L0605", place, "the trace begins before the run", help);
    else if (std::ranges::adjacent_find(times, std::greater_equal<>{}) != times.end())
        read_.fail("L0605", place, "the times of the trace do not rise from row to row");
}

/// Differences in mm and in s cannot be added.
void FitReader::check_units() const {
    const std::string* unit = nullptr;
    bool mixed = false;
    for (const FitCell& cell : plan_.cells)
        for (const Comparison& comparison : cell.run.comparisons) {
            mixed = mixed || (unit && *unit != comparison.unit);
            unit = &comparison.unit;
        }
    if (!mixed) return;
    for (const PendingCell& pending : pending_)
        for (const PendingTarget& target : pending.targets)
            if (target.uncertainty.is_empty())
                read_.fail("L0603", target.signal,
                           "the plan compares values of different units, and this one has no "
                           "uncertainty to count its difference in",
                           "write how exact the figure is: uncertainty: 5 %");
}

/// Figures of the identification, and of the largest case when each is left out in turn.
void FitReader::check_count() const {
    std::size_t all = 0, kept = 0, largest = 0;
    for (const FitCell& cell : plan_.cells) {
        std::size_t figures = 0;
        for (const FitTarget& target : cell.targets) figures += target.given.size();
        all += figures;
        if (!cell.hold_out) kept += figures;
        largest = std::max(largest, figures);
    }
    if (plan_.hold_out_each) kept = std::min(kept, all - largest);
    if (kept >= plan_.parameters.size()) return;
    read_.fail("L0604", parameters_.entries.front().first,
               fmt::format("{} parameters are looked for, but only {} {} not held out",
                           plan_.parameters.size(), kept, kept == 1 ? "figure is" : "figures are"),
               "compare more, or look for less");
}

/// At the beginning of a line.
bool has_key(const std::string& text, const std::string& key) {
    return text.starts_with(key) || text.find("\n" + key) != std::string::npos;
}

}  // namespace

bool is_fit(const SourceFile& file) {
    return has_key(file.text, "lineshaft_fit:");
}

FitPlan read_fit(std::shared_ptr<const SourceFile> file, const LoadOptions& options,
                 const Catalog& catalog, Diagnostics& out) {
    return FitReader(options, catalog, out).read(std::move(file));
}

}  // namespace lineshaft
