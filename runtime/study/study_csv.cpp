#include "runtime/study/study_csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "runtime/csv/csv_cells.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view separator = " | ";
constexpr std::string_view out_of_bounds = " is out of its bounds";
constexpr std::array<std::string_view, 5> fixed{"case", "name", "machine_time", "outcome",
                                                "message"};

std::string one_line(std::string text) {
    std::ranges::replace_if(
        text, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    return text;
}

std::string number(double value) {
    return std::isfinite(value) ? format_number(value) : "";
}

std::optional<double> parse_number(std::string_view text) {
    if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return value;
}

std::string message(const CaseResult& result) {
    std::vector<std::string> all = result.faults;
    all.insert(all.end(), result.deviations.begin(), result.deviations.end());
    for (std::size_t k = 0; k < result.values.size(); ++k)
        if (!result.holds(k))
            all.push_back(result.of->comparisons[k].name() + std::string(out_of_bounds));
    return one_line(fmt::format("{}", fmt::join(all, separator)));
}

/// Without those about bounds, which follow from the values.
std::vector<std::string> split_message(std::string_view text) {
    std::vector<std::string> all;
    while (!text.empty()) {
        const auto end = std::min(text.find(separator), text.size());
        if (!text.substr(0, end).ends_with(out_of_bounds)) all.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + separator.size(), text.size()));
    }
    return all;
}

std::string_view outcome(const CaseResult& result) {
    return !result.faults.empty() ? "fault" : result.ok() ? "ok" : "failed";
}

}  // namespace

/// RFC 4180, one line: cells in double quotes where they hold a comma or a quote.
static std::string join_cells(const std::vector<std::string>& cells) {
    std::string line;
    for (const std::string& cell : cells) {
        if (&cell != &cells.front()) line += ',';
        line += quoted(cell);
    }
    return line;
}

static std::vector<std::string> split_cells(std::string_view line) {
    std::vector<std::string> cells{""};
    bool inside = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool quote = line[i] == '"';
        if (quote && inside && i + 1 < line.size() && line[i + 1] == '"')
            cells.back() += line[++i];
        else if (quote)
            inside = !inside;
        else if (line[i] == ',' && !inside)
            cells.emplace_back();
        else
            cells.back() += line[i];
    }
    return cells;
}

StudyCsv::StudyCsv(const Study& study) : study_(study) {
    for (const CaseGroup& group : study.groups) learn(group);
    for (const Setting& s : study.parameters) see(s.name, s.value);
}

void StudyCsv::learn(const CaseGroup& group) {
    named_ = named_ || !group.name.empty();
    repeats_ = repeats_ || group.repeat > 1;
    for (const Setting& s : group.settings) see(s.name, s.value);
    for (const GridAxis& axis : group.grid)
        for (const Setting& s : axis.values) see(s.name, s.value);
    for (const RandomParameter& p : group.random)
        for (const std::string& value : probes(p)) see(p.name, value);
    for (const Comparison& c : group.comparisons)
        if (std::ranges::find(signals_, c.name(), &SignalColumn::name) == signals_.end())
            signals_.push_back({c.name(), c.unit, c.statistic});
}

void StudyCsv::see(const std::string& name, const std::string& value) {
    Parameter& p = parameter(name);
    const auto parsed = parse_quantity(value);
    const auto* quantity = std::get_if<Quantity>(&parsed);
    if (p.title.empty() && quantity) p.unit = quantity->unit;
    p.numeric = p.numeric && quantity && quantity->unit.same_dimension(p.unit);
    p.title = std::ranges::find(fixed, name) == fixed.end() ? name : "$" + name;
}

StudyCsv::Parameter& StudyCsv::parameter(const std::string& name) {
    const auto it = std::ranges::find(parameters_, name, &Parameter::name);
    if (it != parameters_.end()) return *it;
    return parameters_.emplace_back(Parameter{.name = name, .title = {}, .unit = {}});
}

std::vector<std::string> StudyCsv::titles() const {
    std::vector<std::string> titles{"case"};
    if (named_) titles.emplace_back("name");
    for (const Parameter& p : parameters_) titles.push_back(p.title);
    for (const SignalColumn& s : signals_) {
        titles.push_back(s.name);
        if (width(s) == 1) continue;
        titles.push_back(s.name + ".least");
        titles.push_back(s.name + ".greatest");
    }
    titles.insert(titles.end(), {"machine_time", "outcome", "message"});
    return titles;
}

std::string StudyCsv::header() const {
    return join_cells(titles()) + "\n";
}

