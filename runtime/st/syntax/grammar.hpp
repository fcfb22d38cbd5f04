#pragma once

#include "runtime/st/syntax/mistakes.hpp"
#include "runtime/st/syntax/recovery.hpp"

/// The rules of the grammar that others use, each read by a function that its rule stands above, in
/// parse_*.cpp. A rule is written as in IEC 61131-3:2013, Annex A, and has its name there where it
/// has one: 'IF' is a word or a sign, `?` at most once, `*` any number of times, `+` once or more,
/// `|` one of both. Name, Quoted_Name, Unsigned_Int, Real, Text, Direct, Duration, Type_Prefix and
/// Any_Token are tokens. A sentence below a rule narrows it. What a function reads beside its rule
/// is a mistake that it tells (recovery.hpp, mistakes.hpp); it gives a node back all the same.
namespace lineshaft::st {

// parse_namespaces.cpp
void parse_namespace_element(Parsing& p);
void parse_using(Parsing& p);
/// From `begin` on to the end of the unit that is read; at its outermost to that of the source.
void open_scope(Parsing& p, std::uint32_t begin, std::string_view path);
/// `a.b.c` as one name.
Token parse_qualified_name(Parsing& p, std::string_view what);
/// `.g` of CODESYS.
bool at_name_behind_point(const Parsing& p);

// parse_program_units.cpp
void parse_declaration(Parsing& p);
Pou* parse_pou(Parsing& p);
void parse_attributes(Parsing& p);
/// The type behind ':', and what the result begins with.
void parse_result(Parsing& p, Pou& pou);
/// `said`: where to note it.
bool accept_access(Parsing& p, Access* said = nullptr);

// parse_configurations.cpp
void parse_configuration(Parsing& p);
bool at_var_config(const Parsing& p);
/// `resource`: it stands in this RESOURCE; empty: in none.
void parse_var_config(Parsing& p, std::string_view resource = {});

// parse_bare_program.cpp
/// Statements stand here, or behind the variables that do, with no PROGRAM around them: before all
/// units of the source, and behind nothing that is wrong.
bool at_bare_program(Parsing& p);
void parse_bare_program(Parsing& p);

// parse_classes.cpp
void parse_pou_modifiers(Parsing& p, Pou& pou);
/// EXTENDS and IMPLEMENTS.
void parse_bases(Parsing& p, Pou& pou);
/// Its GET and SET become methods.
void parse_property(Parsing& p, std::vector<Pou*>& to, PouKind of);
/// A METHOD or PROPERTY behind the END of its block.
void parse_late_method(Parsing& p);

// parse_generics.cpp
/// None, or those that a block begins with.
void parse_generic_constants(Parsing& p, Pou& pou);
/// That the block is to be read again, whose first token is `first`.
void keep_generic(Parsing& p, const Pou& pou, std::size_t first);
/// None, or those behind the name of a block, which become a part of it.
void parse_generic_values(Parsing& p, Token& name);

// parse_charts.cpp
void parse_chart_element(Parsing& p, Pou& pou);

// parse_tests.cpp
void parse_test(Parsing& p);
void parse_test_statement(Parsing& p, Block& to);

// parse_declarations.cpp
void parse_sections(Parsing& p, Pou& pou, Word end);
DeclarationBlock parse_section(Parsing& p, Section section);
bool accept_retention(Parsing& p, Retention& retention);
void parse_variables(Parsing& p, std::vector<Declaration*>& to);

// parse_types.cpp
void parse_type_declarations(Parsing& p);
TypeText* parse_type(Parsing& p);

// parse_statements.cpp
/// Up to `end`, or what ends a block around it; in a CASE also up to its next values.
void parse_statements(Parsing& p, Block& to, Word end, bool in_case = false);

// parse_expressions.cpp
Expression* parse_expression(Parsing& p);
Expression* parse_assigned(Parsing& p);
Expression* parse_access(Parsing& p);

// parse_initial_values.cpp
Expression* parse_initial(Parsing& p);
Expression* parse_initials(Parsing& p);
/// Up to and with `end`; values are initial ones, or expressions.
void parse_arguments(Parsing& p, Expression& to, Word end, Expression* (*parse_value)(Parsing&));

}  // namespace lineshaft::st
