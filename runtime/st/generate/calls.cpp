#include <algorithm>
#include <functional>

#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/statements.hpp"
#include "runtime/st/generate/values.hpp"
#include "runtime/st/types/parameters.hpp"

namespace lineshaft::st {

namespace {

/// What a call is given only when all its arguments are known.
struct Later {
    Location to;
    Slot slot;
    std::uint32_t slots = 0;  ///< of an array, a structure, a text or a reference
    bool is_lent = false;     ///< an address
};

/// What has a copy in a call, which is written back behind that.
struct Lent {
    Location at, copy;
    const Type* type = nullptr;
    const Expression* bits = nullptr;  ///< of a variable, instead of `at`
};

/// A test sets an output or a local by its name.
bool is_set(const Argument& argument) {
    return argument.name.word != Word::end_of_file && !argument.is_output;
}

/// The instance that a method works on.
Location method_base(Writing& w, const Expression& e) {
    const Expression& callee = *e.operands[0];
    if (callee.kind == E::member) return locate(w, *callee.operands[0]);
    return {Mode::slot, 0};
}

/// Where a parameter is in the frame that a call is given.
Location parameter(Writing& w, const Location& frame, const Expression& e,
                   const Variable& variable) {
    if (!e.is_dispatched || !e.routine->owner) return behind(frame, variable.slot);
    return behind(frame, slot_in_signature(w, *e.routine, variable));
}

void write(Writing& w, const Location& to, const Location& from, const Type& type) {
    if (to.byte || from.byte)
        store(w, to, load(w, from));
    else
        copy_value(w, to, from, type);
}

/// Bytes that are a part of something: a BOOL of a standard block, what is in a UNION or the image.
bool is_in_bytes(const Location& at) {
    return at.byte || (at.packed && at.packed->through == none);
}

/// A value that VAR_IN_OUT CONSTANT is given, where it has a variable.
Location made_for_call(Writing& w, const Argument& given) {
    const Location made = locate_variable(w, *given.made);
    assign(w, made, *given.made->type, *given.value);
    return made;
}

/// A copy of what is no slot of its own, which is written back behind the call.
Location lend(Writing& w, Location at, const Type& type, std::vector<Lent>& lent) {
    if (at.mode != Mode::slot) at = as_address(w, at);
    lent.push_back({at, {Mode::slot, w.new_temporary(slots_of(w, type))}, &type});
    write(w, lent.back().copy, at, type);
    return lent.back().copy;
}

/// Where the value of a VAR_IN_OUT is, and what it holds if any length may be given. What has a
/// copy is referred to by nothing: ADR of that VAR_IN_OUT is NULL.
void refer(Writing& w, const Location& to, const Argument& argument, std::vector<Later>& later,
           std::vector<Lent>& lent) {
    const Variable& variable = *argument.variable;
    const Expression& value = *argument.value;
    const Type& type = argument.made ? *argument.made->type : *value.type;
    Location at = argument.made ? made_for_call(w, argument) : locate(w, value);
    const bool is_lent = is_in_bytes(at);
    if (is_lent) at = lend(w, at, type, lent);
    later.push_back({to, address_of(w, at), 0, true});
    if (variable.type->is_open) later.push_back({behind(to, 1), capacity_of(w, at, type)});
    if (!w.checked.refers_to_in_outs) return;
    const Location reference = behind(to, variable.type->is_open ? 2 : 1);
    if (is_lent)
        later.push_back({reference, w.constant_slot(0)});
    else if (argument.made)
        later.push_back({reference, reference_to(w, *argument.made), reference_slots});
    else
        later.push_back({reference, reference_to(w, value), reference_slots});
}

/// `variable` stands in the frame, and has the value there.
Lent give_copy(Writing& w, const Location& to, const Variable& variable, const Expression& given) {
    if (given.kind == E::bit) {
        store(w, to, value(w, given));
        return {{}, to, variable.type, &given};
    }
    Location at = locate(w, given);
    if (at.mode != Mode::slot) at = as_address(w, at);
    write(w, to, at, *variable.type);
    return {at, to, variable.type};
}

void give(Writing& w, const std::vector<Later>& later) {
    for (const Later& value : later) {
        if (value.slots > 0)
            copy(w, value.to, {Mode::slot, value.slot}, value.slots);
        else
            store(w, value.to, value.slot);
    }
}

void give_left_out(Writing& w, const Location& frame, const Expression& e) {
    for (const Argument& argument : e.arguments) {
        if (!argument.is_left_out) continue;
        const Location reference = parameter(w, frame, e, *argument.variable);
        Jumps given;
        w.jump(Op::jump_if, 0, load(w, reference), given);
        std::vector<Later> later;
        std::vector<Lent> lent;  // what stands for it is a variable of its own
        refer(w, reference, argument, later, lent);
        give(w, later);
        w.land(given);
    }
}

/// What is given to a call that may meet itself may stand in what that runs on, and is put aside.
void put_aside(Writing& w, std::vector<Later>& later) {
    for (Later& value : later) {
        if ((value.slot & region_mask) != 0) continue;
        const std::uint32_t slots = std::max(value.slots, 1U);
        const Slot aside = w.new_temporary(slots);
        copy(w, {Mode::slot, aside}, {Mode::slot, value.slot}, slots);
        value.slot = aside;
    }
}

/// An input; of an instance that extends its block the part that it has of that.
void give_value(Writing& w, const Location& to, const Type& type, const Expression& value) {
    assign(w, to, type, value);
    const bool is_part = type.kind == Kind::block && value.type != &type && w.code.has_kinds;
    if (is_part)
        store(w, behind(to, w.code.kind_slot()), w.constant_slot(w.kinds.at(type.routine)));
}

/// Inputs of a function or a method that are given nothing begin as they are declared.
void begin_left_out(Writing& w, const Location& frame, const Expression& e,
                    const Routine& routine) {
    if (routine.has_instances()) return;
    for (const Variable& variable : routine.variables) {
        const bool missing =
            variable.section == Section::input &&
            std::ranges::find(e.arguments, &variable, &Argument::variable) == e.arguments.end();
        if (!missing || variable.space == Space::constant) continue;
        const std::uint32_t slots = slots_of(w, *variable.type);
        const bool is_near = !e.is_dispatched && frame.mode == Mode::slot;
        const bool is_of_block = !e.is_dispatched && routine.owner;
        if (e.is_dispatched) signature_image(w, routine);
        const Slot made = is_near ? frame.slot + variable.slot : w.new_temporary(slots);
        w.image_uses.push_back({w.next(), is_of_block ? routine.owner->type : nullptr, &routine});
        w.put(Op::initialise, made,
              e.is_dispatched ? slot_in_signature(w, routine, variable) : variable.slot, slots);
        if (!is_near) copy(w, parameter(w, frame, e, variable), {Mode::slot, made}, slots);
    }
}

/// Inputs and references, and what is left out. Gives what is to be written back. `save`: before
/// the call is given anything what runs already is kept; all that is given is known then.
std::vector<Lent> give(Writing& w, const Location& frame, const Expression& e,
                       const Routine& routine, const std::function<void()>& save = {}) {
    const auto is_given = [](const Argument& argument) {
        const Section section = argument.variable->section;
        return !argument.is_left_out &&
               (section == Section::input || section == Section::in_out || is_set(argument));
    };
    give_left_out(w, frame, e);
    const bool nested = save || std::ranges::any_of(e.arguments, [&](const Argument& a) {
                            return is_given(a) && has_call(*a.value);
                        });
    std::vector<Later> later;
    std::vector<Lent> lent;
    for (const Argument& argument : e.arguments) {
        if (!is_given(argument)) continue;
        const Variable& variable = *argument.variable;
        const Type& type = *variable.type;
        const Location to = parameter(w, frame, e, variable);
        if (variable.space == Space::reference) {
            refer(w, to, argument, later, lent);
        } else if (is_copied_in_out(variable)) {
            const Location at = nested ? Location{Mode::slot, w.new_temporary()} : to;
            lent.push_back(give_copy(w, at, variable, *argument.value));
            if (nested) later.push_back({to, at.slot});
            lent.back().copy = to;
        } else if (!nested) {
            give_value(w, to, type, *argument.value);
        } else if (type.is_scalar()) {
            later.push_back({to, w.new_temporary()});
            value_to(w, *argument.value, later.back().slot);
        } else {
            const std::uint32_t slots = slots_of(w, type);
            later.push_back({to, w.new_temporary(slots), slots});
            give_value(w, {Mode::slot, later.back().slot}, type, *argument.value);
        }
    }
    if (save) {
        put_aside(w, later);
        save();
        for (Later& value : later)
            if (value.is_lent) value.slot = w.emit(Op::lent, none, value.slot);
    }
    give(w, later);
    begin_left_out(w, frame, e, routine);
    return lent;
}

/// What was lent, and outputs.
void take(Writing& w, const Location& frame, const Expression& e, const std::vector<Lent>& lent) {
    const Type* callee = e.operands[0] ? e.operands[0]->type : nullptr;
    for (const Lent& one : lent)
        if (one.bits)
            store_bits(w, *one.bits, load(w, one.copy));
        else
            write(w, one.at, one.copy, *one.type);
    for (const Argument& argument : e.arguments) {
        const Variable& variable = *argument.variable;
        const bool is_taken = argument.is_output || variable.section == Section::output;
        if (!is_taken || is_set(argument)) continue;
        const Location from =
            e.is_dispatched ? parameter(w, frame, e, variable) : part(w, frame, variable);
        const Type &given = *variable.type, &wanted = *argument.value->type;
        const auto taken = [&] {
            Slot slot = load(w, from);
            if (is_finer_than_ms(callee, given, e.place)) slot = whole_ms(w, slot, e.place);
            if (argument.is_negated) return w.emit(Op::not_bool, none, slot);
            const bool is_time_of_s7 = e.place.dialect().has_s7_instructions &&
                                       wanted.kind == Kind::time && !wanted.counts_ns;
            slot = convert(w, slot, given, wanted, false, none);
            return is_time_of_s7 && !given.is_time() ? whole_ms(w, slot, e.place) : slot;
        };
        if (argument.value->kind == E::bit) {
            store_bits(w, *argument.value, taken());
            continue;
        }
        const Location to = locate(w, *argument.value);
        if (given.is_alias() && wanted.kind == Kind::block)
            copy_value(w, to, locate_instance(w, from, wanted), wanted);
        else if (given.kind == Kind::text && to.packed)
            store_packed_text(w, to, address_of(w, from));
        else if (given.kind == Kind::text)
            w.put(Op::text_copy, address_of(w, to), address_of(w, from),
                  capacity_of(w, to, wanted));
        else if (!given.is_scalar())
            copy_value(w, to, from, given);
        else
            store(w, to, taken());
    }
}

/// The frame that the callee runs on: where its instance is, or has been given.
Location on_frame(Writing& w, Location frame) {
    return frame.mode == Mode::indexed ? as_address(w, frame) : frame;
}

/// `number` is that of what is called.
void put_call(Writing& w, Op near, Op far, const Location& frame, std::uint32_t number) {
    if (frame.mode == Mode::slot)
        w.put(near, frame.slot, number);
    else
        w.put(far, address_of(w, frame), number);
}

std::vector<Lent> give_and_call(Writing& w, const Location& frame, const Expression& e,
                                const Routine& routine) {
    std::vector<Lent> lent = give(w, frame, e, routine);
    w.place = e.place;
    put_call(w, Op::call, Op::call_at, frame, w.routine_number(routine));
    return lent;
}

/// Its address, in a slot that stays while arguments are computed.
Slot address_of_instance(Writing& w, const Expression& e) {
    const Expression& callee = *e.operands[0];
    const bool is_interface = callee.kind == E::member && callee.operands[0]->type &&
                              callee.operands[0]->type->kind == Kind::interface;
    const Slot to = w.new_temporary();
    if (is_interface)
        value_to(w, *callee.operands[0], to);
    else
        store(w, {Mode::slot, to}, address_of(w, method_base(w, e)));
    return to;
}

/// Behind the call of a method or a body that may have run already. Gives where its results are.
Slot swap(Writing& w) {
    return w.emit(Op::swap_frame, none, 0);
}

/// The instance says which routine that is, and where its parameters are.
Location find_and_call(Writing& w, const Expression& e, Slot instance) {
    const Slot found = w.new_temporary(2);
    w.place = e.place;
    w.put(Op::find_routine, found, instance, method_number(w, *e.routine));
    const bool is_method = e.routine->owner != nullptr, meets = may_meet_itself(w, e);
    Location frame{Mode::address, 0, is_method ? found + 1 : instance};
    const auto save = [&] {
        w.place = e.place;
        w.put(Op::save_found, 0, found, instance);
    };
    const std::vector<Lent> lent =
        meets ? give(w, frame, e, *e.routine, save) : give(w, frame, e, *e.routine);
    w.place = e.place;
    w.put(Op::call_found, instance, found);
    if (meets) {
        const Slot results = swap(w);
        if (is_method) frame.index = results;
    }
    take(w, frame, e, lent);
    if (meets) w.put(Op::pop_frame);
    return frame;
}

/// A function, on a frame of its own.
Location call_on_pile(Writing& w, const Expression& e) {
    const Slot at = w.new_temporary();
    w.place = e.place;
    w.put(Op::push_frame, at, w.routine_number(*e.routine));
    const Location frame{Mode::address, 0, at};
    const std::vector<Lent> lent = give_and_call(w, frame, e, *e.routine);
    take(w, frame, e, lent);
    w.put(Op::pop_frame);
    return frame;
}

/// A method or a body of the instance at that address, with what runs there already kept.
Location call_again(Writing& w, const Expression& e, Slot at) {
    const Routine& routine = *e.routine;
    Location frame{Mode::address, 0, at};
    const auto save = [&] {
        w.place = e.place;
        w.put(Op::save_frame, 0, w.routine_number(routine), at);
    };
    const std::vector<Lent> lent = give(w, frame, e, routine, save);
    w.place = e.place;
    w.put(Op::call_at, at, w.routine_number(routine));
    const Slot results = swap(w);
    if (routine.owner) frame = {Mode::address, 0, results, 0 - routine.first};
    take(w, frame, e, lent);
    w.put(Op::pop_frame);
    return frame;
}

}  // namespace

Slot call(Writing& w, const Expression& e, Slot wanted) {
    if (!e.routine) return standard(w, e, wanted);
    const Location frame = call_routine(w, e);
    const Routine& routine = *e.routine;
    const std::uint32_t slots = slots_of(w, *routine.result->type);
    const Location from =
        e.is_dispatched ? parameter(w, frame, e, *routine.result) : part(w, frame, *routine.result);
    const Slot to = slots == 1 ? w.result(wanted) : w.new_temporary(slots);
    if (slots == 1)
        store(w, {Mode::slot, to}, load(w, from, to));
    else
        copy(w, {Mode::slot, to}, from, slots);
    return to;
}

Location call_routine(Writing& w, const Expression& e) {
    const Routine& routine = *e.routine;
    if (e.is_dispatched) return find_and_call(w, e, address_of_instance(w, e));
    const bool is_function = routine.is_function();
    if (may_meet_itself(w, e))
        return is_function ? call_on_pile(w, e) : call_again(w, e, address_of_instance(w, e));
    Location frame =
        is_function ? Location{Mode::slot, Region::window} : on_frame(w, method_base(w, e));
    const std::vector<Lent> lent = give_and_call(w, frame, e, routine);
    if (is_function) w.windows = std::max(w.windows, routine.frame);
    const auto is_called_for = [](const Argument& a) {
        return (a.is_output || a.variable->section == Section::output) && has_call(*a.value);
    };
    if (is_function && std::ranges::any_of(e.arguments, is_called_for)) {
        frame.slot = w.new_temporary(routine.variables_end);
        w.put(Op::copy, frame.slot, Region::window, routine.variables_end);
    }
    take(w, frame, e, lent);
    return frame;
}

/// What an instance of Siemens' timers is called as; null: it is none, or that is not known.
const BlockType* timer_at(const Writing& w, const Expression& instance) {
    const Type* type = instance.type;
    if (!type || type->kind != Kind::standard) return nullptr;
    constexpr std::string_view timers[] = {"ton", "tof", "tp"};
    if (std::ranges::find(timers, type->standard->name) == std::end(timers)) return nullptr;
    if (!type->name.starts_with("IEC_")) return type->standard;
    const auto found = w.checked.called_as.find(variable_of_instance(instance));
    return found == w.checked.called_as.end() ? nullptr : found->second;
}

void update_timer(Writing& w, const Expression& read) {
    const bool is_of_siemens = read.place.dialect().has_s7_instructions;
    if (!is_of_siemens || !(same_name(read.token.text, "q") || same_name(read.token.text, "et")))
        return;
    const Expression& instance = *read.operands[0];
    const BlockType* timer = timer_at(w, instance);
    if (!timer) return;
    const Location frame = on_frame(w, locate(w, instance));
    Jumps mocked;
    if (w.has_tests) {
        const Slot calls = load(w, behind(frame, instance.type->slots - 1));
        w.jump(Op::jump_if, 0, w.emit(Op::lt_signed, none, calls, w.constant_slot(0)), mocked);
    }
    put_call(w, Op::call_block, Op::call_block_at, frame, w.standard_number(*timer));
    w.land(mocked);
}

void call_instance(Writing& w, const Expression& e) {
    const Expression& callee = *e.operands[0];
    const Type& type = *callee.type;
    const Location frame = on_frame(w, locate(w, callee));
    if (e.operands[1]) {
        const std::vector<Lent> lent = give(w, frame, e, *type.routine);
        call_routine(w, *e.operands[1]);
        return take(w, frame, e, lent);
    }
    if (e.is_dispatched || (type.kind == Kind::block && may_meet_itself(w, e))) {
        const Slot instance = w.new_temporary();
        store(w, {Mode::slot, instance}, address_of(w, frame));
        e.is_dispatched ? find_and_call(w, e, instance) : call_again(w, e, instance);
        return;
    }
    if (type.kind == Kind::block)
        return take(w, frame, e, give_and_call(w, frame, e, *type.routine));
    for (const Argument& argument : e.arguments)
        if (argument.variable->section != Section::output || is_set(argument))
            assign(w, part(w, frame, *argument.variable), *argument.variable->type,
                   *argument.value);
    const std::uint32_t number = w.standard_number(e.called_as ? *e.called_as : *type.standard);
    w.place = e.place;
    Jumps runs, mocked;
    if (w.has_tests) {
        count_call(w, behind(frame, type.slots - 1), runs);
        w.jump(Op::jump, 0, 0, mocked);
        w.land(runs);
    }
    put_call(w, Op::call_block, Op::call_block_at, frame, number);
    w.land(mocked);
    take(w, frame, e, {});
}

}  // namespace lineshaft::st
