#include <algorithm>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/checker_class.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/vendors/instead.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;

bool is_variable(const Expression& e) {
    using E = Expression::Kind;
    return e.kind == E::name || e.kind == E::member || (e.kind == E::index && !e.is_character());
}

/// A structure or an array that came as an input, or in one, is passed on by reference.
bool is_own_input(const Expression& e) {
    const Expression* root = &e;
    while (root->kind != Expression::Kind::name && root->operands[0]) root = root->operands[0];
    return root->variable && root->variable->section == Section::input &&
           (!e.type->is_scalar() || e.type->is_handle());
}

}  // namespace

bool has_call(const Expression& e) {
    if (e.kind == Expression::Kind::call && e.routine) return true;
    for (const Expression* operand : e.operands)
        if (operand && has_call(*operand)) return true;
    return std::ranges::any_of(e.arguments, [](const Argument& a) { return has_call(*a.value); });
}

const Type* Checker::check_call(Expression& call, bool as_statement, const Type* expected) {
    Expression& callee = *call.operands[0];
    if (callee.kind == Expression::Kind::member) {
        const Type* of = check(*callee.operands[0]);
        if (!of) return nullptr;
        if (of->kind == Kind::standard && same_name(of->standard->name, callee.token.text)) {
            call.operands[0] = callee.operands[0];  // `#delay.TON(...)`, as Siemens has it
            return check_instance_call(call, *of, as_statement);
        }
        if (of->kind == Kind::block) {
            const auto it = of->routine->methods.find(callee.token.text);
            if (it != of->routine->methods.end()) {
                Routine& method = *it->second;
                const bool outside =
                    !routine_ || (routine_ != of->routine && routine_->owner != of->routine);
                if (method.pou->is_private && outside && !is_in_test())
                    return fail("L0907", callee.token.place,
                                fmt::format("'{}' is PRIVATE to {}", callee.token.text, of->name),
                                "only its own block calls it");
                return check_routine_call(call, method, as_statement);
            }
        }
    }
    if (callee.kind == Expression::Kind::name && !is_instance(callee.token)) {
        const std::string_view name = callee.token.text;
        for (const Routine* r = routine_; r; r = r->owner)
            if (const auto it = r->methods.find(name); it != r->methods.end())
                return check_routine_call(call, *it->second, as_statement);
        Routine* routine = find_routine(callee.token);
        if (routine && !routine->type) return check_routine_call(call, *routine, as_statement);
        const bool is_function = (routine || !callee.token.quoted) && !callee.token.local &&
                                 (find_standard_function(name) || !find_variable(callee.token));
        if (is_function && find_test_statement(name) != TestCall::none)
            return check_test_statement(call, as_statement);
        if (is_function) return check_standard_function(call, expected);
    }
    const Type* type = check(callee);
    if (!type) return nullptr;
    if (type->is_instance()) return check_instance_call(call, *type, as_statement);
    return fail("L0907", callee.place, fmt::format("{} cannot be called", describe(*type)),
                "functions, methods and instances of function blocks are called");
}

/// A variable may bear a function's name, but no instance can be meant then.
bool Checker::is_instance(const Token& name) {
    const Variable* variable = find_variable(name);
    return variable && variable->type && variable->type->is_instance();
}

const Type* Checker::check_routine_call(Expression& call, Routine& routine, bool as_statement) {
    call.routine = &routine;
    if (routine_) {
        routine_->calls.push_back(&routine);
        routine_->call_places.push_back(call.place);
    }
    check_arguments(call, routine);
    if (routine.result) return routine.result->type;
    if (!as_statement)
        return fail("L0905", call.place, fmt::format("'{}' has no result", routine.name),
                    "call it as a statement of its own, and take an output with '=>'");
    return nullptr;
}

const Type* Checker::check_instance_call(Expression& call, const Type& type, bool as_statement) {
    if (!as_statement)
        return fail("L0905", call.place, "the call of an instance has no value",
                    "call it as a statement of its own, then take an output: name.Q");
    if (type.kind == Kind::block) {
        call.routine = type.routine;
        check_arguments(call, *type.routine);
    } else {
        check_standard_arguments(call, type);
    }
    return nullptr;
}

