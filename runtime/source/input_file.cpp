#include "runtime/source/input_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lineshaft {

std::atomic<bool> interrupt_requested = false;

namespace {

/// Whatever their names.
class ReadFiles {
  public:
    void add(const struct stat& file) {
        const std::lock_guard lock(mutex_);
        files_.insert({file.st_dev, file.st_ino});
    }
    bool contains(const struct stat& file) {
        const std::lock_guard lock(mutex_);
        return files_.contains({file.st_dev, file.st_ino});
    }

  private:
    std::mutex mutex_;
    std::set<std::pair<dev_t, ino_t>> files_;
};

ReadFiles& read_files() {
    static ReadFiles files;
    return files;
}

/// By path, without links and dots.
std::map<std::string, std::string>& overlays() {
    static std::map<std::string, std::string> texts;
    return texts;
}

std::string real_name(const std::string& path) {
    std::error_code unknown;
    const auto whole = std::filesystem::absolute(path, unknown);
    const auto real = std::filesystem::weakly_canonical(whole, unknown);
    return unknown ? path : real.string();
}

}  // namespace

void lay_over(const std::string& path, std::optional<std::string> bytes) {
    if (bytes)
        overlays()[real_name(path)] = std::move(*bytes);
    else
        overlays().erase(real_name(path));
}

bool was_read(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 && read_files().contains(status);
}

InputFile::InputFile(const std::string& path)
    : InputFile(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
    owned_ = true;
}

InputFile::InputFile(int descriptor) : descriptor_(descriptor) {
    struct stat status {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) error_ = errno;
    if (error_ == 0 && S_ISREG(status.st_mode)) read_files().add(status);
    waits_ = S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode) || S_ISCHR(status.st_mode);
}

InputFile::~InputFile() {
    if (owned_ && descriptor_ >= 0) ::close(descriptor_);
}

std::size_t InputFile::read(char* to, std::size_t size) {
    while (error_ == 0 && !ended_ && wait()) {
        const ssize_t count = ::read(descriptor_, to, size);
        if (count > 0) return static_cast<std::size_t>(count);
        if (count == 0) ended_ = true;
        if (count < 0 && errno != EINTR && errno != EAGAIN) error_ = errno;
    }
    return 0;
}

bool InputFile::wait() {
    if (!waits_) return true;
    constexpr int wake_ms = 200;
    pollfd waiting{.fd = descriptor_, .events = POLLIN, .revents = 0};
    while (!interrupt_requested)
        if (::poll(&waiting, 1, wake_ms) > 0) return true;
    error_ = EINTR;
    return false;
}

std::string read_bytes(const std::string& path, std::size_t most, int& error) {
    if (!overlays().empty())
        if (const auto it = overlays().find(real_name(path)); it != overlays().end()) {
            error = 0;
            return it->second.substr(0, most);
        }
    InputFile file(path);
    std::string text;
    std::array<char, 1 << 14> part{};
    std::size_t count = 1;
    while (count > 0 && text.size() < most) {
        count = file.read(part.data(), std::min(part.size(), most - text.size()));
        text.append(part.data(), count);
    }
    error = file.error();
    return text;
}

}  // namespace lineshaft
