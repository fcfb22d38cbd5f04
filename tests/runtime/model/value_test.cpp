#include "runtime/model/value.hpp"

#include <array>
#include <limits>
#include <random>

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("a stored value is loaded again and its neighbours are left alone") {
    const struct {
        Type type;
        Value value;
    } all[] = {{Type::boolean, true},
               {Type::boolean, false},
               {Type::integer, std::numeric_limits<std::int64_t>::min()},
               {Type::enumeration, std::int64_t{2}},
               {Type::unsigned_integer, std::numeric_limits<std::uint64_t>::max()},
               {Type::real, -0.1}};
    for (const auto& [type, value] : all) {
        std::array<std::byte, 10> memory;
        memory.fill(std::byte{0x5a});
        store(type, memory.data() + 1, value);  // at no particular alignment
        CHECK(load(type, memory.data() + 1) == value);
        CHECK(memory[0] == std::byte{0x5a});
        CHECK(memory[1 + size_of(type)] == std::byte{0x5a});
    }
}

TEST_CASE("a trace has 0 and 1, whole numbers and the shortest reals") {
    CHECK(format(true) == "1");
    CHECK(format(false) == "0");
    CHECK(format(std::int64_t{-12}) == "-12");
    CHECK(format(std::numeric_limits<std::uint64_t>::max()) == "18446744073709551615");
    CHECK(format(0.1) == "0.1");
    CHECK(format(1e300) == "1e+300");
}

TEST_CASE("an enumeration's numbers need not be 0, 1, 2") {
    static constexpr std::string_view list[] = {"idle", "run", "runs", "fault"};
    static constexpr std::int64_t numbers[] = {0, 10, 10, -3};
    const ValueNames names("State", list, numbers);
    CHECK(describe(std::int64_t{10}, Type::enumeration, names, "") == "run");
    CHECK(describe(std::int64_t{-3}, Type::enumeration, names, "") == "fault");
    CHECK(describe(std::int64_t{1}, Type::enumeration, names, "") == "1");
    CHECK(names.find("runs") == 10);
    CHECK_FALSE(names.takes(1));
    CHECK(names.with_others(-128, 127).takes(1));
    CHECK_FALSE(names.with_others(-128, 127).takes(200));
    CHECK(names.fits(names.with_others(-128, 127)));
    CHECK_FALSE(names.fits(names.without_sign()));
    CHECK(names.without_sign().whole(-1) == Wide{18446744073709551615u});
    CHECK(names.without_sign().stored(Wide{18446744073709551615u}) == -1);
    CHECK_FALSE(names.without_sign().stored(-1));
    CHECK(names.whole(-1) == -1);
    CHECK_FALSE(names.with_others(-128, 127).fits(names));
    CHECK_FALSE(names.fits(ValueNames(list)));
}

TEST_CASE("a person reads true, names and units") {
    static constexpr std::string_view list[] = {"idle", "run"};
    const ValueNames names(list);
    CHECK(describe(true, Type::boolean, {}, "") == "true");
    CHECK(describe(false, Type::boolean, {}, "") == "false");
    CHECK(describe(std::int64_t{1}, Type::enumeration, names, "") == "run");
    CHECK(describe(std::int64_t{2}, Type::enumeration, names, "") == "2");
    CHECK(describe(std::int64_t{-1}, Type::enumeration, names, "") == "-1");
    CHECK(describe(2.5, Type::real, {}, "mm/s") == "2.5 mm/s");
    CHECK(describe(2.5, Type::real, {}, "") == "2.5");
    CHECK(describe(std::int64_t{7}, Type::integer, {}, "pulse") == "7 pulse");
}

