#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "runtime/source/input_file.hpp"

/// The cells that `lineshaft plan` reads and writes.
namespace lineshaft::bulk {

inline constexpr std::size_t longest_line = 65536;

/// Without blanks around it, and the return before its newline.
std::string_view trimmed(std::string_view text);

/// Takes the first cell off `rest`, without blanks and quotes around it; nothing when there is
/// none.
std::optional<std::string_view> next_cell(std::optional<std::string_view>& rest);

/// What is wrong with `cell` as a number; empty when nothing is.
std::string read_number(std::string_view cell, std::string_view column, double& value);

/// `,` and the number.
void append_number(std::string& text, double value);

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
