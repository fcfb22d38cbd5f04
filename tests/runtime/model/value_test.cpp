#include "runtime/model/value.hpp"

#include <array>
#include <limits>

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
    CHECK(format(0.1) == "0.1");
    CHECK(format(1e300) == "1e+300");
}

TEST_CASE("a person reads true, names and units") {
    constexpr std::string_view names[] = {"idle", "run"};
    CHECK(describe(true, Type::boolean, {}, "") == "true");
    CHECK(describe(false, Type::boolean, {}, "") == "false");
    CHECK(describe(std::int64_t{1}, Type::enumeration, names, "") == "run");
    CHECK(describe(std::int64_t{2}, Type::enumeration, names, "") == "2");
    CHECK(describe(std::int64_t{-1}, Type::enumeration, names, "") == "-1");
    CHECK(describe(2.5, Type::real, {}, "mm/s") == "2.5 mm/s");
    CHECK(describe(2.5, Type::real, {}, "") == "2.5");
    CHECK(describe(std::int64_t{7}, Type::integer, {}, "pulse") == "7 pulse");
}

TEST_CASE("as a real, true is 1 and an integer is itself") {
    CHECK(as_real(true) == 1);
    CHECK(as_real(false) == 0);
    CHECK(as_real(std::int64_t{-4}) == -4);
    CHECK(as_real(0.25) == 0.25);
}
