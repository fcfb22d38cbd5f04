#pragma once

#include <set>
#include <string>
#include <vector>

namespace lineshaft {

/// Holds the folders of some files for as long as it lives, so that their names are given by one
/// process at a time. A folder that cannot be read, or that its file system cannot lock, is not
/// held.
class FolderLocks {
  public:
    explicit FolderLocks(const std::set<std::string>& folders);
    ~FolderLocks();
    FolderLocks(const FolderLocks&) = delete;
    FolderLocks& operator=(const FolderLocks&) = delete;

    /// So that names outlive a power failure; false, and errno, when a disk fails. A file system
    /// that does not flush folders is no error.
    bool flush() const;

  private:
    FolderLocks() = default;  ///< first, so that what throws behind it closes what is open

    std::vector<int> descriptors_;
};

/// So that all that has been written below a folder outlives a power failure; false, and errno,
/// when a disk fails. Of a folder that may not be read nobody is told whether one does.
bool flush_file_system(const std::string& folder);

/// The folder that a file stands in: `.` for a bare name.
std::string folder_of(const std::string& path);

}  // namespace lineshaft
