#include "blocks/logic/timer.hpp"

#include <optional>

#include <catch2/catch.hpp>

#include "runtime/model/random.hpp"
#include "tests/blocks/logic/scan_table.hpp"
#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

TEST_CASE("ton follows the timing diagram of the standard") {
    check_tables("ton", Calls::once_and_twice,
                 {
                     {"in longer than pt", R"(
    time   in  pt   | q  et
    0ms    0   5ms  | 0  0
    1ms    1   .    | 0  0
    5ms    1   .    | 0  4ms
    6ms    1   .    | 1  5ms
    7ms    1   .    | 1  5ms
    8ms    0   .    | 0  0   )"},
                     {"in shorter than pt", R"(
    time   in  pt   | q  et
    0ms    1   5ms  | 0  0
    4ms    1   .    | 0  4ms
    5ms    0   .    | 0  0
    6ms    1   .    | 0  0
    10ms   1   .    | 0  4ms
    11ms   1   .    | 1  5ms )"},
                     {"scans of 3 ms do not divide 10 ms", R"(
    time   in  pt    | q  et
    0ms    0   10ms  | 0  0
    3ms    1   .     | 0  0
    6ms    1   .     | 0  3ms
    9ms    1   .     | 0  6ms
    12ms   1   .     | 0  9ms
    15ms   1   .     | 1  10ms
    18ms   1   .     | 1  10ms
    21ms   0   .     | 0  0    )"},
                     {"a nanosecond decides", R"(
    time        in  pt    | q  et
    7ns         1   10ms  | 0  0
    10ms+6ns    1   .     | 0  9999999ns
    10ms+7ns    1   .     | 1  10ms )"},
                     {"pt = 0", R"(
    time   in  pt   | q  et
    0ms    0   0    | 0  0
    1ms    1   0    | 1  0
    2ms    1   0    | 1  0
    3ms    0   0    | 0  0   )"},
                     {"pt < 0", R"(
    time   in  pt    | q  et
    0ms    1   -5ms  | 1  0
    1ms    1   .     | 1  0
    2ms    0   .     | 0  0   )"},
                     {"pt grows while time runs", R"(
    time   in  pt    | q  et
    0ms    1   5ms   | 0  0
    4ms    1   .     | 0  4ms
    5ms    1   8ms   | 0  5ms
    7ms    1   .     | 0  7ms
    8ms    1   .     | 1  8ms )"},
                     {"pt falls below et while time runs", R"(
    time   in  pt    | q  et
    0ms    1   9ms   | 0  0
    4ms    1   .     | 0  4ms
    5ms    1   3ms   | 1  3ms
    6ms    1   .     | 1  3ms )"},
                     {"pt has no effect after its end, before the next start", R"(
    time   in  pt    | q  et
    0ms    1   2ms   | 0  0
    3ms    1   .     | 1  2ms
    4ms    1   9ms   | 1  2ms
    5ms    0   .     | 0  0
    6ms    1   .     | 0  0
    14ms   1   .     | 0  8ms
    15ms   1   .     | 1  9ms )"},
                     {"100 days in scans of 1 ms", R"(
    time        in  pt     | q  et
    1ms         1   2400h  | 0  0
    2400h       1   .      | 0  8639999999ms
    2400h+1ms   1   .      | 1  2400h
    2400h+2ms   1   .      | 1  2400h )"},
                     {"5 ms after 100 days, in scans of 2 ms", R"(
    time        in  pt     | q  et
    2400h       0   5ms    | 0  0
    2400h+2ms   1   .      | 0  0
    2400h+4ms   1   .      | 0  2ms
    2400h+6ms   1   .      | 0  4ms
    2400h+8ms   1   .      | 1  5ms
    2400h+10ms  0   .      | 0  0  )"},
                     {"two scans at one instant", R"(
    time   in  pt   | q  et
    0ms    1   1ms  | 0  0
    0ms    1   .    | 0  0
    1ms    1   .    | 1  1ms
    1ms    0   .    | 0  0
    1ms    1   .    | 0  0
    2ms    1   .    | 1  1ms )"},
                 });
}

