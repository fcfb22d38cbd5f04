#include "blocks/pulse/pulse_train.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

#include "runtime/model/random.hpp"
#include "tests/blocks/pulse/decoder.hpp"
#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr std::int64_t never = INT64_MAX / 2;

PulseTrain train_of(const PulseSegment& s, RateUpdate update, PulseTime start = {}) {
    PulseTrain train;
    train.begin(s, update, start);
    return train;
}

/// Begins each segment where the last one has ended.
PulseTime run_through(const std::vector<PulseSegment>& segments, RateUpdate update, Edges& edges,
                      PulseTime start = {}) {
    for (const PulseSegment& s : segments) {
        PulseTrain train = train_of(s, update, start);
        const Edges part = all_edges(train);
        edges.insert(edges.end(), part.begin(), part.end());
        start = train.end();
    }
    return start;
}

PulseSegment any_segment(Random& random, std::int64_t most_pulses) {
    const auto pick = [&](std::int64_t most) {
        return 1 + static_cast<std::int64_t>(random.next() % static_cast<std::uint64_t>(most));
    };
    const std::int64_t rates[] = {1, 10, 1000, 100'000};
    return {pick(rates[random.next() % 4]), pick(rates[random.next() % 4]), pick(most_pulses)};
}

}  // namespace

