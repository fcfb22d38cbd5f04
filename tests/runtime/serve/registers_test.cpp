#include "runtime/serve/registers.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

using enum RegisterType;
using Words = std::array<std::uint16_t, 4>;

MappedSignal mapped(RegisterType type, int count, Type of, double scale = 1) {
    MappedSignal signal{.count = count, .type = type, .signal = {}};
    signal.signal.type = of;
    set_scale(signal, scale);
    return signal;
}

Words written(const MappedSignal& signal, const Value& value) {
    Words words{};
    to_registers(signal, value, words);
    return words;
}

}  // namespace

TEST_CASE("registers have the words and bytes that are said") {
    MappedSignal signal = mapped(int32, 2, Type::integer);
    CHECK(written(signal, std::int64_t{0x12345678}) == Words{0x1234, 0x5678});
    signal.low_first = true;
    CHECK(written(signal, std::int64_t{0x12345678}) == Words{0x5678, 0x1234});
    signal.little = true;
    CHECK(written(signal, std::int64_t{0x12345678}) == Words{0x7856, 0x3412});
    CHECK(written(mapped(real32, 2, Type::real), 1.5) == Words{0x3FC0, 0});
    CHECK(written(mapped(uint16, 1, Type::boolean), true) == Words{1});
    CHECK(written(mapped(int16, 1, Type::real, 0.001), -0.5) == Words{0xFE0C});
}

TEST_CASE("what a type does not have is the nearest that it has") {
    CHECK(written(mapped(int16, 1, Type::integer), std::int64_t{40000}) == Words{0x7FFF});
    CHECK(written(mapped(int16, 1, Type::integer), std::int64_t{-40000}) == Words{0x8000});
    CHECK(written(mapped(uint16, 1, Type::real), -1.0) == Words{0});
    CHECK(written(mapped(uint16, 1, Type::real), std::nan("")) == Words{0});
    CHECK(written(mapped(int64, 4, Type::real), 1e300) == Words{0x7FFF, 0xFFFF, 0xFFFF, 0xFFFF});
    CHECK(written(mapped(uint64, 4, Type::integer), std::numeric_limits<std::int64_t>::min()) ==
          Words{});
}

TEST_CASE("integers without a sign have all 64 bits in their registers, and come back from them") {
    constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    const MappedSignal all = mapped(uint64, 4, Type::unsigned_integer);
    CHECK(written(all, most) == Words{0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF});
    CHECK(from_registers(all, Words{0xFFFF, 0xFFFF, 0xFFFF, 0xFFFE}) == Value{most - 1});
    const MappedSignal with_sign = mapped(int64, 4, Type::unsigned_integer);
    CHECK(written(with_sign, most) == Words{0x7FFF, 0xFFFF, 0xFFFF, 0xFFFF});
    CHECK_FALSE(from_registers(with_sign, Words{0x8000, 0, 0, 0}));
    CHECK(from_registers(mapped(real32, 2, Type::unsigned_integer), Words{0x5F00, 0}) ==
          Value{std::uint64_t{1} << 63});
}

TEST_CASE("a value that its registers have comes back from them") {
    std::mt19937_64 random(7);
    struct Kind {
        RegisterType type;
        int count;
    };
    for (int n = 0; n < 20'000; ++n) {
        const Kind kind = std::array<Kind, 5>{
            {{int16, 1}, {int32, 2}, {int64, 4}, {uint32, 2}, {uint16, 1}}}[random() % 5];
        MappedSignal signal = mapped(kind.type, kind.count, Type::integer);
        signal.little = random() % 2;
        signal.low_first = random() % 2;
        Words words{};
        for (int i = 0; i < kind.count; ++i)
            words[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(random());
        const auto value = from_registers(signal, words);
        REQUIRE(value);
        REQUIRE(written(signal, *value) == words);
        signal = mapped(real64, 4, Type::real);
        const double real = std::bit_cast<double>(random());
        const auto again = from_registers(signal, written(signal, real));
        REQUIRE(again.has_value() == std::isfinite(real));
        if (again) REQUIRE(std::get<double>(*again) == real);
    }
}

TEST_CASE("registers without a value of the signal's have none") {
    static constexpr std::string_view names[] = {"idle", "runs"};
    MappedSignal choice = mapped(uint16, 1, Type::enumeration);
    choice.signal.names = ValueNames(names);
    CHECK(from_registers(choice, Words{1}) == Value{std::int64_t{1}});
    CHECK_FALSE(from_registers(choice, Words{2}));
    CHECK_FALSE(from_registers(mapped(uint16, 1, Type::boolean), Words{2}));
    CHECK_FALSE(from_registers(mapped(real32, 2, Type::integer), Words{0x3FC0, 0}));
    CHECK_FALSE(from_registers(mapped(uint64, 4, Type::integer), Words{0x8000}));
    CHECK_FALSE(from_registers(mapped(real32, 2, Type::real), Words{0x7F80, 0}));
}

TEST_CASE("whole numbers keep all their digits, whatever their scale") {
    std::mt19937_64 random(11);
    for (int n = 0; n < 20'000; ++n) {
        const double power = std::pow(10.0, static_cast<double>(random() % 10));
        const bool is_whole = random() % 2;
        const MappedSignal signal = mapped(
            int64, 4, Type::integer, (random() % 2 ? -1 : 1) * (is_whole ? power : 1 / power));
        INFO("scale " << signal.scale);
        REQUIRE(signal.divisor != 0);
        const std::int64_t room =
            std::numeric_limits<std::int64_t>::max() / static_cast<std::int64_t>(power);
        const std::int64_t small = static_cast<std::int64_t>(random() >> 1) % room;
        const auto large = static_cast<std::int64_t>(small * static_cast<std::int64_t>(power));
        // What is a multiple of the scale, and has room in the registers.
        const std::int64_t value = is_whole ? large : small;
        const auto again = from_registers(signal, written(signal, value));
        REQUIRE(again);
        REQUIRE(std::get<std::int64_t>(*again) == value);
    }
}

TEST_CASE(
    "a scaled whole number is rounded to the nearest, and refused where it would not be whole") {
    const MappedSignal tens = mapped(int16, 1, Type::integer, 10);
    CHECK(written(tens, std::int64_t{14}) == Words{1});
    CHECK(written(tens, std::int64_t{15}) == Words{2});
    CHECK(written(tens, std::int64_t{-15}) == Words{0xFFFE});
    CHECK(from_registers(tens, Words{2}) == Value{std::int64_t{20}});
    const MappedSignal parts = mapped(int16, 1, Type::integer, 0.1);
    CHECK(written(parts, std::int64_t{14}) == Words{140});
    CHECK(from_registers(parts, Words{140}) == Value{std::int64_t{14}});
    CHECK_FALSE(from_registers(parts, Words{141}));
    const MappedSignal thirds = mapped(int64, 4, Type::integer, 0.3);
    CHECK(thirds.divisor == 0);
}
