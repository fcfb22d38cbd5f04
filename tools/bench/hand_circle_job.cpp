#include "tools/bench/hand_circle_job.hpp"

#include <algorithm>
#include <cmath>

#include <sleef.h>

#include "blocks/profile/velocity_ramp.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view method_names[] = {"immediate", "early", "centred", "balanced", "ramp"};
constexpr std::string_view time_names[] = {"paper", "paper_whole_clocks", "exact"};
constexpr std::string_view state_names[] = {"idle", "approach", "home", "engage", "run", "done"};
constexpr std::string_view error_names[] = {"none", "not_finite", "arc_is_empty", "steps_too_fast"};

constexpr double in_position = 1e-9;  // [mm]
constexpr int clocks_to_settle = 3;   // until a job has been seen and its effect published
constexpr int fixed_point_steps = 8;
constexpr double most_steps = 1e9;

}  // namespace

SteppedArc SteppedArc::between(double radius, double start, double end, double step) {
    SteppedArc arc;
    arc.radius = radius;
    arc.start = start;
    arc.direction = end < start ? -1 : 1;
    arc.sweep = std::abs(end - start);
    const double wanted = std::round(arc.sweep * radius / step);
    arc.steps = static_cast<std::int64_t>(std::clamp(wanted, 1.0, most_steps));
    return arc;
}

double SteppedArc::theta(std::int64_t i) const {
    return sweep * static_cast<double>(i) / static_cast<double>(steps);
}

Point SteppedArc::chord_ratio(std::int64_t i) const {
    const Point from = at(theta(i - 1)), to = at(theta(i));
    return {(to.x - from.x) / step_angle(), (to.y - from.y) / step_angle()};
}

double SteppedArc::sagitta() const {
    const double s = Sleef_cinz_sind1_u10purec(step_angle() / 4);
    return 2 * radius * s * s;
}

std::span<const Field> HandCircleJob::fields() {
    using C = HandCircleJob;
    static const Field table[] = {
        parameter("method", &C::method, "", "when and how the ratios change").one_of(method_names),
        parameter("transition_time", &C::transition_time, "",
                  "of method early: eq. (18), the same rounded up to motion clocks, or exact")
            .one_of(time_names),
        parameter("radius", &C::radius, "mm", "of the arc").above(0),
        parameter("speed", &C::speed, "mm/s", "along the arc").above(0),
        parameter("step", &C::step, "mm", "wanted length of a step").above(0),
        parameter("start_angle", &C::start_angle, "rad", "of the start point; 0 is (0, R)"),
        parameter("end_angle", &C::end_angle, "rad", "clockwise when above start_angle"),
        parameter("acceleration", &C::acceleration, "mm/s^2", "limit of the slaves").above(0),
        parameter("jerk", &C::jerk, "mm/s^3", "limit of the slaves").above(0),
        parameter("motion_clock", &C::motion_clock, "s", "of the axes: every(interpolator)")
            .above(0)
            .must_be_set(),
        parameter(
            "lead", &C::lead, "",
            "motion clocks from the set-points that are read to the start of a job commanded now")
            .at_least(0),
        parameter("settling_time", &C::settling_time, "s",
                  "that the slaves stand on the start point before they are homed")
            .at_least(0),
        input("start", &C::start, "", "rising edge: do the arc").must_be_set(),
        input("master_position", &C::master_position, "rad", "of the master axis").must_be_set(),
        input("x_position", &C::x_position, "mm", "of slave X").must_be_set(),
        input("x_velocity", &C::x_velocity, "mm/s", "of slave X (methods balanced, ramp)"),
        input("y_position", &C::y_position, "mm", "of slave Y").must_be_set(),
        input("y_velocity", &C::y_velocity, "mm/s", "of slave Y (methods balanced, ramp)"),
        output("state", &C::state, "", "what it is doing").one_of(state_names),
        output("approach", &C::approach, "", "slaves: move to start_x, start_y"),
        output("home", &C::home, "", "slaves: position := start_x, start_y; master: 0"),
        output("execute", &C::execute, "", "master: move to master_target"),
        output("done", &C::done, "", "the master has reached its target"),
        output("start_x", &C::start_x, "mm", "start point"),
        output("start_y", &C::start_y, "mm", "start point"),
        output("master_target", &C::master_target, "rad", "theta_n"),
        output("master_velocity", &C::master_velocity, "rad/s", "v_G = speed / radius"),
        output("ratio_x", &C::ratio_x, "mm/rad", "of slave X"),
        output("ratio_y", &C::ratio_y, "mm/rad", "of slave Y"),
        output("acceleration_x", &C::acceleration_x, "mm/s^2", "of X's next job"),
        output("acceleration_y", &C::acceleration_y, "mm/s^2", "of Y's next job"),
        output("step_x", &C::step_x, "", "step i of the ratio of X"),
        output("step_y", &C::step_y, "", "step i of the ratio of Y"),
        output("steps", &C::steps, "", "n"),
        output("sagitta", &C::sagitta, "mm", "height of a step's arc over its chord"),
        output("error", &C::error, "", "the arc cannot be done"),
        output("error_id", &C::error_id, "", "why").one_of(error_names),
    };
    return table;
}

