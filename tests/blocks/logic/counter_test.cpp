#include "blocks/logic/counter.hpp"

#include <catch2/catch.hpp>

#include "tests/blocks/logic/scan_table.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

TEST_CASE("ctu counts up as in the standard") {
    check_tables("ctu", Calls::once_and_twice,
                 {
                     {"rising edges only", R"(
    cu  r  pv  | q  cv
    0   0  2   | 0  0
    1   .  .   | 0  1
    1   .  .   | 0  1
    0   .  .   | 0  1
    1   .  .   | 1  2
    0   .  .   | 1  2
    1   .  .   | 1  3  )"},
                     {"true at the first scan is an edge", R"(
    cu  r  pv  | q  cv
    1   0  1   | 1  1
    1   .  .   | 1  1  )"},
                     {"reset dominates", R"(
    cu  r  pv  | q  cv
    1   0  1   | 1  1
    0   1  .   | 0  0
    1   1  .   | 0  0
    0   0  .   | 0  0
    1   0  .   | 1  1  )"},
                     {"an edge during reset is not counted later", R"(
    cu  r  pv  | q  cv
    0   1  1   | 0  0
    1   1  .   | 0  0
    1   0  .   | 0  0
    0   0  .   | 0  0
    1   0  .   | 1  1  )"},
                     {"pv = 0 and below: q without a count, and with reset", R"(
    cu  r  pv  | q  cv
    0   0  0   | 1  0
    0   0  -5  | 1  0
    0   1  .   | 1  0  )"},
                     {"pv changed while counting", R"(
    cu  r  pv  | q  cv
    1   0  3   | 0  1
    0   .  1   | 1  1
    0   .  2   | 0  1
    1   .  .   | 1  2  )"},
                     {"a pv beyond an int is never reached", R"(
    cu  r  pv     | q  cv
    1   0  32768  | 0  1 )"},
                     {"a pv that a lint alone holds", R"(
    data_type  cu  r  pv                   | q  cv
    lint       1   0  9223372036854775807  | 0  1  )"},
                 });
}

TEST_CASE("a counter stops at the limits of its type") {
    struct Limits {
        CounterType type;
        std::int64_t least, most;
    };
    constexpr Limits all[] = {{CounterType::int_, -32768, 32767},
                              {CounterType::sint, -128, 127},
                              {CounterType::usint, 0, 255},
                              {CounterType::uint, 0, 65535}};
    for (const auto& [type, least, most] : all) {
        Ctud counter;
        counter.data_type = type;
        const auto scan = [&](bool up, bool down) {
            counter.cu = up, counter.cd = down;
            counter.scan({});
        };
        counter.cv = most - 1;
        for (int i = 0; i < 3; ++i) scan(true, false), scan(false, false);
        CHECK(counter.cv == most);
        counter.cv = least + 1;
        for (int i = 0; i < 3; ++i) scan(false, true), scan(false, false);
        CHECK(counter.cv == least);
    }
}

TEST_CASE("ctd counts down as in the standard") {
    check_tables("ctd", Calls::once_and_twice,
                 {
                     {"from the start: q, and below 0", R"(
    cd  ld  pv  | q  cv
    0   0   2   | 1  0
    1   .   .   | 1  -1
    0   .   .   | 1  -1
    1   .   .   | 1  -2  )"},
                     {"load, then edges", R"(
    cd  ld  pv  | q  cv
    0   1   2   | 0  2
    0   0   .   | 0  2
    1   .   .   | 0  1
    1   .   .   | 0  1
    0   .   .   | 0  1
    1   .   .   | 1  0
    0   .   .   | 1  0   )"},
                     {"true at the first scan is an edge", R"(
    cd  ld  pv  | q  cv
    1   0   2   | 1  -1  )"},
                     {"load dominates", R"(
    cd  ld  pv  | q  cv
    1   1   2   | 0  2
    0   1   .   | 0  2
    1   1   .   | 0  2   )"},
                     {"an edge during load is not counted later", R"(
    cd  ld  pv  | q  cv
    0   1   2   | 0  2
    1   1   .   | 0  2
    1   0   .   | 0  2
    0   0   .   | 0  2
    1   0   .   | 0  1   )"},
                     {"pv is read while ld is true", R"(
    cd  ld  pv  | q  cv
    0   1   2   | 0  2
    0   1   5   | 0  5
    0   0   9   | 0  5   )"},
                     {"load of 0 and below", R"(
    cd  ld  pv  | q  cv
    0   1   0   | 1  0
    0   1   -3  | 1  -3  )"},
                     {"a pv beyond the type is loaded as its limit", R"(
    data_type  cd  ld  pv           | q  cv
    int        0   1   32768        | 0  32767
    int        0   1   -32769       | 1  -32768
    dint       0   1   2147483648   | 0  2147483647
    dint       0   1   -2147483649  | 1  -2147483648 )"},
                     {"the lower limit holds", R"(
    data_type  cd  ld  pv                     | q  cv
    int        0   1   -32767                 | 1  -32767
    int        1   0   .                      | 1  -32768
    int        0   0   .                      | 1  -32768
    int        1   0   .                      | 1  -32768
    dint       0   1   -2147483648            | 1  -2147483648
    dint       1   0   .                      | 1  -2147483648
    lint       0   1   -9223372036854775807   | 1  -9223372036854775807
    lint       1   0   .                      | 1  -9223372036854775808
    lint       0   0   .                      | 1  -9223372036854775808
    lint       1   0   .                      | 1  -9223372036854775808 )"},
                 });
}

