#include "blocks/libraries/libraries.hpp"

namespace lineshaft {

namespace {

using namespace std::string_view_literals;

constexpr LibraryFile files_of_libraries[] = {
#include "blocks/libraries/libraries.inc"
};

}  // namespace

std::span<const LibraryFile> vendor_libraries() {
    return files_of_libraries;
}

}  // namespace lineshaft
