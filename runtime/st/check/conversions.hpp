#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// REAL.
bool is_single(const Type& type);
/// Makes `e` a value of `to` where the language does that by itself, and tells where it does not.
bool coerce(Checking& c, Expression*& e, const Type& to);
/// Puts a conversion in, or converts a constant at once.
void convert(Checking& c, Expression*& e, const Type& to);

/// `16#FF` has that of the bit string that is wanted.
void take_width(Checking& c, Expression*& e, const Type* expected);

/// A bit string where a number is due.
void become_number(Checking& c, Expression*& e);

/// Integers are joined as bit strings of their width. It is reckoned with bit strings as with
/// integers: with the wanted one, if that is wider.
void reinterpret(Checking& c, Expression& e, Kind from, const Type* expected = nullptr);

/// Of a CHAR and a STRING one becomes what the other is.
void unite_texts(Checking& c, Expression*& a, Expression*& b);

/// Gives a number without type that of the other one, if it fits.
bool make_concrete(Checking& c, Expression*& e, const Type& other);

/// Brings both operands to one type, if there is one.
const Type* unite(Checking& c, Expression& e, const Type* expected = nullptr);

// In place, for standard_calls.cpp.
const Type* convert_result(Checking& c, Expression& call, const Type& from, const Type& to);

}  // namespace lineshaft::st
