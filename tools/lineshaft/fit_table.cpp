#include "tools/lineshaft/fit_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "runtime/run/signal_json.hpp"
#include "runtime/study/text_table.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

constexpr double same_sum = 0.01;  // relative difference of starts that ended alike

std::string with_unit(double value, const std::string& unit) {
    return short_number(value) + (unit.empty() ? "" : " " + unit);
}

/// As many digits as the standard error bears out, and two of it.
int digits_after_point(const FitValue& v) {
    if (!(v.standard_error > 0)) return 6;
    return std::clamp(1 - static_cast<int>(std::floor(std::log10(v.standard_error))), 0, 12);
}

std::string value_table(const FitReport& report) {
    std::vector<Cells> rows{{"parameter", "value", "standard error", "from", "to", ""}};
    for (const FitValue& v : report.values) {
        const FitParameter& p = *v.parameter;
        const int digits = digits_after_point(v);
        const std::string unit = p.unit.text.empty() ? "" : " " + p.unit.text;
        const bool known = std::isfinite(v.standard_error);
        rows.push_back(
            {p.name, fmt::format("{:.{}f}{}", v.value, digits, unit),
             known ? fmt::format("{:.{}f}{}", v.standard_error, digits, unit) : "not determined",
             p.text(p.from), p.text(p.to), v.at_bound ? "AT ITS BOUND" : ""});
    }
    return align(rows);
}

std::string row_table(const char* title, const std::vector<const FitRow*>& of) {
    std::vector<Cells> rows{{title, "signal", "given", "ours", "difference", "residual", ""}};
    for (const FitRow* one : of) {
        const FitRow& row = *one;
        const Comparison& c = *row.comparison;
        const bool trace = !row.cell->times.empty();
        const double share = row.difference / std::abs(row.given) * 100;
        rows.push_back({describe(row.cell->run), c.name(),
                        trace ? fmt::format("{} samples", row.samples) : short_number(row.given),
                        trace ? "" : with_unit(row.ours, c.unit),
                        trace ? "rms " + with_unit(row.difference, c.unit)
                              : fmt::format("{:+.2g}{}", row.difference,
                                            row.given == 0 ? ""
                                                           : fmt::format(" ({:+.{}f} %)", share,
                                                                         decimals(share))),
                        fmt::format("{:.3g}", row.residual),
                        c.bounds.judged() ? (row.ok ? "ok" : "FAILED") : ""});
    }
    return rows.size() == 1 ? "" : align(rows);
}

std::string cell_table(const FitReport& report, bool held_out) {
    std::vector<const FitRow*> rows;
    for (const FitRow& row : report.rows)
        if (row.cell->hold_out == held_out) rows.push_back(&row);
    return row_table(held_out ? "held-out cell" : "cell", rows);
}

/// How the parameters' errors go together; nothing to say of one.
std::string correlation_table(const FitReport& report) {
    if (report.values.size() < 2) return "";
    std::vector<Cells> rows{{"correlation"}};
    for (const FitValue& v : report.values) rows.front().push_back(v.parameter->name);
    for (const FitValue& v : report.values) {
        rows.push_back({v.parameter->name});
        for (const double r : v.correlations)
            rows.back().push_back(std::isfinite(r) ? fmt::format("{:.2f}", r) : "");
    }
    return "\n" + align(rows);
}

/// A line a signal: how far off the predictions are.
std::string error_table(const std::vector<const FitRow*>& of) {
    std::vector<std::string> names;
    for (const FitRow* row : of)
        if (std::ranges::find(names, row->comparison->name()) == names.end())
            names.push_back(row->comparison->name());
    std::vector<Cells> table{{"errors of", "figures", "mean", "greatest", "root mean square"}};
    for (const std::string& name : names) {
        double count = 0, sum = 0, greatest = 0, squares = 0;
        const std::string* unit = nullptr;
        for (const FitRow* row : of) {
            if (row->comparison->name() != name) continue;
            const double share = std::abs(row->difference / row->given) * 100;
            unit = &row->comparison->unit;
            ++count;
            sum += share;
            greatest = std::max(greatest, share);
            squares += row->difference * row->difference;
        }
        const auto percent = [](double value) {
            return std::isfinite(value) ? fmt::format("{:.{}f} %", value, decimals(value)) : "";
        };
        table.push_back({name, fmt::format("{}", count), percent(sum / count), percent(greatest),
                         with_unit(std::sqrt(squares / count), *unit)});
    }
    return align(table);
}

