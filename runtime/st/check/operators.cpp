#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/implicit_checks.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/variants.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

/// CODESYS: `SHL(1, i)`
bool is_shifted_number(const Expression& e) {
    if (e.kind != E::call || e.operands[0]->kind != E::name || e.arguments.empty()) return false;
    const StandardFunction* function = find_standard_function(e.operands[0]->token.text);
    const Expression* given = e.arguments.front().value;
    return function && function->typing == Typing::places && given && given->kind == E::constant &&
           e.place.dialect().is_loose;
}

/// `SEL(b, 16#0, 16#1)`, `MAX(1, 2)`, `EXPT(2, 5)`
bool is_call_of_literals(const Expression& e) {
    if (e.kind != E::call || e.operands[0]->kind != E::name || e.arguments.empty()) return false;
    const StandardFunction* function = find_standard_function(e.operands[0]->token.text);
    if (!function || e.place.dialect().literals_suit_their_use) return false;
    const bool chooses = function->typing == Typing::chosen;
    const auto is_whole = [](const Argument& argument) {
        const Expression* given = argument.value;
        return given && given->kind == E::constant && given->token.word == Word::integer;
    };
    const bool is_open = chooses || function->typing == Typing::common ||
                         (function->typing == Typing::operation && function->word == Word::power);
    return is_open && std::all_of(e.arguments.begin() + chooses, e.arguments.end(), is_whole);
}

/// `2 ** 5`
bool is_power_of_literals(const Expression& e) {
    return e.kind == E::binary && e.op == Word::power && e.operands[0]->kind == E::constant &&
           e.operands[1]->kind == E::constant;
}

/// Numbers without a type that are as wide as what they are for.
bool is_mask(const Expression& e) {
    if (e.kind == E::unary) return e.op == Word::not_ && e.operands[0]->kind == E::constant;
    if (e.kind == E::call) return is_shifted_number(e) || is_call_of_literals(e);
    if (e.kind != E::binary || !is_logic(e.op)) return is_power_of_literals(e);
    const Expression &left = *e.operands[0], &right = *e.operands[1];
    return (is_mask(left) && (is_mask(right) || right.kind == E::constant)) ||
           (is_mask(right) && left.kind == E::constant);
}

/// All of its numbers are of the type.
bool suits(Checking& c, Expression& mask, const Type* type) {
    if (!type || mask.kind != E::call || !is_call_of_literals(mask)) return true;
    const bool chooses =
        find_standard_function(mask.operands[0]->token.text)->typing == Typing::chosen;
    return std::all_of(
        mask.arguments.begin() + chooses, mask.arguments.end(), [&](Argument& argument) {
            const Wide value = check(c, argument.value) ? argument.value->constant.integer : 0;
            const bool is_bit = type->kind == Kind::boolean && (value == 0 || value == 1);
            return is_bit || (value >= smallest(*type) && value <= largest(*type));
        });
}

/// `w AND NOT 16#FF`, `w OR SHL(1, i)`, `w OR SEL(b, 1, 2)`: the mask is as wide as what it is for.
void check_masks(Checking& c, Expression& e, const Type* expected) {
    for (const int i : {0, 1}) {
        Expression *&mask = e.operands[i], *&beside = e.operands[1 - i];
        if (!is_mask(*mask)) continue;
        const Type* other = is_mask(*beside) ? nullptr : check(c, beside);
        const bool has_width = other && (other->kind == Kind::bits ||
                                         (other->kind == Kind::integer && mask->kind == E::call));
        const Type* due = has_width && suits(c, *mask, other) ? other : expected;
        check(c, mask, suits(c, *mask, due) ? due : nullptr);
    }
}

/// In CODESYS an enumeration's value is its number to a sign and to what works on bits, too;
/// 'strict' forbids the sign alone.
void take_number_of_enumeration(Checking& c, Expression*& operand, bool may_be_strict) {
    if (operand->place.dialect().enumerations_are_numbers &&
        (may_be_strict || !operand->type->is_strict))
        enumeration_becomes_number(c, operand);
}

