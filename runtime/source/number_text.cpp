#include "runtime/source/number_text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "runtime/source/shortest_digits.hpp"

namespace lineshaft {

namespace {

__extension__ using Bits128 = unsigned __int128;

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
    return static_cast<int>(fewest) + (number >= powers_of_ten[fewest] ? 1 : 0);
}

template <class Word>
void put(char* to, Word word) {
    static_assert(std::endian::native == std::endian::little);
    std::memcpy(to, &word, sizeof word);
}

constexpr std::uint64_t eight_zeros = 0x3030303030303030;

/// Eight digits, the first in the lowest byte: a pair, two pairs and four pairs at a time.
std::uint64_t eight_digits(std::uint64_t number) {
    const std::uint64_t fours = number / 10000 | number % 10000 << 32;
    const std::uint64_t hundreds = fours * 10486 >> 20 & 0x7f0000007f;
    const std::uint64_t pairs = hundreds | (fours - 100 * hundreds) << 16;
    const std::uint64_t tens = pairs * 103 >> 10 & 0x000f000f000f000f;
    return (tens | (pairs - 10 * tens) << 8) + eight_zeros;
}

/// 0.d1d2d3... * 10^point, as text
struct Digits {
    Bits128 first;  ///< sixteen, the first in the lowest byte
    char last;      ///< the seventeenth
    int count;      ///< without the zeros at the end
    int point;

    explicit Digits(ShortDecimal number) {
        const int all = count_digits(number.digits);
        point = all + number.exponent;
        constexpr std::uint64_t eight = powers_of_ten[8];
        const std::uint64_t full =
            number.digits * powers_of_ten[static_cast<std::size_t>(most_digits - all)];
        const std::uint64_t before = full / eight, leading = before / eight;
        const std::uint64_t low = eight_digits(full - before * eight);
        const std::uint64_t high = eight_digits(before - leading * eight);
        first = Bits128{low} << 72 | Bits128{high} << 8 | ('0' + leading);
        last = static_cast<char>(low >> 56);
        count = most_digits - std::countl_zero(low ^ eight_zeros) / 8;
        if (low == eight_zeros) count -= std::countl_zero(high ^ eight_zeros) / 8;
    }
};

/// `0.000ddd`: the point is 0 to 6 places before the digits.
char* write_below_one(char* to, const Digits& digits) {
    put(to, eight_zeros - ('0' - '.') * 256);
    to += 2 - digits.point;
    put(to, digits.first);
    to[16] = digits.last;
    return to + digits.count;
}

/// `ddd.ddd`: 1 to 16 digits before the point.
char* write_fixed(char* to, const Digits& digits) {
    const int point = digits.point;
    put(to, digits.first);
    to[16] = digits.last;
    if (digits.count <= point) return to + point;
    to[point] = '.';
    put(to + point + 1, digits.first >> 8 >> 8 * (point - 1));
    to[17] = digits.last;
    return to + digits.count + 1;
}

/// `d.ddde-05`
char* write_scientific(char* to, const Digits& digits) {
    put(to + 1, digits.first);
    to[17] = digits.last;
    to[0] = to[1];
    to[1] = '.';
    to += digits.count > 1 ? digits.count + 1 : 1;
    *to++ = 'e';
    const int exponent = digits.point - 1, size = std::abs(exponent);
    *to++ = exponent < 0 ? '-' : '+';
    if (size < 10) *to++ = '0';
    return std::to_chars(to, to + 3, size).ptr;
}

char* write_not_finite(char* to, double value) {
    const std::string_view text = std::isnan(value) ? "NaN" : value < 0 ? "-INF" : "INF";
    return std::ranges::copy(text, to).out;
}

}  // namespace

char* write_integer(char* to, std::int64_t value) {
    return std::to_chars(to, to + longest_number, value).ptr;
}

char* write_unsigned(char* to, std::uint64_t value) {
    return std::to_chars(to, to + longest_number, value).ptr;
}

char* write_real(char* to, double value) {
    if (is_small_integer(value)) return write_integer(to, static_cast<std::int64_t>(value));
    if (!std::isfinite(value)) return write_not_finite(to, value);
    *to = '-';
    to += std::signbit(value) ? 1 : 0;
    if (value == 0) return write_integer(to, 0);
    const Digits digits(shortest_digits(std::abs(value)));
    if (digits.point < -3 || digits.point > 16) return write_scientific(to, digits);
    return digits.point <= 0 ? write_below_one(to, digits) : write_fixed(to, digits);
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
    put(to + 2, eight_digits(part % powers_of_ten[8]));
    for (to += 9; *to == '0';) --to;
    return to + 1;
}

}  // namespace lineshaft
