#include "runtime/trace/recorder.hpp"

#include <bit>
#include <limits>

#include <catch2/catch.hpp>

#include "tests/allocations.hpp"

using namespace lineshaft;

namespace {

/// Keeps the rows as words.
class Rows : public TraceSink {
  public:
    explicit Rows(std::size_t width) : width_(width) {}

    void begin() override { begins.push_back(all.size()); }
    void end() override { ++ends; }
    void rows(const std::uint64_t* words, std::size_t rows) override {
        blocks.push_back(rows);
        for (std::size_t i = 0; i < rows; ++i)
            all.emplace_back(words + i * width_, words + (i + 1) * width_);
    }

    std::vector<std::vector<std::uint64_t>> all;
    std::vector<std::size_t> blocks;
    std::vector<std::size_t> begins;  ///< rows before each measurement
    std::size_t ends = 0;

  private:
    std::size_t width_;
};

/// Counts rows without keeping them.
class Count : public TraceSink {
  public:
    void rows(const std::uint64_t*, std::size_t rows) override { count += rows; }
    std::size_t count = 0;
};

struct Signals {
    bool flag = true;
    std::int64_t number = -3;
    double real = -0.5;

    std::vector<Signal> list() const {
        const auto at = [](const auto& m) { return reinterpret_cast<const std::byte*>(&m); };
        return {
            {.name = "a.flag", .type = Type::boolean, .unit = {}, .names = {}, .slot = at(flag)},
            {.name = "a.number",
             .type = Type::integer,
             .unit = {},
             .names = {},
             .slot = at(number)},
            {.name = "a.real", .type = Type::real, .unit = "mm", .names = {}, .slot = at(real)}};
    }
};

Scan scan(std::int64_t index) {
    return {.time = index * 1000, .interval = 1000, .index = index};
}

}  // namespace

TEST_CASE("a recorded row is time, scan and the bits of each signal") {
    Signals s;
    Rows sink(5);
    Recorder recorder({.task = 0, .every = 1, .signals = s.list()}, sink);
    recorder.scanned(0, scan(7));
    s = {.flag = false, .number = 1, .real = 2};
    recorder.scanned(0, scan(8));
    CHECK(sink.all.empty());
    recorder.finish();
    using Row = std::vector<std::uint64_t>;
    REQUIRE(sink.all.size() == 2);
    CHECK(sink.all[0] ==
          Row{7000, 7, 1, static_cast<std::uint64_t>(-3), std::bit_cast<std::uint64_t>(-0.5)});
    CHECK(sink.all[1] == Row{8000, 8, 0, 1, std::bit_cast<std::uint64_t>(2.0)});
    CHECK(recorder.recorded() == 2);
}

TEST_CASE("only every n-th scan of the chosen task is recorded, the first one first") {
    Signals s;
    Rows sink(5);
    Recorder recorder({.task = 1, .every = 10, .signals = s.list()}, sink);
    for (std::int64_t i = 0; i < 35; ++i) {
        recorder.scanned(0, scan(i));
        recorder.scanned(1, scan(i));
        recorder.scanned(2, scan(i));
    }
    recorder.finish();
    REQUIRE(sink.all.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) CHECK(sink.all[i][1] == 10 * i);
}

TEST_CASE("full blocks go to the sink as they fill, the rest with flush, nothing twice") {
    Signals s;
    Rows sink(5);
    Recorder recorder({.task = 0, .every = 1, .signals = s.list()}, sink);
    for (std::int64_t i = 0; i < 2500; ++i) recorder.scanned(0, scan(i));
    const std::size_t before = sink.all.size();
    CHECK(before > 0);
    CHECK(before < 2500);
    recorder.finish();
    recorder.finish();
    REQUIRE(sink.all.size() == 2500);
    for (std::size_t i = 0; i < 2500; ++i) REQUIRE(sink.all[i][1] == i);
    CHECK(sink.blocks.back() == 2500 - before);
}

TEST_CASE("a trace of no signals still has time and scan") {
    Rows sink(2);
    Recorder recorder({}, sink);
    recorder.scanned(0, scan(3));
    recorder.finish();
    CHECK(sink.all == std::vector<std::vector<std::uint64_t>>{{3000, 3}});
}

