#include "runtime/serve/connection.hpp"

#include <algorithm>
#include <cstring>

#include <poll.h>
#include <sys/socket.h>

#include "runtime/serve/http.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t most_lines = 100, most_head_bytes = 16 << 10, most_request_bytes = 80 << 10;
constexpr std::int64_t millisecond = 1'000'000, request_time = 5000 * millisecond;
constexpr int idle_ms = 1000, write_ms = 5000;

/// Which of `events` have come within the time.
int wait_for(int socket, int events, std::int64_t milliseconds) {
    pollfd waiting{.fd = socket, .events = static_cast<short>(events), .revents = 0};
    return ::poll(&waiting, 1, static_cast<int>(std::max<std::int64_t>(milliseconds, 0))) > 0
               ? waiting.revents
               : 0;
}

}  // namespace

bool Connection::begin() {
    if (too_much_ || gone_ || (first_ == end_ && wait_for(socket_, POLLIN, idle_ms) == 0))
        return false;
    bytes_ = lines_ = line_ = 0;
    in_head_ = true;
    deadline_ = Pacer::now() + request_time;
    return true;
}

bool Connection::is_readable() const {
    return first_ < end_ ||
           wait_for(socket_, POLLIN, (deadline_ - Pacer::now()) / millisecond) != 0;
}

bool Connection::is_writable() const {
    return wait_for(socket_, POLLRDHUP, 0) == 0;
}

bool Connection::fill() {
    if (!is_readable()) return false;
    const ssize_t got = ::recv(socket_, buffer_.data(), buffer_.size(), 0);
    first_ = 0;
    end_ = static_cast<std::size_t>(std::max<ssize_t>(got, 0));
    return got > 0;
}

bool Connection::is_allowed(char next) {
    if (++bytes_ > most_request_bytes) return false;
    if (!in_head_) return true;
    if (next != '\r' && next != '\n') ++line_;
    if (next == '\n') {
        in_head_ = line_ > 0;
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
    const bool is_ready = (wait_for(socket_, POLLOUT, write_ms) & POLLOUT) != 0;
    const ssize_t sent = is_ready ? ::send(socket_, from, size, MSG_NOSIGNAL) : -1;
    gone_ = sent < 0;
    return sent;
}

void Connection::get_remote_ip_and_port(std::string& host, int&) const {
    host = peer_of(socket_);
}

}  // namespace lineshaft
