#include "runtime/debug/messages.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace lineshaft::debug {

namespace {

constexpr std::size_t longest_head = 4096, longest_body = std::size_t{16} << 20;

/// What the head of a message says; empty if it says nothing of a length that can be.
std::optional<std::size_t> length_in(std::string_view head) {
    constexpr std::string_view key = "content-length:";
    std::string small(head);
    std::ranges::transform(small, small.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    std::size_t at = small.find(key);
    if (at == std::string::npos) return {};
    at = small.find_first_not_of(' ', at + key.size());
    if (at == std::string::npos) return {};
    std::size_t length = 0;
    const auto [end, error] =
        std::from_chars(small.data() + at, small.data() + small.size(), length);
    return error == std::errc() && length <= longest_body ? std::optional(length) : std::nullopt;
}

}  // namespace

Messages::Messages(int in, int out)
    : in_(in), out_(out), wake_(::eventfd(0, EFD_CLOEXEC)), thread_([this] { read_all(); }) {}

Messages::~Messages() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(wake_, &one, sizeof one);
    thread_.join();
    ::close(wake_);
}

bool Messages::read_some() {
    pollfd waits[] = {{in_, POLLIN, 0}, {wake_, POLLIN, 0}};
    if (::poll(waits, 2, -1) < 0) return errno == EINTR;
    if (waits[1].revents != 0) return false;
    char piece[1 << 16];
    const ssize_t count = ::read(in_, piece, sizeof piece);
    if (count > 0) bytes_.append(piece, static_cast<std::size_t>(count));
    return count > 0 || (count < 0 && errno == EINTR);
}

/// Empty when there will be none.
std::optional<std::string> Messages::take_body() {
    constexpr std::string_view end_of_head = "\r\n\r\n";
    std::size_t end = 0;
    while ((end = bytes_.find(end_of_head)) == std::string::npos)
        if (bytes_.size() > longest_head || !read_some()) return {};
    const auto length = length_in(std::string_view(bytes_).substr(0, end));
    if (!length) return {};
    const std::size_t first = end + end_of_head.size();
    while (bytes_.size() < first + *length)
        if (!read_some()) return {};
    std::string body = bytes_.substr(first, *length);
    bytes_.erase(0, first + *length);
    return body;
}

void Messages::read_all() {
    bool goes_on = true;
    while (goes_on) {
        const auto body = take_body();
        Json message = body ? Json::parse(*body, nullptr, false) : Json();
        goes_on = message.is_object();
        const std::lock_guard lock(mutex_);
        if (goes_on)
            messages_.push_back(std::move(message));
        else
            ended_ = true;
        ++waiting_;
        changed_.notify_all();
    }
}

std::optional<Json> Messages::next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !messages_.empty() || ended_; });
    if (messages_.empty()) return {};
    Json message = std::move(messages_.front());
    messages_.pop_front();
    --waiting_;
    return message;
}

void Messages::send(const Json& message) {
    const std::string body = message.dump(-1, ' ', false, Json::error_handler_t::replace);
    const std::string text = fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body);
    for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t count = ::write(out_, text.data() + sent, text.size() - sent);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return;
        sent += static_cast<std::size_t>(count);
    }
}

}  // namespace lineshaft::debug
