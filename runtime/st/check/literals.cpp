#include "runtime/st/syntax/literals.hpp"

#include <algorithm>
#include <chrono>

#include "runtime/source/encoding.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/types/s5.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::st {

namespace {

/// In CODESYS and TwinCAT several underlines may stand between two digits.
std::optional<Wide> read_whole_number(std::string_view text, const Dialect& dialect) {
    if (!dialect.underlines_may_repeat || text.find("__") == text.npos) return read_integer(text);
    std::string plain(text);
    for (std::size_t at = plain.find("__"); at != plain.npos; at = plain.find("__"))
        plain.erase(at, 1);
    return read_integer(plain);
}

const Type* check_number(Checking& c, Expression& e) {
    const std::string_view text = e.token.text;
    if (e.token.word == Word::real) {
        const auto value = read_real(text);
        if (!value)
            return c.fail(code::value_out_of_range, e.place,
                          fmt::format("'{}' is out of range", text));
        e.constant.real = *value;
        return &any_real_type;
    }
    const auto value = read_whole_number(text, e.place.dialect());
    if (!value)
        return c.fail(code::value_out_of_range, e.place,
                      fmt::format("'{}' is not a number of at most 64 bits", text),
                      "write 100, 1_000, 16#FF, 8#17 or 2#1010");
    e.constant.integer = *value;
    return text.find('#') == std::string_view::npos ? &any_integer_type : &any_bits_type;
}

std::optional<Wide> read_dtl(Checking& c, const Expression& e) {
    const auto value = read_moment(e.token.text);
    if (!value)
        c.fail(code::value_out_of_range, e.place, fmt::format("'{}' is not a DTL", e.place.text()),
               "write DTL#2020-02-29-12:30:15.25");
    return value;
}

const Type* check_dtl(Checking& c, Expression*& e) {
    const auto value = read_dtl(c, *e);
    if (!value) return nullptr;
    e = make_call(c, "LDT_TO_DTL", make_constant(c, *e, moment_type, {.integer = *value}));
    return check(c, e);
}

const Type* check_s5time(Checking& c, Expression& e) {
    const auto duration = read_duration(e.token.text);
    const auto word = duration ? s5time_of(*duration) : std::nullopt;
    if (!word)
        return c.fail(code::value_out_of_range, e.place,
                      fmt::format("'{}' is not an S5TIME", e.place.text()),
                      "write S5T#10ms to S5T#2h46m30s");
    e.constant.integer = *word;
    return &s5time_type;
}

/// `90-1-1` of Siemens is in 1990, `12-7-12` in 2012.
std::string with_whole_year(const Expression& e) {
    const std::string_view text = e.token.text;
    const std::size_t digits = text.find('-');
    const bool is_short = e.place.dialect().has_s7_instructions && (digits == 1 || digits == 2);
    if (!is_short) return std::string(text);
    const bool is_before_2000 = digits == 2 && text[0] == '9';
    return fmt::format("{}{}{}", is_before_2000 ? "19" : "20", digits == 1 ? "0" : "", text);
}

const Type* check_time(Checking& c, Expression*& slot) {
    Expression& e = *slot;
    const std::string_view prefix = e.place.text().substr(0, e.place.text().find('#'));
    if (const Type* type = find_prefix(prefix); type && type->is_date()) {
        const auto value = read_time(with_whole_year(e), type->kind);
        if (!value)
            return c.fail(code::value_out_of_range, e.place,
                          fmt::format("'{}' is not a {}", e.place.text(), type->name),
                          "write D#2020-02-29, TOD#12:30:15.25 or DT#2020-02-29-12:30:15");
        const bool is_whole = e.place.dialect().dates_count_seconds && !type->counts_ns;
        const Wide unit = !is_whole ? 1 : type->kind == Kind::clock ? 1'000'000 : 1'000'000'000;
        e.constant.integer = *value / unit * unit;
        return type;
    }
    if (same_name(prefix, "dtl")) return check_dtl(c, slot);
    const Dialect& dialect = e.place.dialect();
    if (dialect.has_s7_instructions && lower(prefix).starts_with("s5")) return check_s5time(c, e);
    const bool is_long = same_name(prefix.substr(0, 1), "l"),
               has_no_sign = dialect.is_loose && is_long;
    const auto value = read_duration(e.token.text, has_no_sign);
    if (!value)
        return c.fail(code::value_out_of_range, e.place,
                      fmt::format("'{}' is not a time", e.place.text()),
                      "write T#1h2m3.5s, with d, h, m, s, ms, us and ns in this order");
    e.constant.integer = wrapped(is_long ? long_time_type(e.place) : ltime_type, *value);
    if (!dialect.times_count_ms) return &time_type;
    const Wide kept = is_long ? *value : in_whole_ms(*value, dialect);
    if (dialect.refuses_finer_times && !is_long && kept != *value)
        return c.fail(code::value_out_of_range, e.place,
                      fmt::format("'{}' is not a TIME", e.place.text()),
                      "that is whole ms from T#-24d20h31m23s648ms to T#24d20h31m23s647ms; write "
                      "LT#...");
    if (!is_long) e.constant.integer = kept;
    return is_long ? &long_time_type(e.place) : &time_type;
}

/// Up to its first $00, which ends a text in CODESYS and Automation Studio.
void end_at_zero(std::string& text, const Dialect& dialect) {
    if (dialect.texts_end_at_zero) text.resize(std::min(text.find('\0'), text.size()));
}

/// What stands in quotes, in bytes as the dialect has them. What has none is told.
std::string written_text(Checking& c, const Expression& e) {
    if (!e.place.dialect().texts_are_windows_1252) return std::string(e.token.text);
    std::string bytes = in_windows_1252(e.token.text);
    if (std::ranges::count(bytes, '?') != std::ranges::count(e.token.text, '?'))
        c.warn(
            code::value_out_of_range, e.place,
            "a STRING has bytes of Windows-1252 here, and a character that is none of them is '?'",
            "a WSTRING has it: write \"...\"");
    return bytes;
}

const Type* check_text(Checking& c, Expression& e) {
    const bool is_wide = e.token.quoted && has_wide_texts(e.place);
    auto text = read_text(is_wide ? std::string(e.token.text) : written_text(c, e), e.token.quoted);
    if (!text)
        return c.fail(code::value_out_of_range, e.place,
                      "'$' is not followed by one of its characters",
                      "write $$ for a '$', $' for a quote, $N for a new line, $0A for a byte");
    if (static_cast<Wide>(text->size()) > longest_text)
        return c.fail(code::value_out_of_range, e.place,
                      fmt::format("the text has {} bytes", text->size()),
                      "a text has at most 32767 bytes");
    end_at_zero(*text, e.place.dialect());
    e.constant.text = is_wide ? text_of_units(units_of(*text)) : *text;
    return is_wide ? &wide_string_type : &string_type;
}

}  // namespace

