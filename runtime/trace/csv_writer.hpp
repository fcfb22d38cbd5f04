#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "runtime/trace/recorder.hpp"

namespace lineshaft {

/// A file that appears under its name only when it is whole: written as `NAME.part`, then flushed to the disk
/// and renamed. What has been written when something goes wrong stays in `NAME.part`.
class OutputFile {
  public:
    explicit OutputFile(std::string path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view text);
    /// False when any step failed: see error().
    bool commit();

    /// `cannot write 'x.csv': No space left on device`; empty while all is well.
    const std::string& error() const { return error_; }

  private:
    void fail(const char* what);

    std::string path_;
    std::string part_;
    std::FILE* file_ = nullptr;
    std::string error_;
};

/// Writes rows as RFC 4180 CSV: one header row, then `time` [s], `scan`, and a column a signal; comma,
/// newline, shortest round-trip numbers, booleans 0/1, enumerations as integers, not-a-number and infinite
/// values as an empty cell.
class CsvWriter : public TraceSink {
  public:
    CsvWriter(std::string path, const TraceSetup& setup);

    void rows(const std::uint64_t* words, std::size_t rows) override;

    /// Closes the file and writes the CSVW sidecar `PATH-metadata.json` with types, units, program and its
    /// hash beside it. Empty when all is well, else what went wrong.
    std::string finish(const std::string& title, const std::string& program_text);

  private:
    OutputFile file_;
    std::string path_;
    std::vector<Signal> signals_;
    std::string row_;  ///< room for one row
    std::int64_t row_count_ = 0;
};

/// FNV-1a, 64 bits, as 16 hexadecimal digits: tells whether two traces come from the same program text.
std::string text_hash(std::string_view text);

}  // namespace lineshaft
