#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// Finds what blocks and interfaces EXTEND and IMPLEMENT, and which methods replace which; what is
/// not replaced is inherited. Before variables are declared. L0904, L0911.
void resolve_bases(Checking& c);
/// Behind resolve_bases() and before the own variables: those of the base are the block's.
void inherit_variables(Routine& block);
/// When all is declared: what a block owes to its bases and interfaces is there, and as they say.
void check_classes(Checking& c);

/// Tells where the type is that of a block without instances.
void refuse_abstract(Checking& c, const Type* type, Place place);

/// The block that the routine at hand is, or is of; null: it is none, as in a TEST.
const Routine* own_block(const Checking& c);

/// THIS or SUPER; null: it is none. `e` means the instance then.
bool is_own_instance(Checking& c, const Expression& e);
const Type* check_own_instance(Checking& c, Expression*& e);

/// Tells, and is false, where the routine at hand may not name what has that access.
bool is_accessible(Checking& c, Access access, const Routine& owner, const Token& name);

/// The method that `receiver` calls; notes in the call how it is found.
const Type* check_method_call(Checking& c, Expression*& call, Routine& method,
                              const Expression& receiver, bool as_statement);
/// Whether what `receiver` refers to may be of a block that derives from that of its type.
bool may_be_derived(const Expression& receiver);
/// Whether a call is one of an instance, or of a part of it, that a reference is to.
bool is_through_reference(const Expression& call);

/// `instance.Property`, with the instance, or of the own block with null; null: there is none of
/// that name.
Routine* find_accessor(Checking& c, const Expression& e, Accessor accessor);
/// What a PROPERTY that is read gives.
const Type* check_getter(Checking& c, Expression*& e, Routine& getter);
/// `x.Property := value;` is a call. False: the target is no PROPERTY.
bool rewrite_property(Checking& c, Statement*& s);

}  // namespace lineshaft::st
