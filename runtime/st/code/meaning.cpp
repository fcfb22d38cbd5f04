#include "runtime/st/code/meaning.hpp"

#include <charconv>
#include <cmath>
#include <tuple>

#include "runtime/source/letters.hpp"
#include "runtime/st/code/bytes.hpp"
#include "runtime/st/code/code.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::st::meaning {

namespace {

std::int32_t bytes_from_first(const std::byte* reference) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(word(reference, 1)));
}

/// 0 of none, else the number of its Piece plus 1.
std::uint64_t piece_of(const std::byte* reference) {
    return word(reference, 1) >> 32;
}

/// Whatever it is called: THIS of an instance is where the variable is that has it.
auto where(const std::byte* reference) {
    return std::pair(word(reference, 0), bytes_from_first(reference));
}

/// A record of a call that recurs ends with so many slots, of which the first has an address.
constexpr std::size_t record_end = 3;
constexpr std::uint64_t no_frame = ~std::uint64_t{0};

/// `16#FF`
int base_of(std::string_view number) {
    return number.starts_with("2#")    ? 2
           : number.starts_with("8#")  ? 8
           : number.starts_with("16#") ? 16
                                       : 10;
}

}  // namespace

std::string_view text_at(const std::byte* place) {
    return {reinterpret_cast<const char*>(place + 8), static_cast<std::size_t>(word(place, 0))};
}

void copy_text(std::byte* to, const std::byte* from, std::uint64_t room) {
    const std::uint64_t length = std::min(word(from, 0), room);
    std::memmove(to + 8, from + 8, length);
    set_word(to, 0, length);
}

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

std::int64_t compare_texts(const std::byte* a, const std::byte* b) {
    const auto order = text_at(a) <=> text_at(b);
    return order < 0 ? -1 : order > 0;
}

std::optional<std::uint64_t> character_of(const std::byte* from, std::int64_t place,
                                          std::uint32_t room) {
    if (place < 1 || place > std::int64_t{room}) return {};
    const auto at = static_cast<std::uint64_t>(place - 1);
    return at < word(from, 0) ? byte(from + 8, at) : 0;
}

bool set_character(std::byte* text, std::int64_t place, std::uint64_t value) {
    const auto at = static_cast<std::uint64_t>(place) - 1;
    const bool is_there = at < word(text, 0);
    if (is_there) set_byte(text + 8, at, value);
    if (is_there && value == 0) set_word(text, 0, at);
    return is_there;
}

std::optional<std::uint64_t> byte_of_text(const std::byte* from, std::int64_t place,
                                          std::uint64_t room) {
    const auto at = static_cast<std::uint64_t>(place);
    if (at > room) return {};
    return at < word(from, 0) ? byte(from + 8, at) : 0;
}

bool set_byte_of_text(std::byte* text, std::int64_t place, std::uint64_t value,
                      std::uint64_t room) {
    const auto at = static_cast<std::uint64_t>(place);
    if (at > room || (at == room && value != 0)) return false;
    std::uint64_t length = word(text, 0);
    const bool is_behind = at >= length;
    if (is_behind && length < room) set_byte(text + 8, length, 0);
    if (at < room) set_byte(text + 8, at, value);
    if (!is_behind && value == 0) length = at;
    while (is_behind && length < room && byte(text + 8, length) != 0) ++length;
    set_word(text, 0, length);
    return true;
}

std::uint64_t find_text(const std::byte* in, const std::byte* what) {
    return text_at(what).empty() ? 0 : text_at(in).find(text_at(what)) + 1;
}

template <class T>
void write_number(std::byte* to, T value, bool has_sign) {
    if constexpr (std::is_floating_point_v<T>)
        if (std::isnan(value)) value = std::abs(value);  // a NaN's sign is the processor's
    char* first = reinterpret_cast<char*>(to + 8);
    const int sign = has_sign && value >= T{} ? 1 : 0;
    if (sign == 1) *first = '+';
    const auto [end, error] = std::to_chars(first + sign, first + longest_result, value);
    set_word(to, 0, error == std::errc() ? static_cast<std::uint64_t>(end - first) : 0);
}

