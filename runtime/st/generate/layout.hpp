#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// The slots that a value of the type takes; lays it out. Of a block only after it is laid out,
/// with all its methods. L0912: more memory than a block may have.
std::uint32_t slots_of(Writing& w, const Type& type);

/// The slot of a variable before it is laid out.
inline constexpr std::uint32_t unplaced = 0xFFFF'FFFF;

/// Before all: what is in blocks is unplaced.
void forget_places(Writing& w);

/// A block is in it, of which a body or a method is not written yet: so its size is not known.
bool is_growing(const Writing& w, const Type& type);

/// Of a list of globals the variables with blocks in them, which are as large as these are once
/// all is written, or those without.
void lay_out_members(Writing& w, const Type& list, bool with_blocks);

/// Puts in what is known when all is laid out.
void finish_late(Writing& w);

/// Variables that live for one call only come last, to be initialised in one go.
void lay_out(Writing& w, Routine& block);

/// Those of a variable in its frame.
std::uint32_t slots_in_frame(Writing& w, const Variable& variable);
/// It is given to a method, or else taken from it.
bool is_in_signature(const Variable& variable, bool is_given);

/// What is given to a function or a method comes first. A method's frame is a part of its block's.
void lay_out_call(Writing& w, Routine& routine);

}  // namespace lineshaft::st
