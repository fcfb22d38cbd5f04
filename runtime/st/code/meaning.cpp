#include "runtime/st/code/meaning.hpp"

#include <tuple>

#include "runtime/source/letters.hpp"
#include "runtime/st/code/addresses.hpp"
#include "runtime/st/code/bytes.hpp"
#include "runtime/st/code/code.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::st::meaning {

namespace {

ByteOfPiece byte_of_piece(const std::byte* reference) {
    return ByteOfPiece::of(word(reference, 1));
}

/// Whatever it is called: THIS of an instance is where the variable is that has it.
auto where(const std::byte* reference) {
    return std::pair(word(reference, 0), byte_of_piece(reference).byte);
}

static_assert(sizeof(Frames::Record) == 8 * record_end);
constexpr std::uint64_t no_frame = ~std::uint64_t{0};

}  // namespace

std::uint64_t left_in_64(double value) {
    value = std::nearbyint(value);
    if (fits<std::int64_t>(value)) return whole<std::int64_t>(value);
    if (value > 0.0 && value < 0x1p64) return static_cast<std::uint64_t>(value);
    return std::uint64_t{1} << 63;
}

static constexpr std::uint64_t least_of_32 = 0xFFFF'FFFF'8000'0000;

std::uint64_t left_in_32(double value) {
    value = std::nearbyint(value);
    if (value < -0x1p31) return least_of_32;
    return fits<std::int64_t>(value) ? whole<std::int64_t>(value) : 0;
}

std::uint64_t truncated_in_32(double value) {
    value = std::trunc(value);
    return fits<std::int32_t>(value) ? whole<std::int32_t>(value) : least_of_32;
}

std::uint64_t truth_of_text(const std::byte* from, bool is_strict) {
    const auto is_letter = [](char a, char b) { return upper(a) == b; };
    std::string_view text = text_at(from);
    if (is_strict) {
        text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
        return text.starts_with("TRUE") || text.starts_with("true") ? 1 : 0;
    }
    return text == "1" || std::ranges::equal(text, std::string_view("TRUE"), is_letter) ? 1 : 0;
}

static void write_text(std::byte* to, std::string_view text) {
    std::memcpy(to + 8, text.data(), text.size());
    set_word(to, 0, text.size());
}

void write_truth(std::byte* to, bool value) {
    write_text(to, value ? "TRUE" : "FALSE");
}

void write_time(std::byte* to, std::uint32_t text, std::int64_t value) {
    const auto [kind, form, is_unsigned] = TimeText::of_number(text);
    fmt::memory_buffer made;
    add_time(made, kind, is_unsigned ? Wide{static_cast<std::uint64_t>(value)} : value, form);
    write_text(to, {made.data(), made.size()});
}

void write_bits(std::byte* to, std::uint64_t value) {
    write_text(to, fmt::format("16#{:x}", value));
}

void write_ten_digits(std::byte* to, double value) {
    write_text(to, fmt::format("{:.10g}", value));
}

void write_time_in_parts(std::byte* to, std::int64_t value) {
    constexpr std::int64_t second = 1'000'000'000, minute = 60 * second, hour = 60 * minute,
                           day = 24 * hour;
    std::string text = fmt::format("T#{}d", value / day);
    const auto add = [&](std::int64_t whole, std::int64_t unit, std::string_view name) {
        if (value % whole != 0) text += fmt::format("{}{}", value % whole / unit, name);
    };
    add(day, hour, "h");
    add(hour, minute, "m");
    add(minute, second, "s");
    if (value % second != 0)
        text += fmt::format("{:g}ms", static_cast<double>(value % second) / 1e6);
    write_text(to, text);
}

std::int64_t time_of_text(std::uint64_t kind, const std::byte* from) {
    std::string_view text = text_at(from);
    text.remove_prefix(text.find('#') + 1);  // 0 without one
    return static_cast<std::int64_t>(read_time(text, static_cast<Type::Kind>(kind)).value_or(0));
}

