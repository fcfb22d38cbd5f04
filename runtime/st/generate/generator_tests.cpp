#include <fmt/format.h>

#include "runtime/st/generate/generator_class.hpp"
#include "runtime/st/prelude/standard_source.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;
using Mode = Location::Mode;

/// Of what counts the calls of an instance: this bit says that it is mocked, those below how often
/// it was called.
constexpr std::uint64_t mocked_bit = std::uint64_t{1} << 63;

}  // namespace

void Generator::write_test_statement(const Expression& e) {
    const Expression& first = *e.arguments[0].value;
    switch (e.test) {
        case TestCall::advance_time:
            return advance_time(value(first));
        case TestCall::mock: {
            const Location calls = calls_of(first);
            return store(calls, emit(Op::or_bits, none, load(calls), constant_slot(mocked_bit)));
        }
        case TestCall::mock_function: {
            const Routine& function = *e.routine;
            assign(locate_global(*function.mock_value), *function.mock_value->type,
                   *e.arguments[1].value);
            return store(locate_global(*function.mock_flag), constant_slot(1));
        }
        case TestCall::mock_verify_called:
        case TestCall::mock_verify_call_count: {
            const bool any = e.test == TestCall::mock_verify_called;
            const Slot count =
                emit(Op::and_bits, none, load(calls_of(first)), constant_slot(mocked_bit - 1));
            const Slot wanted = any ? constant_slot(0) : value(*e.arguments[1].value);
            const Op op = any ? Op::ne_word : Op::eq_word;
            return write_assertion(e, {emit(op, none, count, wanted), count, wanted});
        }
        case TestCall::assert_true:
        case TestCall::assert_false: {
            const Slot found = value(first);
            const Op op = e.test == TestCall::assert_true ? Op::ne_word : Op::eq_word;
            return write_assertion(e, {emit(op, none, found, constant_slot(0)), found, found});
        }
        case TestCall::assert_near:
            return write_distance(e);
        default:
            break;
    }
    const Expression& second = *e.arguments[1].value;
    const Type& type = *first.type;
    if (type.kind == Kind::text || type.is_scalar()) return write_assertion(e, compared(e));
    if (e.test == TestCall::assert_eq)
        return write_equal(e, type, locate(first), locate(second), "");
}

/// In each millisecond of it the test's own objects, such as axes, are scanned.
void Generator::advance_time(Slot by) {
    std::vector<const Variable*> objects;
    for (const Routine* of = routine_->is_test() ? routine_ : nullptr; of; of = of->owner)
        for (const Variable& variable : of->variables)
            if (variable.type && variable.type->is_object()) objects.push_back(&variable);
    for (const Global& global : checked_.globals)
        if (global.object) objects.push_back(global.object);
    if (objects.empty()) return put(Op::advance_time, 0, by, by);
    const Slot zero = constant_slot(0), left = new_temporary(), step = new_temporary();
    put(Op::move, left, by);
    const std::uint32_t start = next();
    std::vector<std::uint32_t> end;
    jump(Op::jump_unless, 0, emit(Op::lt_signed, none, zero, left), end);
    put(Op::min_signed, step, left, constant_slot(1'000'000));
    put(Op::advance_time, 0, step, step);
    for (const Variable* object : objects)
        put(Op::call_block_at, address_of(locate_global(*object)),
            standard_number(*object->type->standard));
    put(Op::sub_lint, left, left, step);
    put(Op::repeat, 0, 0, start);
    land(end);
    put(Op::advance_time, 0, zero, by);
}

/// Where it is counted how often an instance was called.
Location Generator::calls_of(const Expression& instance) {
    const Location at = locate(instance);
    const Type& type = *instance.type;
    return part(at, type.kind == Kind::block ? std::uint32_t{error_slot} : type.slots - 1);
}

Location Generator::locate_global(const Variable& variable) {
    Expression name;
    name.kind = Expression::Kind::name;
    name.variable = const_cast<Variable*>(&variable);
    name.type = variable.type;
    return locate(name);
}

Generator::Compared Generator::compared(const Expression& e) {
    const Expression &first = *e.arguments[0].value, &second = *e.arguments[1].value;
    if (first.type->kind == Kind::text) {
        const Slot a = text_address(first), b = text_address(second);
        return {relation(e.test, int_type, emit(Op::text_compare, none, a, b), constant_slot(0)), a,
                b};
    }
    const Slot a = value(first), b = value(second);
    const bool is_unsigned = first.type->is_unsigned_64() || second.type->is_unsigned_64();
    const Type& type = first.type->is_real() ? *first.type : is_unsigned ? ulint_type : lint_type;
    return {relation(e.test, type, a, b), a, b};
}

