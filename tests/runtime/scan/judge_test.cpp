#include "runtime/scan/judge.hpp"

#include <limits>
#include <random>

#include <catch2/catch.hpp>

#include "tests/runtime/scan/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// The output of task a is its number of scans: 1 at 0 ms, 2 at 2 ms, ... 6 at 10 ms.
struct Counted {
    Bench bench{{{.name = "a", .every = 2}}};

    Expectation expect(double low, double high) {
        return {.text = "the count",
                .signal = bench.output("a"),
                .always = false,
                .at = {},
                .low = low,
                .high = high,
                .wanted = "something else"};
    }
    Expectation at(std::int64_t time, double value) {
        Expectation e = expect(value, value);
        e.at = time * ms;
        return e;
    }
    Expectation always(double low, double high) {
        Expectation e = expect(low, high);
        e.always = true;
        return e;
    }
    Judge judged(std::vector<Expectation> expectations) {
        Judge judge(std::move(expectations));
        judge.finish(bench.run({&judge}));
        return judge;
    }
};

std::int64_t any_integer(std::mt19937_64& random) {
    constexpr std::int64_t ends[] = {std::numeric_limits<std::int64_t>::min(), -1, 0,
                                     std::int64_t{1} << 53,
                                     std::numeric_limits<std::int64_t>::max()};
    const std::int64_t value =
        random() % 4 == 0 ? ends[random() % std::size(ends)] : static_cast<std::int64_t>(random());
    const auto step = static_cast<std::uint64_t>(random() % 3) - 1;
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(value) + step);
}

}  // namespace

TEST_CASE("integers are judged as integers, whatever their size") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 20'000; ++i) {
        const std::int64_t value = any_integer(random);
        const std::int64_t low = random() % 2 == 0 ? value + (value < 0) : any_integer(random);
        const std::int64_t high = random() % 2 == 0 ? value - (value > 0) : any_integer(random);
        Expectation e{.text = {}, .signal = {}, .at = {}, .low = low, .high = high, .wanted = {}};
        e.signal.type = Type::integer;
        e.signal.slot = reinterpret_cast<const std::byte*>(&value);
        Judge judge({e});
        judge.finish({});
        INFO(low << " <= " << value << " <= " << high);
        REQUIRE(judge.ok() == (low <= value && value <= high));
    }
}

TEST_CASE("an expectation at an instant sees what was published at it, and until the next scan") {
    Counted c;
    const Judge judge = c.judged({c.at(4, 3), c.at(5, 3), c.at(4, 2), c.at(0, 1), c.at(10, 6)});
    CHECK(judge.verdicts()[0].ok);
    CHECK(judge.verdicts()[1].ok);
    CHECK_FALSE(judge.verdicts()[2].ok);
    CHECK(judge.verdicts()[2].deviation == "a.output is 3 at 0.004 s; expected something else");
    CHECK(judge.verdicts()[3].ok);
    CHECK(judge.verdicts()[4].ok);
    CHECK(judge.verdicts()[0].deviation.empty());
    CHECK_FALSE(judge.ok());
}

TEST_CASE("an expectation between two scans sees the value before the second") {
    Counted c;
    Expectation just_before = c.at(0, 2);
    just_before.at = 4 * ms - 1;
    CHECK(c.judged({just_before}).ok());
}

TEST_CASE("an expectation at the end sees the last value") {
    Counted c;
    CHECK(c.judged({c.expect(6, 6)}).ok());
    Counted wrong;
    const Judge judge = wrong.judged({wrong.expect(5, 5)});
    CHECK(judge.verdicts()[0].deviation ==
          "a.output is 6 at 0.01 s, scan 5; expected something else");
}

TEST_CASE("an expectation that always holds is judged after each scan, its first failure told") {
    Counted c;
    const Judge judge = c.judged({c.always(1, 6), c.always(0, 3), c.always(2, 9)});
    CHECK(judge.verdicts()[0].ok);
    CHECK(judge.verdicts()[1].deviation ==
          "a.output is 4 at 0.006 s, scan 3; expected something else");
    CHECK(judge.verdicts()[2].deviation == "a.output is 1 at 0 s, scan 0; expected something else");
}

TEST_CASE("an expectation beyond the end of the run has failed") {
    Counted c;
    Judge judge = c.judged({c.at(11, 6), c.at(10, 6), c.at(500, 6)});
    CHECK_FALSE(judge.verdicts()[0].ok);
    CHECK(judge.verdicts()[0].deviation == "the count: the run ended at 0.01 s, before it");
    CHECK(judge.verdicts()[1].ok);
    CHECK_FALSE(judge.verdicts()[2].ok);
    Counted stopped;
    stopped.bench.live("a").flag_at = 1;
    stopped.bench.machine.until = stopped.bench.flag("a");
    judge = stopped.judged({stopped.at(2, 2), stopped.at(3, 2)});
    CHECK(judge.verdicts()[0].ok);
    CHECK_FALSE(judge.verdicts()[1].ok);
}

TEST_CASE("a value that is no number fulfils nothing") {
    double value = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    Expectation e{.text = {},
                  .signal = {.name = "x",
                             .unit = {},
                             .names = {},
                             .slot = reinterpret_cast<std::byte*>(&value)},
                  .always = false,
                  .at = {},
                  .low = -infinite,
                  .high = infinite,
                  .wanted = "a number"};
    Judge judge({e});
    judge.finish({});
    CHECK_FALSE(judge.ok());
}

TEST_CASE("a signal from outside is judged after each instant") {
    bool input = false;
    Expectation e{.text = {},
                  .signal = {.name = "inputs.go",
                             .type = Type::boolean,
                             .unit = {},
                             .names = {},
                             .slot = reinterpret_cast<std::byte*>(&input)},
                  .always = true,
                  .at = {},
                  .low = 0,
                  .high = 0,
                  .wanted = "false"};
    Judge judge({e});
    judge.settled(0, ms);
    CHECK(judge.ok());
    input = true;
    judge.settled(ms, 2 * ms);
    CHECK(judge.verdicts()[0].deviation == "inputs.go is true at 0.001 s; expected false");
}

TEST_CASE("a task that never ran is told as such, not as a scan before the first") {
    Bench bench({{.name = "a", .every = 2, .offset = 50}});
    Judge judge({{.text = "the count",
                  .signal = bench.output("a"),
                  .always = false,
                  .at = {},
                  .low = 1,
                  .high = 1,
                  .wanted = "1"}});
    judge.finish(bench.run({&judge}));
    CHECK(judge.verdicts()[0].deviation ==
          "a.output is 0 at 0.01 s, before the first scan; expected 1");
}
