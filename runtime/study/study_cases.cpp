#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/study/study_file_reader.hpp"

namespace lineshaft {

namespace {

/// No further case is checked: a grid may make many of one mistake.
constexpr std::size_t enough_mistakes = 100;

/// 3 x 1000.
std::string product_text(const CaseGroup& group) {
    std::string text;
    const auto times = [&](std::int64_t factor) {
        text += fmt::format("{}{}", text.empty() ? "" : " x ", factor);
    };
    for (const GridAxis& axis : group.grid) times(static_cast<std::int64_t>(axis.values.size()));
    if (!group.random.empty()) times(group.draws);
    if (group.repeat > 1 || text.empty()) times(group.repeat);
    return text;
}

/// The greatest number instead of a product beyond it.
std::int64_t product(std::int64_t a, std::int64_t b) {
    constexpr auto greatest = std::numeric_limits<std::int64_t>::max();
    return a > greatest / b ? greatest : a * b;
}

/// In place of settings of the same names.
void merge(std::vector<Setting>& into, const std::vector<Setting>& settings) {
    for (const Setting& setting : settings) {
        std::erase_if(into, [&](const Setting& s) { return s.name == setting.name; });
        into.push_back(setting);
    }
}

}  // namespace

void StudyFileReader::one_case(const CasePlan& plan) {
    CaseGroup group{.mark = plan.mark,
                    .name = plan.name.text,
                    .settings = common_,
                    .grid = plan.grid,
                    .random = plan.random,
                    .draws = plan.draws,
                    .seed = plan.seed,
                    .comparisons = {},
                    .repeat = plan.repeat.value_or(plan_.repeat)};
    check_name(plan.name);
    merge(group.settings, plan.settings);
    cases_known_ = cases_known_ && plan.usable;
    if (plan.usable && count(group, plan.size_mark)) check(group, plan.comparisons);
}

void StudyFileReader::check_name(const Node& name) {
    if (name.is_empty() || names_.insert(name.text).second) return;
    read_.fail(code::named_twice, name, fmt::format("a case before has the name '{}'", name.text));
    cases_known_ = false;
}

/// How many cases, and where they stand in the study.
bool StudyFileReader::count(CaseGroup& group, const Mark& place) {
    for (const GridAxis& axis : group.grid)
        group.count = product(group.count, static_cast<std::int64_t>(axis.values.size()));
    group.count = product(group.count, group.draws);
    group.first = study_.case_count();
    const std::int64_t runs = product(group.count, group.repeat);
    const std::string limit = fmt::format("a study makes at most {}", most_runs);
    if (runs > most_runs) {
        const std::string text = product_text(group);
        const bool beyond = runs == std::numeric_limits<std::int64_t>::max();
        read_.diagnostics().add(code::too_many_runs, place,
                                beyond
                                    ? fmt::format("this makes {} runs, which is beyond 2^63", text)
                                : text.find('x') == std::string::npos
                                    ? fmt::format("this makes {} runs", runs)
                                    : fmt::format("this makes {} = {} runs", text, runs),
                                limit);
    } else if (runs_ <= most_runs && runs_ + runs > most_runs) {
        read_.diagnostics().add(code::too_many_runs, group.mark,
                                fmt::format("with this case the study makes {} runs", runs_ + runs),
                                limit);
    }
    if (runs > most_runs || runs_ + runs > most_runs) {
        checkable_ = false;
        runs_ = most_runs + 1;
        return false;
    }
    runs_ += runs;
    return true;
}

bool StudyFileReader::enough() const {
    return !checkable_ || read_.diagnostics().count() > enough_mistakes;
}

/// Loads the program with the settings of the group's first case, which gives the units of what is
/// compared; then once with each other value, so that a mistake is known before the first run. What
/// is wrong with a combination of values only is told by its case.
void StudyFileReader::check(CaseGroup& group, const std::vector<ComparisonPlan>& plans) {
    if (enough()) return;
    study_.groups.push_back(std::move(group));
    CaseGroup& kept = study_.groups.back();
    const StudyCase first = study_.make_case(kept.first);
    const auto loaded = load(first.settings);
    if (!loaded) {
        cases_known_ = false;
        return;
    }
    learn(loaded->program);
    for (const std::vector<ComparisonPlan>* compared : {&std::as_const(plan_.comparisons), &plans})
        for (const ComparisonPlan& comparison : *compared)
            compare(comparison, loaded->linked.machine, kept);
    if (check_ == StudyCheck::values) check_values(kept, first.settings);
}

void StudyFileReader::learn(const Program& program) {
    study_.traced = !program.traces.empty();
    if (!study_.parameters.empty()) return;
    for (const auto& [name, value] : program.parameters) study_.parameters.push_back({name, value});
}

void StudyFileReader::check_values(const CaseGroup& group, const std::vector<Setting>& base) {
    for (const Setting& setting : base) checked_.emplace(setting.name, setting.value);
    for (const GridAxis& axis : group.grid)
        for (const Setting& value : axis.values) check_value(base, value);
    for (const RandomParameter& p : group.random)
        for (const std::string& value : probes(p))
            check_value(base, {p.name, value, group.mark, p.mark});
}

void StudyFileReader::check_value(std::vector<Setting> settings, const Setting& value) {
    if (enough() || !checked_.emplace(value.name, value.value).second) return;
    for (Setting& setting : settings)
        if (setting.name == value.name) setting = value;
    if (!load(settings)) cases_known_ = false;
}

/// Empty when anything was wrong.
std::optional<Loaded> StudyFileReader::load(const std::vector<Setting>& settings) {
    const LoadOptions options{
        .settings = settings, .include_dirs = options_.include_dirs, .files = &files_};
    const std::size_t before = read_.diagnostics().count();
    Loaded loaded{.program = read_program(program_file_, options, read_.diagnostics()),
                  .linked = {}};
    loaded.linked = link(loaded.program, catalog_, read_.diagnostics(),
                         sources_.kinds(loaded.program, catalog_));
    if (read_.diagnostics().count() > before) return {};
    return loaded;
}

}  // namespace lineshaft
