#include "runtime/st/types/elementary.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "runtime/st/syntax/words.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;

Type elementary(Kind kind, std::string name, int bits = 64, bool is_signed = false) {
    Type type;
    type.kind = kind;
    type.name = std::move(name);
    type.bits = bits;
    type.is_signed = is_signed;
    return type;
}

Type character(const char* name, int bits) {
    Type type = elementary(Kind::bits, name, bits);
    type.is_character = true;
    return type;
}

Type long_time(Kind kind, const char* name, bool is_signed = true) {
    Type type = elementary(kind, name, 64, is_signed);
    type.counts_ns = true;
    return type;
}

Type text_type(std::uint32_t length, bool is_open = false, bool is_wide = false) {
    Type type = elementary(Kind::text, is_wide ? "WSTRING" : "STRING");
    type.is_wide = is_wide;
    type.length = length;
    type.slots = 0;
    type.is_open = is_open;
    return type;
}

const Type table[] = {elementary(Kind::boolean, "BOOL", 1),
                      elementary(Kind::integer, "SINT", 8, true),
                      elementary(Kind::integer, "INT", 16, true),
                      elementary(Kind::integer, "DINT", 32, true),
                      elementary(Kind::integer, "LINT", 64, true),
                      elementary(Kind::integer, "USINT", 8),
                      elementary(Kind::integer, "UINT", 16),
                      elementary(Kind::integer, "UDINT", 32),
                      elementary(Kind::integer, "ULINT", 64),
                      elementary(Kind::bits, "BYTE", 8),
                      elementary(Kind::bits, "WORD", 16),
                      elementary(Kind::bits, "DWORD", 32),
                      elementary(Kind::bits, "LWORD", 64),
                      elementary(Kind::real, "REAL", 32),
                      elementary(Kind::real, "LREAL", 64),
                      elementary(Kind::time, "TIME", 64, true),
                      long_time(Kind::time, "LTIME"),
                      text_type(scl.text_length),
                      elementary(Kind::date, "DATE", 64, true),
                      long_time(Kind::date, "LDATE"),
                      elementary(Kind::clock, "TOD", 64, true),
                      elementary(Kind::clock, "TIME_OF_DAY", 64, true),
                      long_time(Kind::clock, "LTOD"),
                      long_time(Kind::clock, "LTIME_OF_DAY"),
                      elementary(Kind::moment, "DT", 64, true),
                      elementary(Kind::moment, "DATE_AND_TIME", 64, true),
                      long_time(Kind::moment, "LDT"),
                      long_time(Kind::moment, "LDATE_AND_TIME"),
                      character("CHAR", 8)};
static_assert(std::size(table) == std::size(elementary_names));

Type null_reference() {
    Type type = elementary(Kind::reference, "NULL");
    type.slots = 3;
    return type;
}

/// Follows references to references, as far as anybody would write them.
bool refer_to_the_same(const Type* a, const Type* b) {
    for (int hops = 0; hops < 64; ++hops) {
        if (a == b) return true;
        if (!a || !b || !a->is_reference() || !b->is_reference()) break;
        if (a->referring != b->referring || a->is_open != b->is_open ||
            a->dimensions != b->dimensions)
            return false;
        a = a->element;
        b = b->element;
    }
    return a && b && !a->is_reference() && same_type(*a, *b);
}

const Type open_string = text_type(scl.text_length, true);
const Type open_wide_string = text_type(scl.text_length, true, true);
const Type wide_string = text_type(scl.text_length, false, true);
const Type wide_character = character("WCHAR", 16);
const Type unsigned_ltime = long_time(Kind::time, "LTIME", false);
const Type any_integer = elementary(Kind::any_integer, "a whole number", 64, true);
const Type any_real = elementary(Kind::any_real, "a real number");
const Type any_bits = elementary(Kind::any_bits, "a whole number");

}  // namespace

const Type null_type = null_reference();

const Type &bool_type = table[0], &int_type = table[2], &dint_type = table[3],
           &lint_type = table[4], &ulint_type = table[8], &real_type = table[13],
           &lreal_type = table[14], &time_type = table[15], &ltime_type = table[16],
           &date_type = table[18], &clock_type = table[20], &moment_type = table[24],
           &any_integer_type = any_integer, &any_real_type = any_real, &any_bits_type = any_bits,
           &string_type = table[17], &open_string_type = open_string, &char_type = table[28],
           &wide_string_type = wide_string, &open_wide_string_type = open_wide_string,
           &wide_char_type = wide_character, &unsigned_ltime_type = unsigned_ltime;

const Type* find_codesys_type(std::string_view name) {
    static const Type bit = [] {
        Type made = elementary(Type::Kind::boolean, "BIT", 1);
        made.is_one_bit = true;
        return made;
    }();
    if (same_name(name, bit.name)) return &bit;
    return same_name(name, "__xword")   ? &bits_type(64)
           : same_name(name, "__uxint") ? &ulint_type
           : same_name(name, "__xint")  ? &lint_type
                                        : nullptr;
}

std::string describe(const Type& type) {
    if (type.is_open_array())
        return fmt::format("ARRAY[{}] OF {}", fmt::join(std::vector(type.dimensions, '*'), ", "),
                           type.element ? describe(*type.element) : "?");
    if (type.is_reference() && type.name.empty()) {
        static constexpr std::string_view words[] = {"REFERENCE TO", "REF_TO", "POINTER TO"};
        return fmt::format("{} {}", words[static_cast<std::size_t>(type.referring)],
                           type.element ? describe(*type.element) : "?");
    }
    if (type.kind != Kind::array || !type.name.empty()) return type.name;
    std::string bounds;
    const Type* element = &type;
    for (; element && element->kind == Kind::array && element->name.empty();
         element = element->element)
        bounds +=
            fmt::format("{}{}..{}", bounds.empty() ? "" : ", ", element->lower, element->upper);
    return fmt::format("ARRAY[{}] OF {}", bounds, element ? describe(*element) : "?");
}

