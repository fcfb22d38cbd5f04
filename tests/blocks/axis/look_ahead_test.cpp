#include "blocks/axis/look_ahead.hpp"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "runtime/model/random.hpp"

using namespace lineshaft;

namespace {

Dynamics any(Random& random) {
    const auto decades = [&](double least, double ratio) {
        return least * std::pow(ratio, random.share());
    };
    return {decades(1, 500), decades(10, 300), decades(10, 300), decades(100, 1e4)};
}

/// Whether a plan from one velocity to another on the way does not turn round.
bool fits(double from, double to, double way, const Dynamics& d) {
    PointMotion motion;
    return motion.begin({.velocity = from}, way, to, d, {}) == PlanResult::ok && !motion.turns(1);
}

}  // namespace

TEST_CASE("the greatest velocity that a way leaves takes the way, and a plan agrees") {
    Random random(1, "greatest change");
    for (int i = 0; i < 3000; ++i) {
        const Dynamics d = any(random);
        const double to = i % 3 == 0 ? 0 : random.share() * 300;
        const double way = 200 * random.share() * random.share();
        const double v = greatest_change(to, way, d.deceleration, d.jerk);
        INFO("to " << to << " on " << way << ", " << d.deceleration << ", " << d.jerk << ": " << v);
        CHECK(v >= to);
        const Dynamics even{v + 1, d.deceleration, d.deceleration, d.jerk};
        CHECK(ramp_way(v, to, even) <= way * (1 + 1e-14));
        CHECK(ramp_way(v * (1 + 1e-14), to, even) >= way * (1 - 1e-9));
        CHECK(fits(v * (1 - 1e-14), to, way * (1 + 1e-12), even));
    }
}

TEST_CASE("from every admissible entry a way leads to an admissible exit, from none above") {
    Random random(2, "entries");
    int bounded = 0;
    for (int i = 0; i < 2000; ++i) {
        const Dynamics d = any(random);
        const double way = 50 * random.share() * random.share();
        const double greatest = random.share() * 200;
        const Speeds exit{i % 4 == 0 ? greatest * random.share() : 0, greatest};
        const Speeds entry = entries(way, exit, d);
        REQUIRE(entry.exist());
        INFO("way " << way << ", exit " << exit.least << " .. " << exit.greatest << ", entry "
                    << entry.least << " .. " << entry.greatest << ", dynamics " << d.velocity << " "
                    << d.acceleration << " " << d.deceleration << " " << d.jerk);
        const auto leads = [&](double v) {
            return greatest_exit({.velocity = v}, way, exit, d).has_value();
        };
        for (const double share : {0.0, 0.1, 0.37, 0.5, 0.9, 1.0}) {
            const double v =
                entry.least + (1e-9 + share * (1 - 2e-9)) * (entry.greatest - entry.least);
            INFO("from " << v);
            CHECK(leads(v));
        }
        for (double share = entry.greatest > d.velocity ? 1e-4 : 1e-9; share < 1; share *= 4) {
            INFO("not from " << entry.greatest * (1 + share));
            CHECK(!leads(entry.greatest * (1 + share)));
        }
        bounded += entry.least > 0 ? 1 : 0;
    }
    CHECK(bounded > 50);
}

TEST_CASE("the greatest exit from any state is one to which a plan does not turn round") {
    Random random(3, "exits");
    int limited = 0;
    for (int i = 0; i < 2000; ++i) {
        const Dynamics d = any(random);
        const double a = (2 * random.share() - 1) * std::min(d.acceleration, d.deceleration);
        const MotionState from{0, 200 * random.share() + a * a / (2 * d.jerk), a, 0};
        const double way = 100 * random.share();
        const Speeds exit{0, 300 * random.share()};
        const auto v = greatest_exit(from, way, exit, d);
        if (!v) continue;
        PointMotion motion;
        const Dynamics fast{1000, d.acceleration, d.deceleration, d.jerk};
        CHECK(motion.begin(from, way, *v * (1 - 1e-9), fast, {}) == PlanResult::ok);
        CHECK_FALSE(motion.turns(1));
        if (*v == exit.greatest) continue;
        ++limited;
        const bool more = motion.begin(from, way, *v * (1 + 1e-6), fast, {}) == PlanResult::ok &&
                          !motion.turns(1);
        CHECK_FALSE(more);
    }
    CHECK(limited > 100);
}
