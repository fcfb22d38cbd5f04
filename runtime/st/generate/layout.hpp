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

/// Gives places to the variables of a list of globals that have blocks in them, which are as large
/// as these are once all is written, or to those without.
void lay_out_members(Writing& w, const Type& list, bool with_blocks);

/// Puts in what is known when all is laid out.
void finish_late(Writing& w);

/// Variables that live for one call only come last, to be initialised in one go.
void lay_out(Writing& w, Routine& block);

/// Those of a variable in its frame.
std::uint32_t slots_in_frame(Writing& w, const Variable& variable);
/// It is given to a method, or else taken from it.
bool is_in_signature(const Routine& method, const Variable& variable, bool is_given);

/// What is given to a function or a method comes first. A method's frame is a part of its block's.
void lay_out_call(Writing& w, Routine& routine);
/// Before the first of a ring of routines is written, which call one another.
void lay_out_ring(Writing& w, int ring);

// images.cpp

/// Memory as it begins: from slot `at` of an image on what a variable, a type or a constant says.
void fill(Writing& w, Writing::Image& image, std::uint32_t at, const Variable& variable);
void fill(Writing& w, Writing::Image& image, std::uint32_t at, const Type& type,
          const Expression& value);
void fill_default(Writing& w, Writing::Image& image, std::uint32_t at, const Type& type);

/// Constants that assignments give to variables of one piece of memory: what stands behind BEGIN of
/// a data block, and what a CONFIGURATION says of a program.
void fill_assigned(Writing& w, Writing::Image& image, const Block& assignments);

/// All images that instructions use go into the code, once each.
void finish_images(Writing& w);

// instance_paths.cpp

/// What has `{attribute 'instance-path'}` says where its instance is, of a program or a list of
/// globals: `Project.MAIN.cell.valves[2]`, in CODESYS' own files `Device.Application.PLC_PRG.cell`.
void fill_paths(Writing& w);

// dispatch.cpp

/// Levels of calls that an instance has room for beyond those that are known.
constexpr std::uint32_t found_levels = 64;
/// And those for calls that recur.
constexpr std::uint32_t recurring_levels = 500;

/// The levels of calls that blocks have room for: those of a base and of what extends it are one.
void prepare_dispatch(Writing& w);

/// Where a parameter of a method stands behind its `Routine::first`, the same in all that replace
/// one another: what is given first, then its result, outputs and ENO, whatever its own block is
/// like.
std::uint32_t slot_in_signature(Writing& w, const Routine& method, const Variable& parameter);
/// The parameters of a method as they begin, in that order.
const Writing::Image& signature_image(Writing& w, const Routine& method);

/// The number that all methods share which may be found where this one is called; or bodies.
std::uint32_t method_number(Writing& w, const Routine& called);

/// A call within a ring of routines: what is called may run already.
bool may_meet_itself(const Writing& w, const Expression& call);

/// When all images are made: what runs calls that recur has room for them behind its frame.
void finish_recursion(Writing& w);

/// When all is laid out: what each kind of instance has for each number.
void finish_dispatch(Writing& w);

}  // namespace lineshaft::st
