#include "runtime/st/code/machine.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>
#include <string_view>

#include <sleef.h>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/constant.hpp"
#include "runtime/st/types/packed.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::st {

namespace {

template <class T>
void write(std::byte* place, T value) {
    static_assert(sizeof value == 8);
    std::memcpy(place, &value, sizeof value);
}

std::uint64_t word(const std::byte* first, std::uint64_t slot) {
    return read<std::uint64_t>(first + 8 * slot);
}

void set_word(std::byte* first, std::uint64_t slot, std::uint64_t value) {
    write(first + 8 * slot, value);
}

std::uint64_t byte(const std::byte* first, std::uint64_t at) {
    return static_cast<std::uint64_t>(first[at]);
}

void set_byte(std::byte* first, std::uint64_t at, std::uint64_t value) {
    first[at] = static_cast<std::byte>(value);
}

void copy_slots(std::byte* to, const std::byte* from, std::uint64_t slots) {
    std::memmove(to, from, 8 * slots);
}

constexpr std::uint64_t mask(std::uint32_t bits) {
    return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
}

/// The value that a slot has of an integer of this width.
template <class T>
std::uint64_t wrap(std::uint64_t value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(static_cast<T>(value)));
}

template <class T>
std::uint64_t quotient(std::uint64_t a, std::uint64_t b) {
    if constexpr (std::is_signed_v<T>) {
        if (b == ~std::uint64_t{0}) return wrap<T>(0 - a);
        return wrap<T>(static_cast<std::uint64_t>(static_cast<std::int64_t>(a) /
                                                  static_cast<std::int64_t>(b)));
    } else {
        return a / b;
    }
}

template <class T>
std::uint64_t remainder(std::uint64_t a, std::uint64_t b) {
    if constexpr (std::is_signed_v<T>) {
        if (b == ~std::uint64_t{0}) return 0;
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(a) %
                                          static_cast<std::int64_t>(b));
    } else {
        return a % b;
    }
}

/// Of a whole number.
template <class T>
bool fits(double value) {
    constexpr double beyond = 2.0 * static_cast<double>(std::numeric_limits<T>::max() / 2 + 1);
    return value < beyond && value >= static_cast<double>(std::numeric_limits<T>::min());
}

template <class T>
std::uint64_t whole(double value) {
    return wrap<T>(static_cast<std::uint64_t>(static_cast<T>(value)));
}

template <int bits>
std::uint64_t shift_left(std::uint64_t value, std::uint64_t places) {
    return places >= bits ? 0 : value << places & mask(bits);
}

template <int bits>
std::uint64_t shift_right(std::uint64_t value, std::uint64_t places) {
    return places >= bits ? 0 : value >> places;
}

template <int bits>
std::uint64_t rotate_left(std::uint64_t value, std::uint64_t places) {
    const std::uint64_t by = places % bits;
    return by == 0 ? value : (value << by | value >> (bits - by)) & mask(bits);
}

template <int bits>
std::uint64_t rotate_right(std::uint64_t value, std::uint64_t places) {
    return rotate_left<bits>(value, bits - places % bits);
}

double exact(double value) {
    return value;
}

double narrow(double value) {
    return double{static_cast<float>(value)};
}

/// A decimal digit in each four bits: none may be above 9.
std::optional<std::uint64_t> from_bcd(std::uint64_t digits) {
    std::uint64_t value = 0;
    for (int shift = 60; shift >= 0; shift -= 4) {
        const std::uint64_t digit = digits >> shift & 15;
        if (digit > 9) return {};
        value = value * 10 + digit;
    }
    return value;
}

/// Of a value that has no more than so many digits.
std::optional<std::uint64_t> to_bcd(std::uint64_t value, std::uint32_t digits) {
    std::uint64_t made = 0;
    for (std::uint32_t i = 0; i < digits; ++i, value /= 10) made |= value % 10 << (4 * i);
    return value == 0 ? std::optional(made) : std::nullopt;
}

