#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/mixed_signs.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/open_arrays.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/untyped_arguments.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

/// One number is without type, the other with; one of them is real. `real` is what the first is
/// beside an integer.
const Type* mixed(const Type& a, const Type& b, const Type& real) {
    if (a.is_any() && b.is_any()) return a.is_real() ? &a : &b;
    const Type &any = a.is_any() ? a : b, &typed = a.is_any() ? b : a;
    return any.is_real() ? common_type(typed, real) : &typed;
}

/// A bit string beside an integer is taken for the number.
const Type* common_number(const Type& a, const Type& b, const Place& place) {
    const auto number = [](const Type& type) -> const Type& {
        return type.kind == Kind::bits ? integer_type(type.bits, false) : type;
    };
    const bool mixes =
        (a.kind == Kind::bits && b.is_integer()) || (a.is_integer() && b.kind == Kind::bits);
    return mixes ? met_type(number(a), number(b), place) : nullptr;
}

const Type& real_for(const Type& type) {
    return type.kind == Kind::real && type.bits == 32 ? real_type : lreal_type;
}

/// The first argument is not what the function takes.
const Type* refuse(Checking& c, const Expression& call, const char* what, const Type& found,
                   std::string help = {}) {
    return c.fail(code::type_does_not_fit, call.arguments[0].value->place,
                  fmt::format("{} takes {}, not {}", call.standard->name, what, describe(found)),
                  std::move(help));
}

const Type* check_element_count(Checking& c, Expression*& e) {
    const Type* array = e->arguments[0].value->type;
    if (array->kind != Kind::array) return refuse(c, *e, "an array", *array);
    std::int64_t count = 1;
    for (; array; array = array->has_inner ? array->element : nullptr)
        count *= array->upper - array->lower + 1;
    return become(c, e, dint_type, {.integer = count});
}

/// What is due, if that is an integer, in CODESYS one of at most 32 bits.
const Type& type_of_bound(const Expression& call, const Type* expected) {
    const bool is_due = expected && expected->kind == Kind::integer &&
                        (expected->bits <= 32 || !call.place.dialect().bounds_have_32_bits);
    return is_due ? expected->plain() : dint_type;
}

/// A variable says the dimension: MUX over those of all, whose fault a dimension that there
/// is not stays in every dialect.
const Type* check_chosen_bound(Checking& c, Expression*& e, const Type& result) {
    const bool is_lower = e->standard->typing == Typing::lower_bound;
    Expression *array = e->arguments[0].value, *wanted = e->arguments[1].value;
    if (!wanted->type->is_integer())
        return c.fail(
            code::type_does_not_fit, wanted->place,
            fmt::format("a dimension is a whole number, not {}", describe(*wanted->type)));
    Expression* first = make_constant(c, *e, lint_type, {.integer = 1});
    std::vector<Argument> choices{
        {.value = make_binary(c, e->place, e->place, Word::minus, wanted, first)}};
    const Type* type = array->type;
    for (std::size_t i = 0; type->is_open_array() && i < type->dimensions; ++i)
        choices.push_back({.value = bound_of(c, *array, is_lower, i)});
    for (; type->kind == Kind::array; type = type->element) {
        const Constant bound{.integer = is_lower ? type->lower : type->upper};
        choices.push_back({.value = make_constant(c, *e, lint_type, bound)});
        if (!type->has_inner) break;
    }
    e = make_call(c, *e, make_name(c, *e->operands[0], "MUX"), std::move(choices));
    e->standard = find_standard_function("MUX");
    e->type = &lint_type;
    for (Argument& choice : e->arguments)
        if (!check(c, choice.value, &lint_type) || !coerce(c, choice.value, lint_type))
            return nullptr;
    convert(c, e, result);
    return e->type = &result;
}

