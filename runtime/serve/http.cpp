#include "runtime/serve/http.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

#include "runtime/run/signal_json.hpp"
#include "runtime/serve/connection.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

constexpr int most_streams = 16;
constexpr std::size_t most_bytes = 64 << 10;  ///< of a request's body

Value value_of(const Signal& signal, std::uint64_t bits) {
    std::array<std::byte, sizeof bits> slot;
    std::memcpy(slot.data(), &bits, sizeof bits);
    return load(signal.type, slot.data());
}

std::string event(const char* name, const Json& data) {
    return fmt::format("event: {}\ndata: {}\n\n", name, data.dump());
}

Json heading(const Stream& stream) {
    Json signals = Json::array();
    for (const Signal* signal : stream.signals())
        signals.push_back({{"name", signal->name},
                           {"unit", signal->unit},
                           {"type", name_of(signal->type)},
                           {"names", signal->names}});
    return signals;
}

/// The rows that have come; empty when none has and none was lost since `lost`.
std::string rows(Stream& stream, std::int64_t& lost) {
    Json time = Json::array();
    std::vector<Json> values(stream.signals().size(), Json::array());
    stream.take([&](std::int64_t at, std::span<const std::uint64_t> words) {
        time.push_back(static_cast<double>(at) / 1e9);
        for (std::size_t i = 0; i < words.size(); ++i) {
            const Signal& signal = *stream.signals()[i];
            const Value value = value_of(signal, words[i]);
            values[i].push_back(signal.type == Type::enumeration
                                    ? Json(std::get<std::int64_t>(value))
                                    : to_json(signal, value));
        }
    });
    if (time.empty() && lost == stream.lost()) return {};
    lost = stream.lost();
    return event("rows", {{"time", time}, {"values", values}, {"lost", lost}});
}

/// The methods of a path, with commas between.
std::string methods_of(const std::string& path) {
    std::string methods;
    for (const Route& route : routes())
        if (route.path == path)
            methods += fmt::format("{}{}{}", methods.empty() ? "" : ", ", route.method,
                                   route.method == "GET" ? ", HEAD" : "");
    return methods;
}

ApiReply of_no_route(const std::string& path) {
    constexpr const char* help = "/api/openapi.json lists what there is";
    const std::string methods = methods_of(path);
    if (methods.empty()) return failure(404, "there is no such path", help);
    ApiReply reply = failure(405, "not by this method", help);
    reply.allow = methods;
    return reply;
}

ApiReply call(Api& api, const Route& route, const std::multimap<std::string, std::string>& query,
              const std::string& body) {
    ApiRequest request{query, nullptr};
    if (!body.empty()) {
        request.body = Json::parse(body, nullptr, false);
        if (request.body.is_discarded()) return failure(400, "the body is not JSON");
    }
    return (api.*route.call)(request);
}

void note(Audit& audit, const Visitor& visitor, const std::string& asked, const ApiReply& reply) {
    AuditEntry entry{visitor.peer, "HTTP", asked, std::to_string(reply.status)};
    if (reply.body.contains("error")) entry.answer += " " + reply.body["error"].get<std::string>();
    if (reply.body.contains("time_ns")) entry.at = reply.body["time_ns"].get<std::int64_t>();
    audit.note(entry);
}

}  // namespace

ApiReply answer(Api& api, Guard& guard, Audit* audit, const Visitor& visitor,
                const std::string& method, const std::string& path,
                const std::multimap<std::string, std::string>& query, const std::string& body) {
    const std::string as = method == "HEAD" ? "GET" : method;
    const auto all = routes();
    const auto route =
        std::ranges::find_if(all, [&](const Route& r) { return r.path == path && r.method == as; });
    const bool writes = route != all.end() && route->writes;
    const auto refused = guard.refuse(visitor, writes);
    if (!refused && method == "HEAD" && route != all.end() && route->reply.is_null())
        return {200, Json::object()};
    ApiReply reply = refused              ? *refused
                     : route == all.end() ? of_no_route(path)
                                          : call(api, *route, query, body);
    if (audit && writes && !Guard::is_of_many(reply))
        note(*audit, visitor, fmt::format("{} {} {}", method, path, body), reply);
    return reply;
}

struct HttpServer::Server : httplib::Server {
    Server(Api& a, const HttpOptions& o, World& w, Audit* au)
        : api(a), options(o), world(w), audit(au), guard(o.guard, w, o.tell) {
        svr_sock_ = 0;  // a server without a port is one that ends, to the library
    }

    void answer_by(const httplib::Request& request, httplib::Response& response,
                   const std::string& body);
    void converse(Client& client);
    void send(std::shared_ptr<Stream> stream, httplib::Response& response);
    bool feed(Stream& stream, httplib::DataSink& sink);

    static inline thread_local Client* client_of_thread = nullptr;

    Api& api;
    const HttpOptions& options;
    World& world;
    Audit* const audit;
    Guard guard;
    std::atomic<int> streams = 0;
    std::atomic<bool> ends = false;
};