TEST_CASE("integers and reals are compared exactly") {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max(), least = -most - 1;
    constexpr std::int64_t edge = std::int64_t{1} << 53;
    CHECK(std::is_lt(compare(edge, edge + 1)));
    CHECK(std::is_gt(compare(edge + 1, 0x1p53)));
    CHECK(std::is_lt(compare(0x1p53, edge + 1)));
    CHECK(std::is_eq(compare(edge, 0x1p53)));
    CHECK(std::is_lt(compare(most, 0x1p63)));
    CHECK(std::is_eq(compare(least, -0x1p63)));
    CHECK(std::is_gt(compare(least, -0x1.0000000000001p63)));
    CHECK(std::is_lt(compare(std::int64_t{-1}, -0.5)));
    CHECK(std::is_gt(compare(std::int64_t{0}, -0.5)));
    CHECK(std::is_eq(compare(std::int64_t{0}, -0.0)));
    CHECK(std::is_eq(compare(true, 1.0)));
    CHECK(std::is_gt(compare(std::numeric_limits<double>::infinity(), most)));
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(std::is_lteq(compare(most, not_a_number)));
    CHECK_FALSE(std::is_gteq(compare(most, not_a_number)));
    CHECK_FALSE(std::is_lteq(compare(not_a_number, most)));
}

TEST_CASE("integers without a sign are compared with all others by what they are") {
    constexpr std::uint64_t edge = std::uint64_t{1} << 63, most = 2 * edge - 1;
    CHECK(std::is_gt(compare(most, std::int64_t{-1})));
    CHECK(std::is_gt(compare(most, std::numeric_limits<std::int64_t>::max())));
    CHECK(std::is_eq(compare(std::uint64_t{5}, std::int64_t{5})));
    CHECK(std::is_eq(compare(edge, 0x1p63)));
    CHECK(std::is_gt(compare(edge + 1, 0x1p63)));
    CHECK(std::is_lt(compare(most, 0x1p64)));
    CHECK(std::is_lt(compare(std::int64_t{-1}, std::uint64_t{0})));
}

TEST_CASE("a whole number is a value of the types that have it") {
    constexpr Wide edge = Wide{1} << 63;
    CHECK(whole_value(-1, Type::unsigned_integer) == std::nullopt);
    CHECK(whole_value(-1, Type::integer) == Value(std::int64_t{-1}));
    CHECK(whole_value(edge, Type::integer) == std::nullopt);
    CHECK(whole_value(edge, Type::unsigned_integer) == Value(std::uint64_t{1} << 63));
    CHECK(whole_value(2 * edge, Type::unsigned_integer) == std::nullopt);
    CHECK(whole(Value(std::uint64_t{1} << 63)) == edge);
    CHECK(whole(Value(true)) == Wide{1});
    CHECK(whole(Value(1.0)) == std::nullopt);
}

TEST_CASE("the order of random values is that of the numbers they stand for") {
    std::mt19937_64 random(1);
    const auto near = [&](std::int64_t number) -> Value {
        const std::uint64_t moved = static_cast<std::uint64_t>(number) + random() % 3 - 1;
        if (random() % 3 == 0) return static_cast<std::int64_t>(moved);
        if (random() % 3 == 0) return moved;
        return static_cast<double>(number);
    };
    // 64 bits of mantissa hold both exactly.
    static_assert(std::numeric_limits<long double>::digits >= 64);
    const auto exact = [](const Value& value) {
        return std::visit([](auto v) { return static_cast<long double>(v); }, value);
    };
    for (int i = 0; i < 100'000; ++i) {
        const auto number = static_cast<std::int64_t>(random()) >> (random() % 64);
        const Value a = near(number), b = near(number);
        INFO(format(a) << " and " << format(b));
        REQUIRE((compare(a, b) == (exact(a) <=> exact(b))));
    }
}

TEST_CASE("as a real, true is 1 and an integer is itself") {
    CHECK(as_real(true) == 1);
    CHECK(as_real(false) == 0);
    CHECK(as_real(std::int64_t{-4}) == -4);
    CHECK(as_real(0.25) == 0.25);
}
