#include <cmath>

#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

/// Made of constants, operators, conversions and standard functions alone.
bool is_fixed(const Expression& e) {
    if (e.kind == E::call) {
        const bool is_standard = e.standard && e.type && e.standard->is_pure;
        return is_standard && std::ranges::all_of(e.arguments, [](const Argument& a) {
                   return is_fixed(*a.value);
               });
    }
    const bool is_made = e.kind == E::unary || e.kind == E::binary || e.kind == E::converted;
    return is_made ? is_fixed(*e.operands[0]) && (!e.operands[1] || is_fixed(*e.operands[1]))
                   : is_constant(e);
}

/// CODESYS keeps it in 32 bits until something takes it, as what is reckoned of variables: it stays
/// to be reckoned.
bool is_beyond(const Expression& e, Wide value) {
    const Type& type = *e.type;
    return type.kind == Type::Kind::integer && e.place.dialect().reckons_in > type.bits &&
           wrapped(type, value) != value;
}

}  // namespace

Constant operate(Word op, const Constant& a, const Constant& b) {
    switch (op) {
        case Word::and_:
        case Word::and_then_:
            return {.integer = a.integer & b.integer};
        case Word::or_:
        case Word::or_else_:
            return {.integer = a.integer | b.integer};
        case Word::xor_:
            return {.integer = a.integer ^ b.integer};
        case Word::plus:
            return {a.integer + b.integer, a.real + b.real};
        case Word::minus:
            return {a.integer - b.integer, a.real - b.real};
        case Word::times:
            return {product(a.integer, b.integer), a.real * b.real};
        case Word::divided:
            return {b.integer == 0 ? 0 : a.integer / b.integer, a.real / b.real};
        case Word::mod_:
            return {.integer = a.integer % b.integer};
        default:
            return {};
    }
}

void fold_unary(Checking& c, Expression*& e) {
    const Type& type = *e->type;
    Constant value = e->operands[0]->constant;
    if (e->op == Word::minus) {
        if (is_beyond(*e, -value.integer)) return;
        value.real = -value.real;
        value.integer = type.is_any() ? -value.integer : wrapped(type, -value.integer);
    } else if (e->op == Word::not_) {
        value.integer = wrapped(type, ~value.integer);
    }
    e = make_constant(c, *e, type, std::move(value));
}

void fold(Checking& c, Expression*& e) {
    const Expression &left = *e->operands[0], &right = *e->operands[1];
    if (!is_constant(left) || !is_constant(right) || e->op == Word::power) return;
    const Type& type = *e->type;
    const bool real = left.type->is_real() || right.type->is_real();
    const Constant a{left.constant.integer, as_real(left)},
        b{right.constant.integer, as_real(right)};
    const auto compared =
        real ? compare(e->op, a.real, b.real) : compare(e->op, a.integer, b.integer);
    if (compared) return (void)(e = make_boolean(c, *e, *compared));
    const bool divides = e->op == Word::divided || e->op == Word::mod_;
    if (divides && !real && b.integer == 0)
        return (void)(e->type =
                          c.fail(code::value_out_of_range, right.place, "this divides by zero"));
    Constant result = operate(e->op, a, b);
    if (type.kind == Kind::time && real)
        result.integer = static_cast<Wide>(std::nearbyint(result.real));
    if (is_beyond(*e, result.integer)) return;
    if (is_single(type)) result.real = static_cast<float>(result.real);
    if (!type.is_any() && !type.is_real()) result.integer = wrapped(type, result.integer);
    constexpr Wide most = Wide{1} << 64;
    if (type.is_any() && (result.integer >= most || result.integer <= -most))
        return (void)(e->type =
                          c.fail(code::value_out_of_range, e->place, "the result is out of range"));
    e = make_constant(c, *e, type, std::move(result));
}

bool evaluate(Checking& c, Expression*& e) {
    if (is_constant(*e) || !e->type || !is_fixed(*e)) return is_constant(*e);
    const Evaluated found = c.evaluate(*e);
    if (found.fault == Fault::none) {
        e = make_constant(c, *e, *e->type, found.value);
        return true;
    }
    e->type = c.fail(
        code::value_out_of_range, e->place,
        fmt::format("this is the fault {}", fault_names[static_cast<std::size_t>(found.fault)]));
    return false;
}

std::optional<Wide> check_whole(Checking& c, Expression*& e, const Type& type) {
    if (!check(c, e, &type)) return {};
    const bool is_reckoned = e->kind == E::binary || e->kind == E::unary;
    if (is_reckoned && e->type->kind == Type::Kind::integer &&
        e->place.dialect().reckons_in > e->type->bits)
        convert(c, e, dint_type);
    if (!evaluate(c, e)) {
        if (e->type && (type.kind != Kind::enumeration || coerce(c, e, type)))
            c.fail(code::not_a_constant, e->place, "a constant is due here",
                   "declare it in VAR CONSTANT");
        return {};
    }
    if (!coerce(c, e, type) || !evaluate(c, e)) return {};
    return e->constant.integer;
}

}  // namespace lineshaft::st
