#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace lineshaft::st {

/// Why there will be no compiled code: a sentence without its point.
struct NoCompiledCode : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Shared objects in a folder that is the user's alone: `lineshaft` in $XDG_CACHE_HOME or ~/.cache.
/// Each is named by the hash of its key, what it was made of. Behind its bytes stand the key, and
/// the hash of both, so that none is loaded of another key, or that is not whole. The longest
/// unused are deleted: 256 MiB remain.
class Cache {
  public:
    /// NoCompiledCode where the folder cannot be, or others may write it.
    Cache();
    ~Cache();
    Cache(const Cache&) = delete;

    /// The handle of dlopen(3); null where it is not there, or not whole. NoCompiledCode where it
    /// cannot be executed.
    void* load(std::string_view key) const;

    /// False while another process has it.
    bool lock();
    void unlock();

    std::string path(std::string_view name) const;
    /// A file of this process that gets its name when it is whole.
    void keep(const std::string& made, std::string_view key) const;

  private:
    void delete_unused() const;

    std::string folder_;
    int descriptor_ = -1, lock_ = -1;
};

}  // namespace lineshaft::st
