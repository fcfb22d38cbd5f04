#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "runtime/csv/number_text.hpp"
#include "runtime/trace/checksum.hpp"
#include "runtime/trace/output_file.hpp"
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

/// Writes rows as RFC 4180 CSV: one header row, then `time` [s], `scan`, and a column a signal;
/// comma, newline, shortest round-trip numbers, booleans 0/1, enumerations as integers,
/// not-a-number and infinite values as an empty cell.
class CsvWriter : public TraceSink {
  public:
    CsvWriter(std::string path, const TraceSetup& setup, const CsvStyle& style = {});
    /// Goes on where save() was called.
    CsvWriter(std::string path, const TraceSetup& setup, const CsvStyle& style, StateReader& begun);

    void save(StateWriter& out);
    const std::string& error() const { return file_.error(); }

    void rows(const std::uint64_t* words, std::size_t rows) override;

    /// Closes the file and writes the CSVW sidecar `PATH-metadata.json` beside it: types, units,
    /// program and its hash, rows, a checksum, why the run stopped if it did not complete, and what
    /// came of its expectations (see verdicts_json). A sidecar of before goes first: whenever this
    /// is killed, none tells of another file. Empty when all is well, else what went wrong.
    std::string finish(const std::string& program_title, const std::string& program_text,
                       const std::string& stopped = {},
                       const nlohmann::ordered_json& expectations = {});

    /// Whether writing goes wrong. May be asked while another thread writes.
    bool failed() const { return file_.failed(); }

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
    static char* append_cell(char* end, Cell& cell, std::uint64_t bits);
    /// The text up to `end` into the file; returns where the next begins.
    char* write_out(char* end);

    OutputFile file_;
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

/// FNV-1a, 64 bits, as 16 hexadecimal digits: tells whether two traces come from the same program
/// text.
std::string text_hash(std::string_view text);

}  // namespace lineshaft