std::optional<const Type*> check_place_call(Checking& c, Expression*& e) {
    const std::string_view name = e->operands[0]->token.text;
    const bool is_pou = same_name(name, "__pouname");
    if ((!is_pou && !same_name(name, "__position")) || !e->arguments.empty()) return {};
    const Mark mark = e->place.mark();
    const std::string text = !is_pou     ? fmt::format("Line {}, Column {}", mark.line, mark.column)
                             : c.routine ? c.routine->name
                                         : std::string();
    return become(c, e, string_type, {.text = text});
}

const Type* check_literal(Checking& c, Expression*& e) {
    switch (e->token.word) {
        case Word::integer:
        case Word::real:
            return check_number(c, *e);
        case Word::duration:
            return check_time(c, e);
        case Word::text:
            return check_text(c, *e);
        default:
            return nullptr;
    }
}

/// `C#25`, which is 16#25.
static const Type* check_count(Checking& c, Expression*& e) {
    Expression*& value = e->operands[0];
    if (!check(c, value)) return nullptr;
    const auto digits = is_constant(*value) && value->type->is_integer()
                            ? three_digits(value->constant.integer)
                            : std::nullopt;
    if (!digits)
        return c.fail(code::value_out_of_range, e->place,
                      fmt::format("'{}' is no count", e->place.text()), "write C#0 to C#999");
    return become(c, e, bits_type(16), {.integer = *digits});
}

const Type* check_typed(Checking& c, Expression*& e) {
    Expression*& value = e->operands[0];
    const Token& name = e->token;
    const Type* type = in_dialect(find_prefix(name.text), name.place);
    if (NamedType* named = c.look_up(&Names::types, name)) {
        type = resolve_declared(c, *named);
        if (!type) return nullptr;
        c.note(name.place, *named);
    }
    if (!type && same_name(name.text, "c") && name.place.dialect().has_s7_instructions)
        return check_count(c, e);
    if (!type && resolve_name(c, name))
        return c.fail(code::not_declared, name.place,
                      fmt::format("'{}' is not a type of values", name.text),
                      "write a type, as in INT#5");
    if (!type) return nullptr;
    if (type->has_values() && value->kind == E::name) return check_value(c, e, *type, value->token);
    if (!check(c, value, type) || !coerce(c, value, *type)) return nullptr;
    if (!is_constant(*value))
        return c.fail(code::not_a_constant, value->place,
                      fmt::format("a number is due after '{}#'", name.text));
    return become(c, e, *type, value->constant);
}

Expression* list_of_dtl(Checking& c, const Expression& literal, const Type& type) {
    const auto value = read_dtl(c, literal);
    if (!value) return nullptr;
    using namespace std::chrono;
    const sys_time<nanoseconds> moment(nanoseconds(static_cast<std::int64_t>(*value)));
    const auto day = floor<days>(moment);
    const year_month_day date(day);
    const hh_mm_ss clock(moment - day);
    const Wide parts[] = {int{date.year()},        unsigned{date.month()},
                          unsigned{date.day()},    weekday(day).c_encoding() + 1,
                          clock.hours().count(),   clock.minutes().count(),
                          clock.seconds().count(), clock.subseconds().count()};
    Expression* list = make(c, E::list, literal);
    for (std::size_t i = 0; i < type.members.size(); ++i) {
        Expression* part = make_constant(c, literal, *type.members[i]->type, {.integer = parts[i]});
        list->arguments.push_back({.name = type.members[i]->name, .value = part});
    }
    return list;
}

}  // namespace lineshaft::st