TEST_CASE("a recorder allocates nothing while recording") {
    Signals s;
    Count sink;
    Recorder recorder({.task = 0, .every = 1, .signals = s.list()}, sink);
    const std::int64_t before = test::allocations();
    for (std::int64_t i = 0; i < 10'000; ++i) recorder.scanned(0, scan(i));
    CHECK(test::allocations() == before);
    CHECK(sink.count > 9000);
}

namespace {

using Kind = TriggerKind;

/// A trace of scan() numbers while a boolean or a number takes `values`, one a scan.
struct Triggered {
    bool flag = false;
    double number = 0;
    Rows sink{2};
    std::vector<std::int64_t> triggers;

    TraceSetup setup(Kind kind, double low = 0, double high = 0) const {
        const bool edge = kind == Kind::rising || kind == Kind::falling;
        const auto at = [](const auto& m) { return reinterpret_cast<const std::byte*>(&m); };
        TraceSetup setup{.signals = {}};
        setup.trigger = {.kind = kind, .signal = {}, .low = low, .high = high};
        setup.trigger.signal.type = edge ? Type::boolean : Type::real;
        setup.trigger.signal.slot = edge ? at(flag) : at(number);
        return setup;
    }

    void run(const TraceSetup& setup, const std::vector<double>& values) {
        Recorder recorder(setup, sink);
        recorder.on_trigger = [this](const Scan& s) { triggers.push_back(s.index); };
        for (std::size_t i = 0; i < values.size(); ++i) {
            number = values[i];
            flag = number != 0;
            recorder.scanned(0, scan(static_cast<std::int64_t>(i)));
        }
        recorder.finish();
        CHECK(sink.begins.size() == sink.ends);
        CHECK(recorder.recorded() == static_cast<std::int64_t>(sink.all.size()));
    }

    std::vector<std::int64_t> column(std::size_t i) const {
        std::vector<std::int64_t> out;
        for (const auto& row : sink.all) out.push_back(static_cast<std::int64_t>(row[i]));
        return out;
    }
    std::vector<std::int64_t> times() const { return column(0); }
    std::vector<std::int64_t> scans() const { return column(1); }
};

using List = std::vector<std::int64_t>;

/// The scans in which triggers come, of measurements of one row.
List triggers_of(Kind kind, const std::vector<double>& values, double low = 0, double high = 0) {
    Triggered t;
    TraceSetup setup = t.setup(kind, low, high);
    setup.samples = 1;
    setup.repeat = 100;
    t.run(setup, values);
    CHECK(t.scans() == t.triggers);
    for (const std::int64_t time : t.times()) CHECK(time == 0);
    return t.triggers;
}

}  // namespace

TEST_CASE("a trigger compares integers as integers") {
    constexpr std::int64_t edge = std::int64_t{1} << 53;
    std::int64_t value = 0;
    const auto holds = [&](Kind kind, std::int64_t is, std::int64_t low, std::int64_t high) {
        TraceTrigger trigger{.kind = kind, .signal = {}, .low = low, .high = high};
        trigger.signal.type = Type::integer;
        trigger.signal.slot = reinterpret_cast<const std::byte*>(&value);
        value = is;
        return trigger.condition_holds();
    };
    CHECK(holds(Kind::above, edge + 1, edge, 0));
    CHECK(holds(Kind::below, edge, 0, edge + 1));
    CHECK_FALSE(holds(Kind::equals, edge, edge + 1, edge + 1));
    CHECK_FALSE(holds(Kind::inside, edge, edge + 1, edge + 2));
    CHECK(holds(Kind::equals, edge + 1, edge + 1, edge + 1));
}

TEST_CASE("a trigger comes when its condition begins to hold") {
    CHECK(triggers_of(Kind::rising, {0, 1, 1, 0, 1}) == List{1, 4});
    CHECK(triggers_of(Kind::falling, {1, 0, 0, 1, 0}) == List{1, 4});
    CHECK(triggers_of(Kind::above, {1, 2, 2.5, 3, 2, 3}, 2) == List{2, 5});
    CHECK(triggers_of(Kind::below, {3, 2, 1, 0, 3, 1}, 2, 2) == List{2, 5});
    CHECK(triggers_of(Kind::inside, {0, 1, 2, 3, 2, 0.5}, 1, 2) == List{1, 4});
    CHECK(triggers_of(Kind::equals, {0, 2, 2, 1.5, 2}, 2, 2) == List{1, 4});
}

TEST_CASE("a condition that holds in the first scan is a trigger, a level no edge") {
    CHECK(triggers_of(Kind::above, {3, 3}, 2) == List{0});
    CHECK(triggers_of(Kind::below, {1, 1}, 2, 2) == List{0});
    CHECK(triggers_of(Kind::inside, {1, 1}, 0, 2) == List{0});
    CHECK(triggers_of(Kind::equals, {1, 1}, 1, 1) == List{0});
    CHECK(triggers_of(Kind::rising, {1, 1}) == List{});
    CHECK(triggers_of(Kind::falling, {0, 0}) == List{});
}

TEST_CASE("a value that is no number meets no bound") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Kind kind : {Kind::above, Kind::below, Kind::inside, Kind::equals})
        CHECK(triggers_of(kind, {nan, nan}, 0, 0) == List{});
}

TEST_CASE("a trigger that never comes records nothing") {
    Triggered t;
    TraceSetup setup = t.setup(Kind::above, 10);
    setup.pre_trigger = 3;
    t.run(setup, {0, 1, 2, 3, 4});
    CHECK(t.sink.all.empty());
    CHECK(t.sink.begins.empty());
}

TEST_CASE("the trigger is at time 0, what was before it is negative") {
    Triggered t;
    TraceSetup setup = t.setup(Kind::rising);
    setup.pre_trigger = 2;
    t.run(setup, {0, 0, 0, 0, 0, 1, 1, 0});
    CHECK(t.times() == List{-2000, -1000, 0, 1000, 2000});
    CHECK(t.scans() == List{3, 4, 5, 6, 7});
}

