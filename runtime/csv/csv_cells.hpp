#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <vector>

namespace lineshaft {

/// The end of the cell that begins at `at`: its separator, or the end of the line.
const char* cell_end(const char* at, const char* end, char separator);

/// What the cell holds, its quotes removed.
std::string unquoted(std::string_view cell);

/// As a cell of an RFC 4180 file with this separator, in quotes where it must.
std::string quoted(const std::string& text, char separator = ',');

/// What stands between the cells of a file with this header: the first ',' or ';' outside of quotes
/// and of brackets, which indices of an array stand in.
char separator_of(std::string_view header);

/// Reads a number; why a cell does not do, null when it does.
template <class Number>
const char* read_cell(const std::string& text, Number& value) {
    const char* first = text.data();
    const char* const last = first + text.size();
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') ++first;
    const auto [stop, error] = std::from_chars(first, last, value);
    if (stop != last || error == std::errc::invalid_argument) return "is not a number";
    if (error != std::errc{}) return "is beyond the range of numbers";
    return nullptr;
}

/// The cells of one line, as texts without their quotes.
std::vector<std::string> csv_cells(std::string_view line, char separator = ',');

}  // namespace lineshaft
