#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "blocks/contour/baseline.hpp"
#include "blocks/contour/command_path.hpp"
#include "tools/bench/quickest.hpp"

using namespace lineshaft;

namespace {

constexpr std::size_t lag = 12;  // points, as the paper has on average

/// 0.025 mm a step (100 mm/s, 0.25 ms) along a curve whose radius varies between 10 and 30 mm.
struct Ride {
    std::vector<Point> command, actual;

    Ride() {
        double x = 0, y = 0, angle = 0;
        constexpr double step = 0.025;
        for (int i = 0; i < 4096 + static_cast<int>(lag); ++i) {
            command.push_back({x, y});
            actual.push_back({x + 0.004, y - 0.003});
            angle += step / (20 + 10 * std::sin(0.003 * i));
            x += step * std::cos(angle);
            y += step * std::sin(angle);
        }
    }
};

/// `distance` of each point of the ride.
template <class Distance>
void measure(benchmark::State& state, const Ride& ride, const Distance& distance) {
    Quickest quickest;
    for (auto _ : state) {
        quickest.time([&] {
            for (std::size_t i = 0; i < ride.command.size(); ++i)
                benchmark::DoNotOptimize(distance(i));
        });
    }
    quickest.count(state, ride.command.size());
}

void real_time(benchmark::State& state) {
    const Ride ride;
    CommandPath path;
    measure(state, ride, [&](std::size_t i) {
        path.add(ride.command[i]);
        return path.estimate(ride.actual[i < lag ? 0 : i - lag]);
    });
}

void linear(benchmark::State& state) {
    const Ride ride;
    measure(state, ride,
            [&](std::size_t i) { return polyline_distance(ride.command, i, ride.actual[i]); });
}

/// As the paper counts: without the time of making the spline.
void spline(benchmark::State& state) {
    const Ride ride;
    std::vector<SplineSpan> spans(ride.command.size() - 1);
    natural_spline(ride.command, spans);
    measure(state, ride, [&](std::size_t i) { return spline_distance(spans, i, ride.actual[i]); });
}

void making_the_spline(benchmark::State& state) {
    const Ride ride;
    std::vector<SplineSpan> spans(ride.command.size() - 1);
    Quickest quickest;
    for (auto _ : state) {
        quickest.time([&] { natural_spline(ride.command, spans); });
        benchmark::DoNotOptimize(spans.data());
    }
    quickest.count(state, ride.command.size());
}

}  // namespace

BENCHMARK(real_time);
BENCHMARK(linear);
BENCHMARK(spline);
BENCHMARK(making_the_spline);
BENCHMARK_MAIN();
