#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include <fmt/format.h>

#include "runtime/csv/csv_time.hpp"
#include "runtime/fit/fit.hpp"
#include "runtime/fit/fit_form.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/study/study_reader.hpp"

namespace lineshaft {

namespace {

constexpr double default_step = 1e-3;  // of the way between the bounds

const Node& place_of(const std::optional<Node>& node, const Node& otherwise) {
    return node ? *node : otherwise;
}

/// By default named as the signal.
const Node& column_of(const ComparisonPlan& plan) {
    return place_of(plan.column, plan.signal);
}

/// Reads what a plan has in common with a study as one, and adds what is measured.
class FitReader {
  public:
    FitReader(const LoadOptions& options, const Catalog& catalog, Diagnostics& out)
        : options_(options), catalog_(catalog), read_(out) {}

    FitPlan read(std::shared_ptr<const SourceFile> file);

  private:
    void parameter(const FitParameterPlan& plan);
    StudyPlan study() const;
    void forbid(const std::vector<Setting>& settings) const;
    void join(Study&& study);
    FitCell cell(const FitCasePlan& plan, StudyCase&& run) const;
    void figures(const FitCasePlan& plan, FitCell& cell) const;
    std::optional<double> uncertainty(const ComparisonPlan& plan, const Comparison& comparison,
                                      std::optional<double> whole) const;
    void trace(const FitCasePlan& plan, FitCell& cell) const;
    Unit unit_of(const CsvColumn& column, const std::string& wanted, const Node& place) const;
    void samples(const FitCasePlan& plan, const CsvTable& table, const CsvColumn& time,
                 FitCell& cell) const;
    void check_times(const Node& place, const std::vector<std::int64_t>& times) const;
    void check_units() const;
    void check_count() const;

