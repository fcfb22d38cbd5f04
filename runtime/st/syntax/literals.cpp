#include "runtime/st/syntax/literals.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"

namespace lineshaft::st {

namespace {

constexpr Wide beyond = Wide{1} << 64;

/// Underscores stand between digits, one at a time.
bool separates_well(std::string_view text) {
    return !text.empty() && text.front() != '_' && text.back() != '_' &&
           text.find("__") == std::string_view::npos;
}

std::optional<Wide> read_digits(std::string_view text, int base) {
    if (!separates_well(text)) return {};
    Wide value = 0;
    for (const char c : text) {
        if (c == '_') continue;
        if (digit_of(c) >= base) return {};
        value = value * base + digit_of(c);
        if (value >= beyond) return {};
    }
    return value;
}

struct TimeUnit {
    std::string_view name;
    std::int64_t nanoseconds;
};

// As they must follow each other.
constexpr TimeUnit time_units[] = {{"d", 86'400'000'000'000},
                                   {"h", 3'600'000'000'000},
                                   {"m", 60'000'000'000},
                                   {"s", 1'000'000'000},
                                   {"ms", 1'000'000},
                                   {"us", 1'000},
                                   {"ns", 1}};

using Characters = fmt::memory_buffer;  // on the stack, as long as a literal usually is

Characters without_underscores(std::string_view text, bool small) {
    Characters out;
    for (const char c : text)
        if (c != '_') out.push_back(small ? lower(c) : c);
    return out;
}

std::string_view view(const Characters& text) {
    return {text.data(), text.size()};
}

/// `3.5` in a unit of so many ns; a fraction of a ns is left out.
std::optional<Wide> read_part(std::string_view number, std::int64_t nanoseconds) {
    const std::size_t dot = number.find('.');
    const auto whole = read_digits(number.substr(0, dot), 10);
    if (!whole) return {};
    Wide value = *whole * nanoseconds;
    if (dot == std::string_view::npos) return value;
    Wide scale = nanoseconds, fraction = 0;
    for (const char c : number.substr(dot + 1)) {
        if (digit_of(c) > 9) return {};
        fraction = fraction + scale * digit_of(c) / 10;
        scale /= 10;
    }
    return value + fraction;
}

/// Midnight [ns since 1970].
std::optional<Wide> read_day(std::string_view text) {
    int parts[3] = {};
    for (int& part : parts) {
        const std::size_t end = &part == &parts[2] ? text.size() : text.find('-');
        if (end == std::string_view::npos) return {};
        const auto number = read_digits(text.substr(0, end), 10);
        if (!number || *number > 9999) return {};
        part = static_cast<int>(*number);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    const std::chrono::year_month_day day{std::chrono::year(parts[0]),
                                          std::chrono::month(static_cast<unsigned>(parts[1])),
                                          std::chrono::day(static_cast<unsigned>(parts[2]))};
    if (!day.ok()) return {};
    return Wide{std::chrono::sys_days(day).time_since_epoch().count()} * time_units[0].nanoseconds;
}

std::optional<Wide> within_64_bits(Wide value) {
    return value < beyond / 2 && value >= -beyond / 2 ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<Wide> read_integer(std::string_view text) {
    const std::size_t sharp = text.find('#');
    if (sharp == std::string_view::npos) return read_digits(text, 10);
    const std::string_view base = text.substr(0, sharp);
    const int number = base == "16"   ? 16
                       : base == "10" ? 10
                       : base == "8"  ? 8
                       : base == "2"  ? 2
                                      : 0;
    if (number == 0) return {};
    return read_digits(text.substr(sharp + 1), number);
}

std::optional<double> read_real(std::string_view text) {
    const Characters plain = without_underscores(text, false);
    double value = 0;
    const auto [end, error] = std::from_chars(plain.begin(), plain.end(), value);
    if (error != std::errc() || end != plain.end()) return {};
    return value;
}

std::optional<Wide> read_duration(std::string_view given, bool has_no_sign) {
    const Wide most = has_no_sign ? beyond : beyond / 2;
    const Characters text = without_underscores(given, true);
    std::string_view rest = view(text);
    const bool negative = rest.starts_with('-');
    if (negative || rest.starts_with('+')) rest.remove_prefix(1);
    if (rest.empty()) return {};
    Wide total = 0;
    const TimeUnit* next = std::begin(time_units);
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find_first_not_of("0123456789."), rest.size());
        const std::string_view number = rest.substr(0, end);
        rest.remove_prefix(end);
        const std::size_t letters = std::min(rest.find_first_of("0123456789."), rest.size());
        const std::string_view name = rest.substr(0, letters);
        rest.remove_prefix(letters);
        const auto* unit = std::find_if(next, std::end(time_units),
                                        [&](const TimeUnit& u) { return u.name == name; });
        if (unit == std::end(time_units)) return {};
        const auto part = read_part(number, unit->nanoseconds);
        if (!part || (number.find('.') != std::string_view::npos && !rest.empty())) return {};
        total += *part;
        if (total >= most) return {};
        next = unit + 1;
    }
    return negative ? -total : total;
}

std::optional<Wide> read_date(std::string_view text) {
    const auto day = read_day(text);
    return day ? within_64_bits(*day) : day;
}

std::optional<Wide> read_clock(std::string_view text) {
    constexpr std::string_view names[] = {"h", "m", "s"};
    constexpr int ends[] = {24, 60, 60};
    Characters duration;
    for (int i = 0; !text.empty(); ++i) {
        const std::size_t end = std::min(text.find(':'), text.size());
        const auto number = read_digits(text.substr(0, std::min(end, text.find('.'))), 10);
        if (i == 3 || !number || *number >= ends[i]) return {};
        fmt::format_to(std::back_inserter(duration), "{}{}", text.substr(0, end), names[i]);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (i == 0 && text.empty()) return {};
    }
    return read_duration(view(duration));
}

std::optional<Wide> read_moment(std::string_view text) {
    const std::size_t end = text.rfind('-');
    if (end == std::string_view::npos) return {};
    const auto day = read_day(text.substr(0, end));
    const auto clock = read_clock(text.substr(end + 1));
    return day && clock ? within_64_bits(*day + *clock) : std::nullopt;
}

/// `$00E4` of a WSTRING: a unit of UTF-16.
static std::optional<char32_t> read_unit(std::string_view digits) {
    char32_t unit = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        if (i == digits.size() || digit_of(digits[i]) >= 16) return {};
        unit = unit * 16 + static_cast<char32_t>(digit_of(digits[i]));
    }
    return unit;
}

std::optional<std::string> read_text(std::string_view text, bool is_wide) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '$') {
            out += text[i];
            if (text[i] == '\'' && !is_wide) ++i;
            continue;
        }
        if (++i == text.size()) return {};
        constexpr std::string_view marks = "$'\"lnprtLNPRT", meant = "$'\"\n\n\f\r\t\n\n\f\r\t";
        if (const std::size_t mark = marks.find(text[i]); mark != std::string_view::npos) {
            out += meant[mark];
        } else if (const auto unit = is_wide ? read_unit(text.substr(i)) : std::nullopt) {
            add_character(out, *unit);
            i += 3;
        } else if (i + 1 < text.size() && digit_of(text[i]) < 16 && digit_of(text[i + 1]) < 16) {
            out += static_cast<char>(digit_of(text[i]) * 16 + digit_of(text[i + 1]));
            ++i;
        } else {
            return {};
        }
    }
    return out;
}

bool is_data_block(std::string_view text) {
    return text.size() > 2 && upper(text[0]) == 'D' && upper(text[1]) == 'B' &&
           std::ranges::all_of(text.substr(2), is_digit);
}

std::optional<ImageAddress> read_classic_address(std::string_view text) {
    constexpr std::string_view sizes = "BWD";
    const bool has_size = text.size() > 1 && sizes.find(upper(text[1])) != sizes.npos;
    if (text.empty() || has_size == (text.find('.') != text.npos)) return {};
    std::string full = "%" + std::string(text);
    const char area = upper(text.front());
    full[1] = area == 'E' ? 'I' : area == 'A' ? 'Q' : area;
    return read_address(full, AddressCount::bytes);
}

std::string to_string(Wide value) {
    if (value < 0) return "-" + to_string(-value);
    const auto low = static_cast<std::uint64_t>(value % 10'000'000'000'000'000'000U);
    const auto high = static_cast<std::uint64_t>(value / 10'000'000'000'000'000'000U);
    if (high == 0) return std::to_string(low);
    const std::string digits = std::to_string(low);
    return std::to_string(high) + std::string(19 - digits.size(), '0') + digits;
}

}  // namespace lineshaft::st
