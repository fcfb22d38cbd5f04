#include <random>

#include <catch2/catch.hpp>

#include "runtime/scan/executive.hpp"
#include "tests/runtime/scan/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// Three tasks with other periods, costs and jitters for each seed; `c` starts on an event.
std::vector<TaskSpec> random_tasks(std::mt19937_64& random) {
    const auto below = [&](int n) {
        return static_cast<std::int64_t>(random() % static_cast<unsigned>(n));
    };
    return {{.name = "a",
             .every = 4 + below(5),
             .priority = 1 + below(3),
             .offset = below(3),
             .cost = below(3),
             .jitter = below(2)},
            {.name = "b", .every = 3 + below(9), .priority = 1 + below(3), .cost = below(2)},
            {.name = "c", .priority = 9, .on_event = true}};
}

/// A bench that goes on for 200 ms, with what its tasks show of it.
struct Rig {
    explicit Rig(std::uint64_t seed) : random(seed), bench(random_tasks(random)) {
        bench.machine.duration = 200 * ms;
        bench.machine.seed = seed;
        bench.trigger_from_outside("c");
        for (const std::int64_t at : {20, 90, 150}) bench.set_event("c", at, at != 90);
    }
    Stimulus input(std::int64_t value) {
        return {0, reinterpret_cast<std::byte*>(&bench.live("b").input), Type::integer, value,
                "b.input"};
    }

    std::mt19937_64 random;
    Bench bench;
    Watch watch{bench.output("a")};
};

void check_equal(const Rig& a, const RunResult& of_a, const Rig& b, const RunResult& of_b) {
    REQUIRE(a.bench.log == b.bench.log);
    REQUIRE(a.watch.changes == b.watch.changes);
    REQUIRE(of_a.time == of_b.time);
    REQUIRE(of_a.scans == of_b.scans);
    REQUIRE(of_a.outcome == of_b.outcome);
}

struct Events : EventSink {
    void happened(const RunEvent& event) override {
        if (event.kind == EventKind::stimulus && event.text == "b.input")
            times.push_back(event.time);
    }
    std::vector<std::int64_t> times;
};

}  // namespace

TEST_CASE("a run in steps is the run in one go") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        INFO("seed " << seed);
        Rig whole(seed), parted(seed);
        const RunResult wanted = whole.bench.run({&whole.watch});
        Executive executive(parted.bench.machine);
        executive.add(parted.watch);
        executive.begin();
        std::int64_t time = 0;
        while (executive.run_until(time))
            time += static_cast<std::int64_t>(parted.random() % (9 * ms));
        check_equal(whole, wanted, parted, executive.finish());
    }
}

TEST_CASE(
    "what is posted between two steps counts as a stimulus of the time that it is told with") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        INFO("seed " << seed);
        Rig live(seed), again(seed);
        Events events;
        Executive executive(live.bench.machine);
        executive.report_to(events);
        executive.add(live.watch);
        executive.begin();
        std::int64_t time = 0, posts = 0;
        while (executive.run_until(time)) {
            if (live.random() % 3 == 0) executive.post(live.input(++posts));
            time += static_cast<std::int64_t>(live.random() % (9 * ms));
        }
        const RunResult wanted = executive.finish();
        REQUIRE(posts >= static_cast<std::int64_t>(events.times.size()));
        REQUIRE(posts - static_cast<std::int64_t>(events.times.size()) <= 1);
        std::int64_t value = 0;
        for (const std::int64_t at : events.times) {
            Stimulus stimulus = again.input(++value);
            stimulus.at = at;
            again.bench.machine.stimuli.push_back(stimulus);
        }
        std::ranges::stable_sort(again.bench.machine.stimuli, {}, &Stimulus::at);
        check_equal(live, wanted, again, again.bench.run({&again.watch}));
    }
}

TEST_CASE("what is forced and released between two steps is so in a run that knows it before") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        INFO("seed " << seed);
        Rig live(seed), again(seed);
        const auto force = [](Rig& rig, std::int64_t value) {
            auto& block = rig.bench.live("a");
            auto* const live_place = reinterpret_cast<std::byte*>(&block.output);
            auto* const published = const_cast<std::byte*>(rig.bench.output("a").slot);
            return Force{.live = live_place,
                         .published = published == live_place ? nullptr : published,
                         .block = reinterpret_cast<std::byte*>(&block),
                         .is_output = true,
                         .task = rig.bench.index("a"),
                         .type = Type::integer,
                         .value = value,
                         .name = "a.output",
                         .value_text = std::to_string(value)};
        };
        for (Rig* rig : {&live, &again}) {
            Force planned = force(*rig, -1);
            planned.from = 60 * ms;
            planned.until = 120 * ms;
            rig->bench.machine.forces = {planned};
        }
        Executive executive(live.bench.machine);
        executive.add(live.watch);
        executive.begin();
        std::int64_t time = 0, value = 100;
        while (executive.run_until(time)) {
            if (live.random() % 3 == 0) {
                Force forced = force(again, ++value);
                forced.from = executive.force(force(live, value));
                again.bench.machine.impose(forced);
            } else if (live.random() % 2 == 0) {
                const std::int64_t at = executive.lift_force(force(live, 0).live);
                again.bench.machine.lift_force(force(again, 0).live, at);
            }
            time += static_cast<std::int64_t>(live.random() % (9 * ms));
        }
        const RunResult wanted = executive.finish();
        check_equal(live, wanted, again, again.bench.run({&again.watch}));
    }
}

TEST_CASE("an observer may come and go between steps") {
    Rig rig(1);
    Executive executive(rig.bench.machine);
    executive.begin();
    executive.run_until(50 * ms);
    CHECK(rig.watch.changes.empty());
    executive.add(rig.watch);
    executive.run_until(100 * ms);
    const auto seen = rig.watch.changes;
    CHECK_FALSE(seen.empty());
    executive.remove(rig.watch);
    CHECK_FALSE(executive.run_until(200 * ms));
    CHECK(rig.watch.changes == seen);
    CHECK(executive.finish().time == 200 * ms);
}

TEST_CASE("a run ends where its last step ends") {
    Rig rig(1);
    Executive executive(rig.bench.machine);
    executive.begin();
    CHECK(executive.run_until(70 * ms));
    const RunResult result = executive.finish();
    CHECK(result.time == 70 * ms);
    CHECK(result.outcome == Outcome::completed);
}
