#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "runtime/model/random.hpp"
#include "tests/blocks/motion/bench.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr std::int64_t modes = 6;

/// Two moves by 40 mm, the second of them buffered, with limits of jerk.
constexpr const char* two_moves = R"(
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: axis, task: main, default_acceleration: 1000 mm/s^2, default_deceleration: 800 mm/s^2, default_jerk: 5e4 mm/s^3}
  one: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 40 mm}
  two: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 80 mm}
)";

double expected(std::int64_t mode, double v1, double v2) {
    const double velocities[] = {0, 0, std::min(v1, v2), v1, v2, std::max(v1, v2)};
    return velocities[mode];
}

/// The state in which the second motion begins.
MotionState junction(MotionBench& bench) {
    for (int i = 0; i < 10'000 && !bench.is("two.Active"); ++i) bench.step();
    REQUIRE(bench.is("two.Active"));
    CHECK(bench.is("one.Done"));
    return bench.axis("x").point_motion.plan.phases[0].start;
}

MotionState junction(std::int64_t mode, double v1, double v2) {
    MotionBench bench(two_moves);
    bench.set("one.Velocity", v1);
    bench.set("two.Velocity", v2);
    bench.set("two.BufferMode", mode);
    bench.set("one.Execute", true);
    bench.step(30);
    bench.set("two.Execute", true);
    return junction(bench);
}

}  // namespace

TEST_CASE("the end of the first move is passed exactly, with the velocity of the mode to 4 ulp") {
    for (std::int64_t mode = 1; mode < modes; ++mode)
        for (const auto& [v1, v2] : {std::pair{100.0, 50.0}, {50.0, 100.0}, {70.0, 69.0}}) {
            INFO("mode " << mode << ", " << v1 << " then " << v2);
            const MotionState start = junction(mode, v1, v2);
            CHECK(start.position == 40);
            CHECK(start.acceleration == 0);
            const double wanted = expected(mode, v1, v2);
            CHECK(std::abs(start.velocity - wanted) <=
                  4 * std::abs(std::nextafter(wanted, 1e9) - wanted));
        }
}

TEST_CASE("a mode that is aborting goes on from where the axis is") {
    MotionBench bench(two_moves);
    bench.set("one.Execute", true);
    bench.step(200);
    bench.set("two.Execute", true);
    bench.step(2);
    CHECK(bench.is("one.CommandAborted"));
    CHECK(bench.is("two.Active"));
    CHECK(bench.number("x.velocity") > 80);
}

TEST_CASE(
    "what a way is too short for is blended with what can be reached, without turning round") {
    Random random(1, "short ways");
    for (int i = 0; i < 300; ++i) {
        MotionBench bench(two_moves);
        const double first = random.share() * 5, second = random.share() * 5;
        const auto mode = static_cast<std::int64_t>(2 + random.next() % 4);
        bench.set("one.Position", first);
        bench.set("two.Position", first + second);
        bench.set("two.BufferMode", mode);
        bench.set("one.Execute", true);
        bench.set("two.Execute", true);
        INFO("by " << first << " and " << second << ", mode " << mode);
        double last = 0;
        for (int ms = 0; ms < 2000 && !bench.is("two.Done"); ++ms) {
            bench.step();
            REQUIRE(bench.number("x.position") >= last - 1e-12);
            last = bench.number("x.position");
        }
        CHECK(bench.number("x.position") == first + second);
    }
}

TEST_CASE("moves that part at their junction stand there") {
    MotionBench bench(two_moves);
    bench.set("two.Position", 10.0);
    bench.set("two.BufferMode", std::int64_t{5});
    bench.set("one.Execute", true);
    bench.set("two.Execute", true);
    CHECK(junction(bench).velocity == 0);
}

