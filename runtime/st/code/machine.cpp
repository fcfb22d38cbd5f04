#include "runtime/st/code/machine.hpp"

#include <numeric>

#include "runtime/st/code/meaning.hpp"
#include "runtime/st/code/native/native.hpp"

namespace lineshaft::st {

namespace {

using namespace meaning;

template <bool counts>
Fault run(Frames& frames, const CodeRoutine& routine) {
    const Code& code = frames.code;
    const Instruction* const first = code.instructions.data();
    const Instruction* pc = first + routine.entry;
    std::byte* base = frames.root;
    std::int64_t fuel = frames.fuel;
    Fault fault = Fault::none;

// Macros, because gcc keeps what a function object refers to in memory.
#define at(slot) (base + 8 * std::size_t{slot})
#define U(slot) word(base, slot)
#define I(slot) static_cast<std::int64_t>(U(slot))
#define R(slot) std::bit_cast<double>(U(slot))
#define put(slot, value) write(at(slot), value)
#define target(address) frames.place(address)
#define table(number) code.tables.data()[number]
#define number_of(value, number) code.numbers.data()[table(number).place(value)]
#define within(value, number) table(number).contains(value)
// The empty statement keeps a jump that is not taken off the way to the next instruction.
#define UPPER_C static_cast<std::uint32_t>(to >> 32)
#define GO(address)                                                                      \
    {                                                                                    \
        pc = reinterpret_cast<const Instruction*>(static_cast<std::uintptr_t>(address)); \
        asm volatile("" : "+r"(pc));                                                     \
    }
#define AGAIN(address)                \
    {                                 \
        if (--fuel < 0) FAIL(no_end); \
        GO(address);                  \
    }
#define FAIL(why)           \
    {                       \
        fault = Fault::why; \
        goto ended;         \
    }
#define ELEMENT(slot, number)                         \
    if (!within(U(slot), number)) FAIL(array_bounds); \
    const std::uint64_t element = table(number).place(U(slot))
#define CALL(address, number)                                          \
    {                                                                  \
        if (--fuel < 0) FAIL(no_end);                                  \
        frames.enter(address, static_cast<std::uint64_t>(pc - first)); \
        base = frames.place(frames.base);                              \
        pc = first + code.routines.data()[number].entry;               \
    }
#define LEAVE                                        \
    {                                                \
        if (frames.top == frames.bottom) FAIL(none); \
        pc = first + frames.leave();                 \
        base = frames.place(frames.base);            \
    }
    // A jump from each instruction to the next one's place: the processor foresees them one by one.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#define OP(name, class, operands, ...) &&at_##name,
    static const void* const places[] = {LINESHAFT_ST_OPCODES(OP)};
#undef OP
#define NEXT goto* places[static_cast<std::size_t>(pc->op)]
    NEXT;
#define OP(name, class, operands, ...)                                                    \
    at_##name : {                                                                         \
        [[maybe_unused]] const std::uint64_t to = pc->c;                                  \
        [[maybe_unused]] const std::uint32_t a = pc->a, b = pc->b, d = pc->d,             \
                                             c = static_cast<std::uint32_t>(to);          \
        ++pc;                                                                             \
        if constexpr (counts) ++frames.counted[static_cast<std::size_t>(OpClass::class)]; \
        __VA_ARGS__;                                                                      \
        NEXT;                                                                             \
    }
    LINESHAFT_ST_OPCODES(OP)
#undef OP
#pragma GCC diagnostic pop
ended:
    return frames.end(fault, static_cast<std::uint64_t>(pc - 1 - first));
}

}  // namespace

Fault execute(const Code& code, const CodeRoutine& routine, std::byte* instance, Scan& now,
              const Context& context, std::int64_t fuel, const std::int64_t* times) {
    Frames frames{code, now, context, fuel, instance, routine.levels};
    if (!times && code.native)
        return code.native->entry(routine.entry)(instance, frames, frames.fuel);
    if (!times) return run<false>(frames, routine);
    std::uint64_t counted[op_classes + 1] = {};
    frames.counted = counted;
    const Fault fault = run<true>(frames, routine);
    std::memcpy(instance + 8 * counts_slot, counted, 8 * op_classes);
    const Wide taken = std::inner_product(times, times + op_classes, counted, Wide{0});
    set_word(instance, time_slot, static_cast<std::uint64_t>(std::min<Wide>(taken, never)));
    return fault;
}

}  // namespace lineshaft::st
