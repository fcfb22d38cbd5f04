#include <vector>

#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

const Dialect& dialect_of(const Emission& e) {
    return e.call.place.dialect();
}

/// A text that is put together from parts of others. What is given is computed before it begins.
struct Parts {
    explicit Parts(Emission& emission) : e(emission) {}

    Slot sum(Slot a, Slot b) const { return e.emit(Op::add_lint, a, b); }
    Slot difference(Slot a, Slot b) const { return e.emit(Op::sub_lint, a, b); }
    /// There is nothing to give where a number is not above `limit`.
    void need_above(std::int64_t limit, Slot number) {
        const Slot holds =
            e.emit(Op::lt_signed, e.constant(static_cast<std::uint64_t>(limit)), number);
        most = e.emit(Op::mul_lint, most, holds);
    }
    /// In SCL.
    void expect_above(std::int64_t limit, Slot number) {
        if (dialect.negative_counts_clear) need_above(limit, number);
    }
    void begin() { made = e.new_text(); }
    void append(Slot from, Slot first, Slot count) const {
        if (most != all) count = e.emit(Op::min_signed, count, most);
        e.append(made, from, first, count);
    }

    Emission& e;
    const Dialect& dialect = dialect_of(e);
    Slot zero = e.constant(0), one = e.constant(1), all = e.constant(1U << 30), most = all;
    Slot in = e.text(0);
    Slot made = 0;
};

/// CODESYS: what is given to LEN is a STRING(255).
Slot emit_length(Emission& e) {
    const Slot text = e.text(0);
    if (!dialect_of(e).texts_have_255) return e.result(Op::text_length, text, e.is_wide());
    const Slot length = e.emit(Op::text_length, text, e.is_wide());
    return e.result(Op::min_signed, length, e.constant(255));
}

Slot emit_concatenate(Emission& e) {
    Parts parts(e);
    std::vector<Slot> given{parts.in};
    for (std::size_t i = 1; i < e.count(); ++i) given.push_back(e.text(i));
    parts.begin();
    for (const Slot text : given) parts.append(text, parts.zero, parts.all);
    return parts.made;
}

Slot emit_left(Emission& e) {
    Parts parts(e);
    const Slot count = e.value(1);
    parts.begin();
    parts.append(parts.in, parts.zero, count);
    return parts.made;
}

Slot emit_right(Emission& e) {
    Parts parts(e);
    const Slot count = e.value(1);
    parts.begin();
    const Slot length = e.emit(Op::text_length, parts.in, e.is_wide());
    parts.append(parts.in, parts.difference(length, count), count);
    return parts.made;
}

Slot emit_middle(Emission& e) {
    Parts parts(e);
    const Slot count = e.value(1), place = e.value(2);
    if (parts.dialect.middle_begins_at_one) parts.need_above(0, place);
    parts.begin();
    parts.append(parts.in, parts.difference(place, parts.one), count);
    return parts.made;
}

Slot emit_delete(Emission& e) {
    Parts parts(e);
    const Slot count = e.value(1), before = parts.difference(e.value(2), parts.one);
    parts.expect_above(-1, count);
    parts.expect_above(-1, before);
    parts.begin();
    parts.append(parts.in, parts.zero, before);
    parts.append(parts.in, parts.sum(before, count), parts.all);
    return parts.made;
}

/// `all` characters that CODESYS puts behind the first `before`; 0 where there are not so many, or
/// not more.
Slot taken_by_codesys(Parts& parts, Slot before, Op is_within) {
    if (!parts.dialect.inserts_within_text) return parts.all;
    Emission& e = parts.e;
    const Slot length = e.emit(Op::text_length, parts.in, e.is_wide());
    return e.emit(Op::mul_lint, parts.all, e.emit(is_within, before, length));
}

