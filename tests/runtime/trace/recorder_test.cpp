#include "runtime/trace/recorder.hpp"

#include <bit>

#include <catch2/catch.hpp>

#include "tests/allocations.hpp"

using namespace lineshaft;

namespace {

/// Keeps the rows as words.
class Rows : public TraceSink {
  public:
    explicit Rows(std::size_t width) : width_(width) {}

    void rows(const std::uint64_t* words, std::size_t rows) override {
        blocks.push_back(rows);
        for (std::size_t i = 0; i < rows; ++i)
            all.emplace_back(words + i * width_, words + (i + 1) * width_);
    }

    std::vector<std::vector<std::uint64_t>> all;
    std::vector<std::size_t> blocks;

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
    recorder.flush();
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
    recorder.flush();
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
    recorder.flush();
    recorder.flush();
    REQUIRE(sink.all.size() == 2500);
    for (std::size_t i = 0; i < 2500; ++i) REQUIRE(sink.all[i][1] == i);
    CHECK(sink.blocks.back() == 2500 - before);
}

TEST_CASE("a trace of no signals still has time and scan") {
    Rows sink(2);
    Recorder recorder({}, sink);
    recorder.scanned(0, scan(3));
    recorder.flush();
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
