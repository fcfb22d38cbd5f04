#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/st/code/code.hpp"
#include "runtime/st/code/meaning.hpp"

namespace lineshaft::st::meaning {

template <class T>
void write_number(std::byte* to, T value, bool has_sign) {
    if constexpr (std::is_floating_point_v<T>)
        if (std::isnan(value)) value = std::abs(value);  // a NaN's sign is the processor's
    char* first = reinterpret_cast<char*>(to + 8);
    const int sign = has_sign && value >= T{} ? 1 : 0;
    if (sign == 1) *first = '+';
    const auto [end, error] = std::to_chars(first + sign, first + longest_result, value);
    set_word(to, 0, error == std::errc() ? static_cast<std::uint64_t>(end - first) : 0);
}

namespace {

/// The longest that are written without an exponent.
template <class T>
constexpr int longest_plain = std::is_same_v<T, float> ? 6 : 14;

/// Digits of a number.
template <class T>
constexpr int shown_digits = std::is_same_v<T, float> ? 7 : 15;

/// Between the digits stands the point, behind `before` of them.
char* write_with_point(char* out, std::string_view digits, int before) {
    const auto put = [&](std::string_view part) { out = std::ranges::copy(part, out).out; };
    const auto put_zeros = [&](int count) { out = std::fill_n(out, std::max(count, 0), '0'); };
    if (before <= 0) put("0.");
    put_zeros(-before);
    const auto whole = static_cast<std::size_t>(std::max(before, 0));
    put(digits.substr(0, before <= 0 ? digits.size() : whole));
    if (before <= 0) return out;
    put_zeros(before - static_cast<int>(digits.size()));
    put(".");
    put(digits.size() > whole ? digits.substr(whole) : "0");
    return out;
}

/// `d.ddd` times 10 to the power `exponent`.
struct Scientific {
    template <class T>
    Scientific(T value, int digits) {
        const char* end = std::to_chars(room.data(), room.data() + room.size(), std::abs(value),
                                        std::chars_format::scientific, digits - 1)
                              .ptr;
        const char* letter = std::find(std::as_const(room).data(), end, 'e');
        number = {room.data(), static_cast<std::size_t>(letter - room.data())};
        std::from_chars(letter + (letter[1] == '+' ? 2 : 1), end, exponent);
    }
    std::array<char, 32> room{};
    std::string_view number;
    int exponent = 0;
};

template <class T>
void write_exponent(std::byte* to, T value) {
    const Scientific parts(value, std::is_same_v<T, float> ? 7 : 14);
    char* const first = reinterpret_cast<char*>(to + 8);
    char* out = first;
    *out++ = std::signbit(value) ? '-' : '+';
    out = std::ranges::copy(parts.number, out).out;
    *out++ = 'E';
    if (parts.exponent >= 0) *out++ = '+';
    out = std::to_chars(out, out + parts.room.size(), parts.exponent).ptr;
    set_word(to, 0, static_cast<std::uint64_t>(out - first));
}

template <class T>
void write_rounded(std::byte* to, T value) {
    Scientific parts(value, shown_digits<T>);
    const int exponent = parts.exponent;
    parts.room[1] = parts.room[0];  // without the point
    std::string_view digits = parts.number.substr(1);
    digits = digits.substr(0, std::max<std::size_t>(digits.find_last_not_of('0') + 1, 1));
    const bool is_plain = exponent >= -4 && exponent < longest_plain<T>;
    char* const first = reinterpret_cast<char*>(to + 8);
    char* out = first;
    if (std::signbit(value)) *out++ = '-';
    out = write_with_point(out, digits, is_plain ? exponent + 1 : 1);
    if (!is_plain) {
        *out++ = 'E';
        out = std::to_chars(out, out + parts.room.size(), exponent).ptr;
    }
    set_word(to, 0, static_cast<std::uint64_t>(out - first));
}

/// Of a number that is not 0, without its sign: seven digits of a REAL, of what a REAL holds of
/// them, so that 1/3 has 3333334; fifteen of an LREAL.
struct Digits {
    explicit Digits(float value) {
        constexpr double most = 1e7;
        const Scientific parts(value, 9);
        float mantissa = 0.0F;
        std::from_chars(parts.number.data(), parts.number.data() + parts.number.size(), mantissa);
        double whole = std::floor(double{mantissa * 1e6F} + 0.5);
        exponent = parts.exponent;
        if (whole >= most) {
            whole /= 10.0;
            ++exponent;
        }
        const char* end =
            std::to_chars(room.data(), room.data() + room.size(), static_cast<std::int64_t>(whole))
                .ptr;
        keep({room.data(), static_cast<std::size_t>(end - room.data())});
    }
    explicit Digits(double value) {
        const Scientific parts(value, shown_digits<double>);
        exponent = parts.exponent;
        const auto end = std::ranges::remove_copy(parts.number, room.data(), '.').out;
        keep({room.data(), static_cast<std::size_t>(end - room.data())});
    }
    Digits(const Digits&) = delete;
    Digits& operator=(const Digits&) = delete;
    std::array<char, 32> room{};
    std::string_view text;
    int exponent = 0;

