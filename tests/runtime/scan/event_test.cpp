#include <catch2/catch.hpp>

#include "tests/allocations.hpp"
#include "tests/runtime/scan/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

using Times = std::vector<std::int64_t>;

/// Rings every `period` ns, on its own; `ringing` until the next scan of its task.
struct Bell {
    std::int64_t period = 0;
    std::int64_t next = 0;
    std::int64_t now = 0;
    std::int64_t rings = 0;
    bool ringing = false;
    std::int64_t published = -1;

    std::int64_t next_event_time() const { return next; }
    void advance(std::int64_t time, PulseSink*) {
        REQUIRE(time <= next);
        REQUIRE(time >= now);
        now = time;
        if (time < next) return;
        ++rings;
        ringing = true;
        next += period;
    }
    void publish(std::int64_t time) { published = time; }
};

static_assert(Device<Bell>);

DeviceCall call_of(Bell& bell, int task) {
    return {.calls = {
                .next_event_time =
                    [](const std::byte* b) {
                        return reinterpret_cast<const Bell*>(b)->next_event_time();
                    },
                .advance = [](std::byte* b, std::int64_t time,
                              PulseSink* sink) { reinterpret_cast<Bell*>(b)->advance(time, sink); },
                .publish = [](std::byte* b,
                              std::int64_t time) { reinterpret_cast<Bell*>(b)->publish(time); }},
            .block = reinterpret_cast<std::byte*>(&bell),
            .name = "bell",
            .task = task};
}

/// The scan of `task` takes the bell's flag back.
void silence(Bench& bench, Bell& bell, const std::string& task) {
    add_call(bench.task(task), bell,
             [](std::byte* first, std::size_t, const Scan&, const Context&) {
                 return reinterpret_cast<Bell*>(first)->ringing = false;
             });
}

}  // namespace

TEST_CASE("an event task runs once at each rising edge, and not by itself") {
    Bench bench({{.name = "e", .on_event = true}});
    bench.trigger_from_outside("e");
    bench.set_event("e", 2, true);
    bench.set_event("e", 4, true);
    bench.set_event("e", 5, false);
    bench.set_event("e", 7, true);
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::completed);
    CHECK(bench.times("e") == Times{2, 7});
    CHECK(result.scans == std::vector<std::int64_t>{2});
}

TEST_CASE("a signal that is true from the start is no edge") {
    Bench bench({{.name = "e", .on_event = true}});
    bench.live("e").wanted = true;
    bench.trigger_from_outside("e");
    bench.run();
    CHECK(bench.log.empty());
}

TEST_CASE("an output releases an event task when it is published") {
    Bench bench({{.name = "source", .every = 4, .cost = 1}, {.name = "e", .on_event = true}});
    bench.live("source").flag_at = 1;
    bench.trigger("source", "e");
    bench.wire("source", "e");
    bench.run();
    CHECK(bench.log.back() == Event{"source", 8, 2, 0});
    CHECK(bench.times("e") == Times{5});
    CHECK(bench.log[2] == Event{"e", 5, 0, 2});
}

TEST_CASE("an event task of higher priority interrupts, one of lower waits") {
    Bench bench({{.name = "low", .priority = 1, .on_event = true},
                 {.name = "main", .every = 10, .priority = 5, .cost = 4},
                 {.name = "high", .priority = 9, .on_event = true}});
    bench.trigger_from_outside("low");
    bench.trigger_from_outside("high");
    bench.set_event("low", 1, true);
    bench.set_event("high", 2, true);
    bench.run();
    CHECK(bench.times("high") == Times{2});
    CHECK(bench.times("low") == Times{4});
}

TEST_CASE("edges of several signals at one instant are one release") {
    Bench bench({{.name = "e", .on_event = true}, {.name = "f", .on_event = true}});
    bench.machine.triggers = {{&bench.live("e").wanted, bench.index("e")},
                              {&bench.live("f").wanted, bench.index("e")}};
    bench.set_event("e", 3, true);
    bench.set_event("f", 3, true);
    bench.run();
    CHECK(bench.times("e") == Times{3});
}

TEST_CASE("an edge during the scan is remembered") {
    Bench bench({{.name = "e", .cost = 4, .on_event = true}});
    bench.trigger_from_outside("e");
    bench.set_event("e", 1, true);
    bench.set_event("e", 2, false);
    bench.set_event("e", 3, true);
    CHECK(bench.run().outcome == Outcome::completed);
    CHECK(bench.times("e") == Times{1, 5});
}

