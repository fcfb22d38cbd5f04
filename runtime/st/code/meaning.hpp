#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "runtime/model/scan.hpp"
#include "runtime/st/code/fault.hpp"
#include "runtime/st/code/slots.hpp"
#include "runtime/st/types/packed_form.hpp"

namespace lineshaft::st {

struct Bytes;
struct Code;
struct CodeRoutine;
struct Piece;

}  // namespace lineshaft::st

/// What the lines of the instructions are written in: the machine, the stencils of native code and
/// what a compiler makes of the lines (native/) include it, that without the rest of the program.
/// Nothing here throws.
namespace lineshaft::st::meaning {

template <class T>
void write(std::byte* place, T value) {
    static_assert(sizeof value == 8);
    std::memcpy(place, &value, sizeof value);
}

inline std::uint64_t word(const std::byte* first, std::uint64_t slot) {
    std::uint64_t value = 0;
    std::memcpy(&value, first + 8 * slot, sizeof value);
    return value;
}

inline void set_word(std::byte* first, std::uint64_t slot, std::uint64_t value) {
    write(first + 8 * slot, value);
}

inline std::uint64_t byte(const std::byte* first, std::uint64_t at) {
    return static_cast<std::uint64_t>(first[at]);
}

inline void set_byte(std::byte* first, std::uint64_t at, std::uint64_t value) {
    first[at] = static_cast<std::byte>(value);
}

inline void copy_slots(std::byte* to, const std::byte* from, std::uint64_t slots) {
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

/// Whether the type has that whole number.
template <class T>
bool fits(double value) {
    constexpr double beyond = 2.0 * static_cast<double>(std::numeric_limits<T>::max() / 2 + 1);
    return value < beyond && value >= static_cast<double>(std::numeric_limits<T>::min());
}

template <class T>
std::uint64_t whole(double value) {
    return wrap<T>(static_cast<std::uint64_t>(static_cast<T>(value)));
}

/// The lowest 64 bits of the nearest whole number; of infinity and of what is no number 0.
inline std::uint64_t lowest_bits(double value) {
    value = std::nearbyint(value);
    if (fits<std::int64_t>(value)) return whole<std::int64_t>(value);
    if (!std::isfinite(value)) return 0;
    return static_cast<std::uint64_t>(value - std::floor(value * 0x1p-64) * 0x1p64);
}

/// What CODESYS leaves of the nearest whole number, as its simulation on a PC was seen to. In 64
/// bits they are its lowest from -2^63 to 2^64, and of any other the least number. In 32 bits and
/// fewer they are its lowest from -2^31 to 2^63; the least number below, and 0 above and of what is
/// no number. Its TRUNC gives the least number for all that 32 bits do not hold.
std::uint64_t left_in_64(double value);
std::uint64_t left_in_32(double value);
std::uint64_t truncated_in_32(double value);

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

inline std::uint64_t sum(std::uint64_t a, std::uint64_t b) {
    return a + b;
}

inline std::uint64_t product(std::uint64_t a, std::uint64_t b) {
    return a * b;
}

/// The first one of two NaNs. A compiler may take either, another one in each place.
inline double sum(double a, double b) {
#ifdef __x86_64__
    asm("addsd %1, %0" : "+x"(a) : "xm"(b));
    return a;
#else
    return a + b;
#endif
}

inline double product(double a, double b) {
#ifdef __x86_64__
    asm("mulsd %1, %0" : "+x"(a) : "xm"(b));
    return a;
#else
    return a * b;
#endif
}

inline double exact(double value) {
    return value;
}

inline double narrow(double value) {
    return double{static_cast<float>(value)};
}

/// A decimal digit in each four bits: none may be above 9.
inline std::optional<std::uint64_t> from_bcd(std::uint64_t digits) {
    std::uint64_t value = 0;
    for (int shift = 60; shift >= 0; shift -= 4) {
        const std::uint64_t digit = digits >> shift & 15;
        if (digit > 9) return {};
        value = value * 10 + digit;
    }
    return value;
}

/// The digits of a value; empty: it has more than so many.
inline std::optional<std::uint64_t> to_bcd(std::uint64_t value, std::uint32_t digits) {
    std::uint64_t made = 0;
    for (std::uint32_t i = 0; i < digits; ++i, value /= 10) made |= value % 10 << (4 * i);
    return value == 0 ? std::optional(made) : std::nullopt;
}

/// A FOR goes on with this counter; behind the limit stands the step.
template <class T>
bool is_within(const std::byte* counter, const std::byte* limit) {
    const auto at = static_cast<T>(word(counter, 0)), last = static_cast<T>(word(limit, 0));
    const bool rises = std::is_unsigned_v<T> || static_cast<std::int64_t>(word(limit, 1)) >= 0;
    return rises ? at <= last : at >= last;
}

template <class T>
bool next(std::byte* counter, const std::byte* limit) {
    T sum = 0;
    const bool over = __builtin_add_overflow(static_cast<T>(word(counter, 0)),
                                             static_cast<T>(word(limit, 1)), &sum);
    write(counter, sum);
    return !over && is_within<T>(counter, limit);
}

// Texts: the length, then the characters.

std::string_view text_at(const std::byte* place);

/// False: it was cut.
bool copy_text(std::byte* to, const std::byte* from, TextRoom room);
/// The text of a WSTRING as that of a STRING of bytes, or back, where there is room for units.
void recode_text(std::byte* to, const std::byte* from, TextRoom room);
bool is_too_long(const std::byte* text, TextRoom room);
std::uint64_t length_of_text(const std::byte* text, bool in_units);

/// Puts characters of `from`, from `first` (0) on, behind a text that has `room`;
/// false where that cuts them short.
bool append_text(std::byte* to, const std::byte* from, std::int64_t first, std::int64_t count,
                 TextRoom room);

/// -1, 0 or 1: the size of what std::memcmp returns depends on where the texts are.
std::int64_t compare_texts(const std::byte* a, const std::byte* b);

/// The one numbered `place` (from 1) of a text that has room for so many: 0 behind its end.
std::optional<std::uint64_t> character_of(const std::byte* from, std::int64_t place, TextRoom room);

/// A 0 ends the text there. False if the text is shorter.
bool set_character(std::byte* text, std::int64_t place, std::uint64_t value, TextRoom room);

/// The byte at `place` (from 0) of a text that has room for so many and the 0 that ends it; behind
/// its end it is 0.
std::optional<std::uint64_t> byte_of_text(const std::byte* from, std::int64_t place, TextRoom room);

/// As where texts are bytes with a 0 behind them: a 0 ends the text, another one behind its end
/// goes on with it as far as no 0 stands there. False for a place that it has no room for.
bool set_byte_of_text(std::byte* text, std::int64_t place, std::uint64_t value, TextRoom room);

/// The first place, counted from 1, or 0.
std::uint64_t find_text(const std::byte* in, const std::byte* what, bool in_units);
/// MatIEC's goes on behind what differs: it does not find 'ab' in 'aab'.
std::uint64_t matiec_find_text(const std::byte* in, const std::byte* what);

/// `has_sign`: '+42'.
template <class T>
void write_number(std::byte* to, T value, bool has_sign = false);

/// How a real number becomes a text.
enum class RealForm : std::uint8_t {
    shortest,  ///< that reads back as the same
    rounded,  ///< of 7 or 15 digits with a point, '12.0', and from 10^6 or 10^14 on and below 10^-4
              ///< with an exponent, '1.5E20', as TwinCAT writes it
    of_codesys,  ///< a REAL of 7 digits, '12.0', with an exponent of two from 10^8 on and below
                 ///< 10^-4, '1E08'; an LREAL of 15, from 10^14 on and below 1 '1.0e-1'; '#NaN'
    exponent,    ///< of 7 or 14 digits with signs, '+1.500000E+20', as Siemens writes it
};
constexpr RealForm real_form(std::uint32_t operand) {
    return static_cast<RealForm>(operand);
}
template <class T>
void write_real(std::byte* to, T value, RealForm form);

/// As controllers read it: the number at the beginning, behind blanks; 0 where there is none. One
/// that a double does not hold is infinite or 0. A whole number may be `16#FF`, and where digits
/// may stand in groups `2#1111_0000`.
template <class T>
T number_of_text(const std::byte* from, bool has_groups);

/// As SCL reads it: a comma between digits is nothing, there is no exponent and no base, and a
/// whole number that its type (of `bits`) does not hold is 0.
std::uint64_t s7_integer_of_text(const std::byte* from, std::uint64_t bits, bool is_signed);
double s7_real_of_text(const std::byte* from);

/// As MatIEC's C library reads it: a whole number from its last digit on, whose sign is the first
/// character; what is no digit is passed over, of what is not below '.' that behind it; of a time
/// the seconds before a point. A real number with a point as in C, without one as a whole number.
std::uint64_t matiec_integer_of_text(const std::byte* from, bool is_time);
double matiec_real_of_text(const std::byte* from);

/// 1 of 'TRUE' in any letters and of '1'; `is_strict`: of what begins with 'TRUE' or 'true', behind
/// blanks, too, as CODESYS has it.
std::uint64_t truth_of_text(const std::byte* from, bool is_strict);

/// TRUE or FALSE.
void write_truth(std::byte* to, bool value);

/// `text`: the number of a TimeText.
void write_time(std::byte* to, std::uint32_t text, std::int64_t value);

/// As MatIEC writes them: '16#ff', ten digits of a real number, 'T#0d0h0m2s500ms'.
void write_bits(std::byte* to, std::uint64_t value);
void write_ten_digits(std::byte* to, double value);
void write_time_in_parts(std::byte* to, std::int64_t value);

/// `T#1s`, or without what stands before '#'; 0 where it is none.
std::int64_t time_of_text(std::uint64_t kind, const std::byte* from);

/// Passes of a loop that so many bytes count as.
inline std::int64_t effort(std::int64_t bytes) {
    return bytes > 0 ? bytes / 16 : 0;
}

// References: see Piece.

/// False where it would be beyond what a reference holds.
bool move_reference(std::byte* to, const std::byte* from, std::int64_t by);
/// -1, 0 or 1. One variable is before another as they stand in memory.
std::int64_t compare_references(const std::byte* a, const std::byte* b);
/// In bytes; empty if they are to parts of different variables.
std::optional<std::int64_t> reference_distance(const std::byte* a, const std::byte* b);

/// What a scan needs besides where it is: apart, so that the registers are left to that.
/// The last three are written before they are read.
struct Frames {
    const Code& code;
    const CodeRoutine& scanned;  ///< what the root runs
    const Scan& now;
    const Context& context;
    std::int64_t fuel;
    std::byte* root;
    std::byte* bottom;       ///< where the calls that run begin in the instance
    std::byte* top;          ///< of the calls that run
    std::byte* pile;         ///< behind the frames of calls that recur
    std::uint64_t base = 0;  ///< address of the frame
    std::uint64_t reached;   ///< what the last reference is to
    std::uint64_t* counted;  ///< instructions of each class
    std::int64_t fuel_left;  ///< when a run ended

    Frames(const Code& of, const CodeRoutine& runs, const Scan& moment, const Context& around,
           std::int64_t passes, std::byte* instance, std::byte* calls, std::byte* recurring)
        : code(of),
          scanned(runs),
          now(moment),
          context(around),
          fuel(passes),
          root(instance),
          bottom(calls),
          top(calls),
          pile(recurring) {}

    std::byte* place(std::uint64_t address) const { return place_of(address, root, context); }

    std::uint64_t address_of(std::uint32_t slot) const { return base + slot; }

    /// The address of something, as it means the same to any block that uses it in any scan: with
    /// the number of the instance, where that is one of the program's.
    std::uint64_t lasting(std::uint64_t address) const {
        const Address at = Address::of(address);
        if (at.is_of_program()) return address;
        for (int i = 0; i < context.blocks; ++i)
            if (context.instances[i] == root)
                return Address::in(static_cast<std::uint64_t>(i), at.slot).word();
        return address;
    }

    std::uint64_t global_number(std::uint32_t number) const {
        return word(root, globals_slot + number);
    }
    std::uint64_t global(std::uint32_t number) const {
        return Address::in(global_number(number)).word();
    }

    /// What that method is of the instance at the address, which is one, to slot 0, and the
    /// address of what is given to it, to the next one. False: there is no room to call it.
    bool find(std::byte* to, std::uint64_t address, std::uint32_t method) const;
    /// Whether it has that method, or is of that block.
    bool has(std::uint64_t address, std::uint32_t method) const;

    // Calls within a ring of routines that call one another. Each has slots on a pile, and behind
    // them a record.

    struct Record {
        std::uint64_t slots = 0;                 ///< 0: what is called does not run there already
        std::uint64_t address = 0;               ///< of the frame that they are kept of; or none
        std::uint64_t routine = 0, running = 0;  ///< and how many calls ran
    };

    /// A function, which gets a frame of its own: its address, to the slot. False: there is no
    /// room.
    bool push(std::byte* to, std::uint64_t routine);
    /// A method or a body on the instance at the address: what it may change of a call of its own
    /// is kept, if one runs there.
    Fault save(std::uint64_t routine, std::uint64_t address);
    /// The address of what is lent to that call, which may be in what is kept.
    std::uint64_t lent(std::uint64_t address) const;
    /// Behind the call: what is kept is there again. Gives the address of what the call left.
    std::uint64_t swap() const;
    void pop();

    /// Whether what runs on that frame at that instruction, and what called it, runs.
    void mark(std::uint64_t at, std::uint64_t frame, bool runs) const;
    /// The instruction that a scan that ended goes on with, on the frame that has the nearest __TRY
    /// around it; empty: none has, or nothing catches that fault.
    std::optional<std::uint64_t> caught(Fault fault);
    /// The number that CODESYS has of the fault that was caught last.
    std::uint64_t exception() const;

    /// A call, after which the instruction `behind` is next.
    void enter(std::uint64_t address, std::uint64_t behind) {
        set_word(top, 0, behind);
        set_word(top, 1, base);
        top += 16;
        base = address;
    }

    /// Lets time pass in a test; false for a time that would go back, or end.
    bool advance(std::int64_t by, std::int64_t interval) const;

    /// `behind` an assertion that does not hold.
    bool ends_at(std::uint64_t behind) const;

    void note_cut(std::uint64_t behind) const {
        if (word(root, cut_slot) == 0) set_word(root, cut_slot, behind);
    }

    /// The number of a call that begins now: no other one of the same frame has it.
    std::uint64_t number_of_call(std::int64_t left) const {
        return static_cast<std::uint64_t>(now.index + 1) << 32 | static_cast<std::uint32_t>(left);
    }

    /// Whether the call that has the variable of a piece goes on, or is the one that runs.
    bool goes_on(const Piece& piece, const std::byte* reference, std::uint64_t next) const;

    /// Finds in `reached` what a reference is to, which is to be of that shape. `next` is behind
    /// the instruction that asks.
    Fault reach(const std::byte* reference, std::uint32_t shape, std::uint64_t next);

    /// The variable of a reference and the byte that it is at.
    Fault find(const std::byte* reference, std::uint64_t next, Bytes& found) const;
    /// The number of what a reference is to becomes `reached` (`addresses.hpp`), or what has that
    /// number a reference. False: too many variables have one.
    bool number(const std::byte* reference, std::uint64_t known, std::uint64_t numbers);
    void find_number(std::byte* reference, std::uint64_t number, std::uint64_t known,
                     std::uint64_t numbers) const;
    /// A fault of what is done with that, of which messages name the variable.
    Fault told(Fault fault, const std::byte* reference) const;

    std::uint64_t leave() {
        top -= 16;
        base = word(top, 1);
        return word(top, 0);
    }

    /// Ends a scan, at that instruction.
    Fault end(Fault fault, std::uint64_t at) const;

  private:
    std::uint64_t running() const { return static_cast<std::uint64_t>(top - bottom) / 16; }
    /// For a routine below which so many levels of calls are.
    bool has_room(std::uint32_t depth) const;
    std::byte* pile_begin() const;
    Record last_record() const;
    std::byte* kept_by(const Record& record) const;
    /// Forgets the calls that a fault ends, where so many run behind it.
    void unwind(std::uint64_t calls);
    bool keep(const Record& record);
};

// What a reference is to as the bytes that a controller has there, so many bits behind, and of
// that shape. `slots` is the address of a text's or a value's slots; what is loaded is
// `Frames::reached`.
Fault load_through(Frames& frames, const std::byte* reference, std::uint64_t bit,
                   std::uint32_t shape, std::uint64_t next);
Fault store_through(Frames& frames, const std::byte* reference, std::uint64_t bit,
                    std::uint32_t shape, std::uint64_t value, std::uint64_t next);
Fault load_text_through(Frames& frames, const std::byte* reference, std::uint64_t bit,
                        std::uint32_t shape, std::uint64_t slots, std::uint64_t next);
Fault store_text_through(Frames& frames, const std::byte* reference, std::uint64_t bit,
                         std::uint32_t shape, std::uint64_t slots, std::uint64_t next);
Fault copy_from_through(Frames& frames, const std::byte* reference, std::uint64_t bit,
                        std::uint32_t shape, std::uint64_t slots, std::uint64_t next);
Fault copy_to_through(Frames& frames, const std::byte* reference, std::uint64_t bit,
                      std::uint32_t shape, std::uint64_t slots, std::uint64_t next);
Fault copy_memory(Frames& frames, const std::byte* to, const std::byte* from, std::int64_t count,
                  std::uint64_t next);
Fault fill_memory(Frames& frames, const std::byte* to, std::uint64_t value, std::int64_t count,
                  std::uint64_t next);
/// -1, 0 or 1 in `Frames::reached`.
Fault compare_memory(Frames& frames, const std::byte* a, const std::byte* b, std::int64_t count,
                     std::uint64_t next);

}  // namespace lineshaft::st::meaning
