#include "tests/source_folder.hpp"

namespace lineshaft::test {

std::string in_source(const std::string& path) {
    return std::string(LINESHAFT_SOURCE_DIR) + "/" + path;
}

}  // namespace lineshaft::test