TEST_CASE("a ring that has gone round many times gives its last rows in order") {
    for (std::int64_t size = 1; size <= 7; ++size) {
        Triggered t;
        TraceSetup setup = t.setup(Kind::rising);
        setup.pre_trigger = size;
        setup.samples = 1;
        std::vector<double> values(23);
        values.back() = 1;
        t.run(setup, values);
        List wanted;
        for (std::int64_t i = 22 - size; i <= 22; ++i) wanted.push_back(i);
        CHECK(t.scans() == wanted);
    }
}

TEST_CASE("fewer rows than the ring holds are all there were") {
    Triggered t;
    TraceSetup setup = t.setup(Kind::rising);
    setup.pre_trigger = 5000;
    t.run(setup, {0, 0, 1, 1});
    CHECK(t.times() == List{-2000, -1000, 0, 1000});
    Triggered at_once;
    TraceSetup first = at_once.setup(Kind::above, -1);
    first.pre_trigger = 5000;
    at_once.run(first, {0, 0});
    CHECK(at_once.times() == List{0, 1000});
}

TEST_CASE("a ring larger than a block is given in blocks") {
    Triggered t;
    TraceSetup setup = t.setup(Kind::rising);
    setup.pre_trigger = 3000;
    std::vector<double> values(4001);
    values.back() = 1;
    t.run(setup, values);
    REQUIRE(t.sink.all.size() == 3001);
    for (std::size_t i = 0; i < 3001; ++i) REQUIRE(t.sink.all[i][0] == (i - 3000) * 1000);
    for (const std::size_t rows : t.sink.blocks) CHECK(rows <= 256);
}

TEST_CASE("only every n-th scan is a row, and the trigger comes in any") {
    Triggered t;
    TraceSetup setup = t.setup(Kind::rising);
    setup.every = 3;
    setup.pre_trigger = 1;
    t.run(setup, {0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
    CHECK(t.triggers == List{4});
    CHECK(t.scans() == List{3, 6, 9});
    CHECK(t.times() == List{-1000, 2000, 5000});
}

TEST_CASE("a measurement ends with its samples or its time, whichever is first") {
    const std::vector<double> values{0, 1, 1, 1, 1, 1, 1, 1};
    const auto rows = [&](std::int64_t samples, std::int64_t duration) {
        Triggered t;
        TraceSetup setup = t.setup(Kind::rising);
        setup.samples = samples;
        setup.duration = duration;
        t.run(setup, values);
        return t.sink.all.size();
    };
    CHECK(rows(0, 0) == 7);
    CHECK(rows(3, 0) == 3);
    CHECK(rows(0, 4000) == 5);
    CHECK(rows(0, 3999) == 4);
    CHECK(rows(2, 4000) == 2);
    CHECK(rows(6, 1000) == 2);
    Triggered immediate;
    TraceSetup setup = immediate.setup(Kind::immediate);
    setup.samples = 2;
    immediate.run(setup, values);
    CHECK(immediate.times() == List{0, 1000});
    CHECK(immediate.triggers.empty());
}

TEST_CASE("a trace repeats as often as it may, and not while it records") {
    Triggered t;
    TraceSetup setup = t.setup(Kind::rising);
    setup.samples = 3;
    setup.pre_trigger = 2;
    setup.repeat = 2;
    t.run(setup, {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0});
    CHECK(t.triggers == List{1, 5});
    CHECK(t.sink.begins == std::vector<std::size_t>{0, 4});
    CHECK(t.scans() == List{0, 1, 2, 3, 4, 5, 6, 7});
    CHECK(t.times() == List{-1000, 0, 1000, 2000, -1000, 0, 1000, 2000});
}

TEST_CASE("a measurement of a time may follow the one before at once") {
    Triggered t;
    TraceSetup setup = t.setup(Kind::rising);
    setup.duration = 1000;
    setup.repeat = 9;
    t.run(setup, {0, 1, 0, 1, 0, 1});
    CHECK(t.triggers == List{1, 3, 5});
    CHECK(t.scans() == List{1, 2, 3, 4, 5});
}

TEST_CASE("the memory of a trace is known before it records") {
    TraceSetup setup;
    setup.signals.resize(8);
    CHECK(setup.memory() == 9 * 256 * 80);
    setup.pre_trigger = 1000;
    CHECK(setup.memory() == (1000 + 9 * 256) * 80);
    setup.pre_trigger = std::numeric_limits<std::int64_t>::max();
    CHECK(setup.memory() == std::uint64_t{1} << 63);
}

TEST_CASE("a waiting recorder allocates nothing") {
    Triggered t;
    TraceSetup setup = t.setup(Kind::rising);
    setup.pre_trigger = 100;
    Count sink;
    Recorder recorder(setup, sink);
    const std::int64_t before = test::allocations();
    for (std::int64_t i = 0; i < 10'000; ++i) {
        t.flag = i > 5'000;
        recorder.scanned(0, scan(i));
    }
    CHECK(test::allocations() == before);
    CHECK(sink.count > 4'000);
}
