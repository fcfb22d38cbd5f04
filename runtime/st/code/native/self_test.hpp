#pragma once

#include "runtime/st/code/meaning.hpp"

namespace lineshaft::st::meaning {

constexpr int tested_values = 16;

/// What `self_test` gives where all is as it is to be.
constexpr std::uint64_t self_test_result = 0x6bdd7361fcca6d50;

constexpr double tested_reals[tested_values] = {
    0,          -0.0,    1.0 / 7, -1,    0.1,   1.0 / 3,  -2.7182818284590452, 0.7, 3e9, -7e18,
    16777217.3, 1.5e-45, -3.3e38, 1e300, 255.6, -32768.49};
// clang-format off
constexpr std::uint64_t tested_words[tested_values] = {
    0, 1, 7, 127, 128, 255, 32768, 65535, 0x7FFFFFFF, 0x80000000, 16777217, 0x123456789ABCDEF,
    0x7FFFFFFFFFFFFFFF, 0x8000000000000000, 0xFFFFFFFF81234567, 0xFFFFFFFFFFFFFFFF};
// clang-format on

/// Folds values into one number.
class Mix {
  public:
    void operator()(std::uint64_t value) { sum_ = std::rotl((sum_ ^ value) * 0x100000001B3, 29); }
    void operator()(double value) {
        (*this)(value == value ? std::bit_cast<std::uint64_t>(value) : 1);
    }
    std::uint64_t sum() const { return sum_; }

  private:
    std::uint64_t sum_ = 0;
};

/// REAL in words side by side, of two pairs behind them: gcc 12.2 at -O2 leaves out the rounding
/// here, without -fno-tree-vectorize.
[[gnu::noinline]] inline void round_words(std::byte* first) {
    const auto real = [&](std::uint64_t i) { return std::bit_cast<double>(word(first, i)); };
    write(first, narrow(real(2) * real(4)));
    write(first + 8, narrow(real(3) * real(5)));
}

/// The compiler knows the operands: clang makes another NaN of them than the processor, without
/// -ftrapping-math.
inline void mix_constants(Mix& mix) {
    double zero = 0, infinite = std::numeric_limits<double>::infinity(), minus_one = -1;
    mix(std::bit_cast<std::uint64_t>(zero / zero));
    mix(std::bit_cast<std::uint64_t>(infinite - infinite));
    mix(std::bit_cast<std::uint64_t>(std::sqrt(minus_one)));
    mix(std::bit_cast<std::uint64_t>(narrow(zero * infinite)));
}

template <class T>
void mix_integers(Mix& mix, std::uint64_t a, std::uint64_t b, double x) {
    const std::uint64_t wrapped = wrap<T>(a), by = wrap<T>(b);
    mix(wrap<T>(a * b));
    if (by != 0) mix(quotient<T>(wrapped, by)), mix(remainder<T>(wrapped, by));
    T sum = 0;
    mix(std::uint64_t{__builtin_mul_overflow(static_cast<T>(a), static_cast<T>(b), &sum)});
    const double rounded = std::nearbyint(x);
    if (fits<T>(rounded)) mix(whole<T>(rounded));
}

template <int bits>
void mix_shifts(Mix& mix, std::uint64_t a, std::uint64_t places) {
    const std::uint64_t value = a & mask(bits);
    mix(shift_left<bits>(value, places)), mix(shift_right<bits>(value, places));
    mix(rotate_left<bits>(value, places)), mix(rotate_right<bits>(value, places));
}

/// What compilers may have wrong with flags, or in their own right: the rounding of REAL, integers
/// of each width, shifts, conversions. Of `tested_values` numbers each, which it does not see.
inline std::uint64_t self_test(const double* reals, const std::uint64_t* words) {
    Mix mix;
    mix_constants(mix);
    for (int i = 0; i < tested_values * tested_values; ++i) {
        const double x = reals[i % tested_values], y = reals[i / tested_values];
        const std::uint64_t a = words[i % tested_values], b = words[i / tested_values];
        double six[] = {0, 0, x, y, y, x};
        round_words(reinterpret_cast<std::byte*>(six));
        mix(six[0]), mix(six[1]), mix(x * x + y);
        for (const double z : {x + y, x - y, x * y, x / y, std::fmod(x, y)})
            mix(z), mix(narrow(z)), mix(std::uint64_t{z < y}), mix(std::floor(z)),
                mix(std::trunc(z));
        mix(std::sqrt(x)), mix(std::nearbyint(x)), mix(std::ceil(x));
        const auto signed_a = static_cast<std::int64_t>(a);
        mix(double{static_cast<float>(signed_a)}), mix(double{static_cast<float>(a)});
        mix(static_cast<double>(signed_a)), mix(static_cast<double>(a));
        mix(static_cast<std::uint64_t>(signed_a >> (b & 63)));
        mix_integers<std::int8_t>(mix, a, b, x), mix_integers<std::uint8_t>(mix, a, b, x);
        mix_integers<std::int16_t>(mix, a, b, x), mix_integers<std::uint16_t>(mix, a, b, x);
        mix_integers<std::int32_t>(mix, a, b, x), mix_integers<std::uint32_t>(mix, a, b, x);
        mix_integers<std::int64_t>(mix, a, b, x), mix_integers<std::uint64_t>(mix, a, b, x);
        mix_shifts<8>(mix, a, b % 80), mix_shifts<16>(mix, a, b % 80);
        mix_shifts<32>(mix, a, b % 80), mix_shifts<64>(mix, a, b % 80);
    }
    return mix.sum();
}

}  // namespace lineshaft::st::meaning
