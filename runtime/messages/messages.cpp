#include "runtime/messages/messages.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "runtime/source/letters.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view end_of_head = "\r\n\r\n";

std::optional<std::size_t> length_in(std::string_view head) {
    constexpr std::string_view key = "content-length:";
    const std::string small = lower(head);
    std::size_t at = small.find(key);
    if (at == small.npos) return {};
    at = std::min(small.find_first_not_of(' ', at + key.size()), small.size());
    std::size_t length = 0;
    const auto [end, error] =
        std::from_chars(small.data() + at, small.data() + small.size(), length);
    return error == std::errc() && length <= Frames::longest_body ? std::optional(length)
                                                                  : std::nullopt;
}

}  // namespace

bool Frames::has_one() {
    std::size_t end = 0;
    while (head_ == 0 && (end = bytes_.find(end_of_head)) != bytes_.npos) {
        const std::size_t begin = end - std::min(end, longest_head);
        const auto length = length_in(std::string_view(bytes_).substr(begin, end - begin));
        head_ = end + end_of_head.size();
        body_ = length.value_or(0);
        if (length) break;
        bytes_.erase(0, std::exchange(head_, 0));
    }
    if (head_ == 0 && bytes_.size() > longest_head) bytes_.erase(0, bytes_.size() - longest_head);
    return head_ > 0 && bytes_.size() - head_ >= body_;
}

std::optional<std::string> Frames::take() {
    if (!has_one()) return {};
    std::string body = bytes_.substr(head_, body_);
    bytes_.erase(0, std::exchange(head_, 0) + body_);
    return body;
}

std::string text_in(const Json& from, const char* key, const std::string& otherwise) {
    const auto it = from.find(key);
    return it != from.end() && it->is_string() ? it->get<std::string>() : otherwise;
}

std::int64_t number_in(const Json& from, const char* key, std::int64_t otherwise) {
    const auto it = from.find(key);
    return it != from.end() && it->is_number_integer() ? it->get<std::int64_t>() : otherwise;
}

bool flag_in(const Json& from, const char* key, bool otherwise) {
    const auto it = from.find(key);
    return it != from.end() && it->is_boolean() ? it->get<bool>() : otherwise;
}

Json list_in(const Json& from, const char* key) {
    const auto it = from.find(key);
    return it != from.end() && it->is_array() ? *it : Json::array();
}

std::string framed(const Json& message) {
    const std::string body = message.dump(-1, ' ', false, Json::error_handler_t::replace);
    return fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body);
}

bool Messages::read_some() {
    std::array<char, 1 << 16> part{};
    const std::size_t count = input_.read(part.data(), part.size());
    frames_.add({part.data(), count});
    return count > 0;
}

std::optional<std::string> Messages::next() {
    while (!frames_.has_one())
        if (!read_some()) return {};
    return frames_.take();
}

bool Messages::waits() {
    while (!frames_.has_one()) {
        pollfd ready{.fd = in_, .events = POLLIN, .revents = 0};
        if (interrupt_requested) return true;
        if (::poll(&ready, 1, 0) <= 0) return false;
        if (!read_some()) return true;
    }
    return true;
}

void Messages::send(const Json& message) {
    const std::string text = framed(message);
    for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t count = ::write(out_, text.data() + sent, text.size() - sent);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return;
        sent += static_cast<std::size_t>(count);
    }
}

}  // namespace lineshaft