/// `taken` of `other`'s characters.
Slot emit_replaced(Parts& parts, Slot other, Slot before, Slot count, Slot taken) {
    parts.expect_above(-1, count);
    parts.expect_above(-1, before);
    parts.begin();
    parts.append(parts.in, parts.zero, before);
    parts.append(other, parts.zero, taken);
    parts.append(parts.in, parts.sum(before, count), parts.all);
    return parts.made;
}

Slot emit_insert(Emission& e) {
    Parts parts(e);
    const Slot other = e.text(1), before = e.value(2);
    Slot taken = taken_by_codesys(parts, before, Op::le_signed);
    if (parts.dialect.inserts_within_text)
        taken = e.emit(Op::mul_lint, taken, e.emit(Op::le_signed, parts.zero, before));
    return emit_replaced(parts, other, before, parts.zero, taken);
}

Slot emit_replace(Emission& e) {
    Parts parts(e);
    const Slot other = e.text(1), count = e.value(2);
    const Slot before = parts.difference(e.value(3), parts.one);
    const bool is_in_c = dialect_of(e).functions_are_in_c;
    const Slot taken = is_in_c ? count : taken_by_codesys(parts, before, Op::lt_signed);
    return emit_replaced(parts, other, before, count, taken);
}

Slot emit_find(Emission& e) {
    const Slot in = e.text(0);
    const Slot what = e.text(1);
    if (dialect_of(e).functions_are_in_c && !e.is_wide())
        return e.result(Op::matiec_text_find, in, what);
    const Slot found = e.wanted_slot();
    e.put(Op::text_find, found, in, what, e.is_wide());
    return found;
}

// clang-format off
/// Characters are counted from 1. A text that is made has at most 254, of CODESYS and
/// TwinCAT 255. In SCL MID, DELETE, INSERT and REPLACE give an empty text if P is 0 (INSERT: below
/// 0) or below, or L is below 0, as TIA Portal's help says. In CODESYS MID does if P is 0 or below;
/// INSERT leaves the text as it is if P is below 0 or behind its end, REPLACE if P is behind that.
constexpr StandardFunction texts[] = {
    {"LEN(IN: STRING): INT", "how many characters the text has", Typing::texts,
     emit_length},
    {"MAX_LEN(IN: STRING): INT", "how many characters the variable can hold", Typing::capacity,
     [](Emission& e) { return e.capacity(0); }},
    {"FIND(IN1, IN2: STRING): INT", "where IN2 begins in IN1 for the first time, from 1 on; 0 if it does not; MatIEC goes on behind what differs, and does not find 'ab' in 'aab'",
     Typing::texts, emit_find},
    {"CONCAT(IN1, IN2, ...: STRING): STRING", "the texts one behind the other", Typing::texts, emit_concatenate},
    {"LEFT(IN: STRING; L: ANY_INT): STRING", "the first L characters", Typing::texts, emit_left},
    {"RIGHT(IN: STRING; L: ANY_INT): STRING", "the last L characters", Typing::texts, emit_right},
    {"MID(IN: STRING; L, P: ANY_INT): STRING", "L characters from the one at P on", Typing::texts, emit_middle},
    {"DELETE(IN: STRING; L, P: ANY_INT): STRING", "IN without L characters from the one at P on",
     Typing::texts, emit_delete},
    {"INSERT(IN1, IN2: STRING; P: ANY_INT): STRING", "IN1 with IN2 behind the character at P",
     Typing::texts, emit_insert},
    {"REPLACE(IN1, IN2: STRING; L, P: ANY_INT): STRING",
     "IN1 with IN2 in place of L characters from the one at P on; in MatIEC with at most L of IN2",
     Typing::texts, emit_replace},
    {"S_CONV(IN: ANY_ELEMENTARY): ANY_ELEMENTARY", "IN as what is wanted, as STRING_TO_INT(IN) and INT_TO_STRING(IN) give it",
     Typing::wanted, nullptr},
};
// clang-format on

}  // namespace

constinit const Subject text_functions{"texts", texts};

}  // namespace lineshaft::st
