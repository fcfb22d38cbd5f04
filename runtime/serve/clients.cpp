#include "runtime/serve/clients.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace lineshaft {

/// Who is being answered has a fifth of a second for that.
Clients::~Clients() {
    constexpr std::int64_t patience = 200'000'000, pause = 2'000'000;
    for (Client& client : clients_) client.socket->shut_in();
    for (const std::int64_t end = world_.now() + patience;
         world_.now() < end && !std::ranges::all_of(clients_, [](auto& c) { return +c.gone_; });)
        world_.sleep_until(world_.now() + pause);
    for (Client& client : clients_) client.socket->shut();
    for (Client& client : clients_) world_.join(client.thread_);
}

void Clients::admit(std::unique_ptr<Socket> socket) {
    forget();
    const auto stay = static_cast<std::size_t>(
        std::ranges::count_if(clients_, [](const Client& client) { return !client.shut_; }));
    if ((stay >= most_ && !send_one_away()) || is_full()) return;
    try {
        Client& client = clients_.emplace_back(std::move(socket), world_.now());
        client.thread_ = world_.start([this, &client] {
            try {
                answer_(client);
            } catch (const std::exception&) {
                // Memory or a thread that cannot be had: this client is not answered.
            }
            client.socket->shut();
            client.gone_ = true;
        });
    } catch (const std::exception&) {
        if (!clients_.empty() && !clients_.back().thread_.joinable()) clients_.pop_back();
    }
}

bool Clients::send_one_away() {
    Client* const next = next_to_go();
    if (!next) return false;
    next->shut_ = true;
    next->socket->shut();
    return true;
}

Client* Clients::next_to_go() {
    std::map<std::string_view, std::size_t> of_machine;
    for (const Client& client : clients_)
        if (!client.shut_) ++of_machine[client.peer];
    std::vector<std::tuple<std::size_t, std::int64_t, Client*>> in_turn;
    for (Client& client : clients_)
        if (!client.shut_ && !client.stays_ && !client.gone_)
            in_turn.emplace_back(clients_.size() - of_machine[client.peer], +client.since_,
                                 &client);
    if (in_turn.empty()) return nullptr;
    std::ranges::stable_sort(in_turn, {}, [](const auto& each) {
        return std::pair(std::get<0>(each), std::get<1>(each));
    });
    const auto has_less = [&](const auto& each) {
        return std::get<0>(each) != std::get<0>(in_turn.front());
    };
    const auto of_the_most = std::ranges::find_if(in_turn, has_less);
    const auto next = std::find_if(in_turn.begin(), of_the_most, [](const auto& each) {
        return !std::get<Client*>(each)->socket->is_readable(0);
    });
    return std::get<Client*>(next == of_the_most ? in_turn.front() : *next);
}

void Clients::forget() {
    for (auto client = clients_.begin(); client != clients_.end();) {
        const auto it = client++;
        if (!it->gone_) continue;
        world_.join(it->thread_);
        clients_.erase(it);
    }
}

Listener::Listener(Clients& clients, const std::string& host, int port) : clients_(clients) {
    addrinfo hints{};
    hints.ai_flags = AI_PASSIVE | AI_NUMERICHOST | AI_NUMERICSERV;
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
        error_ = "there is no such address";
        return;
    }
    const int yes = 1;
    socket_ = ::socket(found->ai_family, found->ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (socket_ < 0 || ::setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) != 0 ||
        ::bind(socket_, found->ai_addr, found->ai_addrlen) != 0 ||
        ::listen(socket_, SOMAXCONN) != 0)
        error_ = std::strerror(errno);
    ::freeaddrinfo(found);
    if (!error_.empty()) return;
    try {
        thread_ = std::thread([this] { work(); });
    } catch (const std::system_error& error) {
        error_ = error.code().message();
    }
}

Listener::~Listener() {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
    if (socket_ >= 0) ::close(socket_);
}

void Listener::work() {
    constexpr int patience_ms = 100, pause_us = 2'000;
    while (!ends_) {
        pollfd waiting{.fd = socket_, .events = POLLIN, .revents = 0};
        if (clients_.is_full())
            ::usleep(pause_us);
        else if (::poll(&waiting, 1, patience_ms) > 0)
            admit();
        clients_.forget();
    }
}

void Listener::admit() {
    constexpr int pause_us = 20'000;
    const int socket = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) {
        if (errno == EAGAIN || errno == ECONNABORTED || errno == EINTR) return;
        clients_.send_one_away();  // there is no descriptor or memory: it comes of whom has gone
        ::usleep(pause_us);
        return;
    }
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &yes, sizeof yes);
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    try {
        clients_.admit(system_socket(socket));
    } catch (const std::bad_alloc&) {
        // Nobody can be admitted now.
    }
}

}  // namespace lineshaft
