#include "runtime/trace/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>

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

}  // namespace

OutputFile::OutputFile(std::string path, std::int64_t keep)
    : path_(std::move(path)), part_(path_ + ".part") {
    std::error_code unknown;  // opening tells it
    const fs::file_status status = fs::status(path_, unknown);
    if (fs::is_directory(status)) {
        error_ = fmt::format("cannot write '{}': it is a directory", path_);
        failed_ = true;
        return;
    }
    regular_ = !fs::exists(status) || fs::is_regular_file(status);
    const bool kept = keep == 0 || ::truncate(part_.c_str(), keep) == 0;
    if (kept) file_ = std::fopen(regular_ ? part_.c_str() : path_.c_str(), keep > 0 ? "ab" : "wb");
    if (!file_) fail("open");
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
    error_ = fmt::format("cannot {} '{}': {}", what, path_, std::strerror(errno));
    failed_ = true;
}

}  // namespace lineshaft
