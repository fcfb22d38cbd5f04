#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "blocks/path/path.hpp"
#include "tools/bench/quickest.hpp"

using namespace lineshaft;

namespace {

constexpr double step = 0.1;  ///< length of a piece [mm]
constexpr std::size_t ahead = 1000;

/// Points of a way in the plane, whose direction is known by the number of the piece.
struct Way {
    std::vector<PathVector> points{{}};
    PathLimits limits{{100, 1000, 10'000}, {}};
    double deviation = 0;  ///< of corners; 0: vertices are stops [mm]

    Way(int pieces, double allowed, const std::function<double(int)>& direction)
        : deviation(allowed) {
        limits.axes.fill(no_path_limit);
        for (int k = 0; k < pieces; ++k) {
            PathVector to = points.back();
            to[0] += step * std::cos(direction(k));
            to[1] += step * std::sin(direction(k));
            points.push_back(to);
        }
    }

    /// All times are so many times as long.
    void slow_down(double times) {
        limits.path.velocity /= times;
        limits.path.acceleration /= times * times;
        limits.path.jerk /= times * times * times;
    }
};

/// How long the motion lasts [s].
double run(const Way& way, std::vector<PathPiece>& ring) {
    Path path;
    double lasts = 0;
    PathJoint joint;
    if (way.deviation > 0) joint.distance = PathJoint::any, joint.deviation = way.deviation;
    for (std::size_t k = 0; k + 1 < way.points.size(); ++k) {
        PathCurve line;
        while (path.count - path.first + 2 > ring.size())
            lasts += path.advance_to(ring, Path::any_time, path.first + 1);
        if (line_to(way.points[k], way.points[k + 1], line) != PathFault::none ||
            path.append(ring, line, way.limits, joint) != PathFault::none)
            std::abort();
    }
    while (!path.finished()) lasts += path.advance_to(ring, Path::any_time, Path::to_end);
    return lasts;
}

/// Counts `least` [ns a piece, the quickest run], `lasts` [s] and `searched`: what the motion lasts
/// where a course is looked for everywhere, as it is in slow motion (blocks/path/README.md, "The
/// least time").
void plan_way(benchmark::State& state, const std::function<double(int)>& direction,
              double deviation) {
    constexpr int pieces = 10'000, fewer = 400;
    constexpr double slower = 1000;
    std::vector<PathPiece> ring((deviation > 0 ? 2 : 1) * ahead);
    const Way way(pieces, deviation, direction);
    Quickest quickest;
    for (auto _ : state) quickest.time([&] { benchmark::DoNotOptimize(run(way, ring)); });
    quickest.count(state, pieces);
    Way part(fewer, deviation, direction);
    state.counters["lasts"] = run(part, ring);
    part.slow_down(slower);
    state.counters["searched"] = run(part, ring) / slower;
}

void add(const std::string& name, const std::function<double(int)>& direction) {
    for (const char* deviation : {"0.01", "0.03"})
        benchmark::RegisterBenchmark((name + "/" + deviation).c_str(), plan_way, direction,
                                     std::atof(deviation));
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RegisterBenchmark(
        "line", plan_way, [](int) { return 0.7; }, 0.0);
    benchmark::RegisterBenchmark(
        "stops", plan_way, [](int k) { return k % 2 == 0 ? 0.2 : -0.2; }, 0.0);
    add("zigzag", [](int k) { return k % 2 == 0 ? 0.2 : -0.2; });
    add("circle", [](int k) { return step / 10 * k; });
    add("spiral", [](int k) { return 20 * std::sqrt(1 + 1e-3 * k); });
    add("wave", [](int k) { return std::sin(1e-2 * k) + 0.5 * std::sin(3.7e-2 * k); });
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
