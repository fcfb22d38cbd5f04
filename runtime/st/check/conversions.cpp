#include "runtime/st/check/conversions.hpp"

#include <cmath>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/implicit_checks.hpp"
#include "runtime/st/check/mixed_signs.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/s5.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/syntax/literals.hpp"

namespace lineshaft::st {

bool fits_as_constant(const Expression& e, const Type& to) {
    return is_constant(e) && e.type->is_integer() && to.is_integer() &&
           e.constant.integer >= smallest(to) && e.constant.integer <= largest(to);
}

bool are_same_pattern(const Type& given, const Type& to) {
    const Type& from = given.plain();
    const bool is_one = from.kind == Kind::integer && !from.is_signed && to.kind == Kind::bits;
    return is_one && from.bits <= to.bits;
}

namespace {

/// A bit string stands for an integer of its width or a wider one, and the other way.
bool is_same_pattern(const Type& from, const Type& to) {
    const bool mixes = (from.kind == Kind::bits && to.kind == Kind::integer) ||
                       (from.kind == Kind::integer && to.kind == Kind::bits);
    return mixes && from.bits <= to.bits && !to.is_subrange;
}

bool is_time_of_number(const Type& from, const Type& to) {
    const auto is = [](const Type& number, const Type& time) {
        return number.kind == Kind::integer && number.bits == 32 && !number.is_subrange &&
               time.kind == Kind::time && !time.counts_ns;
    };
    return is(from, to) || is(to, from);
}

/// What TIA Portal converts by itself where a block's IEC check is off: numbers, and bit strings as
/// integers or as the pattern of a real number of their width; times of their width likewise.
bool converts_unchecked(const Expression& e, const Type& to) {
    const Type& from = e.type->plain();
    const auto is_whole = [](const Type& type) {
        return type.kind == Kind::integer || type.kind == Kind::bits;
    };
    const Dialect& dialect = e.place.dialect();
    if (!dialect.packs_as_s7 || to.is_subrange) return false;
    if (is_pattern_of_time(from, to, dialect)) return true;
    if (is_constant(e)) return false;
    if (is_whole(from) && is_whole(to)) return true;
    const bool are_numbers = from.is_number() && to.is_number();
    const bool are_patterns = (from.kind == Kind::bits && to.kind == Kind::real) ||
                              (from.kind == Kind::real && to.kind == Kind::bits);
    return are_numbers || (are_patterns && from.bits == to.bits);
}

void warn_of_check(Checking& c, const Expression& e, const Type& to) {
    const std::string& from = e.type->plain().name;
    c.warn(
        code::conversion_may_lose, e.place,
        fmt::format("{} does not hold every {}", describe(to), from),
        fmt::format("TIA Portal takes it where the block's IEC check is off; write {}_TO_{}(...)",
                    from, to.name));
}

/// A CHAR takes that of a STRING, a WCHAR that of a WSTRING.
bool is_first_character(const Expression& e, const Type& to) {
    const Type& from = *e.type;
    return e.place.dialect().packs_as_s7 && from.kind == Kind::text && to.is_character &&
           from.is_wide == (to.bits == 16) && !is_constant(e);
}

/// A REAL loses of a DINT what is above 2^24, and rounds an LREAL; both round an integer of 64
/// bits. An integer takes one of its width or less with another sign.
bool rounds(Checking& c, const Expression& e, const Type& to) {
    const Type& from = e.type->plain();
    const Dialect& dialect = e.place.dialect();
    const bool of_dint = from.kind == Kind::integer && from.bits == 32 && is_single(to);
    const bool of_long =
        from.kind == Kind::integer && to.kind == Kind::real && takes_long_numbers(e, from);
    const bool is_real = from.kind == Kind::real && is_single(to);
    const bool changes_sign = from.kind == Kind::integer && to.kind == Kind::integer &&
                              from.bits <= to.bits && from.is_signed != to.is_signed &&
                              !to.is_subrange && (dialect.is_loose || !is_constant(e));
    const bool mixes_signs = dialect.takes_what_others_refuse && narrows_mixed_signs(e, from, to);
    if (!(dialect.dint_becomes_real && of_dint) && !(dialect.lreal_becomes_real && is_real) &&
        !of_long && !changes_sign && !mixes_signs) {
        const bool is_unchecked = converts_unchecked(e, to);
        if (is_unchecked) warn_of_check(c, e, to);
        return is_unchecked;
    }
    const bool is_told = changes_sign && mixes_signs && from.bits >= 32 &&
                         dialect.reckons_in_registers;  // of its operands
    if (!is_told) warn_of_loss(c, e, to);
    return true;
}

/// `positive` and `ramp_in` of SoftMotion are mcPositiveDirection and mcRampIn of the catalogue:
/// all of its words, or the first of them. PLCopen's are called as the catalogue's.
bool is_short_for(std::string_view name, std::string_view value) {
    if (same_name(name, value)) return true;
    if (!value.starts_with("mc")) return false;
    value.remove_prefix(2);
    const std::size_t length = value.size();
    for (const char letter : name) {
        if (letter == '_') continue;
        if (value.empty() || lower(letter) != lower(value.front())) return false;
        value.remove_prefix(1);
    }
    return value.size() < length && (value.empty() || lower(value.front()) != value.front());
}

/// A value of the names that a vendor has for the catalogue's: a constant by its name, any where
/// all of them stand in the same order. False where it is none.
bool coerce_to_catalog(Checking& c, Expression*& e, const Type& to) {
    const Type& from = *e->type;
    const bool are_both = from.has_numbers && to.kind == Kind::enumeration && !to.has_numbers;
    if (!are_both) return false;
    if (is_constant(*e)) {
        const std::string* name = from.name_of(e->constant.integer);
        const auto is_meant = [&](auto& value) { return name && is_short_for(*name, value); };
        const auto it = std::ranges::find_if(to.values, is_meant);
        return std::ranges::count_if(to.values, is_meant) == 1 &&
               become(c, e, to, {.integer = it - to.values.begin()});
    }
    const bool is_same_list =
        from.values.size() <= to.values.size() && has_table_for(from) &&
        std::equal(from.values.begin(), from.values.end(), to.values.begin(), is_short_for);
    return is_same_list && convert(c, e, to);
}

/// The one structure is the other's base, or a base of that.
bool is_of_base(const Type& from, const Type& to) {
    const Type* base = from.kind == Kind::structure ? from.base : nullptr;
    return base && to.kind == Kind::structure && (same_type(*base, to) || is_of_base(*base, to));
}

/// A variable hides the value of its name.
bool refuse_hidden_value(Checking& c, const Expression& e, const Type& to) {
    const auto value = std::ranges::find_if(
        to.values, [&](const std::string& text) { return same_name(text, e.place.text()); });
    if (to.kind != Kind::enumeration || value == to.values.end()) return false;
    c.fail(code::type_does_not_fit, e.place,
           fmt::format("'{}' is a variable here, a {}, and no value of {}", e.place.text(),
                       describe(*e.type), describe(to)),
           fmt::format("write {}#{}", to.name, *value));
    return true;
}

bool refuse_conversion(Checking& c, const Expression& e, const Type& to) {
    const Type& from = *e.type;
    if (refuse_hidden_value(c, e, to)) return false;
    const bool of_literal = from.kind == Kind::any_real;
    if (of_literal && !to.is_real() && to.is_number())
        return c.fail(code::conversion_may_lose, e.place,
                      fmt::format("expected {}, found a real number", describe(to)),
                      "write a whole number, or convert it: ROUND(...)");
    if ((from.is_number() || from.is_bits()) && (to.is_number() || to.is_bits())) {
        const bool counts =
            from.kind == Kind::bits && to.is_real();  // DWORD_TO_REAL keeps the bits
        const std::string source = from.is_any() ? "LINT"
                                   : counts      ? integer_type(from.bits, false).name
                                                 : from.plain().name;
        return c.fail(
            code::conversion_may_lose, e.place,
            fmt::format("{} does not hold every {}", describe(to), from.name),
            fmt::format("write {}_TO_{}(...) where it is meant", source, to.plain().name));
    }
    std::string help;
    if (to.kind == Kind::time && from.is_number())
        help = from.is_any() ? "write a time with its unit: T#500ms"
                             : fmt::format("write {}_TO_TIME(...), of {}", from.plain().name,
                                           e.place.dialect().functions_are_in_c ? "s" : "ms");
    if (to.kind == Kind::structure && describe(to) == describe(from))
        help = "declare a TYPE, and both variables of that";
    if (to.is_character && from.kind == Kind::text) help = "a CHAR is one character: 'A'";
    if (to.kind == Kind::boolean && from.is_number()) help = "compare it, as in 'x <> 0'";
    if (to.kind == Kind::enumeration && !to.values.empty())
        help = fmt::format("write one of its values, such as {}", first_value(c, to));
    if (from.kind == Kind::time && to.is_number())
        help = fmt::format("write TIME_TO_{}(...)", to.is_any() ? "LREAL" : to.plain().name);
    if (from.kind == Kind::enumeration && to.kind == Kind::integer)
        help = fmt::format("write TO_{}(...)", to.plain().name);
    return c.fail(code::type_does_not_fit, e.place,
                  fmt::format("expected {}, found {}", describe(to), describe(from)), help);
}

/// What the other integer of its width holds: -1 of a USINT, in CODESYS 40000 of an INT, too, and
/// -1 of a BYTE.
bool wraps(const Type& to, Wide value, const Dialect& dialect) {
    const Wide pattern = Wide{1} << to.bits;
    if (value < 0)
        return -value <= pattern / 2 && !to.is_signed &&
               (to.kind == Kind::integer ? dialect.is_loose : dialect.literals_wrap);
    return dialect.literals_wrap && to.kind == Kind::integer && to.is_signed &&
           value > largest(to) && value < pattern;
}

/// `timer.PT := 500;` of B&R, whose TIME is a DINT.
bool counts_ms(const Expression& e, const Type& to) {
    return to.kind == Kind::time && e.type->kind == Kind::any_integer &&
           e.constant.integer >= smallest(dint_type) && e.constant.integer <= largest(dint_type) &&
           e.place.dialect().times_take_numbers;
}

bool coerce_constant(Checking& c, Expression*& e, const Type& to) {
    const Type& from = *e->type;
    const Wide value = e->constant.integer;
    const bool whole = from.kind == Kind::any_integer || from.kind == Kind::any_bits;
    if (to.is_real() && (whole || from.kind == Kind::any_real)) {
        double real = as_real(*e);
        if (to.kind == Kind::real && to.bits == 32) real = static_cast<float>(real);
        if (!std::isfinite(real))
            return c.fail(code::value_out_of_range, e->place,
                          fmt::format("'{}' is out of range for {}", e->place.text(), to.name));
        return take_type(c, e, to, {.real = real});
    }
    if (!whole) return refuse_conversion(c, *e, to);
    const bool bit = to.kind == Kind::boolean && (value == 0 || value == 1);
    const bool no_time = value == 0 && (to.kind == Kind::time ||
                                        (to.is_date() && e->place.dialect().seconds_move_moments));
    if (to.is_any() || bit || no_time) return take_type(c, e, to, e->constant);
    if (counts_ms(*e, to)) return take_type(c, e, to, {.integer = value * 1'000'000});
    if (to.kind != Kind::integer && to.kind != Kind::bits) return refuse_conversion(c, *e, to);
    const Wide pattern = Wide{1} << to.bits;
    const bool is_wrapped =
        from.kind == Kind::any_integer && !to.is_subrange && wraps(to, value, e->place.dialect());
    if (is_wrapped)
        c.warn(code::conversion_may_lose, e->place,
               value < 0
                   ? fmt::format("{} has no negative numbers", to.name)
                   : fmt::format("{} has no number above {}", to.name, to_string(largest(to))),
               fmt::format("write {}, which is the same bits", to_string(wrapped(to, value))));
    const bool is_pattern =
        is_wrapped || (from.kind == Kind::any_bits && value < pattern && !to.is_subrange);
    if (!is_pattern && (value < smallest(to) || value > largest(to)))
        return c.fail(
            code::value_out_of_range, e->place,
            fmt::format("{} is out of range for {}", to_string(value), describe(to)),
            fmt::format("it goes from {} to {}", to_string(smallest(to)), to_string(largest(to))));
    return take_type(c, e, to, {.integer = is_pattern ? wrapped(to, value) : value});
}

bool fold_conversion(Checking& c, Expression*& e, const Type& to) {
    const Type& from = *e->type;
    if (from.kind == Kind::text || to.kind == Kind::text) return false;
    if (from.kind == Kind::enumeration) {
        if ((!to.is_integer() && !to.is_bits()) || to.is_subrange) return false;
        return become(c, e, to, {.integer = wrapped(to, e->constant.integer)});
    }
    const bool keeps_bits = to.is_real() && from.is_bits();
    if (keeps_bits || from.is_date() || to.is_date()) return false;
    if ((from.kind == Kind::time) != (to.kind == Kind::time)) return false;
    if (to.is_real()) {
        double value = as_real(*e);
        if (to.bits == 32)
            value = from.is_real() ? static_cast<float>(value)
                                   : static_cast<float>(e->constant.integer);
        return become(c, e, to, {.real = value});
    }
    if (from.is_real() || to.kind == Kind::enumeration) return false;
    const bool is_cut = to.kind == Kind::time && !to.counts_ns && from.counts_ns &&
                        e->place.dialect().times_count_ms;
    const Wide given =
        is_cut ? in_whole_ms(e->constant.integer, e->place.dialect()) : e->constant.integer;
    const bool is_odd = given % 2 != 0, takes_lowest = e->place.dialect().truth_is_lowest_bit;
    const Wide value = to.kind == Kind::boolean ? Wide{takes_lowest ? is_odd : given != 0}
                                                : wrapped(to.plain(), given);
    return become(c, e, to, {.integer = value});
}

/// `0` is none.
bool coerce_instance(Checking& c, Expression*& e, const Type& to) {
    const Type& from = *e->type;
    if (is_constant(*e) && from.is_any() && e->constant.integer == 0) return become(c, e, to, {});
    const bool has_methods = from.kind == Kind::block || from.kind == Kind::interface;
    if (has_methods && is_a(*from.routine, *to.routine)) {
        note_held_instance(c, *e);
        return become_converted(c, e, to);
    }
    if (has_methods && from.routine->has_unknown_base) return false;
    return c.fail(code::type_does_not_fit, e->place,
                  fmt::format("expected {}, found {}", describe(to), describe(from)),
                  has_methods ? fmt::format("{} does not implement it", describe(from))
                              : "assign an instance of a block that implements it");
}

}  // namespace

void warn_of_loss(Checking& c, const Expression& e, const Type& to) {
    const std::string& from = e.type->plain().name;
    c.warn(code::conversion_may_lose, e.place,
           fmt::format("{} does not hold every {}", describe(to), from),
           fmt::format("write {}_TO_{}(...) where it is meant", from, to.name));
}

bool is_single(const Type& type) {
    return type.kind == Kind::real && type.bits == 32;
}

bool makes_lreal_of_literals(const Place& place, const Type* expected) {
    if (expected && expected->plain().kind == Kind::real) return !is_single(expected->plain());
    return place.dialect().real_literals_are_lreal;
}

/// What the text is as a CHAR or a WCHAR; empty: it is not one of these.
static std::optional<Wide> only_character(const std::string& text, const Type& type) {
    if (type.bits == 16) {
        const std::u16string units = units_of(text);
        return units.size() == 1 ? std::optional<Wide>(units[0]) : std::nullopt;
    }
    return text.size() == 1 ? std::optional<Wide>(static_cast<unsigned char>(text[0]))
                            : std::nullopt;
}

bool is_literal_character(const Expression& e) {
    return e.place.dialect().literals_are_characters && is_constant(e) && !e.variable &&
           e.type->kind == Kind::text && !e.type->is_wide && e.constant.text.size() == 1;
}

bool takes_long_numbers(const Expression& e, const Type& from) {
    return e.place.dialect().long_numbers_become_real && from.kind == Kind::integer &&
           from.bits == 64;
}

bool counts_bits(const Type& from, const Type& to, const Place& place) {
    return place.dialect().bits_count_in_reals && from.kind == Kind::bits && to.is_real();
}

static const Type* count_bits(Checking& c, Expression*& e, const Type& to) {
    const int bits = e->type->bits;
    if (bits >= to.bits && !is_constant(*e)) warn_of_loss(c, *e, to);
    convert(c, e, integer_type(bits, false));
    return convert(c, e, to);
}

/// In SCL a DT, an LDT and a DTL become one another.
static bool coerce_dtl(Checking& c, Expression*& e, const Type& to) {
    if (!e->place.dialect().has_s7_instructions) return false;
    const bool is_made = e->type->kind == Kind::moment && is_dtl(to),
               is_read = is_dtl(*e->type) && to.kind == Kind::moment;
    if (!is_made && !is_read) return false;
    e = make_call(c, is_made ? "LDT_TO_DTL" : "DTL_TO_LDT", e);
    return check(c, e);
}

bool may_become(Checking& c, const Expression& e, const Type& to) {
    return is_same_pattern(e.type->plain(), to) || rounds(c, e, to);
}

void recode(Checking& c, Expression*& e, const Type& to) {
    if (!is_constant(*e)) {
        become_converted(c, e, to);
        return;
    }
    const std::string& text = e->constant.text;
    const bool has_bytes = e->place.dialect().texts_are_windows_1252;
    become(c, e, to, {.text = !has_bytes ? text : to.is_wide ? widened(text) : narrowed(text)});
}

bool coerce(Checking& c, Expression*& e, const Type& to) {
    if (!e->type) return false;
    if (coerce_dtl(c, e, to) || coerce_s5time(c, e, to)) return true;
    if (coerce_enumeration(c, e, to) || coerce_to_catalog(c, e, to)) return true;
    const bool may_point = e->kind == E::self && (to.is_integer() || to.is_bits());
    if (to.is_reference() || e->type->is_reference() || may_point)
        return coerce_reference(c, e, to);
    const Type& from = *e->type;
    if (from.kind == Kind::text && to.kind == Kind::text) {
        if (from.is_wide != to.is_wide && e->place.dialect().texts_are_windows_1252)
            recode(c, e, from.is_wide ? string_type : wide_string_type);
        const std::string& text = e->constant.text;
        if (is_constant(*e) && kept_bytes(text, to.room()) < text.size())
            c.warn(code::value_out_of_range, e->place,
                   fmt::format("the text has {} {}, and {} keeps {}",
                               to.is_wide ? count_units(text) : text.size(),
                               to.is_wide ? "characters" : "bytes", describe(to), to.length),
                   "declare the STRING longer");
        return true;
    }
    if (&from == &to || same_type(from, to)) return true;
    if (to.kind == Kind::interface) return coerce_instance(c, e, to);
    if (!to.of_number.empty() && from.is_integer() && e->place.dialect().numbers_stand_for_names)
        return coerce_number(c, e, to);
    if (from.is_any()) return coerce_constant(c, e, to);
    if (from.is_object() && to.kind == Kind::handle && from.standard == to.standard)
        return convert(c, e, to);
    if (to.is_character && is_constant(*e) && from.kind == Kind::text)
        if (const auto only = only_character(e->constant.text, to))
            return become(c, e, to, {.integer = *only});
    if (from.is_character && to.kind == Kind::text) return convert(c, e, to);
    if (is_first_character(*e, to)) return warn_of_check(c, *e, to), convert(c, e, to);
    const bool are_alike = from.kind == Kind::array && to.kind == Kind::array &&
                           from.count() == to.count() && same_type(*from.element, *to.element);
    if ((are_alike && e->place.dialect().is_loose) || has_same_form(c, e->place, from, to))
        return true;
    if (to.is_subrange && from.is_scalar() &&
        (widens(from, to) || is_same_pattern(from, to.plain()))) {
        if (is_constant(*e) &&
            (e->constant.integer < smallest(to) || e->constant.integer > largest(to)))
            return c.fail(code::value_out_of_range, e->place,
                          fmt::format("{} is out of range for {}", to_string(e->constant.integer),
                                      describe(to)));
        guard_range(c, e, to);
        return convert(c, e, to);
    }
    if (from.kind == Kind::enumeration && to.kind == Kind::enumeration && from.name == to.name &&
        from.values == to.values && from.numbers == to.numbers)
        return true;
    if (is_of_base(from, to) && become_base(c, e, to)) return true;
    if (fits_as_constant(*e, to)) return become(c, e, to, {.integer = e->constant.integer});
    if (counts_bits(from, to, e->place)) return count_bits(c, e, to);
    const bool is_time = e->place.dialect().dint_is_time && is_time_of_number(from.plain(), to);
    const bool is_truth = from.kind == Kind::boolean && e->place.dialect().bool_is_number &&
                          (to.kind == Kind::integer || to.kind == Kind::bits) && !to.is_subrange;
    const bool fits = from.is_scalar() && (is_time || is_truth || widens(from, to) ||
                                           is_same_pattern(from, to) || rounds(c, *e, to));
    if (!fits) return refuse_conversion(c, *e, to);
    return convert(c, e, to);
}

Wide in_whole_ms(Wide nanoseconds, const Dialect& dialect) {
    constexpr Wide ms = 1'000'000;
    return wrapped(integer_type(32, dialect.times_have_signs), nanoseconds / ms) * ms;
}

bool is_cut_to_ms(const Expression& target, const Type& from) {
    const Type& to = *target.type;
    const bool is_of_standard = target.kind == E::member && target.operands[0]->type &&
                                target.operands[0]->type->kind == Kind::standard;
    return from.kind == to.kind && from.is_time() && from.counts_ns && !to.counts_ns &&
           target.place.dialect().times_have_signs && !target.place.source->is_prelude() &&
           !is_of_standard;
}

const Type* convert(Checking& c, Expression*& e, const Type& to) {
    if (is_constant(*e) && fold_conversion(c, e, to)) return &to;
    return become_converted(c, e, to);
}

void enumeration_becomes_number(Checking& c, Expression*& e) {
    if (e->type->has_numbers) convert(c, e, e->type->base->plain());
}

void take_width(Checking& c, Expression*& e, const Type* expected) {
    if (e->type->kind == Kind::any_bits && expected && expected->kind == Kind::bits)
        coerce(c, e, *expected);
}

void become_number(Checking& c, Expression*& e) {
    const Type& type = e->type->plain();
    if (type.kind == Kind::bits) convert(c, e, integer_type(type.bits, false));
}

void become_lint(Checking& c, Expression*& e) {
    if (e->type->is_any())
        coerce(c, e, lint_type);
    else
        convert(c, e, lint_type);
}

const Type* convert_result(Checking& c, Expression*& e, const Type& from, const Type& to) {
    e->type = &from;
    if (&from != &to) convert(c, e, to);
    return &to;
}

}  // namespace lineshaft::st
