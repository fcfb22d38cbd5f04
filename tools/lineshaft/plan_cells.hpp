#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "runtime/source/input_file.hpp"

/// The cells that `lineshaft plan` reads and writes.
namespace lineshaft::bulk {

inline constexpr std::size_t longest_line = 65536;

/// What may stand around a cell, with the return before the line's newline.
inline constexpr std::string_view blanks = " \t\r";

/// Takes the first cell off `rest`, without blanks and quotes around it; nothing when there is
/// none.
std::optional<std::string_view> next_cell(std::optional<std::string_view>& rest);

/// What is wrong with `cell` as a number; empty when nothing is.
std::string read_number(std::string_view cell, std::string_view column, double& value);

/// `,` and the number.
void append_number(std::string& text, double value);

/// Counts the lines of a file, and tells what is wrong with the one at hand.
class CountedLines {
  public:
    explicit CountedLines(std::string file) : file_(std::move(file)) {}

    /// The next one, without the byte order mark before the first.
    std::string_view take(std::string_view text);
    void mistake(const std::string& what);
    /// What is wrong with the header, when all has been read.
    void mistake_of_header(const std::string& what);
    bool any_mistake() const { return mistakes_; }

  private:
    std::string file_;
    std::size_t number_ = 0;
    bool mistakes_ = false;
};

/// Reads what is there of a file or a pipe, and cuts it into lines, in constant memory. A line that
/// is too long is cut at its beginning.
class Lines {
  public:
    explicit Lines(InputFile& file) : file_(file), buffer_(longest_line, '\0') {}

    enum class Read { some, end, failed, interrupted };

    Read read();
    int error() const { return file_.error(); }  ///< an errno
    /// The next whole line of what has been read; at the end the last one, whatever ends it.
    bool next(std::string_view& line, bool& too_long, bool at_end);

  private:
    InputFile& file_;
    std::string buffer_;
    std::size_t begin_ = 0, end_ = 0;
    bool too_long_ = false;  ///< the line under way has lost its beginning
};

}  // namespace lineshaft::bulk