bool move_reference(std::byte* to, const std::byte* from, std::int64_t by) {
    ByteOfPiece moved = byte_of_piece(from);
    if (__builtin_add_overflow(std::int64_t{moved.byte}, by, &moved.byte)) return false;
    const std::uint64_t address = word(from, 0), call = word(from, 2);
    set_word(to, 0, address);
    set_word(to, 1, moved.word());
    set_word(to, 2, call);
    return true;
}

std::int64_t compare_references(const std::byte* a, const std::byte* b) {
    const auto order = where(a) <=> where(b);
    return order < 0 ? -1 : order > 0;
}

std::optional<std::int64_t> reference_distance(const std::byte* a, const std::byte* b) {
    const ByteOfPiece of_a = byte_of_piece(a), of_b = byte_of_piece(b);
    if (word(a, 0) != word(b, 0) || of_a.piece != of_b.piece) return {};
    return std::int64_t{of_a.byte} - of_b.byte;
}

bool Frames::find(std::byte* to, std::uint64_t address, std::uint32_t method) const {
    const std::uint64_t kind = word(place(address), code.kind_slot());
    const FoundRoutine& found = code.found[kind * code.methods + method];
    set_word(to, 0, found.routine);
    set_word(to, 1, address + found.first);
    return has_room(found.depth);
}

bool Frames::has(std::uint64_t address, std::uint32_t method) const {
    return code.found[word(place(address), code.kind_slot()) * code.methods + method].first != 0;
}

bool Frames::has_room(std::uint32_t depth) const {
    return running() + 1 + depth <= scanned.levels;
}

std::byte* Frames::pile_begin() const {
    return root + 8 * std::size_t{scanned.pile.first};
}

bool Frames::keep(const Record& record) {
    const std::uint64_t bytes = 8 * record.slots + sizeof record;
    if (bytes > static_cast<std::uint64_t>(root + 8 * std::size_t{scanned.pile.end} - pile))
        return false;
    pile += bytes;
    std::memcpy(pile - sizeof record, &record, sizeof record);
    return true;
}

Frames::Record Frames::last_record() const {
    Record record;
    std::memcpy(&record, pile - sizeof record, sizeof record);
    return record;
}

std::byte* Frames::kept_by(const Record& record) const {
    return pile - sizeof record - 8 * record.slots;
}

/// Each part of a frame that is kept, with the place where.
static void each_kept(const CodeRoutine& routine, std::byte* frame, std::byte* kept, auto&& each) {
    for (const auto& [first, end] : {routine.variables, routine.temporaries}) {
        each(frame + 8 * std::size_t{first}, kept, 8 * std::size_t{end - first});
        kept += 8 * std::size_t{end - first};
    }
}

static void exchange(std::byte* in_frame, std::byte* kept, std::size_t bytes) {
    std::swap_ranges(kept, kept + bytes, in_frame);
}

bool Frames::push(std::byte* to, std::uint64_t routine) {
    if (!has_room(code.routines[routine].depth) ||
        !keep({code.routines[routine].frame, no_frame, routine, running()}))
        return false;
    set_word(to, 0, static_cast<std::uint64_t>(kept_by(last_record()) - root) / 8);
    return true;
}

Fault Frames::save(std::uint64_t routine, std::uint64_t address) {
    const CodeRoutine& called = code.routines[routine];
    std::byte* frame = place(address);
    const bool runs = called.mark == 0 ? called.kept() != 0 : word(frame, called.mark) != 0;
    const bool is_kept = (!runs || has_room(called.depth)) &&
                         keep({runs ? called.kept() : 0, address, routine, running()});
    if (!is_kept) return Fault::calls_too_deep;
    if (!runs) return Fault::none;
    if (called.holds_instance) return Fault::runs_already;
    if (called.mark != 0) set_word(frame, called.mark, 0);
    each_kept(called, frame, kept_by(last_record()),
              [](const std::byte* in_frame, std::byte* kept, std::size_t bytes) {
                  std::memcpy(kept, in_frame, bytes);
              });
    return Fault::none;
}

