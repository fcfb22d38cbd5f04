#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/debug/frames.hpp"
#include "runtime/run/link.hpp"

namespace lineshaft::debug {

struct Seat;

/// A value as it is shown, or a group of them. What is in it is made when somebody asks.
struct Shown {
    std::string name, value, type = {};
    std::string signal = {};                ///< as a program names it, where `at` does not tell
    std::string expression = {};            ///< what a watch names it by in its frame
    std::size_t elements = 0;               ///< of an array
    const std::byte* at = nullptr;          ///< where it stands; null: nowhere
    std::size_t bytes = 0;                  ///< there
    std::shared_ptr<const Seat> seat = {};  ///< of a value of Structured Text in memory
    /// So many from the one numbered `first` on, of an array; of all else all.
    std::function<std::vector<Shown>(std::size_t first, std::size_t count)> inside = {};

    bool is_group() const { return value.empty() && type.empty(); }
};
using List = std::vector<Shown>;

/// Where a value is packed, a member of a UNION.
struct PackedPlace {
    std::byte* bytes = nullptr;
    std::uint64_t bit = 0;
    const st::Type* type = nullptr;
    const st::Dialect* dialect = nullptr;
};

/// A value of Structured Text in memory, and how what it refers to is found.
struct Seat {
    const st::Type* type = nullptr;
    std::byte* at = nullptr;
    const Frame* frame = nullptr;
    std::shared_ptr<const void> copy = {};      ///< of other memory, in which `at` is; else none
    std::shared_ptr<const st::Type> made = {};  ///< of what no source has: ARRAY[*] as it is given
    PackedPlace packed = {};                    ///< of what `copy` has of a UNION; else none
    std::size_t behind = 0;                     ///< bytes of the copy before `at`

    /// A part of it, so many bytes behind its begin.
    Seat part(const st::Type* of, std::size_t bytes) const {
        return {of, at + bytes, frame, copy, made, packed, behind + bytes};
    }
};

Shown show(std::string name, const Seat& seat, const std::string& unit = {});

/// A member of a structure, a UNION or a block; `at` null: nowhere.
Seat member_at(const Seat& whole, const st::Variable& member);

/// What is so many bytes behind what a reference is to, as the machine reaches it; `at` null:
/// nothing, or NULL.
Seat target_of(const Seat& reference, std::int64_t bytes = 0);

/// As a literal of that type.
std::string text_shown(const st::Type& type, std::string_view text);

/// The block of the program that an AXIS_REF is to, as its scan sees it; `at` null: to none.
struct Referred {
    const BlockPlace* block = nullptr;
    const std::byte* at = nullptr;
};
Referred block_of(const std::byte* handle, const Frame& frame);

/// What is in it, as a watch reaches it: a group has no name in the language.
std::vector<Shown> parts_of(const Shown& whole, std::size_t first, std::size_t count);

/// The signal that has its value there; empty: none has.
std::string signal_of(const Linked& linked, const Shown& shown);

/// Where a list of global variables or a data block is, by its number.
std::byte* global_at(int global, const Frame& frame);

/// Where a variable of a routine's frame is; `at` null: nowhere.
Seat seat_of(const st::Variable& variable, std::byte* base, const Frame& frame);

/// What a routine that runs sees: its variables by direction. The frame outlives what is shown.
std::vector<Shown> scopes_of(const Frame& frame);

/// What a program's file has: the blocks of a task, each with its fields by direction and where its
/// inputs come from; inputs of the program, and what is forced.
Shown show_blocks(const Linked& linked, int task);
/// As others see its value, where its own block has it.
Shown show_signal(const Machine& machine, const Signal& signal);
Shown show_inputs(const Linked& linked);
Shown show_forces(const Linked& linked, std::int64_t now);

}  // namespace lineshaft::debug