void HandCircleJob::scan(const Scan& now) {
    if (state == State::idle || state == State::done) arc_error = check_arc(now);
    error_id = inputs_finite() ? arc_error : Error::not_finite;
    error = error_id != Error::none;
    if (error) return;
    const bool edge = rising_edge(start, last_start);
    switch (state) {
        case State::idle:
        case State::done:
            if (!edge) break;
            begin();
            enter(State::approach, now);
            break;
        case State::approach:
            if (!at_start()) {
                standing_since = now.time;
                break;
            }
            if (!waited(now) || seconds(now.time - standing_since) < settling_time) break;
            home = true;
            enter(State::home, now);
            break;
        case State::home:
            if (!waited(now)) break;
            home = false;
            engage();
            enter(State::engage, now);
            break;
        case State::engage:
            if (!waited(now)) break;
            execute = true;
            enter(State::run, now);
            break;
        case State::run:
            run(now);
            break;
    }
    publish();
}

bool HandCircleJob::inputs_finite() const {
    return std::isfinite(master_position) && std::isfinite(x_position) &&
           std::isfinite(x_velocity) && std::isfinite(y_position) && std::isfinite(y_velocity);
}

/// What is wrong with the parameters: looked at before an arc, not on the way.
HandCircleJob::Error HandCircleJob::check_arc(const Scan& now) const {
    if (!std::isnormal(master_speed()) || !std::isfinite(end_angle - start_angle))
        return Error::not_finite;
    if (start_angle == end_angle) return Error::arc_is_empty;
    const SteppedArc wanted = SteppedArc::between(radius, start_angle, end_angle, step);
    const double step_time = wanted.step_angle() / master_speed();
    return wanted.steps == 1 || step_time >= least_step_time(wanted, now) ? Error::none
                                                                          : Error::steps_too_fast;
}

/// A scan changes each ratio once; a change that steers by position must have ended before the
/// next.
double HandCircleJob::least_step_time(const SteppedArc& wanted, const Scan& now) const {
    const double scan = seconds(now.interval);
    if (method != Method::balanced && method != Method::ramp) return scan;
    return scan + static_cast<double>(lead + 1) * motion_clock +
           exact_time(speed * wanted.step_angle());
}

bool HandCircleJob::at_start() const {
    return std::abs(x_position - start_x) <= in_position &&
           std::abs(y_position - start_y) <= in_position;
}

bool HandCircleJob::waited(const Scan& now) const {
    return seconds(now.time - state_since) >= clocks_to_settle * motion_clock;
}

void HandCircleJob::enter(State next, const Scan& now) {
    state = next;
    state_since = standing_since = now.time;
}

/// Steps 1 and 2: the arc, its start point, the master's way; the slaves are sent to the start.
void HandCircleJob::begin() {
    arc = SteppedArc::between(radius, start_angle, end_angle, step);
    steps = arc.steps;
    sagitta = arc.sagitta();
    const Point from = arc.at(0);
    start_x = from.x;
    start_y = from.y;
    master_target = arc.sweep;
    master_velocity = master_speed();
    x = {.coordinate = Coordinate::x, .acceleration = acceleration};
    y = {.coordinate = Coordinate::y, .acceleration = acceleration};
    done = execute = false;
    approach = true;
}

/// Step 3, and 4 to 6 for the first step: the ratios that hold from standstill.
void HandCircleJob::engage() {
    approach = false;
    knot = 0;
    next_clock = 0;
    if (method == Method::balanced && arc.steps > 1) next_clock = switch_clock(1);
    for (Axis* axis : {&x, &y}) {
        axis->step = 1;
        axis->ratio = first_ratio(axis->coordinate);
        plan_change(*axis);
    }
}

double HandCircleJob::first_ratio(Coordinate f) const {
    const double half = arc.step_angle() / 2;
    if (method == Method::ramp)
        return Sleef_cinz_tand1_u10purec(half) / half * arc.slope(0).along(f);
    if (method != Method::balanced || arc.steps == 1) return arc.chord_ratio(1).along(f);
    const double theta = master_speed() * static_cast<double>(next_clock) * motion_clock;
    return (arc.at(theta, radius + 0.75 * sagitta).along(f) - arc.at(0).along(f)) / theta;
}

/// Steps 8 to 10.
void HandCircleJob::run(const Scan& now) {
    if (master_position >= master_target) {
        done = true;
        execute = false;
        return enter(State::done, now);
    }
    if (method == Method::balanced) return balance(job_clock());
    if (method == Method::ramp) return ramp_step(job_clock());
    double angle = master_position;
    if (method == Method::centred)
        angle +=
            master_speed() * (static_cast<double>(lead) * motion_clock + seconds(now.interval) / 2);
    poll(x, angle);
    poll(y, angle);
}

void HandCircleJob::poll(Axis& axis, double angle) {
    if (axis.step >= arc.steps || angle < axis.switch_angle) return;
    ++axis.step;
    axis.ratio = arc.chord_ratio(axis.step).along(axis.coordinate);
    plan_change(axis);
}

