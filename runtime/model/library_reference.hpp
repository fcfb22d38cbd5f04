#pragma once

#include <string>

#include "runtime/source/diagnostic.hpp"

namespace lineshaft {

/// That a project refers to a library, and where.
struct LibraryReference {
    std::string name;
    Mark mark;

    bool operator==(const LibraryReference& other) const { return name == other.name; }
};

}  // namespace lineshaft
