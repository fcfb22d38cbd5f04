#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// Whether a relation holds of two values; empty if `op` is none.
template <class T>
std::optional<bool> compare(Word op, const T& a, const T& b) {
    switch (op) {
        case Word::less:
            return a < b;
        case Word::less_or_equal:
            return a <= b;
        case Word::greater:
            return a > b;
        case Word::greater_or_equal:
            return a >= b;
        case Word::equal:
            return a == b;
        case Word::unequal:
            return a != b;
        default:
            return {};
    }
}

/// What another operator of two values comes to, as whole numbers and as real ones; a quotient of
/// whole numbers by 0 is 0, and MOD is not to be asked of that.
Constant operate(Word op, const Constant& a, const Constant& b);

/// An operator with a constant, whose type is noted, becomes its result.
void fold_unary(Checking& c, Expression*& e);
/// The same of two constants of one type. L0908 where it divides by zero, or leaves 64 bits.
void fold(Checking& c, Expression*& e);
/// What is made of constants, operators, conversions and functions of the standard becomes its
/// value, with the bits of a scan: the machine reckons. True if it is a constant then. L0908 where
/// that ends with a fault.
bool evaluate(Checking& c, Expression*& e);

/// Checks `e` and reckons it: a whole number that is known when compiling, of `type`. Empty if it
/// is none, which was told, L0913.
std::optional<Wide> check_whole(Checking& c, Expression*& e, const Type& type);

}  // namespace lineshaft::st
