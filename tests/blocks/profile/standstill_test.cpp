#include <cstring>

#include <catch2/catch.hpp>

#include "blocks/profile/any_state.hpp"
#include "tests/blocks/profile/any_state_problems.hpp"

using namespace lineshaft;
using namespace lineshaft::reference;

namespace {

/// From standstill to standstill: ways of any length, near and far from zero, limits of any size,
/// the same both ways or not.
Problem standing(Random& r) {
    Problem p = random_limits(r);
    if (r.one_in(4)) p.V = p.A * p.A / p.J * r.decades(-6, 6);
    const double size = p.V * ramp_duration(p.V, std::min(p.A, p.D), p.J);
    p.p0 = r.one_in(2) ? 0 : size * r.between(-10, 10) * r.decades(0, 6);
    p.pf = p.p0 + r.sign() * size * r.decades(-12, 3);
    return p;
}

bool is_same(const MotionPlan& one, const MotionPlan& other) {
    return one.count == other.count && one.duration == other.duration &&
           one.missed == other.missed && one.haste == other.haste &&
           one.end.position == other.end.position &&
           std::memcmp(one.phases.data(), other.phases.data(),
                       one.count * sizeof(MotionPlan::Phase)) == 0;
}

}  // namespace

TEST_CASE("a plan from standstill has the bits of the general way", "[any_state]") {
    const std::uint64_t seed = 20261126;
    Random random{seed};
    std::size_t planned = 0;
    for (int i = 0; i < 200'000; ++i) {
        const Problem p = standing(random);
        const MotionLimits limits = limits_of(p);
        const MotionState from{p.p0, 0, 0, 0};
        const PlanOptions options{Entry::gentle, i % 2 == 0 ? 64.0 : 1024.0};
        MotionPlan shorter, general;
        const PlanResult result = plan(limits, from, {p.pf, 0}, shorter, options);
        // No time is enough for any motion: the least time, found by the general way.
        INFO("seed " << seed << ", problem " << i);
        REQUIRE(plan(limits, from, {p.pf, 0}, 0.0, general, options) == result);
        if (result != PlanResult::ok) continue;
        REQUIRE(is_same(shorter, general));
        planned += shorter.count > 0;
    }
    CHECK(planned > 180'000);
}