/// A FOR goes on with this counter; behind the limit stands the step.
template <class T>
bool is_within(const std::byte* counter, const std::byte* limit) {
    const bool rises = std::is_unsigned_v<T> || read<std::int64_t>(limit + 8) >= 0;
    return rises ? read<T>(counter) <= read<T>(limit) : read<T>(counter) >= read<T>(limit);
}

template <class T>
bool next(std::byte* counter, const std::byte* limit) {
    T sum = 0;
    const bool over = __builtin_add_overflow(read<T>(counter), read<T>(limit + 8), &sum);
    write(counter, sum);
    return !over && is_within<T>(counter, limit);
}

// Texts: the length, then the characters.

std::string_view text_at(const std::byte* place) {
    return {reinterpret_cast<const char*>(place + 8), static_cast<std::size_t>(word(place, 0))};
}

void copy_text(std::byte* to, const std::byte* from, std::uint64_t room) {
    const std::uint64_t length = std::min(word(from, 0), room);
    std::memmove(to + 8, from + 8, length);
    set_word(to, 0, length);
}

/// Of `from` those characters from `first` (0) on, to a text that has room for `longest_result`;
/// false where that cuts them short.
bool append_text(std::byte* to, const std::byte* from, std::int64_t first, std::int64_t count) {
    const auto length = static_cast<std::int64_t>(word(from, 0));
    first = std::clamp<std::int64_t>(first, 0, length);
    count = std::clamp<std::int64_t>(count, 0, length - first);
    const auto before = static_cast<std::int64_t>(word(to, 0));
    const auto taken = std::clamp<std::int64_t>(longest_result - before, 0, count);
    std::memmove(to + 8 + before, from + 8 + first, static_cast<std::size_t>(taken));
    set_word(to, 0, static_cast<std::uint64_t>(before + taken));
    return taken == count;
}

/// -1, 0 or 1: the size of what std::memcmp returns depends on where the texts are.
std::int64_t compare_texts(const std::byte* a, const std::byte* b) {
    const auto order = text_at(a) <=> text_at(b);
    return order < 0 ? -1 : order > 0;
}

/// The one numbered `place` (from 1) of a text that has room for so many: 0 behind its end.
std::optional<std::uint64_t> character_of(const std::byte* from, std::int64_t place,
                                          std::uint32_t room) {
    if (place < 1 || place > std::int64_t{room}) return {};
    const auto at = static_cast<std::uint64_t>(place - 1);
    return at < word(from, 0) ? byte(from + 8, at) : 0;
}

/// False if the text is shorter.
bool set_character(std::byte* text, std::int64_t place, std::uint64_t value) {
    const auto at = static_cast<std::uint64_t>(place) - 1;
    const bool is_there = at < word(text, 0);
    if (is_there) set_byte(text + 8, at, value);
    return is_there;
}

/// The first place, counted from 1, or 0.
std::uint64_t find_text(const std::byte* in, const std::byte* what) {
    return text_at(what).empty() ? 0 : text_at(in).find(text_at(what)) + 1;
}

/// `has_sign`: '+42'.
template <class T>
void write_number(std::byte* to, T value, bool has_sign = false) {
    char* first = reinterpret_cast<char*>(to + 8);
    const int sign = has_sign && value >= T{} ? 1 : 0;
    if (sign == 1) *first = '+';
    const auto [end, error] = std::to_chars(first + sign, first + longest_result, value);
    set_word(to, 0, error == std::errc() ? static_cast<std::uint64_t>(end - first) : 0);
}

/// As controllers read it: the number at the beginning, behind blanks; 0 where there is none.
template <class T>
T number_of_text(const std::byte* from) {
    std::string_view text = text_at(from);
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const bool is_negative = text.starts_with('-');
    if (is_negative || text.starts_with('+')) text.remove_prefix(1);
    if (text.find_first_of(".0123456789") != 0) return T{};
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return T{};
    return is_negative ? -value : value;
}

std::uint64_t truth_of_text(const std::byte* from) {
    const auto is_letter = [](char a, char b) { return upper(a) == b; };
    const std::string_view text = text_at(from);
    return text == "1" || std::ranges::equal(text, std::string_view("TRUE"), is_letter) ? 1 : 0;
}

