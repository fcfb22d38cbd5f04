#include "runtime/source/number_text.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace lineshaft;

namespace {

template <class Write, class T>
std::string text(Write write, T value) {
    std::array<char, longest_number> room;
    return {room.data(), write(room.data(), value)};
}

double parsed(const std::string& text) {
    double value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    REQUIRE(end.ptr == text.data() + text.size());
    return value;
}

}  // namespace

TEST_CASE("reals are written short, and as users write them", "[trace][number]") {
    CHECK(text(write_real, 0.0) == "0");
    CHECK(text(write_real, -0.0) == "-0");
    CHECK(text(write_real, 0.1) == "0.1");
    CHECK(text(write_real, -2.5) == "-2.5");
    CHECK(text(write_real, 5e-4) == "0.0005");
    CHECK(text(write_real, 5e-5) == "5e-05");
    CHECK(text(write_real, 100000.0) == "100000");
    CHECK(text(write_real, 1e15) == "1000000000000000");
    CHECK(text(write_real, 1e16) == "1e+16");
    CHECK(text(write_real, -1.7976931348623157e308) == "-1.7976931348623157e+308");
    CHECK(text(write_real, 5e-324) == "5e-324");
    CHECK(text(write_real, std::numeric_limits<double>::infinity()) == "INF");
    CHECK(text(write_real, -std::numeric_limits<double>::infinity()) == "-INF");
    CHECK(text(write_real, -std::nan("")) == "NaN");
}

TEST_CASE("any real reads back as the same bits, in at most 17 digits", "[trace][number]") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 100'000; ++i) {
        const auto value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        const std::string written = text(write_real, value);
        REQUIRE(written.size() <= 24);
        REQUIRE(std::bit_cast<std::uint64_t>(parsed(written)) ==
                std::bit_cast<std::uint64_t>(value));
    }
}

TEST_CASE("a real has the digits and the form of fmt's", "[trace][number]") {
    std::mt19937_64 random(2);
    for (int i = 0; i < 200'000; ++i) {
        const double scale = std::pow(10.0, static_cast<double>(random() % 16) - 7);
        double value = scale * static_cast<double>(static_cast<std::int64_t>(random())) / 0x1p63;
        const double digits = std::pow(10.0, static_cast<double>(random() % 17));
        if (random() % 2 == 0) value = std::round(value * digits) / digits;
        if (value == std::round(value)) continue;
        for (const double near : {value, std::nextafter(value, 0), std::nextafter(value, 1e9)})
            REQUIRE(text(write_real, near) == fmt::format("{}", near));
    }
}

TEST_CASE("nanoseconds become exact seconds", "[trace][number]") {
    CHECK(text(write_seconds, 0) == "0");
    CHECK(text(write_seconds, 1) == "0.000000001");
    CHECK(text(write_seconds, -1'250'000) == "-0.00125");
    CHECK(text(write_seconds, 1'000'000'000) == "1");
    CHECK(text(write_seconds, 12'340'000'000) == "12.34");
    CHECK(text(write_seconds, 8'640'000'000'000'001) == "8640000.000000001");
    CHECK(text(write_seconds, std::numeric_limits<std::int64_t>::min()) == "-9223372036.854775808");
    CHECK(text(write_seconds, std::numeric_limits<std::int64_t>::max()) == "9223372036.854775807");
}
