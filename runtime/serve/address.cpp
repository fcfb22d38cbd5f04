#include "runtime/serve/address.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

namespace lineshaft {

namespace {

bool is_number(const std::string& host) {
    std::byte bytes[16];
    return ::inet_pton(AF_INET, host.c_str(), bytes) == 1 ||
           ::inet_pton(AF_INET6, host.c_str(), bytes) == 1;
}

/// An errno, or 0.
int try_to_bind(const Address& address) {
    addrinfo hints{};
    hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const std::string port = std::to_string(address.port);
    if (::getaddrinfo(address.host.c_str(), port.c_str(), &hints, &found) != 0)
        return EADDRNOTAVAIL;
    const int socket = ::socket(found->ai_family, found->ai_socktype, found->ai_protocol);
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    const bool bound =
        ::bind(socket, found->ai_addr, found->ai_addrlen) == 0 && ::listen(socket, 1) == 0;
    const int error = bound ? 0 : errno;
    ::close(socket);
    ::freeaddrinfo(found);
    return error;
}

}  // namespace

std::optional<Address> Address::parse(const std::string& text) {
    const auto colon = text.rfind(':');
    if (colon == std::string::npos) return {};
    Address address{text.substr(0, colon)};
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, address.port);
    if (error != std::errc() || rest != end || address.port < 1 || address.port > 65535) return {};
    if (address.host.starts_with('[') && address.host.ends_with(']'))
        address.host = address.host.substr(1, address.host.size() - 2);
    if (address.host == "localhost") address.host = "127.0.0.1";
    if (!is_number(address.host)) return {};
    return address;
}

std::string Address::text() const {
    return fmt::format(fmt::runtime(host.find(':') == std::string::npos ? "{}:{}" : "[{}]:{}"),
                       host, port);
}

bool Address::is_loopback() const {
    return host.starts_with("127.") || host == "::1" || host.starts_with("::ffff:127.");
}

std::string Address::obstacle(std::string& cure) const {
    const int error = try_to_bind(*this);
    if (error == 0) return {};
    cure = error == EADDRINUSE ? "another program is there, maybe another 'lineshaft serve': end "
                                 "it, or name another port"
           : error == EACCES   ? "ports below 1024 are for root: name one above"
                               : "name an address of this machine, such as 127.0.0.1";
    return fmt::format("cannot listen at {}: {}", text(), std::strerror(error));
}

}  // namespace lineshaft
