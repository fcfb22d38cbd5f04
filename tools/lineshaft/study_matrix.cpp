#include "tools/lineshaft/study_matrix.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "runtime/study/text_table.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t most_columns = 16;

std::string titled(const Comparison& comparison) {
    return comparison.unit.empty() ? comparison.name()
                                   : fmt::format("{} [{}]", comparison.name(), comparison.unit);
}

std::string value_text(const StudyRow& row) {
    std::string text = short_number(row.ours);
    if (row.of->repeat > 1 && row.comparison->statistic == Statistic::mean)
        text += fmt::format(" ({} .. {})", short_number(row.least), short_number(row.greatest));
    return row.ok ? text : text + " FAILED";
}

/// What the rows have of it, each once, in the order in which they come.
template <class Pick>
auto distinct(const StudyReport& report, Pick pick) {
    std::vector<decltype(pick(report.rows.front()))> found;
    for (const StudyRow& row : report.rows)
        if (const auto one = pick(row); std::ranges::find(found, one) == found.end())
            found.push_back(one);
    return found;
}

std::vector<const StudyCase*> cases_of(const StudyReport& report) {
    return distinct(report, [](const StudyRow& row) { return row.of.get(); });
}

std::vector<std::string> signals_of(const StudyReport& report) {
    return distinct(report, [](const StudyRow& row) { return row.comparison->name(); });
}

const StudyRow* find(const StudyReport& report, const StudyCase* of, const std::string& signal) {
    const auto it = std::ranges::find_if(report.rows, [&](const StudyRow& row) {
        return row.of.get() == of && row.comparison->name() == signal;
    });
    return it == report.rows.end() ? nullptr : &*it;
}

bool same_limits(const Bounds& a, const Bounds& b) {
    return a.at_least == b.at_least && a.at_most == b.at_most;
}

/// Every case has every signal, with one limit and without a paper's value.
bool alike(const StudyReport& report) {
    std::map<std::string, std::pair<const Bounds*, std::size_t>> seen;
    for (const StudyRow& row : report.rows) {
        const Bounds& bounds = row.comparison->bounds;
        const auto [it, first] = seen.try_emplace(row.comparison->name(), &bounds, 0);
        if (bounds.paper || !same_limits(*it->second.first, bounds)) return false;
        ++it->second.second;
    }
    const std::size_t cases = cases_of(report).size();
    return cases > 1 &&
           std::ranges::all_of(seen, [&](const auto& one) { return one.second.second == cases; });
}

/// The values of a case's settings, `20 mm, 5 mm/s`.
std::string values_of(const StudyCase& of, std::span<const std::string> names) {
    std::string text;
    for (const std::string& name : names)
        text += fmt::format("{}{}", text.empty() ? "" : ", ", setting_of(of, name));
    return text;
}

/// Cases that are every combination of the values of settings.
struct CaseGrid {
    std::vector<std::string> rows, columns;
    std::map<std::pair<std::string, std::string>, const StudyCase*> cells;

    CaseGrid(const StudyReport& report, std::span<const std::string> names) {
        const auto note = [](std::vector<std::string>& list, const std::string& value) {
            if (std::ranges::find(list, value) == list.end()) list.push_back(value);
        };
        for (const StudyCase* of : cases_of(report)) {
            const std::string row = values_of(*of, names.first(1)),
                              column = values_of(*of, names.subspan(1));
            note(rows, row);
            note(columns, column);
            complete = cells.try_emplace({row, column}, of).second && complete;
        }
        complete = complete && cells.size() == rows.size() * columns.size() && rows.size() > 1 &&
                   columns.size() > 1 && columns.size() <= most_columns;
    }

    bool complete = true;
};

