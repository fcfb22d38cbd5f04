#pragma once

namespace lineshaft {

/// Holds each integer of 64 bits, with or without a sign, and products of two of them.
__extension__ using Wide = __int128;

}  // namespace lineshaft
