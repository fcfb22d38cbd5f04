#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// REFERENCE TO, REF_TO or POINTER TO that type.
Type& make_reference(Checking& c, Referring referring, const Type* target);
/// POINTER TO that type.
const Type& pointer_to(Checking& c, const Type& target);

/// REFERENCE TO, REF_TO, POINTER TO. What it is to may be declared further down, or be what it is
/// in.
const Type* resolve_reference(Checking& c, const TypeText& text);
/// Resolves those that had to wait until all types are known.
void resolve_targets(Checking& c);

/// A number of 32 bits or more holds where a POINTER points, and is made one again.
bool holds_address(const Type& type);

/// `e`, which means the member of a UNION that keeps a POINTER, becomes that.
const Type* use_kept_pointer(Checking& c, Expression*& e, const Variable& member);
/// The member, where `e` is such a POINTER; else `e`.
Expression* keeper_of_pointer(Expression* e);

/// `e`, a variable, becomes where it is, as a reference of that type; false for what is no
/// variable, which was told.
bool refer(Checking& c, Expression*& e, const Type& to);

/// `e`, a variable of a structure that extends `base`, becomes the part of it that is that. False:
/// it is no variable.
bool become_base(Checking& c, Expression*& e, const Type& base);

/// `p^`
const Type* check_target_of(Checking& c, Expression*& e);
/// `e`, a REFERENCE TO, becomes what it refers to, whose type is given.
const Type* take_target(Checking& c, Expression*& e);
/// `p[i]`, which is `(p + i * SIZEOF(p^))^`.
const Type* check_pointer_index(Checking& c, Expression*& e);

/// A VAR_IN_OUT is given that: what it refers to may end with the call at hand.
void note_lending(Checking& c, const Expression& place);
/// What an interface is given, which may be an instance of one call.
void note_held_instance(Checking& c, const Expression& given);

/// `target ?= value;`: NULL, where what the value is to is not of the target's type.
void check_attempt(Checking& c, Statement& s);

/// What a call of __QUERYINTERFACE or __QUERYPOINTER is given, so that its variables are of one
/// type; false: an argument is wrong, which was told.
bool take_query(Checking& c, Expression*& e, const Routine& called);

/// What is written left of REF=, and where else a REFERENCE TO means itself.
Expression*& without_alias(Expression*& e);
/// `r REF= x;`
void check_reference_assignment(Checking& c, Statement& s);
/// `e`, what a REFERENCE TO refers to, stands for where that is beside `other`, an address, as B&R
/// has it: `r := ADR(x)`, `r <> 0`.
bool means_address(const Expression& e, const Expression& other);
/// Where a side of a comparison does.
void take_addresses(Checking& c, Expression& e);
/// Where the target of an assignment does.
void assign_address(Checking& c, Statement& s);
/// One of both is a reference: comparisons, and what is reckoned with a POINTER.
const Type* check_reference_operator(Checking& c, Expression*& e, const Type* expected);
/// As coerce(), where one of both types is that of a reference.
bool coerce_reference(Checking& c, Expression*& e, const Type& to);

// reference_calls.cpp

/// ADR, REF, SIZEOF, __ISVALIDREF; __NEW and __DELETE, which are refused. Empty: none of them.
std::optional<const Type*> check_reference_call(Checking& c, Expression*& e, const Type* expected);

}  // namespace lineshaft::st