Variable* Checker::find_parameter(Argument& argument, Routine& routine, std::size_t position) {
    const auto is_parameter = [](const Variable& variable) {
        return variable.section == Section::input || variable.section == Section::in_out ||
               variable.section == Section::output;
    };
    const bool named = argument.is_named();
    const bool inner = is_in_test() && named && routine.has_instances();
    std::size_t i = 0;
    for (Variable& variable : routine.variables) {
        if (!is_parameter(variable) && !inner) continue;
        if (named ? same_name(variable.text, argument.name.text) : i == position) return &variable;
        ++i;
    }
    if (argument.is_output && same_name(argument.name.text, "eno")) return &eno_of(routine);
    if (!named)
        return fail("L0907", argument.value->place,
                    fmt::format("'{}' takes {} argument{}", routine.name, i, i == 1 ? "" : "s"));
    std::vector<std::string> names;
    for (const Variable& variable : routine.variables)
        if (is_parameter(variable) || inner) names.emplace_back(variable.text);
    return fail("L0907", argument.name.place,
                fmt::format("'{}' has no argument '{}'", routine.name, argument.name.text),
                same_name(argument.name.text, "en")
                    ? "EN is for a call that is a statement, or whose value is assigned"
                    : suggest(argument.name.text, names));
}

void Checker::check_arguments(Expression& call, Routine& routine) {
    std::size_t position = 0;
    std::vector<const Variable*> given;
    bool by_name = call.arguments.empty();  // 6.6.1.4.2
    for (Argument& argument : call.arguments) {
        by_name |= argument.is_named();
        Variable* parameter = find_parameter(argument, routine, position++);
        argument.variable = parameter;
        if (!parameter) {
            check(*argument.value);
            continue;
        }
        if (std::ranges::find(given, parameter) != given.end())
            fail("L0907", argument.value->place,
                 fmt::format("'{}' is given twice", parameter->text));
        given.push_back(parameter);
        check_argument(call, argument, *parameter);
    }
    for (const Variable& variable : routine.variables) {
        const bool due = variable.section == Section::in_out ||
                         (variable.section == Section::input && !routine.has_instances() &&
                          (!by_name || is_scl(call)) && !variable.initial);
        if (!due || std::ranges::find(given, &variable) != given.end()) continue;
        if (is_in_test() && routine.has_instances())
            leave_out(call, const_cast<Variable&>(variable));
        else
            fail("L0907", call.operands[0]->place,
                 fmt::format("'{}' is called without '{}'", routine.name, variable.text),
                 fmt::format("write {} := ...", variable.text));
    }
}

void Checker::check_argument(Expression&, Argument& argument, Variable& parameter) {
    Expression*& value = argument.value;
    const Type* type = parameter.type;
    const bool is_set = is_in_test() && !argument.is_output && argument.is_named() &&
                        parameter.section != Section::in_out;
    const bool is_eno = argument.is_output && parameter.section == Section::temp;
    if (!is_set && !is_eno && argument.is_output != (parameter.section == Section::output) &&
        argument.is_named()) {
        check(*value);
        fail("L0907", argument.name.place,
             fmt::format("'{}' is {} of the call", parameter.text,
                         parameter.section == Section::output ? "an output" : "an input"),
             parameter.section == Section::output ? "write '=>' and the variable that it goes to"
                                                  : "write ':='");
        return;
    }
    if (parameter.section == Section::input || is_set) {
        if (check(*value, type) && type) coerce(value, *type);
        return;
    }
    const Type* given = check(*value, type && type->kind == Kind::handle ? type : nullptr);
    if (!given || !type) return;
    if (type->kind == Kind::handle && given->is_object()) {
        if (coerce(value, *type)) return;
    }
    const bool is_read = parameter.section == Section::in_out && is_own_input(*value);
    const bool is_place =
        is_variable(*value) || (argument.is_output && value->kind == Expression::Kind::bit);
    if (!is_place || (!is_read && !check_target(*value, "given here"))) {
        if (!is_place)
            fail("L0907", value->place,
                 fmt::format("'{}' takes a variable, not a value", parameter.text),
                 "declare one and give it here");
        return;
    }
    const bool texts = given->kind == Kind::text && type->kind == Kind::text;
    const bool fits =
        same_type(*given, *type) || (parameter.section == Section::in_out
                                         ? texts && type->is_open
                                         : texts || (type->is_scalar() && widens(*type, *given)));
    if (!fits)
        fail("L0905", value->place,
             fmt::format("'{}' is {}, and {} is given", parameter.text, describe(*type),
                         describe(*given)),
             texts ? "a VAR_IN_OUT of type STRING, without a length, takes any" : "");
}

