#include "runtime/st/check/calls.hpp"

#include "runtime/source/letters.hpp"
#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/dynamic_memory.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/image.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/open_arrays.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/check/variants.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/types/parameters.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

/// What B&R's EDGEPOS keeps of each of its calls is a variable of the block in which the call
/// stands. False: it has none, which was told.
bool take_memory(Checking& c, Expression*& e, const Routine& called) {
    const Token& name = called.pou->name;
    const bool keeps = is_prelude(name) && lower(name.text).starts_with("edge");
    if (!keeps || e->arguments.size() != 1) return true;
    Routine* keeper = c.routine;
    while (keeper->owner) keeper = keeper->owner;
    if (!keeper->has_instances())
        return c.fail(
            code::wrong_place, e->place,
            fmt::format("{} keeps what it was given, and a function keeps nothing", name.text),
            "call it in a block, or give the function what was before");
    Variable& before = c.make_variable(
        *keeper, e->token,
        c.checked.names.emplace_back(fmt::format("{} {}", name.text, keeper->variables.size())),
        &bool_type);
    e = make_with(c, *e, {e->arguments[0], {.value = make_use(c, *e, before)}});
    return true;
}

/// __VARINFO of CODESYS is given a variable's name as it is written, too, and its type's. False: it
/// has none, which was told.
bool take_names(Checking& c, Expression*& e, const Routine& called) {
    const Token& name = called.pou->name;
    const bool tells = is_library(name) && same_name(name.text, "__varinfo");
    if (!tells || e->arguments.size() != 1) return true;
    Expression* variable = make_copy(c, *e->arguments[0].value);
    const Type* type = check(c, variable);
    if (!type) return false;
    const auto text = [&](std::string_view input, std::string_view value) {
        constexpr std::size_t longest = 255;
        const Variable* to = find_in(called.names, input);
        return make_constant(c, *e, *to->type, {.text = std::string(value.substr(0, longest))});
    };
    const std::string_view of = type->name;
    e = make_with(c, *e,
                  {e->arguments[0],
                   {.value = text("symbol", e->arguments[0].value->place.text())},
                   {.value = text("typeName", of.substr(of.rfind('.') + 1))}});
    return true;
}

/// A variable may bear a function's name, but no instance can be meant then.
bool is_instance(Checking& c, const Token& name) {
    const Variable* variable = find_variable(c, name);
    return variable && variable->type && variable->type->is_instance();
}

/// A library's block may stand for PLCopen's of the same name, which has the argument.
std::string help_with_argument(Checking& c, std::string_view argument, const Routine& routine,
                               const std::vector<std::string>& names) {
    if (same_name(argument, "en"))
        return "EN is for a call that is a statement, or whose value is assigned";
    const std::string_view full = routine.name;
    const std::string_view name = full.substr(full.rfind('.') + 1);
    const BlockType* standard = is_library(routine.pou->name) ? c.catalog.find(name) : nullptr;
    const auto is_its = [&](const Field& field) {
        return same_name(field.name, argument) ||
               same_name(field.name, standard_part_name(argument));
    };
    if (!standard || std::ranges::none_of(standard->fields, is_its))
        return suggest(argument, names);
    return fmt::format(
        "PLCopen's {} has it; {} is taken as a name stands here that it alone has, as Buffered, "
        "which "
        "is PLCopen's mcBuffered",
        name, full.substr(0, full.size() - name.size() - 1));
}

/// EN and ENO, which a FUNCTION may declare: a list without names leaves them out (6.6.1.5).
bool is_enable(const Variable& variable) {
    const bool is_input = variable.section == Section::input && variable.initial;
    return variable.of && variable.of->kind == PouKind::function && variable.type &&
           variable.type->kind == Kind::boolean && !variable.name.place.dialect().is_loose &&
           ((is_input && same_name(variable.text, "en")) ||
            (variable.section == Section::output && same_name(variable.text, "eno")));
}