const Type* check_open_bound(Checking& c, Expression*& e, const Type& result) {
    Expression*& wanted = e->arguments[1].value;
    const auto dimension = check_whole(c, wanted, lint_type);
    if (!dimension) return nullptr;
    Expression* array = e->arguments[0].value;
    if (*dimension < 1 || *dimension > Wide{array->type->dimensions})
        return c.fail(code::value_out_of_range, wanted->place,
                      fmt::format("the array's dimensions are 1 to {}", array->type->dimensions));
    const bool is_lower = e->standard->typing == Typing::lower_bound;
    e = bound_of(c, *array, is_lower, static_cast<std::size_t>(*dimension) - 1);
    if (!e->type) return nullptr;
    convert(c, e, result);
    return e->type = &result;
}

const Type* check_bound(Checking& c, Expression*& e, const Type* expected) {
    const Type* array = e->arguments[0].value->type;
    if (array->kind != Kind::array && !array->is_open_array())
        return refuse(c, *e, "an array", *array);
    Expression*& wanted = e->arguments[1].value;
    if (!is_constant(*wanted)) return check_chosen_bound(c, e, type_of_bound(*e, expected));
    if (array->is_open_array()) return check_open_bound(c, e, type_of_bound(*e, expected));
    const auto dimension = check_whole(c, wanted, lint_type);
    if (!dimension) return nullptr;
    Wide at = 1;
    for (; at != *dimension && array->has_inner; ++at) array = array->element;
    if (at != *dimension)
        return c.fail(code::value_out_of_range, wanted->place,
                      fmt::format("the array's dimensions are 1 to {}", static_cast<int>(at)));
    const bool is_lower = e->standard->typing == Typing::lower_bound;
    return become(c, e, dint_type, {.integer = is_lower ? array->lower : array->upper});
}

/// `ADD(a, b, c)` is `a + b + c`, `GT(a, b, c)` is `a > b AND b > c`.
Expression* join(Checking& c, const Expression& call, Word op) {
    const auto joined = [&](Word word, Expression* left, Expression* right) {
        return make_binary(c, call.place, call.operands[0]->place, word, left, right);
    };
    const bool compares = op >= Word::less && op <= Word::unequal;
    const auto& arguments = call.arguments;
    Expression* all = joined(op, arguments[0].value, arguments[1].value);
    for (std::size_t i = 2; i < arguments.size(); ++i) {
        Expression *before = arguments[i - 1].value, *value = arguments[i].value;
        if (compares && has_call(*before))
            return c.fail(code::not_supported, before->place,
                          "a function between others is not supported here",
                          "assign its value to a variable, and compare that");
        all = compares ? joined(Word::and_, all, joined(op, make_copy(c, *before), value))
                       : joined(op, all, value);
    }
    return all;
}

/// SCALE_X of a REAL or LREAL; into an integer, which MIN and MAX are then, it rounds.
const Type* check_scale(Checking& c, Expression*& e, const Type* expected) {
    auto& arguments = e->arguments;
    const auto narrow = [](const Type& type) {
        return type.is_any() || (type.kind == Kind::real ? type.bits == 32 : type.bits <= 16);
    };
    const bool is_narrow =
        std::ranges::all_of(arguments, [&](const Argument& a) { return narrow(*a.value->type); });
    const bool known = expected && (expected->kind == Kind::integer || expected->is_real());
    const Type& real = is_narrow && (!known || narrow(*expected)) ? real_type : lreal_type;
    const Type* limits = arguments[0].value->type;
    const Type& result = known ? expected->plain() : limits->kind == Kind::integer ? *limits : real;
    for (Argument& argument : arguments)
        if (!coerce(c, argument.value, real)) return nullptr;
    return convert_result(c, e, real, result.is_real() ? real : result);
}

const Type& given_type(const Expression& call, std::size_t argument) {
    return *call.arguments[argument].value->type;
}

bool coerce_from(Checking& c, Expression& call, std::size_t first, const Type& type) {
    bool good = true;
    for (std::size_t i = first; i < call.arguments.size(); ++i)
        good &= (type.kind == Kind::text && given_type(call, i).kind == type.kind) ||
                coerce(c, call.arguments[i].value, type);
    return good;
}