  private:
    void keep(std::string_view all) {
        text = all.substr(0, std::max<std::size_t>(all.find_last_not_of('0') + 1, 1));
    }
};

/// `1E08`
char* write_short_exponent(char* out, std::string_view digits, int exponent) {
    *out++ = digits[0];
    if (digits.size() > 1) *out++ = '.';
    out = std::ranges::copy(digits.substr(1), out).out;
    *out++ = 'E';
    if (exponent < 0) *out++ = '-';
    const int size = std::abs(exponent);
    *out++ = static_cast<char>('0' + size / 10);
    *out++ = static_cast<char>('0' + size % 10);
    return out;
}

/// `1.0e-1`
char* write_long_exponent(char* out, std::string_view digits, int exponent) {
    out = write_with_point(out, digits, 1);
    *out++ = 'e';
    return std::to_chars(out, out + longest_result, exponent).ptr;
}

template <class T>
char* write_finite_of_codesys(char* out, T value) {
    constexpr bool is_single = std::is_same_v<T, float>;
    constexpr int least = is_single ? -4 : 0, beyond = is_single ? 8 : 14;
    if (value == T{}) return std::ranges::copy(std::string_view("0.0"), out).out;
    const Digits digits(value);
    const int exponent = digits.exponent;
    if (exponent >= least && exponent < beyond)
        return write_with_point(out, digits.text, exponent + 1);
    return is_single ? write_short_exponent(out, digits.text, exponent)
                     : write_long_exponent(out, digits.text, exponent);
}

template <class T>
void write_of_codesys(std::byte* to, T value) {
    char* const first = reinterpret_cast<char*>(to + 8);
    char* out = first;
    const std::string_view no_number = std::isnan(value) ? "#NaN" : "#Inf";
    if (value < T{}) *out++ = '-';
    out = std::isfinite(value) ? write_finite_of_codesys(out, value)
                               : std::ranges::copy(no_number, out).out;
    set_word(to, 0, static_cast<std::uint64_t>(out - first));
}

/// A value that is not finite, as Siemens has it.
template <class T>
void write_no_number(std::byte* to, T value) {
    const std::string_view text = std::isnan(value) ? "NaN" : value < T{} ? "-INF" : "INF";
    std::ranges::copy(text, reinterpret_cast<char*>(to + 8));
    set_word(to, 0, text.size());
}

}  // namespace

template <class T>
void write_real(std::byte* to, T value, RealForm form) {
    if (form == RealForm::of_codesys) return write_of_codesys(to, value);
    if (form == RealForm::exponent && !std::isfinite(value)) return write_no_number(to, value);
    if (form == RealForm::shortest || !std::isfinite(value)) return write_number(to, value, false);
    form == RealForm::rounded ? write_rounded(to, value) : write_exponent(to, value);
}

namespace {

/// `16#FF`
int base_of(std::string_view number) {
    return number.starts_with("2#")    ? 2
           : number.starts_with("8#")  ? 8
           : number.starts_with("16#") ? 16
                                       : 10;
}

/// More than a text has.
constexpr int max_digits = 1'000'000;

/// `2#1111_0000` without the signs between its digits.
std::string_view without_groups(std::string_view text, std::array<char, longest_result>& room) {
    text = text.substr(0, room.size());
    const auto end = std::ranges::remove_copy(text, room.data(), '_').out;
    return {room.data(), static_cast<std::size_t>(end - room.data())};
}

/// Of a number that no double holds: infinity, or 0 where it is too near to that.
double beyond_range(std::string_view number) {
    const std::size_t letter = std::min(number.find_first_of("eE"), number.size());
    const auto whole = static_cast<double>(std::min(number.find('.'), letter)),
               first = static_cast<double>(number.find_first_of("123456789"));
    std::string_view power = number.substr(std::min(letter + 1, number.size()));
    if (power.starts_with('+')) power.remove_prefix(1);
    int exponent = power.starts_with('-') ? -max_digits : max_digits;
    if (power.empty()) exponent = 0;
    std::from_chars(power.data(), power.data() + power.size(), exponent);
    return whole - first + exponent > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

}  // namespace

template <class T>
T number_of_text(const std::byte* from, bool has_groups) {
    std::array<char, longest_result> room;
    std::string_view text = text_at(from);
    if (has_groups) text = without_groups(text, room);
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    const bool is_negative = text.starts_with('-');
    if (is_negative || text.starts_with('+')) text.remove_prefix(1);
    if (text.find_first_of(".0123456789") != 0) return T{};
    T value{};
    std::from_chars_result read;
    if constexpr (std::is_integral_v<T>) {
        const int base = base_of(text);
        if (base != 10) text.remove_prefix(text.find('#') + 1);
        read = std::from_chars(text.data(), text.data() + text.size(), value, base);
    } else {
        read = std::from_chars(text.data(), text.data() + text.size(), value);
    }
    if constexpr (std::is_floating_point_v<T>)
        if (read.ec == std::errc::result_out_of_range)
            value = beyond_range({text.data(), static_cast<std::size_t>(read.ptr - text.data())});
    return is_negative ? -value : value;
}

/// Sign, digits, point and digits.
static std::string s7_number(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const bool has_sign = text.starts_with('-') || text.starts_with('+');
    std::string read = text.starts_with('-') ? "-" : "";
    if (has_sign) text.remove_prefix(1);
    bool has_point = false;
    for (const char c : text) {
        const bool is_comma = c == ',' && !has_point, is_point = c == '.' && !has_point;
        if (!is_comma && !is_point && (c < '0' || c > '9')) break;
        has_point |= is_point;
        if (!is_comma) read += c;
    }
    return read;
}

std::uint64_t s7_integer_of_text(const std::byte* from, std::uint64_t bits, bool is_signed) {
    const std::string number = s7_number(text_at(from));
    const bool is_negative = number.starts_with('-');
    const char *first = number.data() + (is_negative ? 1 : 0), *end = number.data() + number.size();
    std::uint64_t value = 0;
    if (std::from_chars(first, end, value).ec != std::errc()) return 0;
    const std::uint64_t half = std::uint64_t{1} << (bits - 1),
                        most = !is_signed ? half - 1 + half : half - 1;
    if (is_negative) return is_signed && value <= half ? 0 - value : 0;
    return value <= most ? value : 0;
}

double s7_real_of_text(const std::byte* from) {
    const std::string number = s7_number(text_at(from));
    double value = 0.0;
    std::from_chars(number.data(), number.data() + number.size(), value, std::chars_format::fixed);
    return value;
}

template void write_number(std::byte*, std::int64_t, bool);
template void write_number(std::byte*, std::uint64_t, bool);
template void write_real(std::byte*, double, RealForm);
template void write_real(std::byte*, float, RealForm);
template std::uint64_t number_of_text(const std::byte*, bool);
template double number_of_text(const std::byte*, bool);

}  // namespace lineshaft::st::meaning
