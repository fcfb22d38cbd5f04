#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace lineshaft {

inline constexpr std::int64_t one_second = 1'000'000'000;  ///< [ns]

/// A client's connection. One thread reads and writes; any may shut it.
class Socket {
  public:
    virtual ~Socket() = default;

    /// How many bytes have come, at least one; 0 when none will come any more, or none has until
    /// `until` [ns].
    virtual std::size_t receive(char* to, std::size_t size, std::int64_t until) = 0;
    /// Whether bytes, or the end of them, come until then.
    virtual bool is_readable(std::int64_t until) = 0;
    /// How many bytes could be sent, at least one; 0 when the client has gone, or takes none.
    virtual std::size_t send(std::string_view bytes, std::int64_t until) = 0;
    /// Whether the client has gone, or sends no more.
    virtual bool has_ended() = 0;
    /// Nothing more is received, but what is being sent may go; and nothing at all: who waits for
    /// it waits no more.
    virtual void shut_in() = 0;
    virtual void shut() = 0;

    virtual std::string peer() const = 0;  ///< the number of the other machine; empty: none
};

/// A file that grows at its end. Errors are those of errno; 0: none.
class GrowingFile {
  public:
    virtual ~GrowingFile() = default;

    virtual int lock() = 0;  ///< an error when another one has it
    virtual std::int64_t size() = 0;
    virtual std::string read(std::int64_t from, std::size_t most) = 0;
    virtual int append(std::string_view bytes, std::size_t& written) = 0;
    virtual int truncate(std::int64_t size) = 0;  ///< what is appended follows there
    virtual int flush() = 0;                      ///< to the disk
};

/// Why there are lines missing in a file, by an error of errno.
std::string cannot_write(const std::string& path, int error);

/// What serving takes of the world outside: its clock, threads and files. The system's, but for
/// tests, which play one in virtual time.
class World {
  public:
    virtual ~World() = default;

    virtual std::int64_t now() = 0;  ///< that no clock is set by [ns]
    virtual void sleep_until(std::int64_t time) = 0;

    /// Lets go of the lock until `holds`, which is looked at again whenever `changed` is notified.
    /// False when it is `until` [ns], and does not hold.
    virtual bool wait(std::unique_lock<std::mutex>& lock, std::condition_variable& changed,
                      std::int64_t until, const std::function<bool()>& holds) = 0;

    /// Throws std::system_error, or std::bad_alloc, when there can be no thread more.
    virtual std::thread start(std::function<void()> work) = 0;
    virtual void join(std::thread& thread) = 0;

    /// Makes the file when it is not there, and `may_make` it. Null: `error` says why.
    virtual std::unique_ptr<GrowingFile> open(const std::string& path, bool may_make,
                                              int& error) = 0;

    static World& system();
};

/// `socket` is closed in the end, at once when there is no memory for this.
std::unique_ptr<Socket> system_socket(int socket);

}  // namespace lineshaft
