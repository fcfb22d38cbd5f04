#include "blocks/axis/servo_drive.hpp"

#include <cmath>

#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view loop_names[] = {"ideal", "first_order", "second_order"};
constexpr std::string_view encoder_names[] = {"motor", "table"};
constexpr std::string_view error_names[] = {"none", "not_finite", "no_position_loop",
                                            "no_velocity_loop", "no_time_constant"};

/// 0 where no double holds it.
double velocity_between(double from, double to, double elapsed) {
    const double made = elapsed > 0 ? (to - from) / elapsed : 0;
    return std::isfinite(made) ? made : 0;
}

}  // namespace

std::span<const Field> ServoDrive::fields() {
    using D = ServoDrive;
    static const Field table[] = {
        parameter("unit", &D::unit, "", "unit of the axis").one_of(axis_unit_names),
        parameter("delay", &D::delay, "", "clocks that a set-point travels to the drive")
            .at_least(0)
            .at_most(longest_delay),
        parameter("kv", &D::kv, "1/s", "gain of the position loop; 0: motor at its set-point")
            .at_least(0),
        parameter("integral_time", &D::integral_time, "s",
                  "of the position loop's integral action; 0: none")
            .at_least(0),
        parameter("velocity_feed_forward", &D::velocity_feed_forward, "",
                  "share of the set velocity; 1: all of it")
            .at_least(0),
        parameter("velocity_loop", &D::loop, &VelocityLoop::kind, "", "dynamics of the velocity")
            .one_of(loop_names),
        parameter("time_constant", &D::loop, &VelocityLoop::time_constant, "s",
                  "of a first-order velocity loop")
            .at_least(0),
        parameter("natural_frequency", &D::loop, &VelocityLoop::natural_frequency, "rad/s",
                  "of a second-order velocity loop")
            .at_least(0),
        parameter("damping", &D::loop, &VelocityLoop::damping, "",
                  "of a second-order velocity loop; 1: critical")
            .at_least(0),
        parameter("coulomb_friction", &D::loop, &VelocityLoop::coulomb, "{unit}/s^2",
                  "force over moved mass")
            .at_least(0),
        parameter("viscous_friction", &D::loop, &VelocityLoop::viscous, "1/s",
                  "force over velocity and moved mass")
            .at_least(0),
        parameter("backlash", &D::transmission, &Transmission::backlash, "{unit}",
                  "play between motor and table")
            .at_least(0),
        parameter("windup", &D::transmission, &Transmission::windup, "{unit}",
                  "lag of the table in steady motion: friction over stiffness"),
        parameter("breakaway_windup", &D::transmission, &Transmission::breakaway_windup, "{unit}",
                  "lag of the table in addition, after a reversal: the reversal error"),
        parameter("presliding_travel", &D::transmission, &Transmission::presliding_travel, "{unit}",
                  "within which a reversal winds up")
            .at_least(0),
        parameter("breakaway_time", &D::transmission, &Transmission::breakaway_time, "s",
                  "in which `breakaway_windup` decays, also at standstill")
            .at_least(0),
        parameter("encoder", &D::encoder, "", "where it sits").one_of(encoder_names),
        parameter("resolution", &D::resolution, "{unit}", "of the encoder; 0: no steps")
            .at_least(0),
        parameter("noise", &D::noise, "{unit}", "of the encoder, standard deviation").at_least(0),
        parameter("seed", &D::seed, "",
                  "of the noise; 0: drawn from the run's seed and the block's name")
            .at_least(0),
        input("set_position", &D::set_position, "{unit}", "set-point of the axis").must_be_set(),
        input("set_velocity", &D::set_velocity, "{unit}/s", "of the set-point"),
        input("home", &D::home, "", "rising edge: position := home_position"),
        input("home_position", &D::home_position, "{unit}", "actual position at home"),
        output("position", &D::position, "{unit}", "actual position, read from the encoder"),
        output("velocity", &D::velocity, "{unit}/s",
               "of the motor; without `kv`: set_velocity, or where that is always 0 what the "
               "positions make"),
        output("motor_position", &D::motor_position, "{unit}", "where the motor is"),
        output("table_position", &D::table_position, "{unit}", "where the table is"),
        output("following_error", &D::following_error, "{unit}",
               "set-point in the drive - actual position"),
        output("error", &D::error, "", "the drive cannot follow; outputs are held"),
        output("error_id", &D::error_id, "", "why").one_of(error_names),
    };
    return table;
}