Variable* find_parameter(Checking& c, Argument& argument, Routine& routine, std::size_t position) {
    const bool named = argument.is_named();
    const bool inner = c.is_in_test() && named && routine.has_instances();
    std::size_t i = 0;
    std::vector<Variable*> variables = all_variables(routine);
    const auto is_given = [](const Variable* v) { return v->section != Section::output; };
    const bool outputs_last = routine.pou->name.place.dialect().is_loose;
    if (outputs_last) std::stable_partition(variables.begin(), variables.end(), is_given);
    for (Variable* variable : variables) {
        if (!variable->is_parameter() && !inner) continue;
        if (!named && is_enable(*variable)) continue;
        if (named ? same_name(variable->text, argument.name.text) : i == position) return variable;
        ++i;
    }
    if (argument.is_output && same_name(argument.name.text, "eno")) return &eno_of(c, routine);
    if (!named)
        return c.fail(code::wrong_arguments, argument.value->place,
                      fmt::format("'{}' takes {} argument{}", routine.name, i, i == 1 ? "" : "s"));
    if (routine.has_unknown_base) return nullptr;
    std::vector<std::string> names;
    for (const Variable* variable : variables)
        if (variable->is_parameter() || inner) names.emplace_back(variable->text);
    return c.fail(code::wrong_arguments, argument.name.place,
                  fmt::format("'{}' has no argument '{}'", routine.name, argument.name.text),
                  help_with_argument(c, argument.name.text, routine, names));
}

/// TwinCAT takes what is given last.
void note_twice(Checking& c, const Argument& argument) {
    const std::string message = fmt::format("'{}' is given twice", argument.variable->text);
    const Place& place = argument.value->place;
    if (place.dialect().is_loose && argument.is_named() && !argument.is_output)
        c.warn(code::wrong_arguments, place, message + ", and the last one counts", "");
    else
        c.fail(code::wrong_arguments, place, message);
}

/// A VAR_IN_OUT that a test does not give stays what it was; at first it is a variable of its own.
Argument leave_out(Checking& c, const Expression& call, Variable& parameter) {
    const Type* type = !parameter.type->is_open  ? parameter.type
                       : parameter.type->is_wide ? &wide_string_type
                                                 : &string_type;
    Variable& own = c.make_variable(*c.routine, {}, {}, type);
    depend(c, own.type, call.place);
    c.routine->lends = true;
    return {parameter.name, false, make_use(c, call, own), &parameter, true};
}

bool is_open_array(const Variable& variable) {
    return variable.type && variable.type->is_open_array();
}

/// They stand behind it.
std::vector<Variable*> bounds_of(const Routine& routine, const Variable& array) {
    std::vector<Variable*> found;
    for (Variable* variable : all_variables(routine))
        if (variable->bound_of == &array) found.push_back(variable);
    return found;
}

/// An ARRAY[*] takes where its first element is and two bounds.
void give_open_arrays(Checking& c, Expression*& e, const Routine& routine) {
    const auto is_one = [](const Argument& a) { return a.variable && is_open_array(*a.variable); };
    if (std::ranges::none_of(e->arguments, is_one)) return;
    std::vector<Argument> given;
    for (const Argument& argument : e->arguments)
        if (!is_one(argument))
            given.push_back(argument);
        else
            give_open_array(c, argument, *argument.variable, bounds_of(routine, *argument.variable),
                            given);
    e = make_with(c, *e, std::move(given));
}

/// `EN := TRUE` of a call within an expression says nothing.
void leave_out_enable(Checking& c, Expression*& e, const Routine& routine) {
    const auto is_enable = [&](Argument& a) {
        return same_name(a.name.text, "en") && !declares(routine, "en") && check(c, a.value) &&
               a.value->kind == E::constant && a.value->type->kind == Kind::boolean &&
               a.value->constant.integer == 1;
    };
    std::vector<Argument> left = e->arguments;
    if (std::erase_if(left, is_enable) > 0) e = make_with(c, *e, std::move(left));
}

void refuse_without(Checking& c, const Expression& call, std::string_view called,
                    const Variable& parameter) {
    c.fail(code::wrong_arguments, call.operands[0]->place,
           fmt::format("'{}' is called without '{}'", called, parameter.text),
           fmt::format("write {} := ...", parameter.text));
}

