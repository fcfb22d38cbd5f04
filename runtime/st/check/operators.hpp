#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

inline bool is_comparison(Word op) {
    return op >= Word::less && op <= Word::unequal;
}

inline bool is_logic(Word op) {
    return op == Word::and_ || op == Word::or_ || op == Word::xor_ || op == Word::and_then_ ||
           op == Word::or_else_;
}

/// `-x`, `NOT x`, `a + b`: checks the operands, brings them to one type, and folds constants. L0905
/// and L0906 where an operator does not go with them.
const Type* check_unary(Checking& c, Expression*& e, const Type* expected);
const Type* check_binary(Checking& c, Expression*& e, const Type* expected);

}  // namespace lineshaft::st