namespace {

struct QueuedMove {
    double end = 0;
    std::int64_t mode = 0;
    Dynamics d;
};

/// Moves in one direction, all of them blending, with limits that change at some of their ends.
std::vector<QueuedMove> any_queue(Random& random) {
    const auto any_of = [&](std::initializer_list<double> values) {
        return *(values.begin() + random.next() % values.size());
    };
    std::vector<QueuedMove> moves(2 + random.next() % 8);
    QueuedMove last;
    for (QueuedMove& move : moves) {
        if (last.end == 0 || random.next() % 2 == 0)
            last.d = {any_of({20, 50, 100, 100}), any_of({200, 500, 2000}),
                      any_of({300, 500, 1000}), any_of({2e3, 5e3, 1e5})};
        last.end += any_of({0.5, 2, 5, 10, 40}) * (0.5 + random.share());
        last.mode = static_cast<std::int64_t>(2 + random.next() % 4);
        move = last;
    }
    return moves;
}

struct Passed {
    double velocity = 0, acceleration = 0;
};

/// What was seen of a queue: how its moves began, when it was done, whether it turned round.
struct Drive {
    std::vector<Passed> begun;
    std::int64_t done = 0;  ///< [ms] after the first began
    std::string turned;     ///< where it turned round
};

Drive drive(const std::vector<QueuedMove>& moves, std::int64_t apart) {
    std::string program = "tasks: {main: {every: 1 ms}}\nblocks:\n  x: {type: axis, task: main}\n";
    for (std::size_t i = 0; i < moves.size(); ++i) {
        const auto& [end, mode, d] = moves[i];
        program += fmt::format(
            "  m{}: {{type: MC_MoveAbsolute, task: main, Axis: x, Position: {} mm, Velocity: {} "
            "mm/s, Acceleration: {} mm/s^2, Deceleration: {} mm/s^2, Jerk: {} mm/s^3, BufferMode: "
            "{}}}\n",
            i, end, d.velocity, d.acceleration, d.deceleration, d.jerk,
            buffer_mode_names[static_cast<std::size_t>(mode)]);
    }
    MotionBench bench(program);
    Drive seen;
    const std::string last = fmt::format("m{}.Done", moves.size() - 1);
    std::int64_t first = 0;
    std::size_t sent = 0;
    for (std::int64_t ms = 0; ms < 60'000 && !bench.is(last); ++ms) {
        for (; sent < moves.size() && static_cast<std::int64_t>(sent) * apart <= ms; ++sent)
            bench.set(fmt::format("m{}.Execute", sent), true);
        bench.step();
        const double back = bench.number("x.velocity");
        if (back < -1e-6 && seen.turned.empty())
            seen.turned = fmt::format("at {} ms in move {}", bench.now(), seen.begun.size() - 1);
        if (seen.begun.size() == moves.size()) continue;
        if (!bench.is(fmt::format("m{}.Active", seen.begun.size()))) continue;
        if (seen.begun.empty()) first = bench.now();
        const MotionState& start = bench.axis("x").point_motion.plan.phases[0].start;
        seen.begun.push_back({start.velocity, start.acceleration});
    }
    seen.done = bench.now() - first;
    CHECK(bench.number("x.position") == moves.back().end);
    return seen;
}

/// Moves of the same limits, as one.
struct Stretch {
    double way = 0;
    Dynamics d;
    double wanted = 0;  ///< where it begins
    std::size_t first = 0;
};

std::vector<Stretch> stretches(const std::vector<QueuedMove>& moves) {
    std::vector<Stretch> all;
    double from = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
        const QueuedMove& move = moves[i];
        if (i == 0 || move.d != moves[i - 1].d)
            all.push_back(
                {0, move.d,
                 i == 0 ? 0 : expected(move.mode, moves[i - 1].d.velocity, move.d.velocity), i});
        all.back().way += move.end - from;
        from = move.end;
    }
    return all;
}

