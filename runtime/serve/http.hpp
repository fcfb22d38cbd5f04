#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "runtime/serve/api.hpp"

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

/// The number of a socket's other end; empty for none.
std::string peer_of(int socket);

struct HttpOptions {
    Address address;  ///< port 0: nobody listens
    bool allow_write = false;
    std::string token;                  ///< that clients of other machines need for writing
    std::string_view page;              ///< HTML
    std::int64_t most_requests = 1000;  ///< a second, of all clients
};

/// What of a request tells whether it may come in.
struct Visitor {
    std::string peer, host, origin, authorization;
};

/// Decides who may do what. For any thread.
class Guard {
  public:
    explicit Guard(const HttpOptions& options) : options_(options) {}

    /// What is answered instead: L0513 of another host or origin, writing that is not allowed; 429
    /// for too many requests a second. Empty when it may come in.
    std::optional<ApiReply> refuse(const Visitor& visitor, bool writes);

  private:
    bool is_known(const std::string& host) const;
    bool is_too_much();

    const HttpOptions& options_;
    std::mutex mutex_;
    std::int64_t second_ = 0, requests_ = 0;
};

/// Serves the page and the API, from the constructor on until it is destroyed.
class HttpServer {
  public:
    HttpServer(Api& api, const HttpOptions& options);
    ~HttpServer();

    /// Nobody listens: another one does there, or it is not allowed.
    bool failed() const { return failed_; }

    /// Answers all requests of a client that come to a socket, and closes it.
    void converse(int socket);

  private:
    struct Server;
    std::unique_ptr<Server> server_;
    bool failed_ = false;
};

/// The answer to a request: its path, query and body have any bytes. 404 and 405 for what is not
/// in routes().
ApiReply answer(Api& api, Guard& guard, const Visitor& visitor, const std::string& method,
                const std::string& path, const std::multimap<std::string, std::string>& query,
                const std::string& body);

}  // namespace lineshaft