TEST_CASE("tof follows the timing diagram of the standard") {
    check_tables("tof", Calls::once_and_twice,
                 {
                     {"never on", R"(
    time   in  pt   | q  et
    0ms    0   5ms  | 0  0
    9ms    0   .    | 0  0   )"},
                     {"off longer than pt", R"(
    time   in  pt   | q  et
    0ms    0   5ms  | 0  0
    1ms    1   .    | 1  0
    2ms    0   .    | 1  0
    6ms    0   .    | 1  4ms
    7ms    0   .    | 0  5ms
    8ms    0   .    | 0  5ms
    9ms    1   .    | 1  0   )"},
                     {"off shorter than pt", R"(
    time   in  pt   | q  et
    0ms    1   5ms  | 1  0
    1ms    0   .    | 1  0
    5ms    0   .    | 1  4ms
    6ms    1   .    | 1  0
    7ms    0   .    | 1  0
    11ms   0   .    | 1  4ms
    12ms   0   .    | 0  5ms )"},
                     {"scans of 3 ms do not divide 10 ms", R"(
    time   in  pt    | q  et
    0ms    1   10ms  | 1  0
    3ms    0   .     | 1  0
    12ms   0   .     | 1  9ms
    15ms   0   .     | 0  10ms
    18ms   0   .     | 0  10ms )"},
                     {"pt = 0", R"(
    time   in  pt   | q  et
    0ms    1   0    | 1  0
    1ms    0   0    | 0  0
    2ms    1   0    | 1  0   )"},
                     {"pt < 0", R"(
    time   in  pt    | q  et
    0ms    1   -1ms  | 1  0
    1ms    0   .     | 0  0  )"},
                     {"pt grows while time runs", R"(
    time   in  pt    | q  et
    0ms    1   5ms   | 1  0
    1ms    0   .     | 1  0
    5ms    0   8ms   | 1  4ms
    8ms    0   .     | 1  7ms
    9ms    0   .     | 0  8ms )"},
                     {"pt falls below et while time runs", R"(
    time   in  pt    | q  et
    0ms    1   9ms   | 1  0
    1ms    0   .     | 1  0
    5ms    0   3ms   | 0  3ms
    6ms    0   9ms   | 0  3ms )"},
                     {"100 days in scans of 1 ms", R"(
    time        in  pt     | q  et
    0ms         1   2400h  | 1  0
    1ms         0   .      | 1  0
    2400h       0   .      | 1  8639999999ms
    2400h+1ms   0   .      | 0  2400h )"},
                     {"5 ms after 100 days, in scans of 2 ms", R"(
    time        in  pt     | q  et
    2400h       1   5ms    | 1  0
    2400h+2ms   0   .      | 1  0
    2400h+6ms   0   .      | 1  4ms
    2400h+8ms   0   .      | 0  5ms )"},
                 });
}

TEST_CASE("tp follows the timing diagram of the standard") {
    check_tables("tp", Calls::once_and_twice,
                 {
                     {"in longer than the pulse", R"(
    time   in  pt   | q  et
    0ms    0   5ms  | 0  0
    1ms    1   .    | 1  0
    5ms    1   .    | 1  4ms
    6ms    1   .    | 0  5ms
    9ms    1   .    | 0  5ms
    10ms   0   .    | 0  0   )"},
                     {"in shorter than the pulse", R"(
    time   in  pt   | q  et
    0ms    1   5ms  | 1  0
    1ms    0   .    | 1  1ms
    4ms    0   .    | 1  4ms
    5ms    0   .    | 0  0   )"},
                     {"not retriggerable", R"(
    time   in  pt   | q  et
    0ms    1   5ms  | 1  0
    1ms    0   .    | 1  1ms
    2ms    1   .    | 1  2ms
    3ms    0   .    | 1  3ms
    4ms    1   .    | 1  4ms
    5ms    1   .    | 0  5ms
    6ms    1   .    | 0  5ms
    7ms    0   .    | 0  0
    8ms    1   .    | 1  0   )"},
                     {"an edge in the scan that ends the pulse is lost", R"(
    time   in  pt   | q  et
    0ms    1   2ms  | 1  0
    1ms    0   .    | 1  1ms
    2ms    1   .    | 0  2ms
    3ms    1   .    | 0  2ms
    4ms    0   .    | 0  0
    5ms    1   .    | 1  0   )"},
                     {"scans of 3 ms do not divide 10 ms", R"(
    time   in  pt    | q  et
    0ms    0   10ms  | 0  0
    3ms    1   .     | 1  0
    12ms   1   .     | 1  9ms
    15ms   1   .     | 0  10ms
    18ms   0   .     | 0  0   )"},
                     {"pt = 0 and below: no pulse", R"(
    time   in  pt    | q  et
    0ms    1   0     | 0  0
    1ms    0   .     | 0  0
    2ms    1   -1ms  | 0  0
    3ms    1   5ms   | 0  0
    4ms    0   .     | 0  0
    5ms    1   .     | 1  0   )"},
                     {"pt grows while time runs", R"(
    time   in  pt    | q  et
    0ms    1   5ms   | 1  0
    4ms    0   8ms   | 1  4ms
    7ms    0   .     | 1  7ms
    8ms    1   .     | 0  8ms )"},
                     {"pt falls below et while time runs", R"(
    time   in  pt    | q  et
    0ms    1   9ms   | 1  0
    5ms    1   3ms   | 0  3ms
    6ms    1   9ms   | 0  3ms
    7ms    0   .     | 0  0   )"},
                     {"100 days in scans of 1 ms", R"(
    time        in  pt     | q  et
    1ms         1   2400h  | 1  0
    2ms         0   .      | 1  1ms
    2400h       0   .      | 1  8639999999ms
    2400h+1ms   0   .      | 0  0   )"},
                     {"5 ms after 100 days, in scans of 2 ms", R"(
    time        in  pt   | q  et
    2400h       0   5ms  | 0  0
    2400h+2ms   1   .    | 1  0
    2400h+6ms   1   .    | 1  4ms
    2400h+8ms   1   .    | 0  5ms )"},
                 });
}

