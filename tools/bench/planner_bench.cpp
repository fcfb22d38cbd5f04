#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <dlfcn.h>

#include "blocks/profile/any_state.hpp"
#include "blocks/profile/seven_segment.hpp"
#include "blocks/profile/velocity_ramp.hpp"
#include "tools/bench/planner_peer.hpp"
#include "tools/bench/quickest.hpp"

using namespace lineshaft;

namespace {

/// SplitMix64: the same problems on every machine.
struct Random {
    std::uint64_t state;

    std::uint64_t next() {
        std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    double decades(double low, double high) { return std::pow(10, between(low, high)); }
};

double ramp_length(double from, double to, double A, double J) {
    return 0.5 * (from + to) * ramp_duration(to - from, A, J);
}

/// One third of the problems each: one ramp only, with a peak, with cruise.
SevenSegment random_problem(Random& random) {
    SevenSegment p;
    p.A = random.decades(0, 4);
    p.J = p.A * random.decades(0, 3);
    p.Vm = p.A * p.A / p.J * random.decades(-1.5, 1.5);
    p.Vs = p.Vm * random.unit();
    p.Ve = p.Vm * random.unit();
    const double first = ramp_length(p.Vs, p.Ve, p.A, p.J);
    const double second = ramp_length(p.Vs, p.Vm, p.A, p.J) + ramp_length(p.Vm, p.Ve, p.A, p.J);
    switch (random.next() % 3) {
        case 0:
            p.L = first * random.unit();
            break;
        case 1:
            p.L = random.between(first, second);
            break;
        default:
            p.L = second * random.decades(0, 2);
    }
    return p;
}

std::vector<SevenSegment> problems(std::size_t count) {
    Random random{2023};
    std::vector<SevenSegment> list(count);
    for (SevenSegment& p : list) p = random_problem(random);
    return list;
}

std::vector<SevenSegment> problems_of(MoveKind kind) {
    Random random{2023};
    std::vector<SevenSegment> list;
    SevenSegmentPlan out;
    for (int tries = 0; tries < 1000000 && list.size() < 4096; ++tries) {
        const SevenSegment p = random_problem(random);
        if (plan(p, out) == PlanResult::ok && out.kind == kind) list.push_back(p);
    }
    return list;
}

/// Items of a loop.
constexpr std::size_t share = 4096;

struct Change {
    double v0, a0, v1, A, J;
};

std::vector<Change> changes(std::size_t count = share) {
    Random random{2025};
    std::vector<Change> list(count);
    for (Change& c : list) {
        c.A = random.decades(0, 4);
        c.J = c.A * random.decades(0, 3);
        const double step = c.A * c.A / c.J;
        c.v0 = step * random.between(-10, 10);
        c.a0 = random.next() % 2 ? 0 : c.A * random.between(-1, 1);
        c.v1 = c.v0 + step * random.between(-3, 3);
    }
    return list;
}

double bare_ramps(const std::vector<Change>& list) {
    double sum = 0;
    for (const Change& c : list) sum += ramp_duration(c.v1 - c.v0, c.A, c.J);
    return sum;
}

/// One bare ramp formula [ns], the least of many repetitions: what the ratios stand on.
double measure_baseline() {
    const std::vector<Change> list = changes();
    Quickest quickest;
    for (int i = 0; i < 1000; ++i)
        quickest.time([&] { benchmark::DoNotOptimize(bare_ramps(list)); });
    return quickest.per(list.size());
}

double baseline = 0;

/// Runs the loop, which handles some thousand items, and counts for each item `mean` [ns of
/// processor time], `least` [ns, the quickest loop] and `ratio` (least to the bare ramp formula).
template <typename Loop>
void measure(benchmark::State& state, std::size_t items, const Loop& loop) {
    const std::clock_t start = std::clock();
    Quickest quickest;
    for (auto _ : state) quickest.time(loop);
    const double taken = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    const auto handled = static_cast<double>(state.iterations()) * static_cast<double>(items);
    state.counters["mean"] = taken / handled * 1e9;
    quickest.count(state, items);
    state.counters["ratio"] = quickest.per(items) / baseline;
}

void bare_ramp(benchmark::State& state) {
    const std::vector<Change> list = changes();
    measure(state, list.size(), [&] { benchmark::DoNotOptimize(bare_ramps(list)); });
}

/// Each loop takes the next few thousand items of the list: the processor foretells no branch that
/// it has seen before, unless the list is that short.
template <typename Item, typename Body>
void measure_stream(benchmark::State& state, const std::vector<Item>& list, const Body& body) {
    const std::size_t part = std::min(list.size(), share);
    std::size_t next = 0;
    measure(state, part, [&] {
        if (next + part > list.size()) next = 0;
        for (const std::size_t last = next + part; next < last; ++next) body(list[next]);
    });
}

void velocity_ramp(benchmark::State& state, const std::vector<Change>& list) {
    VelocityRamp ramp;
    measure_stream(state, list, [&](const Change& c) {
        benchmark::DoNotOptimize(ramp.plan(c.v0, c.a0, c.v1, c.A, c.J));
        benchmark::ClobberMemory();
    });
}

void plan_all(benchmark::State& state, const std::vector<SevenSegment>& list) {
    SevenSegmentPlan out;
    measure_stream(state, list, [&](const SevenSegment& p) {
        benchmark::DoNotOptimize(plan(p, out));
        benchmark::ClobberMemory();
    });
}

struct Reach {
    MotionLimits limits;
    MotionState from;
    Goal to;
    double duration = 0;  ///< 1.2 times the least
};

enum class From : std::int64_t { any_state, rest, near, last_ramp };

/// Normally distributed (Box and Muller).
double normal(Random& random, double deviation) {
    const double radius = std::sqrt(-2 * std::log(1 - random.unit()));
    return deviation * radius * std::cos(6.283185307179586 * random.unit());
}

/// Random states as Ruckig's own benchmark draws them, within limits that are the same both ways.
std::vector<Reach> peer_states() {
    Random random{2029};
    std::vector<Reach> list;
    MotionPlan out;
    const auto some = [&](double part) { return random.unit() < part ? normal(random, 0.8) : 0; };
    while (list.size() < 65536) {
        Reach r;
        r.from = {normal(random, 4), some(0.9), some(0.8), 0};
        r.to = {normal(random, 4), some(0.7)};
        const double V = random.between(0.1, 12) + std::abs(r.to.velocity);
        const double A = random.between(0.1, 12);
        r.limits.set(V, -V, A, A, random.between(0.1, 12));
        if (plan(r.limits, r.from, r.to, out) != PlanResult::ok) continue;
        r.duration = 1.2 * out.duration;
        list.push_back(r);
    }
    return list;
}

std::vector<Reach> reaches(From kind) {
    Random random{2026};
    std::vector<Reach> list;
    MotionPlan out;
    while (list.size() < 65536) {
        Reach r;
        const double A = random.decades(0, 4), J = A * random.decades(0, 3);
        const double V = A * A / J * random.decades(-1.5, 1.5);
        r.limits.set(V, -V * random.between(0.3, 1), A, A * random.between(0.3, 1), J);
        const bool near = kind == From::near;  // from rest to rest, too
        const double way =
            V * ramp_duration(V, A, J) * (near ? random.decades(-9, -4) : random.decades(-3, 1));
        r.to.position = random.next() % 2 ? way : -way;
        if (kind == From::any_state) {
            r.to.velocity = random.next() % 2 ? 0 : V * random.between(-0.3, 1);
            r.from.velocity = V * random.between(-0.3, 1);
            r.from.acceleration = random.next() % 3 ? A * random.between(-0.3, 1) : 0;
        }
        if (plan(r.limits, r.from, r.to, out) != PlanResult::ok) continue;
        r.duration = 1.2 * out.duration;
        if (kind == From::last_ramp && out.count > 2)
            r.from = out.at(out.phases[out.count - 2].begin +
                            out.phases[out.count - 2].duration * random.unit());
        list.push_back(r);
    }
    return list;
}

/// In the least time, or in a given one.
void plan_reaches(benchmark::State& state, const std::vector<Reach>& list, bool timed) {
    MotionPlan out;
    measure_stream(state, list, [&](const Reach& r) {
        benchmark::DoNotOptimize(timed ? plan(r.limits, r.from, r.to, r.duration, out)
                                       : plan(r.limits, r.from, r.to, out));
        benchmark::ClobberMemory();
    });
}

/// What another planner, which `peers` builds and names in LINESHAFT_PEER, takes for the same;
/// `failures`: refused, `late`: taking longer by more than 1e-7.
struct PlannerPeer {
    decltype(&planner_peer_prepare) prepare = nullptr;
    decltype(&planner_peer_plan) plan = nullptr;
    decltype(&planner_peer_release) release = nullptr;

