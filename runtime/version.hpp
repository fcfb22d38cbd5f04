#pragma once

namespace lineshaft {

/// `0.1.0`
const char* version();

}  // namespace lineshaft