template <class T>
void write_real(std::byte* to, T value, bool has_point) {
    write_number(to, value, false);
    const std::string_view text = text_at(to);
    const std::size_t digits = std::min(text.find_first_not_of("-0123456789"), text.size());
    const bool is_whole = digits == text.size() || text[digits] == 'e';
    if (!has_point || !is_whole) return;
    constexpr std::string_view point = ".0";
    std::byte* first = to + 8 + digits;
    std::memmove(first + point.size(), first, text.size() - digits);
    std::memcpy(first, point.data(), point.size());
    set_word(to, 0, text.size() + point.size());
}

template <class T>
T number_of_text(const std::byte* from) {
    std::string_view text = text_at(from);
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const bool is_negative = text.starts_with('-');
    if (is_negative || text.starts_with('+')) text.remove_prefix(1);
    if (text.find_first_of(".0123456789") != 0) return T{};
    T value{};
    std::from_chars_result read;
    if constexpr (std::is_integral_v<T>) {
        const int base = base_of(text);
        if (base != 10) text.remove_prefix(text.find('#') + 1);
        read = std::from_chars(text.data(), text.data() + text.size(), value, base);
    } else {
        read = std::from_chars(text.data(), text.data() + text.size(), value);
    }
    if (read.ec != std::errc()) return T{};
    return is_negative ? -value : value;
}

std::uint64_t truth_of_text(const std::byte* from) {
    const auto is_letter = [](char a, char b) { return upper(a) == b; };
    const std::string_view text = text_at(from);
    return text == "1" || std::ranges::equal(text, std::string_view("TRUE"), is_letter) ? 1 : 0;
}

static void write_text(std::byte* to, std::string_view text) {
    std::memcpy(to + 8, text.data(), text.size());
    set_word(to, 0, text.size());
}

void write_truth(std::byte* to, bool value) {
    write_text(to, value ? "TRUE" : "FALSE");
}

void write_time(std::byte* to, std::uint64_t kind, std::int64_t value) {
    fmt::memory_buffer text;
    add_time(text, static_cast<Type::Kind>(kind), value);
    write_text(to, {text.data(), text.size()});
}

std::int64_t time_of_text(std::uint64_t kind, const std::byte* from) {
    std::string_view text = text_at(from);
    text.remove_prefix(text.find('#') + 1);  // 0 without one
    return static_cast<std::int64_t>(read_time(text, static_cast<Type::Kind>(kind)).value_or(0));
}

template void write_number(std::byte*, std::int64_t, bool);
template void write_number(std::byte*, std::uint64_t, bool);
template void write_real(std::byte*, double, bool);
template void write_real(std::byte*, float, bool);
template std::uint64_t number_of_text(const std::byte*);
template double number_of_text(const std::byte*);

bool move_reference(std::byte* to, const std::byte* from, std::int64_t by) {
    std::int32_t bytes = 0;
    if (__builtin_add_overflow(std::int64_t{bytes_from_first(from)}, by, &bytes)) return false;
    const std::uint64_t address = word(from, 0), piece = piece_of(from), call = word(from, 2);
    set_word(to, 0, address);
    set_word(to, 1, piece << 32 | static_cast<std::uint32_t>(bytes));
    set_word(to, 2, call);
    return true;
}

std::int64_t compare_references(const std::byte* a, const std::byte* b) {
    const auto order = where(a) <=> where(b);
    return order < 0 ? -1 : order > 0;
}

std::optional<std::int64_t> reference_distance(const std::byte* a, const std::byte* b) {
    if (word(a, 0) != word(b, 0) || piece_of(a) != piece_of(b)) return {};
    return std::int64_t{bytes_from_first(a)} - bytes_from_first(b);
}

void Frames::find(std::byte* to, std::uint64_t address, std::uint32_t method) const {
    const std::uint64_t kind = word(place(address), code.kind_slot());
    const FoundRoutine& found = code.found[kind * code.methods + method];
    set_word(to, 0, found.routine);
    set_word(to, 1, address + found.first);
}

