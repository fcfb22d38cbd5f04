#include "runtime/serve/world.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <unistd.h>

#include "runtime/serve/pacer.hpp"

namespace lineshaft {

namespace {

class SystemSocket final : public Socket {
  public:
    explicit SystemSocket(int socket) : socket_(socket) {}
    ~SystemSocket() override { ::close(socket_); }
    SystemSocket(const SystemSocket&) = delete;
    SystemSocket& operator=(const SystemSocket&) = delete;

    std::size_t receive(char* to, std::size_t size, std::int64_t until) override {
        if (!is_readable(until)) return 0;
        return static_cast<std::size_t>(std::max<ssize_t>(::recv(socket_, to, size, 0), 0));
    }
    bool is_readable(std::int64_t until) override { return wait_for(POLLIN, until) != 0; }
    std::size_t send(std::string_view bytes, std::int64_t until) override {
        if ((wait_for(POLLOUT, until) & POLLOUT) == 0) return 0;
        const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        return static_cast<std::size_t>(std::max<ssize_t>(sent, 0));
    }
    bool has_ended() override { return wait_for(POLLRDHUP, 0) != 0; }
    void shut_in() override { ::shutdown(socket_, SHUT_RD); }
    void shut() override { ::shutdown(socket_, SHUT_RDWR); }
    std::string peer() const override;

  private:
    /// Which of `events` have come.
    int wait_for(int events, std::int64_t until) const;

    int socket_;
};

int SystemSocket::wait_for(int events, std::int64_t until) const {
    constexpr std::int64_t millisecond = 1'000'000, hour = 3'600'000;
    pollfd waiting{.fd = socket_, .events = static_cast<short>(events), .revents = 0};
    const std::int64_t left = until > 0 ? (until - Pacer::now()) / millisecond : 0;
    const auto timeout = static_cast<int>(std::clamp<std::int64_t>(left, 0, hour));
    return ::poll(&waiting, 1, timeout) > 0 ? waiting.revents : 0;
}

std::string SystemSocket::peer() const {
    sockaddr_storage peer{};
    socklen_t size = sizeof peer;
    auto* const address = reinterpret_cast<sockaddr*>(&peer);
    char text[128] = {};
    if (::getpeername(socket_, address, &size) == 0 && peer.ss_family != AF_UNIX)
        ::getnameinfo(address, size, text, sizeof text, nullptr, 0, NI_NUMERICHOST);
    return text;
}

class SystemFile final : public GrowingFile {
  public:
    explicit SystemFile(int file) : file_(file) {}
    ~SystemFile() override { ::close(file_); }
    SystemFile(const SystemFile&) = delete;
    SystemFile& operator=(const SystemFile&) = delete;

    int lock() override { return ::flock(file_, LOCK_EX | LOCK_NB) == 0 ? 0 : errno; }
    std::int64_t size() override { return ::lseek(file_, 0, SEEK_END); }
    std::string read(std::int64_t from, std::size_t most) override {
        std::string text(most, '\0');
        const ssize_t got = ::pread(file_, text.data(), most, from);
        text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
        return text;
    }
    int append(std::string_view bytes, std::size_t& written) override;
    int truncate(std::int64_t size) override {
        return ::ftruncate(file_, size) == 0 && ::lseek(file_, size, SEEK_SET) >= 0 ? 0 : errno;
    }
    int flush() override { return ::fdatasync(file_) == 0 || errno == EINVAL ? 0 : errno; }

  private:
    int file_;
};

int SystemFile::append(std::string_view bytes, std::size_t& written) {
    for (written = 0; written < bytes.size();) {
        const ssize_t got = ::write(file_, bytes.data() + written, bytes.size() - written);
        if (got >= 0)
            written += static_cast<std::size_t>(got);
        else if (errno != EINTR)
            return errno;
    }
    return 0;
}

class SystemWorld final : public World {
  public:
    std::int64_t now() override { return Pacer::now(); }
    void sleep_until(std::int64_t time) override { Pacer::sleep_until(time); }
    bool wait(std::unique_lock<std::mutex>& lock, std::condition_variable& changed,
              std::int64_t until, const std::function<bool()>& holds) override {
        using Clock = std::chrono::steady_clock;
        const Clock::time_point end{Clock::duration(until)};
        return changed.wait_until(lock, end, holds);
    }
    std::thread start(std::function<void()> work) override { return std::thread(std::move(work)); }
    void join(std::thread& thread) override { thread.join(); }
    std::unique_ptr<GrowingFile> open(const std::string& path, bool may_make, int& error) override {
        const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC | (may_make ? O_CREAT : 0), 0666);
        error = file < 0 ? errno : 0;
        return file < 0 ? nullptr : std::make_unique<SystemFile>(file);
    }
};

}  // namespace

std::string cannot_write(const std::string& path, int error) {
    return fmt::format("cannot write '{}': {}", path, std::strerror(error));
}

World& World::system() {
    static SystemWorld world;
    return world;
}

std::unique_ptr<Socket> system_socket(int socket) {
    try {
        return std::make_unique<SystemSocket>(socket);
    } catch (const std::bad_alloc&) {
        ::close(socket);
        throw;
    }
}

}  // namespace lineshaft
