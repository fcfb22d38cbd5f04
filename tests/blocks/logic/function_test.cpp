#include <string>

#include <catch2/catch.hpp>

#include "blocks/logic/arithmetic.hpp"
#include "runtime/model/random.hpp"
#include "tests/blocks/logic/scan_table.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

TEST_CASE("boolean functions have the truth tables of the standard") {
    check_tables("and", Calls::once_and_twice,
                 {
                     {"two inputs", R"(
    in1 in2 | out
    0   0   | 0
    0   1   | 0
    1   0   | 0
    1   1   | 1 )"},
                     {"eight inputs", R"(
    in1 in2 in3 in4 in5 in6 in7 in8 | out
    1   1   1   1   1   1   1   1   | 1
    1   1   0   1   1   1   1   1   | 0
    1   1   1   0   1   1   1   1   | 0
    1   1   1   1   0   1   1   1   | 0
    1   1   1   1   1   0   1   1   | 0
    1   1   1   1   1   1   0   1   | 0
    1   1   1   1   1   1   1   0   | 0 )"},
                 });
    check_tables("or", Calls::once_and_twice,
                 {
                     {"two inputs", R"(
    in1 in2 | out
    0   0   | 0
    0   1   | 1
    1   0   | 1
    1   1   | 1 )"},
                     {"eight inputs", R"(
    in1 in2 in3 in4 in5 in6 in7 in8 | out
    0   0   0   0   0   0   0   0   | 0
    0   0   1   0   0   0   0   0   | 1
    0   0   0   1   0   0   0   0   | 1
    0   0   0   0   1   0   0   0   | 1
    0   0   0   0   0   1   0   0   | 1
    0   0   0   0   0   0   1   0   | 1
    0   0   0   0   0   0   0   1   | 1 )"},
                 });
    check_tables("xor", Calls::once_and_twice,
                 {
                     {"two inputs", R"(
    in1 in2 | out
    0   0   | 0
    0   1   | 1
    1   0   | 1
    1   1   | 0 )"},
                     {"eight inputs", R"(
    in1 in2 in3 in4 in5 in6 in7 in8 | out
    0   0   1   0   0   0   0   0   | 1
    0   0   1   1   0   0   0   0   | 0
    0   0   1   1   1   0   0   0   | 1
    0   0   1   1   1   1   0   0   | 0
    0   0   1   1   1   1   1   0   | 1
    0   0   1   1   1   1   1   1   | 0 )"},
                 });
    check_tables("not", Calls::once_and_twice, {{"both", "in | out \n 0 | 1 \n 1 | 0 \n 0 | 1"}});
}

