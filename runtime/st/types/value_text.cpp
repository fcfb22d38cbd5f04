#include "runtime/st/types/value_text.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <iterator>

#include "runtime/source/encoding.hpp"
#include "runtime/source/units.hpp"
#include "runtime/source/utf8.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;

/// The shortest number that reads back as the same value of its width.
std::string real_text(double value, bool is_long) {
    if (!std::isfinite(value)) return format_number(value);
    const std::string text =
        is_long ? fmt::format("{}", value) : fmt::format("{}", static_cast<float>(value));
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

using Out = std::back_insert_iterator<fmt::memory_buffer>;

void add_duration(Out to, Wide nanoseconds, TimeForm form) {
    constexpr std::pair<std::uint64_t, const char*> units[] = {{86'400'000'000'000, "d"},
                                                               {3'600'000'000'000, "h"},
                                                               {60'000'000'000, "m"},
                                                               {1'000'000'000, "s"},
                                                               {1'000'000, "ms"},
                                                               {1'000, "us"},
                                                               {1, "ns"}};
    auto left = static_cast<std::uint64_t>(nanoseconds < 0 ? -nanoseconds : nanoseconds);
    const char* const none = form == TimeForm::of_long_in_codesys ? "0ns" : "0s";
    fmt::format_to(to, "{}#{}{}", form == TimeForm::plain ? "T" : "LTIME",
                   nanoseconds < 0 ? "-" : "", nanoseconds == 0 ? none : "");
    for (const auto& [size, unit] : units) {
        if (left >= size) fmt::format_to(to, "{}{}", left / size, unit);
        left %= size;
    }
}

void add_date(Out to, Kind kind, std::int64_t since_1970, TimeForm form) {
    using namespace std::chrono;
    const sys_time<nanoseconds> moment{nanoseconds(since_1970)};
    const auto midnight = floor<days>(moment);
    const year_month_day day(midnight);
    const hh_mm_ss clock(moment - midnight);
    const bool is_long = form == TimeForm::of_long || form == TimeForm::of_long_in_codesys,
               is_of_codesys = form == TimeForm::of_long_in_codesys;
    const char* const of_date = is_of_codesys ? "LD" : is_long ? "LDATE" : "D";
    fmt::format_to(to, "{}#",
                   kind == Kind::date    ? of_date
                   : kind == Kind::clock ? (is_long ? "LTOD" : "TOD")
                                         : (is_long ? "LDT" : "DT"));
    if (kind != Kind::clock)
        fmt::format_to(to, "{:04}-{:02}-{:02}", static_cast<int>(day.year()),
                       static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()));
    if (kind == Kind::date) return;
    const auto hours =
        kind == Kind::clock ? floor<std::chrono::hours>(nanoseconds(since_1970)) : clock.hours();
    fmt::format_to(to, "{}{:02}:{:02}:", kind == Kind::moment ? "-" : "", hours.count(),
                   clock.minutes().count());
    const auto seconds = clock.seconds().count(), rest = clock.subseconds().count();
    if (rest != 0 && form == TimeForm::of_matiec) {
        fmt::format_to(to, "{:09.6f}",
                       static_cast<double>(seconds) + static_cast<double>(rest) / 1e9);
        return;
    }
    fmt::format_to(to, "{:02}", seconds);
    if (rest % 1'000'000 != 0 || (rest != 0 && is_of_codesys))
        fmt::format_to(to, ".{:09}", rest);
    else if (rest != 0)
        fmt::format_to(to, ".{:03}", rest / 1'000'000);
}

std::string literal(Kind kind, Wide nanoseconds) {
    fmt::memory_buffer text;
    add_time(text, kind, nanoseconds);
    return fmt::to_string(text);
}

}  // namespace

std::string value_text(const Type& type, std::uint64_t slot) {
    const auto number = static_cast<std::int64_t>(slot);
    if (const std::string* name = type.has_values() ? type.name_of(number) : nullptr)
        return fmt::format("{}#{}", type.name, *name);
    switch (type.kind) {
        case Kind::boolean:
            return slot != 0 ? "TRUE" : "FALSE";
        case Kind::bits:
            if (type.is_character && type.bits == 16)
                return text_literal(text_of_units(std::u16string(1, static_cast<char16_t>(slot))));
            if (type.is_character) return text_literal(std::string(1, static_cast<char>(slot)));
            return fmt::format("16#{:X}", slot);
        case Kind::real:
        case Kind::any_real:
            return real_text(std::bit_cast<double>(slot), type.bits != 32);
        case Kind::time:
        case Kind::date:
        case Kind::clock:
        case Kind::moment:
            return literal(type.kind, whole_in(type, slot));
        default:
            return type.is_unsigned_64() ? std::to_string(slot) : std::to_string(number);
    }
}

std::string time_literal(std::int64_t nanoseconds) {
    return literal(Kind::time, nanoseconds);
}

void add_time(fmt::memory_buffer& to, Kind kind, Wide nanoseconds, TimeForm form) {
    if (kind == Kind::time)
        add_duration(std::back_inserter(to), nanoseconds, form);
    else
        add_date(std::back_inserter(to), kind, static_cast<std::int64_t>(nanoseconds), form);
}

std::optional<Wide> read_time(std::string_view text, Kind kind) {
    if (kind == Kind::date) return read_date(text);
    if (kind == Kind::clock) return read_clock(text);
    return kind == Kind::moment ? read_moment(text) : read_duration(text);
}

std::string printable(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const Utf8Character c = first_character(text);
        const auto byte = static_cast<unsigned char>(text.front());
        if (c.code < 0x20 || (!c.valid && of_windows_1252(byte) == 0xFFFD))
            out += fmt::format("${:02X}", byte);
        else if (!c.valid)
            add_character(out, of_windows_1252(byte));
        else
            out += text.substr(0, c.bytes);
        text.remove_prefix(c.bytes);
    }
    return out;
}

std::string text_literal(std::string_view text) {
    std::string marked;
    for (const char c : text) {
        if (c == '$' || c == '\'') marked += '$';
        marked += c;
    }
    return "'" + printable(marked) + "'";
}

}  // namespace lineshaft::st
