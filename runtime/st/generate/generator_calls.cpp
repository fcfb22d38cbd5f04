#include <algorithm>

#include "runtime/st/generate/generator_class.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;
using E = Expression::Kind;
using Mode = Location::Mode;

/// A test sets an output or a local by its name.
bool is_set(const Argument& argument) {
    return argument.name.word != Word::end_of_file && !argument.is_output;
}

}  // namespace

Slot Generator::call(const Expression& e, Slot wanted) {
    if (!e.routine) return standard(e, wanted);
    const Location frame = call_routine(e);
    const Routine& routine = *e.routine;
    const Type& type = *routine.result->type;
    const std::uint32_t slots = slots_of(type);
    if (routine.is_function()) {
        const Slot from = frame.slot + routine.result->slot;
        const Slot to = slots == 1 ? result(wanted) : new_temporary(slots);
        if (slots == 1)
            put(Op::move, to, from);
        else
            put(Op::copy, to, from, slots);
        return to;
    }
    const Location from = part(method_base(e), *routine.result);
    const Slot to = slots == 1 ? result(wanted) : new_temporary(slots);
    if (slots == 1)
        store({Mode::slot, to}, load(from, to));
    else
        copy({Mode::slot, to}, from, slots);
    return to;
}

/// The instance that a method works on.
Location Generator::method_base(const Expression& e) {
    const Expression& callee = *e.operands[0];
    if (callee.kind == E::member) return locate(*callee.operands[0]);
    return {Mode::slot, 0};
}

/// A call whose arguments call functions themselves has them first, for they use the same memory;
/// where the places of outputs do, what the function has made is kept from them.
Location Generator::call_routine(const Expression& e) {
    const Routine& routine = *e.routine;
    const bool is_function = routine.is_function();
    Location frame = is_function ? Location{Mode::slot, Region::window} : method_base(e);
    if (frame.mode == Mode::indexed) frame = as_address(frame);
    give(frame, e, routine);
    place_ = e.place;
    if (frame.mode == Mode::slot)
        put(Op::call, frame.slot, routine_number(routine));
    else
        put(Op::call_at, address_of(frame), routine_number(routine));
    if (is_function) windows_ = std::max(windows_, routine.frame);
    const auto is_called_for = [](const Argument& a) {
        return (a.is_output || a.variable->section == Section::output) && has_call(*a.value);
    };
    if (is_function && std::ranges::any_of(e.arguments, is_called_for)) {
        frame.slot = new_temporary(routine.variables_end);
        put(Op::copy, frame.slot, Region::window, routine.variables_end);
    }
    take(frame, e);
    return frame;
}

std::uint32_t Generator::standard_number(const BlockType& kind) {
    const auto [it, added] =
        standard_numbers_.emplace(&kind, static_cast<std::uint32_t>(code_.standard.size()));
    if (added) code_.standard.push_back(&kind);
    return it->second;
}

void Generator::call_instance(const Expression& e) {
    const Expression& callee = *e.operands[0];
    const Type& type = *callee.type;
    Location frame = locate(callee);
    if (frame.mode == Mode::indexed) frame = as_address(frame);
    if (type.kind == Kind::block) {
        const Routine& routine = *type.routine;
        give(frame, e, routine);
        place_ = e.place;
        if (frame.mode == Mode::slot)
            put(Op::call, frame.slot, routine_number(routine));
        else
            put(Op::call_at, address_of(frame), routine_number(routine));
        return take(frame, e);
    }
    for (const Argument& argument : e.arguments)
        if (argument.variable->section != Section::output || is_set(argument))
            assign(part(frame, *argument.variable), *argument.variable->type, *argument.value);
    const std::uint32_t number = standard_number(*type.standard);
    place_ = e.place;
    std::vector<std::uint32_t> runs, mocked;
    if (has_tests_) {
        count_call(part(frame, type.slots - 1), runs);
        jump(Op::jump, 0, 0, mocked);
        land(runs);
    }
    if (frame.mode == Mode::slot)
        put(Op::call_block, frame.slot, number);
    else
        put(Op::call_block_at, address_of(frame), number);
    land(mocked);
    take(frame, e);
}

