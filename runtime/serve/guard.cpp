#include "runtime/serve/guard.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t most_machines = 1000;  ///< that are told apart; the others are as one
constexpr const char* any_other = "others";

/// Takes as long for a wrong token as for the right one.
bool is_same(std::string_view a, std::string_view b) {
    unsigned difference = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        difference |= static_cast<unsigned>(a[i] ^ b[i]);
    return difference == 0;
}

/// What follows `Bearer`, in any case; none for another way to prove who one is.
std::optional<std::string_view> bearer(std::string_view authorization) {
    constexpr std::string_view scheme = "bearer ";
    if (authorization.size() < scheme.size() ||
        !std::equal(scheme.begin(), scheme.end(), authorization.begin(), [](char a, char b) {
            return a == (b >= 'A' && b <= 'Z' ? static_cast<char>(b | ' ') : b);
        }))
        return {};
    authorization.remove_prefix(scheme.size());
    while (authorization.starts_with(' ')) authorization.remove_prefix(1);
    return authorization;
}

template <class Count>
Count& of(std::map<std::string, Count>& counts, const std::string& whom) {
    const auto it = counts.find(whom);
    if (it != counts.end()) return it->second;
    return counts[counts.size() < most_machines ? whom : any_other];
}

}  // namespace

bool Guard::is_known(const std::string& host) const {
    const std::string name =
        host.substr(0, host.starts_with('[') ? host.find(']') + 1 : host.find(':'));
    return name == "localhost" || Address::parse(name + ":1").has_value();
}

Guard::Token Guard::token_of(const Visitor& visitor) const {
    const auto given = bearer(visitor.authorization);
    if (options_.token.empty() || !given) return Token::none;
    return is_same(*given, options_.token) ? Token::right : Token::wrong;
}

bool Guard::is_too_much(const std::string& of_whom) {
    const std::int64_t now = world_.now() / one_second;
    const std::lock_guard lock(mutex_);
    if (now != second_) requests_.clear();
    second_ = now;
    return ++of(requests_, of_whom) > options_.most_requests;
}

/// Told of the first one, the tenth, the hundredth and so on.
void Guard::slow_down(const std::string& peer) {
    constexpr std::int64_t step = one_second / 10, most = 2 * one_second;
    int count = 0;
    {
        const std::lock_guard lock(mutex_);
        count = ++of(wrong_, peer);
    }
    int power = count;
    while (power % 10 == 0) power /= 10;
    if (power == 1 && tell_)
        tell_(fmt::format("{} has sent a wrong token, {} so far", peer, count));
    world_.sleep_until(world_.now() + std::min(count * step, most));
}

/// A name in Host that is not this machine's is that of a page that a browser was led astray by.
std::optional<ApiReply> Guard::refuse(const Visitor& visitor, bool writes) {
    const Token token = token_of(visitor);
    if (is_too_much(token == Token::right ? "the token" : visitor.peer))
        return failure(429, "too many requests", "ask less often");
    if (!is_known(visitor.host))
        return failure(403, "this is not the address of the machine", "use its number",
                       code::request_not_allowed);
    if (!visitor.origin.empty() && visitor.origin != "http://" + visitor.host)
        return failure(403, "a page of another origin asks", "open the machine's own",
                       code::request_not_allowed);
    if (token == Token::wrong) {
        slow_down(visitor.peer);
        return failure(403, "this is not the token", "send the one that --token-file has",
                       code::request_not_allowed);
    }
    if (!writes) return {};
    if (!options_.allow_write)
        return failure(403, "this machine is only looked at",
                       "serve it with --allow-write to change something",
                       code::request_not_allowed);
    if (token != Token::right && !Address{visitor.peer}.is_loopback())
        return failure(403, "writing from another machine takes the token",
                       "send 'Authorization: Bearer TOKEN', as --token-file has it",
                       code::request_not_allowed);
    return {};
}

}  // namespace lineshaft
