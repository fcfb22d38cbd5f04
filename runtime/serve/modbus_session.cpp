#include "runtime/serve/modbus_session.hpp"

#include <array>

#include "runtime/serve/address.hpp"

namespace lineshaft {

namespace {

/// Transaction, protocol and length, of two bytes each; the length counts what follows it: unit,
/// function code and data.
constexpr std::size_t length_end = 6, header = 7, least_length = 2, most_length = 254;

std::size_t word(std::string_view bytes, std::size_t at) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[at]) << 8 |
                                    static_cast<unsigned char>(bytes[at + 1]));
}

}  // namespace

std::string ModbusSession::take(std::string_view bytes) {
    std::string answers;
    kept_ += bytes;
    std::string_view rest = kept_;
    while (!is_lost_ && rest.size() >= length_end) {
        const std::size_t length = word(rest, 4), size = length_end + length;
        is_lost_ = length < least_length || length > most_length;
        if (is_lost_ || rest.size() < size) break;
        answers += answer(rest.substr(0, size));
        rest.remove_prefix(size);
    }
    kept_ = is_lost_ ? "" : std::string(rest);
    return answers;
}

std::string ModbusSession::answer(std::string_view frame) {
    if (word(frame, 2) != 0) return {};
    const std::string data = desk_.answer(frame.substr(header), peer_);
    const std::size_t length = 1 + data.size();
    std::string answer(frame.substr(0, 4));
    answer += {static_cast<char>(length >> 8), static_cast<char>(length & 0xFF), frame[6]};
    return answer + data;
}

void converse(ModbusDesk& desk, Client& client, World& world) {
    constexpr std::int64_t idle = 300 * one_second, answer_time = 5 * one_second;
    ModbusSession session(desk, {client.peer, Address{client.peer}.is_loopback()});
    std::array<char, 4096> bytes;
    while (!session.is_lost()) {
        const std::size_t count =
            client.socket->receive(bytes.data(), bytes.size(), world.now() + idle);
        if (count == 0) return;
        const std::string answers = session.take({bytes.data(), count});
        if (!answers.empty()) client.has_asked(world.now());
        for (std::string_view rest = answers; !rest.empty();) {
            const std::size_t sent = client.socket->send(rest, world.now() + answer_time);
            if (sent == 0) return;
            rest.remove_prefix(sent);
        }
    }
}

}  // namespace lineshaft
