#pragma once

#include <array>
#include <string>
#include <vector>

#include "runtime/trace/number_text.hpp"
#include "runtime/trace/output_file.hpp"
#include "runtime/trace/recorder.hpp"

namespace lineshaft {

/// Writes rows as RFC 4180 CSV: one header row, then `time` [s], `scan`, and a column a signal;
/// comma, newline, shortest round-trip numbers, booleans 0/1, enumerations as integers,
/// not-a-number and infinite values as an empty cell.
class CsvWriter : public TraceSink {
  public:
    CsvWriter(std::string path, const TraceSetup& setup);
    /// Goes on where save() was called.
    CsvWriter(std::string path, const TraceSetup& setup, StateReader& begun);

    void save(StateWriter& out);
    const std::string& error() const { return file_.error(); }

    void rows(const std::uint64_t* words, std::size_t rows) override;

    /// Closes the file and writes the CSVW sidecar `PATH-metadata.json` with types, units, program
    /// and its hash beside it. Empty when all is well, else what went wrong.
    std::string finish(const std::string& title, const std::string& program_text);

  private:
    /// A column's last value and its text: what stands still is not formatted again.
    struct Cell {
        std::uint64_t bits = 0;
        std::size_t length = 0;
        std::array<char, longest_number> text = {};
    };

    void make_room();
    char* append_cell(char* end, std::size_t column, std::uint64_t bits);
    /// The text up to `end` into the file; returns where the next begins.
    char* write_out(const char* end);

    OutputFile file_;
    std::string path_;
    std::vector<Signal> signals_;
    std::vector<Cell> last_;
    std::string text_;
    std::ptrdiff_t longest_row_ = 0;
    std::int64_t row_count_ = 0;
};

/// FNV-1a, 64 bits, as 16 hexadecimal digits: tells whether two traces come from the same program
/// text.
std::string text_hash(std::string_view text);

}  // namespace lineshaft
