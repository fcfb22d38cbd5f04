#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// In the routine, then in its block, then among the globals; null if there is none.
Variable* find_variable(Checking& c, const Token& token);
/// Whether it is of the routine or its block, which hides what stands beside them.
bool is_own_variable(const Checking& c, const Token& token);
/// The block at hand, where it has a method of that name, which hides functions, programs and
/// global variables. Null: it has none, or an instance of its own is called so.
const Routine* block_with_method(const Checking& c, const Token& token);
/// Adds it, or tells that it is declared twice.
bool is_new_name(Checking& c, Token name, NameMap<Place>& names, bool is_test = false);
/// B&R's own libraries have such: the first one is meant by both, which is told.
bool is_told_by_capitals(Checking& c, const Token& name, const NameMap<Place>& names);

/// Told once in a block, unless it may be declared in what was not understood. One of `functions`
/// may be meant, too.
const Type* undeclared(Checking& c, const Token& name, Place place,
                       std::span<const std::string_view> functions = {});

/// `e` means the variable; one that is constant is its value.
const Type* use(Checking& c, Expression*& e, Variable& variable);
/// The enumeration of `Colour.red`; null if this is none.
const Type* enumeration_of(Checking& c, const Expression& member);

/// The value of that name.
const Type* check_value(Checking& c, Expression*& e, const Type& enumeration, const Token& name);

/// A variable, a value of an enumeration, TRUE, ENO, a block of the program where a reference is
/// `expected`. L0904 for what is not declared.
const Type* check_name(Checking& c, Expression*& e, const Type* expected);

// places.cpp

/// What a structure, an instance of the catalogue or a block of the sources has by that name; null
/// if there is nothing.
Variable* find_member(const Type& type, std::string_view name);

/// What a suggestion is chosen from.
std::vector<std::string> names_of(const std::vector<Variable*>& variables);
/// Those of a standard block's parts as the dialect there calls them.
std::vector<std::string> shown_names(const std::vector<Variable*>& parts, Place place);

/// `motor.speed`, whose variable is noted; also `Colour.red`, and a part of a block that is a
/// function. L0904 where there is none.
const Type* check_member(Checking& c, Expression*& e);
/// `DB10.DBW4`, `"Data".%DBX2.0` of a data block, as an S7 has its bytes. Empty: it is none.
std::optional<const Type*> check_data_address(Checking& c, Expression*& e);
/// `P#DB102.DBX124.0 WORD 2` of Siemens is an array of what stands there.
bool is_any_pointer(std::string_view address);
const Type* check_any_pointer(Checking& c, Expression*& e);
/// `block`, a data block, as an array of its bytes from 0 on. Null: it has parts without bytes,
/// which was told.
Expression* bytes_of_block(Checking& c, const Expression& like, Expression* block);
/// `table[i, 2]`, `text[3]`.
const Type* check_index(Checking& c, Expression*& e);
/// `word.%X3`, `word.%B1`, `word.3`.
const Type* check_bit(Checking& c, Expression*& e);
/// False for what may not be written, which was told, L0910; `how` it would be.
bool check_target(Checking& c, Expression& target, std::string_view how = "assigned");

// objects.cpp

/// A PROGRAM that CODESYS names as its one instance, no variable being called so: a global from
/// then on. Null: it is none.
Variable* declare_program(Checking& c, const Token& name);

/// The kind of block that an AXIS_REF refers to.
const Type* object_type(Checking& c, const Type& handle);
/// `VAR_GLOBAL Axis_1 : AXIS_REF`: the program has the block.
Variable* declare_object(Checking& c, Variable& variable);

/// `e`, a block of the program, becomes a variable that refers to it, which pointers and references
/// are to; anything else stays.
void take_place_of_object(Checking& c, Expression*& e);

/// What a test has of a kind that others refer to, such as an axis, is a block of its own.
void make_object(Checking& c, Variable& variable);

/// `e` means the block of the program that has its name.
const Type* use_object(Checking& c, Expression*& e, const Type& type);
/// What its kind or a library says of it in Structured Text.
Routine* find_part(Checking& c, const Type& type, std::string_view name);

/// `"Axis_1"` of SCL is global: a variable of the unit that is called so means nothing there.
bool hides_object(const Token& quoted, const Variable& found);
/// `"Axis_1".Position`, where nothing else is called so.
bool is_object_of(Checking& c, const Expression& member);

/// The function is called with what stands before the point.
const Type* check_part(Checking& c, Expression*& member, Routine& part);

}  // namespace lineshaft::st
