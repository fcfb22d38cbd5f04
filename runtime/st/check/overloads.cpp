#include "runtime/source/letters.hpp"
#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

/// How well a value goes where `to` is due; empty: not at all.
std::optional<int> closeness(const Type& from, const Type& to) {
    constexpr int same = 8, alike = 6, usual = 5, possible = 3;
    if (same_type(from, to)) return same;
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
        const auto one = closeness(*parameter, *argument.value->type);
        const bool converts = call.place.dialect().vendor == Vendor::siemens &&
                              parameter->section == Section::input &&
                              parameter->type->kind == Kind::integer &&
                              argument.value->type->kind == Kind::integer;
        if (!one && !converts) return {};
        sum += one.value_or(0);
    }
    const auto missing =
        static_cast<int>(parameters.size()) - static_cast<int>(call.arguments.size());
    return sum - std::max(missing, 0);
}

}  // namespace

bool means_standard(const Expression& call, const Routine& method) {
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

}  // namespace lineshaft::st
