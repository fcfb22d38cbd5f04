#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/motion/synchronous.hpp"
#include "tests/blocks/motion/bench.hpp"
#include "tests/blocks/profile/oracle.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// A master that is told to move otherwise up to six times, and a slave that is to be at a
/// position, or on a cam, when the master comes to one.
struct Approach {
    struct Turn {
        std::int64_t at = 0;  ///< [ms]
        double velocity = 0;  ///< of the master from then on [mm/s]
    };

    double V = 1, A = 1, D = 1, J = 1;  ///< of the command
    double own_a = 1, own_j = 1;        ///< of the slave's axis, which brakes after an error
    double master_a = 1, master_j = 0;
    double ratio = 1, way = 1, rise = 1, before = 0;
    bool cam = false;
    std::int64_t coupled = 1;
    std::vector<Turn> turns;

    std::string program() const;
};

Approach draw(std::uint64_t seed) {
    oracle::Random random{seed};
    Approach a;
    a.V = random.decades(1.5, 3);
    a.A = a.V * random.decades(0.5, 1.5);
    a.D = random.one_in(3) ? a.A * random.decades(-0.5, 0.5) : a.A;
    a.J = a.A * random.decades(0.5, 2);
    a.own_a = a.A * random.decades(-0.3, 0.5);
    a.own_j = a.J * random.decades(-0.3, 0.5);
    a.master_a = a.A * random.decades(-1, 0.3);
    a.master_j = random.one_in(3) ? 0 : a.master_a * random.decades(0.5, 3);
    a.ratio = random.one_in(4) ? random.sign() * random.between(0.3, 2) : 1;
    a.way = random.between(0.2, 3) * a.V;
    a.rise = a.ratio * a.way * random.between(0.2, 1.2);
    a.before = random.one_in(4) ? random.between(-0.3, 0.6) * a.V : 0;
    a.cam = random.one_in(4);
    a.coupled = random.one_in(2) ? 1 : static_cast<std::int64_t>(random.between(1, 600));
    const bool wild = random.one_in(4);
    std::int64_t at = random.one_in(2) ? 0 : 300;
    for (double i = random.between(1, 6); i > 0; --i) {
        const double speed =
            wild && random.one_in(3) ? random.between(-0.5, 0.2) : random.between(0.05, 0.8);
        a.turns.push_back({at, a.V * speed / std::max(1.0, std::abs(a.ratio))});
        at += static_cast<std::int64_t>(random.decades(0, 3));
    }
    return a;
}

std::string Approach::program() const {
    std::string text = fmt::format(
        "tasks: {{main: {{every: 1 ms}}}}\nblocks:\n"
        "  m: {{type: axis, task: main, default_velocity: {0} mm/s, default_acceleration: {1} "
        "mm/s^2, default_deceleration: {1} mm/s^2, default_jerk: {2} mm/s^3}}\n"
        "  s: {{type: axis, task: main, default_velocity: {0} mm/s, default_acceleration: {3} "
        "mm/s^2, default_deceleration: {3} mm/s^2, default_jerk: {4} mm/s^3}}\n"
        "  table: {{type: cam_table, task: main, points: [[0 mm, 0 mm, {5} mm/mm, 0 mm/mm^2], "
        "[1e5 mm, {6} mm, {5} mm/mm, 0 mm/mm^2]]}}\n"
        "  select: {{type: MC_CamTableSelect, task: main, Master: m, Slave: s, CamTable: table, "
        "Execute: true}}\n"
        "  move: {{type: MC_MoveVelocity, task: main, Axis: s, Velocity: {7} mm/s}}\n",
        V, master_a, master_j, own_a, own_j, ratio, ratio * 1e5, before);
    for (std::size_t i = 0; i < turns.size(); ++i)
        text += fmt::format(
            "  turn{}: {{type: MC_MoveVelocity, task: main, Axis: m, Velocity: {} "
            "mm/s}}\n",
            i, turns[i].velocity);
    const std::string limits = fmt::format(
        "Velocity: {} mm/s, Acceleration: {} mm/s^2, Deceleration: {} mm/s^2, Jerk: {} "
        "mm/s^3",
        V, A, D, J);
    if (cam)
        return text + fmt::format(
                          "  go: {{type: MC_CamIn, task: main, Master: m, Slave: s, "
                          "CamTableID: select.CamTableID, MasterSyncPosition: {} mm, "
                          "SlaveOffset: {} mm, {}}}\n",
                          way, rise - ratio * way, limits);
    return text + fmt::format(
                      "  go: {{type: MC_GearInPos, task: main, Master: m, Slave: s, "
                      "RatioNumerator: {}, MasterSyncPosition: {} mm, "
                      "SlaveSyncPosition: {} mm, {}}}\n",
                      ratio, way, rise, limits);
}

enum class End { in_sync, refused, error_stop, never };

struct Judged {
    End end = End::never;
    std::string broken;  ///< what did not hold, and when; empty: nothing
};

/// How far a slave goes that brakes, and then runs up to the speed of the law. While the master
/// changes its own, a piece of constant jerk from a state without acceleration ends a timed motion.
double least_way(const MotionState& s, double speed, const MotionState& master, const Approach& a) {
    const Dynamics d{a.V, std::min(a.A, a.D), std::min(a.A, a.D), a.J};
    const double most = master.acceleration == 0 ? 0 : std::abs(a.ratio) * a.master_a;
    return stopping_position(s, d) - s.position + ramp_way(0, speed, d) + speed * most / a.J;
}

