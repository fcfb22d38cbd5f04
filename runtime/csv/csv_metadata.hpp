#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "runtime/model/value.hpp"
#include "runtime/source/diagnostic.hpp"

namespace lineshaft {

/// What a trace's sidecar says (W3C CSVW): `NAME.csv-metadata.json` beside `NAME.csv`.
struct CsvMetadata {
    struct Column {
        std::string title;   ///< as the header has it
        std::string signal;  ///< as the program has it: `shaft.position`
        Type type = Type::real;
        std::string unit;                 ///< empty: none
        std::vector<std::string> values;  ///< names of an enumeration
        std::vector<Wide> numbers;        ///< of these; empty: 0, 1, 2, ...
    };

    std::string title;    ///< of the program
    std::string version;  ///< of the lineshaft that wrote it
    std::string program;  ///< Meaning::in_force of the program
    std::string form;     ///< Meaning::form of the program; empty: not told
    /// What made it, as `parameter speed`, `10 mm/s`: the program's file, parameters in force,
    /// seed, controller, forces, replays.
    std::vector<std::pair<std::string, std::string>> made_by;
    std::string stopped;               ///< why its run did not complete; empty: it did
    std::optional<std::int64_t> rows;  ///< without the header
    std::string crc32;                 ///< Checksum of all bytes of the CSV file
    std::optional<bool> intact;        ///< by its own check, see sidecar_text; empty: it has none
    std::vector<Column> columns;

    /// By title; null when there is none.
    const Column* find(std::string_view title) const;
};

/// `PATH-metadata.json`.
std::string sidecar_path(const std::string& csv_path);

/// The text of a sidecar, with the CRC-32 of itself (the eight digits taken as zeros), so that no
/// byte of it changes unnoticed.
std::string sidecar_text(nlohmann::ordered_json metadata);

/// The sidecar of a CSV file. Empty when there is none, and when it cannot be read: then L0707 says
/// why.
std::optional<CsvMetadata> read_metadata(const std::string& csv_path, Diagnostics& out);

}  // namespace lineshaft
