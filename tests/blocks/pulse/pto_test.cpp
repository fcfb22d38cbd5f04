#include "blocks/pulse/pto.hpp"

#include <algorithm>
#include <initializer_list>

#include <catch2/catch.hpp>

#include "runtime/model/random.hpp"
#include "tests/blocks/pulse/decoder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr std::int64_t ms = 1'000'000;

struct Tape : PulseSink {
    void edges(std::span<const std::int64_t> times, bool reverse) override {
        list.insert(list.end(), times.begin(), times.end());
        position += (reverse ? -1 : 1) * static_cast<std::int64_t>(times.size());
    }
    Edges list;
    std::int64_t position = 0;
};

/// The channel as the executive drives it.
struct Output {
    Pto pto;
    Tape tape;
    std::int64_t now = 0;

    void advance_to(std::int64_t time) {
        for (; pto.next_event_time() <= time; pto.advance(now, &tape)) now = pto.next_event_time();
        now = time;
        pto.advance(now, &tape);
    }
    void execute() {
        ++pto.job;
        pto.scan({.time = now});
        pto.publish(now);
        pto.advance(now, &tape);
        REQUIRE(pto.next_event_time() > now);
    }
    void execute(std::int64_t start_rate, std::int64_t end_rate, std::int64_t count) {
        pto.start_rate = start_rate;
        pto.end_rate = end_rate;
        pto.count = count;
        execute();
    }
    void finish() {
        for (int i = 0; i < 1'000'000 && pto.busy; ++i) advance_to(pto.next_event_time());
        REQUIRE_FALSE(pto.busy);
    }
};

Output with_profile(std::initializer_list<PulseSegment> rows) {
    Output out;
    out.pto.multi_segment = true;
    std::ranges::copy(rows, out.pto.profile.rows.begin());
    out.pto.profile.size = static_cast<std::int64_t>(rows.size());
    return out;
}

}  // namespace

