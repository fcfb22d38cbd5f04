#pragma once

#include <string_view>

#include "runtime/model/catalog.hpp"
#include "runtime/source/diagnostic.hpp"
#include "runtime/st/syntax/tree.hpp"

namespace lineshaft::st {

/// How a file of B&R is read whose library was compiled elsewhere (`read_as` begins so): its `.fun`
/// declares functions and blocks without their bodies. In C the library is the project's own.
inline constexpr std::string_view of_binary_library = ".binary", of_library_in_c = ".ansic";

/// What is declared there is no variable that a source means by its name alone.
bool is_of_binary_library(const Token& name);

/// Leaves out what binary libraries declare and what is here: functions of the standard, kinds of
/// the catalogue but commands of axes, names of a library of the catalogue that is named as theirs.
/// So these are meant by their names. `status` of the other blocks is ERR_NOTIMPLEMENTED.
void leave_out_declared(Tree& tree, const Catalog& catalog);

/// A warning for each library with functions or blocks that the sources use and that have no body.
void warn_of_declared(const Tree& tree, Diagnostics& out);

}  // namespace lineshaft::st