TEST_CASE("comparisons are those of the standard, and exact") {
    const auto check = [](std::string_view type, const char* less, const char* equal,
                          const char* greater) {
        const auto row = [](const char* in, const char* out) {
            return std::string(in) + " | " + out + " 0 none\n";
        };
        const std::string rows = "in1 in2 | out error error_id\n" + row("1 2", less) +
                                 row("-2 -1", less) + row("0.1 0.10000000000000002", less) +
                                 row("3 3", equal) + row("-0 0", equal) + row("2 1", greater) +
                                 row("1e300 -1e300", greater) +
                                 row("9007199254740992 9007199254740991", greater);
        check_tables(type, Calls::once_and_twice, {{"order", std::string_view(rows)}});
    };
    check("gt", "0", "0", "1");
    check("ge", "0", "1", "1");
    check("eq", "0", "1", "0");
    check("le", "1", "1", "0");
    check("lt", "1", "0", "0");
    check("ne", "1", "0", "1");
    check_tables("gt", Calls::once_and_twice, {{"no number: out is held", R"(
    in1 in2 | out error error_id
    2   1   | 1   0     none
    nan 1   | 1   1     not_finite
    0   nan | 1   1     not_finite
    0   1   | 0   0     none )"}});
}

TEST_CASE("hysteresis switches at its two limits and stays in between") {
    check_tables("hysteresis", Calls::once_and_twice, {{"up, down, error", R"(
    in    high low | q error error_id
    2     5    1   | 0 0     none
    4.999 .    .   | 0 0     none
    5     .    .   | 1 0     none
    1.001 .    .   | 1 0     none
    1     .    .   | 0 0     none
    3     .    .   | 0 0     none
    6     .    .   | 1 0     none
    3     2    2   | 1 1     wrong_limits
    3     nan  1   | 1 1     not_finite
    3     5    1   | 1 0     none )"}});
}

TEST_CASE("selections are those of the standard") {
    check_tables("sel", Calls::once_and_twice, {{"g", R"(
    g in0 in1 | out error error_id
    0 1   2   | 1   0     none
    1 1   2   | 2   0     none
    1 1   -3  | -3  0     none
    0 nan 2   | -3  1     not_finite
    1 nan 2   | -3  1     not_finite
    1 1   nan | -3  1     not_finite
    1 1   2   | 2   0     none
    0 7   2   | 7   0     none )"}});
    check_tables("mux", Calls::once_and_twice, {{"k", R"(
    k  in0 in1 in2 in3 in4 in5 in6 in7 | out error error_id
    0  10  11  12  13  14  15  16  17  | 10  0     none
    1  .   .   .   .   .   .   .   .   | 11  0     none
    2  .   .   .   .   .   .   .   .   | 12  0     none
    3  .   .   .   .   .   .   .   .   | 13  0     none
    4  .   .   .   .   .   .   .   .   | 14  0     none
    5  .   .   .   .   .   .   .   .   | 15  0     none
    6  .   .   .   .   .   .   .   .   | 16  0     none
    7  .   .   .   .   .   .   .   .   | 17  0     none
    8  .   .   .   .   .   .   .   .   | 17  1     wrong_index
    -1 .   .   .   .   .   .   .   .   | 17  1     wrong_index
    0  .   nan .   .   .   .   .   .   | 17  1     not_finite
    0  .   1   .   .   .   .   .   .   | 10  0     none )"}});
    check_tables("limit", Calls::once_and_twice, {{"inside, outside, crossed", R"(
    mn in  mx  | out error error_id
    0  5   10  | 5   0     none
    0  -1  10  | 0   0     none
    0  11  10  | 10  0     none
    0  0   10  | 0   0     none
    0  10  10  | 10  0     none
    -2 -3  -1  | -2  0     none
    10 5   0   | 0   0     none
    10 nan 0   | 0   1     not_finite )"}});
    check_tables("min", Calls::once_and_twice, {{"order", R"(
    in1 in2 | out error error_id
    1   2   | 1   0     none
    2   1   | 1   0     none
    -1  -2  | -2  0     none
    3   3   | 3   0     none
    -1  1   | -1  0     none
    0   0.5 | 0   0     none
    1   nan | 0   1     not_finite
    nan 1   | 0   1     not_finite )"}});
    check_tables("max", Calls::once_and_twice, {{"order", R"(
    in1 in2 | out error error_id
    1   2   | 2   0     none
    2   1   | 2   0     none
    -1  -2  | -1  0     none
    3   3   | 3   0     none
    -1  1   | 1   0     none
    0   0.5 | 0.5 0     none
    1   nan | 0.5 1     not_finite
    nan 1   | 0.5 1     not_finite )"}});
    check_tables("move_value", Calls::once_and_twice, {{"enabled and held", R"(
    en in  | out error error_id
    0  5   | 0   0     none
    1  5   | 5   0     none
    1  6   | 6   0     none
    0  7   | 6   0     none
    0  nan | 6   1     not_finite
    1  nan | 6   1     not_finite
    0  8   | 6   0     none
    1  -8  | -8  0     none )"}});
}

TEST_CASE("arithmetic holds its output where there is no result") {
    check_tables("add", Calls::once_and_twice, {{"sums", R"(
    in1    in2    | out  error error_id
    1      2      | 3    0     none
    -1     2.5    | 1.5  0     none
    0.5    0.25   | 0.75 0     none
    1e16   1      | 1e16 0     none
    1.7e308 1e308 | 1e16 1     overflow
    nan    1      | 1e16 1     not_finite
    1      nan    | 1e16 1     not_finite
    4      -4     | 0    0     none )"}});
    check_tables("sub", Calls::once_and_twice, {{"differences", R"(
    in1      in2   | out  error error_id
    1        2     | -1   0     none
    2        1     | 1    0     none
    -1       -2.5  | 1.5  0     none
    0        4     | -4   0     none
    -1.7e308 1e308 | -4   1     overflow
    nan      1     | -4   1     not_finite
    1        nan   | -4   1     not_finite
    4        4     | 0    0     none )"}});
    check_tables("mul", Calls::once_and_twice, {{"products", R"(
    in1   in2   | out  error error_id
    3     2     | 6    0     none
    -3    2     | -6   0     none
    -3    -0.5  | 1.5  0     none
    0     5     | 0    0     none
    1e200 1e200 | 0    1     overflow
    nan   1     | 0    1     not_finite
    1     nan   | 0    1     not_finite
    7     1     | 7    0     none )"}});
    check_tables("div", Calls::once_and_twice, {{"quotients", R"(
    in1   in2    | out  error error_id
    3     2      | 1.5  0     none
    -3    2      | -1.5 0     none
    0     2      | 0    0     none
    7     -7     | -1   0     none
    1     0      | -1   1     division_by_zero
    0     0      | -1   1     division_by_zero
    nan   0      | -1   1     not_finite
    1e200 1e-200 | -1   1     overflow
    8     2      | 4    0     none )"}});
    check_tables("mod", Calls::once_and_twice, {{"remainders", R"(
    in1  in2 | out error error_id
    7    3   | 1   0     none
    -7   3   | -1  0     none
    7    -3  | 1   0     none
    6    3   | 0   0     none
    7.5  2   | 1.5 0     none
    7    0   | 1.5 1     division_by_zero
    nan  3   | 1.5 1     not_finite
    1e15 7   | 6   0     none
    2    3   | 2   0     none )"}});
    check_tables("abs", Calls::once_and_twice, {{"signs", R"(
    in     | out   error error_id
    3      | 3     0     none
    -3     | 3     0     none
    0      | 0     0     none
    -0     | 0     0     none
    -0.5   | 0.5   0     none
    nan    | 0.5   1     not_finite
    -1e308 | 1e308 0     none
    1e-308 | 1e-308 0    none )"}});
}

TEST_CASE("mod gives the remainder of the division that drops the fraction") {
    Random random(1, "mod");
    for (int i = 0; i < 10'000; ++i) {
        const auto a = static_cast<std::int64_t>(random.next() % 2'000'001) - 1'000'000;
        const auto b = static_cast<std::int64_t>(random.next() % 2001) - 1000;
        if (b == 0) continue;
        Mod mod;
        mod.in1 = static_cast<double>(a);
        mod.in2 = static_cast<double>(b);
        mod.scan({});
        INFO(a << " mod " << b);
        REQUIRE(mod.out == static_cast<double>(a % b));
    }
}

TEST_CASE("conversions round to the nearest, of two to the even one") {
    check_tables("lreal_to_lint", Calls::once_and_twice, {{"rounding and limits", R"(
    in                   | out                   error error_id
    1.4                  | 1                     0     none
    1.6                  | 2                     0     none
    1.5                  | 2                     0     none
    2.5                  | 2                     0     none
    -1.5                 | -2                    0     none
    -2.5                 | -2                    0     none
    9223372036854774784  | 9223372036854774784   0     none
    9223372036854775807  | 9223372036854774784   1     overflow
    -9223372036854775808 | -9223372036854775808  0     none
    -1e19                | -9223372036854775808  1     overflow
    nan                  | -9223372036854775808  1     not_finite )"}});
    check_tables("lreal_to_time", Calls::once_and_twice, {{"whole ns", R"(
    in        | out          error error_id
    0.1       | 100ms        0     none
    0.001     | 1ms          0     none
    1.5e-9    | 2ns          0     none
    2.5e-9    | 2ns          0     none
    -0.5      | -500ms       0     none
    8640000   | 2400h        0     none
    8388607.999999999 | 2330h+607999999999ns 0 none
    1e10      | 2330h+607999999999ns 1 overflow
    nan       | 2330h+607999999999ns 1 not_finite )"}});
}
