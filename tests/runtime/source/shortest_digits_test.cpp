#include "runtime/source/shortest_digits.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include <catch2/catch.hpp>

#include "runtime/source/number_text.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;

namespace {

/// As std::to_chars writes it: `1.25e-05`.
std::string scientific(ShortDecimal number) {
    std::string digits = std::to_string(number.digits);
    const int exponent = number.exponent + static_cast<int>(digits.size()) - 1;
    digits.resize(digits.find_last_not_of('0') + 1);
    if (digits.size() > 1) digits.insert(1, ".");
    const std::string size = std::to_string(std::abs(exponent));
    return digits + (exponent < 0 ? "e-" : "e+") + (size.size() < 2 ? "0" : "") + size;
}

std::string expected(double value) {
    char text[32];
    return {text, std::to_chars(text, text + 32, value, std::chars_format::scientific).ptr};
}

/// False once a number, or a neighbour of it, has other digits than std::to_chars gives it.
bool agrees(double number) {
    for (const double value : {number, std::nextafter(number, 0), std::nextafter(number, HUGE_VAL)})
        if (value > 0 && std::isfinite(value) &&
            scientific(shortest_digits(value)) != expected(value)) {
            UNSCOPED_INFO(scientific(shortest_digits(value)) << " instead of " << expected(value));
            return false;
        }
    return true;
}

}  // namespace

TEST_CASE("powers of two and of ten have the digits of to_chars", "[number]") {
    for (int i = -1074; i < 1024; ++i) REQUIRE(agrees(std::ldexp(1, i)));
    for (int i = -323; i <= 308; ++i)
        for (const int digit : {1, 2, 5, 9})
            REQUIRE(agrees(
                std::strtod((std::to_string(digit) + "e" + std::to_string(i)).c_str(), nullptr)));
}

TEST_CASE("numbers of all kinds have the digits of to_chars", "[number]") {
    const std::int64_t count = test::count_of("LINESHAFT_NUMBERS", 20000);
    const std::uint64_t seed = std::random_device()();
    INFO("seed " << seed);
    std::mt19937_64 random(seed);
    const auto below = [&](std::uint64_t end) { return static_cast<double>(random() % end); };
    for (std::int64_t i = 0; i < count; ++i) {
        const std::uint64_t bits = random();
        REQUIRE(agrees(std::bit_cast<double>(bits >> 1)));
        REQUIRE(agrees(std::bit_cast<double>(bits >> 12 >> bits % 52)));
        REQUIRE(agrees(static_cast<double>(bits >> bits % 64)));
        REQUIRE(agrees(below(100'000'000) / std::pow(10, below(12))));
        REQUIRE(agrees(std::ldexp(below(1 << 20), static_cast<int>(random() % 80) - 40)));
    }
}

TEST_CASE("no number takes more room than it is given", "[number]") {
    std::mt19937_64 random(7);
    std::size_t most = 0;
    const auto look = [&](double value) {
        std::string room(64, '#');
        write_real(room.data(), value);
        most = std::max(most, room.find_last_not_of('#') + 1);
    };
    for (int i = 0; i < 100'000; ++i) {
        look(std::bit_cast<double>(random()));
        look(
            -std::ldexp(static_cast<double>(random() >> 11), static_cast<int>(random() % 80) - 70));
    }
    CHECK(most <= longest_number);
    CHECK(most >= longest_number - 1);
}