/// An enumeration with numbers is what these are, where that is not all there is.
const Type& number_type(const Type& type, const Type& other) {
    return type.has_numbers && !same_type(type, other) ? *type.base : type;
}

/// What values of both types have in common; null if there is nothing. `real` as in `mixed`;
/// at `place` a bit string may be a number among real ones.
const Type* common_of(const Type& one, const Type& two, const Type& real, const Place& place) {
    const bool counts = place.dialect().bits_count_in_reals;
    const Type &a = number_type(one, two), &b = number_type(two, one);
    const Type* common = &a;
    if (counts && a.kind == Kind::bits && b.is_real() && !b.is_any()) return &b;
    if (counts && b.kind == Kind::bits && a.is_real() && !a.is_any()) return &a;
    if ((a.is_any() || b.is_any()) && a.is_real() != b.is_real())
        common = mixed(a, b, real);
    else if (a.is_any() && (!b.is_any() || b.is_real()))
        common = &b;
    else if (!b.is_any() && !same_type(a, b) && a.is_scalar())
        common = met_type(a, b, place);
    return common ? common : common_number(a, b, place);
}

/// The type that all arguments from `first` on have in common, which they become.
const Type* unite_from(Checking& c, Expression& call, std::size_t first, const Type* expected) {
    const Type* common = &given_type(call, first);
    const Type& real = real_of_literals(call, first, expected);
    for (std::size_t i = first + 1; i < call.arguments.size() && common; ++i)
        common = common_of(*common, given_type(call, i), real, call.place);
    if (!common)
        return c.fail(code::conversion_may_lose, call.place,
                      fmt::format("the arguments of {} have no common type", call.standard->name),
                      "convert them");
    const bool is_bit = expected && expected->kind == Kind::boolean && are_bits(call, first);
    const bool is_wanted = is_bit || (expected && (expected->is_number() || expected->is_bits()));
    if (common->is_any() && is_wanted)
        common = common->is_real() ? &expected->plain()
                                   : &type_of_literals(call, first, expected->plain());
    if (common->is_any()) common = common->is_real() ? &lreal_type : &dint_type;
    common = &type_with_literals(call, first, *common, expected);
    const auto is_beyond = [&](const Argument& argument) {
        return is_beyond_single(*argument.value, *common, expected);
    };
    const auto begin = call.arguments.begin() + static_cast<std::ptrdiff_t>(first);
    if (std::any_of(begin, call.arguments.end(), is_beyond)) common = &lreal_type;
    return coerce_from(c, call, first, common->plain()) ? &common->plain() : nullptr;
}

const Type* check_real(Checking& c, Expression& call, const Type* expected) {
    const Type& given = given_type(call, 0);
    const Generic result = call.standard->result;
    const bool is_integer = expected && expected->kind == Kind::integer;
    const bool suits =
        given.is_any() || (given.is_integer() && expected && widens(given, *expected));
    const bool is_wanted = suits && expected && expected->kind == Kind::real;
    const Type& type = is_wanted && result != Generic::any_int ? *expected : real_for(given);
    if (!coerce_from(c, call, 0, type)) return nullptr;
    if (result == Generic::any_int) return is_integer ? &expected->plain() : &dint_type;
    return result == Generic::boolean ? &bool_type : &type;
}

const Type* check_reals(Checking& c, Expression*& e, const Type* expected) {
    Expression& call = *e;
    const Type* type = unite_from(c, call, 0, expected);
    if (!type) return nullptr;
    const bool known = expected && expected->is_real() && !type->is_real();
    const Type& result = known ? real_for(*expected) : real_for(*type);
    const Type& real = known && widens(*type, result) ? result : real_for(*type);
    return coerce_from(c, call, 0, real) ? convert_result(c, e, real, result) : nullptr;
}

/// MIN, MAX, LIMIT and shifts of CODESYS take all types: there an enumeration's value is its
/// number.
void take_numbers_of_enumerations(Checking& c, Expression& call) {
    if (!call.place.dialect().enumerations_are_numbers) return;
    for (Argument& argument : call.arguments)
        if (argument.value->type->kind == Kind::enumeration)
            enumeration_becomes_number(c, argument.value);
}