const Type* check_logic(Checking& c, Expression*& e) {
    for (Expression*& operand : e->operands)
        if (operand) take_number_of_enumeration(c, operand, true);
    const auto is_truth = [](const Expression* o) { return o->type->kind == Kind::boolean; };
    const bool of_truths = std::ranges::any_of(e->operands, is_truth);
    if (!of_truths) reinterpret(c, *e, Kind::integer);
    const Type &a = *e->operands[0]->type, &b = *e->operands[1]->type;
    for (const Expression* operand : e->operands) {
        const Type& type = *operand->type;
        if (type.kind == Kind::boolean || type.is_bits() || type.kind == Kind::any_integer)
            continue;
        return c.fail(code::type_does_not_fit, operand->place,
                      fmt::format("{} does not go with {}", shown(e->op), describe(type)),
                      type.is_number() ? "compare it first, as in 'x <> 0', or convert it to a WORD"
                                       : "it takes BOOL and bit strings");
    }
    const bool lazy = e->op == Word::and_then_ || e->op == Word::or_else_;
    if (lazy && (a.kind != Kind::boolean || b.kind != Kind::boolean))
        return c.fail(code::type_does_not_fit, e->token.place,
                      fmt::format("{} takes two BOOL", shown(e->op)));
    // MatIEC makes && and || of them.
    const bool is_shortened = (e->op == Word::and_ || e->op == Word::or_) &&
                              e->place.dialect().ands_end_early && a.kind == Kind::boolean &&
                              b.kind == Kind::boolean;
    if (is_shortened)
        e = make_binary(c, e->place, e->token.place,
                        e->op == Word::and_ ? Word::and_then_ : Word::or_else_, e->operands[0],
                        e->operands[1]);
    e->type = unite(c, *e);
    if (e->type) fold(c, e);
    return e->type;
}

bool is_numeric(const Type& type) {
    return type.is_number() || type.is_bits();
}

/// Beside a number, and where an order is asked for, an enumeration's value is its number.
void take_numbers(Checking& c, Expression& e, bool always) {
    for (const int i : {0, 1})
        if (always || is_numeric(*e.operands[1 - i]->type))
            enumeration_becomes_number(c, e.operands[i]);
}

/// In B&R a BOOL is 0 or 1 beside a number, and to what reckons.
void take_truths(Checking& c, Expression& e, bool always) {
    for (const int i : {0, 1}) {
        const Type& other = e.operands[1 - i]->type->plain();
        const bool counts = e.place.dialect().bool_is_number &&
                            e.operands[i]->type->kind == Kind::boolean &&
                            (always || (other.is_number() && !other.is_any()));
        if (counts)
            convert(c, e.operands[i], other.kind == Kind::integer ? other : integer_type(8, false));
    }
}

/// `a.x = b.x AND a.y = b.y`
Expression* equal_parts(Checking& c, const Expression& like, Expression* a, Expression* b,
                        const Type& type) {
    const auto join = [&](Word op, Expression* left, Expression* right) {
        return left ? make_binary(c, like.place, like.token.place, op, left, right) : right;
    };
    Expression* made = nullptr;
    if (type.kind == Kind::structure) {
        for (const Variable* member : type.members)
            made = join(Word::and_, made,
                        equal_parts(c, like, make_member(c, a, member->text),
                                    make_member(c, b, member->text), *member->type));
    } else if (type.kind == Kind::array) {
        for (std::int64_t i = type.lower; i <= type.upper; ++i)
            made = join(
                Word::and_, made,
                equal_parts(c, like, make_element(c, a, i), make_element(c, b, i), *type.element));
    }
    return made ? made : join(Word::equal, a, b);
}

/// An S7-1500 compares structures and arrays of one type.
bool compares_parts(const Expression& e) {
    const Expression &left = *e.operands[0], &right = *e.operands[1];
    const Type& type = *left.type;
    constexpr Wide most = 256;
    return (e.op == Word::equal || e.op == Word::unequal) &&
           e.place.dialect().compares_structures && same_type(type, *right.type) &&
           (type.kind == Kind::structure || (type.kind == Kind::array && !type.is_open)) &&
           !has_call(left) && !has_call(right) && count_parts(type) <= most;
}

