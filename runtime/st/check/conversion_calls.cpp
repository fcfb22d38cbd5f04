#include "runtime/st/check/conversion_calls.hpp"

#include "runtime/source/letters.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"

namespace lineshaft::st {

namespace {

/// `WORD_BCD_TO_UINT(x)`, `UINT_TO_BCD_WORD(x)`: a decimal digit in each four bits.
const Type* check_bcd(Checking& c, Expression& call, const Type* source, const Type& target,
                      bool to_bcd) {
    const auto is_digits = [](const Type& type) { return type.kind == Kind::bits; };
    const auto is_number = [](const Type& type) { return type.kind == Kind::integer; };
    if (call.arguments.size() != 1)
        return c.fail("L0907", call.operands[0]->place, "a conversion takes 1 argument");
    Expression*& value = call.arguments[0].value;
    if (!check(c, *value, source)) return nullptr;
    if (source && !coerce(c, value, *source)) return nullptr;
    const Type& from = *value->type;
    const bool fits =
        to_bcd ? is_number(from) && is_digits(target) : is_digits(from) && is_number(target);
    if (!fits)
        return c.fail("L0905", call.place, "BCD digits are those of a bit string, of an integer",
                      "as in WORD_BCD_TO_UINT(x) and UINT_TO_BCD_WORD(x)");
    Expression* converted = make(c, E::converted, call);
    converted->operands[0] = value;
    converted->conversion.is_bcd = true;
    call = Expression(*converted);
    return &target;
}

}  // namespace

std::optional<const Type*> check_conversion(Checking& c, Expression& call, std::string_view name) {
    std::string upper(name);
    for (char& x : upper) x = x >= 'a' && x <= 'z' ? static_cast<char>(x - 'a' + 'A') : x;
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
        is_told |= c.is_lost(named);
        const NamedType* type = c.look_up(&Names::types, named);
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
        return check_bcd(c, call, source, *target, to_bcd);
    if (!target || (at != 0 && !source))
        return is_told ? std::optional<const Type*>(nullptr) : std::nullopt;
    if (call.arguments.size() != 1)
        return c.fail("L0907", call.operands[0]->place, fmt::format("{} takes 1 argument", name));
    Expression*& value = call.arguments[0].value;
    const Type* given = check(c, *value, source);
    if (!given) return nullptr;
    if (given->is_any()) {
        const Type& fallback = given->is_real() ? lreal_type : lint_type;
        if (!coerce(c, value, source ? *source : fallback)) return nullptr;
    } else if (source && !same_type(*given, *source)) {
        if (!coerce(c, value, *source)) return nullptr;
    }
    if (source && source->kind == Kind::time) value->type = source;  // TIME and LTIME are alike
    const Type& from = *value->type;
    const bool impossible = !from.is_scalar() || !target->is_scalar();
    if (impossible && !(from.kind == Kind::text && target->is_scalar()) &&
        !(target->kind == Kind::text && from.is_scalar()))
        return c.fail(
            "L0905", call.place,
            fmt::format("there is no conversion of {} to {}", describe(from), describe(*target)));
    const auto goes = [](const Type& a, const Type& b) {
        return (a.kind == Kind::moment && b.is_date()) ||
               (a.kind == Kind::date && b.kind == Kind::moment) ||
               (a.kind == Kind::clock && b.kind == Kind::time) ||
               (a.kind == Kind::time && b.kind == Kind::clock) || same_type(a, b);
    };
    if (from.is_time() && target->is_time() && !goes(from, *target))
        return c.fail(
            "L0905", call.place,
            fmt::format("there is no conversion of {} to {}", describe(from), describe(*target)));
    if (same_type(from, *target) && from.is_character == target->is_character) {
        Expression copy = *value;
        call = copy;
        return target;
    }
    if (from.kind == Kind::text && target->kind == Kind::enumeration)
        return c.fail(
            "L0905", call.place,
            fmt::format("there is no conversion of {} to {}", describe(from), describe(*target)));
    if (target->kind == Kind::enumeration && !target->counted)
        return c.fail("L0903", call.place,
                      fmt::format("a conversion to {}, whose values have gaps, is not supported",
                                  target->name),
                      "write a CASE");
    Expression* operand = value;
    convert(c, operand, *target);
    if (operand->kind == E::converted && truncates) operand->conversion.truncates = true;
    const bool has_sign = target->kind == Kind::text && from.is_integer() &&
                          call.place.dialect().texts_of_integers_have_signs;
    if (has_sign) operand->conversion.has_sign = true;
    const Place place = call.place;
    call = Expression(*operand);
    call.place = place;
    return target;
}

}  // namespace lineshaft::st