/// The enumeration with 'strict' that all arguments are of, which takes no number; null: there is
/// none.
const Type* strict_of_all(const Expression& call) {
    const Type& first = *call.arguments[0].value->type;
    const auto is_it = [&](const Argument& argument) {
        return same_type(*argument.value->type, first);
    };
    const bool is_strict =
        first.kind == Kind::enumeration && first.is_strict && has_table_for(first);
    return is_strict && std::ranges::all_of(call.arguments, is_it) ? &first : nullptr;
}

bool is_text(const Argument& argument) {
    return argument.value->type->kind == Kind::text;
}

const Type* check_common(Checking& c, Expression*& e, const Type* expected) {
    Expression& call = *e;
    const Generic result = call.standard->result;
    if (result == Generic::any_elementary && std::ranges::all_of(call.arguments, is_text))
        return check_extreme_text(c, e);
    const Type* strict = result == Generic::any_elementary ? strict_of_all(call) : nullptr;
    if (result == Generic::any_elementary) take_numbers_of_enumerations(c, call);
    const Type* type = unite_from(c, call, 0, strict ? nullptr : expected);
    const bool takes_bits = result == Generic::any_ordered || result == Generic::any_elementary;
    const bool suits = !type || result == Generic::any || type->is_number() || type->is_time() ||
                       (takes_bits && type->kind == Kind::bits);
    if (!suits) return refuse(c, call, "numbers", *type);
    const Type* chosen = take_back(c, e, type, strict ? nullptr : expected);
    if (!chosen || !strict) return chosen;
    e->type = chosen;
    return convert(c, e, *strict);
}

/// MUX of a number that none has: CODESYS gives the last, MatIEC what the type begins with.
void choose_of_others(Checking& c, Expression*& e, const Type* type) {
    const OtherChoice other = e->place.dialect().other_choice;
    if (!type || e->has_else || other == OtherChoice::fault) return;
    std::vector<Argument> inputs = e->arguments;
    if (other == OtherChoice::initial && (type->is_scalar() || type->kind == Kind::text))
        inputs.push_back({.value = make_constant(c, *e, *type, {})});
    e = make_with(c, *e, std::move(inputs));
    e->has_else = true;
}

const Type* check_chosen(Checking& c, Expression*& e, const Type* expected) {
    Expression& call = *e;
    Expression*& choice = call.arguments[0].value;
    if (call.standard->parameters[0].type == Generic::boolean)
        return coerce(c, choice, bool_type)
                   ? take_back(c, e, unite_from(c, call, 1, expected), expected)
                   : nullptr;
    become_number(c, choice);
    if (choice->type->is_any() && !coerce(c, choice, lint_type)) return nullptr;
    look_in_register(c, choice);
    if (choice->type->kind != Kind::integer)
        return c.fail(code::type_does_not_fit, choice->place, "K of MUX is a whole number");
    const Type* type = unite_from(c, call, 1, expected);
    choose_of_others(c, e, type);
    return take_back(c, e, type, expected);
}

constexpr const char* write_its_type = "write its type, as in WORD#16#FF";

/// CODESYS: a number without a type is shifted as what is due, or as 32 bits.
void take_wide(Checking& c, Expression*& e, const Type* expected) {
    if (!e->type->is_any() || e->type->is_real() || !e->place.dialect().is_loose) return;
    const bool is_due =
        expected && (expected->kind == Kind::integer || expected->kind == Kind::bits) &&
        e->constant.integer >= smallest(*expected) && e->constant.integer <= largest(*expected);
    const bool is_long = e->constant.integer > largest(bits_type(32));
    coerce(c, e,
           is_due ? expected->plain() : integer_type(is_long ? 64 : 32, e->constant.integer < 0));
}

