#include "runtime/st/machine.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include <sleef.h>

namespace lineshaft::st {

namespace {

template <class T>
T read(const std::byte* place) {
    T value;
    std::memcpy(&value, place, sizeof value);
    return value;
}

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

double narrow(double value) {
    return double{static_cast<float>(value)};
}

/// A decimal digit in each four bits. False where one is above 9.
bool from_bcd(std::uint64_t digits, auto put) {
    std::uint64_t value = 0;
    for (int shift = 60; shift >= 0; shift -= 4) {
        const std::uint64_t digit = digits >> shift & 15;
        if (digit > 9) return false;
        value = value * 10 + digit;
    }
    put(value);
    return true;
}

/// False where the value has more than so many digits.
bool to_bcd(std::uint64_t value, std::uint32_t digits, auto put) {
    std::uint64_t made = 0;
    for (std::uint32_t i = 0; i < digits; ++i, value /= 10) made |= value % 10 << (4 * i);
    if (value == 0) put(made);
    return value == 0;
}

// Texts: the length, then the characters.

std::string_view text_at(const std::byte* place) {
    return {reinterpret_cast<const char*>(place + 8), static_cast<std::size_t>(word(place, 0))};
}

void copy_text(std::byte* to, const std::byte* from, std::uint32_t room) {
    const std::uint64_t length = std::min<std::uint64_t>(word(from, 0), room);
    std::memmove(to + 8, from + 8, length);
    set_word(to, 0, length);
}

/// Of `from` those characters from `first` (0) on, to a text that has room for `longest_result`.
void append_text(std::byte* to, const std::byte* from, std::int64_t first, std::int64_t count) {
    const auto length = static_cast<std::int64_t>(word(from, 0));
    first = std::clamp<std::int64_t>(first, 0, length);
    count = std::clamp<std::int64_t>(count, 0, length - first);
    const auto before = static_cast<std::int64_t>(word(to, 0));
    count = std::clamp<std::int64_t>(longest_result - before, 0, count);
    std::memmove(to + 8 + before, from + 8 + first, static_cast<std::size_t>(count));
    set_word(to, 0, static_cast<std::uint64_t>(before + count));
}

std::int64_t compare_texts(const std::byte* a, const std::byte* b) {
    return text_at(a).compare(text_at(b));
}

/// The first place, counted from 1, or 0.
std::uint64_t find_text(const std::byte* in, const std::byte* what) {
    return text_at(what).empty() ? 0 : text_at(in).find(text_at(what)) + 1;
}

template <class T>
void write_number(std::byte* to, T value) {
    char* first = reinterpret_cast<char*>(to + 8);
    const auto [end, error] = std::to_chars(first, first + longest_result, value);
    set_word(to, 0, error == std::errc() ? static_cast<std::uint64_t>(end - first) : 0);
}

template <class T>
bool read_number(const std::byte* from, auto put) {
    const std::string_view text = text_at(from);
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return false;
    put(value);
    return true;
}

/// Memory by its address: the number of an instance of the program plus 1, or 0 for the block
/// itself, times 2^32, plus a slot.
struct Memory {
    std::byte* root;
    std::byte* const* instances;

