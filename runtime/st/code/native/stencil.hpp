#pragma once

#include <cstddef>
#include <cstdint>

namespace lineshaft::st {

/// What the symbols in the stencils stand for, by their names there: operands, eight times them
/// (slots), the tables that they number, the number of the instruction behind; the ways on.
// clang-format off
#define LINESHAFT_ST_HOLES(HOLE)                                                            \
    HOLE(a_bytes) HOLE(b_bytes) HOLE(c_bytes) HOLE(d_bytes)                                 \
    HOLE(a_number) HOLE(b_number) HOLE(c_number) HOLE(d_number) HOLE(c_upper)               \
    HOLE(c_table) HOLE(d_table) HOLE(place_behind)                                          \
    HOLE(next_instruction) HOLE(jump_target) HOLE(repeat_target) HOLE(called_routine)
// clang-format on

enum class Hole : std::uint8_t {
#define HOLE(name) name,
    LINESHAFT_ST_HOLES(HOLE)
#undef HOLE
        external,  ///< a function of the program, by its number
    constant,      ///< a place in `stencil_constants`
    own_cold,      ///< a place in the stencil's own code that is seldom executed
    own,           ///< a place in the rest
};

/// As the relocations of the object are (x86-64 psABI).
enum class Width : std::uint8_t { absolute_32, absolute_32_signed, absolute_64, relative_32 };

/// What may stand for a slot that an instruction of the processor reads: nothing else, a register
/// for words, one for reals.
enum class ReadAs : std::uint8_t { memory, word, real };

struct Filling {
    std::uint32_t at;  ///< in the stencil's code
    Hole hole;
    Width width;
    std::int32_t addend;
    std::uint32_t number;  ///< of an external; else a place
    ReadAs read_as;
    std::uint8_t before;  ///< bytes of the processor's instruction before it
};

/// A register of the processor: words have the numbers of its instructions, reals those behind.
inline constexpr std::uint8_t first_real = 16, no_register = 255;

/// Code of an instruction; behind what is executed as a rule stands the rest. Without code the
/// instruction has none.
struct Stencil {
    std::uint32_t code, size, cold_size;  ///< in `stencil_code`
    std::uint32_t fillings, count;        ///< in `stencil_fillings`
    std::uint8_t load, into;  ///< bytes of its beginning, if that loads a slot, into that register
    std::uint8_t result;  ///< the register that has what it wrote last, to `written`, at its end
    Hole written;
    std::uint8_t spoils;  ///< of the registers 8 to 15 of both kinds, a bit each
};

// What `write_table` writes.
extern const Stencil stencils[];  ///< by Op
extern const unsigned char stencil_code[];
extern const Filling stencil_fillings[];
extern const unsigned char stencil_constants[];
extern const std::size_t stencil_constants_size, stencil_externals_count;
extern const void* const stencil_externals[];
extern const char* const stencil_external_names[];

}  // namespace lineshaft::st