TEST_CASE("the manual's profile takes 33.33 + 340 + 66.67 = 440 ms") {
    const std::vector<PulseSegment> profile{
        {2000, 10'000, 200}, {10'000, 10'000, 3400}, {10'000, 2000, 400}};
    Edges edges;
    PulseTrain first = train_of(profile[0], RateUpdate::continuous);
    CHECK(first.end().nanoseconds == 33'333'333);
    CHECK(first.end().fraction == Approx(1.0 / 3));
    const PulseTime end = run_through(profile, RateUpdate::continuous, edges);
    CHECK(end.rounded() == 440'000'000);
    CHECK(edges.size() == 4000);
    CHECK(edges.front() == 0);
    CHECK(edges[200] == 33'333'333);
    CHECK(edges[3600] == 373'333'333);
    check_spacing(edges, 10'000);
}

TEST_CASE("a continuous ramp's edges are where the integral of its rate is whole") {
    Random random(4, "ramps");
    for (std::size_t i = 0; i < 300; ++i) {
        const PulseSegment s = any_segment(random, 2000);
        const PulseTime start{static_cast<std::int64_t>(random.next() % 1'000'000'007),
                              static_cast<double>(random.next() % 1000) / 1000};
        PulseTrain train = train_of(s, RateUpdate::continuous, start);
        INFO(s.start_rate << " -> " << s.end_rate << " Hz in " << s.count);
        const Edges edges = all_edges(train, 1 + i % 7);
        REQUIRE(edges.size() == static_cast<std::size_t>(s.count));
        for (std::int64_t k = 0; k < s.count; k += 1 + s.count / 50) {
            const long double exact = crossing(s, k) + static_cast<long double>(start.fraction);
            const auto time = edges[static_cast<std::size_t>(k)] - start.nanoseconds;
            REQUIRE(std::abs(static_cast<long double>(time) - exact) < 0.5L + 1e-3L);
        }
        check_rates(edges, s);
    }
}

TEST_CASE("per pulse each pulse keeps the rate with which it began") {
    Random random(5, "per pulse");
    for (std::size_t i = 0; i < 300; ++i) {
        const PulseSegment s = any_segment(random, 2000);
        PulseTrain train = train_of(s, RateUpdate::per_pulse);
        INFO(s.start_rate << " -> " << s.end_rate << " Hz in " << s.count);
        const Edges edges = all_edges(train, 1 + i % 7);
        REQUIRE(edges.size() == static_cast<std::size_t>(s.count));
        const long double f0 = s.start_rate, f1 = s.end_rate, Q = s.count;
        const long double T = 2 * Q / (f0 + f1);
        long double t = 0;
        for (const std::int64_t edge : edges) {
            REQUIRE(std::abs(static_cast<long double>(edge) - t * 1e9L) < 0.5L + 1e-2L);
            t += 1 / (f0 + (f1 - f0) * std::min(t / T, 1.0L));
        }
        CHECK(std::abs(static_cast<long double>(train.end().rounded()) - t * 1e9L) < 0.51L);
        check_rates(edges, s);
    }
}

TEST_CASE("the first pulse at the lowest rate lasts a second, unless the rate moves meanwhile") {
    PulseTrain slow = train_of({1, 75, 1}, RateUpdate::per_pulse);
    slow.skip(never);
    CHECK(slow.end().rounded() == 1'000'000'000);
    CHECK(train_of({1, 75, 1}, RateUpdate::continuous).end().rounded() == 26'315'789);
}

TEST_CASE("counts at any time agree with the edges") {
    Random random(6, "counts");
    for (int i = 0; i < 200; ++i) {
        const PulseSegment s = any_segment(random, 500);
        const RateUpdate update = i % 2 == 0 ? RateUpdate::continuous : RateUpdate::per_pulse;
        PulseTrain whole = train_of(s, update, {12'345, 0.25});
        const Edges edges = all_edges(whole);
        PulseTrain train = train_of(s, update, {12'345, 0.25});
        const std::int64_t step = 1 + (edges.back() - 12'345) / 97;
        for (std::int64_t time = 12'000; time < edges.back() + 2 * step; time += step) {
            train.skip(time);
            const auto passed = std::ranges::upper_bound(edges, time) - edges.begin();
            REQUIRE(train.emitted() == passed);
        }
        PulseTrain at_edges = train_of(s, update, {12'345, 0.25});
        for (std::size_t k = 0; k < edges.size(); ++k) {
            at_edges.skip(edges[k] - 1);
            REQUIRE(at_edges.emitted() <= static_cast<std::int64_t>(k));
            at_edges.skip(edges[k]);
            REQUIRE(at_edges.emitted() == static_cast<std::int64_t>(k) + 1);
        }
    }
}

TEST_CASE("a train's end is found by looking at the times that it announces") {
    Random random(7, "ends");
    for (int i = 0; i < 500; ++i) {
        const PulseSegment s = any_segment(random, 5000);
        const RateUpdate update = i % 2 == 0 ? RateUpdate::continuous : RateUpdate::per_pulse;
        PulseTrain whole = train_of(s, update);
        whole.skip(never);
        PulseTrain train = train_of(s, update);
        INFO(s.start_rate << " -> " << s.end_rate << " Hz in " << s.count);
        std::int64_t time = 0;
        int looks = 0;
        for (; !train.ends(time); ++looks) {
            const std::int64_t next = train.end_not_before();
            REQUIRE(next <= whole.end().rounded());
            REQUIRE((next > time || looks == 0));
            time = next;
            train.skip(time);
            REQUIRE(looks < 200);
        }
        CHECK(time == whole.end().rounded());
    }
}

TEST_CASE("segments that follow each other do not drift") {
    Edges edges;
    const PulseSegment third{3, 3, 1};
    const PulseTime end =
        run_through(std::vector<PulseSegment>(30'000, third), RateUpdate::continuous, edges);
    CHECK(end.rounded() == 10'000'000'000'000);
    for (std::size_t k = 0; k < edges.size(); ++k)
        REQUIRE(edges[k] == static_cast<std::int64_t>((k * 2'000'000'000 + 3) / 6));
}

TEST_CASE("the longest train is exact") {
    const PulseSegment s{1, 1, 2'147'483'647};
    PulseTrain train = train_of(s, RateUpdate::per_pulse);
    train.skip(2'147'483'645'999'999'999);
    CHECK(train.emitted() == 2'147'483'646);
    std::int64_t last = 0;
    CHECK(train.take(never * 2 - 1, {&last, 1}) == 1);
    CHECK(last == 2'147'483'646'000'000'000);
    CHECK(train.end().rounded() == 2'147'483'647'000'000'000);
}
