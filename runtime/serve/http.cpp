#include "runtime/serve/http.hpp"

#include <algorithm>
#include <array>
#include <thread>

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include "runtime/run/signal_json.hpp"
#include "runtime/serve/connection.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

constexpr int most_streams = 16, most_clients = 48, most_that_wait = 48;
constexpr std::size_t most_bytes = 64 << 10;  ///< of a request's body

/// Takes as long for a wrong token as for the right one.
bool is_same(std::string_view a, std::string_view b) {
    unsigned difference = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        difference |= static_cast<unsigned>(a[i] ^ b[i]);
    return difference == 0;
}

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

/// Threads for clients; when too many clients wait for one, the next ones are sent away.
class Threads : public httplib::ThreadPool {
  public:
    static inline thread_local bool sends_away = false;

    Threads() : ThreadPool(most_clients) {}

    void enqueue(std::function<void()> client) override {
        sends_away = waiting_ >= most_that_wait;
        if (sends_away) return client();
        ++waiting_;
        ThreadPool::enqueue([this, client = std::move(client)] {
            --waiting_;
            client();
        });
    }

  private:
    std::atomic<int> waiting_ = 0;
};

}  // namespace

bool Guard::is_known(const std::string& host) const {
    const std::string name =
        host.substr(0, host.starts_with('[') ? host.find(']') + 1 : host.find(':'));
    return name == "localhost" || Address::parse(name + ":1").has_value();
}

bool Guard::is_too_much() {
    const std::int64_t second = Pacer::now() / 1'000'000'000;
    const std::lock_guard lock(mutex_);
    if (second != second_) requests_ = 0;
    second_ = second;
    return ++requests_ > options_.most_requests;
}

/// A name in Host that is not this machine's is that of a page that a browser was led astray by.
std::optional<ApiReply> Guard::refuse(const Visitor& visitor, bool writes) {
    if (is_too_much()) return failure(429, "too many requests", "ask less often");
    if (!is_known(visitor.host))
        return failure(403, "this is not the address of the machine", "use its number", "L0513");
    if (!visitor.origin.empty() && visitor.origin != "http://" + visitor.host)
        return failure(403, "a page of another origin asks", "open the machine's own", "L0513");
    if (!writes) return {};
    if (!options_.allow_write)
        return failure(403, "this machine is only looked at",
                       "serve it with --allow-write to change something", "L0513");
    const bool is_near = Address{visitor.peer}.is_loopback();
    if (!is_near &&
        (options_.token.empty() || !is_same(visitor.authorization, "Bearer " + options_.token)))
        return failure(403, "writing from another machine takes the token",
                       "send 'Authorization: Bearer TOKEN', as --token-file has it", "L0513");
    return {};
}

ApiReply answer(Api& api, Guard& guard, const Visitor& visitor, const std::string& method,
                const std::string& path, const std::multimap<std::string, std::string>& query,
                const std::string& body) {
    const auto all = routes();
    const auto route = std::ranges::find_if(
        all, [&](const Route& r) { return r.path == path && r.method == method; });
    const bool writes = route != all.end() && route->writes;
    if (auto refused = guard.refuse(visitor, writes)) return *refused;
    if (route == all.end()) {
        const bool is_there = std::ranges::count(all, path, &Route::path) > 0;
        return failure(is_there ? 405 : 404,
                       is_there ? "not by this method" : "there is no such path",
                       "/api/openapi.json lists what there is");
    }
    ApiRequest request{query, nullptr};
    if (!body.empty()) {
        request.body = Json::parse(body, nullptr, false);
        if (request.body.is_discarded()) return failure(400, "the body is not JSON");
    }
    return (api.*route->call)(request);
}

struct HttpServer::Server : httplib::Server {
    Server(Api& a, const HttpOptions& o) : api(a), options(o), guard(o) {}

    bool process_and_close_socket(int socket) override;
    void reply(const httplib::Request& request, httplib::Response& response);
    void send(std::shared_ptr<Stream> stream, httplib::Response& response);
    bool feed(Stream& stream, httplib::DataSink& sink);

    Api& api;
    const HttpOptions& options;
    Guard guard;
    std::atomic<int> streams = 0;
    std::atomic<bool> ends = false;
    std::thread thread;
};

bool HttpServer::Server::process_and_close_socket(int socket) {
    const auto answer_whole = [](httplib::Request& request) { request.ranges.clear(); };
    Connection connection(socket);
    bool closed = Threads::sends_away;
    while (!closed && !ends && connection.begin())
        if (!process_request(connection, false, closed, answer_whole)) break;
    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
    return true;
}

void HttpServer::Server::reply(const httplib::Request& request, httplib::Response& response) {
    const Visitor visitor{request.remote_addr, request.get_header_value("Host"),
                          request.get_header_value("Origin"),
                          request.get_header_value("Authorization")};
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("Cache-Control", "no-store");
    if (request.path == "/" && request.method == "GET" && !guard.refuse(visitor, false)) {
        response.set_header("Content-Security-Policy",
                            "default-src 'none'; script-src 'unsafe-inline' data:; style-src "
                            "'unsafe-inline'; img-src data:; connect-src 'self'");
        return response.set_content(options.page.data(), options.page.size(), "text/html");
    }
    ApiReply got =
        answer(api, guard, visitor, request.method, request.path, request.params, request.body);
    if (got.stream && streams >= most_streams) {
        got.stream->close();
        got = failure(503, "too many clients take samples", "close a page");
    }
    response.status = got.status;
    if (got.stream) return send(std::move(got.stream), response);
    if (!got.file.empty()) return response.set_content(got.file, "application/octet-stream");
    response.set_content(got.body.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n",
                         "application/json");
}

void HttpServer::Server::send(std::shared_ptr<Stream> stream, httplib::Response& response) {
    ++streams;
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, stream](std::size_t, httplib::DataSink& sink) { return feed(*stream, sink); },
        [this, stream](bool) {
            stream->close();
            --streams;
        });
}

/// Until the client goes, or the machine ends.
bool HttpServer::Server::feed(Stream& stream, httplib::DataSink& sink) {
    constexpr auto pause = std::chrono::milliseconds(20);
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
        std::this_thread::sleep_for(pause);
    }
    sink.done();
    return true;
}

HttpServer::HttpServer(Api& api, const HttpOptions& options)
    : server_(std::make_unique<Server>(api, options)) {
    Server& http = *server_;
    http.new_task_queue = [] { return new Threads; };
    http.set_socket_options([](int socket) {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    http.set_payload_max_length(most_bytes);
    http.set_tcp_nodelay(true);
    const auto reply = [&http](const httplib::Request& request, httplib::Response& response) {
        http.reply(request, response);
    };
    http.Get(".*", reply).Post(".*", reply);
    if (options.address.port == 0) return;
    failed_ = !http.bind_to_port(options.address.host, options.address.port);
    if (failed_) return;
    http.thread = std::thread([&http] { http.listen_after_bind(); });
    while (!http.is_running()) std::this_thread::yield();
}

HttpServer::~HttpServer() {
    server_->ends = true;
    server_->stop();
    if (server_->thread.joinable()) server_->thread.join();
}

void HttpServer::converse(int socket) {
    server_->process_and_close_socket(socket);
}

}  // namespace lineshaft
