#include "runtime/csv/csv_lines.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace lineshaft {

CsvLines::CsvLines(const std::string& path) : file_(path), error_(file_.error()) {
    buffer_.resize(2 * longest);
}

void CsvLines::fill() {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    stop_ -= begin_;
    begin_ = 0;
    char* const to = buffer_.data() + end_;
    const std::size_t count = file_.read(to, std::min(longest, buffer_.size() - end_));
    checksum_.add({to, count});
    end_ += count;
    searched_ = false;
    if (file_.error() != 0) error_ = file_.error();
}

/// Looks for the end of the line at begin_ in what has been read; each byte is looked at once.
bool CsvLines::find_end() {
    const auto find = [this](char wanted, std::size_t from, std::size_t to) {
        const void* found = std::memchr(buffer_.data() + from, wanted, to - from);
        return found ? static_cast<std::size_t>(static_cast<const char*>(found) - buffer_.data())
                     : to;
    };
    if (!searched_ || newline_ < stop_) newline_ = find('\n', stop_, end_);
    searched_ = true;
    stop_ = find('\r', stop_, newline_);
    return stop_ < end_;
}

bool CsvLines::next(std::string_view& line) {
    if (error_ != 0) return false;
    if (after_return_ && begin_ == end_ && !file_.is_ended()) fill();
    if (after_return_ && begin_ < end_ && buffer_[begin_] == '\n') ++begin_;
    after_return_ = false;
    stop_ = begin_;
    bool found = find_end();
    while (!found && !file_.is_ended() && error_ == 0 && end_ - begin_ <= longest) {
        fill();
        found = find_end();
    }
    if (error_ == 0 && stop_ - begin_ > longest) error_ = EFBIG;
    if (error_ != 0 || (!found && begin_ == end_)) return false;
    ended_ = found;
    after_return_ = found && buffer_[stop_] == '\r';
    line = {buffer_.data() + begin_, stop_ - begin_};
    begin_ = stop_ + (found ? 1 : 0);
    return true;
}

}  // namespace lineshaft
