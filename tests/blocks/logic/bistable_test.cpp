#include "blocks/logic/bistable.hpp"

#include <catch2/catch.hpp>

#include "tests/blocks/logic/scan_table.hpp"

using namespace lineshaft::test;

TEST_CASE("sr remembers, and set dominates") {
    check_tables(
        "sr", Calls::once_and_twice,
        {
            {"from q1 = false", R"(
    s1  r  | q1
    0   0  | 0
    0   1  | 0
    1   1  | 1 )"},
            {"all four inputs, from q1 = true", R"(
    s1  r  | q1
    1   0  | 1
    0   0  | 1
    1   0  | 1
    1   1  | 1
    0   1  | 0
    0   0  | 0
    1   1  | 1
    0   0  | 1 )"},
            {"set at the first scan", "s1 r | q1 \n 1 0 | 1 \n 0 0 | 1"},
            {"both at the first scan", "s1 r | q1 \n 1 1 | 1 \n 0 1 | 0"},
            {"reset at the first scan", "s1 r | q1 \n 0 1 | 0 \n 0 0 | 0"},
            {"a set of one scan stays", "s1 r | q1 \n 1 0 | 1 \n 0 0 | 1 \n 0 0 | 1"},
            {"a reset of one scan stays", "s1 r | q1 \n 1 0 | 1 \n 0 1 | 0 \n 0 0 | 0 \n 0 0 | 0"},
            {"set held against reset", "s1 r | q1 \n 1 1 | 1 \n 1 1 | 1 \n 0 1 | 0 \n 1 1 | 1"},
        });
}

TEST_CASE("rs remembers, and reset dominates") {
    check_tables(
        "rs", Calls::once_and_twice,
        {
            {"from q1 = false", R"(
    s  r1  | q1
    0  0   | 0
    0  1   | 0
    1  1   | 0
    1  0   | 1 )"},
            {"all four inputs, from q1 = true", R"(
    s  r1  | q1
    1  0   | 1
    0  0   | 1
    1  0   | 1
    1  1   | 0
    1  0   | 1
    0  1   | 0
    0  0   | 0 )"},
            {"set at the first scan", "s r1 | q1 \n 1 0 | 1 \n 0 0 | 1"},
            {"both at the first scan", "s r1 | q1 \n 1 1 | 0 \n 1 0 | 1"},
            {"reset at the first scan", "s r1 | q1 \n 0 1 | 0 \n 0 0 | 0"},
            {"a set of one scan stays", "s r1 | q1 \n 1 0 | 1 \n 0 0 | 1 \n 0 0 | 1"},
            {"a reset of one scan stays", "s r1 | q1 \n 1 0 | 1 \n 0 1 | 0 \n 0 0 | 0 \n 0 0 | 0"},
            {"reset held against set", "s r1 | q1 \n 1 0 | 1 \n 1 1 | 0 \n 1 1 | 0 \n 1 0 | 1"},
        });
}
