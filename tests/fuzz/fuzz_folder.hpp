#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <stdlib.h>

namespace lineshaft::test {

/// A folder of a fuzz target's own, removed at its end. In memory where that can be: a disk's
/// file system writes what is truncated and written anew at once, some hundred times a second.
struct FuzzFolder {
    FuzzFolder() {
        char in_memory[] = "/dev/shm/lineshaft-fuzz-XXXXXX",
             on_disk[] = "/tmp/lineshaft-fuzz-XXXXXX";
        const char* const name = ::mkdtemp(in_memory) ? in_memory : ::mkdtemp(on_disk);
        if (!name) std::abort();
        path = name;
    }
    ~FuzzFolder() {
        std::error_code gone;
        std::filesystem::remove_all(path, gone);
    }
    std::string path;
};

}  // namespace lineshaft::test
