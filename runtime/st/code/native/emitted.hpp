#pragma once

#include "runtime/st/code/meaning.hpp"
#include "runtime/st/code/native/self_test.hpp"

/// What stands before the routines that `emit` writes out, behind `meaning` and what that needs:
/// the program compiles it into itself as a text, and nowhere else. A routine is a function whose
/// instructions are macros, `OP_name(its number, a, b, c, d, to)`.
namespace lineshaft::st {

extern "C" {
double Sleef_cinz_logd1_u10purec(double);
double Sleef_cinz_log10d1_u10purec(double);
double Sleef_cinz_expd1_u10purec(double);
double Sleef_cinz_sind1_u10purec(double);
double Sleef_cinz_cosd1_u10purec(double);
double Sleef_cinz_tand1_u10purec(double);
double Sleef_cinz_asind1_u10purec(double);
double Sleef_cinz_acosd1_u10purec(double);
double Sleef_cinz_atand1_u10purec(double);
double Sleef_cinz_atan2d1_u10purec(double, double);
double Sleef_cinz_atanhd1_u10purec(double);
double Sleef_cinz_tanhd1_u10purec(double);
double Sleef_cinz_powd1_u10purec(double, double);
Fault native_end(std::byte*, meaning::Frames&, std::int64_t fuel, std::uint64_t behind, Fault);
void native_call_block(const Code&, std::byte*, std::uint32_t, const Scan&, const Context&);
}

struct Code {
    void call_block(std::byte* block, std::uint32_t number, const Scan& now,
                    const Context& context) const {
        native_call_block(*this, block, number, now, context);
    }
};

std::uint64_t byte_of(const Code&, std::uint32_t shape, std::uint64_t slot);

}  // namespace lineshaft::st

namespace lineshaft::st::meaning {

/// How a routine was left, and how many passes of loops and calls are.
struct Left {
    Fault fault;
    std::int64_t fuel;
};
constexpr Fault goes_on{-1};

/// An operand that is a constant of the routine: the compiler is to know what its slot has.
struct Known {
    std::uint32_t slot;
    std::uint64_t bits;
    constexpr operator std::uint32_t() const { return slot; }
};
constexpr std::uint64_t word(const std::byte*, const Known& constant) {
    return constant.bits;
}

#define STATE std::byte *base, Frames &frames, std::int64_t fuel
#define at(slot) (base + 8 * std::size_t{slot})
#define U(slot) word(base, slot)
#define I(slot) static_cast<std::int64_t>(U(slot))
#define R(slot) std::bit_cast<double>(U(slot))
#define put(slot, value) write(at(slot), value)
#define UPPER(operand) static_cast<std::uint32_t>(operand >> 32)
#define BEHIND behind
#define IMAGE(number) reinterpret_cast<const std::byte*>(images + number)
#define target(address) frames.place(address)
#define number_of(value, number) numbers[tables[number].place(value)]
#define within(value, number) tables[number].contains(value)
#define GO(label) goto label
#define CHOOSE(slot, number, ways) \
    switch (U(slot)) { ways }
// What is left is nothing that gcc knows of: else it keeps what was left before each pass, too.
#define AGAIN(label)                \
    {                               \
        --fuel;                     \
        asm("" : "+r"(fuel));       \
        if (fuel < 0) FAIL(no_end); \
        goto label;                 \
    }
#define FAIL(why)                                                \
    return {                                                     \
        native_end(base, frames, fuel, behind, Fault::why), fuel \
    }
#define ELEMENT(slot, number)                         \
    if (!within(U(slot), number)) FAIL(array_bounds); \
    const std::uint64_t element = tables[number].place(U(slot))
#define CALL(address, number)                                                        \
    {                                                                                \
        if (--fuel < 0) FAIL(no_end);                                                \
        frames.enter(address, behind);                                               \
        const Left left = routines[number](frames.place(frames.base), frames, fuel); \
        if (left.fault != goes_on) return left;                                      \
        fuel = left.fuel;                                                            \
        frames.leave();                                                              \
    }
#define LEAVE         \
    return {          \
        goes_on, fuel \
    }
#define code frames.code
#define SCAN(number)                                                    \
    static Fault scan_##number(STATE) {                                 \
        const Fault fault = routine_##number(base, frames, fuel).fault; \
        if (fault != goes_on) return fault;                             \
        set_word(base, error_slot, 0);                                  \
        set_word(base, error_id_slot, 0);                               \
        return Fault::none;                                             \
    }

/// What the program calls when it has loaded this. Null where the self-test says something else.
#define BEGIN                                                                            \
    extern "C" [[gnu::visibility("default")]] const void* native_begin(                  \
        const void* const* externals, const double* reals, const std::uint64_t* words) { \
        std::memcpy(native_externals, externals, sizeof native_externals);               \
        return self_test(reals, words) == self_test_result ? entries : nullptr;          \
    }

}  // namespace lineshaft::st::meaning
