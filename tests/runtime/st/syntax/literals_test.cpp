#include "runtime/st/syntax/literals.hpp"

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

constexpr st::Wide second = 1'000'000'000, hour = 3600 * second, day = 24 * hour;

}  // namespace

TEST_CASE("Structured Text: numbers are read with bases and underscores", "[st]") {
    CHECK(st::read_integer("1_000") == st::Wide{1000});
    CHECK(st::read_integer("16#fF") == st::Wide{255});
    CHECK(st::read_integer("2#1010_0000") == st::Wide{160});
    CHECK(st::read_integer("18446744073709551615") == (st::Wide{1} << 64) - 1);
    for (const char* wrong : {"", "1__0", "_1", "1_", "8#8", "3#1", "18446744073709551616", "1x"})
        CHECK_FALSE(st::read_integer(wrong));
    CHECK(st::read_real("1_000.5") == 1000.5);
    CHECK(st::read_real("1e3") == 1000.0);
    CHECK_FALSE(st::read_real("1e999"));
}

TEST_CASE("Structured Text: durations have their units in order", "[st]") {
    CHECK(st::read_duration("1h2m3.5s") == hour + 123 * second + second / 2);
    CHECK(st::read_duration("-5ms") == st::Wide{-5'000'000});
    CHECK(st::read_duration("1D_2H") == day + 2 * hour);
    CHECK(st::read_duration("0.0000000019s") == st::Wide{1});
    for (const char* wrong : {"", "-", "5", "s", "1s2m", "1.5h2m", "1s1s", "1x", "106752d"})
        CHECK_FALSE(st::read_duration(wrong));
}

TEST_CASE("Structured Text: dates exist and fit into 64 bits", "[st]") {
    CHECK(st::read_date("1970-01-02") == day);
    CHECK(st::read_clock("12:30:15.25") == 12 * hour + 1815 * second + second / 4);
    CHECK(st::read_moment("1970-01-02-01:00") == day + hour);
    CHECK(st::read_moment("1677-09-21-00:12:44"));
    CHECK_FALSE(st::read_moment("1677-09-21-00:12:43"));
    CHECK_FALSE(st::read_date("1677-09-21"));
    for (const char* wrong : {"", "2021-02-29", "2020-13-01", "2020-02", "2020-02-29-", "x-1-1"})
        CHECK_FALSE(st::read_date(wrong));
    for (const char* wrong : {"", "12", "24:00", "12:60", "12:30:15:1", "12:30:60", "-1:00"})
        CHECK_FALSE(st::read_clock(wrong));
    for (const char* wrong : {"", "2020-02-29", "2020-02-29-", "2020-02-29-24:00", "12:30"})
        CHECK_FALSE(st::read_moment(wrong));
}

TEST_CASE("Structured Text: '$' marks what a text cannot have itself", "[st]") {
    CHECK(st::read_text("it$'s $$ $41$N") == "it's $ A\n");
    CHECK(st::read_text("it''s") == "it's");
    CHECK_FALSE(st::read_text("$"));
    CHECK_FALSE(st::read_text("$4"));
    CHECK_FALSE(st::read_text("$x"));
}

TEST_CASE("Structured Text: numbers beyond 64 bits are written in full", "[st]") {
    CHECK(st::to_string(0) == "0");
    CHECK(st::to_string((st::Wide{1} << 64) - 1) == "18446744073709551615");
    CHECK(st::to_string(-(st::Wide{1} << 64)) == "-18446744073709551616");
    CHECK(st::to_string(st::Wide{10'000'000'000'000'000'000U} * 10) == "100000000000000000000");
}
