#include "runtime/source/sha256.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace lineshaft {

namespace {

using Words = std::array<std::uint32_t, 8>;

constexpr std::size_t block = 64;

/// The first 32 bits behind the point of the roots of the first primes.
template <std::size_t count>
std::array<std::uint32_t, count> roots(long double (*root)(long double)) {
    std::array<std::uint32_t, count> made;
    std::size_t found = 0;
    for (std::uint32_t n = 2; found < count; ++n) {
        bool is_prime = true;
        for (std::uint32_t by = 2; by * by <= n; ++by) is_prime = is_prime && n % by != 0;
        if (!is_prime) continue;
        const long double value = root(static_cast<long double>(n));
        made[found++] = static_cast<std::uint32_t>((value - std::floor(value)) * 4294967296.0L);
    }
    return made;
}

void take(Words& state, const char* bytes) {
    static const auto added = roots<block>([](long double x) { return std::cbrt(x); });
    std::array<std::uint32_t, block> w;
    for (std::size_t i = 0; i < 16; ++i) {
        w[i] = 0;
        for (std::size_t k = 0; k < 4; ++k) w[i] = w[i] << 8 | static_cast<unsigned char>(*bytes++);
    }
    const auto mixed = [](std::uint32_t x, int a, int b, std::uint32_t c) {
        return std::rotr(x, a) ^ std::rotr(x, b) ^ c;
    };
    for (std::size_t i = 16; i < block; ++i)
        w[i] = w[i - 16] + mixed(w[i - 15], 7, 18, w[i - 15] >> 3) + w[i - 7] +
               mixed(w[i - 2], 17, 19, w[i - 2] >> 10);
    auto [a, b, c, d, e, f, g, h] = state;
    for (std::size_t i = 0; i < block; ++i) {
        const std::uint32_t first =
            h + mixed(e, 6, 11, std::rotr(e, 25)) + ((e & f) ^ (~e & g)) + added[i] + w[i];
        const std::uint32_t second =
            mixed(a, 2, 13, std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
        h = g, g = f, f = e, e = d + first, d = c, c = b, b = a, a = first + second;
    }
    const Words now = {a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < now.size(); ++i) state[i] += now[i];
}

}  // namespace

std::string sha256(std::string_view bytes) {
    Words state = roots<8>([](long double x) { return std::sqrt(x); });
    std::string rest(bytes.substr(bytes.size() / block * block));
    rest += '\x80';
    while (rest.size() % block != block - 8) rest += '\0';
    for (int shift = 56; shift >= 0; shift -= 8)
        rest += static_cast<char>(8 * std::uint64_t{bytes.size()} >> shift);
    for (std::size_t i = 0; i + block <= bytes.size(); i += block) take(state, bytes.data() + i);
    for (std::size_t i = 0; i < rest.size(); i += block) take(state, rest.data() + i);
    std::string text;
    for (const std::uint32_t word : state) text += fmt::format("{:08x}", word);
    return text;
}

}  // namespace lineshaft
