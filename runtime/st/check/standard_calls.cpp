#include "runtime/source/letters.hpp"
#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

/// `LIMIT_INT`, `SHL_WORD`: IEC 61131-3:2013, 6.6.1.7. Empty: it is none.
std::optional<const Type*> check_typed_function(Checking& c, Expression*& e) {
    const std::string_view written = e->operands[0]->token.text;
    const std::size_t end = std::min(written.rfind('_'), written.size() - 1);
    const std::string_view name = written.substr(0, end);
    const Type* type = in_dialect(find_elementary(written.substr(end + 1)), e->place);
    const StandardFunction* standard = find_standard_function(name);
    if (!type || !standard || standard->typing == Typing::statement) return {};
    Expression* call = make_call(c, *e, make_name(c, *e->operands[0], name), e->arguments);
    const bool is_rounded = standard->result == Generic::any_int && type->is_real();
    const Type* result = check_standard_function(c, call, is_rounded ? &lint_type : type);
    if (!result) return nullptr;
    if (result->is_any()) return coerce(c, e = call, *type) ? type : nullptr;
    if (is_rounded) return e = call, convert_result(c, e, *result, *type);
    const bool fits = result->kind == Kind::boolean || same_type(*result, *type);
    if (!fits && !widens(*result, *type))
        return c.fail(code::conversion_may_lose, e->place,
                      fmt::format("{} takes {}, not {}", written, type->name, describe(*result)),
                      fmt::format("write {}", name));
    e = call;
    return fits ? result : convert_result(c, e, *result, *type);
}

/// What it gives is of the type that it reckons in, and so are its arguments.
bool reckons_as_wanted(const StandardFunction& f) {
    const bool is_operation = f.typing == Typing::operation && f.word != Word::mod_ &&
                              f.result != Generic::boolean && f.result != Generic::any_bit;
    return is_operation || f.typing == Typing::reals || f.typing == Typing::own ||
           (f.typing == Typing::real && f.result == Generic::any_real);
}

/// `LIMIT(IN := n, MX := 5)`: an input of a formal call that is left out has its initial value.
void add_left_out(Checking& c, Expression*& e, const StandardFunction& f) {
    const auto& given = e->arguments;
    if (f.typing != Typing::common || f.most != f.least || given.empty() ||
        !e->place.dialect().named_inputs_may_be_left_out ||
        !std::ranges::all_of(given, &Argument::is_named))
        return;
    std::vector<std::string> names;
    for (int i = 0; i < f.least; ++i) names.push_back(argument_name(f, i));
    for (const Argument& argument : given)
        if (!find_called(names, argument.name.text)) return;  // is told
    std::vector<Argument> all = given;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (find_called(given, names[i], &Argument::name)) continue;
        Token token = e->operands[0]->token;
        token.word = Word::name;
        token.text = f.parameter(i).name;
        all.push_back(
            {.name = token, .value = make_constant(c, *e, any_integer_type, {.integer = 0})});
    }
    e = make_with(c, *e, std::move(all));
}

}  // namespace

bool check_count(Checking& c, const Expression& call, const StandardFunction& f) {
    const int count = static_cast<int>(call.arguments.size());
    if (count >= f.least && count <= f.most) return true;
    return c.fail(code::wrong_arguments, call.operands[0]->place,
                  fmt::format("{} takes {}{} argument{}", f.name, f.least,
                              f.most > f.least ? " or more" : "", f.most == 1 ? "" : "s"));
}

