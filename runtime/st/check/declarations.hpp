#pragma once

#include <functional>

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// Names of all types and routines; then the types.
void collect_names(Checking& c);

/// A variable in `to`, with its unit, which is checked.
Variable* add(Checking& c, std::deque<Variable>& to, const Declaration& declared, const Type* type);

/// What a block declares, in the order in which it is checked: each constant of B&R behind those
/// that it is made of.
std::vector<Declaration*> in_order(const DeclarationBlock& block);

/// A constant scalar takes no memory, unless others see it at its address.
void make_constant(Checking& c, Variable& variable);

/// The variable stands beside all blocks, where no source names it: VAR_STAT, and what the checker
/// adds.
void keep_once(Checking& c, Variable& variable);

/// `Motor(number := 3)` of a block, or of an array of such, which is written as an enumeration with
/// a base; null: it is one, or there are none.
const std::vector<Argument>* constructor_arguments(const TypeText* text, const Type* type);

/// Tells that a variable or member would be a block of the program, such as AXIS.
void refuse_object(Checking& c, const Declaration& declared, const Type* type);

/// Variables, results and constants of all routines, and which they are made of.
void declare_routines(Checking& c);

// own_instances.cpp

/// Whether a method declares an instance of its own block, or of one that has an instance of that
/// again, if in a method alone, for which an instance has no room. It stands beside all blocks, so
/// the method does not run within itself (Fault::runs_already). Of an interface's method: one that
/// has that interface, so that its own method is called alike.
bool is_its_own_block(Checking& c, const Routine& routine, const Type* type);
/// Such a variable becomes in each call what an instance is that nothing was done with.
void begin_anew(Checking& c, Routine& routine, Variable& variable);
/// Such an input refers to what it is given. Gives the copy that its name means in the method.
Variable& take_own_instance(Checking& c, Routine& routine, Variable& input);
/// Such a result refers to what the method has made.
void give_own_instance(Checking& c, Routine& routine, Variable& result);

// globals.cpp

/// VAR_GLOBAL and data blocks.
void declare_globals(Checking& c);
/// One that a type or another constant asks for, wherever it is declared; null when it asks for
/// itself, or over too many others.
Variable* declare_early(Checking& c, const Checking::GlobalConstant& constant);
/// `list.x`, as a variable of a list is named from anywhere.
std::string_view name_in_list(Checking& c, const DeclarationBlock& block,
                              const Declaration& declared);
/// A list of a library's project is seen as all that stands in its namespace.
Token name_of_global(Checking& c, const Declaration& declared);
/// `a` beside `A`, where capitals count.
bool differs_in_capitals(const Variable& known, const Token& name);
/// A PROGRAM of B&R has the name of its folder, which is none of its language.
bool is_folder(const Pou& pou);

/// A library's variable that its FUNCTION "name.Update" writes is written at the beginning of each
/// call that names it: the first notes it, the other puts the calls in front.
void note_update(Checking& c, const Variable& variable);
void bring_up_to_date(Checking& c, Routine& routine);

// initial_values.cpp

/// Checks those of all variables, and what stands behind BEGIN of data blocks.
void check_initial_values(Checking& c);
/// What the variable begins with; of `a, b : INT := 2 + 3` it is checked once for all.
void check_initial(Checking& c, Variable& variable);
/// A literal, a list or another constant for a variable of `type`. The pointer goes to what it is
/// then.
void check_initial(Checking& c, Expression*& value, const Type& type);

// members_by_others.cpp

/// What a member of a structure begins with may name members before it, where nothing else has that
/// name: `STRUCT b : Block; i : I_Block := b; END_STRUCT`. Notes those members.
void note_members_by_others(Checking& c, const Type& structure);
/// Whether `value` of such a member does so: all else in it is checked then.
bool begins_by_others(Checking& c, const Variable& member, Expression*& value);
/// That value where the structure is what `structure` makes a node of each time.
Expression* with_members(Checking& c, Expression* e, std::span<Variable* const> members,
                         const std::function<Expression*()>& structure);

// beginnings.cpp

/// What a variable begins with, where that is no constant: `p : POINTER TO INT := ADR(x);`. It is
/// assigned when the block or one of its methods runs first, of a call in each.
/// False: the variable begins with constants only.
bool begin_with(Checking& c, Expression*& value, const Type& type);

/// It is a block that has an FB_init, or has such in it.
bool is_constructed(const Checking& c, const Type* type);
/// Or has members that begin with what is no constant, before what its variable declares.
bool begins_by_itself(const Checking& c, const Type* type);
/// Or has a method that follows that.
bool is_followed(const Checking& c, const Type* type);
/// It is one with an FB_init of its own or its base, or an array of such.
bool has_constructor(const Checking& c, const Type* type);

/// Calls FB_init of the instances that the variable is or has in it, with what stands behind its
/// type, at the same time. What is declared behind that, `:= (x := 1)`, is assigned behind it.
void begin_instance(Checking& c, Variable& variable);
/// Assigns what members of its type begin with, `STRUCT p : POINTER TO INT := ADR(x); END_STRUCT`,
/// before what is declared of the variable itself.
void begin_members(Checking& c, Variable& variable);

/// Calls what stands behind `{attribute 'call_after_init'}` of these instances.
void follow_init(Checking& c, Variable& variable);

void refuse_constructor_arguments(Checking& c, Place place, const Type& type);

/// Calls FB_init of what is made in a run, at `part`, with `values`.
void construct_one(Checking& c, const Expression& like, Routine& routine, const Type& type,
                   const std::vector<Argument>* values, const std::function<Expression*()>& part,
                   Block& to);

/// What VAR_GLOBAL begins with so comes before the first block that runs, one that no other has an
/// instance of.
void begin_globals(Checking& c);

/// These assignments and calls: of a base first, and of its FB_init in one that stands for it.
Block beginnings(Checking& c, Routine& routine);

// beginnings_of_blocks.cpp

/// Behind the check of what its variables begin with: a block that begins with what runs gets a
/// method for that, which whoever has an instance of it calls before anything is read of it.
void begin_block(Checking& c, Routine& block);
/// That method of a block; null: it has none.
Routine* beginning_of(const Type& block);
/// A checked call that lets an instance begin, which is about to be copied; null: it has nothing to
/// begin with that runs.
Statement* begin_to_copy(Checking& c, const Expression& instance);

// axes_of_tests.cpp

/// Each AXIS_REF that a TEST, what it tests or a global keeps has a block of the program, which the
/// TEST begins with giving it.
void give_axes_to_tests(Checking& c);

// order.cpp

/// The routine runs, or is made of, what is in `type`.
void depend(Checking& c, const Type* type, Place place, bool through_reference = false);

/// Each behind all that it runs, in `Checked::order`; tells recursions.
void order_routines(Checking& c);
void warn_of_unused(Checking& c);

}  // namespace lineshaft::st
