#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// REAL.
bool is_single(const Type& type);
/// Makes `e`, which has a type, a value of `to` where the language does that by itself: a constant
/// of it, or a conversion. False where it does not, which was told: L0905, L0906, or L0908 for a
/// constant that is out of range.
bool coerce(Checking& c, Expression*& e, const Type& to);
/// Makes `e` a value of `to` in any case: a conversion is put in, or a constant converted at once.
void convert(Checking& c, Expression*& e, const Type& to);

/// `16#FF` has that of the bit string that is wanted.
void take_width(Checking& c, Expression*& e, const Type* expected);

/// A bit string where a number is due.
void become_number(Checking& c, Expression*& e);

/// A whole number or a bit string becomes a LINT.
void become_lint(Checking& c, Expression*& e);

/// A value of an enumeration that a source declares where a number is due.
void enumeration_becomes_number(Checking& c, Expression*& e);

/// Integers are joined as bit strings of their width. It is reckoned with bit strings as with
/// integers: with the wanted one, if that is wider.
void reinterpret(Checking& c, Expression& e, Kind from, const Type* expected = nullptr);

/// Of a CHAR and a STRING one becomes what the other is.
void unite_texts(Checking& c, Expression*& a, Expression*& b);

/// Gives a number without type that of the other one, if it fits.
bool make_concrete(Checking& c, Expression*& e, const Type& other);

/// Brings both operands to one type, that of the result or one that `expected` suggests; null if
/// there is none, which was told, L0905 or L0906.
const Type* unite(Checking& c, Expression& e, const Type* expected = nullptr);

/// `e`, which is of type `from`, as a value of `to`.
const Type* convert_result(Checking& c, Expression*& e, const Type& from, const Type& to);

}  // namespace lineshaft::st
