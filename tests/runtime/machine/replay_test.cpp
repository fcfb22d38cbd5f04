#include "runtime/machine/replay.hpp"

#include <catch2/catch.hpp>

#include "tests/runtime/scan/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

using enum Replay::Between;
using Read = std::vector<std::int64_t>;

/// Times in ms.
template <class T>
std::vector<Replay::Point> points(std::initializer_list<std::pair<std::int64_t, T>> list) {
    std::vector<Replay::Point> all;
    for (const auto& [time, value] : list) {
        all.push_back({.time = time * ms});
        std::memcpy(all.back().value.data(), &value, sizeof value);
    }
    return all;
}

/// The value at each of some times [ms], 99 where it is left alone.
std::vector<double> played(Replay& replay, std::initializer_list<std::int64_t> times) {
    std::vector<double> all;
    for (const std::int64_t time : times) {
        const auto value = replay.play(time * ms);
        all.push_back(value ? as_real(*value) : 99);
    }
    return all;
}

Replay reals(Replay::Between between) {
    return {nullptr, Type::real, between, points<double>({{2, 1}, {4, 5}, {4, 6}, {8, -2}})};
}

/// Plays integers into the input of the only task, which reads it each millisecond.
Read read_by_a_task(std::vector<Stimulus> stimuli, std::vector<Force> forces) {
    Bench bench({{.name = "a"}});
    std::byte* const input = reinterpret_cast<std::byte*>(&bench.live("a").input);
    bench.machine.replays.emplace_back(input, Type::integer, held,
                                       points<std::int64_t>({{-1, 7}, {2, 8}, {5, 9}}));
    for (Stimulus& s : stimuli) s.target = input;
    for (Force& f : forces) f.live = input;
    bench.machine.stimuli = std::move(stimuli);
    bench.machine.forces = std::move(forces);
    bench.machine.duration = 7 * ms;
    bench.run();
    Read read;
    for (const Event& e : bench.log) read.push_back(e.input);
    return read;
}

}  // namespace

TEST_CASE("replay: a held value stays until the next point", "[replay]") {
    Replay replay = reals(held);
    CHECK(replay.next_time() == 2 * ms);
    CHECK(played(replay, {0, 1, 2, 3}) == std::vector<double>{99, 99, 1, 99});
    CHECK(replay.next_time() == 4 * ms);
    CHECK(played(replay, {4, 7, 8, 9}) == std::vector<double>{6, 99, -2, 99});
    CHECK(replay.next_time() == never);
    Replay late = reals(held);
    CHECK(played(late, {7, 100}) == std::vector<double>{6, -2});
}

TEST_CASE("replay: an interpolated value lies between two points", "[replay]") {
    Replay replay = reals(interpolated);
    CHECK(replay.next_time() == never);
    CHECK(played(replay, {0, 2, 3, 4, 5, 6, 8, 9}) ==
          std::vector<double>{99, 1, 3, 6, 4, 2, -2, 99});
    constexpr double huge = 1.7e308;
    Replay far(nullptr, Type::real, interpolated, points<double>({{0, -huge}, {2, huge}}));
    CHECK(played(far, {0, 1, 2}) == std::vector<double>{-huge, 0, huge});
}

TEST_CASE("replay: a course goes on wherever it is resumed", "[replay]") {
    for (const auto between : {held, interpolated})
        for (std::int64_t resumed = 0; resumed < 10; ++resumed) {
            Replay whole = reals(between), parted = reals(between);
            played(whole, {resumed});
            parted.skip_to(resumed * ms);
            CHECK(whole.next_time() == parted.next_time());
            CHECK(played(whole, {resumed + 1, 11}) == played(parted, {resumed + 1, 11}));
        }
}

TEST_CASE("replay: values from before the run are there at its start", "[replay]") {
    Replay replay(nullptr, Type::integer, held, points<std::int64_t>({{-5, 1}, {-1, 2}, {3, 4}}));
    CHECK(replay.next_time() == 0);
    CHECK(played(replay, {0, 1, 3}) == std::vector<double>{2, 99, 4});
}

TEST_CASE("replay: a task reads what is due before it runs", "[replay]") {
    CHECK(read_by_a_task({}, {}) == Read{7, 7, 8, 8, 8, 9, 9, 9});
}

TEST_CASE("replay: a stimulus of the same instant comes after it", "[replay]") {
    const auto set = [](std::int64_t at) {
        return Stimulus{at * ms, nullptr, Type::integer, std::int64_t{50}};
    };
    CHECK(read_by_a_task({set(2)}, {}) == Read{7, 7, 50, 50, 50, 9, 9, 9});
    CHECK(read_by_a_task({set(3)}, {}) == Read{7, 7, 8, 50, 50, 9, 9, 9});
}

TEST_CASE("replay: a force wins, and the replayed value is there at its end", "[replay]") {
    const Force force{.from = 1 * ms,
                      .until = 6 * ms,
                      .type = Type::integer,
                      .value = std::int64_t{50},
                      .name = {},
                      .value_text = {}};
    CHECK(read_by_a_task({}, {force}) == Read{7, 50, 50, 50, 50, 50, 9, 9});
}

TEST_CASE("replay: a held point is an instant of its own", "[replay]") {
    Bench bench(
        {{.name = "slow", .every = 10}, {.name = "event", .priority = 5, .on_event = true}});
    bench.trigger_from_outside("event");
    std::byte* const wanted = reinterpret_cast<std::byte*>(&bench.live("event").wanted);
    bench.machine.replays.emplace_back(wanted, Type::boolean, held,
                                       points<bool>({{1, true}, {2, false}, {7, true}}));
    bench.run();
    CHECK(bench.times("event") == Read{1, 7});
}

TEST_CASE("replay: an interpolated value is set in every instant", "[replay]") {
    Bench bench({{.name = "a", .every = 2}, {.name = "b", .every = 5, .priority = 2}});
    auto* const input = reinterpret_cast<std::byte*>(&bench.live("a").input);
    bench.machine.replays.emplace_back(input, Type::real, interpolated,
                                       points<double>({{0, 0}, {10, 20}}));
    bench.run();
    Read read;
    for (const Event& e : bench.log)
        if (e.task == "a")
            read.push_back(static_cast<std::int64_t>(
                as_real(load(Type::real, reinterpret_cast<const std::byte*>(&e.input)))));
    CHECK(read == Read{0, 4, 8, 12, 16, 20});
}
