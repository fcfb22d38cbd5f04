#include "blocks/axis/way.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

#include "tests/blocks/profile/oracle.hpp"

using namespace lineshaft;

namespace {

/// By looking at it 10,000 times.
Range seen(const Way& way, double until) {
    Range range{way.at(0).position, way.at(0).position};
    for (int i = 1; i <= 10'000; ++i) {
        const double position = way.at(until * i / 10'000).position;
        range = {std::min(range.least, position), std::max(range.greatest, position)};
    }
    return range;
}

}  // namespace

TEST_CASE("a motion of constant jerk stays between its ends and where it turns") {
    const Range turning = positions_of({0, 3, -4, 0}, 2);
    CHECK(turning.least == -2);
    CHECK(turning.greatest == 1.125);
    const Range twice = positions_of({0, 3, -4, 2}, 4);  // at 1 s and 3 s
    CHECK(twice.least == 0);
    CHECK(twice.greatest == Approx(3 * 4 - 2 * 16 + 64.0 / 3));
    const Range still = positions_of({5, 0, 0, 0}, 3);
    CHECK((still.least == 5 && still.greatest == 5));
}

TEST_CASE("the way of a sum of motions has the positions that are seen on it, and no others") {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        oracle::Random random{seed};
        const auto state = [&] {
            return MotionState{random.between(-50, 50), random.between(-100, 100),
                               random.between(-500, 500), 0};
        };
        const Dynamics d{random.between(50, 200), random.between(300, 2000),
                         random.between(300, 2000), random.decades(3, 6)};
        PointMotion first, second;
        VelocityMotion ramp;
        REQUIRE(first.begin(state(), random.between(-50, 50), 0, d, {0}) == PlanResult::ok);
        REQUIRE(second.begin(state(), random.between(-50, 50), random.between(-20, 20), d,
                             {7'000'000}) == PlanResult::ok);
        REQUIRE(ramp.begin(state(), random.between(-100, 100), d, {3'000'000}) == PlanResult::ok);
        const Moment from{random.one_in(2) ? 10'000'000 : 60'000'000, 0.5e-9};
        for (const bool ramps : {false, true}) {
            Way way(from);
            way.add(second);
            if (ramps)
                way.add(ramp);
            else
                way.add(first);
            const double until = way.duration();
            const Range found = way.positions(until), looked = seen(way, until);
            const double step = until / 10'000, near = 2000 * step * step + 1e-9;
            INFO("seed " << seed << (ramps ? ", a ramp" : ""));
            CHECK(found.least <= looked.least + 1e-9);
            CHECK(found.greatest >= looked.greatest - 1e-9);
            CHECK(found.least >= looked.least - near);
            CHECK(found.greatest <= looked.greatest + near);
        }
    }
}
