#include "runtime/st/check/implicit_checks.hpp"

#include "runtime/source/letters.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"

namespace lineshaft::st {

namespace {

bool is_implicit(std::string_view name) {
    const std::string small = lower(name);
    return small == "checkbounds" || small.starts_with("checkdiv") ||
           small.starts_with("checkrange") || small.starts_with("checklrange");
}

/// Null: the application has no such function, or it is not called here.
const Routine* find_check(Checking& c, const Expression& at, const std::string& name) {
    const bool is_due = c.routine && !is_constant(at) && at.place.source->is_users() &&
                        at.place.dialect().has_implicit_checks &&
                        !is_implicit(c.routine->pou->name.text);
    const Routine* found = is_due ? find_in(c.users.routines, name) : nullptr;
    const bool is_guarded = found && at.kind == E::call && at.routine == found;
    return found && found->is_function() && !is_guarded ? found : nullptr;
}

/// The function takes and gives a number of `type`; what it gives is made one of the value's again.
void guard(Checking& c, Expression*& value, const Routine& function, const Type& type,
           const Type* bounds = nullptr) {
    const Type& back = *value->type;
    const Expression like = *value;
    std::vector<Argument> given{{.value = value}};
    if (!same_type(back, type)) convert(c, given[0].value, type);
    if (bounds)
        for (const std::int64_t bound : {bounds->lower, bounds->upper})
            given.push_back({.value = make_constant(c, like, type, {.integer = bound})});
    Expression* call =
        make_call(c, like, make_name(c, like, function.pou->name.text), std::move(given));
    if (!check(c, call, &type)) return;
    value = call;
    if (!bounds && !same_type(*call->type, back)) convert(c, value, back);
}

}  // namespace

void guard_index(Checking& c, Expression*& index, const Type& array) {
    if (const Routine* function = find_check(c, *index, "CheckBounds"))
        guard(c, index, *function, dint_type, &array);
}

void guard_divisor(Checking& c, Expression*& divisor) {
    const Type& type = divisor->type->plain();
    const bool is_long = type.bits == 64;
    const Routine* function = find_check(c, *divisor, "CheckDiv" + type.name);
    const Type& taken = function         ? type
                        : type.is_real() ? (is_long ? lreal_type : real_type)
                                         : (is_long ? lint_type : dint_type);
    if (!function) function = find_check(c, *divisor, "CheckDiv" + taken.name);
    if (function) guard(c, divisor, *function, taken);
}

void guard_range(Checking& c, Expression*& value, const Type& subrange) {
    const Type& plain = subrange.plain();
    const Type& taken = integer_type(plain.bits == 64 ? 64 : 32, plain.is_signed);
    const std::string name = fmt::format("Check{}Range{}", plain.bits == 64 ? "L" : "",
                                         plain.is_signed ? "Signed" : "Unsigned");
    if (const Routine* function = find_check(c, *value, name))
        guard(c, value, *function, taken, &subrange);
}

}  // namespace lineshaft::st
