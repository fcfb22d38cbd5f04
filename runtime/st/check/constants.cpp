#include "runtime/st/check/constants.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/code/machine.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/generate/generator.hpp"

namespace lineshaft::st {

namespace {

void fold_binary(Checking& c, Expression& e, const Constant& a, const Constant& b) {
    const Type& operand = *e.operands[0]->type;
    const bool real = operand.is_real() || e.operands[1]->type->is_real();
    const double x = as_real(*e.operands[0]), y = as_real(*e.operands[1]);
    const bool less = real ? x < y : a.integer < b.integer;
    const bool same = real ? x == y : a.integer == b.integer;
    const bool more = real ? x > y : a.integer > b.integer;
    const bool divides = e.op == Word::divided || e.op == Word::mod_;
    if (divides && !real && b.integer == 0) {
        c.fail("L0908", e.operands[1]->place, "this divides by zero");
        e.type = nullptr;
        return;
    }
    Constant result;
    switch (e.op) {
        case Word::less:
            return become_boolean(e, less);
        case Word::less_or_equal:
            return become_boolean(e, less || same);
        case Word::greater:
            return become_boolean(e, more);
        case Word::greater_or_equal:
            return become_boolean(e, more || same);
        case Word::equal:
            return become_boolean(e, same);
        case Word::unequal:
            return become_boolean(e, !same);
        case Word::and_:
        case Word::and_then_:
            result.integer = a.integer & b.integer;
            break;
        case Word::or_:
        case Word::or_else_:
            result.integer = a.integer | b.integer;
            break;
        case Word::xor_:
            result.integer = a.integer ^ b.integer;
            break;
        case Word::plus:
            result = {a.integer + b.integer, x + y};
            break;
        case Word::minus:
            result = {a.integer - b.integer, x - y};
            break;
        case Word::times:
            result = {product(a.integer, b.integer), x * y};
            break;
        case Word::divided:
            result = {real ? 0 : a.integer / b.integer, x / y};
            break;
        case Word::mod_:
            result.integer = a.integer % b.integer;
            break;
        default:
            return;
    }
    const Type& type = *e.type;
    if (type.kind == Kind::time && real)
        result.integer = static_cast<Wide>(std::nearbyint(result.real));
    if (type.kind == Kind::real && type.bits == 32) result.real = static_cast<float>(result.real);
    if (!type.is_any() && !type.is_real()) result.integer = wrapped(type, result.integer);
    const Wide most = Wide{1} << 64;
    if (type.is_any() && (result.integer >= most || result.integer <= -most)) {
        c.fail("L0908", e.place, "the result is out of range");
        e.type = nullptr;
        return;
    }
    become(e, type, result);
}

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

Constant constant_of(const Type& type, const std::uint64_t* slots) {
    if (type.kind == Kind::text)
        return {.text = {reinterpret_cast<const char*>(slots + 1), std::size_t{*slots}}};
    if (type.is_real()) return {.real = std::bit_cast<double>(*slots)};
    return {.integer = type.is_unsigned_64() ? Wide{*slots} : static_cast<std::int64_t>(*slots)};
}

}  // namespace

void fold_unary(Expression& e, const Constant& value) {
    const Type& type = *e.type;
    Constant result = value;
    if (e.op == Word::minus) {
        result.real = -value.real;
        result.integer = type.is_any() ? -value.integer : wrapped(type, -value.integer);
    } else if (e.op == Word::not_) {
        result.integer = wrapped(type, ~value.integer);
    }
    become(e, type, result);
}

void fold(Checking& c, Expression& e) {
    if (!is_constant(*e.operands[0]) || !is_constant(*e.operands[1])) return;
    fold_binary(c, e, e.operands[0]->constant, e.operands[1]->constant);
}

bool evaluate(Checking& c, Expression& e) {
    if (is_constant(e) || !e.type || !is_fixed(e)) return is_constant(e);
    Pou pou{.place = e.place};
    Checked alone;
    Type block{.kind = Kind::block};
    Routine& routine = alone.routines.emplace_back();
    routine.pou = &pou;
    routine.type = &block;
    block.routine = &routine;
    Variable& result = routine.variables.emplace_back();
    result.name.place = e.place;
    result.type = e.type;
    Expression target{.kind = E::name, .place = e.place};
    target.type = e.type;
    target.variable = &result;
    Statement assigned{.place = e.place, .target = &target, .value = &e};
    pou.body = {&assigned};
    alone.order = {&routine};
    Diagnostics wrong;
    Generated made = generate(alone, wrong, {});
    std::vector<std::uint64_t>& image = made.images.at(&block);
    Scan scan;
    const Fault fault = execute(made.code, made.code.routines.front(),
                                reinterpret_cast<std::byte*>(image.data()), scan, {}, 1, nullptr);
    if (fault == Fault::none) {
        become(e, *e.type, constant_of(*e.type, &image[result.slot]));
        return true;
    }
    e.type =
        c.fail("L0908", e.place,
               fmt::format("this is the fault {}", fault_names[static_cast<std::size_t>(fault)]));
    return false;
}

std::optional<Wide> check_whole(Checking& c, Expression*& e, const Type& type) {
    if (!check(c, *e, &type)) return {};
    if (!evaluate(c, *e)) {
        if (e->type)
            c.fail("L0913", e->place, "a constant is due here", "declare it in VAR CONSTANT");
        return {};
    }
    if (!coerce(c, e, type)) return {};
    return e->constant.integer;
}

}  // namespace lineshaft::st