    explicit PlannerPeer(const char* file) {
        void* const object = ::dlopen(file, RTLD_NOW);
        if (!object) return;
        prepare = reinterpret_cast<decltype(prepare)>(::dlsym(object, "planner_peer_prepare"));
        plan = reinterpret_cast<decltype(plan)>(::dlsym(object, "planner_peer_plan"));
        release = reinterpret_cast<decltype(release)>(::dlsym(object, "planner_peer_release"));
    }
    explicit operator bool() const { return prepare && plan && release; }
};

void plan_by_peer(benchmark::State& state, const std::vector<Reach>& list, bool timed,
                  const PlannerPeer& peer) {
    std::vector<PeerProblem> problems;
    std::vector<std::size_t> order;
    for (const Reach& r : list) {
        const MotionLimits::Side& side = r.limits.side[0];
        order.push_back(problems.size());
        problems.push_back({side.V, -r.limits.side[1].V, side.A, side.D, r.limits.J,
                            r.from.position, r.from.velocity, r.from.acceleration, r.to.position,
                            r.to.velocity, timed ? r.duration : 0});
    }
    void* const prepared = peer.prepare(problems.data(), problems.size());
    double failures = 0, late = 0;
    MotionPlan own;
    for (const std::size_t i : order) {
        const Reach& r = list[i];
        const double taken = peer.plan(prepared, i);
        timed ? plan(r.limits, r.from, r.to, r.duration, own) : plan(r.limits, r.from, r.to, own);
        failures += std::isnan(taken);
        late += taken > own.duration * (1 + 1e-7);
    }
    measure_stream(state, order,
                   [&](std::size_t i) { benchmark::DoNotOptimize(peer.plan(prepared, i)); });
    peer.release(prepared);
    state.counters["failures"] = failures;
    state.counters["late"] = late;
}

void evaluate_reach(benchmark::State& state) {
    const Reach r = reaches(From::any_state).front();
    MotionPlan out;
    plan(r.limits, r.from, r.to, out);
    constexpr int points = 4096;
    const double step = out.duration / points;
    measure(state, points, [&] {
        std::size_t phase = 0;
        for (int i = 0; i < points; ++i) benchmark::DoNotOptimize(out.at(step * i, phase).position);
    });
}

template <typename Motion>
void evaluate(benchmark::State& state, const Motion& motion) {
    constexpr int points = 4096;
    const double step = motion.duration / points;
    measure(state, points, [&] {
        for (int i = 0; i < points; ++i) benchmark::DoNotOptimize(motion.at(step * i).position);
    });
}

/// A motion, and a time in it.
template <typename Motion>
struct Instant {
    Motion motion;
    double time = 0;
};

/// Each motion of a quarter of a million once in a round, at a time of its own: beyond the caches
/// of one core.
template <typename Motion, typename Make>
void evaluate_stream(benchmark::State& state, const Make& make) {
    Random random{2027};
    std::vector<Instant<Motion>> list(std::size_t{1} << 18);
    for (Instant<Motion>& each : list) {
        make(random, each.motion);
        each.time = each.motion.duration * random.unit();
    }
    measure_stream(state, list, [](const Instant<Motion>& each) {
        benchmark::DoNotOptimize(each.motion.at(each.time).position);
    });
}

void evaluate_ramps(benchmark::State& state) {
    const std::vector<Change> list = changes(std::size_t{1} << 18);
    std::size_t next = 0;
    evaluate_stream<VelocityRamp>(state, [&](Random&, VelocityRamp& out) {
        const Change& c = list[next++];
        out.plan(c.v0, c.a0, c.v1, c.A, c.J);
    });
}

void evaluate_plans(benchmark::State& state) {
    evaluate_stream<SevenSegmentPlan>(state, [](Random& random, SevenSegmentPlan& out) {
        while (plan(random_problem(random), out) != PlanResult::ok) continue;
    });
}

void evaluate_reaches(benchmark::State& state, const std::vector<Reach>& list) {
    std::size_t next = 0;
    evaluate_stream<MotionPlan>(state, [&](Random&, MotionPlan& out) {
        const Reach& r = list[next++ % list.size()];
        plan(r.limits, r.from, r.to, out);
    });
}

void evaluate_ramp(benchmark::State& state) {
    VelocityRamp ramp;
    ramp.plan(0, 0, 100, 500, 5000);
    evaluate(state, ramp);
}

void evaluate_plan(benchmark::State& state) {
    SevenSegmentPlan out;
    plan({10, 20, 80, 500, 5000, 30}, out);
    evaluate(state, out);
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    baseline = measure_baseline();
    std::fprintf(stderr, "ratio 1 = the bare ramp formula, %.2f ns\n", baseline);

    benchmark::RegisterBenchmark("bare_ramp", bare_ramp);
    benchmark::RegisterBenchmark("velocity_ramp", velocity_ramp, changes(1000000));
    benchmark::RegisterBenchmark("velocity_ramp/repeated", velocity_ramp, changes());
    benchmark::RegisterBenchmark("velocity_ramp/at", evaluate_ramps);
    benchmark::RegisterBenchmark("velocity_ramp/at_one_after_the_other", evaluate_ramp);
    benchmark::RegisterBenchmark("plan/at", evaluate_plans);
    benchmark::RegisterBenchmark("plan/at_one_after_the_other", evaluate_plan);
    benchmark::RegisterBenchmark("plan/a_million_of_all_kinds", plan_all, problems(1000000));
    for (int i = 0; i < move_kinds; ++i) {
        const auto kind = static_cast<MoveKind>(i);
        const std::string title = "plan/" + std::string(name(kind));
        benchmark::RegisterBenchmark(title.c_str(), plan_all, problems_of(kind));
    }
    const std::vector<Reach> any = reaches(From::any_state), rest = reaches(From::rest),
                             near = reaches(From::near), states = peer_states();
    benchmark::RegisterBenchmark("reach/at", evaluate_reaches, any);
    benchmark::RegisterBenchmark("reach/at_one_after_the_other", evaluate_reach);
    benchmark::RegisterBenchmark("reach/any_state", plan_reaches, any, false);
    benchmark::RegisterBenchmark("reach/peer_states", plan_reaches, states, false);
    benchmark::RegisterBenchmark("reach/peer_states_given_duration", plan_reaches, states, true);
    benchmark::RegisterBenchmark("reach/rest_to_rest", plan_reaches, rest, false);
    benchmark::RegisterBenchmark("reach/tiny_distance", plan_reaches, near, false);
    benchmark::RegisterBenchmark("reach/last_ramp", plan_reaches, reaches(From::last_ramp), false);
    benchmark::RegisterBenchmark("reach/given_duration", plan_reaches, any, true);
    if (const char* file = std::getenv("LINESHAFT_PEER")) {
        const PlannerPeer peer(file);
        if (!peer) return std::fprintf(stderr, "%s is no planner\n", file), 2;
        benchmark::RegisterBenchmark("peer/any_state", plan_by_peer, any, false, peer);
        benchmark::RegisterBenchmark("peer/peer_states", plan_by_peer, states, false, peer);
        benchmark::RegisterBenchmark("peer/peer_states_given_duration", plan_by_peer, states, true,
                                     peer);
        benchmark::RegisterBenchmark("peer/rest_to_rest", plan_by_peer, rest, false, peer);
        benchmark::RegisterBenchmark("peer/tiny_distance", plan_by_peer, near, false, peer);
        benchmark::RegisterBenchmark("peer/given_duration", plan_by_peer, any, true, peer);
    }
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