const Type* check_comparison(Checking& c, Expression*& e) {
    take_numbers(c, *e, e->op != Word::equal && e->op != Word::unequal);
    take_truths(c, *e, false);
    unite_texts(c, e->operands[0], e->operands[1]);
    const auto is_kind = [&](Kind kind) {
        return std::ranges::any_of(e->operands,
                                   [&](const Expression* o) { return o->type->kind == kind; });
    };
    if (is_kind(Kind::bits) && is_kind(Kind::integer)) reinterpret(c, *e, Kind::bits);
    if (is_dtl(*e->operands[0]->type) && is_dtl(*e->operands[1]->type)) become_moments(c, *e);
    const Type &a = *e->operands[0]->type, &b = *e->operands[1]->type;
    const bool order = e->op != Word::equal && e->op != Word::unequal;
    if (compares_parts(*e)) {
        const bool differs = e->op == Word::unequal;
        e = equal_parts(c, *e, e->operands[0], e->operands[1], a);
        if (differs) e = make_not(c, e);
        return check(c, e);
    }
    if (!order && is_kind(Kind::interface)) {
        const int other = e->operands[0]->type->kind == Kind::interface ? 1 : 0;
        Expression*& operand = e->operands[other];
        const bool fits = operand->type->kind == Kind::interface ||
                          coerce(c, operand, *e->operands[1 - other]->type);
        return fits ? &bool_type : nullptr;
    }
    if (a.kind == Kind::text && b.kind == Kind::text) return &bool_type;
    if (a.kind == Kind::text || b.kind == Kind::text)
        return refuse_operands(c, *e, "a STRING is compared with a STRING");
    for (const Type* type : {&a, &b}) {
        const bool is_instance = type->kind == Kind::interface;
        const bool fits = type->is_scalar() && !(order && type->kind == Kind::enumeration);
        if (!fits || is_instance)
            return c.fail(code::type_does_not_fit, e->token.place,
                          fmt::format("'{}' does not compare {}", shown(e->op), describe(*type)),
                          is_instance ? "instances are equal or not"
                          : type->is_scalar()
                              ? "the values of an enumeration are equal or not; compare TO_INT(...)"
                              : "compare its parts one by one");
    }
    if (!unite(c, *e)) return nullptr;
    e->type = &bool_type;
    fold(c, e);
    return e->type;
}

const Type* check_arithmetic(Checking& c, Expression*& e, const Type* expected) {
    if (is_dtl(*e->operands[0]->type) || is_dtl(*e->operands[1]->type))
        return check_dtl_arithmetic(c, e);
    for (const Expression* operand : e->operands)
        if (operand->type->is_strict && e->place.dialect().is_loose)
            return c.fail(
                code::type_does_not_fit, operand->place,
                fmt::format("'{}' does not go with {}", shown(e->op), describe(*operand->type)),
                "it has the attribute 'strict': convert it, TO_INT(...)");
    take_numbers(c, *e, true);
    const Type &a = *e->operands[0]->type, &b = *e->operands[1]->type;
    if (a.is_time() || b.is_time()) return check_time_arithmetic(c, e);
    reinterpret(c, *e, Kind::bits, expected);
    take_truths(c, *e, true);
    for (const Expression* operand : e->operands) {
        const Type& type = *operand->type;
        if (type.is_number() || type.is_any()) continue;
        std::string help;
        if (type.kind == Kind::boolean) help = "convert it: BOOL_TO_INT(...)";
        if (type.kind == Kind::enumeration) help = "convert it: TO_INT(...)";
        if (type.kind == Kind::text) help = "join texts with CONCAT(...)";
        return c.fail(code::type_does_not_fit, operand->place,
                      fmt::format("'{}' does not go with {}", shown(e->op), describe(type)), help);
    }
    e->type = unite(c, *e, expected);
    if (e->type && e->type->kind == Kind::any_bits) e->type = &any_integer_type;
    if (e->type && e->op == Word::mod_ && e->type->is_real())
        return c.fail(code::type_does_not_fit, e->token.place, "MOD takes whole numbers",
                      "write a - TRUNC(a / b) * b");
    if (e->type && (e->op == Word::divided || e->op == Word::mod_))
        guard_divisor(c, e->operands[1]);
    if (e->type) fold(c, e);
    return e->type;
}

