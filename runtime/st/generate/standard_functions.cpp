#include <algorithm>

#include "runtime/st/functions/standard.hpp"
#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/values.hpp"

namespace lineshaft::st {

namespace {

/// As the timer begins, but with the time that was given to it.
void reset_timer(Writing& w, const Expression& timer) {
    const Type& type = *timer.type;
    const std::uint32_t slots = slots_of(w, type);
    if (w.images[&type].empty()) {
        Writing::Image fresh(slots, 0);
        fill_default(w, fresh, 0, type);
        w.images[&type] = std::move(fresh);
    }
    const Slot made = w.new_temporary(slots);
    w.image_uses.push_back({w.next(), &type, nullptr});
    w.put(Op::initialise, made, 0, slots);
    Location at = locate(w, timer);
    if (at.mode == Mode::indexed) at = as_address(w, at);
    const auto keep = [&](const Variable& member) {
        if (same_name(member.text, "pt"))
            w.put(Op::move, made + member.slot, load(w, part(w, at, member)));
    };
    for (const Variable* member : type.members) keep(*member);
    if (type.kind == Kind::block) std::ranges::for_each(type.routine->variables, keep);
    copy(w, at, {Mode::slot, made}, slots - (w.has_tests && type.kind == Kind::standard ? 1 : 0));
}

Slot value_or_address(Writing& w, const Expression& e, Slot wanted = none) {
    if (e.type->is_scalar()) return value(w, e, wanted);
    if (e.type->kind == Kind::text) return text_address(w, e);
    if (e.type->is_reference()) return address_of(w, {Mode::slot, reference(w, e)});
    if (e.kind != E::call) {
        const Location at = locate(w, e);
        return address_of(w, at.packed ? unpacked(w, at, *e.type) : at);
    }
    return e.routine ? w.emit(Op::set_address, none, call(w, e, none)) : standard(w, e, none);
}

/// The values of the arguments from `first` on, one behind the other; of texts, arrays and
/// structures their addresses.
Slot several(Writing& w, const Expression& e, std::size_t first) {
    const auto count = static_cast<std::uint32_t>(e.arguments.size() - first);
    const Slot slots = w.new_temporary(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Slot from = value_or_address(w, *e.arguments[first + i].value, slots + i);
        if (from != slots + i) w.put(Op::move, slots + i, from);
    }
    return slots;
}

struct Call : Emission {
    Call(Writing& writing, const Expression& e, Slot to) : Emission(e), w(writing), wanted(to) {}

    Slot emit(Op op, Slot b, Slot c) override { return w.emit(op, none, b, c); }
    Slot result(Op op, Slot b, Slot c) override { return w.emit(op, wanted, b, c); }
    Slot wanted_slot() override { return w.result(wanted); }
    Slot value(std::size_t i) override { return value_before(w, given(i), call); }
    Slot text(std::size_t i) override { return text_before(w, given(i), call); }
    Slot value_or_address(std::size_t i) override { return st::value_or_address(w, given(i)); }
    Slot several(std::size_t first) override { return st::several(w, call, first); }
    Slot capacity(std::size_t i) override {
        const Slot room = capacity_of(w, locate(w, given(i)), *given(i).type);
        const std::uint32_t most = ~TextRoom(0, true).number();
        return w.emit(Op::and_bits, wanted, room, w.constant_slot(most));
    }
    Slot reference(std::size_t i) override { return st::reference(w, given(i)); }
    Slot moved(Slot reference, Slot bytes) override {
        const Slot made = w.new_temporary(reference_slots);
        w.put(Op::move_reference, made, reference, bytes);
        return w.emit(Op::set_address, none, made);
    }
    void put(Op op, Slot a, Slot b, Slot c, Slot d) override { w.put(op, a, b, c, d); }
    Slot constant(std::uint64_t bits) override { return w.constant_slot(bits); }
    void land() override { w.land(); }
    Slot index(Slot slot, std::uint64_t count) override {
        return w.emit(Op::index, none, slot, w.table({0, count, 1}));
    }
    Slot fitted(Slot slot) override {
        const bool faults =
            w.options.overflow_faults && type().kind == Kind::integer && type().bits < 64;
        return faults ? within(w, type(), slot) : result(of_type(Op::wrap_sint, type()), slot, 0);
    }
    Slot new_text() override { return st::new_text(w, is_wide()).address; }
    void append(Slot to, Slot from, Slot first, Slot count) override {
        const Slot range = w.new_temporary(2);
        w.put(Op::move, range, first);
        w.put(Op::move, range + 1, count);
        const bool has_255 = call.place.dialect().texts_have_255;
        const auto most =
            static_cast<std::uint32_t>(has_255 ? longest_result_of_codesys : longest_result);
        w.put(Op::text_append, to, from, range, TextRoom(most, is_wide()).number());
    }
    void reset_timer(std::size_t i) override { st::reset_timer(w, given(i)); }

    Writing& w;
    Slot wanted;
};

/// It may be read whether or not it is wanted.
bool is_at_hand(const Expression& e) {
    using E = Expression::Kind;
    return e.kind == E::constant || e.kind == E::name || e.kind == E::self ||
           (e.kind == E::member && is_at_hand(*e.operands[0]));
}

bool chooses(const Expression& e) {
    return e.standard->typing == Typing::chosen &&
           !std::ranges::all_of(e.arguments, is_at_hand,
                                [](const Argument& a) -> const Expression& { return *a.value; });
}

/// SEL and MUX, of whose arguments one is evaluated.
Slot choose(Writing& w, Call& call) {
    const std::size_t count = call.count() - 1;
    const bool by_truth = call.given(0).type->kind == Kind::boolean;
    const Slot to = w.new_temporary(), given = value_before(w, call.given(0), call.call);
    const Slot number = by_truth || call.call.has_else ? given : call.index(given, count);
    Jumps ends;
    for (std::size_t i = 1; i <= count; ++i) {
        Jumps next;
        if (i < count && by_truth) w.jump(Op::jump_if, 0, number, next);
        if (i < count && !by_truth)
            w.jump(after(comparison_op(Word::equal, lint_type), 2), number, w.constant_slot(i - 1),
                   next);
        const Slot from = value_or_address(w, call.given(i), to);
        if (from != to) w.put(Op::move, to, from);
        if (i < count) w.jump(Op::jump, 0, 0, ends);
        w.land(next);
    }
    w.land(ends);
    return to;
}

}  // namespace

Slot standard(Writing& w, const Expression& e, Slot wanted) {
    Call call(w, e, wanted);
    return chooses(e) ? choose(w, call) : e.standard->emit(call);
}

}  // namespace lineshaft::st
