#include "runtime/source/number_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace lineshaft {

namespace {

constexpr double below_exponent = 1e15;

bool is_small_integer(double value) {
    return std::abs(value) < below_exponent &&
           value == static_cast<double>(static_cast<std::int64_t>(value)) &&
           !(value == 0 && std::signbit(value));
}

/// `0.000ddd` or `ddd.ddd` of a number in [1e-4, 1e7) that is not whole, laid out from `d.ddde-xx`:
/// the library's own fixed form takes a quarter longer.
char* write_fixed(char* to, double value) {
    char text[48];
    const char* end =
        std::to_chars(text + 1, text + longest_number, value, std::chars_format::scientific).ptr;
    const int exponent = 10 * (end[-2] - '0') + (end[-1] - '0');
    const bool below_one = end[-3] == '-';
    text[2] = text[1];
    const char* digits = text + 2;
    const auto count = std::max<std::ptrdiff_t>(end - 4 - digits, 1);
    if (below_one) {
        std::memcpy(to, "0.000000", 8);
        std::memcpy(to + 1 + exponent, digits, 17);
        return to + 1 + exponent + count;
    }
    std::memcpy(to, digits, 8);
    to[exponent + 1] = '.';
    std::memcpy(to + exponent + 2, digits + exponent + 1, 16);
    return to + count + 1;
}

}  // namespace

char* write_integer(char* to, std::int64_t value) {
    return std::to_chars(to, to + longest_number, value).ptr;
}

char* write_real(char* to, double value) {
    if (is_small_integer(value)) return write_integer(to, static_cast<std::int64_t>(value));
    if (!std::isfinite(value)) return to;
    const double size = std::abs(value);
    const auto form = size != 0 && (size < 1e-4 || size >= 1e16) ? std::chars_format::scientific
                                                                 : std::chars_format::fixed;
    if (size < 1e-4 || size >= 1e7) return std::to_chars(to, to + longest_number, value, form).ptr;
    *to = '-';
    return write_fixed(to + (value < 0), size);
}

char* write_seconds(char* to, std::int64_t nanoseconds) {
    constexpr std::uint64_t second = 1'000'000'000;
    auto whole = static_cast<std::uint64_t>(nanoseconds);
    if (nanoseconds < 0) {
        *to++ = '-';
        whole = 0 - whole;
    }
    to = std::to_chars(to, to + longest_number, whole / second).ptr;
    if (whole % second == 0) return to;
    char* end = std::to_chars(to, to + longest_number, second + whole % second).ptr;
    *to = '.';
    while (end[-1] == '0') --end;
    return end;
}

}  // namespace lineshaft