/// Inputs and references, and what is left out.
void Generator::give(const Location& frame, const Expression& e, const Routine& routine) {
    const auto is_given = [](const Argument& argument) {
        const Section section = argument.variable->section;
        return !argument.is_left_out &&
               (section == Section::input || section == Section::in_out || is_set(argument));
    };
    give_left_out(frame, e);
    const bool nested = std::ranges::any_of(
        e.arguments, [&](const Argument& a) { return is_given(a) && has_call(*a.value); });
    std::vector<Later> later;
    for (const Argument& argument : e.arguments) {
        if (!is_given(argument)) continue;
        const Variable& variable = *argument.variable;
        const Type& type = *variable.type;
        const Location to = part(frame, variable.slot);
        if (variable.space == Space::reference) {
            refer(to, variable, *argument.value, later);
        } else if (!nested) {
            assign(to, type, *argument.value);
        } else if (type.is_scalar()) {
            later.push_back({to, new_temporary()});
            value_to(*argument.value, later.back().slot);
        } else {
            const std::uint32_t slots = slots_of(type);
            later.push_back({to, new_temporary(slots), slots});
            assign({Mode::slot, later.back().slot}, type, *argument.value);
        }
    }
    for (const Later& value : later) {
        if (value.slots > 0)
            copy(value.to, {Mode::slot, value.slot}, value.slots);
        else
            store(value.to, value.slot);
    }
    if (routine.has_instances()) return;
    for (const Variable& variable : routine.variables) {
        const bool missing = variable.section == Section::input &&
                             std::ranges::none_of(e.arguments, [&](const Argument& argument) {
                                 return argument.variable == &variable;
                             });
        if (!missing || variable.space == Space::none) continue;
        const std::uint32_t slots = slots_of(*variable.type);
        const Type* block = routine.owner ? routine.owner->type : nullptr;
        const Slot made =
            frame.mode == Mode::slot ? frame.slot + variable.slot : new_temporary(slots);
        image_uses_.push_back({next(), block, &routine});
        put(Op::initialise, made, variable.slot, slots);
        if (frame.mode != Mode::slot) copy(part(frame, variable.slot), {Mode::slot, made}, slots);
    }
}

/// Where the value of a VAR_IN_OUT is, and what it holds if any length may be given.
void Generator::refer(const Location& to, const Variable& variable, const Expression& value,
                      std::vector<Later>& later) {
    const Location at = locate(value);
    later.push_back({to, address_of(at)});
    if (variable.type->is_open) later.push_back({part(to, 1), capacity_of(at, *value.type)});
}

void Generator::give_left_out(const Location& frame, const Expression& e) {
    for (const Argument& argument : e.arguments) {
        if (!argument.is_left_out) continue;
        const Location reference = part(frame, argument.variable->slot);
        std::vector<std::uint32_t> given;
        jump(Op::jump_if, 0, load(reference), given);
        std::vector<Later> later;
        refer(reference, *argument.variable, *argument.value, later);
        for (const Later& value : later) store(value.to, value.slot);
        land(given);
    }
}

/// Outputs.
void Generator::take(const Location& frame, const Expression& e) {
    for (const Argument& argument : e.arguments) {
        const Variable& variable = *argument.variable;
        const bool is_taken = argument.is_output || variable.section == Section::output;
        if (!is_taken || is_set(argument)) continue;
        const Location from = part(frame, variable);
        const Type &given = *variable.type, &wanted = *argument.value->type;
        if (argument.value->kind == E::bit) {
            store_bits(*argument.value, convert(load(from), given, wanted, false, none));
            continue;
        }
        const Location to = locate(*argument.value);
        if (given.kind == Kind::text)
            put(Op::text_copy, address_of(to), address_of(from), capacity_of(to, wanted));
        else if (!given.is_scalar())
            copy(to, from, slots_of(given));
        else
            store(to, convert(load(from), given, wanted, false, none));
    }
}

// Standard functions.

