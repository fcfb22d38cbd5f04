#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// The slot that has the value: `wanted` if something had to be computed, else where it is.
Slot value(Writing& w, const Expression& e, Slot wanted = none);
void value_to(Writing& w, const Expression& e, Slot to);

/// A value that stays what it is while `later` is computed: operands go from left to right.
Slot value_before(Writing& w, const Expression& e, const Expression& later);

/// The instruction that compares values of a type. There is none of `>` and `>=`: their operands
/// are exchanged.
Op comparison_op(Word relation, const Type& type);
constexpr bool is_exchanged(Word relation) {
    return relation == Word::greater || relation == Word::greater_or_equal;
}
/// Whether a relation of two values holds.
Slot compare(Writing& w, Word relation, const Type& type, Slot a, Slot b, Slot wanted = none);

/// The same of two texts, by their addresses.
Slot compare_texts(Writing& w, Word relation, Slot a, Slot b, Slot wanted = none);

/// The slot again; a number that is not of its type is a fault.
Slot within(Writing& w, const Type& type, Slot slot);

}  // namespace lineshaft::st
