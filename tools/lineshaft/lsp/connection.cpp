#include "tools/lineshaft/lsp/connection.hpp"

#include <array>
#include <charconv>

#include <fmt/format.h>
#include <poll.h>

#include "runtime/source/input_file.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::lsp {

namespace {

constexpr std::string_view end_of_head = "\r\n\r\n";
constexpr std::size_t longest_body = std::size_t{64} << 20;

std::optional<std::size_t> length_in(std::string_view head) {
    constexpr std::string_view key = "content-length:";
    const std::string small = lower(head);
    std::size_t at = small.find(key);
    if (at == small.npos) return {};
    at = std::min(small.find_first_not_of(' ', at + key.size()), small.size());
    std::size_t length = 0;
    const auto [end, error] =
        std::from_chars(small.data() + at, small.data() + small.size(), length);
    return error == std::errc() && length <= longest_body ? std::optional(length) : std::nullopt;
}

}  // namespace

std::optional<Frames::Head> Frames::head() const {
    const std::size_t end = bytes_.find(end_of_head);
    if (end == bytes_.npos) return {};
    return Head{end + end_of_head.size(), length_in(std::string_view(bytes_).substr(0, end))};
}

bool Frames::has_one() const {
    const auto found = head();
    return found && bytes_.size() >= found->bytes + found->length.value_or(0);
}

std::optional<std::string> Frames::take() {
    while (has_one()) {
        const Head found = *head();
        std::string body = bytes_.substr(found.bytes, found.length.value_or(0));
        bytes_.erase(0, found.bytes + body.size());
        if (found.length) return body;
    }
    return {};
}

std::string framed(const Json& message) {
    const std::string body = message.dump(-1, ' ', false, Json::error_handler_t::replace);
    return fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body);
}

void serve(int descriptor, const std::function<void(const std::string&)>& receive,
           const std::function<bool()>& work, const std::function<bool()>& is_ended) {
    InputFile input(descriptor);
    Frames frames;
    std::array<char, 1 << 16> part{};
    while (!is_ended()) {
        if (const auto message = frames.take()) {
            receive(*message);
            continue;
        }
        pollfd waiting{.fd = descriptor, .events = POLLIN, .revents = 0};
        if (::poll(&waiting, 1, 0) == 0 && work()) continue;
        const std::size_t count = input.read(part.data(), part.size());
        if (count == 0) break;
        frames.add({part.data(), count});
    }
    while (!is_ended() && work()) continue;
}

}  // namespace lineshaft::lsp
