#include "runtime/st/functions/emission.hpp"

namespace lineshaft::st {

/// The families of integers stand in the order SINT, INT, DINT, LINT, USINT, UINT, UDINT, ULINT.
Op of_type(Op first, const Type& type) {
    constexpr int distance = static_cast<int>(Op::add_int) - static_cast<int>(Op::add_sint);
    int width = 0;
    while ((8 << width) < type.bits) ++width;
    const int number = type.is_signed ? width : width + 4;
    return static_cast<Op>(static_cast<int>(first) + number * distance);
}
}  // namespace lineshaft::st