/// The values without each cell, and what that says of their errors.
std::string left_out_values(const FitReport& report) {
    std::vector<Cells> rows{{"without"}, {"jackknife standard error"}};
    for (std::size_t i = 0; i < report.values.size(); ++i) {
        const FitValue& v = report.values[i];
        const int digits = digits_after_point(v);
        const std::string unit = v.parameter->unit.text.empty() ? "" : " " + v.parameter->unit.text;
        rows[0].push_back(v.parameter->name);
        rows[1].push_back(
            fmt::format("{:.{}f}{}", jackknife_error(report.left_out, i), digits, unit));
    }
    for (const FitLeftOut& one : report.left_out) {
        Cells cells{describe(one.cell->run)};
        for (std::size_t i = 0; i < report.values.size(); ++i)
            cells.push_back(
                fmt::format("{:.{}f}", one.values[i], digits_after_point(report.values[i])));
        if (!one.converged) cells.push_back("not converged");
        rows.insert(rows.end() - 1, cells);
    }
    return align(rows);
}

std::string left_out_tables(const FitReport& report) {
    std::vector<const FitRow*> rows;
    for (const FitLeftOut& one : report.left_out)
        for (const FitRow& row : one.rows) rows.push_back(&row);
    if (rows.empty()) return "";
    return "\nEach case left out in turn, predicted from all the others:\n\n" +
           row_table("left-out cell", rows) + "\n" + error_table(rows) + "\n" +
           left_out_values(report);
}

std::string start_line(const FitReport& report) {
    const double least = report.starts[report.best].sum;
    const auto alike = std::ranges::count_if(report.starts, [&](const FitStart& start) {
        return start.sum - least <= same_sum * least;
    });
    const bool converged = report.starts[report.best].converged;
    return fmt::format("sum of squares {:.6g} in uncertainties; {} of {} starts ended there{}\n",
                       least, alike, report.starts.size(),
                       converged ? "" : "; the search had not converged");
}

Json row_json(const FitRow& row) {
    Json set = Json::object();
    for (const Setting& s : row.cell->run.settings) set[s.name] = s.value;
    const bool trace = !row.cell->times.empty();
    return {{"name", row.cell->run.name},
            {"set", set},
            {"signal", row.comparison->name()},
            {"unit", row.comparison->unit},
            {"given", trace ? Json(nullptr) : Json(row.given)},
            {"ours", trace ? Json(nullptr) : json_number(row.ours)},
            {"difference", json_number(row.difference)},
            {"residual", json_number(row.residual)},
            {"samples", row.samples},
            {"held_out", row.cell->hold_out},
            {"ok", row.ok}};
}

Json numbers(const std::vector<double>& values) {
    Json list = Json::array();
    for (const double value : values) list.push_back(json_number(value));
    return list;
}

Json left_out_json(const FitLeftOut& one) {
    Json rows = Json::array();
    for (const FitRow& row : one.rows) rows.push_back(row_json(row));
    return {{"values", numbers(one.values)}, {"cells", rows}, {"converged", one.converged}};
}

}  // namespace

std::string fit_table(const FitPlan& plan, const FitReport& report) {
    std::string text = plan.title + "\n\n";
    if (report.values.empty())
        text += "No start could be evaluated: the program does not run there.\n";
    else
        text += value_table(report) + start_line(report) + correlation_table(report);
    for (const bool held_out : {false, true})
        if (const std::string table = cell_table(report, held_out); !table.empty())
            text += "\n" + table;
    text += left_out_tables(report);
    for (const std::string& note : plan.notes) text += "\n" + note + "\n";
    for (const std::string& line : report.faults) text += "\nfault: " + line + "\n";
    return text;
}

Json fit_json(const FitPlan& plan, const FitReport& report) {
    Json parameters = Json::array(), cells = Json::array(), starts = Json::array();
    for (const FitValue& v : report.values)
        parameters.push_back({{"name", v.parameter->name},
                              {"value", json_number(v.value)},
                              {"unit", v.parameter->unit.text},
                              {"standard_error", json_number(v.standard_error)},
                              {"correlations", numbers(v.correlations)},
                              {"from", v.parameter->from},
                              {"to", v.parameter->to},
                              {"at_bound", v.at_bound}});
    for (const FitRow& row : report.rows) cells.push_back(row_json(row));
    for (const FitStart& start : report.starts)
        starts.push_back({{"values", start.values},
                          {"sum", json_number(start.sum)},
                          {"converged", start.converged}});
    Json object{{"title", plan.title},
                {"parameters", parameters},
                {"cells", cells},
                {"starts", starts},
                {"runs", report.runs}};
    for (const FitLeftOut& one : report.left_out) object["left_out"].push_back(left_out_json(one));
    if (!report.faults.empty()) object["faults"] = report.faults;
    object["ok"] = report.ok();
    return object;
}

std::string fit_settings(const FitPlan& plan, const FitReport& report) {
    std::string text = fmt::format("# Identified: {}\nset:\n", plan.title);
    for (const FitValue& v : report.values)
        text += fmt::format("  {}: {}\n", v.parameter->name, v.parameter->text(v.value));
    return text;
}

}  // namespace lineshaft
