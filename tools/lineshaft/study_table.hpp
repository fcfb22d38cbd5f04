#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "runtime/study/report.hpp"

namespace lineshaft {

enum class TableStyle {
    fitting,  ///< matrices or a wide table where they say as much as rows, see matrix_tables()
    wide,     ///< a row a case, a column a signal
};

/// The study as a table: settings that vary, signal, paper, ours, difference, range of repeats,
/// verdict; then the claims; then what went wrong.
std::string study_table(const Study& study, const StudyReport& report,
                        TableStyle style = TableStyle::fitting);

/// The first row or claim that does not hold, in one line; empty when all do.
std::string first_failure(const StudyReport& report);

/// `{"title", "notes", "rows": [{"case", "name", "set", "signal", "unit", "paper", "ours",
/// "ok"}...], "claims": [...], "ok"}`; paper is null where there is none. A case of repeats has
/// `repeats`, `least` and `greatest`, one that was traced the files `traces`.
nlohmann::ordered_json study_json(const Study& study, const StudyReport& report);

}  // namespace lineshaft
