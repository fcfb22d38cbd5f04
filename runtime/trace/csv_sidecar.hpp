#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "runtime/names/signal.hpp"

namespace lineshaft {

/// How a CSV file is written.
struct CsvStyle {
    enum class Names : std::uint8_t {
        dot,    ///< `shaft.position`, as in the program
        slash,  ///< `shaft/position`: PlotJuggler makes a tree of it
        snake,  ///< `shaft_position`: a name in most languages
    };

    Names names = Names::dot;
    bool units = false;  ///< in the header: `shaft.position [mm]`
    bool excel_de =
        false;  ///< semicolons between cells and decimal commas, as a German Excel reads
};

/// What made a trace, for its sidecar.
struct TraceOrigin {
    std::string title = {};               ///< of the program
    std::string program = {};             ///< Meaning::in_force of the program
    nlohmann::ordered_json run = {};      ///< see origin_of(); null: not told
    std::vector<std::string> notes = {};  ///< of the program
    nlohmann::ordered_json report = {};   ///< see connect_report(); null: not said
};

/// A CSV file of a trace.
struct WrittenTable {
    std::string path;
    std::vector<Signal> signals;  ///< behind `time` and `scan`
    CsvStyle style;
    std::int64_t rows = 0;
    std::string crc32;  ///< Checksum of its bytes
};

/// What an enumeration's names count, as a list; empty where that is 0, 1, 2, ...
nlohmann::ordered_json numbers_json(const ValueNames& names);

/// A column's title.
std::string title_of(const CsvStyle& style, std::string_view name, std::string_view unit);

/// The CSVW sidecar: types, units, what made the table, rows, a checksum, why the run stopped if it
/// did not complete, and what came of its expectations (see verdicts_json).
std::string csv_sidecar(const WrittenTable& table, const TraceOrigin& origin,
                        const std::string& stopped, const nlohmann::ordered_json& expectations);

}  // namespace lineshaft
