#pragma once

#include <string>
#include <vector>

#include "runtime/csv/checksum.hpp"
#include "runtime/source/number_text.hpp"
#include "runtime/trace/csv_sidecar.hpp"
#include "runtime/trace/output_set.hpp"
#include "runtime/trace/recorder.hpp"

namespace lineshaft {

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

    /// What has been written so far, as its sidecar tells it.
    WrittenTable written() const;

    /// Hands the file over, with what stands in its sidecar `PATH-metadata.json`. Nothing may
    /// follow.
    void hand_over(OutputSet& files, std::string sidecar);

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
    void write(std::string_view text);
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