/// Of a block that commands an axis, inputs that vendors add to PLCopen's: an axis without a real
/// drive does the same with and without, with some if they are this constant.
struct VendorsOwn {
    std::string_view name;
    std::optional<double> only = {};
};

const VendorsOwn* vendors_own(const Type& type, std::string_view argument) {
    static constexpr VendorsOwn known[] = {{"StartMode"},       {"StopMode"},
                                           {"Restart"},         {"PositionControlled"},
                                           {"bRegulatorOn"},    {"bDriveStart"},
                                           {"Enable_Positive"}, {"Enable_Negative"},
                                           {"Current", 0},      {"AbortAcceleration", 0},
                                           {"Override", 100}};
    const auto refers = [](const Variable* member) { return member->type->is_handle(); };
    const auto* it = std::ranges::find_if(
        known, [&](const VendorsOwn& input) { return same_name(input.name, argument); });
    return it != std::end(known) && std::ranges::any_of(type.members, refers) ? it : nullptr;
}

void Checker::ignore(const Type& type, Argument& argument, std::optional<double> only) {
    if (!check(*argument.value)) return;
    const Expression& value = *argument.value;
    if (!only || (is_constant(value) && as_real(value) == *only))
        return out_.warn("L0923", argument.name.place.mark(),
                         fmt::format("{} does not take '{}'", type.name, argument.name.text),
                         "a simulated axis does the same with and without");
    fail("L0903", argument.name.place,
         fmt::format("'{}' of {} is not supported", argument.name.text, type.name),
         fmt::format("leave it out: it is as if it were {}", *only == 0 ? "FALSE" : "100"));
}

void Checker::check_standard_arguments(Expression& call, const Type& type) {
    std::vector<std::string> names;
    for (const Variable* member : type.members) names.emplace_back(member->text);
    std::size_t position = 0;
    for (Argument& argument : call.arguments) {
        Variable* found = nullptr;
        if (!argument.is_named()) {
            if (position < type.members.size()) found = type.members[position++];
        } else {
            for (Variable* member : type.members)
                if (same_name(member->text, standard_name(type, argument.name.text)))
                    found = member;
        }
        argument.variable = found;
        const VendorsOwn* ignored =
            found || argument.is_output ? nullptr : vendors_own(type, argument.name.text);
        if (ignored) {
            ignore(type, argument, ignored->only);
            continue;
        }
        if (!found && !argument.is_named()) {
            fail("L0907", argument.value->place,
                 fmt::format("{} takes {} arguments", type.name, names.size()),
                 fmt::format("they are {}", fmt::join(names, ", ")));
            break;
        }
        if (!found) {
            fail("L0907", argument.name.place,
                 fmt::format("{} has no argument '{}'", type.name, argument.name.text),
                 same_name(argument.name.text, "cam")
                     ? "select the cam with MC_CamTableSelect, and give its CamTableID"
                     : suggest(argument.name.text, names));
            continue;
        }
        check_argument(call, argument, *found);
    }
    std::erase_if(call.arguments, [](const Argument& argument) { return !argument.variable; });
    for (const Variable* member : type.members) {
        if (member->section != Section::in_out ||
            std::ranges::find(call.arguments, member, &Argument::variable) != call.arguments.end())
            continue;
        fail("L0907", call.operands[0]->place,
             fmt::format("'{}' is called without '{}'", type.name, member->text),
             fmt::format("write {} := ...", member->text));
    }
}

// Standard functions.

bool Checker::check_count(const Expression& call, const StandardFunction& f) {
    const int count = static_cast<int>(call.arguments.size());
    if (count >= f.least && count <= f.most) return true;
    fail("L0907", call.operands[0]->place,
         fmt::format("{} takes {}{} argument{}", f.name, f.least,
                     f.most > f.least ? " or more" : "", f.most == 1 ? "" : "s"));
    return false;
}