/// Whether what the statement asserts of two values holds.
Slot Generator::relation(TestCall test, const Type& type, Slot a, Slot b) {
    const bool real = type.is_real(), big = type.is_unsigned_64();
    const Op less = real ? Op::lt_float : big ? Op::lt_unsigned : Op::lt_signed;
    const Op at_most = real ? Op::le_float : big ? Op::le_unsigned : Op::le_signed;
    switch (test) {
        case TestCall::assert_neq:
            return emit(real ? Op::ne_float : Op::ne_word, none, a, b);
        case TestCall::assert_gt:
            return emit(less, none, b, a);
        case TestCall::assert_lt:
            return emit(less, none, a, b);
        case TestCall::assert_ge:
            return emit(at_most, none, b, a);
        case TestCall::assert_le:
            return emit(at_most, none, a, b);
        default:
            return emit(real ? Op::eq_float : Op::eq_word, none, a, b);
    }
}

void Generator::write_distance(const Expression& e) {
    const auto real = [&](std::size_t i) {
        const Expression& argument = *e.arguments[i].value;
        const Slot slot = value(argument);
        return argument.type->is_real() ? slot : emit(Op::lreal_from_signed, none, slot);
    };
    const Slot found = real(0), wanted = real(1), tolerance = real(2);
    const Slot distance = emit(Op::abs_lreal, none, emit(Op::sub_lreal, none, found, wanted));
    write_assertion(e, {emit(Op::le_float, none, distance, tolerance), found, wanted, tolerance});
}

/// Part by part, so that a message can name the first one that differs.
void Generator::write_equal(const Expression& e, const Type& type, const Location& a,
                            const Location& b, const std::string& path) {
    if (type.kind == Kind::array) {
        const std::uint32_t slots = slots_of(*type.element);
        for (std::int64_t i = type.lower; i <= type.upper; ++i) {
            const auto at = static_cast<std::uint32_t>(i - type.lower) * slots;
            write_equal(e, *type.element, part(a, at), part(b, at), fmt::format("{}[{}]", path, i));
        }
        return;
    }
    if (type.kind == Kind::structure) {
        for (const Variable* member : type.members)
            write_equal(e, *member->type, part(a, *member), part(b, *member),
                        fmt::format("{}.{}", path, member->text));
        return;
    }
    const std::uint32_t kept = temporaries_;
    Compared values;
    if (type.kind == Kind::text) {
        values.found = address_of(a), values.wanted = address_of(b);
        const Slot order = emit(Op::text_compare, none, values.found, values.wanted);
        values.holds = relation(TestCall::assert_eq, int_type, order, constant_slot(0));
    } else if (type.is_scalar()) {
        values.found = load(a), values.wanted = load(b);
        values.holds = relation(TestCall::assert_eq, type, values.found, values.wanted);
    } else {
        return;
    }
    write_assertion(e, values, &type, path);
    temporaries_ = kept;
}

/// The stop keeps the values' slots, and what follows it that of the message.
void Generator::write_assertion(const Expression& e, const Compared& values, const Type* part,
                                const std::string& path) {
    std::vector<std::uint32_t> holds;
    jump(Op::jump_if, 0, values.holds, holds);
    const auto count = static_cast<std::size_t>(info(e.test).values);
    const bool has_message = e.arguments.size() > count;
    const Slot message = has_message ? text_address(*e.arguments.back().value) : values.found;
    const auto type = [&](std::size_t i) { return part ? part : e.arguments[i].value->type; };
    assertions_.push_back(
        {next(), e.test, e.place, type(0), count > 1 ? type(1) : nullptr, path, has_message});
    put(Op::stop, values.found, values.wanted,
        values.tolerance == none ? values.found : values.tolerance);
    put(Op::message, message);
    land(holds);
}

/// The body of a block in a build with tests begins by counting its call, and ends if it is mocked.
void Generator::count_call(const Location& calls, std::vector<std::uint32_t>& runs) {
    const Slot count = emit(Op::add_lint, none, load(calls), constant_slot(1));
    store(calls, count);
    jump(Op::jump_unless, 0, emit(Op::lt_signed, none, count, constant_slot(0)), runs);
}

void Generator::cover(CoverPoint::Kind kind, Place place, std::size_t branch) {
    const SourceFile* file = place.file->get();
    if (!options_.covered || file == test_file_ || is_standard_source(*file)) return;
    const bool is_function = kind == CoverPoint::Kind::function;
    put(Op::cover, static_cast<Slot>(code_.points.size()));
    code_.points.push_back({kind, place, static_cast<std::uint32_t>(branch),
                            is_function ? routine_->name : std::string()});
}

void Generator::begin_mockable(const Routine& routine) {
    std::vector<std::uint32_t> runs;
    if (has_tests_ && routine.has_instances() && !routine.pou->is_tests)
        count_call({Mode::slot, error_slot}, runs);
    if (routine.mock_flag) jump(Op::jump_unless, 0, load(locate_global(*routine.mock_flag)), runs);
    if (runs.empty()) return;
    if (routine.mock_flag) {
        const Variable& result = *routine.result;
        const Location from = locate_global(*routine.mock_value);
        if (result.type->is_scalar())
            store({Mode::slot, result.slot}, load(from));
        else
            copy({Mode::slot, result.slot}, from, slots_of(*result.type));
    }
    put(Op::leave);
    land(runs);
}

}  // namespace lineshaft::st