Slot Generator::standard(const Expression& e, Slot wanted) {
    const StandardFunction& f = standard_functions()[static_cast<std::size_t>(e.standard)];
    const auto argument = [&](std::size_t i) { return value_before(*e.arguments[i].value, e); };
    const Type& type = *e.type;
    const bool narrow = type.kind == Kind::real && type.bits == 32;
    const auto rounded = [&](Slot slot) { return narrow ? emit(Op::narrow, wanted, slot) : slot; };
    const Slot exact = narrow ? none : wanted;
    switch (f.rule) {
        case Rule::real:
            return rounded(emit(f.op, exact, argument(0)));
        case Rule::real_two: {
            const Slot a = argument(0), b = argument(1);
            return rounded(emit(f.op, exact, a, b));
        }
        case Rule::square: {
            const Slot a = argument(0);
            return emit(narrow ? Op::mul_real : Op::mul_lreal, wanted, a, a);
        }
        case Rule::fraction: {
            const Slot a = argument(0);
            return emit(Op::sub_lreal, wanted, a, emit(Op::truncate, none, a));
        }
        case Rule::whole:
            return emit(of_type(Op::round_sint, type), wanted, emit(f.op, none, argument(0)));
        case Rule::absolute: {
            if (type.is_real()) return emit(Op::abs_lreal, wanted, argument(0));
            if (!type.is_signed) return argument(0);
            const Slot a = emit(Op::abs_signed, none, argument(0));
            if (options_.overflow_faults && type.kind == Kind::integer && type.bits < 64)
                return within(type, a);
            return emit(of_type(Op::wrap_sint, type), wanted, a);
        }
        case Rule::extremum:
            return extremum(e, f.op == Op::max_signed, wanted);
        case Rule::limit: {
            const Op least = type.is_real()          ? Op::min_lreal
                             : type.is_unsigned_64() ? Op::min_unsigned
                                                     : Op::min_signed;
            const Op greatest = type.is_real()          ? Op::max_lreal
                                : type.is_unsigned_64() ? Op::max_unsigned
                                                        : Op::max_signed;
            const Slot mn = argument(0), in = argument(1), mx = argument(2);
            return emit(least, wanted, emit(greatest, none, in, mn), mx);
        }
        case Rule::select: {
            const Slot second = argument(0), first = several(e, 1);
            return emit(Op::select, wanted, second, first);
        }
        case Rule::multiplex: {
            const Slot k = argument(0), first = several(e, 1);
            const std::uint64_t count = e.arguments.size() - 1;
            const bool has_else = same_name(e.arguments.back().name.text, "inelse");
            const Slot index = has_else ? emit(Op::min_unsigned, none, k, constant_slot(count - 1))
                                        : emit(Op::index, none, k, table({0, count, 1}));
            return emit(Op::load_at, wanted, first, index);
        }
        case Rule::shift: {
            int width = 0;
            while ((8 << width) < type.bits) ++width;
            const Op op = static_cast<Op>(static_cast<int>(f.op) + 4 * width);
            const Slot a = argument(0), n = argument(1);
            if (!type.is_signed) return emit(op, wanted, a, n);
            if (f.op == Op::shr_8) return emit(Op::shr_signed, wanted, a, n);
            const Type& bits = bits_type(type.bits);
            const Slot pattern = emit(of_type(Op::wrap_sint, bits), none, a);
            return emit(of_type(Op::wrap_sint, type), wanted, emit(op, none, pattern, n));
        }
        case Rule::normalise: {
            const Slot min = argument(0), in = argument(1), max = argument(2);
            land();  // MIN is read twice
            const Op sub = narrow ? Op::sub_real : Op::sub_lreal;
            const Slot above = emit(sub, none, in, min), range = emit(sub, none, max, min);
            return emit(narrow ? Op::div_real : Op::div_lreal, wanted, above, range);
        }
        case Rule::scale: {
            const Slot min = argument(0), in = argument(1), max = argument(2);
            land();  // MIN is read twice
            const Slot range = emit(narrow ? Op::sub_real : Op::sub_lreal, none, max, min);
            const Slot above = emit(narrow ? Op::mul_real : Op::mul_lreal, none, in, range);
            return emit(narrow ? Op::add_real : Op::add_lreal, wanted, above, min);
        }
        case Rule::length:
            return emit(Op::text_length, wanted, text_address(*e.arguments[0].value));
        case Rule::find: {
            const Slot in = text_address(*e.arguments[0].value);
            return emit(Op::text_find, wanted, in, text_address(*e.arguments[1].value));
        }
        case Rule::text:
            return text_address(e);
        case Rule::finite:
            return emit(Op::is_finite, wanted, argument(0));
        case Rule::valid_bcd:
            return emit(Op::is_bcd, wanted, argument(0));
        case Rule::from_bcd:
            return emit(of_type(Op::wrap_sint, type), wanted,
                        emit(Op::from_bcd, none, argument(0)));
        case Rule::to_bcd:
            return emit(Op::to_bcd, wanted, argument(0), static_cast<Slot>(type.bits / 4));
        case Rule::time:
            return emit(Op::time_now, wanted, 0);
        case Rule::swap:
            return emit(Op::swap_bytes, wanted, argument(0), static_cast<Slot>(type.bits));
        case Rule::encode:
            return emit(Op::lowest_bit, wanted, argument(0));
        case Rule::decode: {
            const auto last = static_cast<std::uint64_t>(type.bits - 1);
            const Slot place = emit(Op::and_bits, none, argument(0), constant_slot(last));
            return emit(Op::shl_64, wanted, constant_slot(1), place);
        }
        case Rule::statement:
            return reset_timer(*e.arguments[0].value);
        case Rule::capacity: {
            const Expression& text = *e.arguments[0].value;
            return capacity_of(locate(text), *text.type);
        }
        case Rule::bound:
        case Rule::move:
        case Rule::operation:
            return value_or_address(*e.arguments[0].value, none);
    }
    return none;
}