void ServoDrive::scan(const Scan& now) {
    if (!checked) check();
    error_id = all_finite(set_position, set_velocity, home_position) ? contradiction
                                                                     : ServoError::not_finite;
    const bool homing = rising_edge(home, last_home);
    in_simulation = in_simulation && !homing;
    has_velocity = has_velocity || set_velocity != 0;
    const double elapsed = now.index == 0 ? 0 : seconds(now.time - last_time);
    if (error_id == ServoError::none)
        error_id = in_simulation ? copy(elapsed) : follow(now.time, homing);
    last_time = now.time;
    error = error_id != ServoError::none;
}

/// Parameters do not change while a program runs.
void ServoDrive::check() {
    using Kind = VelocityLoop::Kind;
    const Transmission& t = transmission;
    checked = true;
    in_simulation = kv == 0 && delay == 0 && resolution == 0 && noise == 0 && t.backlash == 0 &&
                    t.windup == 0 && t.breakaway_windup == 0;
    if (kv == 0 && (loop.kind != Kind::ideal || velocity_feed_forward > 0 || integral_time > 0))
        contradiction = ServoError::no_position_loop;
    else if (loop.kind == Kind::ideal && (loop.coulomb > 0 || loop.viscous > 0))
        contradiction = ServoError::no_velocity_loop;
    else if ((loop.kind == Kind::first_order && loop.time_constant == 0) ||
             (loop.kind == Kind::second_order && loop.natural_frequency == 0))
        contradiction = ServoError::no_time_constant;
}

/// What `follow` comes to with everything off, in less than half the time.
ServoError ServoDrive::copy(double elapsed) {
    velocity =
        has_velocity ? set_velocity : velocity_between(motor_position, set_position, elapsed);
    position = motor_position = table_position = set_position;
    return ServoError::none;
}

ServoError ServoDrive::follow(std::int64_t time, bool homing) {
    if (first_scan) start();
    const double elapsed = first_scan ? 0 : seconds(time - last_time);
    first_scan = false;
    return move(transported(), elapsed, homing);
}

void ServoDrive::start() {
    transport.fill({set_position, 0});
    motor.position = gear.driven = set_position;
    random = Random(static_cast<std::uint64_t>(seed), "noise");
}

/// The set-point that reaches the drive now.
ServoDrive::SetPoint ServoDrive::transported() {
    newest = newest == longest_delay ? 0 : newest + 1;
    transport[static_cast<std::size_t>(newest)] = {set_position, set_velocity};
    const std::int64_t wanted = newest - delay;
    return transport[static_cast<std::size_t>(wanted < 0 ? wanted + longest_delay + 1 : wanted)];
}

/// What no double can hold is not set.
ServoError ServoDrive::move(const SetPoint& wanted, double elapsed, bool homing) {
    const VelocityLoop::State next =
        kv > 0 ? loop.advance(motor, demand, elapsed) : at_set_point(wanted, elapsed);
    const Transmission::State next_gear = transmission.advance(gear, next.position, elapsed);
    const double table = transmission.table(next_gear);
    const double seen = read_encoder(encoder == Encoder::motor ? next.position : table);
    const double next_offset = homing ? home_position - seen : home_offset;
    const double reading = homing ? home_position : seen + next_offset;
    const double distance = wanted.position - reading;
    const double next_integral =
        integral_time > 0 ? integral + distance * elapsed / integral_time : 0;
    const double next_demand =
        kv * (distance + next_integral) + velocity_feed_forward * wanted.velocity;
    if (!all_finite(next.position, next.velocity, next.integral, table, reading, next_demand))
        return ServoError::not_finite;
    motor = next;
    gear = next_gear;
    demand = next_demand;
    integral = next_integral;
    home_offset = next_offset;
    motor_position = next.position;
    velocity = next.velocity;
    table_position = table;
    position = reading;
    following_error = distance;
    return ServoError::none;
}

/// How a motor without a position loop moves.
VelocityLoop::State ServoDrive::at_set_point(const SetPoint& wanted, double elapsed) const {
    const double made = velocity_between(motor.position, wanted.position, elapsed);
    return {wanted.position, has_velocity ? wanted.velocity : made, 0};
}

double ServoDrive::read_encoder(double true_position) {
    const double seen = noise > 0 ? true_position + noise * random.normal() : true_position;
    return resolution > 0 ? resolution * std::round(seen / resolution) : seen;
}

}  // namespace lineshaft
