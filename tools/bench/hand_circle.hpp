#pragma once

#include <cstdint>
#include <optional>

#include "blocks/axis/gear_axis.hpp"
#include "blocks/axis/servo_drive.hpp"
#include "blocks/axis/virtual_axis.hpp"
#include "blocks/circle/circle_fit.hpp"
#include "runtime/model/random.hpp"
#include "tools/bench/hand_circle_job.hpp"

namespace lineshaft {

/// programs/paper/wei2025_circle.yaml with its defaults (radius 20 mm, 10 mm/s, seed 1), written by
/// hand as one flat loop over the same blocks: the limit of what the executive can reach.
struct HandCircle {
    HandCircle();

    /// Until the circle is done; calls `after(g, x, y)` behind each scan of the interpolator.
    template <class After>
    void run(After after);

    ServoDrive g_drive, x_drive, y_drive;
    HandCircleJob circle;
    VirtualAxis g;
    GearAxis x, y;
    CircleFit fit;

  private:
    void servo(const Scan& now);
    void main(const Scan& now);
    void interpolator(const Scan& now);

    Random jitter_;
    std::int64_t clock_due_ = 0, main_due_ = 0;
    std::int64_t clock_index_ = 0, main_index_ = 0;
};

inline HandCircle::HandCircle() : jitter_(1, "main.jitter") {
    g_drive.unit = g.unit = x.master_unit = y.master_unit = AxisUnit::rad;
    circle.transition_time = HandCircleJob::TransitionTime::paper_whole_clocks;
    circle.motion_clock = 0.00125;
    circle.lead = 2;
    g.motion = VirtualAxis::Motion::absolute;
    g.immediate = true;
}

inline void HandCircle::servo(const Scan& now) {
    g_drive.set_position = g.position;
    g_drive.scan(now);
    x_drive.set_position = x.position;
    x_drive.set_velocity = x.velocity;
    x_drive.scan(now);
    y_drive.set_position = y.position;
    y_drive.set_velocity = y.velocity;
    y_drive.scan(now);
}

inline void HandCircle::main(const Scan& now) {
    circle.start = now.time >= 10'000'000;
    circle.master_position = g_drive.position;
    circle.x_position = x_drive.position;
    circle.x_velocity = x_drive.velocity;
    circle.y_position = y_drive.position;
    circle.y_velocity = y_drive.velocity;
    circle.scan(now);
}

inline void HandCircle::interpolator(const Scan& now) {
    g.wanted_velocity = circle.master_velocity;
    g.target = circle.master_target;
    g.execute = circle.execute;
    g.home = circle.home;
    g.scan(now);
    const auto slave = [&](GearAxis& axis, double ratio, double acceleration, double start) {
        axis.master_position = g.position;
        axis.master_velocity = g.velocity;
        axis.ratio = ratio;
        axis.acceleration_limit = acceleration;
        axis.move = circle.approach;
        axis.target = start;
        axis.home = circle.home;
        axis.home_position = start;
        axis.scan(now);
    };
    slave(x, circle.ratio_x, circle.acceleration_x, circle.start_x);
    slave(y, circle.ratio_y, circle.acceleration_y, circle.start_y);
    fit.enable = g.moving;
    fit.x = x.position;
    fit.y = y.position;
    fit.scan(now);
}

template <class After>
void HandCircle::run(After after) {
    constexpr std::int64_t clock = 1'250'000, ob1 = 4'500'000, spread = 45'000;
    while (!circle.done) {
        if (clock_due_ <= main_due_) {
            const bool both = clock_due_ == main_due_;
            const Scan now{.time = clock_due_, .interval = clock, .index = clock_index_++};
            servo(now);
            interpolator(now);
            after(g, x, y);
            clock_due_ += clock;
            if (!both) continue;
        }
        main({.time = main_due_, .interval = ob1, .index = main_index_++});
        main_due_ += ob1 + jitter_.around_zero(spread);
    }
}

}  // namespace lineshaft
