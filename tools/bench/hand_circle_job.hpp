#pragma once

#include <array>
#include <span>
#include <string_view>

#include "blocks/circle/arc.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// An arc cut into n equal steps of the master's angle theta = 0 .. sweep.
struct SteppedArc : Arc {
    double sweep = 0;        ///< theta_n [rad], > 0
    std::int64_t steps = 1;  ///< n = round(sweep R / step), 1 .. 10^9

    /// From `start` to `end` [rad]; clockwise when end > start. step: wanted length of a step [mm].
    static SteppedArc between(double radius, double start, double end, double step);

    double step_angle() const { return sweep / static_cast<double>(steps); }
    /// theta_i, exact at both ends.
    double theta(std::int64_t i) const;
    /// Chord slope of step i = 1..n: the ratios k_i of eq. (7) [mm/rad].
    Point chord_ratio(std::int64_t i) const;
    /// Height of a step's arc over its chord [mm]: R (1 - cos(dtheta / 2)).
    double sagitta() const;
};

/// programs/paper/circle_job.scl written by hand in C++: what the language costs, and the same
/// bits. The user program of the synchronised circle (Wei et al. 2025, steps 1 to 10): positions
/// the axes on the start point, lets them settle there for `settling_time`, homes them, couples
/// them at standstill, starts the master, and changes the ratios on the way.
///
/// `immediate` (ref. [16]) and `early` (13), (14), (18) change from k_i to k_{i+1} when the read
/// master position has passed theta_i, or theta_i - v_G T. `centred` calls when the job would start
/// nearest to theta_i - v_G T_exact / 2; it knows that a job starts `lead` motion clocks after the
/// positions it reads.
///
/// `balanced` steers by position. Both axes switch at the clock nearest to theta_j / v_G - T / 2.
/// The next ratio leads from where the slave will be at that clock to the vertex of a polygon
/// balanced about the circle (radius R + 0.75 sagitta) at the *next* switch:
///     v_new = (f(v_G t') - p - v_old T / 2) / (t' - t - T / 2),   T = T_exact(|v_new - v_old|),
/// a few fixed-point steps. A job starts on a motion clock, which is inferred from the master's
/// angle.
///
/// `ramp` lets each transition fill its step dt: the job's own acceleration is
///     a = 2 dv / dt / (1 + sqrt(1 - 4 dv / (j dt^2))),
/// so the velocity runs piecewise linearly through the knots' velocities, scaled so that each step
/// covers its chord: v_k = v cos(theta_k) tan(dtheta/2) / (dtheta/2). Half of the position error at
/// each knot is fed back.
struct HandCircleJob {
    enum class Method : std::int64_t { immediate, early, centred, balanced, ramp };
    enum class TransitionTime : std::int64_t { paper, paper_whole_clocks, exact };
    enum class State : std::int64_t { idle, approach, home, engage, run, done };
    enum class Error : std::int64_t {
        none,
        not_finite,      ///< an input, or the master's velocity, is no number
        arc_is_empty,    ///< start and end angle are equal
        steps_too_fast,  ///< a step takes less than a scan, or than a change of ratio
    };

    Method method = Method::early;
    TransitionTime transition_time = TransitionTime::paper;
    double radius = 20, speed = 10, step = 1;
    double start_angle = 0, end_angle = 6.283185307179586;
    double acceleration = 100, jerk = 5e4;
    double motion_clock = 0.001;
    std::int64_t lead = 1;
    double settling_time = 0;

    bool start = false;
    double master_position = 0;
    double x_position = 0, x_velocity = 0, y_position = 0, y_velocity = 0;

    State state = State::idle;
    bool approach = false, home = false, execute = false, done = false;
    double start_x = 0, start_y = 0;
    double master_target = 0, master_velocity = 0;
    double ratio_x = 0, ratio_y = 0;
    double acceleration_x = 100, acceleration_y = 100;
    std::int64_t step_x = 0, step_y = 0, steps = 0;
    double sagitta = 0;
    bool error = false;
    Error error_id = Error::none;

    /// One slave: its coordinate of the arc's points, and what it was told.
    struct Axis {
        Coordinate coordinate = Coordinate::x;
        std::int64_t step = 0;      ///< i of the ratio in force
        double ratio = 0;           ///< [mm/rad]
        double acceleration = 100;  ///< of its last job [mm/s^2]
        double switch_angle = 0;    ///< of the next change [rad]
    };

    SteppedArc arc;
    Axis x, y;
    bool last_start = false;
    Error arc_error = Error::none;
    std::int64_t state_since = 0, standing_since = 0;
    std::int64_t knot = 0;        ///< balanced, ramp: steps begun
    std::int64_t next_clock = 0;  ///< balanced, ramp: motion clock of the next change

    static std::span<const Field> fields();
    void scan(const Scan& now);

  private:
    bool inputs_finite() const;
    Error check_arc(const Scan& now) const;
    double least_step_time(const SteppedArc& wanted, const Scan& now) const;
    bool at_start() const;
    bool waited(const Scan& now) const;
    void enter(State next, const Scan& now);
    void begin();
    void engage();
    double first_ratio(Coordinate coordinate) const;
    void run(const Scan& now);
    void poll(Axis& axis, double job_angle);
    void plan_change(Axis& axis) const;
    double time_for(double dv) const;
    double exact_time(double dv) const;
    double master_speed() const { return speed / radius; }
    double end_time() const { return arc.sweep / master_speed(); }
    std::int64_t job_clock() const;
    void balance(std::int64_t clock);
    void balance_axis(Axis& axis, double from, double t, double next, double rho);
    void ramp_step(std::int64_t clock);
    void ramp_axis(Axis& axis, double from, double t, double next);
    std::int64_t switch_clock(std::int64_t j) const;
    std::int64_t knot_clock(std::int64_t k) const;
    void publish();
};

}  // namespace lineshaft