/// By plans alone: the duration of one on the way that does not turn round; empty if there is none.
std::optional<double> planned(double from, double to, const Stretch& s) {
    PointMotion motion;
    const auto plan = [&](double way, double v) {
        return motion.begin({.velocity = from}, way, v, s.d, {}) == PlanResult::ok &&
               !motion.turns(1);
    };
    if (to > s.d.velocity && plan(s.way - ramp_way(s.d.velocity, to, s.d), s.d.velocity))
        return motion.plan.duration + ramp_duration(to - s.d.velocity, s.d.acceleration, s.d.jerk);
    if (!plan(s.way, to)) return {};
    return motion.plan.duration;
}

constexpr int levels = 200;

/// What the rounding of a way of 100 mm is worth at 1e5 mm/s^3: 4e-11 mm from standstill [mm/s].
constexpr double unresolved = 1e-5;

/// Velocities from `most` down to 1e-7, and these among them: where the way is short only few fit.
std::vector<double> tried_up_to(double most, std::initializer_list<double> these) {
    std::vector<double> all;
    for (double v = most; v > 1e-7; v -= std::min(most / levels, 0.2 * v)) all.push_back(v);
    for (const double v : these)
        if (v > 1e-7 && v < most) all.push_back(v);
    std::sort(all.rbegin(), all.rend());
    return all;
}

/// The greatest velocity that is possible, by trying from above; 0: none.
template <class Possible>
double greatest(const std::vector<double>& velocities, const Possible& possible) {
    double high = velocities.empty() ? 0 : velocities.front();
    for (double low : velocities) {
        if (possible(low)) {
            for (int k = 0; k < 40; ++k) {
                const double middle = 0.5 * (low + high);
                (possible(middle) ? low : high) = middle;
            }
            return low;
        }
        high = low;
    }
    return 0;
}

/// With which velocities at most each stretch may begin, looked for by trial.
std::vector<double> searched(const std::vector<Stretch>& all) {
    std::vector<double> admissible(all.size() + 1, 0.0);
    for (std::size_t i = all.size() - 1; i > 0; --i) {
        const double exit = admissible[i + 1], own = all[i].d.velocity;
        const auto leads = [&](double from) {
            const auto fits = [&](double to) { return planned(from, to, all[i]).has_value(); };
            for (const double to : {exit, from, own})
                if (to <= exit && fits(to)) return true;
            for (int k = levels; k >= 0; k -= 4)
                if (fits(exit * k / levels)) return true;
            return false;
        };
        admissible[i] = greatest(tried_up_to(all[i].wanted, {exit, own}), leads);
    }
    return admissible;
}

}  // namespace

TEST_CASE("a queue of blending moves is driven as a search by trial finds it") {
    const std::int64_t count = count_of("LINESHAFT_QUEUES", 60);
    for (std::int64_t seed = 1; seed <= count; ++seed) {
        Random random(static_cast<std::uint64_t>(seed), "queues");
        const auto moves = any_queue(random);
        const auto all = stretches(moves);
        INFO("seed " << seed << ", " << moves.size() << " moves, " << all.size() << " stretches");
        const Drive seen = drive(moves, 0);
        CHECK(seen.turned == "");
        const auto admissible = searched(all);
        double least = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Passed& at = seen.begun[all[i].first];
            const auto leads = [&](double to) {
                return planned(seen.begun[all[i - 1].first].velocity, to, all[i - 1]).has_value();
            };
            const double tried =
                i == 0 ? 0
                       : greatest(tried_up_to(admissible[i], {seen.begun[all[i - 1].first].velocity,
                                                              all[i - 1].d.velocity}),
                                  leads);
            INFO("move " << all[i].first << " begins with " << at.velocity << ", by trial with "
                         << tried);
            CHECK(at.acceleration == 0);
            CHECK(at.velocity <= all[i].wanted * (1 + 1e-12));
            CHECK(at.velocity >= tried * (1 - 1e-6) - unresolved);
            CHECK(at.velocity <= tried * (1 + 1e-6) + unresolved);
            const double to = i + 1 < all.size() ? seen.begun[all[i + 1].first].velocity : 0;
            Stretch roomy = all[i];
            roomy.way *= 1 + 1e-9;
            const auto part = planned(at.velocity, to, roomy);
            REQUIRE(part);
            least += *part;
        }
        CHECK(static_cast<double>(seen.done) >= 1000 * least - 1);
        CHECK(static_cast<double>(seen.done) <= 1000 * least + 2);
    }
}