    std::byte* at(std::uint64_t address) const {
        const std::uint64_t space = address >> 32;
        std::byte* first = space == 0 ? root : instances[space - 1];
        return first + 8 * (address & 0xFFFF'FFFF);
    }
};

template <bool counts>
Fault run(const Code& code, const CodeRoutine& routine, std::byte* root, Scan& now,
          const Context& context, std::int64_t fuel) {
    const Memory memory{root, context.instances};
    const Instruction* const first = code.instructions.data();
    const Instruction* pc = first + routine.entry;
    std::byte* base = root;
    std::uint64_t base_address = 0;
    std::byte* const bottom = root + 8 * (globals_slot + code.globals);
    std::byte* top = bottom;
    std::uint64_t counted[op_classes + 1] = {};

    const auto U = [&](std::uint32_t slot) {
        return read<std::uint64_t>(base + 8 * std::size_t{slot});
    };
    const auto I = [&](std::uint32_t slot) {
        return read<std::int64_t>(base + 8 * std::size_t{slot});
    };
    const auto R = [&](std::uint32_t slot) { return read<double>(base + 8 * std::size_t{slot}); };
    const auto put = [&](std::uint32_t slot, auto value) {
        write(base + 8 * std::size_t{slot}, value);
    };
    const auto at = [&](std::uint32_t slot) { return base + 8 * std::size_t{slot}; };
    const auto target = [&](std::uint64_t address) { return memory.at(address); };
    const auto address_of = [&](std::uint32_t slot) { return base_address + slot; };
    const auto global_address = [&](std::uint32_t global) {
        return (word(root, globals_slot + global) + 1) << 32;
    };
    const auto initialise = [&](std::byte* to, std::uint32_t image, std::uint32_t slots) {
        std::memcpy(to, &code.images[image], 8 * std::size_t{slots});
    };
    const auto checked_index = [&](std::uint32_t slot, std::uint32_t number, std::uint64_t& index) {
        const IndexTable& table = code.tables[number];
        index = U(slot) - static_cast<std::uint64_t>(table.lower);
        if (index >= table.count) return false;
        index *= table.stride;
        return true;
    };
    const auto index = [&](std::uint32_t to, std::uint32_t slot, std::uint32_t number) {
        std::uint64_t found = 0;
        if (!checked_index(slot, number, found)) return false;
        put(to, found);
        return true;
    };
    const auto index_more = [&](std::uint32_t to, std::uint32_t slot, std::uint32_t number) {
        std::uint64_t found = 0;
        if (!checked_index(slot, number, found)) return false;
        put(to, U(to) + found);
        return true;
    };
    const auto within = [&](std::uint32_t slot, std::uint32_t number) {
        std::uint64_t found = 0;
        return checked_index(slot, number, found);
    };
    const auto look_up = [&](std::uint32_t to, std::uint32_t slot, std::uint32_t number) {
        const IndexTable& table = code.tables[number];
        if (U(slot) >= table.count) return false;
        put(to, code.numbers[static_cast<std::size_t>(table.lower) + U(slot)]);
        return true;
    };
    const auto begins = [&](std::uint32_t counter, std::uint32_t limit) {
        return I(limit + 1) >= 0 ? I(counter) <= I(limit) : I(counter) >= I(limit);
    };
    const auto next = [&](std::uint32_t counter, std::uint32_t limit) {
        std::int64_t sum = 0;
        const bool over = __builtin_add_overflow(I(counter), I(limit + 1), &sum);
        put(counter, sum);
        return !over && begins(counter, limit);
    };
    const auto call_block = [&](std::byte* block, std::uint32_t number) {
        const BlockType& type = *code.standard[number];
        type.scan_blocks(block, 1, now, {type.context, context.instances});
    };
    const auto enter = [&](std::uint64_t address, std::uint32_t number) {
        set_word(top, 0, static_cast<std::uint64_t>(pc - first));
        set_word(top, 1, base_address);
        top += 16;
        base_address = address;
        base = memory.at(address);
        pc = first + code.routines[number].entry;
    };
    const auto end = [&](Fault fault) {
        set_word(root, error_slot, fault != Fault::none);
        set_word(root, error_id_slot, static_cast<std::uint64_t>(fault));
        set_word(root, place_slot, static_cast<std::uint64_t>(pc - first) - 1);
        set_word(root, depth_slot, static_cast<std::uint64_t>(top - bottom) / 16);
        if constexpr (counts) std::memcpy(root + 8 * counts_slot, counted, 8 * op_classes);
        return fault;
    };

#define GO(to) pc = first + (to)
#define FAIL(fault) return end(Fault::fault)
#define LEAVE                                       \
    {                                               \
        if (top == bottom) return end(Fault::none); \
        top -= 16;                                  \
        pc = first + word(top, 0);                  \
        base_address = word(top, 1);                \
        base = memory.at(base_address);             \
    }
    // A jump from each instruction to the next one's place: the processor foresees them one by one.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#define OP(name, class, operands, ...) &&at_##name,
    static const void* const places[] = {LINESHAFT_ST_OPCODES(OP)};
#undef OP
    std::uint32_t a = 0, b = 0, c = 0;
    const auto fetch = [&] {
        const Instruction& in = *pc++;
        a = in.a, b = in.b, c = in.c;
        if constexpr (counts) ++counted[static_cast<std::size_t>(info(in.op).cost)];
        return places[static_cast<std::size_t>(in.op)];
    };
    goto* fetch();
#define OP(name, class, operands, ...) \
    at_##name : {                      \
        __VA_ARGS__;                   \
        goto* fetch();                 \
    }
    LINESHAFT_ST_OPCODES(OP)
#undef OP
#pragma GCC diagnostic pop
#undef GO
#undef FAIL
#undef LEAVE
}

}  // namespace

Fault execute(const Code& code, const CodeRoutine& routine, std::byte* instance, Scan& now,
              const Context& context, std::int64_t fuel, bool counts) {
    return counts ? run<true>(code, routine, instance, now, context, fuel)
                  : run<false>(code, routine, instance, now, context, fuel);
}

}  // namespace lineshaft::st
