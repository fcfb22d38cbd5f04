#include "tools/lineshaft/study_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "runtime/study/text_table.hpp"

namespace lineshaft {

namespace {

/// Names of settings that differ between cases, in order of appearance.
std::vector<std::string> varying(const Study& study) {
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

std::string setting(const StudyCase& c, const std::string& name) {
    const auto it = std::ranges::find(c.settings, name, &Setting::name);
    return it == c.settings.end() ? "" : it->value;
}

std::string difference(double ours, const Bounds& bounds, bool percent) {
    if (!bounds.paper) return "";
    const double d = ours - *bounds.paper;
    if (percent) return fmt::format("{:+.{}f} points", d * 100, decimals(d * 100));
    if (*bounds.paper == 0) return fmt::format("{:+.4g}", d);
    const double share = d / std::abs(*bounds.paper) * 100;
    return fmt::format("{:+.2g} ({:+.{}f} %)", d, share, decimals(share));
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

std::string row_table(const Study& study, const StudyReport& report) {
    const auto names = varying(study);
    const bool any_limit = std::ranges::any_of(
        report.rows, [](const StudyRow& r) { return has_limit(r.comparison->bounds); });
    Cells head = names;
    for (const char* title : {"signal", "paper", "ours", "difference"}) head.emplace_back(title);
    head.emplace_back(any_limit ? "limit" : "");
    std::vector<Cells> rows{head};
    for (const StudyRow& row : report.rows) {
        const Bounds& bounds = row.comparison->bounds;
        Cells cells;
        for (const std::string& name : names) cells.push_back(setting(*row.of, name));
        cells.push_back(row.comparison->name());
        cells.push_back(paper(bounds, false));
        cells.push_back(short_number(row.ours) +
                        (row.comparison->unit.empty() ? "" : " " + row.comparison->unit));
        cells.push_back(difference(row.ours, bounds, false));
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

nlohmann::ordered_json finite(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json paper_json(const Bounds& bounds, double scale) {
    return bounds.paper ? nlohmann::ordered_json(*bounds.paper * scale)
                        : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::string study_table(const Study& study, const StudyReport& report) {
    std::string text = study.title + "\n\n" + row_table(study, report);
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
        return fmt::format(
            "{} is {}; paper {}, limit {}", what, short_number(ours, percent),
            bounds.paper ? short_number(*bounds.paper, percent) : "none",
            bounds.at_least || bounds.at_most ? limit_text(bounds, percent) : "none");
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
        nlohmann::ordered_json object{{"set", set},
                                      {"signal", row.comparison->name()},
                                      {"unit", row.comparison->unit},
                                      {"paper", paper_json(row.comparison->bounds, 1)},
                                      {"ours", finite(row.ours)},
                                      {"ok", row.ok}};
        if (row.of->repeat > 1) object["repeats"] = row.of->repeat;
        if (row.of->repeat > 1 && row.comparison->statistic == Statistic::mean) {
            object["least"] = finite(row.least);
            object["greatest"] = finite(row.greatest);
        }
        rows.push_back(std::move(object));
    }
    auto claims = nlohmann::ordered_json::array();
    for (const ClaimRow& row : report.claims) {
        const double scale = row.claim->percent ? 100 : 1;
        claims.push_back({{"set", nlohmann::ordered_json::object()},
                          {"signal", row.claim->text},
                          {"unit", row.claim->percent ? "%" : ""},
                          {"paper", paper_json(row.claim->bounds, scale)},
                          {"ours", finite(row.ours * scale)},
                          {"ok", row.ok},
                          {"formula", row.claim->formula}});
    }
    nlohmann::ordered_json object{{"title", study.title}, {"rows", rows}, {"claims", claims}};
    if (!report.faults.empty()) object["faults"] = report.faults;
    if (!report.deviations.empty()) object["deviations"] = report.deviations;
    object["ok"] = report.ok();
    return object;
}

}  // namespace lineshaft
