#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <stdlib.h>

namespace lineshaft::test {

/// A folder of a fuzz target's own, removed at its end.
struct FuzzFolder {
    FuzzFolder() {
        char name[] = "/tmp/lineshaft-fuzz-XXXXXX";
        if (!::mkdtemp(name)) std::abort();
        path = name;
    }
    ~FuzzFolder() {
        std::error_code gone;
        std::filesystem::remove_all(path, gone);
    }
    std::string path;
};

}  // namespace lineshaft::test
