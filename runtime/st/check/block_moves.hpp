#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// MOVE_BLK, UMOVE_BLK, FILL_BLK and UFILL_BLK of Siemens as what they do with the elements of two
/// arrays; beyond an array is a fault. Its arguments are in their order.
void rewrite_block_move(Checking& c, Statement*& s);

}  // namespace lineshaft::st
