#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "runtime/csv/checksum.hpp"
#include "runtime/source/input_file.hpp"

namespace lineshaft {

/// Cuts a file into lines, in constant memory.
class CsvLines {
  public:
    static constexpr std::size_t longest = 1 << 20;  ///< bytes of a line, and read at once

    explicit CsvLines(const std::string& path);

    /// The next line without its end (LF, CR LF or CR); false at the end of the file, or after an
    /// error.
    bool next(std::string_view& line);
    bool is_ended() const { return ended_; }                   ///< the last line had an end
    int error() const { return error_; }                       ///< errno, 0 when all is well
    std::string checksum() const { return checksum_.text(); }  ///< of all that was read

  private:
    void fill();
    bool find_end();

    InputFile file_;
    Checksum checksum_;
    std::string buffer_;
    std::size_t begin_ = 0, end_ = 0;
    std::size_t stop_ = 0;     ///< up to here there is no line end behind begin_
    std::size_t newline_ = 0;  ///< the next LF of what has been read; end_: none
    bool searched_ = false;    ///< for it
    bool ended_ = true;
    bool after_return_ = false;  ///< the line before ended with CR: an LF belongs to it
    int error_;
};

}  // namespace lineshaft
