#include "runtime/serve/lateness.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("a quantile of lateness is that of the sorted times, to 1/32") {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        INFO("seed " << seed);
        std::mt19937_64 random(seed);
        Lateness lateness;
        std::vector<std::int64_t> times;
        for (std::uint64_t n = 1 + random() % 2000; n > 0; --n) {
            times.push_back(static_cast<std::int64_t>(random() >> (1 + random() % 63)));
            lateness.add(times.back());
        }
        std::ranges::sort(times);
        const auto count = static_cast<double>(times.size());
        for (const double part : {0.001, 0.5, 0.99, 0.999, 1.0}) {
            const auto place = static_cast<std::size_t>(std::ceil(part * count)) - 1;
            const std::int64_t wanted = times[place], found = lateness.quantile(part);
            CHECK(found >= wanted);
            CHECK(static_cast<double>(found - wanted) <= static_cast<double>(wanted) / 32);
        }
        CHECK(lateness.greatest() == times.back());
        CHECK(lateness.quantile(1) == times.back());
        std::int64_t sum = 0, above = 0;
        for (const auto& [below, n] : lateness.histogram()) {
            sum += n;
            CHECK(std::ranges::count_if(times, [&](auto t) { return t < below && t >= above; }) ==
                  n);
            above = below;
        }
        CHECK(sum == lateness.count());
        CHECK(sum == static_cast<std::int64_t>(times.size()));
    }
}

TEST_CASE("of nothing there is no lateness; what is early is in time") {
    Lateness lateness;
    CHECK(lateness.quantile(0.99) == 0);
    CHECK(lateness.histogram().empty());
    lateness.add(-5);
    CHECK(lateness.greatest() == 0);
    CHECK(lateness.count() == 1);
}