void write_text(std::byte* to, std::string_view text) {
    std::memcpy(to + 8, text.data(), text.size());
    set_word(to, 0, text.size());
}

void write_time(std::byte* to, std::uint64_t kind, std::int64_t value) {
    fmt::memory_buffer text;
    add_time(text, static_cast<Type::Kind>(kind), value);
    write_text(to, {text.data(), text.size()});
}

/// `T#1s`, or without what stands before '#'; 0 where it is none.
std::int64_t time_of_text(std::uint64_t kind, const std::byte* from) {
    std::string_view text = text_at(from);
    text.remove_prefix(text.find('#') + 1);  // 0 without one
    return static_cast<std::int64_t>(read_time(text, static_cast<Type::Kind>(kind)).value_or(0));
}

/// What a scan needs besides where it is: apart, so that the registers are left to that.
struct Frames {
    const Code& code;
    Scan& now;
    const Context& context;
    std::int64_t fuel;
    std::byte* root;
    std::byte* bottom = root + 8 * (globals_slot + code.globals);
    std::byte* top = bottom;           ///< of the calls that run
    std::uint64_t base = 0;            ///< address of the frame
    std::uint64_t* counted = nullptr;  ///< instructions of each class

    /// Of an address: the number of an instance of the program plus 1, or 0 for the block itself,
    /// times 2^32, plus a slot.
    std::byte* place(std::uint64_t address) const {
        const std::uint64_t space = address >> 32;
        std::byte* first = space == 0 ? root : context.instances[space - 1];
        return first + 8 * (address & 0xFFFF'FFFF);
    }

    std::uint64_t address_of(std::uint32_t slot) const { return base + slot; }

    std::uint64_t global_number(std::uint32_t number) const {
        return word(root, globals_slot + number);
    }
    std::uint64_t global(std::uint32_t number) const { return (global_number(number) + 1) << 32; }

    void call_block(std::byte* block, std::uint32_t number) const {
        const BlockType& type = *code.standard[number];
        Context inner = context;
        inner.kind = type.context;
        type.scan_blocks(block, 1, now, inner);
    }

    void enter(std::uint64_t address, const Instruction* back) {
        set_word(top, 0, static_cast<std::uint64_t>(back - code.instructions.data()));
        set_word(top, 1, base);
        top += 16;
        base = address;
    }

    /// Of a test: false for a time that would go back, or end.
    bool advance(std::int64_t by, std::int64_t interval) {
        now.interval = interval;
        ++now.index;
        return by >= 0 && !__builtin_add_overflow(now.time, by, &now.time);
    }

    void note_cut(const Instruction* at) const {
        if (word(root, cut_slot) == 0)
            set_word(root, cut_slot, static_cast<std::uint64_t>(at - code.instructions.data()));
    }

    const Instruction* leave() {
        top -= 16;
        base = word(top, 1);
        return code.instructions.data() + word(top, 0);
    }

    Fault end(Fault fault, const Instruction* at) {
        set_word(root, error_slot, fault != Fault::none);
        set_word(root, error_id_slot, static_cast<std::uint64_t>(fault));
        if (fault == Fault::none) return fault;
        set_word(root, place_slot, static_cast<std::uint64_t>(at - code.instructions.data()));
        set_word(root, depth_slot, static_cast<std::uint64_t>(top - bottom) / 16);
        return fault;
    }
};

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
#define CALL(address, number)                            \
    {                                                    \
        if (--fuel < 0) FAIL(no_end);                    \
        frames.enter(address, pc);                       \
        base = frames.place(frames.base);                \
        pc = first + code.routines.data()[number].entry; \
    }
#define LEAVE                                        \
    {                                                \
        if (frames.top == frames.bottom) FAIL(none); \
        pc = frames.leave();                         \
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
    return frames.end(fault, pc - 1);
}

}  // namespace

Fault execute(const Code& code, const CodeRoutine& routine, std::byte* instance, Scan& now,
              const Context& context, std::int64_t fuel, const std::int64_t* times) {
    Frames frames{code, now, context, fuel, instance};
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
