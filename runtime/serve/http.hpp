#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "runtime/serve/audit.hpp"
#include "runtime/serve/clients.hpp"
#include "runtime/serve/guard.hpp"

namespace lineshaft {

struct HttpOptions {
    Address address;  ///< port 0: nobody listens
    GuardOptions guard = {};
    std::string_view page = {};                              ///< HTML
    std::function<void(const std::string&)> tell = nullptr;  ///< sentences for who serves
};

/// Serves the page and the API to clients that come.
class HttpServer {
  public:
    static constexpr std::size_t most_clients = 64;

    /// `audit` may be null.
    HttpServer(Api& api, const HttpOptions& options, World& world, Audit* audit = nullptr);
    ~HttpServer();

    /// Why nobody can be answered, empty when all is well: see HttpSession.
    const std::string& error() const;

    /// Answers all requests of a client.
    void converse(Client& client);

    /// Streams end, and who is answered now is the last one.
    void end();

  private:
    struct Server;
    std::unique_ptr<Server> server_;
};

/// The answer to a request: its path, query and body have any bytes. 404 and 405 for what is not
/// in routes(). What would change something is noted, also when it is refused.
ApiReply answer(Api& api, Guard& guard, Audit* audit, const Visitor& visitor,
                const std::string& method, const std::string& path,
                const std::multimap<std::string, std::string>& query, const std::string& body);

}  // namespace lineshaft
