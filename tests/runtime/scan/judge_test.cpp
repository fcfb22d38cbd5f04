#include "runtime/scan/judge.hpp"

#include <array>
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
                .low = low,
                .high = high,
                .wanted = "something else"};
    }
    Expectation at(std::int64_t time, double value) {
        Expectation e = expect(value, value);
        e.when = Expectation::When::at;
        e.from = time * ms;
        return e;
    }
    Expectation always(double low, double high) {
        Expectation e = expect(low, high);
        e.when = Expectation::When::always;
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
        Expectation e{.text = {}, .signal = {}, .low = low, .high = high, .wanted = {}};
        e.signal.type = Type::integer;
        e.signal.slot = reinterpret_cast<const std::byte*>(&value);
        Judge judge({e});
        judge.finish({});
        INFO(low << " <= " << value << " <= " << high);
        REQUIRE(judge.ok() == (low <= value && value <= high));
    }
}

TEST_CASE("an integer without a sign is judged by what it is, and told so") {
    constexpr std::uint64_t value = std::numeric_limits<std::uint64_t>::max();
    Expectation e{.text = {}, .signal = {}, .low = value, .high = value, .wanted = "it"};
    e.signal.name = "a.n";
    e.signal.type = Type::unsigned_integer;
    e.signal.slot = reinterpret_cast<const std::byte*>(&value);
    Expectation other = e;
    other.low = other.high = std::int64_t{-1};
    Judge judge({e, other});
    judge.finish({});
    CHECK(judge.verdicts()[0].ok);
    CHECK(judge.verdicts()[1].deviation == "a.n is 18446744073709551615 at 0 s; expected it");
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
    just_before.from = 4 * ms - 1;
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
    CHECK(judge.verdicts()[0].deviation ==
          "a.output at 0.011 s is undecided: the run ended at 0.01 s; let it run longer");
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
                  .when = Expectation::When::always,
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
    Judge judge(
        {{.text = "the count", .signal = bench.output("a"), .low = 1, .high = 1, .wanted = "1"}});
    judge.finish(bench.run({&judge}));
    CHECK(judge.verdicts()[0].deviation ==
          "a.output is 0 at 0.01 s, before the first scan; expected 1");
}

namespace {

/// What stood in three booleans at each look: those of task 0 and 1 after their scans, the third,
/// from outside, once an instant.
struct Seen {
    std::int64_t time = 0;
    int task = -1;
    bool value = false;
};

/// A run of random instants, in which tasks scan in any order and as often as they like, and the
/// judge of it.
struct RandomRun {
    explicit RandomRun(std::uint64_t seed) : random(seed) {}

    Expectation expect(Expectation::When when, int signal, int cause) {
        Expectation e{.text = "e", .signal = named(signal), .when = when, .wanted = "w"};
        if (when == Expectation::When::answered) e.cause = named(cause);
        if (when == Expectation::When::answered) e.until = below(8);
        if (when == Expectation::When::always && below(2) == 0) {
            e.from = below(30);
            e.until = e.from + below(10);
        }
        if (when == Expectation::When::at) e.from = below(50);
        e.low = when == Expectation::When::counted ? below(4) : below(2);
        e.high = as_real(e.low) + static_cast<double>(below(2));
        return e;
    }

    /// Draws what happens.
    void draw() {
        auto values = levels;
        std::int64_t time = 0;
        for (int instants = 1 + static_cast<int>(below(12)); instants > 0; --instants) {
            for (auto n = below(4); n > 0; --n) {
                const auto task = static_cast<std::size_t>(below(2));
                if (below(2) == 0) values[task] = !values[task];
                seen.push_back({time, static_cast<int>(task), values[task]});
            }
            if (below(3) == 0) values[2] = !values[2];
            seen.push_back({time, -1, values[2]});
            time += 1 + below(8);
            ends.push_back(time);
        }
    }

    /// The first instants of it, at most all; one that stops within an instant has not seen its
    /// last scans. Gives when it ended.
    std::int64_t play(Judge& judge, std::size_t instants, Outcome outcome = Outcome::completed) {
        levels = begin;
        judge.begin();
        RunResult result;
        result.outcome = outcome;
        result.scans = {0, 0};
        std::size_t done = 0;
        for (const Seen& look : seen) {
            levels[look.task < 0 ? 2 : static_cast<std::size_t>(look.task)] = look.value;
            const bool breaks_off = outcome == Outcome::block_error && done + 1 == instants;
            if (look.task >= 0) {
                auto& scan = result.scans[static_cast<std::size_t>(look.task)];
                judge.scanned(look.task, {.time = look.time, .index = scan++});
            }
            if (look.task >= 0 && !breaks_off) continue;
            result.time = breaks_off ? look.time : ends[done] - 1;
            judge.settled(look.time, result.time + 1);
            if (++done == instants) break;
        }
        judge.finish(result);
        return result.time;
    }

    std::int64_t below(std::uint64_t limit) { return static_cast<std::int64_t>(random() % limit); }

    std::array<bool, 3> levels{}, begin{};
    std::vector<Seen> seen;
    std::vector<std::int64_t> ends;  ///< of the instants: when the next one begins

  private:
    Signal named(int i) {
        const auto n = static_cast<std::size_t>(i);
        return {.name = "s",
                .type = Type::boolean,
                .unit = {},
                .names = {},
                .slot = reinterpret_cast<const std::byte*>(&levels[n]),
                .task = i == 2 ? -1 : i};
    }

