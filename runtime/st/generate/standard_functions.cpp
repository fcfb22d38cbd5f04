#include "runtime/st/generate/standard_functions.hpp"

#include <algorithm>

#include "runtime/st/functions/standard.hpp"
#include "runtime/st/generate/calls.hpp"
#include "runtime/st/generate/images.hpp"
#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/texts.hpp"
#include "runtime/st/generate/values.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;
using E = Expression::Kind;
using Mode = Location::Mode;

/// As the timer begins, but with the time that was given to it.
Slot reset_timer(Writing& w, const Expression& timer) {
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
    return none;
}

Slot extremum(Writing& w, const Expression& e, bool greatest, Slot wanted) {
    const Type& type = *e.type;
    const Op op = type.is_real()          ? (greatest ? Op::max_lreal : Op::min_lreal)
                  : type.is_unsigned_64() ? (greatest ? Op::max_unsigned : Op::min_unsigned)
                                          : (greatest ? Op::max_signed : Op::min_signed);
    Slot so_far = value_before(w, *e.arguments[0].value, e);
    for (std::size_t i = 1; i < e.arguments.size(); ++i) {
        const bool last = i + 1 == e.arguments.size();
        so_far = w.emit(op, last ? wanted : none, so_far, value(w, *e.arguments[i].value));
    }
    return so_far;
}

Slot value_or_address(Writing& w, const Expression& e, Slot wanted) {
    if (e.type->is_scalar()) return value(w, e, wanted);
    if (e.type->kind == Kind::text) return text_address(w, e);
    if (e.kind != E::call) return address_of(w, locate(w, e));
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

}  // namespace

Slot standard(Writing& w, const Expression& e, Slot wanted) {
    const StandardFunction& f = *e.standard;
    const auto argument = [&](std::size_t i) { return value_before(w, *e.arguments[i].value, e); };
    const Type& type = *e.type;
    const bool narrow = type.kind == Kind::real && type.bits == 32;
    const auto rounded = [&](Slot slot) {
        return narrow ? w.emit(Op::narrow, wanted, slot) : slot;
    };
    const Slot exact = narrow ? none : wanted;
    switch (f.rule) {
        case Rule::real:
            return rounded(w.emit(f.op, exact, argument(0)));
        case Rule::real_two: {
            const Slot a = argument(0), b = argument(1);
            return rounded(w.emit(f.op, exact, a, b));
        }
        case Rule::square: {
            const Slot a = argument(0);
            return w.emit(narrow ? Op::mul_real : Op::mul_lreal, wanted, a, a);
        }
        case Rule::fraction: {
            const Slot a = argument(0);
            return w.emit(Op::sub_lreal, wanted, a, w.emit(Op::truncate, none, a));
        }
        case Rule::whole:
            return w.emit(of_type(Op::round_sint, type), wanted, w.emit(f.op, none, argument(0)));
        case Rule::absolute: {
            if (type.is_real()) return w.emit(Op::abs_lreal, wanted, argument(0));
            if (!type.is_signed) return argument(0);
            const Slot a = w.emit(Op::abs_signed, none, argument(0));
            if (w.options.overflow_faults && type.kind == Kind::integer && type.bits < 64)
                return within(w, type, a);
            return w.emit(of_type(Op::wrap_sint, type), wanted, a);
        }
        case Rule::extremum:
            return extremum(w, e, f.op == Op::max_signed, wanted);
        case Rule::limit: {
            const Op least = type.is_real()          ? Op::min_lreal
                             : type.is_unsigned_64() ? Op::min_unsigned
                                                     : Op::min_signed;
            const Op greatest = type.is_real()          ? Op::max_lreal
                                : type.is_unsigned_64() ? Op::max_unsigned
                                                        : Op::max_signed;
            const Slot mn = argument(0), in = argument(1), mx = argument(2);
            return w.emit(least, wanted, w.emit(greatest, none, in, mn), mx);
        }
        case Rule::select: {
            const Slot second = argument(0), first = several(w, e, 1);
            return w.emit(Op::select, wanted, second, first);
        }
        case Rule::multiplex: {
            const Slot k = argument(0), first = several(w, e, 1);
            const std::uint64_t count = e.arguments.size() - 1;
            const bool has_else = same_name(e.arguments.back().name.text, "inelse");
            const Slot index = has_else
                                   ? w.emit(Op::min_unsigned, none, k, w.constant_slot(count - 1))
                                   : w.emit(Op::index, none, k, w.table({0, count, 1}));
            return w.emit(Op::load_at, wanted, first, index);
        }
        case Rule::shift: {
            int width = 0;
            while ((8 << width) < type.bits) ++width;
            const Op op = static_cast<Op>(static_cast<int>(f.op) + 4 * width);
            const Slot a = argument(0), n = argument(1);
            if (!type.is_signed) return w.emit(op, wanted, a, n);
            if (f.op == Op::shr_8) return w.emit(Op::shr_signed, wanted, a, n);
            const Type& bits = bits_type(type.bits);
            const Slot pattern = w.emit(of_type(Op::wrap_sint, bits), none, a);
            return w.emit(of_type(Op::wrap_sint, type), wanted, w.emit(op, none, pattern, n));
        }
        case Rule::normalise: {
            const Slot min = argument(0), in = argument(1), max = argument(2);
            w.land();  // MIN is read twice
            const Op sub = narrow ? Op::sub_real : Op::sub_lreal;
            const Slot above = w.emit(sub, none, in, min), range = w.emit(sub, none, max, min);
            return w.emit(narrow ? Op::div_real : Op::div_lreal, wanted, above, range);
        }
        case Rule::scale: {
            const Slot min = argument(0), in = argument(1), max = argument(2);
            w.land();  // MIN is read twice
            const Slot range = w.emit(narrow ? Op::sub_real : Op::sub_lreal, none, max, min);
            const Slot above = w.emit(narrow ? Op::mul_real : Op::mul_lreal, none, in, range);
            return w.emit(narrow ? Op::add_real : Op::add_lreal, wanted, above, min);
        }
        case Rule::length:
            return w.emit(Op::text_length, wanted, text_address(w, *e.arguments[0].value));
        case Rule::find: {
            const Slot in = text_address(w, *e.arguments[0].value);
            return w.emit(Op::text_find, wanted, in, text_address(w, *e.arguments[1].value));
        }
        case Rule::text:
            return text_address(w, e);
        case Rule::finite:
            return w.emit(Op::is_finite, wanted, argument(0));
        case Rule::valid_bcd:
            return w.emit(Op::is_bcd, wanted, argument(0));
        case Rule::time:
            return w.emit(Op::time_now, wanted, 0);
        case Rule::swap:
            return w.emit(Op::swap_bytes, wanted, argument(0), static_cast<Slot>(type.bits));
        case Rule::encode:
            return w.emit(Op::lowest_bit, wanted, argument(0));
        case Rule::decode: {
            const auto last = static_cast<std::uint64_t>(type.bits - 1);
            const Slot place = w.emit(Op::and_bits, none, argument(0), w.constant_slot(last));
            return w.emit(Op::shl_64, wanted, w.constant_slot(1), place);
        }
        case Rule::statement:
            return reset_timer(w, *e.arguments[0].value);
        case Rule::capacity: {
            const Expression& text = *e.arguments[0].value;
            return capacity_of(w, locate(w, text), *text.type);
        }
        case Rule::bound:
        case Rule::move:
        case Rule::operation:
            return value_or_address(w, *e.arguments[0].value, none);
    }
    return none;
}

}  // namespace lineshaft::st