std::uint64_t Frames::lent(std::uint64_t address) const {
    const Record record = last_record();
    if (record.slots == 0) return address;
    std::uint64_t found = address;
    const auto number = [](const std::byte* at) { return reinterpret_cast<std::uintptr_t>(at); };
    each_kept(code.routines[record.routine], place(record.address), kept_by(record),
              [&](const std::byte* in_frame, const std::byte* kept, std::size_t bytes) {
                  const std::uintptr_t behind = number(place(address)) - number(in_frame);
                  if (behind < bytes)
                      found = (static_cast<std::uint64_t>(kept - root) + behind) / 8;
              });
    return found;
}

std::uint64_t Frames::swap() const {
    const Record record = last_record();
    const CodeRoutine& called = code.routines[record.routine];
    if (record.slots == 0) return record.address + called.variables.first;
    std::byte* frame = place(record.address);
    each_kept(called, frame, kept_by(record), exchange);
    if (called.mark != 0) set_word(frame, called.mark, 1);
    return static_cast<std::uint64_t>(kept_by(record) - root) / 8;
}

void Frames::pop() {
    pile = kept_by(last_record());
}

void Frames::unwind(std::uint64_t calls) {
    for (; pile != pile_begin() && last_record().running >= calls; pop()) {
        const Record record = last_record();
        const CodeRoutine& called = code.routines[record.routine];
        if (record.slots == 0 || record.address == no_frame) continue;
        std::byte* frame = place(record.address);
        each_kept(called, frame, kept_by(record), exchange);
        if (called.mark != 0) set_word(frame, called.mark, 0);
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
    const EndOfScan here{static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(running()),
                         base};
    set_word(root, place_slot, here.place_word());
    set_word(root, depth_slot, here.depth_word());
    if (code.has_kinds) mark(at, base, false);
    return fault;
}

std::optional<std::uint64_t> Frames::caught(Fault fault) {
    const bool is_caught =
        fault != Fault::none && fault != Fault::no_end && fault != Fault::assertion;
    if (!is_caught || code.handlers.empty()) return {};
    std::uint64_t frame = base;
    std::uint64_t at = EndOfScan::of(word(root, place_slot), word(root, depth_slot)).instruction;
    for (std::byte* level = top;; level -= 16) {
        const auto it = std::ranges::find_if(
            code.handlers, [&](const Handler& h) { return at >= h.first && at < h.end; });
        if (it != code.handlers.end()) {
            top = level;
            base = frame;
            unwind(running());
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

bool Frames::advance(std::int64_t by, std::int64_t interval) const {
    return code.witness && code.witness->let_pass(by, interval);
}

bool Frames::ends_at(std::uint64_t behind) const {
    if (!code.witness) return true;
    return code.witness->ends_at(behind - 1, base, running());
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
        set_word(root, code.left_slot(), byte_of_piece(reference).piece);
    return fault;
}

Fault Frames::find(const std::byte* reference, std::uint64_t next, Bytes& found) const {
    const ByteOfPiece to = byte_of_piece(reference);
    if (to.piece == 0) return Fault::no_reference;
    const Piece& piece = code.pieces[to.piece - 1];
    if (piece.ends && !goes_on(piece, reference, next))
        return told(Fault::call_has_ended, reference);
    found = {piece.shape, place(word(reference, 0)), to.byte};
    return Fault::none;
}

bool Frames::number(const std::byte* reference, std::uint64_t known, std::uint64_t numbers) {
    const auto found = number_of_reference(code, reference, {place(known), place(numbers)});
    reached = found.value_or(0);
    return found.has_value();
}

void Frames::find_number(std::byte* reference, std::uint64_t number, std::uint64_t known,
                         std::uint64_t numbers) const {
    find_reference(code, number, {place(known), place(numbers)}, reference);
}

Fault Frames::reach(const std::byte* reference, std::uint32_t shape, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = find(reference, next, at); wrong != Fault::none) return wrong;
    const auto slot = slot_of(code, at.shape, 8 * at.first, shape);
    if (!slot) return told(Fault::outside_of_variable, reference);
    reached = word(reference, 0) + *slot;
    return Fault::none;
}

}  // namespace lineshaft::st::meaning
