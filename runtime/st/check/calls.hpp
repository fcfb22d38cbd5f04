#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// A function or a method is called, which its arguments are checked for and given to; notes the
/// routine, and that the one at hand calls it. The type of its result: null where it has none,
/// which is told unless the call is a statement.
const Type* check_routine_call(Checking& c, Expression*& e, Routine& routine, bool as_statement);
/// The name of a part of a kind of the catalogue, also where vendors call it otherwise: RESET is R.
std::string_view standard_name(const Type& type, std::string_view name);
/// Finds what is called, an instance, a method, a function, a statement of tests, and checks that.
/// `as_statement`: its value is not taken. `expected` as in check().
const Type* check_call(Checking& c, Expression*& e, bool as_statement, const Type* expected);

// arguments.cpp

/// What a call gives suits `parameter`, and becomes that; else it is told.
void check_argument(Checking& c, Argument& argument, Variable& parameter);

// overloads.cpp

/// Which of the functions or methods that share the name of `first` a call means: the one whose
/// arguments, also those that go out, are of the types that are given, or need the least
/// conversion. Where none fits it is the first, whose call is refused then.
Routine& overload_of(Checking& c, Expression& call, const NameMap<std::vector<Routine*>>& overloads,
                     Routine& first);
/// The function that a call of the name of `first` means: of the namespaces that are seen there the
/// innermost that has an overload which fits.
Routine& function_called(Checking& c, Expression& call, Routine& first);
/// A call without THIS means a function, though the block has a method of that name: a function of
/// the sources or of a library they use, as SIMATIC AX has it; or one of the standard, where the
/// call gives more than the method takes.
bool means_function(Checking& c, const Expression& call, const Routine& method);

// timers.cpp

/// `TON` of `#delay.TON(...)`, also where the kind is Structured Text itself, as TONR is.
bool is_named_as_its_kind(const Type& type, std::string_view name);
/// Siemens' IEC_TIMER that is called as a TONR is declared as one, which has an input more.
void make_sums_of_timers(Checking& c);
/// Any other is what it is called as; all timers have one layout. Null: it is no TOF or TP.
const Type* timer_of(Checking& c, const Type& type, const Token& called);
/// Notes what a call makes a timer.
void note_timer(Checking& c, const Expression& timer, const BlockType& called);

// standard_calls.cpp

/// Tells when there are too few arguments, or too many.
bool check_count(Checking& c, const Expression& call, const StandardFunction& f);
/// Arguments by name may stand in any order: those of the call that stands for it are in that of
/// the function. False for a name that is none, which was told.
bool order_arguments(Checking& c, Expression*& e, const StandardFunction& f);

/// A function of the standard, or a conversion by its name: `expected` as in check().
const Type* check_standard_function(Checking& c, Expression*& e, const Type* expected);

// standard_types.cpp

/// What the call of a standard function gives; null, and told, if its arguments do not suit. They
/// have their own types already, and become what the function takes.
const Type* standard_type_of(Checking& c, Expression*& e, const Type* expected);

// reference_calls.cpp

/// What MEMCPY and its like are given, and the type of what they give.
const Type* check_memory(Checking& c, Expression& call, const Type* expected);

// extreme_texts.cpp

/// MIN, MAX and LIMIT of texts, which have their types: choices of texts stand for the call then.
const Type* check_extreme_text(Checking& c, Expression*& e);

// conversion_calls.cpp

/// `INT_TO_REAL(x)`, `TO_REAL(x)`, `REAL_TRUNC_INT(x)`: a conversion stands for the call then.
/// Empty if the name is none of one.
std::optional<const Type*> check_conversion(Checking& c, Expression*& e, std::string_view name);
/// Whether it is one between elementary types.
bool is_conversion_name(std::string_view name);

// bit_patterns.cpp

/// `MOVE(x)` is what Move of Siemens' LAD and FBD does: a number, a bit string or a time goes to
/// what is wanted by its bits, the lowest first. All else is assigned. Empty: it is no such call.
std::optional<const Type*> check_move(Checking& c, Expression*& e, const Type* expected);

// any_inputs.cpp

/// Whether an input is ANY, as CODESYS and TwinCAT have it.
bool is_any_input(const Type& type);

/// `value`, a variable of any type, becomes what such an input has inside: its class, where it is,
/// how many bytes it has. What came by such an input is passed on.
void become_any(Checking& c, Expression*& value, const Type& type);

}  // namespace lineshaft::st
