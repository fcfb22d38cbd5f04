#pragma once

#include "runtime/st/syntax/lexer.hpp"
#include "runtime/st/syntax/tree.hpp"

namespace lineshaft::st {

/// Adds what stands in a source to `tree`. After a mistake it goes on at the next `;` or `END_...`,
/// so that all of a file is told at once; a declaration with a mistake is lost:
///   L0902  what is expected, and stands there instead; a block that does not end
///   L0903  a part of the language that is not supported
///   L0912  nested too deep
/// Where a source is no file of tests, TEST, SETUP and TEARDOWN are refused.
void parse(Tokens tokens, Tree& tree, Diagnostics& out);

/// The name that a list of VAR_GLOBAL has, which its file gives it, or what it is in a project.
std::string_view name_of_list(const Source& source);

/// B&R declares the functions and blocks of a library in a file of its own, `.fun`, and writes
/// their bodies elsewhere, without variables: both are one unit. A declaration that has no body
/// anywhere stays as it is.
void join_declared_apart(Tree& tree);

/// An ACTION of B&R in a file without a block is of the one FUNCTION_BLOCK in its folder that runs
/// it, in its body or in an action that it was given so.
void give_actions_to_blocks(Tree& tree);

/// B&R's types of one file whose names differ in capitals alone are several: the later ones get
/// names of their own, wherever these stand so.
void tell_types_by_capitals(Tree& tree);

/// Reads each block with VAR_GENERIC again for each `Stack<10>`, as a block of that name. Values
/// are literals, constants and constants of a generic block around; one whose constants have no
/// values of their own is left out.
void expand_generics(Tree& tree);

}  // namespace lineshaft::st
