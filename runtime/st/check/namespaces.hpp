#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// Which namespaces there are, and what each scope sees of them. A USING of another is told.
void collect_namespaces(Checking& c);

/// What is declared as `T` in the namespace `a.b` is `a.b.T`.
Token name_with_namespace(Checking& c, Token declared);

/// `a.b.x` as one name where `a` is no variable, and `a.b.x` is declared in a namespace, stands in
/// a list of globals or is of a library. Nothing: the points take parts.
std::optional<Token> qualified_name(Checking& c, const Expression& member);

/// `list.p` of a PROPERTY that a list of globals has becomes that of the list's block of them.
void name_block_of_list(Checking& c, Expression& member);

/// Whether `e` means what is called so in full, `a.b.x`, though no source declares that.
bool is_full_name(Checking& c, const Expression& e, std::string_view full);

/// `Otg` of `Planner.Otg` in a project of another tool, which has another project as a library: its
/// name is nowhere in the sources. So is `Other.x` of `Library.Other.x`, which CODESYS' libraries
/// give on. Nothing in other sources, where the first is declared, or where the second is no type,
/// block or function.
std::optional<Token> without_project(Checking& c, Token name);

/// Tells that a namespace is unknown, or has no such name, unless that was told.
void refuse_qualified(Checking& c, const Token& name);
/// The same, where what is before the last point of a member is a namespace. False: it is none.
bool refuse_member_of_namespace(Checking& c, const Expression& member);
/// `Limits.typo` of a list of globals that has none of that name, which was told. False: it is no
/// list.
bool refuse_of_list(Checking& c, const Expression& member);

/// What stands there may be of a namespace that is unknown.
bool may_be_elsewhere(Checking& c, Place place);
/// Tells of a USING whose namespace is not there, and of which nothing is named.
void warn_of_usings(Checking& c);

}  // namespace lineshaft::st
