#include "runtime/st/check/any_inputs.hpp"

#include <bit>

#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"

namespace lineshaft::st {

namespace {

std::string_view class_of_number(const Type& type) {
    constexpr std::string_view bits[] = {"BYTE", "WORD", "DWORD", "LWORD"};
    constexpr std::string_view integers[] = {"SINT", "INT", "DINT", "LINT"};
    constexpr std::string_view unsigned_[] = {"USINT", "UINT", "UDINT", "ULINT"};
    const int place = std::countr_zero(static_cast<unsigned>(type.bits)) - 3;
    if (type.kind == Kind::bits) return bits[place];
    return type.is_signed ? integers[place] : unsigned_[place];
}

/// Of TYPE_CLASS, without `TYPE_`.
std::string_view class_of(const Type& type) {
    switch (type.kind) {
        case Kind::boolean:
            return "BOOL";
        case Kind::integer:
        case Kind::bits:
            return class_of_number(type);
        case Kind::real:
            return type.bits == 32 ? "REAL" : "LREAL";
        case Kind::time:
            return type.counts_ns ? "LTIME" : "TIME";
        case Kind::date:
            return "DATE";
        case Kind::clock:
            return "TIMEOFDAY";
        case Kind::moment:
            return "DATEANDTIME";
        case Kind::text:
            return "STRING";
        case Kind::enumeration:
            return "ENUM";
        case Kind::array:
            return "ARRAY";
        case Kind::reference:
            return "POINTER";
        case Kind::interface:
            return "INTERFACE";
        case Kind::handle:
        case Kind::structure:
        case Kind::union_:
        case Kind::block:
        case Kind::standard:
            return "USERDEF";
        case Kind::any_integer:
        case Kind::any_real:
        case Kind::any_bits:
            return "NONE";
    }
    return "NONE";
}

}  // namespace

bool is_any_input(const Type& type) {
    return type.kind == Kind::structure && type.name == "__SYSTEM.AnyType";
}

void become_any(Checking& c, Expression*& value, const Type& type) {
    Expression* place = make_call(c, "ADR", value);
    const Type* pointer = check(c, place);
    if (!pointer) return;
    const Type& given = *pointer->element;
    if (&given == &type) {
        value = place->operands[0];
        return;
    }
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
    check(c, value, &type);
}

}  // namespace lineshaft::st