/// Arguments by name may stand in any order.
bool Checker::put_in_order(Expression& call, const StandardFunction& f) {
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
            fail("L0907", named ? argument.name.place : argument.value->place,
                 fmt::format("'{}' is {} {}", named ? argument.name.text : *it, wrong, f.name),
                 fmt::format("it takes {}", fmt::join(names, ", ")));
            return false;
        }
        sorted[static_cast<std::size_t>(it - names.begin())] = argument;
    }
    call.arguments = std::move(sorted);
    return true;
}

/// `LIMIT_INT`, `SHL_WORD`: IEC 61131-3:2013, 6.6.1.7.
bool is_typed_function(std::string_view name) {
    const std::size_t end = name.rfind('_');
    if (end == name.npos || !find_elementary(name.substr(end + 1))) return false;
    const StandardFunction* standard = find_standard_function(name.substr(0, end));
    return standard && standard->rule != Rule::statement;
}

const Type* Checker::check_typed_function(Expression& call) {
    Token& name = call.operands[0]->token;
    const std::string_view written = name.text;
    const std::size_t end = written.rfind('_');
    const Type& type = *find_elementary(written.substr(end + 1));
    name.text = written.substr(0, end);
    const Type* result = check_standard_function(call, &type);
    name.text = written;
    if (!result || result->kind == Kind::boolean || same_type(*result, type)) return result;
    if (widens(*result, type)) return convert_result(call, *result, type);
    return fail("L0906", call.place,
                fmt::format("{} takes {}, not {}", written, type.name, describe(*result)),
                fmt::format("write {}", written.substr(0, end)));
}

const Type* Checker::check_standard_function(Expression& call, const Type* expected) {
    const Token& name = call.operands[0]->token;
    if (is_lost(name)) return nullptr;
    call.standard = find_standard_function(name.text);
    const std::string_view instead = instead_of_function(name.text);
    if (!call.standard && !instead.empty() && !tree_.lost.contains(name.text))
        return fail("L0903", name.place, fmt::format("the function {} is not supported", name.text),
                    std::string(instead));
    if (call.standard && call.standard->rule == Rule::statement)
        return fail("L0905", call.place, fmt::format("{} has no value", name.text),
                    "write it as a statement of its own");
    for (Argument& argument : call.arguments)
        if (argument.is_output && call.standard)
            return fail("L0907", argument.name.place,
                        "a standard function has no output but its value");
    if (!call.standard) {
        if (const auto converted = check_conversion(call, name.text)) return *converted;
        if (find_routine(name) || standard_type(name.text))
            return fail("L0907", name.place,
                        fmt::format("'{}' is a kind of block, not an instance", name.text),
                        "declare one in VAR, and call that");
        if (is_typed_function(name.text)) return check_typed_function(call);
        std::vector<std::string> names = visible_names();
        for (const StandardFunction& f : standard_functions()) names.emplace_back(f.name);
        if (is_in_test())
            for (const TestStatement& known : test_statements) names.emplace_back(known.name);
        for (Argument& argument : call.arguments) check(*argument.value);
        return undeclared(name, name.place, names);
    }
    const StandardFunction& f = *call.standard;
    if (!check_count(call, f) || !put_in_order(call, f)) return nullptr;
    const int count = static_cast<int>(call.arguments.size());
    const bool first_differs = f.rule == Rule::select || f.rule == Rule::multiplex;
    const bool passes = f.rule == Rule::extremum || f.rule == Rule::limit || first_differs ||
                        f.rule == Rule::move ||
                        (f.rule == Rule::scale && expected && expected->is_real());
    for (int i = 0; i < count; ++i)
        check(*call.arguments[static_cast<std::size_t>(i)].value,
              passes && !(first_differs && i == 0) ? expected : nullptr);
    for (const Argument& argument : call.arguments)
        if (!argument.value->type) return nullptr;
    return standard_result(call, expected);
}

namespace {

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

}  // namespace

