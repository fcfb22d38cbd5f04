#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "runtime/csv/csv_reader.hpp"
#include "runtime/source/diagnostic.hpp"

namespace lineshaft {

/// A trace that can be drawn: rows, a time that does not fall.
struct ReportRun {
    CsvTable table;
    std::string path, label = {};
    const CsvColumn* time = nullptr;        ///< [s]
    std::vector<const CsvColumn*> signals;  ///< all columns but `time` and `scan`
    nlohmann::ordered_json expectations = nlohmann::ordered_json::array();  ///< of the sidecar
    nlohmann::ordered_json events =
        nlohmann::ordered_json::array();  ///< the first 1,000, see EventWriter
    nlohmann::ordered_json notes = nlohmann::ordered_json::array();  ///< of the program
    nlohmann::ordered_json arrangement = {};  ///< see connect_report(); null: not said
};

/// The trace at `path`, and of its signals those named in `wanted`, or all. Empty when it cannot be
/// drawn: L0702 (unknown column), L0721 (no rows), L0722 (time falls), L0723 (a sidecar of another
/// file), or what read_csv says.
std::optional<ReportRun> read_run(const std::string& path, const std::vector<std::string>& wanted,
                                  Diagnostics& out);

/// L0724 unless both have the same signals, L0725 unless both were recorded at the same interval.
void check_overlay(const ReportRun& first, const ReportRun& second, Diagnostics& out);

/// Signals that are coordinates of one point.
struct PathPair {
    std::string x, y;
};

/// Pairs of lengths whose names differ by `x` for `y` only: x.position and y.position, path.x and
/// path.y, x_drive.position and y_drive.position.
std::vector<PathPair> find_paths(const ReportRun& run);

/// A run as tools/report/page/main.js takes it.
nlohmann::ordered_json to_json(const ReportRun& run);

}  // namespace lineshaft
