#include "runtime/serve/connection.hpp"

#include <algorithm>

namespace lineshaft {

namespace {

constexpr std::size_t most_lines = 100, most_head_bytes = 16 << 10, most_request_bytes = 80 << 10;
constexpr std::int64_t request_time = 5 * one_second, write_time = 5 * one_second;

}  // namespace

bool Connection::begin() {
    constexpr std::int64_t patience = (idle_s + 1) * one_second;
    if (too_much_ || gone_ ||
        (first_ == end_ && !client_.socket->is_readable(world_.now() + patience)))
        return false;
    bytes_ = lines_ = line_ = 0;
    in_head_ = true;
    is_answered_ = false;
    deadline_ = world_.now() + request_time;
    return true;
}

bool Connection::is_readable() const {
    return first_ < end_ || client_.socket->is_readable(deadline_);
}

bool Connection::is_writable() const {
    return !client_.socket->has_ended();
}

bool Connection::fill() {
    first_ = 0;
    end_ = client_.socket->receive(buffer_.data(), buffer_.size(), deadline_);
    return end_ > 0;
}

bool Connection::is_allowed(char next) {
    if (++bytes_ > most_request_bytes) return false;
    if (!in_head_) return true;
    if (next != '\r' && next != '\n') ++line_;
    if (next == '\n') {
        in_head_ = line_ > 0;
        if (!in_head_) client_.has_asked(world_.now());
        line_ = 0;
        ++lines_;
    }
    return bytes_ <= most_head_bytes && lines_ <= most_lines + 2;
}

ssize_t Connection::read(char* to, std::size_t size) {
    if (too_much_ || gone_) return -1;
    if (first_ == end_ && !fill()) {
        too_much_ = true;
        return -1;
    }
    std::size_t count = 0;
    for (; count < size && first_ < end_ && !too_much_; ++first_)
        if (is_allowed(buffer_[first_]))
            to[count++] = buffer_[first_];
        else
            too_much_ = true;
    return too_much_ ? -1 : static_cast<ssize_t>(count);
}

ssize_t Connection::write(const char* from, std::size_t size) {
    if (gone_) return -1;
    if (!is_answered_) client_.has_asked(world_.now());
    is_answered_ = true;
    const std::size_t sent = client_.socket->send({from, size}, world_.now() + write_time);
    gone_ = sent == 0;
    return gone_ ? -1 : static_cast<ssize_t>(sent);
}

void Connection::get_remote_ip_and_port(std::string& host, int&) const {
    host = client_.peer;
}

}  // namespace lineshaft
