/// Each instruction's line as a function of its own, which is compiled alone, never linked:
/// `write_table` takes the code of each from the object. What stands in for an operand is the
/// address of a symbol that is nowhere defined; its relocation is the hole that is filled when a
/// library is loaded. Every way out of a function is a tail call; the one to the next instruction
/// is expected, so that it comes last.

#include <sleef.h>

#include "runtime/st/code/meaning.hpp"
#include "runtime/st/code/native/native.hpp"

namespace lineshaft::st::meaning {

namespace {

/// The symbols of an operand: eight times it, for a slot, and it.
#define SYMBOLS(operand) extern "C" const char operand##_bytes[], operand##_number[];
SYMBOLS(a)
SYMBOLS(b)
SYMBOLS(c)
SYMBOLS(d)
#undef SYMBOLS
extern "C" const char c_upper[], c_table[], d_table[], place_behind[];

/// The compiler knows of an address that it is none of the others and not 0, which a number may be.
#define NUMBER(symbol)                                  \
    [] {                                                \
        std::uint32_t value = 0;                        \
        asm("movl %1, %0" : "=r"(value) : "i"(symbol)); \
        return value;                                   \
    }()
#define TABLE(symbol)                                      \
    [] {                                                   \
        const IndexTable* value = nullptr;                 \
        asm("movabsq %1, %0" : "=r"(value) : "i"(symbol)); \
        return value;                                      \
    }()

struct Operand {
    std::uint32_t number;
    std::uint64_t bytes;
    const IndexTable* table;

    operator std::uint32_t() const { return number; }
    template <std::integral T>
    Operand operator+(T more) const {
        const auto n = static_cast<std::uint32_t>(more);
        return {number + n, bytes + 8 * n, table};
    }
};

/// Where a jump of a constant address goes.
struct Way {};

std::byte* slot_at(std::byte* base, const Operand& slot) {
    return base + slot.bytes;
}

std::uint64_t word(const std::byte* base, const Operand& slot) {
    return read<std::uint64_t>(base + slot.bytes);
}

/// Slots may be the same, which the compiler does not see in their symbols.
template <class T>
void put_at(std::byte* place, T value) {
    asm volatile("" ::: "memory");
    write(place, value);
    asm volatile("" ::: "memory");
}

#define STENCIL Fault
#define STATE std::byte *base, Frames &frames, std::int64_t fuel
#ifdef __clang__
#define MUST_JUMP [[clang::musttail]]
#else
#define MUST_JUMP
#endif
#define WAY(name) extern "C" [[gnu::cold]] STENCIL name(STATE);
extern "C" STENCIL next_instruction(STATE);
extern "C" STENCIL repeat_target(STATE);
WAY(jump_target)
WAY(called_routine)
#undef WAY

#define WAY_OF [[gnu::always_inline]] inline STENCIL
WAY_OF go(const Way&, STATE) {
    return jump_target(base, frames, fuel);
}
WAY_OF go(std::int64_t address, STATE) {
    const std::uint64_t distance = static_cast<std::uint64_t>(address) -
                                   reinterpret_cast<std::uint64_t>(frames.code.instructions.data());
    return frames.code.native->entry(distance / sizeof(Instruction))(base, frames, fuel);
}
WAY_OF call(const Operand&, STATE) {
    return called_routine(base, frames, fuel);
}
[[maybe_unused]] WAY_OF call(std::uint64_t routine, STATE) {
    return frames.code.native->entry(frames.code.routines.data()[routine].entry)(base, frames,
                                                                                 fuel);
}

}  // namespace

#define at(slot) slot_at(base, slot)
#define U(slot) word(base, slot)
#define I(slot) static_cast<std::int64_t>(U(slot))
#define R(slot) std::bit_cast<double>(U(slot))
#define put(slot, value) put_at(at(slot), value)
#define UPPER(way) NUMBER(c_upper)
#define BEHIND NUMBER(place_behind)
#define IMAGE(operand) \
    reinterpret_cast<const std::byte*>(code.images.data() + std::uint32_t{operand})
#define target(address) frames.place(address)
#define table(operand) (*operand.table)
#define number_of(value, operand) code.numbers.data()[table(operand).place(value)]
#define within(value, operand) table(operand).contains(value)
#define GO(way) return go(way, base, frames, fuel)
#define CHOOSE(slot, number, ways) GO(number_of(U(slot), number))
#define AGAIN(way)                                \
    {                                             \
        if (--fuel < 0) FAIL(no_end);             \
        return repeat_target(base, frames, fuel); \
    }
#define FAIL(why) return native_end(base, frames, fuel, BEHIND, Fault::why)
#define ELEMENT(slot, number)                         \
    if (!within(U(slot), number)) FAIL(array_bounds); \
    const std::uint64_t element = table(number).place(U(slot))
#define CALL(address, routine)                    \
    {                                             \
        if (--fuel < 0) FAIL(no_end);             \
        frames.enter(address, BEHIND);            \
        base = frames.place(frames.base);         \
        return call(routine, base, frames, fuel); \
    }
#define LEAVE                                                  \
    {                                                          \
        if (frames.top == frames.bottom) [[likely]] {          \
            set_word(base, error_slot, 0);                     \
            set_word(base, error_id_slot, 0);                  \
            return Fault::none;                                \
        }                                                      \
        const std::uint64_t behind = frames.leave();           \
        base = frames.place(frames.base);                      \
        return code.native->entry(behind)(base, frames, fuel); \
    }
#define OP(name, class, operands, ...)                                                       \
    extern "C" [[gnu::flatten]] STENCIL stencil_##name(STATE) {                              \
        [[maybe_unused]] const Code& code = frames.code;                                     \
        [[maybe_unused]] const Way to;                                                       \
        [[maybe_unused]] const Operand a{NUMBER(a_number),                                   \
                                         reinterpret_cast<std::uint64_t>(a_bytes), nullptr}, \
            b{NUMBER(b_number), reinterpret_cast<std::uint64_t>(b_bytes), nullptr},          \
            c{NUMBER(c_number), reinterpret_cast<std::uint64_t>(c_bytes), TABLE(c_table)},   \
            d{NUMBER(d_number), reinterpret_cast<std::uint64_t>(d_bytes), TABLE(d_table)};   \
        __VA_ARGS__;                                                                         \
        MUST_JUMP return next_instruction(base, frames, fuel);                               \
    }
LINESHAFT_ST_OPCODES(OP)

}  // namespace lineshaft::st::meaning