/// `SHL(16#D800, 10)` is a number without a type, too.
bool fold_shift(Checking& c, Expression*& e) {
    if (!e->place.dialect().is_loose || !same_name(e->standard->name, "shl")) return false;
    const Expression &given = *e->arguments[0].value, &places = *e->arguments[1].value;
    const bool are_constant = is_constant(given) && is_constant(places) && given.type->is_any() &&
                              places.type->is_integer() && places.constant.integer >= 0;
    if (!are_constant || given.type->is_real() || places.constant.integer > 63) return false;
    const Wide shifted = given.constant.integer << static_cast<int>(places.constant.integer);
    if (shifted > largest(lint_type) || shifted < smallest(lint_type)) return false;
    return become(c, e, any_integer_type, {.integer = shifted});
}

/// A shift of one bit by any place but 0 is FALSE, and its rotation does nothing.
const Type* check_shift_of_truth(Checking& c, Expression*& e) {
    Expression *given = e->arguments[0].value, *places = e->arguments[1].value;
    const bool rotates = same_name(e->standard->name.substr(0, 2), "ro");
    Expression* stays = make_binary(c, e->place, e->place, Word::equal, places,
                                    make_constant(c, *e, any_integer_type, {}));
    e = rotates ? given : make_binary(c, e->place, e->place, Word::and_, given, stays);
    return check(c, e);
}

const Type* check_places(Checking& c, Expression*& e, const Type* expected) {
    Expression& call = *e;
    Expression*& places = call.arguments[1].value;
    take_numbers_of_enumerations(c, call);
    become_number(c, places);
    take_width(c, call.arguments[0].value, expected);
    take_wide(c, call.arguments[0].value, expected);
    const Type &given = given_type(call, 0), &count = *places->type;
    if (!count.is_integer() && count.kind != Kind::any_bits)
        return c.fail(code::type_does_not_fit, places->place, "the number of places is an integer");
    if (!coerce(c, places, count.is_any() ? lint_type : count)) return nullptr;
    if (given.kind == Kind::boolean && !e->place.dialect().packs_as_s7)
        return check_shift_of_truth(c, e);
    if (given.kind != Kind::bits && given.kind != Kind::integer)
        return refuse(c, call, "a bit string", given, write_its_type);
    return call.standard->result == Generic::boolean ? &bool_type : &given.plain();
}

const Type* check_bits(Checking& c, Expression& call, const Type* expected) {
    const Generic result = call.standard->result;
    if (result == Generic::any_bit) take_width(c, call.arguments[0].value, expected);
    const Type& given = given_type(call, 0);
    if (given.kind == Kind::any_bits && result == Generic::integer)
        coerce(c, call.arguments[0].value, bits_type(64));
    if (given_type(call, 0).kind != Kind::bits)
        return refuse(c, call, "a bit string", given,
                      result == Generic::boolean ? "" : write_its_type);
    return result == Generic::boolean   ? &bool_type
           : result == Generic::integer ? &int_type
                                        : &given;
}

const Type* check_bit_number(Checking& c, Expression& call, const Type* expected) {
    Expression*& number = call.arguments[0].value;
    become_number(c, number);
    if (number->type->is_any() && !coerce(c, number, lint_type)) return nullptr;
    if (!number->type->is_integer()) return refuse(c, call, "a whole number", *number->type);
    return expected && expected->kind == Kind::bits ? expected : &bits_type(32);
}

const Type* check_texts(Checking& c, Expression& call) {
    const StandardFunction& f = *call.standard;
    bool is_wide = false;
    for (std::size_t i = 0; i < call.arguments.size(); ++i) {
        Expression*& value = call.arguments[i].value;
        const bool is_text = f.parameter(i).type == Generic::text;
        is_wide |= is_text && value->type->is_wide;
        if (is_text && value->type->is_character) coerce(c, value, string_type);
        if (!is_text) become_number(c, value);
        const Type& type = *value->type;
        if (is_text ? type.kind != Kind::text : !type.is_integer())
            return c.fail(code::type_does_not_fit, value->place,
                          fmt::format("expected {}, found {}",
                                      is_text ? "a STRING" : "a whole number", describe(type)));
        if (type.is_any() && !coerce(c, value, lint_type)) return nullptr;
    }
    for (Argument& argument : call.arguments)
        if (is_wide && argument.value->type->kind == Kind::text)
            coerce(c, argument.value, wide_string_type);
    return f.result != Generic::text ? &int_type : is_wide ? &wide_string_type : &string_type;
}

