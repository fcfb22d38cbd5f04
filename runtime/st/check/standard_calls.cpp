#include "runtime/st/check/standard_calls.hpp"

#include <algorithm>

#include "runtime/st/check/catalog_types.hpp"
#include "runtime/st/check/constants.hpp"
#include "runtime/st/check/conversion_calls.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/vendors/instead.hpp"

namespace lineshaft::st {

namespace {

/// `LIMIT_INT`, `SHL_WORD`: IEC 61131-3:2013, 6.6.1.7.
bool is_typed_function(std::string_view name) {
    const std::size_t end = name.rfind('_');
    if (end == name.npos || !find_elementary(name.substr(end + 1))) return false;
    const StandardFunction* standard = find_standard_function(name.substr(0, end));
    return standard && standard->rule != Rule::statement;
}

const Type* check_typed_function(Checking& c, Expression& call) {
    Token& name = call.operands[0]->token;
    const std::string_view written = name.text;
    const std::size_t end = written.rfind('_');
    const Type& type = *find_elementary(written.substr(end + 1));
    name.text = written.substr(0, end);
    const Type* result = check_standard_function(c, call, &type);
    name.text = written;
    if (!result || result->kind == Kind::boolean || same_type(*result, type)) return result;
    if (widens(*result, type)) return convert_result(c, call, *result, type);
    return c.fail("L0906", call.place,
                  fmt::format("{} takes {}, not {}", written, type.name, describe(*result)),
                  fmt::format("write {}", written.substr(0, end)));
}

/// Of a number without type and one with; one of them is real.
const Type* mixed(const Type& a, const Type& b) {
    if (a.is_any() && b.is_any()) return a.is_real() ? &a : &b;
    const Type &any = a.is_any() ? a : b, &typed = a.is_any() ? b : a;
    return any.is_real() ? common_type(typed, real_type) : &typed;
}

/// Of a bit string and an integer: that of the numbers.
const Type* common_number(const Type& a, const Type& b) {
    const auto number = [](const Type& type) -> const Type& {
        return type.kind == Kind::bits ? integer_type(type.bits, false) : type;
    };
    const bool mixes =
        (a.kind == Kind::bits && b.is_integer()) || (a.is_integer() && b.kind == Kind::bits);
    return mixes ? common_type(number(a), number(b)) : nullptr;
}

const Type& real_for(const Type& type) {
    return type.kind == Kind::real && type.bits == 32 ? real_type : lreal_type;
}

/// Bounds of an array, and how many elements it has, are constants.
const Type* check_bound(Checking& c, Expression& call) {
    const StandardFunction& f = *call.standard;
    const Type* array = call.arguments[0].value->type;
    if (array->kind != Kind::array)
        return c.fail("L0905", call.arguments[0].value->place,
                      fmt::format("{} takes an array, not {}", f.name, describe(*array)));
    std::int64_t value = 1;
    if (f.most == 1) {
        for (const Type* inner = array; inner; inner = inner->has_inner ? inner->element : nullptr)
            value *= inner->upper - inner->lower + 1;
    } else {
        const auto dimension = check_whole(c, call.arguments[1].value, lint_type);
        if (!dimension) return nullptr;
        Wide at = 1;
        for (; at != *dimension && array->has_inner; ++at) array = array->element;
        if (at != *dimension)
            return c.fail("L0908", call.arguments[1].value->place,
                          fmt::format("the array's dimensions are 1 to {}", static_cast<int>(at)));
        value = f.name.front() == 'L' ? array->lower : array->upper;
    }
    become(call, dint_type, {.integer = value});
    return &dint_type;
}

/// `ADD(a, b, c)` is `a + b + c`, `GT(a, b, c)` is `a > b AND b > c`.
Expression* join(Checking& c, Expression& call, Word op) {
    const auto joined = [&](Word word, Expression* left, Expression* right) {
        Expression* made = make(c, E::binary, call);
        made->op = word;
        made->token.place = call.operands[0]->place;
        made->operands[0] = left;
        made->operands[1] = right;
        return made;
    };
    const bool compares = op >= Word::less && op <= Word::unequal;
    const auto& arguments = call.arguments;
    Expression* all = joined(op, arguments[0].value, arguments[1].value);
    for (std::size_t i = 2; i < arguments.size(); ++i) {
        Expression *before = arguments[i - 1].value, *value = arguments[i].value;
        if (compares && has_call(*before))
            return c.fail("L0903", before->place, "a function between others is not supported here",
                          "assign its value to a variable, and compare that");
        Expression* again = make(c, before->kind, *before);
        *again = *before;
        all = compares ? joined(Word::and_, all, joined(op, again, value)) : joined(op, all, value);
    }
    return all;
}

/// SCALE_X of a REAL or LREAL; into an integer, which MIN and MAX are then, it rounds.
const Type* check_scale(Checking& c, Expression& call, const Type* expected) {
    auto& arguments = call.arguments;
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
    return convert_result(c, call, real, result.is_real() ? real : result);
}

const Type* standard_result(Checking& c, Expression& call, const Type* expected) {
    const StandardFunction& f = *call.standard;
    auto& arguments = call.arguments;
    const auto coerce_from = [&](std::size_t first, const Type& type) {
        bool good = true;
        for (std::size_t i = first; i < arguments.size(); ++i)
            good &= (type.kind == Kind::text && arguments[i].value->type->kind == type.kind) ||
                    coerce(c, arguments[i].value, type);
        return good;
    };
    /// The type that all from `first` on have in common.
    const auto common_from = [&](std::size_t first) -> const Type* {
        const Type* common = arguments[first].value->type;
        for (std::size_t i = first + 1; i < arguments.size(); ++i) {
            const Type& type = *arguments[i].value->type;
            const Type& before = *common;
            const bool one_is_real = common->is_real() || type.is_real();
            const bool one_is_any = common->is_any() || type.is_any();
            if (one_is_any && one_is_real && common->is_real() != type.is_real())
                common = mixed(*common, type);
            else if (common->is_any() && (!type.is_any() || type.is_real()))
                common = &type;
            else if (!type.is_any() && !same_type(*common, type) && common->is_scalar())
                common = common_type(*common, type);
            if (!common) common = common_number(before, type);
            if (!common) {
                c.fail("L0906", call.place,
                       fmt::format("the arguments of {} have no common type", f.name),
                       "convert them");
                return nullptr;
            }
        }
        const bool is_wanted = expected && (expected->is_number() || expected->is_bits());
        if (common->is_any() && is_wanted) common = &expected->plain();
        if (common->is_any()) common = common->is_real() ? &lreal_type : &dint_type;
        return coerce_from(first, common->plain()) ? &common->plain() : nullptr;
    };
    if (f.rule == Rule::time) return &time_type;
    if (f.rule == Rule::multiplex || f.rule == Rule::decode) become_number(c, arguments[0].value);
    if (f.rule == Rule::shift) become_number(c, arguments[1].value);
    if (f.rule == Rule::shift || f.rule == Rule::swap) take_width(c, arguments[0].value, expected);
    const Type& first = *arguments[0].value->type;
    switch (f.rule) {
        case Rule::real:
        case Rule::square:
        case Rule::fraction:
        case Rule::finite: {
            const bool suits =
                first.is_any() || (first.is_integer() && expected && widens(first, *expected));
            const Type& type =
                suits && expected && expected->kind == Kind::real ? *expected : real_for(first);
            if (!coerce_from(0, type)) return nullptr;
            return f.rule == Rule::finite ? &bool_type : &type;
        }
        case Rule::real_two:
        case Rule::normalise: {
            const Type* type = common_from(0);
            if (!type) return nullptr;
            const bool known = expected && expected->is_real() && !type->is_real();
            const Type& result = known ? real_for(*expected) : real_for(*type);
            const Type& real = known && widens(*type, result) ? result : real_for(*type);
            return coerce_from(0, real) ? convert_result(c, call, real, result) : nullptr;
        }
        case Rule::scale:
            return check_scale(c, call, expected);
        case Rule::whole: {
            if (!coerce_from(0, real_for(first))) return nullptr;
            return expected && expected->kind == Kind::integer ? &expected->plain() : &dint_type;
        }
        case Rule::absolute:
        case Rule::extremum:
        case Rule::limit:
        case Rule::move: {
            const Type* type = common_from(0);
            if (!type) return nullptr;
            const bool number = type->is_number() || type->is_time() ||
                                (f.rule != Rule::absolute && type->kind == Kind::bits);
            if (number || f.rule == Rule::move) return type;
            return c.fail("L0905", arguments[0].value->place,
                          fmt::format("{} takes numbers, not {}", f.name, describe(*type)));
        }
        case Rule::select:
            if (!coerce(c, arguments[0].value, bool_type)) return nullptr;
            return common_from(1);
        case Rule::multiplex:
            if (first.is_any() ? !coerce(c, arguments[0].value, lint_type)
                               : first.kind != Kind::integer)
                return first.is_any() ? nullptr
                                      : c.fail("L0905", arguments[0].value->place,
                                               "K of MUX is a whole number");
            return common_from(1);
        case Rule::shift: {
            const Type& count = *arguments[1].value->type;
            if (!count.is_integer() && count.kind != Kind::any_bits)
                return c.fail("L0905", arguments[1].value->place,
                              "the number of places is an integer");
            if (!coerce(c, arguments[1].value, count.is_any() ? lint_type : count)) return nullptr;
            if (first.kind == Kind::bits || (first.kind == Kind::integer)) return &first.plain();
            return c.fail("L0905", arguments[0].value->place,
                          fmt::format("{} takes a bit string, not {}", f.name, describe(first)),
                          "write its type, as in WORD#16#FF");
        }
        case Rule::valid_bcd:
            if (first.kind == Kind::bits) return &bool_type;
            return c.fail("L0905", arguments[0].value->place,
                          fmt::format("{} takes a bit string, not {}", f.name, describe(first)));
        case Rule::swap:
        case Rule::encode:
            if (first.kind == Kind::any_bits && f.rule == Rule::encode)
                coerce(c, arguments[0].value, bits_type(64));
            if (arguments[0].value->type->kind == Kind::bits)
                return f.rule == Rule::encode ? &int_type : &first;
            return c.fail("L0905", arguments[0].value->place,
                          fmt::format("{} takes a bit string, not {}", f.name, describe(first)),
                          "write its type, as in WORD#16#FF");
        case Rule::decode:
            if (first.is_any() ? !coerce(c, arguments[0].value, lint_type) : !first.is_integer())
                return first.is_any() ? nullptr
                                      : c.fail("L0905", arguments[0].value->place,
                                               fmt::format("DECO takes a whole number, not {}",
                                                           describe(first)));
            return expected && expected->kind == Kind::bits ? expected : &bits_type(32);
        case Rule::capacity:
            if (first.kind != Kind::text)
                return c.fail("L0905", arguments[0].value->place,
                              fmt::format("expected a STRING, found {}", describe(first)));
            if (!first.is_open) become(call, int_type, {.integer = first.length});
            return &int_type;
        case Rule::bound:
            return check_bound(c, call);
        case Rule::length:
        case Rule::find:
        case Rule::text: {
            const std::size_t texts = f.rule == Rule::text ? static_cast<std::size_t>(f.texts) : 2;
            for (std::size_t i = 0; i < arguments.size(); ++i) {
                if (i < texts && arguments[i].value->type->is_character)
                    coerce(c, arguments[i].value, string_type);
                if (i >= texts) become_number(c, arguments[i].value);
                const Type& type = *arguments[i].value->type;
                if (i < texts ? type.kind == Kind::text : type.is_integer()) {
                    if (type.is_any() && !coerce(c, arguments[i].value, lint_type)) return nullptr;
                    continue;
                }
                return c.fail(
                    "L0905", arguments[i].value->place,
                    fmt::format("expected {}, found {}", i < texts ? "a STRING" : "a whole number",
                                describe(type)));
            }
            return f.rule == Rule::text ? &string_type : &int_type;
        }
        case Rule::time:
        case Rule::statement:
            return nullptr;
        case Rule::operation: {
            Expression* joined = join(c, call, f.word);
            const Type* type = joined ? check(c, *joined, expected) : nullptr;
            if (joined) call = *joined;
            return type;
        }
    }
    return nullptr;
}

}  // namespace

bool check_count(Checking& c, const Expression& call, const StandardFunction& f) {
    const int count = static_cast<int>(call.arguments.size());
    if (count >= f.least && count <= f.most) return true;
    c.fail("L0907", call.operands[0]->place,
           fmt::format("{} takes {}{} argument{}", f.name, f.least,
                       f.most > f.least ? " or more" : "", f.most == 1 ? "" : "s"));
    return false;
}

bool order_arguments(Checking& c, Expression& call, const StandardFunction& f) {
    if (std::ranges::none_of(call.arguments, &Argument::is_named)) return true;
    const int count = static_cast<int>(call.arguments.size());
    std::vector<Argument> sorted(call.arguments.size());
    std::vector<std::string> names;
    for (int i = 0; i < count; ++i) names.push_back(argument_name(f, i));
    const bool has_else = std::ranges::any_of(
        call.arguments, [](const Argument& a) { return same_name(a.name.text, "inelse"); });
    if (f.rule == Rule::multiplex && has_else) names.back() = "INELSE";
    for (int i = 0; i < count; ++i) {
        const Argument& argument = call.arguments[static_cast<std::size_t>(i)];
        const auto is_called = [&](const std::string& name) {
            return same_name(name, argument.name.text);
        };
        const bool named = argument.is_named();
        const auto it = named ? std::ranges::find_if(names, is_called) : names.begin() + i;
        const char* wrong = it == names.end() ? "not an argument of"
                            : sorted[static_cast<std::size_t>(it - names.begin())].value
                                ? "given twice to"
                                : nullptr;
        if (wrong) {
            c.fail("L0907", named ? argument.name.place : argument.value->place,
                   fmt::format("'{}' is {} {}", named ? argument.name.text : *it, wrong, f.name),
                   fmt::format("it takes {}", fmt::join(names, ", ")));
            return false;
        }
        sorted[static_cast<std::size_t>(it - names.begin())] = argument;
    }
    call.arguments = std::move(sorted);
    return true;
}

const Type* check_standard_function(Checking& c, Expression& call, const Type* expected) {
    const Token& name = call.operands[0]->token;
    if (c.is_lost(name)) return nullptr;
    call.standard = find_standard_function(name.text);
    const std::string_view instead = instead_of_function(name.text);
    if (!call.standard && !instead.empty() && !c.tree.lost.contains(name.text))
        return c.fail("L0903", name.place,
                      fmt::format("the function {} is not supported", name.text),
                      std::string(instead));
    if (call.standard && call.standard->rule == Rule::statement)
        return c.fail("L0905", call.place, fmt::format("{} has no value", name.text),
                      "write it as a statement of its own");
    for (Argument& argument : call.arguments)
        if (argument.is_output && call.standard)
            return c.fail("L0907", argument.name.place,
                          "a standard function has no output but its value");
    if (!call.standard) {
        if (const auto converted = check_conversion(c, call, name.text)) return *converted;
        if (c.find_routine(name) || standard_type(c, name.text))
            return c.fail("L0907", name.place,
                          fmt::format("'{}' is a kind of block, not an instance", name.text),
                          "declare one in VAR, and call that");
        if (is_typed_function(name.text)) return check_typed_function(c, call);
        std::vector<std::string> names = visible_names(c);
        for (const StandardFunction& f : standard_functions()) names.emplace_back(f.name);
        if (c.is_in_test())
            for (const TestStatement& known : test_statements) names.emplace_back(known.name);
        for (Argument& argument : call.arguments) check(c, *argument.value);
        return undeclared(c, name, name.place, names);
    }
    const StandardFunction& f = *call.standard;
    if (!check_count(c, call, f) || !order_arguments(c, call, f)) return nullptr;
    const int count = static_cast<int>(call.arguments.size());
    const bool first_differs = f.rule == Rule::select || f.rule == Rule::multiplex;
    const bool passes = f.rule == Rule::extremum || f.rule == Rule::limit || first_differs ||
                        f.rule == Rule::move ||
                        (f.rule == Rule::scale && expected && expected->is_real());
    for (int i = 0; i < count; ++i)
        check(c, *call.arguments[static_cast<std::size_t>(i)].value,
              passes && !(first_differs && i == 0) ? expected : nullptr);
    for (const Argument& argument : call.arguments)
        if (!argument.value->type) return nullptr;
    return standard_result(c, call, expected);
}

}  // namespace lineshaft::st