void check_arguments(Checking& c, Expression*& e, Routine& routine) {
    leave_out_enable(c, e, routine);
    Expression& call = *e;
    std::size_t position = 0;
    std::vector<const Variable*> given;
    const Dialect& dialect = call.place.dialect();
    const bool may_end_early =
        dialect.inputs_may_be_left_out || (routine.owner && dialect.methods_may_leave_out_inputs);
    bool by_name = call.arguments.empty() || may_end_early;  // 6.6.1.4.2
    for (Argument& argument : call.arguments) {
        by_name |= argument.is_named();
        Variable* parameter = find_parameter(c, argument, routine, position++);
        argument.variable = parameter;
        if (!parameter) {
            check(c, argument.value);
            continue;
        }
        if (argument.is_named()) c.note(argument.name.place, *parameter);
        if (std::ranges::find(given, parameter) != given.end()) note_twice(c, argument);
        given.push_back(parameter);
        if (!is_open_array(*parameter)) check_argument(c, argument, *parameter);
    }
    std::vector<Argument> left_out;
    for (Variable* declared : all_variables(routine)) {
        Variable& variable = *declared;
        const bool due =
            (variable.section == Section::in_out && !is_kept_in_out(variable)) ||
            is_open_array(variable) ||
            (variable.section == Section::input && !routine.has_instances() &&
             (!by_name || !call.place.dialect().named_inputs_may_be_left_out) && !variable.initial);
        if (!due || call.operands[1] || variable.bound_of ||
            std::ranges::find(given, &variable) != given.end())
            continue;
        const bool may_miss = c.is_in_test() && routine.has_instances();
        if (may_miss && variable.type) left_out.push_back(leave_out(c, call, variable));
        if (!may_miss) refuse_without(c, call, routine.name, variable);
    }
    if (!left_out.empty()) {
        left_out.insert(left_out.begin(), call.arguments.begin(), call.arguments.end());
        e = make_with(c, call, std::move(left_out));
    }
    give_open_arrays(c, e, routine);
}

/// What vendors add to a block that commands an axis; null for another input.
const AddedInput* added_input(const Type& type, std::string_view argument) {
    const auto refers = [](const Variable* member) { return member->type->is_handle(); };
    return std::ranges::any_of(type.members, refers) ? find_added_input(argument) : nullptr;
}

void ignore(Checking& c, const Type& type, Argument& argument, std::optional<double> only) {
    if (!check(c, argument.value)) return;
    const Expression& value = *argument.value;
    if (!only || (is_constant(value) && as_real(value) == *only))
        return c.warn(code::argument_not_taken, argument.name.place,
                      fmt::format("{} does not take '{}'", type.name, argument.name.text),
                      "a simulated axis does the same with and without");
    c.fail(code::not_supported, argument.name.place,
           fmt::format("'{}' of {} is not supported", argument.name.text, type.name),
           *only == 0 ? std::string("leave it out: it is as if it were FALSE")
                      : fmt::format("leave it out: it is as if it were {}", *only));
}

void check_standard_arguments(Checking& c, Expression*& e, const Type& type) {
    Expression& call = *e;
    std::vector<Variable*> pins;
    std::ranges::copy_if(type.members, std::back_inserter(pins),
                         [](const Variable* member) { return member->section != Section::local; });
    const std::vector<std::string> names = shown_names(pins, e->place);
    std::size_t position = 0;
    for (Argument& argument : call.arguments) {
        Variable* found = nullptr;
        if (!argument.is_named()) {
            if (position < pins.size()) found = pins[position++];
        } else {
            found = find_member(type, standard_name(type, argument.name.text));
            if (found && found->section == Section::local) found = nullptr;
        }
        argument.variable = found;
        if (found && argument.is_named()) c.note(argument.name.place, *found);
        const AddedInput* ignored =
            found || argument.is_output ? nullptr : added_input(type, argument.name.text);
        if (ignored) {
            ignore(c, type, argument, ignored->only);
            continue;
        }
        if (!found && !argument.is_named()) {
            c.fail(code::wrong_arguments, argument.value->place,
                   fmt::format("{} takes {} arguments", type.name, names.size()),
                   fmt::format("they are {}", fmt::join(names, ", ")));
            break;
        }
        if (!found) {
            const std::string_view instead = instead_of_input(argument.name.text);
            c.fail(code::wrong_arguments, argument.name.place,
                   fmt::format("{} has no argument '{}'", type.name, argument.name.text),
                   instead.empty() ? suggest(argument.name.text, names) : std::string(instead));
            continue;
        }
        check_argument(c, argument, *found);
    }
    std::vector<Argument> taken;
    std::ranges::copy_if(call.arguments, std::back_inserter(taken), &Argument::variable);
    if (taken.size() < call.arguments.size()) e = make_with(c, call, std::move(taken));
    for (const Variable* member : type.members)
        if (member->section == Section::in_out &&
            std::ranges::find(e->arguments, member, &Argument::variable) == e->arguments.end())
            refuse_without(c, call, type.name, *member);
}

