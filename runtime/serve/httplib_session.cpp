#include "runtime/serve/connection.hpp"
#include "runtime/serve/http_session.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t most_bytes = 64 << 10;  ///< of a request's body

class Sink final : public HttpSink {
  public:
    explicit Sink(httplib::DataSink& sink) : sink_(sink) {}
    bool is_writable() override { return sink_.is_writable(); }
    bool write(std::string_view bytes) override { return sink_.write(bytes.data(), bytes.size()); }

  private:
    httplib::DataSink& sink_;
};

class Session final : public HttpSession, httplib::Server {
  public:
    Session(World& world, AnswerHttp&& answer, const std::atomic<bool>& ends);
    void converse(Client& client) override;

  private:
    void answer_by(const httplib::Request& request, httplib::Response& response, std::string body);

    static inline thread_local Client* client_of_thread = nullptr;

    World& world_;
    const AnswerHttp answer_;
    const std::atomic<bool>& ends_;
};

/// The body is read here: the library allows a form, as `curl -d` sends it, 8 KiB.
Session::Session(World& world, AnswerHttp&& answer, const std::atomic<bool>& ends)
    : world_(world), answer_(std::move(answer)), ends_(ends) {
    constexpr std::size_t most_requests = 1000;
    svr_sock_ = 0;  // a server without a port is one that ends, to the library
    set_payload_max_length(most_bytes);
    set_keep_alive_max_count(most_requests);
    set_keep_alive_timeout(Connection::idle_s);
    const auto without_body = [this](const httplib::Request& request, httplib::Response& response) {
        answer_by(request, response, "");
    };
    const auto with_body = [this](const httplib::Request& request, httplib::Response& response,
                                  const httplib::ContentReader& read) {
        std::string body;
        const auto take = [&](const char* bytes, std::size_t size) {
            body.append(bytes, size);
            return body.size() <= most_bytes;
        };
        const bool has_none =
            !request.has_header("Content-Length") && !request.has_header("Transfer-Encoding");
        if (has_none || read(take)) answer_by(request, response, std::move(body));
    };
    constexpr const char* any = ".*";
    Get(any, without_body).Options(any, without_body).Delete(any, without_body);
    Post(any, with_body).Put(any, with_body).Patch(any, with_body).Delete(any, with_body);
    set_exception_handler(
        [](const httplib::Request&, httplib::Response& response, const std::exception_ptr&) {
            response.status = 503;
            response.set_content("{\"error\": \"this machine has no memory for that\"}\n",
                                 "application/json");
        });
}

void Session::converse(Client& client) {
    const auto answer_whole = [](httplib::Request& request) { request.ranges.clear(); };
    Connection connection(client, world_);
    client_of_thread = &client;
    bool closed = false;
    for (std::size_t left = keep_alive_max_count_; left > 0 && !closed && !ends_; --left)
        if (!connection.begin() || !process_request(connection, left == 1, closed, answer_whole))
            return;
}

void Session::answer_by(const httplib::Request& request, httplib::Response& response,
                        std::string body) {
    HttpReply reply =
        answer_(*client_of_thread,
                {{request.remote_addr, request.get_header_value("Host"),
                  request.get_header_value("Origin"), request.get_header_value("Authorization")},
                 request.method,
                 request.path,
                 request.params,
                 std::move(body)});
    response.status = reply.status;
    for (const auto& [name, value] : reply.headers) response.set_header(name, value);
    if (!reply.stream) return response.set_content(reply.body, reply.type);
    response.set_chunked_content_provider(
        reply.type,
        [stream = std::move(reply.stream)](std::size_t, httplib::DataSink& sink) {
            Sink to(sink);
            if (!stream(to)) return false;
            sink.done();
            return true;
        },
        [end = std::move(reply.end_stream)](bool) { end(); });
}

}  // namespace

HttpSession* lineshaft_http_session(World& world, AnswerHttp&& answer,
                                    const std::atomic<bool>& ends) {
    return new Session(world, std::move(answer), ends);
}

}  // namespace lineshaft