/// What is in force; of a case that could not be loaded what it sets, or the program.
std::string StudyCsv::cell(const Parameter& p, const CaseResult& result) const {
    std::string value;
    for (const auto* settings : {&study_.parameters, &result.of->settings})
        if (const auto it = std::ranges::find(*settings, p.name, &Setting::name);
            it != settings->end())
            value = it->value;
    for (const auto& [name, in_force] : result.parameters)
        if (name == p.name) value = in_force;
    const auto parsed = parse_quantity(value);
    const auto* quantity = std::get_if<Quantity>(&parsed);
    if (!p.numeric || !quantity) return one_line(value);
    if (quantity->is_integer && quantity->unit.text == p.unit.text)
        return fmt::format("{}", quantity->integer);
    return number(convert(quantity->number, quantity->unit, p.unit));
}

/// The value that stands in a cell.
std::string StudyCsv::text(const Parameter& p, std::string_view cell) const {
    return p.numeric && !p.unit.text.empty() ? fmt::format("{} {}", cell, p.unit.text)
                                             : std::string(cell);
}

std::string StudyCsv::row(const CaseResult& result) const {
    const StudyCase& of = *result.of;
    std::vector<std::string> cells{fmt::format("{}", of.number)};
    if (named_) cells.push_back(of.name);
    for (const Parameter& p : parameters_) cells.push_back(cell(p, result));
    for (const SignalColumn& s : signals_) {
        const auto it = std::ranges::find(of.comparisons, s.name, &Comparison::name);
        const auto k = static_cast<std::size_t>(it - of.comparisons.begin());
        const bool known = k < result.values.size();
        cells.push_back(known ? number(result.values[k].ours) : "");
        if (width(s) == 1) continue;
        cells.push_back(known ? number(result.values[k].least) : "");
        cells.push_back(known ? number(result.values[k].greatest) : "");
    }
    cells.push_back(number(result.machine_seconds));
    cells.emplace_back(outcome(result));
    cells.push_back(message(result));
    return join_cells(cells) + "\n";
}

std::optional<CaseResult> StudyCsv::parse(std::string_view row) const {
    const auto cells = split_cells(row);
    const std::size_t signals = 1 + (named_ ? 1 : 0) + parameters_.size();
    std::map<std::string, std::size_t> at;
    std::size_t time = signals;
    for (const SignalColumn& s : signals_) {
        at[s.name] = time;
        time += width(s);
    }
    if (cells.size() != time + 3) return {};
    const auto index = parse_number(cells[0]);
    const double count = static_cast<double>(study_.case_count());
    if (!index || !(*index >= 1 && *index <= count) || *index != std::trunc(*index)) return {};
    CaseResult result;
    result.of =
        std::make_shared<StudyCase>(study_.make_case(static_cast<std::int64_t>(*index) - 1));
    for (std::size_t k = 0; k < parameters_.size(); ++k)
        result.parameters.emplace_back(
            parameters_[k].name, text(parameters_[k], cells[signals - parameters_.size() + k]));
    const auto seconds = parse_number(cells[time]);
    if (!seconds) return {};
    result.machine_seconds = *seconds;
    const bool fault = cells[time + 1] == "fault";
    (fault ? result.faults : result.deviations) = split_message(cells[time + 2]);
    if (fault) return result;
    for (const Comparison& c : result.of->comparisons) {
        const std::size_t first = at[c.name()];
        const bool alone = !repeats_ || c.statistic == Statistic::spread;
        const auto ours = parse_number(cells[first]);
        const auto least = alone ? ours : parse_number(cells[first + 1]);
        const auto greatest = alone ? ours : parse_number(cells[first + 2]);
        if (!ours || !least || !greatest) return {};
        result.values.push_back({*ours, *least, *greatest});
    }
    return result;
}

nlohmann::ordered_json StudyCsv::schema() const {
    auto columns = nlohmann::ordered_json::array();
    const auto add = [&](const std::string& title, const char* type, const std::string& unit) {
        columns.push_back({{"titles", title}, {"datatype", type}});
        if (!unit.empty()) columns.back()["unit"] = unit;
    };
    for (const std::string& title : titles()) {
        const auto p = std::ranges::find(parameters_, title, &Parameter::title);
        const auto s = std::ranges::find_if(signals_, [&](const SignalColumn& signal) {
            return title == signal.name || title == signal.name + ".least" ||
                   title == signal.name + ".greatest";
        });
        if (title == "case")
            add(title, "integer", "");
        else if (p != parameters_.end())
            add(title, p->numeric ? "double" : "string", p->numeric ? p->unit.text : "");
        else if (s != signals_.end())
            add(title, "double", s->unit);
        else
            add(title, title == "machine_time" ? "double" : "string",
                title == "machine_time" ? "s" : "");
    }
    return columns;
}

}  // namespace lineshaft
