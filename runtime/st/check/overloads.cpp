#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

/// How well a value goes where `to` is due; empty: not at all.
std::optional<int> closeness(const Type& from, const Type& to) {
    constexpr int same = 8, alike = 6, usual = 5, possible = 3;
    if (same_type(from, to)) return same;
    if (is_any_input(to)) return 0;
    if (&from == &null_type)
        return to.is_reference() || to.kind == Kind::interface ? std::optional(possible)
                                                               : std::nullopt;
    if (from.kind == Kind::text && to.kind == Kind::text) return alike;
    if (from.kind == Kind::array && to.is_open_array()) {
        const Type* element = &from;
        for (std::size_t i = 0; i < to.dimensions && element->kind == Kind::array; ++i)
            element = element->element;
        return to.element && same_type(*element, *to.element) ? std::optional(alike) : std::nullopt;
    }
    if (from.routine && to.routine)
        return is_a(*from.routine, *to.routine) ? std::optional(alike) : std::nullopt;
    if (from.is_any()) {
        const bool is_usual = from.is_real() ? to.is_real() && to.bits == 64
                              : from.kind == Kind::any_integer
                                  ? to.kind == Kind::integer && to.bits == 32 && to.is_signed
                                  : to.kind == Kind::bits;
        const bool is_possible = from.is_real() ? to.is_real() : to.is_number() || to.is_bits();
        return is_usual      ? std::optional(usual)
               : is_possible ? std::optional(to.is_real() && !from.is_real() ? 1 : possible)
                             : std::nullopt;
    }
    if (from.is_scalar() && to.is_scalar() && widens(from, to)) return possible - (to.bits > 32);
    return {};
}

std::vector<const Variable*> parameters_of(const Routine& routine) {
    std::vector<const Variable*> found;
    for (const Variable& variable : routine.variables)
        if (variable.is_parameter()) found.push_back(&variable);
    return found;
}

std::optional<int> closeness(const Variable& parameter, const Type& given) {
    const bool goes_out = parameter.section == Section::output;
    return goes_out ? closeness(*parameter.type, given) : closeness(given, *parameter.type);
}

/// A number as it is written goes only where it is in range.
bool is_in_range(const Expression& given, const Type& to) {
    const bool is_written = given.kind == E::constant && given.type->kind == Kind::any_integer;
    const Wide value = given.constant.integer;
    return !is_written || to.kind != Kind::integer ||
           (value >= smallest(to) && value <= largest(to));
}

bool is_of_no_parameter(const Argument& argument) {
    return argument.is_output && same_name(argument.name.text, "eno");
}

std::optional<int> closeness(const Expression& call, const Routine& routine) {
    const std::vector<const Variable*> parameters = parameters_of(routine);
    int sum = 0;
    for (std::size_t i = 0; i < call.arguments.size(); ++i) {
        const Argument& argument = call.arguments[i];
        if (is_of_no_parameter(argument)) continue;
        const Variable* parameter = i < parameters.size() ? parameters[i] : nullptr;
        if (argument.is_named()) {
            const auto* named = find_called(parameters, argument.name.text, &Variable::text);
            parameter = named ? *named : nullptr;
        }
        if (!parameter || !parameter->type) return {};
        if (!argument.value->type) continue;
        if (!is_in_range(*argument.value, *parameter->type)) return {};
        const Type& type = *argument.value->type;
        const bool is_character =
            parameter->type->is_character && is_literal_character(*argument.value);
        const auto one = closeness(*parameter, is_character ? char_type : type);
        const bool converts = call.place.dialect().inputs_take_any_integer &&
                              parameter->section == Section::input &&
                              parameter->type->kind == Kind::integer && type.kind == Kind::integer;
        if (!one && !converts) return {};
        const bool is_text = !is_character && is_literal_character(*argument.value);
        sum += one.value_or(0) - (is_text ? 1 : 0);
    }
    const auto missing =
        static_cast<int>(parameters.size()) - static_cast<int>(call.arguments.size());
    return sum - std::max(missing, 0);
}

}  // namespace

bool means_function(Checking& c, const Expression& call, const Routine& method) {
    const Token& name = call.operands[0]->token;
    if (call.place.dialect().this_calls_methods) {
        const Routine* function = c.find_routine(name);
        if (function && function->is_function() && !function->owner) return true;
    }
    const StandardFunction* f = find_standard_function(method.pou->name.text);
    const int count = static_cast<int>(call.arguments.size());
    return f && count >= f->least && count <= f->most &&
           call.arguments.size() > parameters_of(method).size();
}

Routine& overload_of(Checking& c, Expression& call, const NameMap<std::vector<Routine*>>& overloads,
                     Routine& first) {
    const auto it = std::ranges::find_if(overloads, [&](const auto& entry) {
        return std::ranges::find(entry.second, &first) != entry.second.end();
    });
    if (it == overloads.end()) return first;
    for (Argument& argument : call.arguments)
        if (!is_of_no_parameter(argument)) check(c, argument.value);
    Routine* best = &first;
    std::optional<int> closest;
    for (Routine* routine : it->second) {
        const auto one = closeness(call, *routine);
        if (!one || (closest && *one <= *closest)) continue;
        closest = one;
        best = routine;
    }
    return *best;
}

/// In the namespaces that are seen there, the innermost first.
static std::vector<Routine*> functions_named(Checking& c, const Token& name) {
    std::vector<Routine*> found;
    const Prefixes* here = is_prelude(name) ? nullptr : c.prefixes_at(name.place);
    if (!here) return found;
    for (const std::string_view path : here->paths) {
        Routine* routine = find_in(c.users.routines, fmt::format("{}.{}", path, name.text));
        if (routine && routine->is_function() && std::ranges::find(found, routine) == found.end())
            found.push_back(routine);
    }
    return found;
}

Routine& function_called(Checking& c, Expression& call, Routine& first) {
    Routine& nearest = overload_of(c, call, c.names_beside(first.pou->name).overloads, first);
    const std::vector<Routine*> named = functions_named(c, call.operands[0]->token);
    if (named.size() < 2) return nearest;
    for (Argument& argument : call.arguments)
        if (!is_of_no_parameter(argument)) check(c, argument.value);
    if (closeness(call, nearest)) return nearest;
    for (Routine* other : named) {
        Routine& one = overload_of(c, call, c.users.overloads, *other);
        if (closeness(call, one)) return one;
    }
    return nearest;
}

}  // namespace lineshaft::st
