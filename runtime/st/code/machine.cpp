#include "runtime/st/code/machine.hpp"

#include <numeric>
#include <utility>

#include <sleef.h>

#include "runtime/st/code/meaning.hpp"
#include "runtime/st/code/native/native.hpp"
#include "runtime/st/syntax/constant.hpp"

namespace lineshaft::st {

namespace {

using namespace meaning;

/// `IF a < b THEN x := y; END_IF` as one instruction: whether the condition holds.
bool is_met(const Instruction& in, const std::byte* base) {
    const std::uint64_t a = word(base, in.a), b = word(base, in.b);
    const auto signed_a = static_cast<std::int64_t>(a), signed_b = static_cast<std::int64_t>(b);
    const auto real_a = std::bit_cast<double>(a), real_b = std::bit_cast<double>(b);
    switch (in.op) {
        case Op::move_if_lt_signed:
            return signed_a < signed_b;
        case Op::move_if_le_signed:
            return signed_a <= signed_b;
        case Op::move_if_lt_unsigned:
            return a < b;
        case Op::move_if_le_unsigned:
            return a <= b;
        case Op::move_if_lt_float:
            return real_a < real_b;
        case Op::move_if_le_float:
            return real_a <= real_b;
        case Op::move_if_eq_word:
            return a == b;
        case Op::move_if_ne_word:
            return a != b;
        case Op::move_if_eq_float:
            return real_a == real_b;
        default:
            return real_a != real_b;
    }
}

/// Executes an instruction of two statements, and looks between them. Gives the next one.
const Instruction* step_twice(const Instruction* pc, std::byte* base, const auto& look) {
    const Instruction& in = *pc;
    if (in.op == Op::move_twice) {
        set_word(base, in.a, word(base, in.b));
        look();
        set_word(base, in.c, word(base, in.d));
    } else if (in.op == Op::move_and_jump) {
        set_word(base, in.a, word(base, in.b));
        look();
        return reinterpret_cast<const Instruction*>(static_cast<std::uintptr_t>(in.c));
    } else if (is_met(in, base)) {
        look();
        set_word(base, in.c, word(base, in.d));
    }
    return pc + 1;
}

/// Lets the probe look before the statements that begin with an instruction. Gives the instruction
/// that is to be executed: a later one, where two statements are one instruction.
const Instruction* look(const Frames& frames, const Instruction* pc, std::byte* base) {
    const Code& code = frames.code;
    Probe& probe = *code.probe;
    for (;;) {
        const auto at = static_cast<std::size_t>(pc - code.instructions.data());
        std::size_t next = probe.marks()[at];
        if (next == 0) return pc;
        const auto tell = [&] {
            probe.at({code, next - 1, frames.root, frames.context, frames.now,
                      static_cast<std::uint32_t>((frames.top - frames.bottom) / 16), frames.base});
        };
        if (!code.statements[next - 1].is_inner) {
            tell();
            ++next;
        }
        const bool is_split =
            next <= code.statements.size() && code.statements[next - 1].instruction == at;
        if (!is_split) return pc;
        pc = step_twice(pc, base, tell);
    }
}

/// From that instruction on, on the frame at `frames.base`.
template <bool counts, bool steps>
Fault run(Frames& frames, std::uint64_t from) {
    const Code& code = frames.code;
    const Instruction* const first = code.instructions.data();
    const Instruction* pc = first + from;
    std::byte* base = frames.place(frames.base);
    std::int64_t fuel = frames.fuel_left;
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
#define UPPER(operand) static_cast<std::uint32_t>(operand >> 32)
#define BEHIND static_cast<std::uint64_t>(pc - first)
#define IMAGE(number) reinterpret_cast<const std::byte*>(code.images.data() + number)
#define GO(address)                                                                      \
    {                                                                                    \
        pc = reinterpret_cast<const Instruction*>(static_cast<std::uintptr_t>(address)); \
        asm volatile("" : "+r"(pc));                                                     \
    }
#define CHOOSE(slot, number, ways) GO(number_of(U(slot), number))
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
#define CALL(address, number)                            \
    {                                                    \
        if (--fuel < 0) FAIL(no_end);                    \
        frames.enter(address, BEHIND);                   \
        base = frames.place(frames.base);                \
        pc = first + code.routines.data()[number].entry; \
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
#define NEXT                                          \
    if constexpr (steps) pc = look(frames, pc, base); \
    goto* places[static_cast<std::size_t>(pc->op)]
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
    frames.fuel_left = fuel;
    return frames.end(fault, BEHIND - 1);
}

/// What ended with that fault goes on where a __CATCH is for it.
template <bool counts, bool steps>
[[gnu::noinline]] Fault run_caught(Frames& frames, Fault fault) {
    while (const auto at = frames.caught(fault)) fault = run<counts, steps>(frames, *at);
    return fault;
}

template <bool counts, bool steps>
Fault run_whole(Frames& frames) {
    frames.fuel_left = frames.fuel;
    const Fault fault = run<counts, steps>(frames, frames.scanned.entry);
    return fault == Fault::none ? fault : run_caught<counts, steps>(frames, fault);
}

[[gnu::always_inline]] inline Fault run_native(const ScanStart& start, Frames& frames,
                                               std::byte* base) {
    const NativeEntry entry = start.code->native->scan_of(start.number);
    const Fault fault = entry(base, frames, start.fuel);
    if (fault == Fault::none) [[likely]]
        return fault;
    return run_caught<false, false>(frames, fault);
}

[[gnu::always_inline]] inline Frames frames_at(const ScanStart& start, std::byte* instance,
                                               const Scan& now, const Context& context) {
    return {*start.code,
            *start.routine,
            now,
            context,
            start.fuel,
            instance,
            instance + start.calls,
            instance + start.pile};
}

/// With a probe, or counted, or without native code. Apart, as the way to that is short.
[[gnu::noinline]] Fault run_otherwise(const ScanStart& start, Frames& frames) {
    const auto& times = frames.code.times;
    Probe* const probe = frames.code.probe;
    std::byte* const instance = frames.root;
    const bool steps = probe && probe->steps(frames.scanned, frames.now);
    if (frames.code.native && !steps) return run_native(start, frames, frames.place(frames.base));
    if (!times && !steps) return run_whole<false, false>(frames);
    std::uint64_t counted[op_classes + 1] = {};
    frames.counted = counted;
    const Fault fault = steps ? run_whole<true, true>(frames) : run_whole<true, false>(frames);
    if (!times) return fault;
    std::memcpy(instance + 8 * counts_slot, counted, 8 * op_classes);
    const Wide taken = std::inner_product(times->begin(), times->end(), counted, Wide{0});
    set_word(instance, time_slot, static_cast<std::uint64_t>(std::min<Wide>(taken, never)));
    return fault;
}

}  // namespace

Probe::Probe(const Code& code) : marks_(code.instructions.size()) {
    for (std::size_t i = code.statements.size(); i > 0; --i)
        marks_[code.statements[i - 1].instruction] = static_cast<std::uint32_t>(i);
}

ScanStart::ScanStart(const Code& of, const CodeRoutine& runs, std::int64_t passes)
    : code(&of),
      routine(&runs),
      fuel(passes),
      number(static_cast<std::uint32_t>(&runs - of.routines.data())),
      calls(8 * of.calls_slot()),
      pile(8 * runs.pile.first) {}

bool execute(std::byte* instance, const ScanStart& start, const Scan& now, const Context& context) {
    Frames frames = frames_at(start, instance, now, context);
    const Code& code = *start.code;
    const Fault fault = code.native && !code.probe ? run_native(start, frames, instance)
                                                   : run_otherwise(start, frames);
    return fault != Fault::none;
}

Fault execute_part(const Code& code, const CodeRoutine& routine, std::byte* copy,
                   std::uint64_t frame, const Scan& now, const Context& context,
                   std::int64_t fuel) {
    const ScanStart start(code, routine, fuel);
    Frames frames = frames_at(start, copy, now, context);
    frames.base = frame;
    return run_otherwise(start, frames);
}

std::size_t bytes_beside(const CodeRoutine& routine) {
    return 16 * std::size_t{routine.levels} +
           8 * std::size_t{routine.pile.end - routine.pile.first};
}

Fault execute_beside(const Code& code, const CodeRoutine& routine, std::byte* root,
                     std::uint64_t frame, const Scan& now, const Context& context,
                     std::int64_t fuel, std::byte* room) {
    CodeRoutine beside = routine;
    beside.pile.first = static_cast<std::uint32_t>((room - root) / 8) + 2 * routine.levels;
    beside.pile.end = beside.pile.first + routine.pile.end - routine.pile.first;
    Frames frames(code, beside, now, context, fuel, root, room,
                  root + 8 * std::size_t{beside.pile.first});
    frames.base = frame;
    Witness* const witness = std::exchange(code.witness, nullptr);
    const Fault fault = run_whole<false, false>(frames);
    code.witness = witness;
    return fault;
}

}  // namespace lineshaft::st
