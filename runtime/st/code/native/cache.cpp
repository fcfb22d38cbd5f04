#include "runtime/st/code/native/cache.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "runtime/source/text_hash.hpp"

namespace lineshaft::st {

namespace {

constexpr std::uintmax_t most_bytes = 256 << 20;

std::string folder_of_user() {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    if (cache && *cache == '/') return cache;
    const char* home = std::getenv("HOME");
    if (!home || *home != '/')
        throw NoCompiledCode("neither XDG_CACHE_HOME nor HOME names a folder for it");
    return std::string(home) + "/.cache";
}

/// Whoever else writes there could have anything executed.
bool is_users_alone(const struct stat& status, mode_t others) {
    return status.st_uid == ::geteuid() && (status.st_mode & others) == 0;
}

std::string content(int descriptor) {
    std::string bytes;
    char part[65536];
    for (ssize_t size = 0; (size = ::read(descriptor, part, sizeof part)) > 0;)
        bytes.append(part, static_cast<std::size_t>(size));
    return bytes;
}

constexpr std::size_t hash_size = 16;

std::string named(std::string_view key) {
    return text_hash(key) + ".so";
}

bool is_whole(std::string_view bytes, std::string_view key) {
    if (bytes.size() <= key.size() + hash_size) return false;
    const std::size_t size = bytes.size() - hash_size;
    return bytes.substr(size - key.size(), key.size()) == key &&
           text_hash(bytes.substr(0, size)) == bytes.substr(size);
}

}  // namespace

Cache::Cache() {
    const std::string above = folder_of_user();
    std::error_code known_below;
    std::filesystem::create_directories(above, known_below);
    folder_ = above + "/lineshaft";
    if (::mkdir(folder_.c_str(), 0700) != 0 && errno != EEXIST)
        throw NoCompiledCode(fmt::format("cannot make {}: {}", folder_, std::strerror(errno)));
    descriptor_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    struct stat status {};
    struct statvfs system {};
    std::string why;
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0 ||
        ::fstatvfs(descriptor_, &system) != 0)
        why = fmt::format("cannot use {}: {}", folder_, std::strerror(errno));
    else if (!is_users_alone(status, 077))
        why = fmt::format("others may use {}: it must be yours, with mode 700", folder_);
    else if (system.f_flag & ST_NOEXEC)
        why = fmt::format("nothing in {} may be executed (noexec)", folder_);
    if (why.empty()) return;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw NoCompiledCode(why);
}

Cache::~Cache() {
    unlock();
    ::close(descriptor_);
}

std::string Cache::path(std::string_view name) const {
    return fmt::format("{}/{}", folder_, name);
}

void* Cache::load(std::string_view key) const {
    const std::string name = named(key);
    const int file = ::openat(descriptor_, name.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) return nullptr;
    struct stat status {};
    const bool is_ours =
        ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && is_users_alone(status, 022);
    const bool is_good = is_ours && is_whole(content(file), key);
    if (is_good) ::futimens(file, nullptr);
    ::close(file);
    if (!is_good) return nullptr;
    void* library = ::dlopen(path(name).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw NoCompiledCode(::dlerror());
    return library;
}

bool Cache::lock() {
    if (lock_ < 0)
        lock_ = ::openat(descriptor_, "lock", O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (lock_ < 0) throw NoCompiledCode(fmt::format("cannot write {}", folder_));
    return ::flock(lock_, LOCK_EX | LOCK_NB) == 0;
}

void Cache::unlock() {
    if (lock_ >= 0) ::close(std::exchange(lock_, -1));
}

void Cache::keep(const std::string& made, std::string_view key) const {
    std::ifstream file(made, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    bytes += key;
    std::ofstream whole(made, std::ios::binary | std::ios::app);
    whole << key << text_hash(bytes);
    whole.close();
    if (!whole || ::chmod(made.c_str(), 0600) != 0 ||
        ::rename(made.c_str(), path(named(key)).c_str()) != 0) {
        ::unlink(made.c_str());
        throw NoCompiledCode(fmt::format("cannot write {}", folder_));
    }
    delete_unused();
}

/// What goes wrong here remains: the next that is made tries again.
void Cache::delete_unused() const {
    struct File {
        std::filesystem::file_time_type used;
        std::uintmax_t size;
        std::filesystem::path path;
        auto operator<=>(const File&) const = default;
    };
    std::vector<File> files;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder_, none))
        if (entry.is_regular_file(none) && entry.path().extension() == ".so")
            files.push_back({entry.last_write_time(none), entry.file_size(none), entry.path()});
    std::sort(files.begin(), files.end(), std::greater<>());
    std::uintmax_t sum = 0;
    for (const File& file : files)
        if ((sum += file.size) > most_bytes) std::filesystem::remove(file.path, none);
}

}  // namespace lineshaft::st
