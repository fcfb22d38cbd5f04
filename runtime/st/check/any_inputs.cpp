#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"

namespace lineshaft::st {

namespace {

/// TYPE_CLASS calls a kind of type so, behind `TYPE_`; those of numbers and times say their size.
struct TypeClass {
    Kind kind;
    std::string_view name;
};
constexpr TypeClass classes_of_kinds[] = {
    {Kind::date, "DATE"},         {Kind::clock, "TIMEOFDAY"},    {Kind::moment, "DATEANDTIME"},
    {Kind::text, "STRING"},       {Kind::enumeration, "ENUM"},   {Kind::array, "ARRAY"},
    {Kind::reference, "POINTER"}, {Kind::interface, "INTERFACE"}};

std::string_view class_of(const Type& type) {
    if (type.kind == Kind::boolean) return type.name;
    if (type.kind == Kind::time) return type.counts_ns ? "LTIME" : "TIME";
    if (type.kind == Kind::real) return type.bits == 32 ? "REAL" : "LREAL";
    if (type.kind == Kind::integer) return integer_type(type.bits, type.is_signed).name;
    if (type.kind == Kind::bits) return bits_type(type.bits).name;
    if (type.is_wide) return "WSTRING";
    const auto* row = std::ranges::find(classes_of_kinds, type.kind, &TypeClass::kind);
    if (row != std::end(classes_of_kinds)) return row->name;
    return type.is_any() ? "NONE" : "USERDEF";
}

/// What ANY_BIT and its like take (6.3.2, table 10).
bool takes(std::string_view family, const Type& given) {
    const bool is_number = given.is_number();
    if (family == "ANY_BIT") return given.is_bits() || given.kind == Kind::boolean;
    if (family == "ANY_INT") return given.is_integer();
    if (family == "ANY_REAL") return given.is_real();
    if (family == "ANY_NUM") return is_number;
    if (family == "ANY_MAGNITUDE") return is_number || given.kind == Kind::time;
    if (family == "ANY_STRING") return given.kind == Kind::text;
    if (family == "ANY_DATE") return given.is_date();
    return true;
}

/// A typed value as it is written stands in a variable, to have a place: CODESYS takes none.
void keep_value(Checking& c, Expression*& value) {
    if (!c.routine || !value->place.dialect().any_takes_literals || !check(c, value)) return;
    if (value->kind != E::constant || value->variable || value->type->is_any()) return;
    Variable& kept = c.make_variable(*c.routine, value->token, value->token.text, value->type);
    kept.initial = value;
    value = make_use(c, *value, kept);
}

}  // namespace

bool is_any_input(const Type& type) {
    return type.kind == Kind::structure &&
           (type.name == "__SYSTEM.AnyType" || type.name.starts_with("__SYSTEM.ANY_"));
}

void become_any(Checking& c, Expression*& value, const Type& type) {
    const Type* called = value->kind == E::call ? check(c, value) : nullptr;
    if (called && is_any_input(*called)) {
        value = make_copy(c, *value);
        value->type = &type;
        return;
    }
    keep_value(c, value);
    Expression* place = make_call(c, "__SYSTEM.ADR", value);
    const Type* pointer = check(c, place);
    if (!pointer) return;
    const Type& given = *pointer->element;
    const auto as_input = [&](Expression* any) {
        value = make_copy(c, *any);
        value->type = &type;
    };
    if (is_any_input(given)) return as_input(place->operands[0]);
    const std::string family = type.name.substr(type.name.find('.') + 1);
    if (!takes(family, given.plain()))
        return (void)c.fail(code::type_does_not_fit, value->place,
                            fmt::format("{} takes no {}", family, describe(given)));
    const Type& classes = *type.members[0]->type;
    const auto found =
        std::ranges::find(classes.values, fmt::format("TYPE_{}", class_of(given.plain())));
    const auto number = [&](const Type& of, std::int64_t integer) {
        return Argument{.value = make_constant(c, *place, of, {.integer = integer})};
    };
    value = make_call(c, *place, make_name(c, *place, "__SYSTEM.any_of"),
                      {number(classes, found - classes.values.begin()),
                       {.value = place},
                       number(dint_type, static_cast<std::int64_t>(bytes_of(given)))});
    if (check(c, value)) as_input(value);
}

}  // namespace lineshaft::st