TEST_CASE("ctud counts both ways as in the standard") {
    check_tables("ctud", Calls::once_and_twice,
                 {
                     {"up", R"(
    cu  cd  r  ld  pv  | qu  qd  cv
    0   0   0  0   2   | 0   1   0
    1   .   .  .   .   | 0   0   1
    0   .   .  .   .   | 0   0   1
    1   .   .  .   .   | 1   0   2
    1   .   .  .   .   | 1   0   2  )"},
                     {"down", R"(
    cu  cd  r  ld  pv  | qu  qd  cv
    0   0   0  1   2   | 1   0   2
    0   1   0  0   .   | 0   0   1
    0   1   0  0   .   | 0   0   1
    0   0   0  0   .   | 0   0   1
    0   1   0  0   .   | 0   1   0
    0   0   0  0   .   | 0   1   0
    0   1   0  0   .   | 0   1   -1 )"},
                     {"both edges in one scan change nothing", R"(
    cu  cd  r  ld  pv  | qu  qd  cv
    1   1   0  0   2   | 0   1   0
    0   0   .  .   .   | 0   1   0
    1   0   .  .   .   | 0   0   1
    1   1   .  .   .   | 0   1   0  )"},
                     {"reset dominates all", R"(
    cu  cd  r  ld  pv  | qu  qd  cv
    0   0   0  1   2   | 1   0   2
    1   0   1  1   .   | 0   1   0
    1   0   0  0   .   | 0   1   0  )"},
                     {"load dominates the edges", R"(
    cu  cd  r  ld  pv  | qu  qd  cv
    1   0   0  1   5   | 1   0   5
    1   0   0  0   .   | 1   0   5
    0   1   0  1   .   | 1   0   5
    0   1   0  0   .   | 1   0   5  )"},
                     {"true at the first scan is an edge", R"(
    cu  cd  r  ld  pv  | qu  qd  cv
    1   0   0  0   1   | 1   0   1  )"},
                     {"the limits hold", R"(
    cu  cd  r  ld  pv      | qu  qd  cv
    0   0   0  1   32766   | 1   0   32766
    1   0   0  0   .       | 1   0   32767
    0   0   0  0   .       | 1   0   32767
    1   0   0  0   .       | 1   0   32767
    0   0   0  1   -32767  | 1   1   -32767
    0   1   0  0   .       | 0   1   -32768
    0   0   0  0   .       | 0   1   -32768
    0   1   0  0   .       | 0   1   -32768 )"},
                     {"a dint goes on where an int ends", R"(
    data_type  cu  cd  r  ld  pv          | qu  qd  cv
    dint       0   0   0  1   32767       | 1   0   32767
    dint       1   0   0  0   .           | 1   0   32768
    dint       0   0   0  1   2147483646  | 1   0   2147483646
    dint       1   0   0  0   .           | 1   0   2147483647
    dint       0   0   0  0   .           | 1   0   2147483647
    dint       1   0   0  0   .           | 1   0   2147483647 )"},
                     {"pv changed while counting", R"(
    cu  cd  r  ld  pv  | qu  qd  cv
    1   0   0  0   3   | 0   0   1
    0   .   .  .   1   | 1   0   1
    0   .   .  .   2   | 0   0   1  )"},
                 });
}

TEST_CASE("a counter stops at the upper limit of its type and counts on after a reset") {
    Ctu counter;
    counter.pv = 32767;
    const auto edge = [&] {
        counter.cu = false;
        counter.scan({});
        counter.cu = true;
        counter.scan({});
    };
    for (int i = 1; i < 32767; ++i) {
        edge();
        REQUIRE(counter.cv == i);
        REQUIRE_FALSE(counter.q);
    }
    for (int i = 0; i < 3; ++i) {
        edge();
        CHECK(counter.cv == 32767);
        CHECK(counter.q);
    }
    counter.r = true;
    edge();
    CHECK(counter.cv == 0);
    counter.r = false;
    edge();
    CHECK(counter.cv == 1);
}
