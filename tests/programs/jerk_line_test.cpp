#include <algorithm>

#include <catch2/catch.hpp>

#include "blocks/pulse/pulse_train.hpp"
#include "runtime/model/random.hpp"
#include "tests/blocks/scanning.hpp"
#include "tests/programs/constant_jerk_line.hpp"
#include "tests/programs/twin.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// programs/paper/jerk_line.st and its twin, in both widths.
struct JerkLine : Twin<ConstantJerkLine> {
    void scan(const Scan& now) {
        static const st::Library in_lreal = compiled({"jerk_line.st", "jerk_line_lreal.st"});
        static const st::Library in_real = compiled({"jerk_line.st", "jerk_line_real.st"});
        scan_both(real == Width::real_32 ? in_real : in_lreal, "JerkLine", now, "real");
    }
};

JerkLine line(double x, double y) {
    JerkLine l;
    l.velocity = 1.5;
    l.pulses_per_length = 60'000;
    l.x.displacement = x;
    l.y.displacement = y;
    l.start = true;
    return l;
}

struct Sum {
    std::int64_t x = 0, y = 0, segments_x = 0, segments_y = 0;
};

/// Channels that are never busy: the pulses that the line sends in all.
Sum sent(JerkLine& l) {
    Sum sum;
    Clock clock;
    for (int i = 0; i < 10'000; ++i) {
        const std::int64_t x = l.x.job, y = l.y.job;
        clock.scan(l);
        if (l.x.job != x) sum.x += l.x.count;
        if (l.y.job != y) sum.y += l.y.count;
        sum.segments_x += l.x.job - x;
        sum.segments_y += l.y.job - y;
        if (!l.busy) break;
    }
    CHECK_FALSE(l.busy);
    return sum;
}

}  // namespace