/// As the timer begins, but with the time that was given to it.
Slot Generator::reset_timer(const Expression& timer) {
    const Type& type = *timer.type;
    const std::uint32_t slots = slots_of(type);
    if (images_[&type].empty()) {
        Image fresh(slots, 0);
        fill_default(fresh, 0, type);
        images_[&type] = std::move(fresh);
    }
    const Slot made = new_temporary(slots);
    image_uses_.push_back({next(), &type, nullptr});
    put(Op::initialise, made, 0, slots);
    Location at = locate(timer);
    if (at.mode == Mode::indexed) at = as_address(at);
    const auto keep = [&](const Variable& member) {
        if (same_name(member.text, "pt")) put(Op::move, made + member.slot, load(part(at, member)));
    };
    for (const Variable* member : type.members) keep(*member);
    if (type.kind == Kind::block) std::ranges::for_each(type.routine->variables, keep);
    copy(at, {Mode::slot, made}, slots - (has_tests_ && type.kind == Kind::standard ? 1 : 0));
    return none;
}

Slot Generator::extremum(const Expression& e, bool greatest, Slot wanted) {
    const Type& type = *e.type;
    const Op op = type.is_real()          ? (greatest ? Op::max_lreal : Op::min_lreal)
                  : type.is_unsigned_64() ? (greatest ? Op::max_unsigned : Op::min_unsigned)
                                          : (greatest ? Op::max_signed : Op::min_signed);
    Slot so_far = value_before(*e.arguments[0].value, e);
    for (std::size_t i = 1; i < e.arguments.size(); ++i) {
        const bool last = i + 1 == e.arguments.size();
        so_far = emit(op, last ? wanted : none, so_far, value(*e.arguments[i].value));
    }
    return so_far;
}

/// The values of the arguments from `first` on, one behind the other; of texts, arrays and
/// structures their addresses.
Slot Generator::several(const Expression& e, std::size_t first) {
    const auto count = static_cast<std::uint32_t>(e.arguments.size() - first);
    const Slot slots = new_temporary(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Slot from = value_or_address(*e.arguments[first + i].value, slots + i);
        if (from != slots + i) put(Op::move, slots + i, from);
    }
    return slots;
}

Slot Generator::value_or_address(const Expression& e, Slot wanted) {
    if (e.type->is_scalar()) return value(e, wanted);
    if (e.type->kind == Kind::text) return text_address(e);
    if (e.kind != E::call) return address_of(locate(e));
    return e.routine ? emit(Op::set_address, none, call(e, none)) : standard(e, none);
}

}  // namespace lineshaft::st
