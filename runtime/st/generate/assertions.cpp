#include <fmt/format.h>

#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/statements.hpp"
#include "runtime/st/generate/values.hpp"

namespace lineshaft::st {

namespace {

/// What counts the calls of an instance has this bit where it is mocked; those below say how often
/// it was called.
constexpr std::uint64_t mocked_bit = std::uint64_t{1} << 63;

struct Compared {
    Slot holds = none, found = none, wanted = none, tolerance = none;
};

/// In each millisecond of it the test's own objects, such as axes, are scanned.
void advance_time(Writing& w, Slot by) {
    std::vector<const Variable*> objects;
    for (const Routine* of = w.routine->is_test() ? w.routine : nullptr; of; of = of->owner)
        for (const Variable& variable : of->variables)
            if (variable.type && variable.type->is_object()) objects.push_back(&variable);
    for (const Global& global : w.checked.globals)
        if (global.object) objects.push_back(global.object);
    if (objects.empty()) return w.put(Op::advance_time, 0, by, by);
    const Slot zero = w.constant_slot(0), left = w.new_temporary(), step = w.new_temporary();
    w.put(Op::move, left, by);
    const std::uint32_t start = w.next();
    Jumps end;
    w.jump(Op::jump_unless, 0, w.emit(Op::lt_signed, none, zero, left), end);
    w.put(Op::min_signed, step, left, w.constant_slot(1'000'000));
    w.put(Op::advance_time, 0, step, step);
    for (const Variable* object : objects)
        w.put(Op::call_block_at, address_of(w, locate_variable(w, *object)),
              w.standard_number(*object->type->standard));
    w.put(Op::sub_lint, left, left, step);
    w.put(Op::repeat, 0, 0, start);
    w.land(end);
    w.put(Op::advance_time, 0, zero, by);
}

/// Where it is counted how often an instance was called.
Location calls_of(Writing& w, const Expression& instance) {
    const Location at = locate(w, instance);
    const Type& type = *instance.type;
    return behind(at, type.kind == Kind::block ? std::uint32_t{error_slot} : type.slots - 1);
}

Compared compared(Writing& w, const Expression& e) {
    const Expression &first = *e.arguments[0].value, &second = *e.arguments[1].value;
    const Word relation = info(e.test).relation;
    if (first.type->kind == Kind::text) {
        const Slot a = text_address(w, first), b = text_address(w, second);
        return {compare_texts(w, relation, a, b), a, b};
    }
    const Slot a = value(w, first), b = value(w, second);
    const bool is_unsigned = first.type->is_unsigned_64() || second.type->is_unsigned_64();
    const Type& type = first.type->is_real() ? *first.type : is_unsigned ? ulint_type : lint_type;
    return {compare(w, relation, type, a, b), a, b};
}

/// The stop keeps the values' slots, and what follows it that of the message.
void write_assertion(Writing& w, const Expression& e, const Compared& values,
                     const Type* part = nullptr, const std::string& path = {}) {
    Jumps holds;
    w.jump(Op::jump_if, 0, values.holds, holds);
    const auto count = static_cast<std::size_t>(info(e.test).values);
    const bool has_message = e.arguments.size() > count;
    const Slot message = has_message ? text_address(w, *e.arguments.back().value) : values.found;
    const auto type = [&](std::size_t i) { return part ? part : e.arguments[i].value->type; };
    w.assertions.push_back(
        {w.next(), e.test, e.place, type(0), count > 1 ? type(1) : nullptr, path, has_message});
    w.put(Op::stop, values.found, values.wanted,
          values.tolerance == none ? values.found : values.tolerance);
    w.put(Op::message, message);
    w.land(holds);
}

void write_distance(Writing& w, const Expression& e) {
    const auto real = [&](std::size_t i) {
        const Expression& argument = *e.arguments[i].value;
        const Slot slot = value(w, argument);
        if (argument.type->is_real()) return slot;
        const bool is_unsigned = argument.type->is_unsigned_64();
        return w.emit(is_unsigned ? Op::lreal_from_unsigned : Op::lreal_from_signed, none, slot);
    };
    const Slot found = real(0), wanted = real(1), tolerance = real(2);
    const Slot distance = w.emit(Op::abs_lreal, none, w.emit(Op::sub_lreal, none, found, wanted));
    write_assertion(w, e,
                    {w.emit(Op::le_float, none, distance, tolerance), found, wanted, tolerance});
}

Location in_slots(Writing& w, const Expression& e) {
    const Location at = locate(w, e);
    return at.packed ? unpacked(w, at, *e.type) : at;
}

/// Part by part, so that a message can name the first one that differs.
void write_equal(Writing& w, const Expression& e, const Type& type, const Location& a,
                 const Location& b, const std::string& path) {
    if (type.kind == Kind::array) {
        const std::uint32_t slots = slots_of(w, *type.element);
        for (std::int64_t i = type.lower; i <= type.upper; ++i) {
            const auto at = static_cast<std::uint32_t>(i - type.lower) * slots;
            write_equal(w, e, *type.element, behind(a, at), behind(b, at),
                        fmt::format("{}[{}]", path, i));
        }
        return;
    }
    if (type.kind == Kind::structure) {
        for (const Variable* member : type.members)
            write_equal(w, e, *member->type, part(w, a, *member), part(w, b, *member),
                        fmt::format("{}.{}", path, member->text));
        return;
    }
    if (type.kind == Kind::union_) {
        const Location first = as_packed(w, a, type), second = as_packed(w, b, type);
        for (const RawBytes& bytes : raw_parts(type)) {
            const Slot found = load_raw(w, first, bytes), wanted = load_raw(w, second, bytes);
            const Type& number = bits_type(8 * bytes.bytes);
            write_assertion(w, e, {compare(w, Word::equal, number, found, wanted), found, wanted},
                            &number, fmt::format("{} from byte {} on", path, bytes.first));
        }
        return;
    }
    const std::uint32_t kept = w.temporaries;
    Compared values;
    if (type.kind == Kind::text) {
        values.found = address_of(w, a), values.wanted = address_of(w, b);
        values.holds = compare_texts(w, Word::equal, values.found, values.wanted);
    } else if (type.is_scalar()) {
        values.found = load(w, a), values.wanted = load(w, b);
        values.holds = compare(w, Word::equal, type, values.found, values.wanted);
    } else {
        return;
    }
    write_assertion(w, e, values, &type, path);
    w.temporaries = kept;
}

}  // namespace

void write_test_statement(Writing& w, const Expression& e) {
    const Expression& first = *e.arguments[0].value;
    switch (e.test) {
        case TestCall::advance_time:
            return advance_time(w, value(w, first));
        case TestCall::mock: {
            const Location calls = calls_of(w, first);
            return store(w, calls,
                         w.emit(Op::or_bits, none, load(w, calls), w.constant_slot(mocked_bit)));
        }
        case TestCall::mock_function: {
            const Routine& function = *e.routine;
            assign(w, locate_variable(w, *function.mock_value), *function.mock_value->type,
                   *e.arguments[1].value);
            return store(w, locate_variable(w, *function.mock_flag), w.constant_slot(1));
        }
        case TestCall::mock_verify_called:
        case TestCall::mock_verify_call_count: {
            const bool any = e.test == TestCall::mock_verify_called;
            const Slot count = w.emit(Op::and_bits, none, load(w, calls_of(w, first)),
                                      w.constant_slot(mocked_bit - 1));
            const Slot wanted = any ? w.constant_slot(0) : value(w, *e.arguments[1].value);
            const Op op = any ? Op::ne_word : Op::eq_word;
            return write_assertion(w, e, {w.emit(op, none, count, wanted), count, wanted});
        }
        case TestCall::assert_true:
        case TestCall::assert_false: {
            const Slot found = value(w, first);
            const Op op = e.test == TestCall::assert_true ? Op::ne_word : Op::eq_word;
            return write_assertion(w, e,
                                   {w.emit(op, none, found, w.constant_slot(0)), found, found});
        }
        case TestCall::assert_near:
            return write_distance(w, e);
        case TestCall::none:
        case TestCall::assert_eq:
        case TestCall::assert_neq:
        case TestCall::assert_gt:
        case TestCall::assert_lt:
        case TestCall::assert_ge:
        case TestCall::assert_le:
            break;
    }
    const Expression& second = *e.arguments[1].value;
    const Type& type = *first.type;
    if (type.kind == Kind::text || type.is_scalar()) return write_assertion(w, e, compared(w, e));
    if (e.test == TestCall::assert_eq)
        return write_equal(w, e, type, in_slots(w, first), in_slots(w, second), "");
}

void count_call(Writing& w, const Location& calls, Jumps& runs) {
    const Slot count = w.emit(Op::add_lint, none, load(w, calls), w.constant_slot(1));
    store(w, calls, count);
    w.jump(Op::jump_unless, 0, w.emit(Op::lt_signed, none, count, w.constant_slot(0)), runs);
}

void begin_mockable(Writing& w, const Routine& routine) {
    Jumps runs;
    if (w.has_tests && routine.has_instances() && !routine.pou->is_tests)
        count_call(w, {Mode::slot, error_slot}, runs);
    if (routine.mock_flag)
        w.jump(Op::jump_unless, 0, load(w, locate_variable(w, *routine.mock_flag)), runs);
    if (runs.empty()) return;
    if (routine.mock_flag) {
        const Variable& result = *routine.result;
        const Location from = locate_variable(w, *routine.mock_value);
        if (result.type->is_scalar())
            store(w, {Mode::slot, result.slot}, load(w, from));
        else
            copy(w, {Mode::slot, result.slot}, from, slots_of(w, *result.type));
    }
    w.put(Op::leave);
    w.land(runs);
}

}  // namespace lineshaft::st