/// That the routine at hand runs `called`.
void note_call(Checking& c, const Expression& call, Routine& called) {
    if (!c.routine) return;
    if (call.is_dispatched) {
        c.routine->dispatches = c.checked.dispatches = true;
        c.routine->finds.push_back(&called);
    } else {
        c.routine->calls.push_back({&called, call.place, is_through_reference(call), true});
    }
}

/// The instance is given its arguments as by a call of itself.
void check_call_of_action(Checking& c, Expression*& e, Routine& block) {
    e->routine = &block;
    check_arguments(c, e, block);
    check_call(c, e->operands[1], true, nullptr);
}

const Type* check_instance_call(Checking& c, Expression*& e, const Type& type, bool as_statement) {
    if (!as_statement)
        return c.fail(code::type_does_not_fit, e->place, "the call of an instance has no value",
                      "call it as a statement of its own, then take an output: name.Q");
    if (type.kind == Kind::block) {
        const Expression& instance = *e->operands[0];
        if (e->operands[1]) return check_call_of_action(c, e, *type.routine), nullptr;
        if (type.routine->pou->is_class)
            return c.fail(code::wrong_place, e->place,
                          fmt::format("{} is a CLASS, and has no body", type.name),
                          "call one of its methods");
        e->is_dispatched = type.routine->is_replaced && may_be_derived(instance);
        note_call(c, *e, *type.routine);
        e->routine = type.routine;
        if (root_of(*e->operands[0]).kind == E::deref) depend(c, &type, e->place, true);
        check_arguments(c, e, *type.routine);
    } else {
        check_standard_arguments(c, e, type);
    }
    return nullptr;
}

}  // namespace

const Type* check_routine_call(Checking& c, Expression*& e, Routine& routine, bool as_statement) {
    e->routine = &routine;
    c.note(e->operands[0]->token.place, routine);
    note_call(c, *e, routine);
    check_arguments(c, e, routine);
    if (routine.result) return routine.result->type;
    if (!as_statement)
        return c.fail(code::type_does_not_fit, e->place,
                      fmt::format("'{}' has no result", routine.name),
                      "call it as a statement of its own, and take an output with '=>'");
    return nullptr;
}

std::string_view standard_name(const Type& type, std::string_view name) {
    if (type.kind != Kind::standard) return name;
    const std::string_view other =
        find_member(type, name) ? std::string_view() : standard_part_name(name);
    return find_member(type, other) ? other : name;
}

/// `Motor.Motor_1(...)` of STEP 7 V5: the instance data block of that FUNCTION_BLOCK is called.
static void name_instance_of_block(Checking& c, Expression*& e) {
    const Expression& callee = *e->operands[0];
    if (callee.kind != E::member || callee.operands[0]->kind != E::name ||
        !e->place.dialect().has_s7_instructions)
        return;
    const Token& block = callee.operands[0]->token;
    const Routine* routine = find_variable(c, block) ? nullptr : c.find_routine(block);
    if (!routine || !routine->has_instances()) return;
    Expression* instance = make_name(c, *callee.operands[0], callee.token.text);
    const Variable* found = find_variable(c, instance->token);
    if (found && found->type && found->type->kind == Kind::block && found->type->routine == routine)
        e = make_call(c, *e, instance, e->arguments);
}

/// It is a call of what the standard has.
static const Type* check_function(Checking& c, Expression*& e, const Type* expected) {
    if (const auto given = check_move(c, e, expected)) return *given;
    if (const auto given = check_variant_call(c, e)) return *given;
    if (const auto given = check_reference_call(c, e, expected)) return *given;
    if (const auto given = check_place_call(c, e)) return *given;
    return check_standard_function(c, e, expected);
}

/// `__SYSTEM.ADR(x)`, which the checker puts in: of the standard, whatever has that name beside it.
static std::optional<const Type*> check_put_in(Checking& c, Expression*& e, const Type* expected) {
    constexpr std::string_view system = "__SYSTEM.";
    const Expression& callee = *e->operands[0];
    const std::string_view name = callee.token.text;
    if (callee.kind != E::name || !name.starts_with(system) || c.find_routine(callee.token))
        return {};
    e = make_call(c, *e, make_name(c, callee, name.substr(system.size())), e->arguments);
    return check_function(c, e, expected);
}

