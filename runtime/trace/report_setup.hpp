#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "runtime/outside/outside.hpp"
#include "runtime/trace/recorder.hpp"

namespace lineshaft {

/// `report:` of the program for the sidecars of its traces, as the page takes it: `{"plots":
/// [["x.position", ...], ...], "own_axis": [...], "hide": [...], "curves": {"lag": "a.x - b.x"},
/// "paths": [{"x", "y"}], "circle": {"x", "y", "radius"},
/// "band": {"table", "within", "points"}, "while": ...}`, each where it is said;
/// lengths in the unit of the first path. Null without `report:`. L0203 for a signal that no trace
/// records, L0602 for a formula.
nlohmann::ordered_json connect_report(const Connecting& to, const std::vector<TraceSetup>& traces);

}  // namespace lineshaft