/// CODESYS: a power of two REALs is one, of which either may be a literal; any other is an LREAL.
bool are_single(const Type& a, const Type& b) {
    const auto fits = [](const Type& t) { return is_single(t) || t.kind == Kind::any_real; };
    return fits(a) && fits(b) && (is_single(a) || is_single(b));
}

bool may_be_single(const Type& a, const Type& b, bool is_due) {
    const auto fits = [](const Type& t) { return t.is_any() || t.bits <= 32; };
    return fits(a) && fits(b) && (is_due || is_single(a) || is_single(b));
}

/// A power of two whole numbers without a type: whole where no real number is due, in SCL where a
/// whole one is, as all other powers are real there. Empty: it is none, or is not known yet.
std::optional<const Type*> check_whole_power(Checking& c, Expression*& e, const Type* expected) {
    const Expression &base = *e->operands[0], &exponent = *e->operands[1];
    const auto is_whole = [](const Expression& o) {
        return is_constant(o) && o.type->kind == Kind::any_integer;
    };
    if (!is_whole(base) || !is_whole(exponent) || exponent.constant.integer < 0) return {};
    constexpr Wide most = Wide{1} << 64;
    Wide value = 1;
    for (Wide i = 0; i < exponent.constant.integer && value < most && value > -most; ++i)
        value = product(value, base.constant.integer);
    if (exponent.constant.integer > 64 && base.constant.integer > 1) return {};
    const bool is_beyond = value >= most || value <= -most;
    const Dialect& dialect = e->place.dialect();
    const bool is_whole_alone =
        dialect.literals_suit_their_use && !dialect.real_results_reckon_as_real;
    if (is_whole_alone || (expected && !expected->is_real())) {
        if (is_beyond)
            return c.fail(code::value_out_of_range, e->place, "the result is out of range");
        return become(c, e, any_integer_type, {.integer = value});
    }
    if (is_beyond) return {};
    return become(c, e, any_real_type, {.real = static_cast<double>(value)});
}

const Type* check_power(Checking& c, Expression*& e, const Type* expected) {
    Expression *&left = e->operands[0], *&right = e->operands[1];
    for (Expression*& operand : e->operands) become_number(c, operand);
    for (Expression* operand : e->operands)
        if (!operand->type->is_number())
            return c.fail(code::type_does_not_fit, operand->place,
                          fmt::format("'**' does not go with {}", describe(*operand->type)));
    if (const auto whole = check_whole_power(c, e, expected)) return *whole;
    const bool is_due = expected && is_single(*expected),
               is_wide = e->place.dialect().real_literals_are_lreal;
    const bool narrow = is_wide ? are_single(*left->type, *right->type)
                                : may_be_single(*left->type, *right->type, is_due);
    const Type& type = narrow ? real_type : lreal_type;
    const auto widen = [&](Expression*& operand) {
        if (widens(*operand->type, type) || operand->type->is_any())
            return coerce(c, operand, type);
        convert(c, operand, type);
        return true;
    };
    if (!widen(left) || !widen(right)) return nullptr;
    if (narrow || !is_due || !is_wide) return &type;
    e->type = &type;
    return convert(c, e, real_type);
}

}  // namespace

Nothing refuse_operands(Checking& c, const Expression& e, std::string help) {
    return c.fail(code::type_does_not_fit, e.token.place,
                  fmt::format("'{}' does not go with {} and {}", shown(e.op),
                              describe(*e.operands[0]->type), describe(*e.operands[1]->type)),
                  std::move(help));
}

/// CODESYS: what is below 0 of a UDINT is a DINT, of a ULINT a LINT.
static void take_sign(Checking& c, Expression*& operand) {
    const Type& type = operand->type->plain();
    const bool is_unsigned = type.kind == Kind::integer && !type.is_signed && type.bits >= 32;
    if (is_unsigned && operand->place.dialect().reckons_in_registers)
        convert(c, operand, integer_type(type.bits, true));
}

/// `word := NOT 0`: a whole number without a type is one of those that are due.
static bool take_width_of_result(Checking& c, Expression*& operand, const Type* expected) {
    const Kind kind = operand->type->kind;
    const bool is_open = kind == Kind::any_integer || kind == Kind::any_bits;
    const bool is_due = expected && (expected->kind == Kind::integer || expected->is_bits());
    return !is_open || !is_due || coerce(c, operand, expected->plain());
}