bool Frames::has(std::uint64_t address, std::uint32_t method) const {
    return code.found[word(place(address), code.kind_slot()) * code.methods + method].first != 0;
}

bool Frames::has_room(std::uint64_t routine) const {
    const auto running = static_cast<std::uint64_t>(top - bottom) / 16;
    return running + 1 + code.routines[routine].depth <= levels;
}

bool Frames::keep(std::byte* to, std::uint64_t routine, std::uint64_t address,
                  std::uint64_t slots) {
    const std::uint64_t bytes = 8 * (slots + record_end);
    if (!has_room(routine) || static_cast<std::uint64_t>(pile_end - pile) < bytes) return false;
    set_word(to, 0, static_cast<std::uint64_t>(pile - root) / 8);
    pile += bytes;
    set_word(pile - 8 * record_end, 0, address);
    set_word(pile - 8 * record_end, 1, routine);
    set_word(pile - 8 * record_end, 2, static_cast<std::uint64_t>(top - bottom) / 16);
    return true;
}

bool Frames::push(std::byte* to, std::uint64_t routine) {
    return keep(to, routine, no_frame, code.routines[routine].frame);
}

bool Frames::save(std::byte* to, std::uint64_t routine, std::uint64_t address) {
    const CodeRoutine& method = code.routines[routine];
    if (!keep(to, routine, address, method.kept())) return false;
    std::byte* kept = place(word(to, 0));
    for (const auto& [first, end] : {method.variables, method.temporaries}) {
        copy_slots(kept, place(address + first), end - first);
        kept += 8 * std::size_t{end - first};
    }
    return true;
}

void Frames::swap() const {
    const std::uint64_t address = word(pile - 8 * record_end, 0);
    const CodeRoutine& method = code.routines[word(pile - 8 * record_end, 1)];
    std::byte* kept = pile - 8 * (record_end + method.kept());
    for (const auto& [first, end] : {method.variables, method.temporaries}) {
        const std::size_t bytes = 8 * std::size_t{end - first};
        std::swap_ranges(kept, kept + bytes, place(address + first));
        kept += bytes;
    }
}

void Frames::pop() {
    const std::byte* record = pile - 8 * record_end;
    const CodeRoutine& routine = code.routines[word(record, 1)];
    const bool has_own = word(record, 0) == no_frame;
    pile -= 8 * (record_end + (has_own ? routine.frame : routine.kept()));
}

void Frames::unwind(std::uint64_t running) {
    while (pile != pile_begin && word(pile - 8, 0) >= running) {
        if (word(pile - 8 * record_end, 0) != no_frame) swap();
        pop();
    }
}

void Frames::mark(std::uint64_t at, std::uint64_t frame, bool runs) const {
    std::byte* level = top;
    for (;;) {
        const auto routine = std::ranges::upper_bound(code.routines, at, {}, &CodeRoutine::end);
        if (routine->mark != 0) set_word(place(frame), routine->mark, runs);
        if (level == bottom) return;
        level -= 16;
        at = word(level, 0) - 1;
        frame = word(level, 1);
    }
}

Fault Frames::end(Fault fault, std::uint64_t at) const {
    set_word(root, error_slot, fault != Fault::none);
    set_word(root, error_id_slot, static_cast<std::uint64_t>(fault));
    if (fault == Fault::none) return fault;
    set_word(root, place_slot, at);
    set_word(root, depth_slot, static_cast<std::uint64_t>(top - bottom) / 16);
    if (code.has_kinds) mark(at, base, false);
    return fault;
}

