#pragma once

#include "runtime/st/syntax/parsing.hpp"

/// What is written in other languages and dialects, and not in this one. What is refused is told,
/// and skipped or read all the same, whichever finds more of the other mistakes.
namespace lineshaft::st {

/// What is written here in other languages: what to write instead. Empty if nothing is known.
std::string habit(const Parsing& p);

/// `x ^ 2`, as some languages write a power.
bool at_power(const Parsing& p);

/// A word of what is not supported. It is not skipped.
bool refuse_unsupported(Parsing& p);

// Beside blocks and within them. False: it is none.

/// A chart where nothing stays, up to the end of the block.
void refuse_chart(Parsing& p);
/// `UNIT a; INTERFACE ... IMPLEMENTATION ...` of SIMOTION, up to the end of the file.
bool refuse_simotion(Parsing& p);
/// `<T : ANY_NUM>` behind a function's name, which is skipped.
void refuse_type_parameters(Parsing& p);
/// `PUBLIC METHOD m` becomes `METHOD PUBLIC m`, which is told.
void turn_modifiers(Tokens& tokens, Diagnostics& out);

// In declarations.

/// VAR_ACCESS. False: it is none.
bool skip_section(Parsing& p);
/// VAR_INST where nothing stays.
void refuse_static(Parsing& p, PouKind kind);
void refuse_shared_place(Parsing& p);
/// A statement stands where a declaration is due.
void refuse_statement(Parsing& p);
/// A word of the language stands where a name is due: whatever uses it would be wrong too.
void refuse_reserved_name(Parsing& p);
/// `USTRING[20]`, `INT[3]`
void refuse_length(Parsing& p, const Token& type);

// In statements and expressions.

/// `x = 1;` is meant as an assignment.
void refuse_comparison(Parsing& p);
/// The value in `RETURN n;`.
void refuse_returned(Parsing& p);
/// In a condition `x := 1` is meant as a comparison.
void refuse_assignment(Parsing& p);
/// `RUNG ... END_RUNG` of a network in LAD or FBD, an instruction list, a body that CoDeSys 2.3
/// exports as it is drawn. False: it is none.
bool refuse_other_language(Parsing& p);
/// A value that is no call, a label, JMP.
void refuse_value(Parsing& p, const Expression& value);
/// `t(IN := x; PT := y)`: takes the ';'. False: it is none.
bool refuse_semicolon(Parsing& p);

}  // namespace lineshaft::st
