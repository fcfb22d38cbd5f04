#pragma once

#include <string>
#include <vector>

#include "runtime/study/report.hpp"

namespace lineshaft {

/// Names of settings that differ between cases, in order of appearance.
std::vector<std::string> varying_settings(const Study& study);

/// The value that a case sets; empty when it sets none.
std::string setting_of(const StudyCase& of, const std::string& name);

/// `<= 0.3`, `>= 1, <= 2`; empty without limits.
std::string limit_text(const Bounds& bounds, bool percent);

/// A row a case, a column a signal: `0.0217 (0.0215 .. 0.0221)`, mean, least and greatest of
/// repeats.
std::string wide_table(const Study& study, const StudyReport& report);

/// Where no paper's value has to stand beside each of ours: a table a signal, the first setting
/// that varies downwards and all others across, when the cases are every combination of those;
/// else a wide table of several signals. Empty when rows one below the other say more, as the cases
/// have different limits.
std::string matrix_tables(const Study& study, const StudyReport& report);

}  // namespace lineshaft