const Type* find_prefix(std::string_view name) {
    static constexpr std::pair<std::string_view, std::string_view> shorter[] = {
        {"b", "byte"}, {"w", "word"}, {"dw", "dword"}, {"lw", "lword"},
        {"l", "dint"}, {"d", "date"}, {"ld", "ldate"}};
    const auto* found = find_called(shorter, name, [](const auto& row) { return row.first; });
    return find_elementary(found ? found->second : name);
}

const Type* find_elementary(std::string_view name) {
    if (same_name(name, "wstring")) return &wide_string_type;
    if (same_name(name, "wchar")) return &wide_char_type;
    return find_called(table, name, &Type::name);
}

const Type& unsized_string(const Dialect& dialect) {
    static const Type shorter[] = {text_type(codesys.text_length), text_type(matiec.text_length)};
    const auto* type = std::ranges::find(shorter, dialect.text_length, &Type::length);
    return type == std::end(shorter) ? string_type : *type;
}

const Type& unsized_wide_string(const Place& place) {
    static const Type shorter[] = {text_type(codesys.text_length, false, true),
                                   text_type(matiec.text_length, false, true)};
    if (!has_wide_texts(place)) return unsized_string(place.dialect());
    const auto* type = std::ranges::find(shorter, place.dialect().text_length, &Type::length);
    return type == std::end(shorter) ? wide_string_type : *type;
}

bool has_wide_texts(const Place& place) {
    return !place.dialect().packs_as_s7;
}

const Type& integer_type(int bits, bool is_signed) {
    return *std::ranges::find_if(table, [&](const Type& type) {
        return type.kind == Kind::integer && type.bits == bits && type.is_signed == is_signed;
    });
}

const Type& bits_type(int bits) {
    return *std::ranges::find_if(
        table, [&](const Type& type) { return type.kind == Kind::bits && type.bits == bits; });
}

bool widens(const Type& given_from, const Type& given_to) {
    const Type &from = given_from.plain(), &to = given_to.plain();
    if (same_type(from, to)) return true;
    if (from.kind == Kind::integer && to.kind == Kind::integer)
        return from.bits < to.bits && (to.is_signed || !from.is_signed);
    if (from.kind == Kind::integer && to.kind == Kind::real)
        return from.bits <= (to.bits == 32 ? 16 : 32);
    if (from.kind == Kind::boolean) return to.kind == Kind::bits;
    if (from.is_code) return (to.kind == Kind::integer || to.kind == Kind::bits) && to.bits >= 16;
    return from.kind == to.kind && (from.kind == Kind::real || from.kind == Kind::bits) &&
           from.bits < to.bits;
}

const Type* common_type(const Type& given_a, const Type& given_b) {
    const Type &a = given_a.plain(), &b = given_b.plain();
    if (widens(a, b)) return &b;
    if (widens(b, a)) return &a;
    for (const Type& type : table)
        if (widens(a, type) && widens(b, type)) return &type;
    return nullptr;
}

bool same_type(const Type& a, const Type& b) {
    if (&a == &b) return true;
    if (a.kind != b.kind) return false;
    switch (a.kind) {
        case Kind::time:
        case Kind::date:
        case Kind::clock:
        case Kind::moment:
        case Kind::boolean:
            return true;
        case Kind::integer:
        case Kind::bits:
        case Kind::real:
            return a.bits == b.bits && a.is_signed == b.is_signed &&
                   a.is_subrange == b.is_subrange &&
                   (!a.is_subrange || (smallest(a) == smallest(b) && largest(a) == largest(b)));
        case Kind::text:
            return a.length == b.length && a.is_open == b.is_open && a.is_wide == b.is_wide;
        case Kind::array:
            return a.lower == b.lower && a.upper == b.upper && same_type(*a.element, *b.element);
        case Kind::reference:
            return refer_to_the_same(&a, &b);
        case Kind::structure:
        case Kind::union_:
            return a.is_unnamed && b.is_unnamed && a.pack == b.pack &&
                   std::ranges::equal(a.members, b.members,
                                      [](const Variable* x, const Variable* y) {
                                          return same_name(x->text, y->text) && x->type &&
                                                 y->type && same_type(*x->type, *y->type);
                                      });
        case Kind::standard:
            return a.standard == b.standard && a.name == b.name;
        default:
            return false;
    }
}

Wide smallest(const Type& type) {
    if (type.is_subrange) return whole_in(type, static_cast<std::uint64_t>(type.lower));
    return type.is_signed ? -(Wide{1} << (type.bits - 1)) : 0;
}

Wide largest(const Type& type) {
    if (type.is_subrange) return whole_in(type, static_cast<std::uint64_t>(type.upper));
    return (Wide{1} << (type.is_signed ? type.bits - 1 : type.bits)) - 1;
}

Wide whole_in(const Type& type, std::uint64_t slot) {
    return type.is_unsigned_64() ? Wide{slot} : static_cast<std::int64_t>(slot);
}

Wide wrapped(const Type& type, Wide value) {
    const Wide range = Wide{1} << type.bits;
    Wide rest = value % range;
    if (rest < 0) rest += range;
    return type.is_signed && rest >= range / 2 ? rest - range : rest;
}

}  // namespace lineshaft::st