TEST_CASE("truncated pulses are lost, carried ones are not") {
    JerkLine l = line(1.5, 1);
    const Sum cut = sent(l);
    CHECK(cut.x == 89'960);
    CHECK(cut.y == 59'960);
    CHECK(cut.segments_x == 80);
    CHECK(cut.segments_y == 78);
    CHECK(l.done);
    JerkLine carrying = line(1.5, 1);
    carrying.rounding = JerkLine::Rounding::carry;
    const Sum carried = sent(carrying);
    CHECK(carried.x == 90'000);
    CHECK(carried.y == 60'000);
}

TEST_CASE("pulses are carried to the nearest at every sample's end") {
    for (const auto width : {JerkLine::Width::real_32, JerkLine::Width::real_64}) {
        JerkLine l = line(3, 2.5);
        l.real = width;
        l.rounding = JerkLine::Rounding::carry;
        l.phases = ConstantJerkPhases::whole;
        l.chain = JerkLine::Chain::clock;
        Clock clock;
        std::int64_t x = 0, y = 0;
        do {
            const std::int64_t job_x = l.x.job, job_y = l.y.job;
            clock.scan(l);
            if (l.x.job != job_x) x += l.x.count;
            if (l.y.job != job_y) y += l.y.count;
            REQUIRE(std::abs(static_cast<double>(y) - l.gamma * static_cast<double>(x)) < 1);
        } while (l.busy);
        CHECK(x == 180'000);
        CHECK(y == 150'000);
    }
}

TEST_CASE("rates that fit put out the count within the period, and idle for less than a pulse") {
    Random random(9, "rates");
    const auto pick = [&](double high) {
        return high * static_cast<double>(random.next() % 10'000) / 10'000;
    };
    for (int i = 0; i < 300; ++i) {
        JerkLine l = line(0.002 + pick(8), pick(8));
        l.acceleration = 0.2 + pick(2);
        l.jerk = 0.2 + pick(5);
        l.rounding = JerkLine::Rounding::carry;
        l.rates = JerkLine::Rates::fit;
        l.phases = ConstantJerkPhases::whole;
        l.chain = JerkLine::Chain::clock;
        Clock clock;
        do {
            const std::int64_t job = l.x.job;
            clock.scan(l);
            if (l.x.job == job) continue;
            INFO(l.x.start_rate << " -> " << l.x.end_rate << " Hz in " << l.x.count);
            for (const auto update : {RateUpdate::continuous, RateUpdate::per_pulse}) {
                PulseTrain train;
                train.begin({l.x.start_rate, l.x.end_rate, l.x.count}, update, {});
                train.skip(1'000'000'000);
                const auto idle = static_cast<double>(50'000'000 - train.end().nanoseconds);
                REQUIRE(idle >= 0);
                const auto slower = std::min(l.x.start_rate, l.x.end_rate);
                REQUIRE(idle * static_cast<double>(slower) < 1e9);
            }
        } while (l.busy);
    }
}

TEST_CASE("the larger displacement leads, whichever axis and direction it has") {
    JerkLine a = line(2.5, -3), b = line(3, 2.5);
    const Sum swapped = sent(a), straight = sent(b);
    CHECK(swapped.x == straight.y);
    CHECK(swapped.y == straight.x);
    CHECK(a.y.reverse);
    CHECK_FALSE(a.x.reverse);
    CHECK(a.gamma == 2.5 / 3);
}

TEST_CASE("an axis below its threshold stands") {
    JerkLine l = line(1.5, 0.0009);
    CHECK(sent(l).segments_y == 0);
    JerkLine by_pulses = line(1.5, 0.01);
    by_pulses.threshold_pulses = 1000;
    CHECK(sent(by_pulses).segments_y == 0);
    JerkLine none = line(0, 0);
    CHECK(sent(none).segments_x == 0);
    CHECK_FALSE(none.done);
}

TEST_CASE("limits that are not above 0 are unreasonable and nothing moves") {
    for (double ConstantJerkLine::*limit :
         {&ConstantJerkLine::acceleration, &ConstantJerkLine::jerk, &ConstantJerkLine::velocity,
          &ConstantJerkLine::period}) {
        for (const double bad : {0.0, -1.0}) {
            JerkLine l = line(1, 1);
            l.*limit = bad;
            CHECK(sent(l).segments_x == 0);
            CHECK(l.unreasonable);
        }
    }
}

TEST_CASE("an interpolation time of at most 4 t1 is a warning, and the line runs") {
    JerkLine l = line(1.5, 1);
    l.interpolation_time = 4;
    CHECK(sent(l).x == 89'960);
    CHECK(l.short_time);
    JerkLine longer = line(1.5, 1);
    longer.interpolation_time = 4.001;
    sent(longer);
    CHECK_FALSE(longer.short_time);
}

TEST_CASE("the next sample waits for the leading channel, or for both, or for nothing") {
    using Chain = JerkLine::Chain;
    const auto sends = [](Chain chain, bool x_busy, bool y_busy) {
        JerkLine l = line(1.5, 1);
        l.chain = chain;
        Clock clock;
        clock.scan(l);
        REQUIRE(l.samples == 1);
        l.x.busy = x_busy;
        l.y.busy = y_busy;
        clock.scan(l);
        return l.samples == 2;
    };
    CHECK(sends(Chain::leading, false, true));
    CHECK_FALSE(sends(Chain::leading, true, false));
    CHECK_FALSE(sends(Chain::both, false, true));
    CHECK(sends(Chain::both, false, false));
    CHECK(sends(Chain::clock, true, true));
}

TEST_CASE("a line is done when both channels have ended") {
    JerkLine l = line(1.5, 1);
    Clock clock;
    clock.scan(l);
    CHECK_FALSE(l.y.interrupt);
    CHECK(l.x.interrupt);
    l.y.busy = true;
    for (int i = 0; i < 100; ++i) clock.scan(l);
    CHECK(l.busy);
    CHECK(l.y.interrupt);
    l.y.busy = false;
    clock.scan(l);
    CHECK(l.done);
    CHECK(l.duration == Approx(0.101));
}