/// Bounds of an array, and how many elements it has, are constants.
const Type* Checker::check_bound(Expression& call) {
    const StandardFunction& f = *call.standard;
    const Type* array = call.arguments[0].value->type;
    if (array->kind != Kind::array)
        return fail("L0905", call.arguments[0].value->place,
                    fmt::format("{} takes an array, not {}", f.name, describe(*array)));
    std::int64_t value = 1;
    if (f.most == 1) {
        for (const Type* inner = array; inner; inner = inner->has_inner ? inner->element : nullptr)
            value *= inner->upper - inner->lower + 1;
    } else {
        const auto dimension = check_whole(call.arguments[1].value, lint_type);
        if (!dimension) return nullptr;
        Wide at = 1;
        for (; at != *dimension && array->has_inner; ++at) array = array->element;
        if (at != *dimension)
            return fail("L0908", call.arguments[1].value->place,
                        fmt::format("the array's dimensions are 1 to {}", static_cast<int>(at)));
        value = f.name.front() == 'L' ? array->lower : array->upper;
    }
    become(call, dint_type, {.integer = value});
    return &dint_type;
}

const Type* Checker::standard_result(Expression& call, const Type* expected) {
    const StandardFunction& f = *call.standard;
    auto& arguments = call.arguments;
    const auto coerce_from = [&](std::size_t first, const Type& type) {
        bool good = true;
        for (std::size_t i = first; i < arguments.size(); ++i)
            good &= (type.kind == Kind::text && arguments[i].value->type->kind == type.kind) ||
                    coerce(arguments[i].value, type);
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
                fail("L0906", call.place,
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
    if (f.rule == Rule::multiplex || f.rule == Rule::decode) become_number(arguments[0].value);
    if (f.rule == Rule::shift) become_number(arguments[1].value);
    if (f.rule == Rule::shift || f.rule == Rule::swap) take_width(arguments[0].value, expected);
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
            return coerce_from(0, real) ? convert_result(call, real, result) : nullptr;
        }
        case Rule::scale:
            return check_scale(call, expected);
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
            return fail("L0905", arguments[0].value->place,
                        fmt::format("{} takes numbers, not {}", f.name, describe(*type)));
        }
        case Rule::select:
            if (!coerce(arguments[0].value, bool_type)) return nullptr;
            return common_from(1);
        case Rule::multiplex:
            if (first.is_any() ? !coerce(arguments[0].value, lint_type)
                               : first.kind != Kind::integer)
                return first.is_any()
                           ? nullptr
                           : fail("L0905", arguments[0].value->place, "K of MUX is a whole number");
            return common_from(1);
        case Rule::shift: {
            const Type& count = *arguments[1].value->type;
            if (!count.is_integer() && count.kind != Kind::any_bits)
                return fail("L0905", arguments[1].value->place,
                            "the number of places is an integer");
            if (!coerce(arguments[1].value, count.is_any() ? lint_type : count)) return nullptr;
            if (first.kind == Kind::bits || (first.kind == Kind::integer)) return &first.plain();
            return fail("L0905", arguments[0].value->place,
                        fmt::format("{} takes a bit string, not {}", f.name, describe(first)),
                        "write its type, as in WORD#16#FF");
        }
        case Rule::valid_bcd:
            if (first.kind == Kind::bits) return &bool_type;
            return fail("L0905", arguments[0].value->place,
                        fmt::format("{} takes a bit string, not {}", f.name, describe(first)));
        case Rule::swap:
        case Rule::encode:
            if (first.kind == Kind::any_bits && f.rule == Rule::encode)
                coerce(arguments[0].value, bits_type(64));
            if (arguments[0].value->type->kind == Kind::bits)
                return f.rule == Rule::encode ? &int_type : &first;
            return fail("L0905", arguments[0].value->place,
                        fmt::format("{} takes a bit string, not {}", f.name, describe(first)),
                        "write its type, as in WORD#16#FF");
        case Rule::decode:
            if (first.is_any() ? !coerce(arguments[0].value, lint_type) : !first.is_integer())
                return first.is_any() ? nullptr
                                      : fail("L0905", arguments[0].value->place,
                                             fmt::format("DECO takes a whole number, not {}",
                                                         describe(first)));
            return expected && expected->kind == Kind::bits ? expected : &bits_type(32);
        case Rule::capacity:
            if (first.kind != Kind::text)
                return fail("L0905", arguments[0].value->place,
                            fmt::format("expected a STRING, found {}", describe(first)));
            if (!first.is_open) become(call, int_type, {.integer = first.length});
            return &int_type;
        case Rule::bound:
            return check_bound(call);
        case Rule::length:
        case Rule::find:
        case Rule::text: {
            const std::size_t texts = f.rule == Rule::text ? static_cast<std::size_t>(f.texts) : 2;
            for (std::size_t i = 0; i < arguments.size(); ++i) {
                if (i < texts && arguments[i].value->type->is_character)
                    coerce(arguments[i].value, string_type);
                if (i >= texts) become_number(arguments[i].value);
                const Type& type = *arguments[i].value->type;
                if (i < texts ? type.kind == Kind::text : type.is_integer()) {
                    if (type.is_any() && !coerce(arguments[i].value, lint_type)) return nullptr;
                    continue;
                }
                return fail("L0905", arguments[i].value->place,
                            fmt::format("expected {}, found {}",
                                        i < texts ? "a STRING" : "a whole number", describe(type)));
            }
            return f.rule == Rule::text ? &string_type : &int_type;
        }
        case Rule::time:
        case Rule::statement:
            return nullptr;
        case Rule::operation: {
            Expression* joined = join(call, f.word);
            const Type* type = joined ? check(*joined, expected) : nullptr;
            if (joined) call = *joined;
            return type;
        }
    }
    return nullptr;
}

