#pragma once

#include <cstdint>

#include "blocks/axis/servo_drive.hpp"
#include "blocks/circle/circle_fit.hpp"
#include "runtime/model/random.hpp"
#include "tools/bench/hand_circle_axes.hpp"
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
    HandCircleAxes axes;
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
    g_drive.unit = AxisUnit::rad;
    circle.transition_time = HandCircleJob::TransitionTime::paper_whole_clocks;
    circle.motion_clock = 0.00125;
    circle.lead = 2;
}

inline void HandCircle::servo(const Scan& now) {
    g_drive.set_position = axes.g.position;
    g_drive.scan(now);
    x_drive.set_position = axes.x.position;
    x_drive.set_velocity = axes.x.velocity;
    x_drive.scan(now);
    y_drive.set_position = axes.y.position;
    y_drive.set_velocity = axes.y.velocity;
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
    axes.command(circle, now.time, now.interval);
}

inline void HandCircle::interpolator(const Scan& now) {
    axes.interpolate(now.time, now.interval);
    fit.enable = axes.g_moves();
    fit.x = axes.x.position;
    fit.y = axes.y.position;
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
            after(axes.g, axes.x, axes.y);
            clock_due_ += clock;
            if (!both) continue;
        }
        main({.time = main_due_, .interval = ob1, .index = main_index_++});
        main_due_ += ob1 + jitter_.around_zero(spread);
    }
}

}  // namespace lineshaft
