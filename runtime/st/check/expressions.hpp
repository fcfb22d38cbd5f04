#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// The type of `e`, noted in it; null if it has none, which was told then. `expected` is what it
/// goes to, if that is known: it gives numbers, names of enumerations and functions their type, and
/// does not convert. What `e` stands for is hung in its place: a constant for what is folded.
const Type* check(Checking& c, Expression*& e, const Type* expected = nullptr);

// literals.cpp

/// A literal as it is written: notes its value. A number has no type of its own yet.
const Type* check_literal(Checking& c, Expression*& e);
/// `__POUNAME()` and `__POSITION()`, texts that CODESYS makes of where they stand. Empty: neither.
std::optional<const Type*> check_place_call(Checking& c, Expression*& e);
/// `INT#5`, `Colour#red`.
const Type* check_typed(Checking& c, Expression*& e);
/// `DTL#2020-02-29-12:30:15` as its parts.
Expression* list_of_dtl(Checking& c, const Expression& literal, const Type& type);

// operators.cpp

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

/// Tells that the operator does not go with what it stands between.
Nothing refuse_operands(Checking& c, const Expression& e, std::string help);

// time_operators.cpp

/// Operands that are DTL become LDT.
void become_moments(Checking& c, Expression& e);
/// TIME + TIME, TIME * number, TIME / number.
const Type* check_time_arithmetic(Checking& c, Expression*& e);
/// TIME(), LTIME(), TASK_CYCLE() and their like.
const Type* check_scan_time(Checking& c, Expression*& e);

/// DTL + TIME, TIME + DTL, DTL - TIME, and DTL - DTL, a TIME.
const Type* check_dtl_arithmetic(Checking& c, Expression*& e);

}  // namespace lineshaft::st
