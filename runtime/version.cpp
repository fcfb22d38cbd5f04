#include "runtime/version.hpp"

namespace lineshaft {

const char* version() {
    return LINESHAFT_VERSION;
}

}  // namespace lineshaft
