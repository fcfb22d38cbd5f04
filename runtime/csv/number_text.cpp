#include "runtime/csv/number_text.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include <fmt/compile.h>

namespace lineshaft {

namespace {

constexpr double below_exponent = 1e15;

bool is_small_integer(double value) {
    return std::abs(value) < below_exponent &&
           value == static_cast<double>(static_cast<std::int64_t>(value)) &&
           !(value == 0 && std::signbit(value));
}

constexpr int most_digits = 17;
constexpr auto powers_of_ten = [] {
    std::array<std::uint64_t, most_digits + 1> powers = {1};
    for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = 10 * powers[i - 1];
    return powers;
}();

int count_digits(std::uint64_t number) {
    const auto fewest = static_cast<std::size_t>(std::bit_width(number) * 1233 >> 12);
    return static_cast<int>(fewest) + (number >= powers_of_ten[fewest]);
}

/// Eight digits, the first in the lowest byte: a pair, two pairs and four pairs at a time.
std::uint64_t eight_digits(std::uint64_t number) {
    static_assert(std::endian::native == std::endian::little);
    const std::uint64_t fours = number / 10000 | number % 10000 << 32;
    const std::uint64_t hundreds = fours * 10486 >> 20 & 0x7f0000007f;
    const std::uint64_t pairs = hundreds | (fours - 100 * hundreds) << 16;
    const std::uint64_t tens = pairs * 103 >> 10 & 0x000f000f000f000f;
    return (tens | (pairs - 10 * tens) << 8) + 0x3030303030303030;
}

void put_word(char* to, std::uint64_t word) {
    std::memcpy(to, &word, sizeof word);
}

/// `0.ddd`, and `ddd.ddd` of fewer than 8 digits before the point. The digits are fmt's
/// (`dragonbox`); laid out by fmt, too, a trace of random reals takes 10 ns a value more (of 63).
char* write_fixed(char* to, double value) {
    auto [significand, exponent] = fmt::detail::dragonbox::to_decimal(value);
    const int count = count_digits(significand);
    const int point = count + exponent;
    significand *= powers_of_ten[static_cast<std::size_t>(most_digits - count)];
    const std::uint64_t first = eight_digits(significand / powers_of_ten[9]);
    const std::uint64_t second = eight_digits(significand / 10 % powers_of_ten[8]);
    const auto last = static_cast<char>('0' + significand % 10);
    if (point <= 0) {
        put_word(to, 0x3030303030302e30);  // 0.000000
        to += 2 - point;
        put_word(to, first);
        put_word(to + 8, second);
        to[16] = last;
        return to + count;
    }
    const std::uint64_t before = (std::uint64_t{1} << 8 * point) - 1;
    const std::uint64_t dot = std::uint64_t{'.'} << 8 * point;
    put_word(to, (first & before) | dot | (first << 8 & ~(before << 8 | 0xff)));
    to[8] = static_cast<char>(first >> 56);
    put_word(to + 9, second);
    to[17] = last;
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
    if (size < 1e-4 || size >= 1e7) return fmt::format_to(to, FMT_COMPILE("{}"), value);
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
    const std::uint64_t part = whole % second;
    if (part == 0) return to;
    *to = '.';
    to[1] = static_cast<char>('0' + part / powers_of_ten[8]);
    put_word(to + 2, eight_digits(part % powers_of_ten[8]));
    for (to += 9; *to == '0';) --to;
    return to + 1;
}

}  // namespace lineshaft