TEST_CASE("a profile runs its segments without a gap and then is done") {
    Output out = with_profile({{2000, 10'000, 200}, {10'000, 10'000, 3400}, {10'000, 2000, 400}});
    out.execute();
    CHECK(out.pto.busy);
    CHECK(out.pto.active_segment == 1);
    out.advance_to(200 * ms);
    CHECK(out.pto.active_segment == 2);
    CHECK(out.pto.rate == 10'000);
    out.advance_to(440 * ms - 1);
    CHECK_FALSE(out.pto.done);
    CHECK(out.pto.pulses == 4000);
    out.advance_to(440 * ms);
    CHECK(out.pto.done);
    CHECK_FALSE(out.pto.busy);
    CHECK(out.pto.active_segment == 0);
    CHECK(out.tape.list.size() == 4000);
    out.pto.scan({.time = out.now});
    CHECK(out.pto.done);
    out.pto.scan({.time = out.now + ms});
    CHECK_FALSE(out.pto.done);
}

TEST_CASE("a second train waits and follows at once, a third is refused") {
    Output out;
    out.execute(1000, 1, 10);
    out.execute(3000, 1, 7);
    CHECK(out.pto.queued);
    CHECK_FALSE(out.pto.overflow);
    out.execute(2000, 1, 5);
    CHECK(out.pto.overflow);
    CHECK(out.pto.refused == 1);
    CHECK(out.pto.refusal == Pto::Refusal::overflow);
    out.finish();
    CHECK(out.pto.trains == 2);
    CHECK(out.pto.pulses == 17);
    CHECK(out.tape.list[10] == 10 * ms);
    CHECK(out.tape.list.back() == 12 * ms);
}

TEST_CASE("what is out of range is clamped and says so") {
    Output out;
    out.execute(0, 0, 0);
    CHECK(out.pto.clamped);
    out.finish();
    CHECK(out.now == 1000 * ms);
    CHECK(out.pto.pulses == 1);

    Output fast;
    fast.execute(200'000, 0, -5);
    CHECK(fast.pto.train.segment() == PulseSegment{65'535, 65'535, 1});
    CHECK(fast.pto.clamped);
    CHECK(fast.pto.warnings == 2);
    CHECK(fast.pto.warning_id == Pto::Warning::count_out_of_range);

    Output multi;
    multi.pto.multi_segment = true;
    multi.execute(200'000, -1, 3'000'000'000);
    CHECK(multi.pto.train.segment() == PulseSegment{100'000, 1, 2'147'483'647});

    Output good;
    good.execute(65'535, 1, 1);
    CHECK_FALSE(good.pto.clamped);
    CHECK(good.pto.warnings == 0);
}

TEST_CASE("a table of no segments, or of more than there are, puts nothing out") {
    for (const std::int64_t segments : {0, 2, 256}) {
        Output out;
        out.pto.multi_segment = true;
        out.pto.segments = segments;
        out.execute(100, 100, 10);
        CHECK_FALSE(out.pto.busy);
        CHECK(out.pto.refused == 1);
        CHECK(out.pto.refusal == Pto::Refusal::no_segments);
    }
}

TEST_CASE("a segment below 500 us sets underflow, and ends the train if it may") {
    for (const bool ends : {false, true}) {
        Output out = with_profile({{10'000, 10'000, 4}, {10'000, 10'000, 100}});
        out.pto.underflow_ends = ends;
        out.execute();
        out.finish();
        CHECK(out.pto.underflow);
        CHECK(out.pto.pulses == (ends ? 4 : 104));
        CHECK(out.pto.lost == (ends ? 100 : 0));
    }
    Output exact = with_profile({{10'000, 10'000, 5}});
    exact.execute();
    exact.finish();
    CHECK_FALSE(exact.pto.underflow);
}

TEST_CASE("the output ends at once when it is stopped, and no pulse is lost in silence") {
    const bool by_stop = GENERATE(true, false);
    Output out = with_profile({{1000, 1000, 100}, {1000, 1000, 50}});
    out.execute();
    out.execute();
    out.advance_to(20 * ms);
    out.pto.stop = by_stop;
    out.pto.enable = by_stop;
    if (!by_stop) ++out.pto.job;
    out.pto.scan({.time = out.now});
    CHECK(out.pto.busy);
    out.pto.publish(out.now);
    CHECK_FALSE(out.pto.busy);
    CHECK(out.pto.stopped);
    CHECK(out.pto.done);
    CHECK(out.pto.end_time == 0.02);
    CHECK(out.pto.trains == 1);
    CHECK(out.pto.pulses == 21);
    CHECK(out.pto.lost == 300 - 21);
    CHECK(out.pto.next_event_time() == never);
}

TEST_CASE("each end of a train is a rising edge, scanned or not") {
    for (const bool scanned : {true, false}) {
        for (const RateUpdate update : {RateUpdate::continuous, RateUpdate::per_pulse}) {
            Output out = with_profile({{1000, 3000, 10}, {3000, 1000, 10}});
            out.pto.rate_update = update;
            out.execute();
            for (int train = 1; train <= 20; ++train) {
                out.execute();
                bool fell = false;
                while (out.pto.trains < train) {
                    fell = fell || !out.pto.done;
                    out.advance_to(out.pto.next_event_time());
                }
                CHECK(fell);
                CHECK(out.pto.done);
                if (scanned) out.pto.scan({.time = out.now});
            }
        }
    }
}

TEST_CASE("direction belongs to the train, not to the moment") {
    Output out;
    out.execute(1000, 1, 5);
    out.pto.reverse = true;
    out.execute(1000, 1, 3);
    CHECK_FALSE(out.pto.reversed);
    out.finish();
    CHECK(out.pto.reversed);
    CHECK(out.pto.position == 2);
    CHECK(out.tape.position == 2);
    CHECK(out.pto.pulses == 8);
}

TEST_CASE("the control byte stands for the named fields") {
    Output out = with_profile({{1000, 1000, 5}, {1000, 1000, 5}});
    out.pto.enable = false;
    out.pto.multi_segment = false;
    out.pto.control = 0xE0;
    out.execute();
    CHECK(out.pto.active.segments == 2);
    out.finish();

    Output single;
    single.pto.control = 0xC5;
    single.execute(500, 1, 4);
    single.finish();
    CHECK(single.now == 8 * ms);
    single.pto.control = 0xC1;
    single.execute(1000, 1, 9);
    single.finish();
    CHECK(single.pto.pulses == 8);
    CHECK(single.now == 12 * ms);

    Output pulse_width;
    pulse_width.pto.control = 0x80;
    pulse_width.execute(500, 1, 4);
    CHECK_FALSE(pulse_width.pto.busy);
    CHECK(pulse_width.pto.refusal == Pto::Refusal::not_pto);
}

TEST_CASE("execute works by its edge, and without interrupt nothing is done") {
    Output out;
    out.pto.interrupt = false;
    out.pto.count = 3;
    out.pto.start_rate = 1000;
    for (int i = 0; i < 5; ++i) {
        out.pto.execute = true;
        out.pto.scan({.time = out.now});
        out.pto.publish(out.now);
    }
    CHECK_FALSE(out.pto.queued);
    out.finish();
    CHECK(out.pto.pulses == 3);
    CHECK_FALSE(out.pto.done);
}

TEST_CASE("ten thousand random profiles, recounted from their edges") {
    Random random(2, "profiles");
    const auto pick = [&](std::int64_t most) {
        return static_cast<std::int64_t>(random.next() % static_cast<std::uint64_t>(most));
    };
    for (int i = 0; i < 10'000; ++i) {
        Output out;
        out.pto.multi_segment = true;
        out.pto.rate_update = i % 2 == 0 ? RateUpdate::continuous : RateUpdate::per_pulse;
        out.pto.profile.size = 1 + pick(6);
        std::vector<PulseSegment> rows;
        std::int64_t pulses = 0;
        for (std::int64_t k = 0; k < out.pto.profile.size; ++k) {
            rows.push_back({1 + pick(100'000), 1 + pick(100'000), 1 + pick(60)});
            out.pto.profile.rows[static_cast<std::size_t>(k)] = rows.back();
            pulses += rows.back().count;
        }
        out.now = pick(1'000'000'000);
        out.execute();
        out.advance_to(out.now + pick(3) * ms);
        out.finish();
        INFO("profile " << i);
        REQUIRE(static_cast<std::int64_t>(out.tape.list.size()) == pulses);
        check_spacing(out.tape.list, 100'000);
        auto first = out.tape.list.begin();
        for (const PulseSegment& row : rows) {
            const auto last = first + row.count;
            check_rates(Edges(first, last), row);
            first = last;
        }
    }
}