    LoadOptions options_;
    const Catalog& catalog_;
    Reader read_;
    FitFilePlan file_;
    FitPlan plan_;
};

FitPlan FitReader::read(std::shared_ptr<const SourceFile> file) {
    plan_.file = file;
    const auto root = parse_yaml(file, read_.diagnostics());
    if (!root || !check_kind(read_, *root, "lineshaft_fit")) return std::move(plan_);
    read_form(fit_form(), read_, *root, file_);
    plan_.starts = file_.starts;
    plan_.seed = file_.seed;
    plan_.hold_out_each = !file_.hold_out.is_empty();
    for (const FitParameterPlan& plan : file_.parameters) parameter(plan);
    forbid(file_.study.settings);
    for (const FitCasePlan& plan : file_.cases) forbid(plan.run.settings);
    const bool good = read_.diagnostics().empty();
    Study made = read_study(file, study(), options_, catalog_, read_.diagnostics());
    if (good && read_.diagnostics().empty()) join(std::move(made));
    return std::move(plan_);
}

StudyPlan FitReader::study() const {
    StudyPlan study = file_.study;
    for (const FitCasePlan& plan : file_.cases) study.cases.push_back(plan.run);
    return study;
}

/// The unit of `from` is the parameter's.
void FitReader::parameter(const FitParameterPlan& plan) {
    if (plan.from.is_empty() || plan.to.is_empty()) return;
    const auto low = read_.quantity(plan.from, "expected a bound with its unit, such as 0 ms");
    if (!low) return;
    FitParameter made{.name = plan.name.text, .unit = low->unit};
    const auto high = read_.real(plan.to, made.unit);
    if (!high) return;
    made.from = low->number;
    made.to = *high;
    if (!(made.from < made.to))
        return read_.fail(code::number_out_of_range, plan.to,
                          fmt::format("'to' is not above 'from' ({})", plan.from.text));
    const auto number = [&](const std::optional<Node>& node, double otherwise) {
        return node ? read_.real(*node, made.unit).value_or(otherwise) : otherwise;
    };
    made.start = number(plan.start, (made.from + made.to) / 2);
    if (made.start < made.from || made.start > made.to)
        read_.fail(code::number_out_of_range, *plan.start, "'start' is outside of 'from' and 'to'");
    made.step = number(plan.step, (made.to - made.from) * default_step);
    if (!(made.step > 0 && made.step <= (made.to - made.from) / 2))
        read_.fail(code::number_out_of_range, *plan.step,
                   "'step' must be above 0 and at most half of the way from 'from' to 'to'");
    options_.settings.push_back(
        {made.name, made.text(made.start), plan.name.mark, place_of(plan.start, plan.from).mark});
    plan_.parameters.push_back(std::move(made));
}

void FitReader::forbid(const std::vector<Setting>& settings) const {
    for (const Setting& setting : settings)
        for (const FitParameterPlan& parameter : file_.parameters)
            if (parameter.name.text == setting.name)
                read_.diagnostics().add(
                    code::entries_do_not_go_together, setting.mark,
                    fmt::format("'{}' is set here, and looked for as well", setting.name),
                    "leave it out, or take it out of 'parameters'");
}

void FitReader::join(Study&& study) {
    plan_.title = std::move(study.title);
    plan_.program = std::move(study.program);
    plan_.notes = std::move(study.notes);
    plan_.include_dirs = std::move(study.include_dirs);
    for (std::size_t i = 0; i < file_.cases.size(); ++i)
        plan_.cells.push_back(cell(file_.cases[i], study.make_case(static_cast<std::int64_t>(i))));
    if (!read_.diagnostics().empty()) return;
    check_units();
    check_count();
}

FitCell FitReader::cell(const FitCasePlan& plan, StudyCase&& run) const {
    FitCell made{.run = std::move(run), .hold_out = plan.hold_out};
    for (const FitParameterPlan& parameter : file_.parameters)
        std::erase_if(made.run.settings,
                      [&](const Setting& s) { return s.name == parameter.name.text; });
    if (plan.trace.file.is_empty())
        figures(plan, made);
    else
        trace(plan, made);
    return made;
}

void FitReader::figures(const FitCasePlan& plan, FitCell& cell) const {
    for (std::size_t k = 0; k < plan.run.comparisons.size(); ++k) {
        const ComparisonPlan& p = plan.run.comparisons[k];
        const Comparison& comparison = cell.run.comparisons[k];
        if (p.column)
            read_.fail(code::entry_is_missing, *p.column,
                       "the case has no 'trace' with this column",
                       "name the file in the case: trace: measured.csv");
        else if (!comparison.bounds.paper)
            read_.fail(code::entry_is_missing, p.signal,
                       fmt::format("'{}' has nothing to be compared with", comparison.name()),
                       "write what was measured, {paper: VALUE}, or the case's trace: FILE");
        else if (const auto u = uncertainty(p, comparison, comparison.bounds.paper))
            cell.targets.push_back({{*comparison.bounds.paper}, *u});
    }
}

/// 1 where it is not given; a percentage is of `whole`.
std::optional<double> FitReader::uncertainty(const ComparisonPlan& plan,
                                             const Comparison& comparison,
                                             std::optional<double> whole) const {
    if (!plan.uncertainty) return 1;
    const Node& node = *plan.uncertainty;
    const Unit unit = Unit::parse(comparison.unit).value();
    const auto size = whole ? read_.real_or_share(node, unit, *whole) : read_.real(node, unit);
    if (!size || *size > 0) return size;
    read_.fail(code::number_out_of_range, node,
               fmt::format("an uncertainty of '{}' is not above 0", node.text));
    return {};
}

void FitReader::trace(const FitCasePlan& plan, FitCell& cell) const {
    Diagnostics& out = read_.diagnostics();
    const Node& name = plan.trace.file;
    const auto path = resolve_path(name.text, plan_.file->path, plan_.include_dirs, name.mark, out);
    if (!path) return;
    if (!std::filesystem::exists(*path))
        return read_.fail(code::file_cannot_be_read, name,
                          fmt::format("there is no file '{}'", *path));
    const std::string time_name = plan.trace.time ? plan.trace.time->text : "time";
    CsvOptions csv{.columns = {time_name}};
    for (const ComparisonPlan& p : plan.run.comparisons) csv.columns.push_back(column_of(p).text);
    const auto table = read_csv(*path, out, csv);
    if (!table) return;
    if (const CsvColumn* column =
            table->require(time_name, out, place_of(plan.trace.time, name).mark))
        samples(plan, *table, *column, cell);
}

/// What the file says, else `wanted`; both measure the same.
Unit FitReader::unit_of(const CsvColumn& column, const std::string& wanted,
                        const Node& place) const {
    const Unit due = Unit::parse(wanted).value();
    if (column.unit.empty()) return due;
    const auto found = Unit::parse(column.unit);
    if (found && found->same_dimension(due)) return *found;
    read_.fail(code::unit_measures_something_else, place,
               fmt::format("column '{}' is in {}, not in {}", column.name, column.unit,
                           wanted.empty() ? "plain numbers" : wanted));
    return due;
}

void FitReader::samples(const FitCasePlan& plan, const CsvTable& table, const CsvColumn& time,
                        FitCell& cell) const {
    Diagnostics& out = read_.diagnostics();
    std::vector<const CsvColumn*> columns;
    std::vector<Unit> units;
    for (std::size_t k = 0; k < plan.run.comparisons.size(); ++k) {
        const ComparisonPlan& p = plan.run.comparisons[k];
        const Comparison& comparison = cell.run.comparisons[k];
        if (comparison.bounds.paper || comparison.bounds.judged() ||
            p.statistic == Statistic::spread)
            read_.fail(code::entries_do_not_go_together, p.signal,
                       "a signal of a trace is compared sample by sample",
                       "leave out paper, within, at_least, at_most and spread");
        const Node& place = column_of(p);
        const CsvColumn* column = table.require(place.text, out, place.mark);
        if (!column) continue;
        columns.push_back(column);
        units.push_back(unit_of(*column, comparison.unit, place));
        cell.targets.push_back({{}, uncertainty(p, comparison, {}).value_or(1)});
    }
    const Unit seconds = unit_of(time, "s", plan.trace.place);
    if (!out.empty()) return;
    for (std::size_t row = 0; row < table.rows; ++row) {
        const auto is_missing = [row](const CsvColumn* c) { return c->is_missing(row); };
        if (time.is_missing(row) || std::ranges::any_of(columns, is_missing)) continue;
        for (const CsvColumn* column : columns)
            if (!column->is_finite(row))
                return read_.fail(
                    code::measurement_cannot_be_compared, plan.trace.place,
                    fmt::format("'{}' in line {} of column '{}' is no measurement",
                                format_number(column->values[row]), line_of(row), column->name),
                    "leave the cell empty where there is no value");
        const auto at = time_of(time, row, seconds, plan.trace.offset, read_, plan.trace.file);
        if (!at) return;
        cell.times.push_back(*at);
        for (std::size_t k = 0; k < columns.size(); ++k)
            cell.targets[k].given.push_back(
                convert(columns[k]->values[row], units[k],
                        Unit::parse(cell.run.comparisons[k].unit).value()));
    }
    check_times(plan.trace.place, cell.times);
}

void FitReader::check_times(const Node& place, const std::vector<std::int64_t>& times) const {
    const char* help = "time counts from the start of the run; offset: TIME moves the trace";
    if (times.empty())
        read_.fail(code::measurement_cannot_be_compared, place,
                   "the trace has no row with all of the columns");
    else if (times.front() < 0)
        read_.fail(code::measurement_cannot_be_compared, place, "the trace begins before the run",
                   help);
    else if (std::ranges::adjacent_find(times, std::greater_equal<>{}) != times.end())
        read_.fail(code::measurement_cannot_be_compared, place,
                   "the times of the trace do not rise from row to row");
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
    for (const FitCasePlan& plan : file_.cases)
        for (const ComparisonPlan& compared : plan.run.comparisons)
            if (!compared.uncertainty)
                read_.fail(code::uncertainties_are_missing, compared.signal,
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
    read_.fail(code::too_few_figures, file_.parameters.front().name,
               fmt::format("{} parameters are looked for, but only {} {} not held out",
                           plan_.parameters.size(), kept, kept == 1 ? "figure is" : "figures are"),
               "compare more, or look for less");
}

}  // namespace

bool is_fit(const SourceFile& file) {
    return file.has_key("lineshaft_fit:");
}

FitPlan read_fit(std::shared_ptr<const SourceFile> file, const LoadOptions& options,
                 const Catalog& catalog, Diagnostics& out) {
    return FitReader(options, catalog, out).read(std::move(file));
}

}  // namespace lineshaft
