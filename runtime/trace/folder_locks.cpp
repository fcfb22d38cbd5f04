#include "runtime/trace/folder_locks.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <map>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lineshaft {

FolderLocks::FolderLocks(const std::set<std::string>& folders) : FolderLocks() {
    // Each once, by whatever names, and in one order for all processes.
    std::map<std::pair<dev_t, ino_t>, int> opened;
    descriptors_.reserve(folders.size());
    for (const std::string& folder : folders) {
        const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        struct stat status {};
        if (descriptor < 0) continue;
        descriptors_.push_back(descriptor);
        if (::fstat(descriptor, &status) == 0 &&
            opened.try_emplace({status.st_dev, status.st_ino}, descriptor).second)
            continue;
        ::close(descriptor);
        descriptors_.pop_back();
    }
    for (const auto& [place, descriptor] : opened)
        while (::flock(descriptor, LOCK_EX) != 0 && errno == EINTR) continue;
}

FolderLocks::~FolderLocks() {
    for (const int descriptor : descriptors_) ::close(descriptor);
}

bool FolderLocks::flush() const {
    return std::ranges::all_of(descriptors_, [](int descriptor) {
        return ::fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS;
    });
}

bool flush_file_system(const std::string& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) {
        ::sync();
        return true;
    }
    const bool flushed = ::syncfs(descriptor) == 0;
    ::close(descriptor);
    return flushed;
}

std::string folder_of(const std::string& path) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

}  // namespace lineshaft
