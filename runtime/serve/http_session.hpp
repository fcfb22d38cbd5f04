#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/serve/clients.hpp"

namespace lineshaft {

/// What of a request tells whether it may come in.
struct Visitor {
    std::string peer, host, origin, authorization;
};

/// A request that has come as a whole. Its path, query and body have any bytes.
struct HttpRequest {
    Visitor visitor;
    std::string method, path;
    std::multimap<std::string, std::string> query;
    std::string body;
};

/// Where an answer goes that has no length.
class HttpSink {
  public:
    virtual ~HttpSink() = default;
    virtual bool is_writable() = 0;
    virtual bool write(std::string_view bytes) = 0;  ///< false when the client has gone
};

struct HttpReply {
    int status = 200;
    std::vector<std::pair<const char*, std::string>> headers = {};
    std::string type = {}, body = {};
    /// In place of the body: writes until there is no more; false when the client has gone.
    std::function<bool(HttpSink&)> stream = nullptr;
    std::function<void()> end_stream = nullptr;  ///< in any case
};

using AnswerHttp = std::function<HttpReply(Client& client, const HttpRequest& request)>;

/// Talks HTTP with clients: their bytes become requests, and replies bytes. That is cpp-httplib's
/// work, which brings TLS and brotli along, though neither is used, and they take longer to load
/// than all else of a command. So it stands in a shared object of its own, httplib_session.cpp,
/// which is loaded when somebody serves. For any thread.
class HttpSession {
  public:
    virtual ~HttpSession() = default;

    /// Answers all requests of a client, or until `ends`.
    virtual void converse(Client& client) = 0;

    /// Null when the shared object is not beside this command, nor where it is installed: `error`
    /// says why.
    static std::unique_ptr<HttpSession> load(World& world, AnswerHttp answer,
                                             const std::atomic<bool>& ends, std::string& error);
};

/// What the shared object is asked for by name.
extern "C" HttpSession* lineshaft_http_session(World& world, AnswerHttp&& answer,
                                               const std::atomic<bool>& ends);

}  // namespace lineshaft
