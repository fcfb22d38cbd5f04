#include "tools/lineshaft/study_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "runtime/run/signal_json.hpp"
#include "runtime/study/text_table.hpp"
#include "tools/lineshaft/study_matrix.hpp"

namespace lineshaft {

namespace {

std::string difference(double ours, const Bounds& bounds, bool percent) {
    if (!bounds.paper) return "";
    const double d = ours - *bounds.paper;
    if (percent) return fmt::format("{:+.{}f} points", d * 100, decimals(d * 100));
    if (*bounds.paper == 0) return fmt::format("{:+.4g}", d);
    const double share = d / std::abs(*bounds.paper) * 100;
    return fmt::format("{:+.2g} ({:+.{}f} %)", d, share, decimals(share));
}

std::string verdict(const Bounds& bounds, bool ok) {
    if (!bounds.judged()) return "";
    return ok ? "ok" : "FAILED";
}

std::string paper(const Bounds& bounds, bool percent) {
    return bounds.paper ? short_number(*bounds.paper, percent) : "";
}

bool has_limit(const Bounds& bounds) {
    return bounds.at_least || bounds.at_most;
}

bool has_range(const StudyRow& row) {
    return row.of->repeat > 1 && row.comparison->statistic == Statistic::mean;
}

std::string range_text(const StudyRow& row) {
    if (!has_range(row)) return "";
    return fmt::format("{} .. {}", short_number(row.least), short_number(row.greatest));
}

std::string row_table(const Study& study, const StudyReport& report) {
    const auto names = varying_settings(study);
    const auto titled = [&](const char* title, auto is_there) {
        return std::ranges::any_of(report.rows, is_there) ? title : "";
    };
    const auto has_paper = [](const StudyRow& r) { return r.comparison->bounds.paper.has_value(); };
    Cells head = names;
    head.insert(head.end(),
                {"signal", titled("paper", has_paper), "ours", titled("difference", has_paper),
                 titled("least .. greatest", has_range), titled("limit", [](const StudyRow& r) {
                     return has_limit(r.comparison->bounds);
                 })});
    std::vector<Cells> rows{head};
    for (const StudyRow& row : report.rows) {
        const Bounds& bounds = row.comparison->bounds;
        Cells cells;
        for (const std::string& name : names) cells.push_back(setting_of(*row.of, name));
        cells.push_back(row.comparison->name());
        cells.push_back(paper(bounds, false));
        cells.push_back(short_number(row.ours) +
                        (row.comparison->unit.empty() ? "" : " " + row.comparison->unit));
        cells.push_back(difference(row.ours, bounds, false));
        cells.push_back(range_text(row));
        cells.push_back(limit_text(bounds, false));
        cells.push_back(verdict(bounds, row.ok));
        rows.push_back(std::move(cells));
    }
    return align(rows);
}

std::string claim_table(const StudyReport& report) {
    const bool any_limit = std::ranges::any_of(
        report.claims, [](const ClaimRow& r) { return has_limit(r.claim->bounds); });
    std::vector<Cells> rows{{"claim", "paper", "ours", "difference", any_limit ? "limit" : ""}};
    for (const ClaimRow& row : report.claims) {
        const Claim& c = *row.claim;
        const bool known = std::isfinite(row.ours);
        rows.push_back({c.text, paper(c.bounds, c.percent),
                        known ? short_number(row.ours, c.percent) : "no number",
                        known ? difference(row.ours, c.bounds, c.percent) : "",
                        limit_text(c.bounds, c.percent),
                        row.ok ? verdict(c.bounds, true) : "FAILED"});
    }
    return align(rows);
}

nlohmann::ordered_json paper_json(const Bounds& bounds, double scale) {
    return bounds.paper ? nlohmann::ordered_json(*bounds.paper * scale)
                        : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::string study_table(const Study& study, const StudyReport& report, TableStyle style) {
    std::string rows;
    if (style == TableStyle::wide)
        rows = wide_table(study, report);
    else
        rows = matrix_tables(study, report);
    if (rows.empty()) rows = row_table(study, report);
    std::string text = study.title + "\n\n" + rows;
    if (!report.claims.empty()) text += "\n" + claim_table(report);
    for (const std::string& note : study.notes) text += "\n" + note + "\n";
    if (report.left_out > 0)
        text +=
            fmt::format("\n{} more of the {} cases are not shown\n", report.left_out, report.cases);
    for (const std::string& line : report.deviations) text += "\nexpectation failed: " + line;
    for (const std::string& line : report.faults) text += "\nfault: " + line;
    if (!report.faults.empty() || !report.deviations.empty()) text += "\n";
    return text;
}

std::string first_failure(const StudyReport& report) {
    const auto text = [](const std::string& what, double ours, const Bounds& bounds, bool percent) {
        std::string said = fmt::format("{} is {}", what, short_number(ours, percent));
        if (bounds.paper) said += fmt::format("; paper {}", short_number(*bounds.paper, percent));
        if (!bounds.within.empty())
            said +=
                fmt::format(", within {}", short_number(std::ranges::max(bounds.within), percent));
        if (has_limit(bounds)) said += fmt::format("; limit {}", limit_text(bounds, percent));
        return said;
    };
    for (const StudyRow& row : report.rows) {
        if (row.ok) continue;
        std::string what = row.comparison->name();
        for (const Setting& s : row.of->settings) what += fmt::format(", {} {}", s.name, s.value);
        return text(what, row.ours, row.comparison->bounds, false);
    }
    for (const ClaimRow& row : report.claims)
        if (!row.ok) return text(row.claim->text, row.ours, row.claim->bounds, row.claim->percent);
    return {};
}

nlohmann::ordered_json study_json(const Study& study, const StudyReport& report) {
    auto rows = nlohmann::ordered_json::array();
    for (const StudyRow& row : report.rows) {
        nlohmann::ordered_json set = nlohmann::ordered_json::object();
        for (const Setting& s : row.of->settings) set[s.name] = s.value;
        nlohmann::ordered_json object{{"case", row.of->number},
                                      {"name", row.of->name},
                                      {"set", set},
                                      {"signal", row.comparison->name()},
                                      {"unit", row.comparison->unit},
                                      {"paper", paper_json(row.comparison->bounds, 1)},
                                      {"ours", json_number(row.ours)},
                                      {"ok", row.ok}};
        if (row.of->repeat > 1) object["repeats"] = row.of->repeat;
        if (row.of->repeat > 1 && row.comparison->statistic == Statistic::mean) {
            object["least"] = json_number(row.least);
            object["greatest"] = json_number(row.greatest);
        }
        if (!row.traces.empty()) object["traces"] = row.traces;
        rows.push_back(std::move(object));
    }
    auto claims = nlohmann::ordered_json::array();
    for (const ClaimRow& row : report.claims) {
        const double scale = row.claim->percent ? 100 : 1;
        claims.push_back({{"case", nullptr},
                          {"name", ""},
                          {"set", nlohmann::ordered_json::object()},
                          {"signal", row.claim->text},
                          {"unit", row.claim->percent ? "%" : ""},
                          {"paper", paper_json(row.claim->bounds, scale)},
                          {"ours", json_number(row.ours * scale)},
                          {"ok", row.ok},
                          {"formula", row.claim->formula}});
    }
    nlohmann::ordered_json object{
        {"title", study.title}, {"notes", study.notes}, {"rows", rows}, {"claims", claims}};
    if (!report.faults.empty()) object["faults"] = report.faults;
    if (!report.deviations.empty()) object["deviations"] = report.deviations;
    object["ok"] = report.ok();
    return object;
}

}  // namespace lineshaft
