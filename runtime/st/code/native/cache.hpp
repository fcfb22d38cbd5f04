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
/// Behind each stands the SHA-256 of its bytes, so that one that is not whole is not loaded.
class Cache {
  public:
    /// NoCompiledCode where the folder cannot be, or others may write it.
    Cache();
    ~Cache();
    Cache(const Cache&) = delete;

    /// The handle of dlopen(3); null where it is not there, or not whole. NoCompiledCode where it
    /// cannot be executed.
    void* load(const std::string& name) const;

    /// False while another process has it.
    bool lock();
    void unlock();

    std::string path(std::string_view name) const;
    /// A file of this process that gets its name when it is whole.
    void keep(const std::string& made, const std::string& name) const;

  private:
    std::string folder_;
    int descriptor_ = -1, lock_ = -1;
};

}  // namespace lineshaft::st
