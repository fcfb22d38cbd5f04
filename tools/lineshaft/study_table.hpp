#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "runtime/study/report.hpp"

namespace lineshaft {

/// The study as a table: settings that vary, signal, paper, ours, difference, verdict; then the
/// claims; then what went wrong.
std::string study_table(const Study& study, const StudyReport& report);

/// The first row or claim that does not hold, in one line; empty when all do.
std::string first_failure(const StudyReport& report);

/// `{"title", "rows": [{"set", "signal", "unit", "paper", "ours", "ok"}...], "claims": [...],
/// "ok"}`; paper is null where there is none.
nlohmann::ordered_json study_json(const Study& study, const StudyReport& report);

}  // namespace lineshaft
