#include "runtime/trace/output_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "runtime/trace/folder_locks.hpp"

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

/// The last bytes before `size`; empty when there is no such place.
std::string tail_of(const std::string& path, std::int64_t size) {
    constexpr std::int64_t most = 4096;
    const std::int64_t length = std::min(size, most);
    std::ifstream file(path, std::ios::binary);
    std::string tail(static_cast<std::size_t>(length), '\0');
    file.seekg(size - length);
    file.read(tail.data(), length);
    return file ? tail : "";
}

/// Whether a part's name ends so: `.part`, `.part2`.
bool is_suffix(std::string_view text) {
    constexpr std::string_view begin = ".part";
    return text.starts_with(begin) &&
           text.find_first_not_of("0123456789", begin.size()) == std::string_view::npos;
}

bool is_name_of(int descriptor, const std::string& path) {
    struct stat opened {
    }, named{};
    return ::fstat(descriptor, &opened) == 0 && ::stat(path.c_str(), &named) == 0 &&
           opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace

OutputFile::OutputFile(std::string path, std::int64_t keep) : path_(std::move(path)) {
    if (look()) open(keep);
}

OutputFile::OutputFile(std::string path, StateReader& begun) : path_(std::move(path)) {
    std::int64_t size = 0;
    std::string tail;
    begun.get(size, 0, std::numeric_limits<std::int64_t>::max());
    begun.get(tail);
    begun.get(suffix_);
    begun.require(is_suffix(suffix_), fmt::format("the place in '{}'", path_));
    if (!begun.ok()) set_error(fmt::format("the checkpoint does not fit '{}'", path_));
    if (!begun.ok()) return;
    if (!look()) return;
    if (!regular_)
        open(0);
    else if (take_up(size, tail))
        open_stream(descriptor_, size);
    else if (error_.empty())
        set_error(
            fmt::format("cannot go on with '{}': it is not the file of the checkpoint", path_));
}

bool OutputFile::look() {
    std::error_code unknown;  // opening tells it
    const fs::file_status status = fs::status(path_, unknown);
    if (fs::is_directory(status))
        set_error(fmt::format("cannot write '{}': it is a directory", path_));
    regular_ = path_ != "-" && (!fs::exists(status) || fs::is_regular_file(status));
    return error_.empty();
}

void OutputFile::open(std::int64_t keep) {
    if (path_ == "-") return open_stream(::dup(STDOUT_FILENO), 0);
    if (!regular_) return open_stream(::open(path_.c_str(), O_WRONLY | O_CLOEXEC), 0);
    if (keep == 0)
        take_free_part();
    else if (take_part() == Taken::busy)
        set_error(fmt::format("cannot go on with '{}': another process writes it", path_));
    if (error_.empty()) open_stream(descriptor_, keep);
}

OutputFile::Taken OutputFile::take_part() {
    constexpr int most = 1000;  // on a file system whose numbers of files are not to be trusted
    for (int attempt = 1;; ++attempt) {
        descriptor_ = ::open(part().c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
        if (descriptor_ < 0) {
            fail("open");
            return Taken::failed;
        }
        // A file system that cannot lock has one writer at a time.
        const bool busy = ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
        if (!busy && (is_name_of(descriptor_, part()) || attempt == most)) return Taken::yes;
        ::close(descriptor_);
        descriptor_ = -1;
        if (busy) return Taken::busy;
    }
}

void OutputFile::take_free_part() {
    constexpr int most = 10'000;
    suffix_ = ".part";
    for (int number = 2; take_part() == Taken::busy && number <= most; ++number)
        suffix_ = fmt::format(".part{}", number);
}

bool OutputFile::take_up(std::int64_t size, const std::string& tail) {
    if (tail_of(part(), size) == tail && take_part() == Taken::yes) return true;
    if (tail_of(path_, size) != tail || !error_.empty()) return false;
    take_free_part();
    std::error_code error;
    if (error_.empty()) fs::copy_file(path_, part(), fs::copy_options::overwrite_existing, error);
    return error_.empty() && !error;
}

void OutputFile::open_stream(int descriptor, std::int64_t keep) {
    descriptor_ = -1;
    if (descriptor >= 0) file_ = ::fdopen(descriptor, "wb");
    if (!file_) {
        fail("open");
        if (descriptor >= 0) ::close(descriptor);
    } else if (regular_ && ::ftruncate(descriptor, keep) != 0 && errno != EINVAL) {
        fail("open");
    } else if (regular_) {
        std::fseek(file_, 0, SEEK_END);
    }
}

void OutputFile::save(StateWriter& out) {
    std::int64_t size = 0;
    if (error_.empty() && regular_) {
        if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) fail("write");
        std::fseek(file_, 0, SEEK_END);
        size = std::ftell(file_);
    }
    out.put(size);
    out.put(tail_of(part(), size));
    out.put(suffix_);
}

OutputFile::~OutputFile() {
    if (file_) std::fclose(file_);
    if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(std::string_view text) {
    if (!error_.empty()) return;
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail("write");
}

void OutputFile::flush() {
    if (error_.empty() && std::fflush(file_) != 0) fail("write");
}

bool OutputFile::complete() {
    flush();
    if (regular_ && error_.empty() && ::fsync(::fileno(file_)) != 0) fail("write");
    return error_.empty();
}

bool OutputFile::publish() {
    if (error_.empty() && regular_ && std::rename(part().c_str(), path_.c_str()) != 0)
        fail("rename");
    if (std::fclose(std::exchange(file_, nullptr)) != 0 && error_.empty()) fail("close");
    return error_.empty();
}

void OutputFile::discard() {
    if (!regular_ || !file_) return;
    ::unlink(part().c_str());
    std::fclose(std::exchange(file_, nullptr));
    set_error(fmt::format("'{}' was discarded", path_));
}

bool OutputFile::commit() {
    if (!complete()) return false;
    if (!regular_) return publish();
    const FolderLocks folder({folder_of(path_)});
    if (publish() && !folder.flush()) fail("flush the folder of");
    return error_.empty();
}

void OutputFile::fail(const char* what) {
    const int error = errno;
    const std::string name = path_ == "-" ? "to the standard output" : fmt::format("'{}'", path_);
    set_error(fmt::format("cannot {} {}: {}", what, name, std::strerror(error)));
}

void OutputFile::set_error(std::string text) {
    error_ = std::move(text);
    failed_ = true;
}

}  // namespace lineshaft
