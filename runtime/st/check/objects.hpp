#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// A PROGRAM that CODESYS names as its one instance, no variable being called so: a global from
/// then on. Null: it is none.
Variable* declare_program(Checking& c, const Token& name);

/// The kind of block that an AXIS_REF refers to.
const Type* object_type(Checking& c, const Type& handle);
/// `VAR_GLOBAL Axis_1 : AXIS_REF`: the program has the block.
Variable* declare_object(Checking& c, Variable& variable);

/// What a test has of a kind that others refer to, such as an axis, is a block of its own.
void make_object(Checking& c, Variable& variable);

/// `e` means the block of the program that has its name.
const Type* use_object(Checking& c, Expression*& e, const Type& type);
/// What its kind or a library says of it in Structured Text.
Routine* find_part(Checking& c, const Type& type, std::string_view name);

/// `"Axis_1".Position`, where nothing else is called so.
bool is_object_of(Checking& c, const Expression& member);

/// The function is called with what stands before the point.
const Type* check_part(Checking& c, Expression*& member, Routine& part);

}  // namespace lineshaft::st
