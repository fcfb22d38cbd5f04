#pragma once

#include "runtime/st/check/checking.hpp"

/// Siemens' VARIANT: prelude/variants.st has what it is inside.
namespace lineshaft::st {

bool is_variant(const Type& type);

/// `value`, a variable of any type, or NULL, becomes what a parameter that is a VARIANT has inside.
/// What came by such a one is passed on.
void become_variant(Checking& c, Expression*& value, const Type& type);

/// TypeOf, TypeOfElements, IS_ARRAY, and CountOfElements of a VARIANT: what stands for the call.
/// Empty: it is none of them.
std::optional<const Type*> check_variant_call(Checking& c, Expression*& e);

/// What TypeOf is compared with, or a CASE of it has as labels, may be the name of a type.
void take_type_names(Checking& c, Expression& comparison);
void take_type_names(Checking& c, Statement& selection);

/// `v = NULL` and `v <> NULL` of a VARIANT become comparisons of numbers.
void take_null_variant(Checking& c, Expression& comparison);

}  // namespace lineshaft::st