std::optional<std::uint64_t> Frames::caught(Fault fault) {
    const bool is_caught =
        fault != Fault::none && fault != Fault::no_end && fault != Fault::assertion;
    if (!is_caught || code.handlers.empty()) return {};
    std::uint64_t at = word(root, place_slot), frame = base;
    for (std::byte* level = top;; level -= 16) {
        const auto it = std::ranges::find_if(
            code.handlers, [&](const Handler& h) { return at >= h.first && at < h.end; });
        if (it != code.handlers.end()) {
            top = level;
            base = frame;
            unwind(static_cast<std::uint64_t>(top - bottom) / 16);
            if (code.has_kinds) mark(at, base, true);
            return it->entry;
        }
        if (level == bottom) return {};
        at = word(level - 16, 0) - 1;
        frame = word(level - 16, 1);
    }
}

std::uint64_t Frames::exception() const {
    switch (static_cast<Fault>(word(root, error_id_slot))) {
        case Fault::array_bounds:
            return 0x101;  // RTSEXCPT_ARRAYBOUNDS
        case Fault::division_by_zero:
            return 0x102;  // RTSEXCPT_DIVIDEBYZERO
        case Fault::out_of_range:
            return 0x103;  // RTSEXCPT_OVERFLOW
        case Fault::runs_already:
        case Fault::calls_too_deep:
            return 0x54;  // RTSEXCPT_STACK_OVERFLOW
        default:
            return 0x51;  // RTSEXCPT_ACCESS_VIOLATION
    }
}

bool Frames::ends_at(std::uint64_t behind) const {
    if (!code.witness) return true;
    return code.witness->ends_at(behind - 1, base, static_cast<std::uint64_t>(top - bottom) / 16);
}

bool Frames::goes_on(const Piece& piece, const std::byte* reference, std::uint64_t next) const {
    const CodeRoutine& routine = code.routines[piece.routine];
    const std::byte* variable = place(word(reference, 0));
    std::uint64_t at = next - 1;
    const std::byte* frame = place(base);
    for (const std::byte* level = top;; level -= 16) {
        const bool is_its = at >= routine.entry && at < routine.end;
        if (is_its && frame + 8 * std::size_t{piece.slot} == variable)
            return word(frame, piece.activation) == word(reference, 2);
        if (level == bottom) return false;
        at = word(level - 16, 0) - 1;
        frame = place(word(level - 16, 1));
    }
}

Fault Frames::told(Fault fault, const std::byte* reference) const {
    if (fault == Fault::outside_of_variable || fault == Fault::call_has_ended)
        set_word(root, code.left_slot(), piece_of(reference));
    return fault;
}

Fault Frames::find(const std::byte* reference, std::uint64_t next, Bytes& found) const {
    const std::uint64_t number = piece_of(reference);
    if (number == 0) return Fault::no_reference;
    const Piece& piece = code.pieces[number - 1];
    if (piece.ends && !goes_on(piece, reference, next))
        return told(Fault::call_has_ended, reference);
    found = {piece.shape, place(word(reference, 0)), bytes_from_first(reference)};
    return Fault::none;
}

Fault Frames::reach(const std::byte* reference, std::uint32_t shape, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = find(reference, next, at); wrong != Fault::none) return wrong;
    const auto slot = slot_of(code, at.shape, 8 * at.first, shape);
    if (!slot) return told(Fault::outside_of_variable, reference);
    reached = word(reference, 0) + *slot;
    return Fault::none;
}

/// The slot of a value of that shape there, if there is one; else null: it is to be had by bytes.
static std::byte* slots_at(const Code& code, const Bytes& at, std::uint64_t bit,
                           std::uint32_t shape) {
    const auto slot = slot_of(code, at.shape, 8 * at.first + static_cast<std::int64_t>(bit), shape);
    return slot ? at.slots + 8 * *slot : nullptr;
}

Fault Frames::load_through(const std::byte* reference, std::uint64_t bit, std::uint32_t shape,
                           std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = find(reference, next, at); wrong != Fault::none) return wrong;
    if (const std::byte* slots = slots_at(code, at, bit, shape)) {
        reached = word(slots, 0);
        return Fault::none;
    }
    return told(load_value(code, at, bit, shape, reached), reference);
}

