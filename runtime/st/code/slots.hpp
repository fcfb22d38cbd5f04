#pragma once

#include <compare>
#include <cstdint>

#include "runtime/model/scan.hpp"
#include "runtime/st/code/op_class.hpp"

namespace lineshaft::st {

/// What is found by a value that is one of `count` from `lower` on: the place of an element in an
/// array, or in `Code::numbers` of an enumeration's number or a CASE's jump.
struct IndexTable {
    std::int64_t lower = 0;
    std::uint64_t count = 0, stride = 1, first = 0;

    bool contains(std::uint64_t value) const {
        return value - static_cast<std::uint64_t>(lower) < count;
    }
    std::uint64_t place(std::uint64_t value) const {
        return first + (value - static_cast<std::uint64_t>(lower)) * stride;
    }
    auto operator<=>(const IndexTable&) const = default;
};

/// An instance begins with these slots. Then come the numbers of the data blocks among the
/// program's instances, where there are references the Piece that one of them left (plus 1, or 0),
/// its kind where calls find routines by it, two slots for each call that runs (where it goes on,
/// and on which frame), and its variables. A block that extends another begins with all of its
/// frame.
enum HeaderSlot : std::uint32_t {
    error_slot,     ///< BOOL: the last scan ended with a fault
    error_id_slot,  ///< Fault
    place_slot,     ///< the instruction it ended with, below the instance of its frame
    depth_slot,     ///< calls that ran then, below the slot of its frame
    time_slot,      ///< what its instructions took [ns], if they are counted
    cut_slot,       ///< 1 + the first instruction that cut a text short, or 0
    counts_slot,    ///< executed instructions of each class, if they are counted
    globals_slot = counts_slot + op_classes,
};

/// Where something stands: a slot of an instance of the program, or of the one that is scanned.
struct Address {
    std::uint64_t space = 0;  ///< the number of the instance plus 1; 0: of the one that is scanned
    std::uint64_t slot = 0;

    constexpr bool is_of_program() const { return space != 0; }
    constexpr std::int64_t instance() const { return static_cast<std::int64_t>(space) - 1; }
    constexpr std::uint64_t word() const { return space << 32 | slot; }

    static constexpr Address of(std::uint64_t word) { return {word >> 32, word & 0xFFFF'FFFF}; }
    static constexpr Address in(std::uint64_t instance, std::uint64_t slot = 0) {
        return {instance + 1, slot};
    }
};

/// Where an address leads, in a scan of the instance at `root`.
template <class Byte>
Byte* place_of(std::uint64_t address, Byte* root, const Context& context) {
    const Address at = Address::of(address);
    return (at.is_of_program() ? context.instances[at.instance()] : root) + 8 * at.slot;
}

/// Where a scan ended with a fault.
struct EndOfScan {
    std::uint32_t instruction = 0;
    std::uint32_t depth = 0;  ///< calls that ran
    std::uint64_t frame = 0;  ///< its address

    /// What the two words say.
    static EndOfScan of(std::uint64_t place, std::uint64_t calls) {
        return {static_cast<std::uint32_t>(place), static_cast<std::uint32_t>(calls),
                place >> 32 << 32 | calls >> 32};
    }
    std::uint64_t place_word() const { return frame >> 32 << 32 | instruction; }
    std::uint64_t depth_word() const { return frame << 32 | depth; }
};

}  // namespace lineshaft::st
