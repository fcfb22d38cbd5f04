#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// REAL.
bool is_single(const Type& type);
/// `i * 0.1` is an LREAL: where one is due, in CODESYS where no REAL is. Else it is a REAL.
bool makes_lreal_of_literals(const Place& place, const Type* expected);
/// An integer without sign goes to a bit string of its width or a wider one.
bool are_same_pattern(const Type& given, const Type& to);
/// A constant of another type loses nothing.
bool fits_as_constant(const Expression& e, const Type& to);
/// CODESYS takes a LINT or ULINT for a REAL or LREAL, which rounds it.
bool takes_long_numbers(const Expression& e, const Type& from);
/// CODESYS reads the number in a bit string where a REAL is due, which rounds one of its width.
bool counts_bits(const Type& from, const Type& to, const Place& place);
/// `'A'` in SIMATIC AX, which is a CHAR where nothing else is due.
bool is_literal_character(const Expression& e);
/// As it is written: of a pin of the catalogue, `MC_Home.HomingMode`, without that.
std::string first_value(const Checking& c, const Type& type);
/// A conversion of numbers to it has a table of those between its least and its most.
bool has_table_for(const Type& enumeration);
/// Siemens gives a number where PLCopen has a name: `Direction := 1`.
bool coerce_number(Checking& c, Expression*& e, const Type& to);
/// An enumeration's value and its number stand for each other where the one is known to be one of
/// the other, as CODESYS has it, which so takes values of another enumeration, too; false where
/// nothing was done.
bool coerce_enumeration(Checking& c, Expression*& e, const Type& to);
/// Makes a text one of `to`, of the other width: in dialects whose STRING has a byte a character,
/// by its characters.
void recode(Checking& c, Expression*& e, const Type& to);
/// Makes `e`, which has a type, a value of `to` where the language does that by itself: a constant
/// of it, or a conversion. False where it does not, which was told: L0905, L0906, or L0908 for a
/// constant that is out of range.
bool coerce(Checking& c, Expression*& e, const Type& to);
/// In SCL: arrays of as many elements, and a structure without a name and one with members of the
/// same types, whatever their names, are assigned to each other. Other bounds are told.
bool has_same_form(Checking& c, const Place& at, const Type& from, const Type& to);
/// That a value of `to` does not hold every one of what `e` is of.
void warn_of_loss(Checking& c, const Expression& e, const Type& to);
/// Makes `e` a value of `to` in any case: a conversion is put in, or a constant converted at once.
/// Gives that type, which is never null.
const Type* convert(Checking& c, Expression*& e, const Type& to);

/// What is kept in a variable of another type although that does not hold every value of it: where
/// the dialect does so by itself, which is told.
bool may_become(Checking& c, const Expression& e, const Type& to);

/// What is kept of a TIME that is whole ms in 32 bits, in SCL with a sign.
Wide in_whole_ms(Wide nanoseconds, const Dialect& dialect);
/// An LTIME that is assigned to a TIME of SCL, and the like: what is below a ms is not kept, but by
/// blocks of the standard.
bool is_cut_to_ms(const Expression& target, const Type& from);

/// `16#FF` has that of the bit string that is wanted.
void take_width(Checking& c, Expression*& e, const Type* expected);

/// A bit string where a number is due.
void become_number(Checking& c, Expression*& e);
/// MatIEC calls a function of C, whose arguments and result have no more bits than their type.
void keep_width(Checking& c, Expression*& e);

/// What CODESYS reckons in a register is looked at there, and not kept: it becomes a DINT.
void look_in_register(Checking& c, Expression*& e);

/// A whole number or a bit string becomes a LINT.
void become_lint(Checking& c, Expression*& e);

/// A value of an enumeration that a source declares where a number is due.
void enumeration_becomes_number(Checking& c, Expression*& e);

/// `e`, which is of type `from`, as a value of `to`.
const Type* convert_result(Checking& c, Expression*& e, const Type& from, const Type& to);

// bit_patterns.cpp

/// A time, a date or a time of day, and a number, a bit string or another of these, of as many bits
/// in the memory of an S7.
bool is_pattern_of_time(const Type& from, const Type& to, const Dialect& dialect);

// operands.cpp

/// Integers are joined as bit strings of their width. It is reckoned with bit strings as with
/// integers: with the wanted one, if that is wider.
void reinterpret(Checking& c, Expression& e, Kind from, const Type* expected = nullptr);

/// A CHAR beside a STRING becomes one, or the STRING a CHAR.
void unite_texts(Checking& c, Expression*& a, Expression*& b);

/// `1.0E300` beside a REAL: both are LREALs, in CODESYS where a REAL is due, too.
bool is_beyond_single(const Expression& e, const Type& other, const Type* expected);

/// Gives a number without type that of the other one, if it fits.
bool make_concrete(Checking& c, Expression*& e, const Type& other);

/// The type that holds a constant which `typed` does not, and all of that: the next bit string, or
/// what is expected, or a signed one. Null if there is none, or none is needed.
const Type* wider_for(const Expression& constant, const Type& typed, const Type* expected);

/// Brings both operands to one type, that of the result or one that `expected` suggests; null if
/// there is none, which was told, L0905 or L0906.
const Type* unite(Checking& c, Expression& e, const Type* expected = nullptr);

// constants.cpp

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