Fault Frames::store_through(const std::byte* reference, std::uint64_t bit, std::uint32_t shape,
                            std::uint64_t value, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = find(reference, next, at); wrong != Fault::none) return wrong;
    if (std::byte* slots = slots_at(code, at, bit, shape)) {
        set_word(slots, 0, value);
        return Fault::none;
    }
    return told(store_value(code, at, bit, shape, value), reference);
}

Fault Frames::load_text_through(const std::byte* reference, std::uint64_t bit, std::uint32_t shape,
                                std::uint64_t slots, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = find(reference, next, at); wrong != Fault::none) return wrong;
    at.first += static_cast<std::int64_t>(bit / 8);
    return told(load_text(code, at, shape, place(slots)), reference);
}

Fault Frames::store_text_through(const std::byte* reference, std::uint64_t bit, std::uint32_t shape,
                                 std::uint64_t slots, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = find(reference, next, at); wrong != Fault::none) return wrong;
    if (word(place(slots), 0) > code.shapes[shape].type->length) note_cut(next);
    at.first += static_cast<std::int64_t>(bit / 8);
    return told(store_text(code, at, shape, place(slots)), reference);
}

Fault Frames::copy_from_through(const std::byte* reference, std::uint64_t bit, std::uint32_t shape,
                                std::uint64_t slots, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = find(reference, next, at); wrong != Fault::none) return wrong;
    if (const std::byte* from = slots_at(code, at, bit, shape)) {
        copy_slots(place(slots), from, code.shapes[shape].slots);
        return Fault::none;
    }
    at.first += static_cast<std::int64_t>(bit / 8);
    const Bytes to{shape, place(slots), 0};
    return told(copy_bytes(code, to, at, code.shapes[shape].bits / 8), reference);
}

Fault Frames::copy_to_through(const std::byte* reference, std::uint64_t bit, std::uint32_t shape,
                              std::uint64_t slots, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = find(reference, next, at); wrong != Fault::none) return wrong;
    if (std::byte* to = slots_at(code, at, bit, shape)) {
        copy_slots(to, place(slots), code.shapes[shape].slots);
        return Fault::none;
    }
    at.first += static_cast<std::int64_t>(bit / 8);
    const Bytes from{shape, place(slots), 0};
    return told(copy_bytes(code, at, from, code.shapes[shape].bits / 8), reference);
}

Fault Frames::copy_memory(const std::byte* to, const std::byte* from, std::int64_t count,
                          std::uint64_t next) {
    if (count <= 0) return Fault::none;
    Bytes target, source;
    if (const Fault wrong = find(to, next, target); wrong != Fault::none) return wrong;
    if (const Fault wrong = find(from, next, source); wrong != Fault::none) return wrong;
    const auto bytes = static_cast<std::uint64_t>(count);
    const Fault wrong = copy_bytes(code, target, source, bytes);
    return told(wrong, is_inside(code, target, bytes) ? from : to);
}

Fault Frames::fill_memory(const std::byte* to, std::uint64_t value, std::int64_t count,
                          std::uint64_t next) {
    if (count <= 0) return Fault::none;
    Bytes target;
    if (const Fault wrong = find(to, next, target); wrong != Fault::none) return wrong;
    return told(
        fill_bytes(code, target, static_cast<std::byte>(value), static_cast<std::uint64_t>(count)),
        to);
}

Fault Frames::compare_memory(const std::byte* a, const std::byte* b, std::int64_t count,
                             std::uint64_t next) {
    reached = 0;
    if (count <= 0) return Fault::none;
    Bytes left, right;
    if (const Fault wrong = find(a, next, left); wrong != Fault::none) return wrong;
    if (const Fault wrong = find(b, next, right); wrong != Fault::none) return wrong;
    std::int64_t order = 0;
    const auto bytes = static_cast<std::uint64_t>(count);
    const Fault wrong = compare_bytes(code, left, right, bytes, order);
    reached = static_cast<std::uint64_t>(order);
    return told(wrong, is_inside(code, left, bytes) ? b : a);
}

}  // namespace lineshaft::st::meaning
