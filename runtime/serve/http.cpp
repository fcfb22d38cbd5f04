#include "runtime/serve/http.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

#include "runtime/run/signal_json.hpp"
#include "runtime/serve/http_session.hpp"
#include "runtime/trace/csv_sidecar.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

constexpr int most_streams = 16;

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
    for (const Signal* signal : stream.signals()) {
        signals.push_back({{"name", signal->name},
                           {"unit", signal->unit},
                           {"type", name_of(signal->type)},
                           {"names", signal->names.list()}});
        if (Json numbers = numbers_json(signal->names); !numbers.empty())
            signals.back()["numbers"] = std::move(numbers);
    }
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
                                    ? stored_json(signal.names, std::get<std::int64_t>(value))
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

struct HttpServer::Server {
    Server(Api& a, const HttpOptions& o, World& w, Audit* au)
        : api(a), options(o), world(w), audit(au), guard(o.guard, w, o.tell) {}

    HttpReply answer(Client& client, const HttpRequest& request);
    void send(std::shared_ptr<Stream> stream, Client& client, HttpReply& reply);
    bool feed(Stream& stream, HttpSink& sink);

    Api& api;
    const HttpOptions& options;
    World& world;
    Audit* const audit;
    Guard guard;
    std::atomic<int> streams = 0;
    std::atomic<bool> ends = false;
    std::string error;
    std::unique_ptr<HttpSession> session;
};

HttpReply HttpServer::Server::answer(Client& client, const HttpRequest& request) {
    const bool reads = request.method == "GET" || request.method == "HEAD";
    HttpReply reply;
    reply.headers = {{"X-Content-Type-Options", "nosniff"},
                     {"X-Frame-Options", "DENY"},
                     {"Cache-Control", "no-store"},
                     {"Content-Security-Policy",
                      "default-src 'none'; script-src 'unsafe-inline' data:; style-src "
                      "'unsafe-inline'; img-src data:; connect-src 'self'; frame-ancestors "
                      "'none'; base-uri 'none'; form-action 'none'"}};
    const auto set_content = [&reply](std::string body, const char* type) {
        reply.body = std::move(body);
        reply.type = type;
        return reply;
    };
    if (request.path == "/" && reads && !guard.refuse(request.visitor, false))
        return set_content(std::string(options.page), "text/html");
    ApiReply got = lineshaft::answer(api, guard, audit, request.visitor, request.method,
                                     request.path, request.query, request.body);
    if (got.stream && streams >= most_streams) {
        got.stream->close();
        got = failure(503, "too many clients take samples", "close a page");
    }
    reply.status = got.status;
    if (!got.allow.empty()) reply.headers.emplace_back("Allow", got.allow);
    if (got.stream) {
        send(std::move(got.stream), client, reply);
        return reply;
    }
    if (!got.file.empty()) return set_content(std::move(got.file), "application/octet-stream");
    return set_content(got.body.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n",
                       "application/json");
}

void HttpServer::Server::send(std::shared_ptr<Stream> stream, Client& client, HttpReply& reply) {
    ++streams;
    client.stays(true);
    reply.type = "text/event-stream";
    reply.stream = [this, stream](HttpSink& sink) { return feed(*stream, sink); };
    reply.end_stream = [this, stream, &client] {
        stream->close();
        client.stays(false);
        --streams;
    };
}

/// Until the client goes, or the machine ends.
bool HttpServer::Server::feed(Stream& stream, HttpSink& sink) {
    constexpr std::int64_t pause = 20'000'000;
    constexpr int rows_a_state = 20;
    const auto write = [&](const std::string& text) { return text.empty() || sink.write(text); };
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
    return true;
}

HttpServer::HttpServer(Api& api, const HttpOptions& options, World& world, Audit* audit)
    : server_(std::make_unique<Server>(api, options, world, audit)) {
    Server& server = *server_;
    const auto answer = [&server](Client& client, const HttpRequest& request) {
        return server.answer(client, request);
    };
    server.session = HttpSession::load(world, answer, server.ends, server.error);
}

HttpServer::~HttpServer() = default;

const std::string& HttpServer::error() const {
    return server_->error;
}

void HttpServer::end() {
    server_->ends = true;
}

void HttpServer::converse(Client& client) {
    server_->session->converse(client);
}

}  // namespace lineshaft