TEST_CASE("a second edge before a waiting scan could begin is an overrun") {
    Bench bench({{.name = "e", .cost = 4, .on_event = true}});
    bench.trigger_from_outside("e");
    bool value = true;
    for (const std::int64_t at : {10, 12, 14, 16, 18}) {
        bench.set_event("e", 0, value);
        bench.machine.stimuli.back().at = at * ms / 10;
        value = !value;
    }
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::overrun);
    CHECK(result.time == 18 * ms / 10);
    CHECK(result.message ==
          "task 'e' overran: its event comes again at 0.0018 s, before scan 1, due at 0.0014 s, "
          "could begin; STOP: no task has it under 'on_overrun'");
}

TEST_CASE("event tasks that start each other for ever stop the run") {
    Bench bench({{.name = "e", .on_event = true}});
    bench.trigger_from_outside("e");
    bench.set_event("e", 3, true);
    static bool* wanted = nullptr;
    wanted = &bench.live("e").wanted;
    bool other = false;
    bench.machine.triggers.push_back({&other, bench.index("e")});
    static bool* second = nullptr;
    second = &other;
    add_call(bench.task("e"), other, [](std::byte*, std::size_t, const Scan&, const Context&) {
        *wanted = !*wanted;
        *second = !*wanted;
        return false;
    });
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::overrun);
    CHECK(result.message ==
          "event task 'e' overran: it has scanned 1000 times at 0.003 s and does not end");
}

TEST_CASE("a device's event is an instant between scans and releases its task there") {
    Bench bench({{.name = "main", .every = 5},
                 {.name = "isr", .priority = 9, .cost = 1, .on_event = true}});
    Bell bell{.period = 3 * ms, .next = 3 * ms};
    bench.machine.devices.push_back(call_of(bell, bench.index("isr")));
    bench.machine.triggers.push_back({&bell.ringing, bench.index("isr")});
    silence(bench, bell, "isr");
    bench.run();
    CHECK(bench.times("isr") == Times{3, 6, 9});
    CHECK(bell.rings == 3);
    CHECK(bell.published == 10 * ms);
    CHECK(bell.now == 10 * ms);
}

TEST_CASE("a device's event during its own interrupt is not lost") {
    Bench bench({{.name = "isr", .cost = 4, .on_event = true}});
    Bell bell{.period = 3 * ms, .next = 1 * ms};
    bench.machine.devices.push_back(call_of(bell, 0));
    bench.machine.triggers.push_back({&bell.ringing, 0});
    silence(bench, bell, "isr");
    bench.machine.duration = 9 * ms;
    bench.run();
    CHECK(bench.times("isr") == Times{1, 5, 9});
    CHECK(bell.rings == 3);
}

TEST_CASE("a device is brought up to date whenever somebody looks, and at the end") {
    Bench bench({{.name = "main", .every = 7}});
    Bell bell{.period = ms, .next = never};
    bench.machine.devices.push_back(call_of(bell, 0));
    bench.machine.looks = {2 * ms, 2 * ms, 3 * ms};
    struct : Observer {
        void scanned(int, const Scan&) override {}
        void settled(std::int64_t time, std::int64_t) override { times.push_back(time / ms); }
        Times times;
    } observer;
    bench.run({&observer});
    CHECK(observer.times == Times{0, 2, 3, 7});
    CHECK(bell.now == 10 * ms);
}

TEST_CASE("an error that a device finds while it publishes ends the run") {
    Bench bench({{.name = "main", .every = 2}});
    Bell bell{.next = never};
    DeviceCall call = call_of(bell, 0);
    call.calls.publish = [](std::byte* b, std::int64_t time) {
        reinterpret_cast<Bell*>(b)->ringing = time >= 4 * ms;
    };
    bench.machine.devices.push_back(call);
    bench.task("main").errors.push_back({&bell.ringing, nullptr, {}, "'bell' (bell)"});
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::block_error);
    CHECK(result.time == 4 * ms);
}

TEST_CASE("nothing is allocated while events come and go") {
    Bench bench({{.name = "isr", .cost = 1, .on_event = true},
                 {.name = "main", .every = 2, .priority = 0}});
    for (const char* name : {"isr", "main"}) bench.live(name).log = nullptr;
    Bell bell{.period = 3 * ms, .next = 3 * ms};
    bench.machine.devices.push_back(call_of(bell, 0));
    bench.machine.triggers.push_back({&bell.ringing, bench.index("isr")});
    silence(bench, bell, "isr");
    bench.machine.duration = 1000 * ms;
    struct : Observer {
        void scanned(int, const Scan&) override {}
        void settled(std::int64_t, std::int64_t) override {
            if (first < 0) first = allocations();
            last = allocations();
        }
        std::int64_t first = -1, last = 0;
    } observer;
    const RunResult result = bench.run({&observer});
    CHECK(observer.last == observer.first);
    CHECK(result.scans[static_cast<std::size_t>(bench.index("isr"))] == 333);
}