TEST_CASE("a queue that comes while it is driven does not turn round either") {
    for (int seed = 1; seed <= 40; ++seed) {
        Random random(static_cast<std::uint64_t>(seed), "late queues");
        INFO("seed " << seed);
        CHECK(drive(any_queue(random), static_cast<std::int64_t>(random.next() % 80)).turned == "");
    }
}

TEST_CASE("two moves with the same limits are driven as one over the way of both") {
    for (std::int64_t mode = 2; mode < modes; ++mode) {
        MotionBench bench(two_moves), alone(two_moves);
        for (const char* move : {"one", "two"}) bench.set(fmt::format("{}.Velocity", move), 70.0);
        alone.set("one.Velocity", 70.0);
        alone.set("one.Position", 80.0);
        bench.set("two.BufferMode", mode);
        bench.set("one.Execute", true);
        alone.set("one.Execute", true);
        bool was_active = false;
        double before = 0, apart = 0;
        for (int ms = 0; ms < 3000 && !bench.is("two.Done"); ++ms) {
            if (ms == 30) bench.set("two.Execute", true);
            bench.step();
            alone.step();
            const double now = bench.number("x.position");
            apart = std::max(apart, std::abs(now - alone.number("x.position")));
            if (bench.is("two.Active") && !was_active) {
                INFO("mode " << mode << ", passes 40 mm between " << before << " and " << now);
                CHECK(before < 40);
                CHECK(now >= 40);
                CHECK(bench.number("x.velocity") == Approx(70).epsilon(1e-14));
                CHECK(bench.is("one.Done"));
            }
            was_active = was_active || bench.is("two.Active");
            before = now;
        }
        CHECK(was_active);
        CHECK(apart < 1e-11);
        CHECK(bench.is("two.Done"));
        CHECK(alone.is("one.Done"));
        CHECK(bench.number("x.position") == 80);
    }
}

TEST_CASE("near a limit a junction is passed as fast as the axis could still brake inside") {
    MotionBench bench(R"(
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: axis, task: main, default_acceleration: 1000 mm/s^2, default_deceleration: 800 mm/s^2, default_jerk: 5e4 mm/s^3, software_limits: true, lowest_position: 0 mm, highest_position: 45 mm}
  one: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 40 mm, Velocity: 100 mm/s}
  two: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 45 mm, Velocity: 100 mm/s, Deceleration: 8000 mm/s^2, Jerk: 1e6 mm/s^3, BufferMode: mcBlendingPrevious}
)");
    bench.set("one.Execute", true);
    bench.set("two.Execute", true);
    const double v = junction(bench).velocity;
    const Dynamics defaults{100, 1000, 800, 5e4};
    CHECK(ramp_way(v, 0, defaults) <= 5 * (1 + 1e-9) + 1e-9);
    CHECK(ramp_way(v * (1 + 1e-6), 0, defaults) > 5);
    for (int i = 0; i < 3000 && !bench.is("two.Done"); ++i) bench.step();
    CHECK(bench.is("two.Done"));
    CHECK(bench.number("x.position") == 45);
}