/// `timer.TON(...)`, `station.ReadStatus()`, `motor.Start(...)`. Empty: what is called is none of
/// these.
static std::optional<const Type*> call_of_member(Checking& c, Expression*& e, bool as_statement) {
    const Expression& callee = *e->operands[0];
    const Type* of = check(c, e->operands[0]->operands[0]);
    if (!of) return nullptr;
    if (is_named_as_its_kind(*of, callee.token.text)) {
        if (of->standard) note_timer(c, *callee.operands[0], *of->standard);
        e = make_call(c, *e, callee.operands[0], e->arguments);  // `#delay.TON(...)`
        return check_instance_call(c, e, *of, as_statement);
    }
    if (const Type* timer = timer_of(c, *of, callee.token)) {
        e = make_call(c, *e, callee.operands[0], e->arguments);  // `#any.TOF(...)`
        e->called_as = timer->standard;
        note_timer(c, *e->operands[0], *timer->standard);
        return check_instance_call(c, e, *of, as_statement);
    }
    if (Routine* part = find_part(c, *of, callee.token.text); part && as_statement) {
        e = e->operands[0];
        return check_part(c, e, *part);
    }
    if (of->kind == Kind::block || of->kind == Kind::interface) {
        if (Routine* first = find_in(of->routine->methods, callee.token.text)) {
            Routine& method = overload_of(c, *e, of->routine->overloads, *first);
            if (!method.pou->follows_init &&
                !is_accessible(c, method.pou->access, *method.owner, callee.token))
                return nullptr;
            return check_method_call(c, e, method, *callee.operands[0], as_statement);
        }
    }
    return {};
}

/// A method of its own block, or a function. Empty: an instance is called.
static std::optional<const Type*> call_by_name(Checking& c, Expression*& e, bool as_statement,
                                               const Type* expected) {
    const Expression& callee = *e->operands[0];
    if (const Routine* block = block_with_method(c, callee.token);
        block && !means_function(c, *e, *find_in(block->methods, callee.token.text))) {
        Routine& first = *find_in(block->methods, callee.token.text);
        Routine& method = overload_of(c, *e, block->overloads, first);
        e->is_dispatched = method.is_replaced;
        return check_routine_call(c, e, method, as_statement);
    }
    if (!find_variable(c, callee.token)) declare_program(c, callee.token);
    if (is_instance(c, callee.token) || is_own_instance(c, callee)) return {};
    const std::string_view name = callee.token.text;
    Routine* routine = c.find_routine(callee.token);
    if (routine && take_as_variant(c, e, *routine)) return check_call(c, e, as_statement, expected);
    if (routine && !routine->type && !is_of_dynamic_memory(name)) {
        if (!take_query(c, e, *routine) || !take_memory(c, e, *routine) ||
            !take_names(c, e, *routine) || !take_bytes(c, e, *routine) ||
            !is_given_bytes(c, *e, *routine))
            return nullptr;
        return check_routine_call(c, e, function_called(c, *e, *routine), as_statement);
    }
    const bool is_function = (routine || !callee.token.quoted) && !callee.token.local &&
                             (find_standard_function(name) || !find_variable(c, callee.token));
    if (is_function && find_test_statement(name) != TestCall::none)
        return check_test_statement(c, *e, as_statement);
    if (is_function) return check_function(c, e, expected);
    return {};
}

const Type* check_call(Checking& c, Expression*& e, bool as_statement, const Type* expected) {
    if (const auto given = check_put_in(c, e, expected)) return *given;
    if (Expression* assertion = c.has_tests ? assertion_call(c, *e) : nullptr) {
        e = assertion;
        return check_test_statement(c, *e, as_statement);
    }
    if (const auto name = qualified_name(c, *e->operands[0]))
        e = make_call(c, *e, make_name(c, *e->operands[0], name->text), e->arguments);
    name_instance_of_block(c, e);
    const Expression& callee = *e->operands[0];
    if (callee.kind == E::member) name_block_of_list(c, *e->operands[0]);
    if (refuse_member_of_namespace(c, callee)) return nullptr;
    if (callee.kind == E::member)
        if (const auto given = call_of_member(c, e, as_statement)) return *given;
    if (callee.kind == E::name)
        if (const auto given = call_by_name(c, e, as_statement, expected)) return *given;
    const Type* type = check(c, e->operands[0]);
    if (!type) return nullptr;
    if (as_statement && e->arguments.empty())
        if (Routine* part = find_part(c, *type, "ReadStatus")) return check_part(c, e, *part);
    if (type->is_instance()) return check_instance_call(c, e, *type, as_statement);
    return c.fail(code::wrong_arguments, callee.place,
                  fmt::format("{} cannot be called", describe(*type)),
                  "functions, methods and instances of function blocks are called");
}

}  // namespace lineshaft::st
