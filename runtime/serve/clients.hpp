#pragma once

#include <atomic>
#include <list>

#include "runtime/serve/world.hpp"

namespace lineshaft {

/// A client that has come in, for the thread that answers it.
class Client {
  public:
    Client(std::unique_ptr<Socket> s, std::int64_t now)
        : socket(std::move(s)), peer(socket->peer()), since_(now) {}

    const std::unique_ptr<Socket> socket;
    const std::string peer;  ///< number of its machine

    /// It has asked for something, as a whole: who does gives way last.
    void has_asked(std::int64_t now) { since_ = now; }
    /// It is sent something without an end, and gives way to nobody.
    void stays(bool whether) { stays_ = whether; }

  private:
    friend class Clients;

    std::atomic<std::int64_t> since_;  ///< when it last asked for something, or came [ns]
    std::atomic<bool> stays_ = false, gone_ = false;
    bool shut_ = false;  ///< of Clients' thread
    std::thread thread_ = {};
};

/// The clients of a server, a thread each: one that is slow, or sends half a request, holds up
/// nobody else. When there are too many, of those from the machine that has most the one gives way
/// that has not asked for anything for the longest time, and last of all one of which bytes have
/// come that its thread has not read yet. For one thread, which admits.
class Clients {
  public:
    using Answer = std::function<void(Client&)>;

    /// `answer` talks to a client until that is over. What it throws ends that client alone.
    Clients(World& world, std::size_t most, Answer answer)
        : world_(world), most_(most), answer_(std::move(answer)) {}
    ~Clients();
    Clients(const Clients&) = delete;
    Clients& operator=(const Clients&) = delete;

    /// Sends it away at once when there can be no thread for it.
    void admit(std::unique_ptr<Socket> socket);

    /// So many that were sent away have not gone yet that nobody can be admitted.
    bool is_full() const { return clients_.size() >= 2 * most_; }

    /// Who gives way next does so now. False when nobody can.
    bool send_one_away();

    /// Forgets those that have gone.
    void forget();

  private:
    Client* next_to_go();

    World& world_;
    const std::size_t most_;
    const Answer answer_;
    std::list<Client> clients_;
};

/// Listens at an address and admits who comes, from the constructor on until it is destroyed.
class Listener {
  public:
    /// `host` is a number.
    Listener(Clients& clients, const std::string& host, int port);
    ~Listener();
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    /// Why nobody can come, empty when all is well.
    const std::string& error() const { return error_; }

  private:
    void work();
    void admit();

    Clients& clients_;
    int socket_ = -1;
    std::string error_;
    std::atomic<bool> ends_ = false;
    std::thread thread_;
};

}  // namespace lineshaft
