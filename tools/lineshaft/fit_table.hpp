#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "runtime/fit/fit.hpp"

namespace lineshaft {

/// The values found with their standard errors and correlations, the starts, the cells, those held
/// out apart, and if wanted each left out in turn; notes, faults.
std::string fit_table(const FitPlan& plan, const FitReport& report);

/// `{"title", "parameters": [{"name", "value", "unit", "standard_error", "correlations", "from",
/// "to", "at_bound"}...], "cells": [{"set", "signal", "unit", "given", "ours", "difference",
/// "residual", "samples", "held_out", "ok"}...], "starts": [{"values", "sum", "converged"}...],
/// "left_out": [{"values", "cells", "converged"}...], "ok"}`; a trace has no given and ours, but
/// the root mean square of its differences; null where there is no number; `left_out` only if
/// wanted.
nlohmann::ordered_json fit_json(const FitPlan& plan, const FitReport& report);

/// The values found as `set:` of a study, in full.
std::string fit_settings(const FitPlan& plan, const FitReport& report);

}  // namespace lineshaft
