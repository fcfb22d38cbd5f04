#pragma once

#include <optional>
#include <string>

namespace lineshaft {

/// Where a server listens.
struct Address {
    std::string host;  ///< a number, or localhost
    int port = 0;

    /// `127.0.0.1:8080`, `[::1]:8080`. Empty when it is not an address.
    static std::optional<Address> parse(const std::string& text);
    std::string text() const;
    bool is_loopback() const;

    /// Why nobody can listen there; empty when one can. `cure` says what to do.
    std::string obstacle(std::string& cure) const;
};

}  // namespace lineshaft
