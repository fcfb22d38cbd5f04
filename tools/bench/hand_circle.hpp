#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "blocks/axis/axis.hpp"
#include "blocks/axis/servo_drive.hpp"
#include "blocks/circle/circle_fit.hpp"
#include "blocks/motion/moves.hpp"
#include "blocks/motion/reads.hpp"
#include "blocks/motion/settings.hpp"
#include "blocks/motion/synchronous.hpp"
#include "runtime/model/random.hpp"
#include "tools/bench/hand_circle_job.hpp"

namespace lineshaft {

/// programs/paper/wei2025_circle.yaml with its defaults (radius 20 mm, 10 mm/s, seed 1), written by
/// hand as one flat loop over the same blocks: the limit of what the executive can reach. The
/// commands find their axes and their jobs in this object, as they do in the machine's memory.
struct HandCircle {
    HandCircle();
    HandCircle(const HandCircle&) = delete;
    HandCircle& operator=(const HandCircle&) = delete;

    /// Until the circle is done; calls `after(g, x, y)` behind each scan of the interpolator.
    template <class After>
    void run(After after);

    ServoDrive g_drive, x_drive, y_drive;
    HandCircleJob circle;
    Axis g, x, y;
    ReadStatus g_state;
    CircleFit fit;

  private:
    enum Number : std::int64_t { g_number, x_number, y_number };
    enum Task : int { main_task, interpolator_task };

    /// One slave as circle_axes.scl commands it.
    struct Slave {
        MoveAbsolute move;
        Home home;
        GearIn gear;
        bool coupled = false;
        double last = 0;
    };

    void servo(const Scan& now);
    void main(const Scan& now);
    void command(const Scan& now);
    void command(Slave& slave, double start, double ratio, double acceleration, const Scan& now);
    void interpolator(const Scan& now);
    Context context(Task task);

    Slave x_slave_, y_slave_;
    Home home_g_;
    MoveAbsolute turn_;
    std::array<std::byte*, 3> axes_;
    std::array<std::int64_t, 2> published_{};

    Random jitter_;
    std::int64_t clock_due_ = 0, main_due_ = 0;
};

inline HandCircle::HandCircle()
    : axes_{reinterpret_cast<std::byte*>(&g), reinterpret_cast<std::byte*>(&x),
            reinterpret_cast<std::byte*>(&y)},
      jitter_(1, "main.jitter") {
    g_drive.unit = g.unit = AxisUnit::rad;
    circle.transition_time = HandCircleJob::TransitionTime::paper_whole_clocks;
    circle.motion_clock = 0.00125;
    circle.lead = 2;
    home_g_.axis = turn_.axis = g_state.axis = g_number;
    turn_.pins.acceleration = turn_.pins.deceleration = 1e9;
    turn_.pins.jerk = 0;
    g_state.enable = true;
    for (auto [slave, number] : {std::pair(&x_slave_, x_number), std::pair(&y_slave_, y_number)}) {
        slave->move.axis = slave->home.axis = slave->gear.axis = number;
        slave->gear.pins.coupling.master.axis = g_number;
        slave->move.pins.velocity = 50;
        slave->move.pins.jerk = slave->gear.pins.jerk = 5e4;
    }
}

inline Context HandCircle::context(Task task) {
    return {.instances = axes_.data(),
            .seen = axes_.data(),
            .memory = reinterpret_cast<std::byte*>(this),
            .task = task,
            .published = published_.data()};
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
    command(now);
}

inline void HandCircle::command(const Scan& now) {
    const Context here = context(main_task);
    command(x_slave_, circle.start_x, circle.ratio_x, circle.acceleration_x, now);
    home_g_.execute = circle.home;
    home_g_.scan(now, here);
    command(y_slave_, circle.start_y, circle.ratio_y, circle.acceleration_y, now);
    turn_.execute = circle.execute;
    turn_.pins.position = circle.master_target;
    turn_.pins.velocity = circle.master_velocity;
    turn_.scan(now, here);
}

inline void HandCircle::command(Slave& slave, double start, double ratio, double acceleration,
                                const Scan& now) {
    const Context here = context(main_task);
    slave.move.execute = circle.approach;
    slave.move.pins.position = start;
    slave.move.pins.acceleration = slave.move.pins.deceleration = acceleration;
    slave.move.scan(now, here);
    slave.home.execute = circle.home;
    slave.home.pins.position = start;
    slave.home.scan(now, here);
    if (circle.approach) {
        slave.coupled = false;
        slave.last = 0;
    } else if (ratio != slave.last) {
        slave.gear.execute = false;
        slave.gear.scan(now, here);
        slave.coupled = true;
        slave.last = ratio;
    }
    slave.gear.execute = slave.coupled;
    slave.gear.pins.coupling.master.numerator = ratio;
    slave.gear.pins.acceleration = slave.gear.pins.deceleration = acceleration;
    slave.gear.scan(now, here);
}

inline void HandCircle::interpolator(const Scan& now) {
    const Context here = context(interpolator_task);
    g.scan(now, here);
    x.scan(now, here);
    y.scan(now, here);
    g_state.scan(now, here);
    fit.enable = g_state.states[static_cast<std::size_t>(AxisState::discrete_motion)];
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
            const Scan now{.time = clock_due_,
                           .interval = clock,
                           .index = published_[interpolator_task]};
            servo(now);
            interpolator(now);
            ++published_[interpolator_task];
            after(g, x, y);
            clock_due_ += clock;
            if (!both) continue;
        }
        main({.time = main_due_, .interval = ob1, .index = published_[main_task]});
        ++published_[main_task];
        main_due_ += ob1 + jitter_.around_zero(spread);
    }
}

}  // namespace lineshaft