/// Steps 4 and 5: the master's angle at which the ratio of step i + 1 is commanded.
void HandCircleJob::plan_change(Axis& axis) const {
    if (axis.step >= arc.steps) return;
    const double v_G = master_speed();
    const double dv =
        std::abs(arc.chord_ratio(axis.step + 1).along(axis.coordinate) - axis.ratio) * v_G;
    axis.switch_angle = arc.theta(axis.step);
    if (method == Method::early) axis.switch_angle -= v_G * time_for(dv);
    if (method == Method::centred) axis.switch_angle -= v_G * exact_time(dv) / 2;
}

double HandCircleJob::time_for(double dv) const {
    if (transition_time == TransitionTime::exact) return exact_time(dv);
    const double T = acceleration / jerk + dv / acceleration;  // eq. (18)
    if (transition_time == TransitionTime::paper) return T;
    return std::ceil(T / motion_clock) * motion_clock;
}

double HandCircleJob::exact_time(double dv) const {
    return ramp_duration(dv, acceleration, jerk);
}

/// Motion clocks since the master's start at which a job commanded now would start; -1: not known
/// yet.
std::int64_t HandCircleJob::job_clock() const {
    if (master_position <= 0) return -1;
    return std::llround(master_position / (master_speed() * motion_clock)) + lead;
}

/// The clock at which the change between steps j and j + 1 starts, for both axes.
std::int64_t HandCircleJob::switch_clock(std::int64_t j) const {
    const double T = exact_time(speed * arc.step_angle());
    return std::llround((arc.theta(j) / master_speed() - T / 2) / motion_clock);
}

void HandCircleJob::balance(std::int64_t clock) {
    if (clock < next_clock || knot + 1 >= arc.steps) return;
    ++knot;
    const bool last = knot + 1 == arc.steps;
    next_clock = last ? 0 : switch_clock(knot + 1);
    const double t = static_cast<double>(clock) * motion_clock;
    const double next = last ? end_time() : static_cast<double>(next_clock) * motion_clock;
    const double rho = last ? radius : radius + 0.75 * sagitta;
    const double ahead = static_cast<double>(lead) * motion_clock * master_speed();
    balance_axis(x, x_position + x.ratio * ahead, t, next, rho);
    balance_axis(y, y_position + y.ratio * ahead, t, next, rho);
}

/// An axis that cannot come back to the arc within the step keeps its ratio.
void HandCircleJob::balance_axis(Axis& axis, double from, double t, double next, double rho) {
    const double v_G = master_speed();
    const double v_old = axis.ratio * v_G;
    const double vertex = arc.at(v_G * next, rho).along(axis.coordinate);
    axis.step = knot + 1;
    double v_new = v_old;
    for (int i = 0; i < fixed_point_steps; ++i) {
        const double T = exact_time(std::abs(v_new - v_old));
        const double left = next - t - T / 2;
        if (!(left > 0)) return;
        v_new = (vertex - from - v_old * T / 2) / left;
    }
    if (std::isfinite(v_new / v_G)) axis.ratio = v_new / v_G;
}

/// The clock of knot k, where step k + 1 begins.
std::int64_t HandCircleJob::knot_clock(std::int64_t k) const {
    return std::llround(arc.theta(k) / (master_speed() * motion_clock));
}

void HandCircleJob::ramp_step(std::int64_t clock) {
    if (clock < next_clock || knot >= arc.steps) return;
    ++knot;
    const bool last = knot == arc.steps;
    next_clock = last ? 0 : knot_clock(knot);
    const double t = static_cast<double>(clock) * motion_clock;
    const double next = last ? end_time() : static_cast<double>(next_clock) * motion_clock;
    const double ahead = static_cast<double>(lead) * motion_clock / 2;
    ramp_axis(x, x_position + (x_velocity + x.ratio * master_speed()) * ahead, t, next);
    ramp_axis(y, y_position + (y_velocity + y.ratio * master_speed()) * ahead, t, next);
}

void HandCircleJob::ramp_axis(Axis& axis, double from, double t, double next) {
    const double v_G = master_speed();
    const double dt = next - t;
    axis.step = knot;
    if (!(dt > 0)) return;
    const double half = arc.step_angle() / 2;
    const double scale = Sleef_cinz_tand1_u10purec(half) / half;
    const double missing = arc.at(v_G * t).along(axis.coordinate) - from;
    const double v_new = scale * arc.slope(v_G * next).along(axis.coordinate) * v_G + missing / dt;
    if (!std::isfinite(v_new / v_G)) return;
    const double dv = std::abs(v_new - axis.ratio * v_G);
    const double root = 1 - 4 * dv / (jerk * dt * dt);
    axis.acceleration = acceleration;
    if (root > 0 && dv > 0)
        axis.acceleration = std::min(acceleration, 2 * dv / (dt * (1 + std::sqrt(root))));
    axis.ratio = v_new / v_G;
}

void HandCircleJob::publish() {
    ratio_x = x.ratio;
    ratio_y = y.ratio;
    acceleration_x = x.acceleration;
    acceleration_y = y.acceleration;
    step_x = x.step;
    step_y = y.step;
}

}  // namespace lineshaft
