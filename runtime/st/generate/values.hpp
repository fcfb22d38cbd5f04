#pragma once

#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// The slot that has the value: `wanted` if something had to be computed, else where it is.
Slot value(Writing& w, const Expression& e, Slot wanted = none);
void value_to(Writing& w, const Expression& e, Slot to);

/// Siemens' timers go on where Q or ET is read, too.
void update_timer(Writing& w, const Expression& read);

/// Whether a whole number is beyond what its type holds, as CODESYS' dialect reckons.
bool is_wide(const Writing& w, const Expression& e);
/// A value as it is reckoned: in 32 bits, of what is not kept in its type before.
Slot wide_value(Writing& w, const Expression& e);

/// The same of a number that is compared, or an index: SHL has the bits of its type there,
/// `SHL(year, 14) = 0`.
Slot looked_at(Writing& w, const Expression& e);
/// A relation that one instruction decides: not one of texts, of references or of instances.
bool compares_numbers(const Expression& e);
/// Both sides of such a one, and the type by which they are compared.
struct Sides {
    Slot left, right;
    const Type& type;
};
Sides sides_of(Writing& w, const Expression& e);

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

// conversions.cpp

/// Where the instance is that `?=` takes, or 0 if it is not of the type.
Slot attempted(Writing& w, const Expression& e, Slot wanted);

/// An expression that is a conversion.
Slot converted(Writing& w, const Expression& e, Slot wanted);

/// A number, a time or a boolean in `slot` as one of another type; a real one is rounded, or cut.
Slot convert(Writing& w, Slot slot, const Type& from, const Type& to, bool truncates, Slot wanted);

/// Whether a TIME of that block, or of none, is one in ns, of a timer, where all others are whole
/// ms.
bool is_finer_than_ms(const Type* block, const Type& type, const Place& place);
/// Such a TIME as the language there has it.
Slot whole_ms(Writing& w, Slot slot, const Place& place, Slot wanted = none);

// texts.cpp

/// A slot with the address of the value, which is a text.
Slot text_address(Writing& w, const Expression& e);

/// That of a copy, where `e` is a variable and `later` calls what may write it.
Slot text_before(Writing& w, const Expression& e, const Expression& later);

/// An empty text among the temporaries, and a slot with its address.
struct NewText {
    Slot text, address;
};
NewText new_text(Writing& w, bool is_wide = false);

// standard_functions.cpp

/// A text, an array or a structure is a slot with its address.
Slot standard(Writing& w, const Expression& e, Slot wanted);

// calls.cpp

/// It may be of a function, a method or a standard function.
Slot call(Writing& w, const Expression& e, Slot wanted);

/// The frame that has the result and the outputs. A call whose arguments call functions themselves
/// has them first, for they use the same memory; where the places of outputs do, what the function
/// has made is kept from them.
Location call_routine(Writing& w, const Expression& e);
void call_instance(Writing& w, const Expression& e);

}  // namespace lineshaft::st
