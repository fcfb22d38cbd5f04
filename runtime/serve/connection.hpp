#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <httplib.h>

#include "runtime/serve/clients.hpp"

namespace lineshaft {

/// A client's socket as cpp-httplib reads and writes it, with limits that the library does not
/// have: a request has at most 100 lines of header, 16 KiB of them and 80 KiB in all, and has come
/// within five seconds, however slowly its bytes come. Beyond them nothing more is read, nor from a
/// client that has taken nothing of its answers for five seconds: it may have asked for many.
class Connection final : public httplib::Stream {
  public:
    /// Between two requests a client may be idle for so long [s].
    static constexpr int idle_s = 5;

    Connection(Client& client, World& world) : client_(client), world_(world) {}

    /// Before each request: waits for one, a little longer than a client is told. False when none
    /// comes, or the last one was too much.
    bool begin();

    /// False when the client has gone, or sends no more; one that is slow is waited for by write().
    bool is_writable() const override;
    bool is_readable() const override;
    ssize_t read(char* to, std::size_t size) override;
    ssize_t write(const char* from, std::size_t size) override;
    void get_remote_ip_and_port(std::string& host, int& port) const override;
    void get_local_ip_and_port(std::string&, int&) const override {}
    int socket() const override { return -1; }

  private:
    bool fill();
    bool is_allowed(char next);

    Client& client_;
    World& world_;
    std::array<char, 4096> buffer_{};
    std::size_t first_ = 0, end_ = 0;               ///< of what is left in the buffer
    std::size_t bytes_ = 0, lines_ = 0, line_ = 0;  ///< of the request; of its last line
    bool in_head_ = true, is_answered_ = false, too_much_ = false, gone_ = false;
    std::int64_t deadline_ = 0;  ///< [ns]
};

}  // namespace lineshaft
