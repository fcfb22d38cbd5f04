#include "tools/lineshaft/plan_cells.hpp"

#include <array>
#include <charconv>
#include <cstring>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/source/number_text.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft::bulk {

namespace {

/// A cell without blanks and quotes around it.
std::string_view bare(std::string_view cell) {
    cell = trimmed(cell, blanks);
    if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return cell;
    return trimmed(cell.substr(1, cell.size() - 2), blanks);
}

}  // namespace

std::string_view CountedLines::take(std::string_view text) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (++number_ == 1 && text.starts_with(byte_order_mark))
        text.remove_prefix(byte_order_mark.size());
    return text;
}

void CountedLines::mistake(const std::string& what) {
    fmt::print(stderr, "{}:{}: error: {}\n", file_, number_, what);
    mistakes_ = true;
}

void CountedLines::mistake_of_header(const std::string& what) {
    number_ = 1;
    mistake(what);
}

std::optional<std::string_view> next_cell(std::optional<std::string_view>& rest) {
    if (!rest) return {};
    const std::size_t comma = rest->find(',');
    const std::string_view cell = rest->substr(0, comma);
    if (comma == std::string_view::npos)
        rest.reset();
    else
        rest->remove_prefix(comma + 1);
    return bare(cell);
}

std::string read_number(std::string_view cell, std::string_view column, double& value) {
    if (cell.empty()) return fmt::format("column {} is empty", column);
    const bool plus = cell.size() > 1 && cell[0] == '+' && cell[1] != '-';
    const char* const end = cell.data() + cell.size();
    const auto [stop, error] = std::from_chars(cell.data() + (plus ? 1 : 0), end, value);
    if (error == std::errc::result_out_of_range && stop == end)
        return fmt::format("'{}' in column {} is beyond the range of numbers", cell, column);
    if (error != std::errc{} || stop != end)
        return fmt::format("'{}' in column {} is not a number", cell, column);
    return {};
}

void append_number(std::string& text, double value) {
    std::array<char, longest_number> digits;
    text += ',';
    text.append(digits.data(), write_real(digits.data(), value));
}

Lines::Read Lines::read() {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    if (end_ == buffer_.size()) {
        too_long_ = true;
        end_ = 1;  // at the end of the file there is still a line
    }
    const std::size_t count = file_.read(buffer_.data() + end_, buffer_.size() - end_);
    end_ += count;
    if (interrupt_requested) return Read::interrupted;
    if (file_.error() != 0) return Read::failed;
    return count == 0 ? Read::end : Read::some;
}

bool Lines::next(std::string_view& line, bool& too_long, bool at_end) {
    const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
    const std::size_t newline = rest.find('\n');
    if (newline == std::string_view::npos && (!at_end || rest.empty())) return false;
    line = rest.substr(0, newline);
    begin_ = newline == std::string_view::npos ? end_ : begin_ + newline + 1;
    too_long = too_long_;
    too_long_ = false;
    return true;
}

}  // namespace lineshaft::bulk
