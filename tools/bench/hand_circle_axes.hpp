#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "blocks/axis/axis.hpp"
#include "blocks/motion/moves.hpp"
#include "blocks/motion/reads.hpp"
#include "blocks/motion/settings.hpp"
#include "blocks/motion/synchronous.hpp"
#include "tools/bench/hand_circle_job.hpp"

namespace lineshaft {

/// programs/paper/circle_axes.scl written by hand, with the axes that it commands. The commands
/// find axes and jobs in this object, as they do in the machine's memory.
struct HandCircleAxes {
    HandCircleAxes();
    HandCircleAxes(const HandCircleAxes&) = delete;
    HandCircleAxes& operator=(const HandCircleAxes&) = delete;

    /// What the job asks for; the user program's next scan.
    void command(const HandCircleJob& circle, std::int64_t time, std::int64_t interval);
    /// The next scan of the interpolator.
    void interpolate(std::int64_t time, std::int64_t interval);

    bool g_moves() const {
        return g_state.states[static_cast<std::size_t>(AxisState::discrete_motion)];
    }
    bool error() const;

    Axis g, x, y;
    ReadStatus g_state;

  private:
    enum Number : std::int64_t { g_number, x_number, y_number };
    enum Task : int { main_task, interpolator_task };

    struct Slave {
        MoveAbsolute move;
        Home home;
        GearIn gear;
        bool coupled = false;
        double last = 0;
    };

    void command(Slave& slave, const HandCircleJob& circle, double start, double ratio,
                 double acceleration, const Scan& now);
    Context context(Task task);

    Slave x_slave_, y_slave_;
    Home home_g_;
    MoveAbsolute turn_;
    std::array<std::byte*, 3> axes_;
    std::array<std::int64_t, 2> published_{};
};

inline HandCircleAxes::HandCircleAxes()
    : axes_{reinterpret_cast<std::byte*>(&g), reinterpret_cast<std::byte*>(&x),
            reinterpret_cast<std::byte*>(&y)} {
    g.unit = AxisUnit::rad;
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

inline Context HandCircleAxes::context(Task task) {
    return {.instances = axes_.data(),
            .seen = axes_.data(),
            .memory = reinterpret_cast<std::byte*>(this),
            .task = task,
            .published = published_.data()};
}

inline void HandCircleAxes::command(const HandCircleJob& circle, std::int64_t time,
                                    std::int64_t interval) {
    const Scan now{.time = time, .interval = interval, .index = published_[main_task]};
    const Context here = context(main_task);
    command(x_slave_, circle, circle.start_x, circle.ratio_x, circle.acceleration_x, now);
    home_g_.execute = circle.home;
    home_g_.scan(now, here);
    command(y_slave_, circle, circle.start_y, circle.ratio_y, circle.acceleration_y, now);
    turn_.execute = circle.execute;
    turn_.pins.position = circle.master_target;
    turn_.pins.velocity = circle.master_velocity;
    turn_.scan(now, here);
    ++published_[main_task];
}

inline void HandCircleAxes::command(Slave& slave, const HandCircleJob& circle, double start,
                                    double ratio, double acceleration, const Scan& now) {
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

inline void HandCircleAxes::interpolate(std::int64_t time, std::int64_t interval) {
    const Scan now{.time = time, .interval = interval, .index = published_[interpolator_task]};
    const Context here = context(interpolator_task);
    g.scan(now, here);
    x.scan(now, here);
    y.scan(now, here);
    g_state.scan(now, here);
    ++published_[interpolator_task];
}

inline bool HandCircleAxes::error() const {
    const auto refused = [](const Slave& s) {
        return s.move.error || s.home.error || s.gear.error;
    };
    return g.error || x.error || y.error || refused(x_slave_) || refused(y_slave_) ||
           home_g_.error || turn_.error;
}

}  // namespace lineshaft
