#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// Levels of calls that an instance has room for beyond those that are known.
constexpr std::uint32_t found_levels = 64;

/// Which routines what they call may call again, by an instance; and the levels of calls that
/// blocks have room for: those of a base and of what extends it are one.
void prepare_dispatch(Writing& w);

/// Where a parameter of a method stands behind its `Routine::first`, the same in all that replace
/// one another: what is given first, then its result and outputs, whatever its own block is like.
std::uint32_t slot_in_signature(Writing& w, const Routine& method, const Variable& parameter);
/// The parameters of a method as they begin, in that order.
const Writing::Image& signature_image(Writing& w, const Routine& method);

/// The number that all methods share which may be found where this one is called; or bodies.
std::uint32_t method_number(Writing& w, const Routine& called);

/// When all is laid out: what each kind of instance has for each number.
void finish_dispatch(Writing& w);

}  // namespace lineshaft::st