/// `ADD(a, b, c)` is `a + b + c`, `GT(a, b, c)` is `a > b AND b > c`.
Expression* Checker::join(Expression& call, Word op) {
    const auto joined = [&](Word word, Expression* left, Expression* right) {
        Expression* made = make(Expression::Kind::binary, call);
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
            return fail("L0903", before->place, "a function between others is not supported here",
                        "assign its value to a variable, and compare that");
        Expression* again = make(before->kind, *before);
        *again = *before;
        all = compares ? joined(Word::and_, all, joined(op, again, value)) : joined(op, all, value);
    }
    return all;
}

/// SCALE_X of a REAL or LREAL; into an integer, which MIN and MAX are then, it rounds.
const Type* Checker::check_scale(Expression& call, const Type* expected) {
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
        if (!coerce(argument.value, real)) return nullptr;
    return convert_result(call, real, result.is_real() ? real : result);
}

/// The call, of type `from`, becomes its conversion.
const Type* Checker::convert_result(Expression& call, const Type& from, const Type& to) {
    if (&from == &to) return &to;
    Expression* inner = make(call.kind, call);
    *inner = call;
    inner->type = &from;
    convert(inner, to);
    call = Expression(*inner);
    return &to;
}

/// `WORD_BCD_TO_UINT(x)`, `UINT_TO_BCD_WORD(x)`: a decimal digit in each four bits.
const Type* Checker::check_bcd(Expression& call, const Type* source, const Type& target,
                               bool to_bcd) {
    const auto is_digits = [](const Type& type) { return type.kind == Kind::bits; };
    const auto is_number = [](const Type& type) { return type.kind == Kind::integer; };
    if (call.arguments.size() != 1)
        return fail("L0907", call.operands[0]->place, "a conversion takes 1 argument");
    Expression*& value = call.arguments[0].value;
    if (!check(*value, source)) return nullptr;
    if (source && !coerce(value, *source)) return nullptr;
    const Type& from = *value->type;
    const bool fits =
        to_bcd ? is_number(from) && is_digits(target) : is_digits(from) && is_number(target);
    if (!fits)
        return fail("L0905", call.place, "BCD digits are those of a bit string, of an integer",
                    "as in WORD_BCD_TO_UINT(x) and UINT_TO_BCD_WORD(x)");
    Expression* converted = make(Expression::Kind::converted, call);
    converted->operands[0] = value;
    converted->conversion.is_bcd = true;
    call = Expression(*converted);
    return &target;
}

