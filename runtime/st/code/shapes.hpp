#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/st/types/packed.hpp"

namespace lineshaft::st {

/// How a controller has a value in its memory, in bits, and how it is kept here, in slots: so that
/// a reference may be reckoned with in bytes, and bytes be read and written (`bytes.hpp`).
struct Shape {
    enum class Kind : std::uint8_t {
        whole,   ///< seen by no bytes: a reference, an instance
        scalar,  ///< has a `format`
        text,
        raw,  ///< its slots are the bytes: a UNION
        array,
        structure,
    };

    const Type* type = nullptr;
    Kind kind = Kind::whole;
    bool is_s7 = false;  ///< as SCL's dialect has it, not as Structured Text's
    PackedFormat format = {};
    std::optional<std::uint8_t> byte = {};  ///< of its slot, that a boolean of a standard block is
    std::uint64_t bits = 0, slots = 0;
    std::uint64_t stride = 0;   ///< of an array: bits from an element to the next one
    std::uint32_t element = 0;  ///< its elements' shape
    /// The members of a structure in Code::members; the variables of a block, which have slots.
    std::uint32_t first = 0;
    std::uint32_t count = 0;  ///< elements, members, variables
    std::uint32_t base = 0;   ///< of a block: that of its base plus 1; 0: it has none
};

struct ShapeMember {
    std::uint64_t bit = 0, slot = 0;
    std::uint32_t shape = 0;
};

inline constexpr std::uint32_t reference_slots = 3;

/// A variable that something refers to. A reference is three slots: the lasting address of the
/// variable, 0 of NULL; its ByteOfPiece; and the number of the call that has it, or 0.
struct Piece {
    std::string name;  ///< for messages: `Motor.table`
    std::uint32_t shape = 0;
    bool ends = false;             ///< with the call of its routine
    std::uint32_t routine = 0;     ///< by number
    std::uint32_t slot = 0;        ///< in the frame
    std::uint32_t activation = 0;  ///< slot in the frame with the number of the call
};

struct ByteOfPiece {
    std::uint32_t piece = 0;  ///< the number of the Piece plus 1; 0: there is none
    std::int32_t byte = 0;    ///< from the variable's first one

    constexpr std::uint64_t word() const {
        return std::uint64_t{piece} << 32 | static_cast<std::uint32_t>(byte);
    }
    static constexpr ByteOfPiece of(std::uint64_t word) {
        return {static_cast<std::uint32_t>(word >> 32), static_cast<std::int32_t>(word)};
    }
};

struct Code;

/// It is that shape, or that of a block which derives from it and begins as it does.
bool derives(const Code& code, std::uint32_t shape, std::uint32_t from);

/// The last member that begins at that bit of the structure, or before; null: none does.
const ShapeMember* member_at(const Code& code, const Shape& structure, std::uint64_t bit);

/// How many slots behind the first one of a value of that shape a value of the shape `wanted`
/// begins at that bit; empty: none begins there.
std::optional<std::uint64_t> slot_of(const Code& code, std::uint32_t shape, std::int64_t bit,
                                     std::uint32_t wanted);

/// The first byte of what begins so many slots behind the first one.
std::uint64_t byte_of(const Code& code, std::uint32_t shape, std::uint64_t slot);

}  // namespace lineshaft::st
