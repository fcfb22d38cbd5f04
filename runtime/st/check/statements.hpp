#pragma once

#include <optional>

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// The routine's body, and what runs in front of it.
void check_body(Checking& c, Routine& routine);
/// A statement with all that is in it. What it stands for is hung in its place.
void check(Checking& c, Statement*& s);
/// `target := value;`; `+=` is one of a sum. L0910 for what may not be assigned.
void check_assignment(Checking& c, Statement*& s);

// axis_interfaces.cpp

/// `axis.PlcToNc.Override := 5;` of a checked target is written by the library's block for that,
/// FUNCTION_BLOCK PlcToNcWriter. False: it is another assignment.
bool rewrite_axis_interface(Checking& c, Statement*& s);

// action_calls.cpp

/// `Turn;` of an ACTION becomes its call; another name alone does nothing.
void check_action(Checking& c, Statement*& s);
/// `motor.Turn(speed := 5, done => stands);` of an ACTION gives the block's inputs and what its
/// VAR_IN_OUT refer to, runs it, and takes the block's outputs. False: it is another call.
bool runs_with_pins(Checking& c, Statement*& s);

// rewrites.cpp

/// A statement that means others, `y := f(EN := go)` or SCATTER, is checked as those, which are
/// hung in its place. False if it means itself, and is not checked.
bool rewrite(Checking& c, Statement*& s);

/// Refuses to copy what has a command of an axis. True: it was told.
bool refuse_copy_of_command(Checking& c, Place place, const Type& type);

/// `instance.ENO` of a variable of the routine at hand: what EN was in its last call that had one,
/// and at first TRUE. Null: it is no such variable.
Variable* enable_flag(Checking& c, const Expression& instance);

/// Siemens' ENO, a flag of each call that begins as TRUE: a caller may take it.
Variable& eno_of(Checking& c, Routine& routine);
/// All methods have it that may be found where it is asked for.
void share_eno(Checking& c);

// enable_outputs.cpp

/// What ENO of the statement's standard function is in Siemens' languages, before it is executed:
/// `mn <= mx` of LIMIT. Null: it cannot fail. Arguments that are calls are kept in `before`.
Expression* enable_output(Checking& c, const Statement& s, std::vector<Argument>& given,
                          Block& before);

/// What runs in front of its body: `go.R_EDGE(CLK := go);`.
Block edge_calls(Checking& c, Routine& routine);

/// `go` in a body is `go.R_EDGE.Q`.
const Type* use_edge(Checking& c, Expression*& e, Variable& input);

// block_moves.cpp

/// A LINT of the routine at hand that nobody can name.
Variable& counter(Checking& c, std::string_view name);

/// The least and the greatest index of an array of one dimension, also of an ARRAY[*]. Empty of
/// anything else.
struct Bounds {
    Expression *lower = nullptr, *upper = nullptr;
};
std::optional<Bounds> bounds_of_array(Checking& c, Expression* array);

/// How many elements there are from that one on, which is not checked yet; null: it is none of an
/// array of one dimension.
Expression* elements_from(Checking& c, const Expression& element);

/// Whether MOVE_BLK and its like stay within the arrays that they are given, which are not checked
/// yet; null: that is not known. `fills`: FILL_BLK, whose `in` is one value.
Expression* stays_within(Checking& c, const Expression& like, bool fills, Expression* in,
                         Expression* count, Expression* out);

/// What is given by that name; null: nothing.
Expression* argument_of(const Expression& call, std::string_view name);
/// MOVE_BLK, UMOVE_BLK, FILL_BLK and UFILL_BLK of Siemens as what they do with the elements of two
/// arrays, or to fill with the members of a structure. Where there are fewer elements than that
/// they do nothing. Its arguments are in their order.
void rewrite_block_move(Checking& c, Statement*& s);

// bit_blocks.cpp

/// SCATTER_BLK and GATHER_BLK of Siemens as an assignment for each bit of a word, in a loop.
void rewrite_bit_block(Checking& c, Statement*& s);
/// Whether it has all that it is asked for.
Expression* has_bit_block(Checking& c, const Expression& call);

// block_moves.cpp

/// DEMUX as an IF for each of its outputs.
void rewrite_demux(Checking& c, Statement*& s);

// byte_blocks.cpp

/// Serialize, BLKMOV and their like of the prelude with the bytes of a copy of what they are given.
/// False: it is another call.
bool rewrite_bytes(Checking& c, Statement*& s, const Routine& called);
/// Serialize and Deserialize of a VARIANT, and of what stands in an expression, which is given as
/// one.
bool take_as_variant(Checking& c, Expression*& e, const Routine& called);
/// What these do with a VARIANT, of each type that one is of.
void write_serializations(Checking& c);
/// False, and told: a call of one of them stands where it cannot be given them.
bool is_given_bytes(Checking& c, const Expression& call, const Routine& called);

// test_statements.cpp

/// A variable, a member or an element.
bool is_place(const Expression& e);
/// ASSERT_EQ and the others of TestCall, which is noted: their arguments, and that they stand in a
/// TEST, L0914. Null: they have no value.
const Type* check_test_statement(Checking& c, Expression& call, bool as_statement);

// assertions.cpp

// What others have for tests: SIMATIC AX in `AxUnit.Assert`, as `Equal(expected := 5, actual :=
// x)`, and who has TEST_PROGRAM, as `ASSERT_EQUAL(5, x)`, where what is expected comes first. Any
// build with tests knows them, in blocks too; no source declares them, since they take values of
// every type that ASSERT_EQ and the others take.

/// `AxUnit`, `AxUnit.Assert`
bool is_namespace_of_assertions(std::string_view path);

/// The call as one of ASSERT_EQ and the others; null if it is no such call.
Expression* assertion_call(Checking& c, const Expression& call);

// charts.cpp

/// A variable for each step of the charts that the routine and its actions have, with its X and T,
/// and what these keep from scan to scan. Tells steps that are not there, or there twice.
void declare_charts(Checking& c, Routine& routine);

/// What a scan of the chart of a routine, or of an action, does: its evolution, then its actions.
/// IEC 61131-3:2013, 6.7.6. That of an action stands still while the action is not called.
Block chart_statements(Checking& c, Routine& routine);

}  // namespace lineshaft::st
