#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "runtime/csv/checksum.hpp"
#include "runtime/source/number_text.hpp"
#include "runtime/trace/output_set.hpp"
#include "runtime/trace/recorder.hpp"

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
    std::string title = {};              ///< of the program
    std::string program = {};            ///< Meaning::in_force of the program
    nlohmann::ordered_json run = {};     ///< see origin_of(); null: not told
    nlohmann::ordered_json notes = {};   ///< of the program, a list; null: none
    nlohmann::ordered_json report = {};  ///< see connect_report(); null: not said
};

/// Writes rows as RFC 4180 CSV: one header row, then `time` [s], `scan`, and a column a signal;
/// comma, newline, shortest round-trip numbers, booleans 0/1, enumerations as integers,
/// not-a-number and infinite values as an empty cell.
class CsvWriter : public TraceSink {
  public:
    CsvWriter(std::string path, const TraceSetup& setup, const CsvStyle& style = {});
    /// Goes on where save() was called.
    CsvWriter(std::string path, const TraceSetup& setup, const CsvStyle& style, StateReader& begun);

    void save(StateWriter& out);
    const std::string& error() const { return file_->error(); }

    void rows(const std::uint64_t* words, std::size_t rows) override;

    /// Hands the file over, with its CSVW sidecar `PATH-metadata.json`: types, units, what made it,
    /// rows, a checksum, why the run stopped if it did not complete, and what came of its
    /// expectations (see verdicts_json). Nothing may follow.
    void finish(OutputSet& files, const TraceOrigin& origin, const std::string& stopped = {},
                const nlohmann::ordered_json& expectations = {});

    /// Whether writing goes wrong. May be asked while another thread writes.
    bool failed() const { return file_->failed(); }

  private:
    /// A column's last value, and where in `text_` it stands: what stands still is not formatted
    /// again.
    struct Cell {
        Type type;
        std::uint64_t bits = 0;
        const char* text = nullptr;  ///< null: not yet in `text_`
        std::size_t length = 0;
    };

    void make_room();
    std::string title(std::string_view name, std::string_view unit) const;
    void write(std::string_view text);
    std::string sidecar(const TraceOrigin& origin, const std::string& stopped,
                        const nlohmann::ordered_json& expectations) const;
    static char* append_cell(char* end, Cell& cell, std::uint64_t bits);
    /// The text up to `end` into the file; returns where the next begins.
    char* write_out(char* end);

    std::unique_ptr<OutputFile> file_;
    std::string path_;
    std::vector<Signal> signals_;
    CsvStyle style_;
    char separator_;
    std::vector<Cell> cells_;
    std::string text_;
    std::ptrdiff_t longest_row_ = 0;
    std::int64_t row_count_ = 0;
    Checksum checksum_;  ///< of all that was written
};

}  // namespace lineshaft