bool order_arguments(Checking& c, Expression*& e, const StandardFunction& f) {
    const Expression& call = *e;
    if (std::ranges::none_of(call.arguments, &Argument::is_named)) return true;
    const int count = static_cast<int>(call.arguments.size());
    std::vector<Argument> sorted(call.arguments.size());
    std::vector<std::string> names;
    for (int i = 0; i < count; ++i) names.push_back(argument_name(f, i));
    if (const auto& first = call.arguments[0].name.text;
        f.typing == Typing::reals && lower(first).starts_with("in"))
        names = {"IN1", "IN2"};  // of ATAN2, in the standard's second edition
    const bool has_else = f.typing == Typing::chosen && f.most > f.least &&
                          find_called(call.arguments, "inelse", &Argument::name);
    if (has_else) names.back() = "INELSE";
    for (int i = 0; i < count; ++i) {
        const Argument& argument = call.arguments[static_cast<std::size_t>(i)];
        const bool is_simatic_ax = lower(argument.name.text).starts_with("string");
        const bool is_loose = call.place.dialect().is_loose;
        const bool is_vendors = (f.typing == Typing::texts && (is_loose || is_simatic_ax)) ||
                                (f.typing == Typing::real && is_loose);
        const auto is_called = [&](const std::string& name) {
            return same_name(name, argument.name.text) ||
                   (is_vendors && same_name(name, standard_argument_name(argument.name.text)));
        };
        const bool named = argument.is_named();
        const auto it = named ? std::ranges::find_if(names, is_called) : names.begin() + i;
        const char* wrong = it == names.end() ? "not an argument of"
                            : sorted[static_cast<std::size_t>(it - names.begin())].value
                                ? "given twice to"
                                : nullptr;
        if (wrong)
            return c.fail(
                code::wrong_arguments, named ? argument.name.place : argument.value->place,
                fmt::format("'{}' is {} {}", named ? argument.name.text : *it, wrong, f.name),
                fmt::format("it takes {}", fmt::join(names, ", ")));
        sorted[static_cast<std::size_t>(it - names.begin())] = argument;
    }
    e = make_with(c, call, std::move(sorted));
    e->has_else = has_else;
    return true;
}

const Type* check_standard_function(Checking& c, Expression*& e, const Type* expected) {
    Expression& call = *e;
    const Token& name = call.operands[0]->token;
    if (c.is_lost(name)) return nullptr;
    call.standard = find_standard_function(name.text);
    const std::string_view instead =
        call.standard ? std::string_view() : instead_of_function(name.text);
    if (!instead.empty() && !c.tree.lost.contains(name.text))
        return c.fail(code::not_supported, name.place,
                      fmt::format("the function {} is not supported", name.text),
                      std::string(instead));
    if (call.standard && call.standard->typing == Typing::statement)
        return c.fail(code::type_does_not_fit, call.place,
                      fmt::format("{} has no value", name.text),
                      "write it as a statement of its own");
    for (Argument& argument : call.arguments)
        if (argument.is_output && call.standard)
            return c.fail(code::wrong_arguments, argument.name.place,
                          "a standard function has no output but its value");
    if (!call.standard) {
        if (const auto converted = check_conversion(c, e, name.text)) return *converted;
        if (c.find_routine(name) || standard_type(c, name.text))
            return c.fail(code::wrong_arguments, name.place,
                          fmt::format("'{}' is a kind of block, not an instance", name.text),
                          "declare one in VAR, and call that");
        if (const auto typed = check_typed_function(c, e)) return *typed;
        std::vector<std::string_view> names;
        for (const StandardFunction* f : standard_functions()) names.emplace_back(f->name);
        if (c.is_in_test())
            for (const TestStatement& known : test_statements) names.emplace_back(known.name);
        for (Argument& argument : call.arguments) check(c, argument.value);
        return undeclared(c, name, name.place, names);
    }
    const StandardFunction& f = *call.standard;
    add_left_out(c, e, f);
    if (!check_count(c, *e, f) || !order_arguments(c, e, f)) return nullptr;
    const bool passes = f.typing == Typing::common || f.typing == Typing::chosen ||
                        (f.typing == Typing::scaled && expected && expected->is_real()) ||
                        (f.typing == Typing::own && expected && expected->kind == Kind::integer) ||
                        (expected && expected->is_real() && reckons_as_wanted(f));
    for (std::size_t i = 0; i < e->arguments.size(); ++i) {
        Expression*& value = e->arguments[i].value;
        const bool is_text =
            f.typing == Typing::texts && value->kind == E::name && value->token.quoted;
        const bool is_passed = passes && !(f.typing == Typing::chosen && i == 0);
        check(c, value, is_text ? &string_type : is_passed ? expected : nullptr);
    }
    for (const Argument& argument : e->arguments)
        if (!argument.value->type) return nullptr;
    return standard_type_of(c, e, expected);
}

}  // namespace lineshaft::st
