#include "runtime/trace/output_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

/// So that the new name outlives a power failure. A folder that cannot be read, or a file system
/// that does not flush folders, is no error.
bool flush_folder(const std::string& path) {
    const fs::path folder = fs::path(path).parent_path();
    const int descriptor =
        ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return true;
    const bool flushed = ::fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS;
    const int error = errno;
    ::close(descriptor);
    errno = error;
    return flushed;
}

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

}  // namespace

OutputFile::OutputFile(std::string path, std::int64_t keep)
    : path_(std::move(path)), part_(path_ + ".part") {
    if (look()) open(keep);
}

OutputFile::OutputFile(std::string path, StateReader& begun)
    : path_(std::move(path)), part_(path_ + ".part") {
    std::int64_t size = 0;
    std::string tail;
    begun.get(size);
    begun.get(tail);
    if (!look()) return;
    if (regular_ && !take_up(size, tail))
        set_error(
            fmt::format("cannot go on with '{}': it is not the file of the checkpoint", path_));
    else
        open(size);
}

void OutputFile::open(std::int64_t keep) {
    const bool kept = !regular_ || keep == 0 || ::truncate(part_.c_str(), keep) == 0;
    if (kept) file_ = std::fopen(regular_ ? part_.c_str() : path_.c_str(), keep > 0 ? "ab" : "wb");
    if (!file_) fail("open");
}

bool OutputFile::look() {
    std::error_code unknown;  // opening tells it
    const fs::file_status status = fs::status(path_, unknown);
    if (fs::is_directory(status))
        set_error(fmt::format("cannot write '{}': it is a directory", path_));
    regular_ = !fs::exists(status) || fs::is_regular_file(status);
    return error_.empty();
}

bool OutputFile::take_up(std::int64_t size, const std::string& tail) {
    if (tail_of(part_, size) == tail) return true;
    if (tail_of(path_, size) != tail) return false;
    std::error_code error;
    fs::copy_file(path_, part_, fs::copy_options::overwrite_existing, error);
    return !error;
}

void OutputFile::save(StateWriter& out) {
    std::int64_t size = 0;
    if (error_.empty() && regular_) {
        if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) fail("write");
        std::fseek(file_, 0, SEEK_END);
        size = std::ftell(file_);
    }
    out.put(size);
    out.put(tail_of(part_, size));
}

OutputFile::~OutputFile() {
    if (file_) std::fclose(file_);
}

void OutputFile::write(std::string_view text) {
    if (!error_.empty()) return;
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail("write");
}

void OutputFile::flush() {
    if (error_.empty() && std::fflush(file_) != 0) fail("write");
}

bool OutputFile::commit() {
    if (!error_.empty()) return false;
    if (std::fflush(file_) != 0) fail("write");
    if (regular_ && error_.empty() && ::fsync(::fileno(file_)) != 0) fail("write");
    if (std::fclose(file_) != 0 && error_.empty()) fail("close");
    file_ = nullptr;
    if (!regular_ || !error_.empty()) return error_.empty();
    if (std::rename(part_.c_str(), path_.c_str()) != 0) fail("rename");
    if (error_.empty() && !flush_folder(path_)) fail("flush the folder of");
    return error_.empty();
}

void OutputFile::fail(const char* what) {
    set_error(fmt::format("cannot {} '{}': {}", what, path_, std::strerror(errno)));
}

void OutputFile::set_error(std::string text) {
    error_ = std::move(text);
    failed_ = true;
}

}  // namespace lineshaft