TEST_CASE("a move on a stretch is not refused at a limit that only its own end would overrun") {
    MotionBench bench(R"(
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: axis, task: main, default_velocity: 80 mm/s, default_acceleration: 1000 mm/s^2, default_deceleration: 8000 mm/s^2, default_jerk: 1e6 mm/s^3, software_limits: true, lowest_position: 0 mm, highest_position: 45 mm}
  one: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 30 mm, Deceleration: 200 mm/s^2}
  two: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 35 mm, Deceleration: 200 mm/s^2, BufferMode: mcBlendingPrevious}
  three: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 40 mm, Deceleration: 200 mm/s^2, BufferMode: mcBlendingPrevious}
  four: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 45 mm, BufferMode: mcBlendingPrevious}
)");
    for (const char* move : {"one", "two", "three", "four"})
        bench.set(fmt::format("{}.Execute", move), true);
    for (int i = 0; i < 3000 && !bench.is("three.Active"); ++i) bench.step();
    CHECK(bench.is("three.Active"));
    CHECK(bench.number("x.velocity") == Approx(80));
    for (int i = 0; i < 3000 && !bench.is("four.Done"); ++i) bench.step();
    CHECK(bench.is("four.Done"));
    CHECK(bench.number("x.position") == 45);
    CHECK_FALSE(bench.is("three.Error"));
}

TEST_CASE("moves of one kind in a row take as long as one") {
    std::vector<QueuedMove> six;
    for (int i = 1; i <= 6; ++i) six.push_back({10.0 * i, 2 + i % 4, {100, 500, 500, 5000}});
    const std::int64_t one = drive({six.back()}, 0).done;
    CHECK(drive(six, 0).done == one);
}

TEST_CASE("a command behind a hundred that blend is taken up within 50 us") {
#ifdef NDEBUG
    constexpr double most = 50;
#else
    constexpr double most = 1000;
#endif
    for (const auto& [way, alike] : {std::pair{2.0, true}, {2.0, false}, {0.05, false}}) {
        std::string program =
            "tasks: {main: {every: 1 ms}}\nblocks:\n  x: {type: axis, task: main}\n";
        for (int i = 0; i <= 101; ++i)
            program += fmt::format(
                "  m{}: {{type: MC_MoveRelative, task: main, Axis: x, Distance: {} mm, Velocity: "
                "{} "
                "mm/s, Acceleration: 500 mm/s^2, Deceleration: 500 mm/s^2, Jerk: 5000 mm/s^3, "
                "BufferMode: mcBlendingNext}}\n",
                i, way, alike ? 50 : 30 + i % 7 * 10);
        MotionBench bench(program);
        double least = 1e9, idle = 1e9;
        for (int trial = 0; trial < 20; ++trial) {
            bench.restart();
            for (int i = 0; i <= 100; ++i) bench.set(fmt::format("m{}.Execute", i), true);
            bench.step(5);
            const auto slowest_of_three = [&] {
                double slowest = 0;
                for (int i = 0; i < 3; ++i) {
                    const auto start = std::chrono::steady_clock::now();
                    bench.step();
                    const std::chrono::duration<double, std::micro> taken =
                        std::chrono::steady_clock::now() - start;
                    slowest = std::max(slowest, taken.count());
                }
                return slowest;
            };
            idle = std::min(idle, slowest_of_three());
            bench.set("m101.Execute", true);
            least = std::min(least, slowest_of_three());
        }
        INFO(way << " mm each: " << least << " us of a scan with the command, " << idle
                 << " us without");
        CHECK(least - idle <= most);
    }
}

TEST_CASE("a move that is begun anew while it waits leaves the one at work standing at its end") {
    MotionBench bench(two_moves);
    bench.set("two.BufferMode", std::int64_t{3});
    bench.set("one.Execute", true);
    bench.set("two.Execute", true);
    bench.step(300);
    bench.set("two.Execute", false);
    bench.step(1);
    bench.set("two.Position", 10.0);
    bench.set("two.Execute", true);
    double most = 0;
    for (int i = 0; i < 3000 && !bench.is("two.Done"); ++i) {
        bench.step();
        most = std::max(most, bench.number("x.position"));
    }
    CHECK(bench.is("two.Done"));
    CHECK(bench.number("x.position") == 10);
    CHECK(most <= 40 + 1e-9);
}