std::string matrix(const StudyReport& report, const CaseGrid& grid, const std::string& signal,
                   const std::string& corner) {
    std::vector<Cells> lines{{corner}};
    lines[0].insert(lines[0].end(), grid.columns.begin(), grid.columns.end());
    const Comparison* comparison = nullptr;
    for (const std::string& row : grid.rows) {
        Cells& cells = lines.emplace_back(Cells{row});
        for (const std::string& column : grid.columns) {
            const StudyRow* found = find(report, grid.cells.at({row, column}), signal);
            cells.push_back(value_text(*found));
            comparison = found->comparison;
        }
    }
    const std::string limit = limit_text(comparison->bounds, false);
    return titled(*comparison) + (limit.empty() ? "" : ", limit " + limit) + "\n\n" + align(lines);
}

}  // namespace

std::vector<std::string> varying_settings(const Study& study) {
    std::vector<std::string> order;
    std::map<std::string, std::set<std::string>> values;
    std::map<std::string, std::size_t> uses;
    const auto see = [&](const std::string& name, const std::string& value) {
        if (std::ranges::find(order, name) == order.end()) order.push_back(name);
        values[name].insert(value);
    };
    for (const CaseGroup& group : study.groups) {
        std::set<std::string> own;
        for (const GridAxis& axis : group.grid) own.insert(axis.name);
        for (const RandomParameter& p : group.random) own.insert(p.name);
        for (const Setting& s : group.settings)
            if (own.insert(s.name).second) see(s.name, s.value);
        for (const GridAxis& axis : group.grid)
            for (const Setting& s : axis.values) see(s.name, s.value);
        for (const RandomParameter& p : group.random)
            for (const std::int64_t index : {0, 1}) see(p.name, draw(p, group.seed, index));
        for (const std::string& name : own) ++uses[name];
    }
    std::erase_if(order, [&](const std::string& name) {
        return values[name].size() == 1 && uses[name] == study.groups.size();
    });
    return order;
}

std::string setting_of(const StudyCase& of, const std::string& name) {
    const auto it = std::ranges::find(of.settings, name, &Setting::name);
    return it == of.settings.end() ? "" : it->value;
}

std::string limit_text(const Bounds& bounds, bool percent) {
    std::string text;
    if (bounds.at_least) text = ">= " + short_number(*bounds.at_least, percent);
    if (bounds.at_most) {
        if (!text.empty()) text += ", ";
        text += "<= " + short_number(*bounds.at_most, percent);
    }
    return text;
}

std::string wide_table(const Study& study, const StudyReport& report) {
    const auto names = varying_settings(study);
    const auto signals = signals_of(report);
    Cells head = names;
    for (const std::string& signal : signals)
        head.push_back(titled(*std::ranges::find_if(report.rows, [&](const StudyRow& row) {
                                   return row.comparison->name() == signal;
                               })->comparison));
    std::vector<Cells> lines{head};
    for (const StudyCase* of : cases_of(report)) {
        Cells& cells = lines.emplace_back();
        for (const std::string& name : names) cells.push_back(setting_of(*of, name));
        for (const std::string& signal : signals) {
            const StudyRow* row = find(report, of, signal);
            cells.push_back(row ? value_text(*row) : "");
        }
    }
    return align(lines);
}

std::string matrix_tables(const Study& study, const StudyReport& report) {
    if (!alike(report)) return {};
    const auto names = varying_settings(study);
    const auto signals = signals_of(report);
    const bool limited = std::ranges::any_of(
        report.rows, [](const StudyRow& row) { return row.comparison->bounds.judged(); });
    if (names.size() >= 2) {
        const CaseGrid grid(report, names);
        const std::string across =
            fmt::format("{}", fmt::join(names.begin() + 1, names.end(), ", "));
        std::string text;
        for (const std::string& signal : grid.complete ? signals : std::vector<std::string>{})
            text += (text.empty() ? "" : "\n") +
                    matrix(report, grid, signal, names[0] + " \\ " + across);
        if (!text.empty()) return text;
    }
    return signals.size() > 1 && !limited ? wide_table(study, report) : "";
}

}  // namespace lineshaft