    std::mt19937_64 random;
};

/// Judges by looking at all that was seen, again and again.
struct SlowJudge {
    const RandomRun& run;

    static std::size_t of(const Signal& s) {
        return s.task < 0 ? 2 : static_cast<std::size_t>(s.task);
    }
    std::int64_t end() const { return run.ends.back() - 1; }
    /// After all that was seen until `time`, included.
    bool level(const Signal& s, std::int64_t time) const {
        bool value = run.begin[of(s)];
        for (const Seen& look : run.seen)
            if (look.task == s.task && look.time <= time) value = look.value;
        return value;
    }
    /// Instants at which it rises, each as often as it does.
    std::vector<std::int64_t> edges(const Signal& s) const {
        std::vector<std::int64_t> times;
        bool last = run.begin[of(s)];
        for (const Seen& look : run.seen) {
            if (look.task != s.task) continue;
            if (look.value && !last) times.push_back(look.time);
            last = look.value;
        }
        return times;
    }
    bool within(const Expectation& e, double value) const {
        return value >= as_real(e.low) && value <= as_real(e.high);
    }
    bool answered(const Expectation& e, std::int64_t from) const {
        const std::int64_t until = from + e.until;
        if (level(e.signal, from)) return true;
        return std::ranges::any_of(run.seen, [&](const Seen& look) {
            return look.task == e.signal.task && look.value && look.time >= from &&
                   look.time <= until;
        });
    }
    bool operator()(const Expectation& e) const {
        using enum Expectation::When;
        if (e.when == at_end) return within(e, level(e.signal, end()));
        if (e.when == at) return e.from <= end() && within(e, level(e.signal, e.from));
        if (e.when == counted) return within(e, static_cast<double>(edges(e.signal).size()));
        if (e.when == answered) {
            const auto times = edges(*e.cause);
            return !times.empty() &&
                   std::ranges::all_of(times, [&](auto t) { return this->answered(e, t); });
        }
        const bool bounded = e.until != never;
        if (bounded && e.until > end()) return false;
        if (bounded && !within(e, level(e.signal, e.from))) return false;
        return std::ranges::all_of(run.seen, [&](const Seen& look) {
            const bool meant =
                look.task == e.signal.task && look.time >= e.from && look.time <= e.until;
            return !meant || within(e, look.value) != (e.when == Expectation::When::excluded);
        });
    }
};

}  // namespace

TEST_CASE("each way to expect is judged as by one who looks at all of the run") {
    for (std::uint64_t seed = 1; seed <= 20'000; ++seed) {
        RandomRun run(seed);
        const auto when = static_cast<Expectation::When>(run.below(6));
        const int signal = static_cast<int>(run.below(3));
        const int cause = static_cast<int>(run.below(3));
        const Expectation e = run.expect(when, signal, cause);
        run.draw();
        Judge judge({e});
        run.play(judge, run.ends.size());
        INFO("seed " << seed << ", kind " << static_cast<int>(when) << ": "
                     << judge.verdicts()[0].deviation);
        REQUIRE(judge.ok() == SlowJudge{run}(e));
        REQUIRE(judge.ok() == judge.verdicts()[0].deviation.empty());
    }
}

namespace {

/// Whether what was ok of a shorter run may not be of a longer one: these are of the run so far.
bool is_of_the_time_so_far(const Expectation& e) {
    using enum Expectation::When;
    const bool is_whole = e.from == 0 && e.until == never;
    if (e.when == counted) return as_real(e.high) < std::numeric_limits<double>::infinity();
    return e.when == at_end || e.when == answered || e.when == excluded ||
           (e.when == always && is_whole);
}

}  // namespace

TEST_CASE("what is ok when a run is cut stays so, unless it is of the time so far") {
    using enum Outcome;
    std::array<int, 6> kept{};  // per kind: ok of a run that stopped
    for (std::uint64_t seed = 1; seed <= 20'000; ++seed) {
        RandomRun run(seed);
        const auto when = static_cast<Expectation::When>(run.below(6));
        Expectation e =
            run.expect(when, static_cast<int>(run.below(3)), static_cast<int>(run.below(3)));
        if (run.below(2) == 0 && when == Expectation::When::counted)
            e.high = std::numeric_limits<double>::infinity();
        run.draw();
        Judge whole({e});
        run.play(whole, run.ends.size());
        const auto instants = 1 + static_cast<std::size_t>(run.below(run.ends.size()));
        for (const Outcome outcome : {completed, block_error, limit, interrupted}) {
            Judge cut({e});
            run.play(cut, instants, outcome);
            INFO("seed " << seed << ", kind " << static_cast<int>(when) << ", outcome "
                         << static_cast<int>(outcome) << ", " << instants << " of "
                         << run.ends.size() << " instants: " << whole.verdicts()[0].deviation);
            const bool may_turn = outcome == completed && is_of_the_time_so_far(e);
            if (cut.ok() && !may_turn) REQUIRE(whole.ok());
            if (outcome != completed) kept[static_cast<std::size_t>(when)] += cut.ok();
            REQUIRE(cut.ok() == cut.verdicts()[0].deviation.empty());
            if (cut.verdicts()[0].undecided)
                REQUIRE_THAT(cut.verdicts()[0].deviation,
                             Catch::Contains("is undecided: the run "));
        }
    }
    using When = Expectation::When;
    for (const When when : {When::at_end, When::excluded, When::answered})
        CHECK(kept[static_cast<std::size_t>(when)] == 0);
    for (const When when : {When::at, When::always, When::counted})
        CHECK(kept[static_cast<std::size_t>(when)] > 100);
}