const Type* check_unary(Checking& c, Expression*& e, const Type* expected) {
    Expression*& operand = e->operands[0];
    const Type* type = check(c, operand, expected);
    if (!type) return nullptr;
    take_number_of_enumeration(c, operand, e->op == Word::not_);
    if (e->op == Word::not_ && !take_width_of_result(c, operand, expected)) return nullptr;
    reinterpret(c, *e, e->op == Word::not_ ? Kind::integer : Kind::bits, expected);
    if (e->op == Word::minus) take_sign(c, operand);
    type = operand->type;
    const bool fits = e->op == Word::not_ ? type->kind == Kind::boolean || type->is_bits()
                                          : type->is_integer() || type->is_real() ||
                                                type->kind == Kind::time || type->is_bits();
    if (!fits)
        return c.fail(code::type_does_not_fit, e->place,
                      fmt::format("{} does not go with {}", shown(e->op), describe(*type)),
                      e->op == Word::not_ ? "NOT takes a BOOL or a bit string" : "");
    if (e->op == Word::not_ && type->kind == Kind::any_bits)
        return c.fail(code::type_does_not_fit, e->place, "the width of this number is not known",
                      "write its type: NOT WORD#16#FF");
    e->type = &type->plain();
    if (type->kind == Kind::any_bits) e->type = &any_integer_type;
    const bool counts_ms =
        e->place.dialect().times_count_ms && type->kind == Kind::time && !type->counts_ns;
    if (counts_ms) e->type = &ltime_type;
    if (is_constant(*operand)) fold_unary(c, e);
    return counts_ms ? convert(c, e, time_type) : e->type;
}

bool is_lreal(const Type* type) {
    return type && type->plain().kind == Kind::real && !is_single(*type);
}

/// `k * 0.1 < x` and `k * 0.1 + x`, where nothing else is due: an LREAL behind what is reckoned.
bool goes_with_lreal(Checking& c, Expression& e) {
    Expression *&left = e.operands[0], *&right = e.operands[1];
    const bool is_variable = right->kind == E::member || right->kind == E::index ||
                             (right->kind == E::name && !right->token.quoted &&
                              find_variable(c, right->token) != nullptr);
    return left->kind == E::binary && !is_logic(e.op) && is_variable && is_lreal(check(c, right));
}

/// What is due on the right of a comparison. A sum is not kept in the type on the left: in
/// `s > 255 - s` of a SINT it is a DINT.
const Type* due_beside(const Type* left, const Expression& right) {
    const bool is_reckoned = right.kind == E::binary || right.kind == E::unary;
    const bool is_short = left && left->kind == Kind::integer && left->bits < dint_type.bits;
    return is_reckoned && is_short ? &dint_type : left;
}

const Type* check_binary(Checking& c, Expression*& e, const Type* expected) {
    Expression *&left = e->operands[0], *&right = e->operands[1];
    if (is_comparison(e->op)) take_type_names(c, *e);
    const bool may_be_due = !is_logic(e->op) || (expected && expected->kind == Kind::bits);
    const Type* wanted = is_comparison(e->op) || !may_be_due ? nullptr : expected;
    const bool name_first = left->kind == E::name && is_comparison(e->op);
    if (name_first && (left->token.quoted || !find_variable(c, left->token))) {
        check(c, right);
        check(c, left, right->type);
    }
    if (is_logic(e->op)) check_masks(c, *e, expected);
    if (!wanted && goes_with_lreal(c, *e)) wanted = &lreal_type;
    check(c, left, wanted);
    if (!wanted && is_lreal(left->type)) wanted = left->type;
    check(c, right, is_comparison(e->op) ? due_beside(left->type, *right) : wanted);
    if (!left->type || !right->type) return nullptr;
    if (is_comparison(e->op)) take_null_variant(c, *e);
    if (is_comparison(e->op)) take_addresses(c, *e);
    if (left->type->is_reference() || right->type->is_reference())
        return check_reference_operator(c, e, expected);
    if (is_logic(e->op)) return check_logic(c, e);
    if (is_comparison(e->op)) return check_comparison(c, e);
    if (e->op == Word::power) return check_power(c, e, expected);
    return check_arithmetic(c, e, expected);
}

}  // namespace lineshaft::st