Judged judge(const Approach& a) {
    MotionBench bench(a.program());
    Judged judged;
    MotionState last;
    double greatest = 0;
    for (const auto& turn : a.turns) greatest = std::max(greatest, turn.velocity * a.ratio);
    const auto breaks = [&](const char* what, double value, double limit) {
        if (judged.broken.empty())
            judged.broken = fmt::format("{} is {} at {} ms, and {} is the limit", what, value,
                                        bench.now(), limit);
    };
    bool coupled = false, asked_back = a.before < 0 || a.ratio < 0;
    const std::int64_t most = a.turns.back().at + 20'000;
    for (std::int64_t i = 0; i < most && judged.broken.empty(); ++i) {
        if (i == 0) bench.set("move.Execute", a.before != 0);
        for (std::size_t n = 0; n < a.turns.size(); ++n)
            if (i == a.turns[n].at) bench.set(fmt::format("turn{}.Execute", n), true);
        if (i == a.coupled) bench.set("go.Execute", true);
        bench.step();
        const Axis& slave = bench.axis("s");
        const MotionState now = slave.total();
        const double jerk = (now.acceleration - last.acceleration) / 1e-3;
        constexpr double more = 1 + 1e-6, slack = 1e-6;
        const bool stops = slave.state == AxisState::error_stop;
        const bool follows =
            slave.state == AxisState::synchronized_motion && !bench.is("go.InSync");
        if (follows && coupled) {
            if (std::abs(now.velocity) > a.V * more + slack)
                breaks("the velocity", now.velocity, a.V);
            // A greater one that its own dynamics have left it falls by the whole jerk.
            const double inherited = std::abs(last.acceleration) - a.J * 1e-3;
            const double A = std::max({a.A, a.D, inherited});
            if (std::abs(now.acceleration) > A * more + slack)
                breaks("the acceleration", now.acceleration, A);
            if (std::abs(jerk) > a.J * more + slack) breaks("the mean jerk", jerk, a.J);
            if (std::abs(now.jerk) > a.J * more + slack) breaks("the jerk", now.jerk, a.J);
        }
        if (stops) {
            const double A = std::max({a.A, a.D, a.own_a}), J = std::max(a.own_j, a.J);
            if (std::abs(now.acceleration) > A * more + slack)
                breaks("the acceleration of the stop", now.acceleration, A);
            if (std::abs(jerk) > J * more + slack) breaks("the jerk of the stop", jerk, J);
            if (now.velocity == 0 && now.acceleration == 0) judged.end = End::error_stop;
        }
        const double step = now.position - last.position;
        const double mean = 0.5e-3 * (last.velocity + now.velocity);
        if (i > 0 && !bench.is("go.InSync") && std::abs(step - mean) > 1e-6 * a.J + 1e-9)
            breaks("the step", step, mean);
        if (follows && !asked_back && now.velocity < -slack)
            breaks("the velocity backwards", now.velocity, 0);
        if (follows)
            asked_back |=
                a.rise - now.position < least_way(now, greatest, bench.axis("m").total(), a);
        last = now;
        coupled = follows;
        if (bench.is("go.InSync"))
            judged.end = End::in_sync;
        else if (!stops && bench.is("go.Error"))
            judged.end = End::refused;
        if (judged.end != End::never) break;
    }
    return judged;
}

/// The same failure with less: turns left out, numbers rounded.
Approach shrunk(Approach a) {
    for (bool smaller = true; smaller;) {
        smaller = false;
        const auto try_it = [&](const Approach& less) {
            if (judge(less).broken.empty()) return;
            a = less;
            smaller = true;
        };
        for (std::size_t i = 0; i < a.turns.size() && a.turns.size() > 1 && !smaller; ++i) {
            Approach less = a;
            less.turns.erase(less.turns.begin() + static_cast<std::ptrdiff_t>(i));
            try_it(less);
        }
        for (double Approach::*number : {&Approach::V, &Approach::A, &Approach::D, &Approach::J,
                                         &Approach::own_a, &Approach::own_j, &Approach::master_a,
                                         &Approach::master_j, &Approach::way, &Approach::rise}) {
            Approach less = a;
            const double scale = std::pow(10, std::floor(std::log10(std::abs(a.*number) + 1e-9)));
            less.*number = std::round(a.*number / scale) * scale;
            if (!smaller && less.*number != a.*number) try_it(less);
        }
    }
    return a;
}

}  // namespace

TEST_CASE("random approaches: limits are kept until a slave is in sync, whatever its master does") {
    const char* only = std::getenv("LINESHAFT_SEED");
    const auto first = static_cast<std::uint64_t>(count_of("LINESHAFT_SEED", 1));
    const auto count = static_cast<std::uint64_t>(count_of("LINESHAFT_APPROACHES", only ? 1 : 100));
    std::array<std::uint64_t, 4> ends{};
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        const Approach approach = draw(seed);
        const Judged judged = judge(approach);
        ++ends[static_cast<std::size_t>(judged.end)];
        if (judged.broken.empty()) continue;
        const Approach less = shrunk(approach);
        std::string times;
        for (const auto& turn : less.turns) times += fmt::format(" turn at {} ms", turn.at);
        oracle::print_failure(judge(less).broken,
                              fmt::format("seed {}, coupled at {} ms,{}:\n{}", seed, less.coupled,
                                          times, less.program()));
        FAIL("seed " << seed << ": " << judged.broken);
    }
    if (std::getenv("LINESHAFT_FIGURES"))
        fmt::print("{} approaches: {} in sync, {} refused, {} ErrorStop, {} not met\n", count,
                   ends[0], ends[1], ends[2], ends[3]);
    if (!only) CHECK(ends[0] > count / 2);
}
