#include "runtime/source/letters.hpp"
#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/types/s5.hpp"

namespace lineshaft::st {

namespace {

/// What the name of a conversion says.
struct ConversionName {
    std::string_view name = {};  ///< without ANY_ and ENUM_
    std::string_view from = {};  ///< a type; empty: of any
    std::string_view to = {};    ///< a type
    bool truncates = false;      ///< `REAL_TRUNC_INT`
    bool from_bcd = false;       ///< `WORD_BCD_TO_UINT`
    bool to_bcd = false;         ///< `UINT_TO_BCD_WORD`
};

std::optional<ConversionName> read_conversion(std::string_view name) {
    std::string capital = upper(name);
    for (const std::string_view of_any : {"ANY_", "ENUM_"}) {
        if (!capital.starts_with(fmt::format("{}TO_", of_any))) continue;
        capital.erase(0, of_any.size());
        name.remove_prefix(of_any.size());
    }
    const std::size_t to = capital.starts_with("TO_") ? 0 : capital.find("_TO_");
    const std::size_t trunc = capital.starts_with("TRUNC_") ? 0 : capital.find("_TRUNC_");
    const bool truncates = to == std::string::npos && trunc != std::string::npos;
    const std::size_t at = truncates ? trunc : to;
    if (at == std::string::npos) return {};
    const std::size_t behind = at + (truncates ? 6 : 3) + (at == 0 ? 0U : 1U);
    ConversionName read{name, name.substr(0, at), name.substr(behind), truncates};
    read.to_bcd = std::string_view(capital).substr(behind).starts_with("BCD_");
    read.from_bcd = at >= 3 && capital.substr(at - 3, 3) == "BCD" && !read.to_bcd;
    if (read.to_bcd) read.to.remove_prefix(4);
    if (read.from_bcd) read.from.remove_suffix(at == 3 ? 3 : 4);
    return read;
}

/// A decimal digit in each four bits of a bit string.
const Type* check_bcd(Checking& c, Expression*& e, const Type* source, const Type& target,
                      bool to_bcd) {
    const auto is_digits = [](const Type& type) { return type.kind == Kind::bits; };
    const auto is_number = [](const Type& type) { return type.kind == Kind::integer; };
    if (e->arguments.size() != 1)
        return c.fail(code::wrong_arguments, e->operands[0]->place,
                      "a conversion takes 1 argument");
    Expression*& value = e->arguments[0].value;
    if (!check(c, value, source)) return nullptr;
    if (source && !coerce(c, value, *source)) return nullptr;
    const Type& from = *value->type;
    const bool fits =
        to_bcd ? is_number(from) && is_digits(target) : is_digits(from) && is_number(target);
    if (!fits)
        return c.fail(code::type_does_not_fit, e->place,
                      "BCD digits are those of a bit string, of an integer",
                      "as in WORD_BCD_TO_UINT(x) and UINT_TO_BCD_WORD(x)");
    const Place place = e->place;
    e = make_converted(c, value, target);
    e->place = place;
    e->conversion.is_bcd = true;
    return &target;
}

/// The value that is converted becomes one of `source`, where that is written.
bool check_operand(Checking& c, Expression*& value, const Type* source) {
    const Type* given = check(c, value, source);
    if (!given) return false;
    const bool is_due = source ? !same_type(*given, *source) : false;
    if (given->is_any() || is_due) {
        const Type& fallback = given->is_real() ? lreal_type : lint_type;
        if (!coerce(c, value, source ? *source : fallback)) return false;
    }
    if (!source || source->kind != Kind::time || value->type == source) return true;
    value = make_copy(c, *value);  // TIME and LTIME are alike
    value->type = source;
    return true;
}

/// Between dates and times only some; in CODESYS all: each is what has passed since 1970, or since
/// midnight.
bool is_time_conversion(const Type& from, const Type& to, const Dialect& dialect) {
    return dialect.dates_count_seconds || (from.kind == Kind::moment && to.is_date()) ||
           (from.kind == Kind::date && to.kind == Kind::moment) ||
           (from.kind == Kind::clock && to.kind == Kind::time) ||
           (from.kind == Kind::time && to.kind == Kind::clock) || same_type(from, to);
}

bool is_conversion(const Type& from, const Type& to, const Dialect& dialect) {
    if (from.kind == Kind::text)
        return to.kind == Kind::text || (to.is_scalar() && to.kind != Kind::enumeration);
    if (!from.is_scalar()) return false;
    if (from.is_time() && to.is_time()) return is_time_conversion(from, to, dialect);
    return to.is_scalar() || to.kind == Kind::text;
}

/// The type that the name of a conversion has so; null: there is none. `is_told`: that was told.
const Type* find_converted(Checking& c, const Expression& e, std::string_view name, bool& is_told) {
    if (const Type* type = find_elementary(name)) return in_dialect(type, e.place);
    if (const Type* type = find_codesys_type(name)) return type;
    if (same_name(name, s5time_type.name)) return &s5time_type;
    Token named = e.token;
    named.text = name;
    is_told |= c.is_lost(named);
    const NamedType* type = c.look_up(&Names::types, named);
    return type ? type->type : nullptr;
}

/// A text for a text, a pointer and THIS of a block stay what they are. Empty: it is none of these.
std::optional<const Type*> take_unconverted(Checking& c, Expression*& e, Expression*& value,
                                            const Type& target) {
    const Type& from = *value->type;
    const bool is_text = from.kind == Kind::text && target.kind == Kind::text;
    const bool is_this = value->kind == E::self && (target.is_integer() || target.is_bits());
    if (!is_text && !is_this && !from.is_pointer()) return {};
    if (!is_text && !coerce(c, value, target)) return nullptr;
    e = value;
    if (!is_text || from.is_wide == target.is_wide) return e->type;
    recode(c, e, target);
    return &target;
}

/// What the name says is written, as a conversion of its own.
const Type* make_written(Checking& c, Expression*& e, Expression*& value, const Type& target,
                         bool truncates) {
    const Type& from = *value->type;
    const Place place = e->place;
    const Dialect& dialect = place.dialect();
    const Type& bits = from.kind == Kind::bits ? from : target;
    const bool counts = dialect.bits_count_in_reals && bits.kind == Kind::bits &&
                        (from.is_real() || target.is_real());
    const bool rounds_away = from.is_real() && !truncates && dialect.rounds_away;
    const auto become = [&](const Type& type) {
        const bool is_rounded = value->type->is_real() && (type.is_integer() || type.is_bits());
        convert(c, value, type);
        value->conversion.rounds_away = value->kind == E::converted && rounds_away && is_rounded;
    };
    if (counts) become(integer_type(bits.bits, false));
    become(target);
    e = value;
    e->place = place;
    e->conversion.is_written = true;
    e->conversion.truncates = e->kind == E::converted && truncates;
    e->conversion.has_sign = target.kind == Kind::text && from.is_integer() && from.is_signed &&
                             dialect.texts_of_integers_have_signs;
    return &target;
}

}  // namespace

bool is_conversion_name(std::string_view name) {
    const auto is_type = [](std::string_view type) {
        return find_elementary(type) || same_name(type, s5time_type.name);
    };
    const auto read = read_conversion(name);
    return read && is_type(read->to) && (read->from.empty() || is_type(read->from));
}

std::optional<const Type*> check_conversion(Checking& c, Expression*& e, std::string_view name) {
    const auto read = read_conversion(name);
    if (!read) return {};
    bool is_told = false;
    const Type* target = find_converted(c, *e, read->to, is_told);
    const Type* source = read->from.empty() ? nullptr : find_converted(c, *e, read->from, is_told);
    if (!target || (!read->from.empty() && !source))
        return is_told ? std::optional<const Type*>(nullptr) : std::nullopt;
    const bool is_function = read->truncates && read->from.empty() && target->is_real();
    if (is_function) return {};
    if (read->to_bcd || read->from_bcd) return check_bcd(c, e, source, *target, read->to_bcd);
    if (e->arguments.size() != 1)
        return c.fail(code::wrong_arguments, e->operands[0]->place,
                      fmt::format("{} takes 1 argument", read->name));
    if (!check_operand(c, e->arguments[0].value, source)) return nullptr;
    Expression* value = e->arguments[0].value;
    const bool takes_character = !source && (target->is_integer() || target->is_bits());
    if (takes_character && is_literal_character(*value)) coerce(c, value, char_type);
    const bool is_numbered = value->type->is_pointer() &&
                             (target->kind == Kind::text || target->is_real() || target->is_time());
    if (is_numbered && !coerce(c, value, ulint_type)) return nullptr;
    if (const auto type = take_unconverted(c, e, value, *target)) return *type;
    const Type& from = *value->type;
    const Dialect& dialect = value->place.dialect();
    if (!is_conversion(from, *target, dialect))
        return c.fail(
            code::type_does_not_fit, e->place,
            fmt::format("there is no conversion of {} to {}", describe(from), describe(*target)));
    const bool is_kept = (dialect.reckons_in > from.bits && from.is_integer()) ||
                         (dialect.times_count_ms && from.counts_ns != target->counts_ns);
    if (same_type(from, *target) && from.is_character == target->is_character && !is_kept) {
        e = make_copy(c, *value);
        return e->type;
    }
    if (target->kind == Kind::enumeration && !target->counted)
        return c.fail(code::not_supported, e->place,
                      fmt::format("a conversion to {}, whose values have gaps, is not supported",
                                  target->name),
                      "write a CASE");
    if (from.texts_are_names && target->kind == Kind::text && is_constant(*value))
        if (const std::string* text = from.name_of(value->constant.integer))
            return become(c, e, *target, {.text = *text});
    return make_written(c, e, value, *target, read->truncates);
}

}  // namespace lineshaft::st