const Type* check_capacity(Checking& c, Expression*& e) {
    const Type& given = given_type(*e, 0);
    if (given.kind != Kind::text)
        return c.fail(code::type_does_not_fit, e->arguments[0].value->place,
                      fmt::format("expected a STRING, found {}", describe(given)));
    if (!given.is_open) e = make_constant(c, *e, int_type, {.integer = given.length});
    return &int_type;
}

/// What T_CONV means; empty: it is no conversion of or to a DTL.
std::string_view conversion_of_dtl(const Type& from, const Type& to) {
    if (is_dtl(from))
        return to.kind == Kind::date     ? "DTL_TO_DATE"
               : to.kind == Kind::clock  ? "DTL_TO_TOD"
               : to.kind == Kind::moment ? "DTL_TO_LDT"
                                         : "";
    if (!is_dtl(to)) return {};
    return from.kind == Kind::date     ? "DATE_TO_DTL"
           : from.kind == Kind::clock  ? "TOD_TO_DTL"
           : from.kind == Kind::moment ? "LDT_TO_DTL"
                                       : "";
}

/// S_CONV and T_CONV are the conversion that has a name.
const Type* check_wanted(Checking& c, Expression*& e, const Type* expected) {
    Expression* given = e->arguments[0].value;
    if (expected && (is_dtl(*given->type) || is_dtl(*expected))) {
        const std::string_view name = conversion_of_dtl(*given->type, *expected);
        if (!name.empty()) return check(c, e = make_call(c, name, given));
    }
    const bool is_known = expected && (expected->kind == Kind::text ||
                                       (expected->is_scalar() && !expected->is_any()));
    if (!is_known)
        return c.fail(code::type_does_not_fit, e->place,
                      fmt::format("what {} is to give is not known", e->standard->name),
                      "assign it to a variable, or write STRING_TO_INT(...)");
    const bool is_text = expected->kind == Kind::text;
    const std::string name = "TO_" + (is_text ? "STRING" : expected->plain().name);
    return check_conversion(c, e, c.checked.names.emplace_back(name)).value_or(nullptr);
}

const Type* check_operation(Checking& c, Expression*& e, const Type* expected) {
    for (Argument& argument : e->arguments) keep_width(c, argument.value);
    Expression* joined = join(c, *e, e->standard->word);
    if (!joined) return nullptr;
    e = joined;
    if (check(c, e, expected)) keep_width(c, e);
    return e->type;
}

}  // namespace

const Type* standard_type_of(Checking& c, Expression*& e, const Type* expected) {
    Expression& call = *e;
    // clang-format off
    switch (call.standard->typing) {
        case Typing::real: return check_real(c, call, expected);
        case Typing::reals: return check_reals(c, e, expected);
        case Typing::scaled: return check_scale(c, e, expected);
        case Typing::own:
        case Typing::common: return check_common(c, e, expected);
        case Typing::chosen: return check_chosen(c, e, expected);
        case Typing::places: return fold_shift(c, e) ? e->type : check_places(c, e, expected);
        case Typing::bits: return check_bits(c, call, expected);
        case Typing::bit_number: return check_bit_number(c, call, expected);
        case Typing::texts: return check_texts(c, call);
        case Typing::capacity: return check_capacity(c, e);
        case Typing::lower_bound:
        case Typing::upper_bound: return check_bound(c, e, expected);
        case Typing::element_count: return check_element_count(c, e);
        case Typing::scan_time: return check_scan_time(c, e);
        case Typing::wanted: return check_wanted(c, e, expected);
        case Typing::memory: return check_memory(c, call, expected);
        case Typing::operation: return check_operation(c, e, expected);
        case Typing::statement: break;
    }
    // clang-format on
    return nullptr;
}

}  // namespace lineshaft::st
