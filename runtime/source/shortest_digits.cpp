#include "runtime/source/shortest_digits.hpp"

#include <array>
#include <bit>
#include <cstddef>

namespace lineshaft {
namespace {

__extension__ using Bits128 = unsigned __int128;

constexpr int least_power = -292;
constexpr int greatest_power = 324;
constexpr int mantissa_bits = 52;

/// A whole number below 2^1280, the lowest 32 bits first.
struct Long {
    std::array<std::uint32_t, 40> words{};
    std::size_t size = 1;

    constexpr void multiply_by_ten() {
        std::uint64_t carry = 0;
        for (std::size_t i = 0; i < size; ++i) {
            carry += std::uint64_t{10} * words[i];
            words[i] = static_cast<std::uint32_t>(carry);
            carry >>= 32;
        }
        if (carry != 0) words[size++] = static_cast<std::uint32_t>(carry);
    }

    constexpr void divide_by_ten() {
        std::uint64_t rest = 0;
        for (std::size_t i = size; i-- > 0;) {
            rest = rest << 32 | words[i];
            words[i] = static_cast<std::uint32_t>(rest / 10);
            rest %= 10;
        }
        if (words[size - 1] == 0) --size;
    }

    /// Its first 128 binary digits, rounded up.
    constexpr Bits128 leading() const {
        const int unused = std::countl_zero(words[size - 1]);
        Bits128 digits = 0;
        for (std::size_t i = 1; i <= 4; ++i) digits = digits << 32 | words[size - i];
        const std::uint64_t more = std::uint64_t{words[size - 5]} << unused;
        bool rest = static_cast<std::uint32_t>(more) != 0;
        for (std::size_t i = 0; i + 5 < size && !rest; ++i) rest = words[i] != 0;
        return (digits << unused | more >> 32) + (rest ? 1 : 0);
    }
};

/// The leading 128 binary digits of the powers of ten: products of 2^160 and ten, and quotients of
/// 2^1152, of which so many digits are left that a fraction lost does not matter.
constexpr auto leading_of_powers = [] {
    std::array<Bits128, greatest_power - least_power + 1> powers{};
    Long product{{}, 6}, quotient{{}, 37};
    product.words[5] = quotient.words[36] = 1;
    for (std::size_t i = -least_power; i < powers.size(); ++i, product.multiply_by_ten())
        powers[i] = product.leading();
    for (std::size_t i = -least_power; i-- > 0;) {
        quotient.divide_by_ten();
        powers[i] = quotient.leading();
    }
    return powers;
}();

/// floor(log10(2^q)), and of 3/4 of it
constexpr int decimal_exponent(int q, bool three_quarters) {
    return (q * 1262611 - (three_quarters ? 524031 : 0)) >> 22;
}

/// floor(log2(10^k))
constexpr int binary_exponent(int k) {
    return (k * 1741647) >> 19;
}

/// The whole part of power * count / 2^128, odd where something is left over.
std::uint64_t scaled(Bits128 power, std::uint64_t count) {
    const Bits128 low = Bits128{static_cast<std::uint64_t>(power)} * count;
    const Bits128 product = (power >> 64) * count + (low >> 64);
    return static_cast<std::uint64_t>(product >> 64) |
           (static_cast<std::uint64_t>(product) > 1 ? 1 : 0);
}

}  // namespace

ShortDecimal shortest_digits(double value) {
    constexpr std::uint64_t hidden = std::uint64_t{1} << mantissa_bits;
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const std::uint64_t mantissa = bits & (hidden - 1);
    const int biased = static_cast<int>(bits >> mantissa_bits);
    const std::uint64_t c = biased == 0 ? mantissa : mantissa | hidden;
    const int q = (biased == 0 ? 1 : biased) - 1075;
    const bool nearer_below = mantissa == 0 && biased > 1;

    const int k = decimal_exponent(q, nearer_below);
    const int h = q + binary_exponent(-k) + 1;
    const Bits128 power = leading_of_powers[static_cast<std::size_t>(-k - least_power)];
    const std::uint64_t odd = c & 1;
    const std::uint64_t lower = scaled(power, (4 * c - (nearer_below ? 1 : 2)) << h) + odd;
    const std::uint64_t middle = scaled(power, 4 * c << h);
    const std::uint64_t upper = scaled(power, (4 * c + 2) << h) - odd;

    const std::uint64_t ones = middle / 4, tens = ones / 10;
    const bool tens_below = lower <= 40 * tens, tens_above = 40 * tens + 40 <= upper;
    if (ones >= 10 && tens_below != tens_above) return {tens + (tens_above ? 1 : 0), k + 1};
    const bool below = lower <= 4 * ones, above = 4 * ones + 4 <= upper;
    const std::uint64_t half = 4 * ones + 2;
    const bool rounds_up = middle > half || (middle == half && ones % 2 == 1);
    return {ones + ((below != above ? above : rounds_up) ? 1 : 0), k};
}

}  // namespace lineshaft