/// `INT_TO_REAL(x)`, `TO_REAL(x)`, `REAL_TRUNC_INT(x)`: the call becomes a conversion. Empty if the
/// name is none of one.
std::optional<const Type*> Checker::check_conversion(Expression& call, std::string_view name) {
    std::string upper(name);
    for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    for (const std::size_t prefix : {4U, 5U})  // of any type, of an enumeration
        if (upper.starts_with(prefix == 4 ? "ANY_TO_" : "ENUM_TO_"))
            upper.erase(0, prefix), name.remove_prefix(prefix);
    const std::size_t to = upper.starts_with("TO_") ? 0 : upper.find("_TO_");
    const std::size_t trunc = upper.starts_with("TRUNC_") ? 0 : upper.find("_TRUNC_");
    const bool truncates = to == std::string::npos && trunc != std::string::npos;
    const std::size_t at = truncates ? trunc : to;
    if (at == std::string::npos) return {};
    const std::size_t skip = (truncates ? 6 : 3) + (at == 0 ? 0U : 1U);
    bool is_told = false;
    const auto find = [&](std::string_view text) -> const Type* {
        if (const Type* type = find_elementary(text)) return type;
        Token named = call.token;
        named.text = text;
        is_told |= is_lost(named);
        const NamedType* type = look_up(&Names::types, named);
        return type ? type->type : nullptr;
    };
    std::string_view from_name = name.substr(0, at), to_name = name.substr(at + skip);
    const bool to_bcd = std::string_view(upper).substr(at + skip).starts_with("BCD_");
    const bool from_bcd = at >= 3 && upper.substr(at - 3, 3) == "BCD" && !to_bcd;
    if (to_bcd) to_name.remove_prefix(4);
    if (from_bcd) from_name.remove_suffix(at == 3 ? 3 : 4);
    const Type* target = find(to_name);
    const Type* source = from_name.empty() ? nullptr : find(from_name);
    if (target && (to_bcd || from_bcd) && (from_name.empty() || source))
        return check_bcd(call, source, *target, to_bcd);
    if (!target || (at != 0 && !source))
        return is_told ? std::optional<const Type*>(nullptr) : std::nullopt;
    if (call.arguments.size() != 1)
        return fail("L0907", call.operands[0]->place, fmt::format("{} takes 1 argument", name));
    Expression*& value = call.arguments[0].value;
    const Type* given = check(*value, source);
    if (!given) return nullptr;
    if (given->is_any()) {
        const Type& fallback = given->is_real() ? lreal_type : lint_type;
        if (!coerce(value, source ? *source : fallback)) return nullptr;
    } else if (source && !same_type(*given, *source)) {
        if (!coerce(value, *source)) return nullptr;
    }
    if (source && source->kind == Kind::time) value->type = source;  // TIME and LTIME are alike
    const Type& from = *value->type;
    const bool impossible = !from.is_scalar() || !target->is_scalar();
    if (impossible && !(from.kind == Kind::text && target->is_scalar()) &&
        !(target->kind == Kind::text && from.is_scalar()))
        return fail(
            "L0905", call.place,
            fmt::format("there is no conversion of {} to {}", describe(from), describe(*target)));
    const auto goes = [](const Type& a, const Type& b) {
        return (a.kind == Kind::moment && b.is_date()) ||
               (a.kind == Kind::date && b.kind == Kind::moment) ||
               (a.kind == Kind::clock && b.kind == Kind::time) ||
               (a.kind == Kind::time && b.kind == Kind::clock) || same_type(a, b);
    };
    if (from.is_time() && target->is_time() && !goes(from, *target))
        return fail(
            "L0905", call.place,
            fmt::format("there is no conversion of {} to {}", describe(from), describe(*target)));
    if (same_type(from, *target) && from.is_character == target->is_character) {
        Expression copy = *value;
        call = copy;
        return target;
    }
    if (from.kind == Kind::text && target->kind == Kind::enumeration)
        return fail(
            "L0905", call.place,
            fmt::format("there is no conversion of {} to {}", describe(from), describe(*target)));
    if (target->kind == Kind::enumeration && !target->counted)
        return fail("L0903", call.place,
                    fmt::format("a conversion to {}, whose values have gaps, is not supported",
                                target->name),
                    "write a CASE");
    Expression* operand = value;
    convert(operand, *target);
    if (operand->kind == Expression::Kind::converted && truncates)
        operand->conversion.truncates = true;
    const bool has_sign = target->kind == Kind::text && from.is_integer() && is_scl(call);
    if (has_sign) operand->conversion.has_sign = true;
    const Place place = call.place;
    call = Expression(*operand);
    call.place = place;
    return target;
}

}  // namespace lineshaft::st