namespace {

/// Scans of any distance, up to 100 days after the start, with a new pt now and then.
struct Hazard {
    Random random;
    Scan now;
    bool in = false;
    std::int64_t pt = 5 * millisecond;

    explicit Hazard(std::uint64_t seed) : random(seed, "timer") {
        now.time = static_cast<std::int64_t>(random.next() % 8'640'000'000'000'000);
    }
    void next() {
        now.time += static_cast<std::int64_t>(random.next() % 3'000'001);
        ++now.index;
        if (random.next() % 5 == 0) in = !in;
        if (random.next() % 8 == 0)
            pt = static_cast<std::int64_t>(random.next() % 12'000'000) - millisecond;
    }
};

}  // namespace

TEST_CASE("ton is true when in was true for a pt since its edge, whatever the scans") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        Hazard hazard(seed);
        Ton ton;
        std::optional<std::int64_t> edge;
        bool up = false;
        for (int i = 0; i < 500; ++i, hazard.next()) {
            ton.in = hazard.in;
            ton.pt = hazard.pt;
            ton.scan(hazard.now);
            if (!hazard.in) edge.reset();
            if (hazard.in && !edge) edge = hazard.now.time;
            up = edge && (up || hazard.now.time - *edge >= hazard.pt);
            INFO("seed " << seed << ", scan " << i);
            REQUIRE(ton.q == up);
        }
    }
}

TEST_CASE("tof is ton upside down") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        Hazard hazard(seed);
        Ton ton;
        Tof tof;
        hazard.in = true;
        for (int i = 0; i < 500; ++i, hazard.next()) {
            tof.in = hazard.in;
            ton.in = !hazard.in;
            ton.pt = tof.pt = hazard.pt;
            ton.scan(hazard.now);
            tof.scan(hazard.now);
            INFO("seed " << seed << ", scan " << i);
            REQUIRE(tof.q == !ton.q);
            REQUIRE(tof.et == ton.et);
        }
    }
}

TEST_CASE("tp's pulses begin with an edge and last for a pt") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        Hazard hazard(seed);
        Tp tp;
        bool last_in = false, last_q = false;
        std::int64_t start = 0;
        for (int i = 0; i < 500; ++i, hazard.next()) {
            tp.in = hazard.in;
            tp.pt = hazard.pt;
            tp.scan(hazard.now);
            INFO("seed " << seed << ", scan " << i);
            const bool edge = hazard.in && !last_in;
            if (!last_q) {
                REQUIRE(tp.q == (edge && hazard.pt > 0));
                start = hazard.now.time;
            } else {
                REQUIRE(tp.q == (hazard.now.time - start < hazard.pt));
            }
            if (tp.q) REQUIRE(tp.et == hazard.now.time - start);
            last_in = hazard.in;
            last_q = tp.q;
        }
    }
}
