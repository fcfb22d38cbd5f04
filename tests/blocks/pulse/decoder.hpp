#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/pulse/pulse_train.hpp"

/// Recounts pulses from their edges, never from what a block says of itself.
namespace lineshaft::test {

using Edges = std::vector<std::int64_t>;

/// By bisection on the integral of the rate, in long double: no formula of the train's own.
inline long double crossing(const PulseSegment& s, std::int64_t pulse) {
    const long double f0 = s.start_rate, f1 = s.end_rate;
    const long double T = 2 * static_cast<long double>(s.count) / (f0 + f1);
    long double low = 0, high = T;
    for (int i = 0; i < 80; ++i) {
        const long double t = (low + high) / 2;
        const long double passed = f0 * t + (f1 - f0) * t * t / (2 * T);
        (passed < static_cast<long double>(pulse) ? low : high) = t;
    }
    return (low + high) / 2 * 1e9L;
}

/// All edges of a train, taken in pieces of `piece`.
inline Edges all_edges(PulseTrain& train, std::size_t piece = 100) {
    Edges edges;
    std::vector<std::int64_t> out(piece);
    while (train.emitted() < train.segment().count) {
        const std::size_t taken = train.take(INT64_MAX / 2, out);
        edges.insert(edges.end(), out.begin(), out.begin() + static_cast<std::ptrdiff_t>(taken));
    }
    return edges;
}

/// Times rise, and never by less than the period of `most` Hz.
inline void check_spacing(const Edges& edges, std::int64_t most) {
    const std::int64_t least = 1'000'000'000 / most;
    for (std::size_t i = 1; i < edges.size(); ++i) REQUIRE(edges[i] - edges[i - 1] >= least);
}

/// Between any two edges the mean rate is one that the segment passes through.
inline void check_rates(const Edges& edges, const PulseSegment& s) {
    const auto low = static_cast<double>(std::min(s.start_rate, s.end_rate));
    const auto high = static_cast<double>(std::max(s.start_rate, s.end_rate));
    for (std::size_t i = 1; i < edges.size(); ++i) {
        const auto period = static_cast<double>(edges[i] - edges[i - 1]);
        REQUIRE(period <= 1e9 / low + 1);
        REQUIRE(period >= 1e9 / high - 1);
    }
}

}  // namespace lineshaft::test