void HttpServer::Server::converse(Client& client) {
    const auto answer_whole = [](httplib::Request& request) { request.ranges.clear(); };
    Connection connection(client, world);
    client_of_thread = &client;
    bool closed = false;
    for (std::size_t left = keep_alive_max_count_; left > 0 && !closed && !ends; --left)
        if (!connection.begin() || !process_request(connection, left == 1, closed, answer_whole))
            return;
}

void HttpServer::Server::answer_by(const httplib::Request& request, httplib::Response& response,
                                   const std::string& body) {
    const Visitor visitor{request.remote_addr, request.get_header_value("Host"),
                          request.get_header_value("Origin"),
                          request.get_header_value("Authorization")};
    const bool reads = request.method == "GET" || request.method == "HEAD";
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("X-Frame-Options", "DENY");
    response.set_header("Cache-Control", "no-store");
    response.set_header("Content-Security-Policy",
                        "default-src 'none'; script-src 'unsafe-inline' data:; style-src "
                        "'unsafe-inline'; img-src data:; connect-src 'self'; frame-ancestors "
                        "'none'; base-uri 'none'; form-action 'none'");
    if (request.path == "/" && reads && !guard.refuse(visitor, false))
        return response.set_content(options.page.data(), options.page.size(), "text/html");
    ApiReply got = lineshaft::answer(api, guard, audit, visitor, request.method, request.path,
                                     request.params, body);
    if (got.stream && streams >= most_streams) {
        got.stream->close();
        got = failure(503, "too many clients take samples", "close a page");
    }
    response.status = got.status;
    if (!got.allow.empty()) response.set_header("Allow", got.allow);
    if (got.stream) return send(std::move(got.stream), response);
    if (!got.file.empty()) return response.set_content(got.file, "application/octet-stream");
    response.set_content(got.body.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n",
                         "application/json");
}

void HttpServer::Server::send(std::shared_ptr<Stream> stream, httplib::Response& response) {
    ++streams;
    client_of_thread->stays(true);
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, stream](std::size_t, httplib::DataSink& sink) { return feed(*stream, sink); },
        [this, stream, client = client_of_thread](bool) {
            stream->close();
            client->stays(false);
            --streams;
        });
}

/// Until the client goes, or the machine ends.
bool HttpServer::Server::feed(Stream& stream, httplib::DataSink& sink) {
    constexpr std::int64_t pause = 20'000'000;
    constexpr int rows_a_state = 20;
    const auto write = [&](const std::string& text) {
        return text.empty() || sink.write(text.data(), text.size());
    };
    const auto write_state = [&] {
        const ApiReply state = api.state({});
        return state.status != 200 || write(event("state", state.body));
    };
    std::int64_t lost = 0;
    if (!write(event("signals", heading(stream)))) return false;
    for (int i = 0; !ends && !stream.is_closed(); ++i) {
        if (i % rows_a_state == 0 && !write_state()) return false;
        if (!sink.is_writable() || !write(rows(stream, lost))) return false;
        world.sleep_until(world.now() + pause);
    }
    sink.done();
    return true;
}

/// The body is read here: the library allows a form, as `curl -d` sends it, 8 KiB.
HttpServer::HttpServer(Api& api, const HttpOptions& options, World& world, Audit* audit)
    : server_(std::make_unique<Server>(api, options, world, audit)) {
    constexpr std::size_t most_requests = 1000;
    Server& http = *server_;
    http.set_payload_max_length(most_bytes);
    http.set_keep_alive_max_count(most_requests);
    http.set_keep_alive_timeout(Connection::idle_s);
    const auto without_body = [&http](const httplib::Request& request,
                                      httplib::Response& response) {
        http.answer_by(request, response, "");
    };
    const auto with_body = [&http](const httplib::Request& request, httplib::Response& response,
                                   const httplib::ContentReader& read) {
        std::string body;
        const auto take = [&](const char* bytes, std::size_t size) {
            body.append(bytes, size);
            return body.size() <= most_bytes;
        };
        const bool has_none =
            !request.has_header("Content-Length") && !request.has_header("Transfer-Encoding");
        if (has_none || read(take)) http.answer_by(request, response, body);
    };
    constexpr const char* any = ".*";
    http.Get(any, without_body).Options(any, without_body).Delete(any, without_body);
    http.Post(any, with_body).Put(any, with_body).Patch(any, with_body).Delete(any, with_body);
    http.set_exception_handler(
        [](const httplib::Request&, httplib::Response& response, const std::exception_ptr&) {
            response.status = 503;
            response.set_content("{\"error\": \"this machine has no memory for that\"}\n",
                                 "application/json");
        });
}

HttpServer::~HttpServer() = default;

void HttpServer::end() {
    server_->ends = true;
}

void HttpServer::converse(Client& client) {
    server_->converse(client);
}

}  // namespace lineshaft
