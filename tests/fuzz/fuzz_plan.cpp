/// Any bytes as the numbers of both planners: a plan is sound, or refused and not written.

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "blocks/profile/any_state.hpp"
#include "blocks/profile/seven_segment.hpp"

using namespace lineshaft;

namespace {

void require(bool holds) {
    if (!holds) std::abort();
}

void check_move(const std::array<double, 11>& x) {
    SevenSegmentPlan out;
    if (plan(SevenSegment{x[0], x[1], x[2], x[3], x[4], x[5]}, out) != PlanResult::ok) {
        require(out.duration == 0);
        return;
    }
    for (const double T : out.T) require(T >= 0 && T <= out.duration);
    require(std::isfinite(out.duration) && out.end.position == x[5]);
}

void check_motion(const MotionPlan& out, const Goal& goal) {
    require(std::isfinite(out.duration) && out.count <= MotionPlan::most_phases);
    for (std::size_t i = 0; i < out.count; ++i)
        require(out.phases[i].duration > 0 && std::isfinite(out.phases[i].duration));
    const MotionState end = out.at(out.duration);
    require(end.position == goal.position && end.velocity == goal.velocity &&
            end.acceleration == 0);
}

void check_motions(const std::array<double, 11>& x, PlanOptions options) {
    MotionLimits limits;
    if (limits.set(x[5], x[9], x[6], x[7], x[8]) != PlanResult::ok) return;
    const MotionState from{x[0], x[1], x[2], 0};
    const Goal goal{x[3], x[4]};
    for (options.entry = Entry::gentle;; options.entry = Entry::soonest) {
        MotionPlan least, timed;
        const PlanResult result = plan(limits, from, goal, least, options);
        if (result == PlanResult::ok)
            check_motion(least, goal);
        else
            require(least.count == 0 && least.duration == 0);
        if (plan(limits, from, goal, x[10], timed, options) == PlanResult::ok) {
            check_motion(timed, goal);
            require(timed.duration >= x[10]);
        }
        if (options.entry == Entry::soonest) break;
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::array<double, 11> numbers{};
    std::memcpy(numbers.data(), data, std::min(size, sizeof numbers));
    check_move(numbers);
    check_motions(numbers, {});
    return 0;
}
