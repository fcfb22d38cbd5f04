#pragma once

#include <array>
#include <span>

#include "blocks/axis/axis_unit.hpp"
#include "blocks/axis/transmission.hpp"
#include "blocks/axis/velocity_loop.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/random.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Why a servo drive set `error`. It holds its outputs, and goes on when the inputs are good again.
enum class ServoError : std::int64_t {
    none,
    not_finite,        ///< an input is NaN or infinite, or the motion leaves the range of numbers
    no_position_loop,  ///< velocity loop, feed-forward or integral action without `kv`
    no_velocity_loop,  ///< friction without a velocity loop that it could act on
    no_time_constant,  ///< a velocity loop without its `time_constant` or `natural_frequency`
};

/// A drive with its motor, mechanics and encoder, from the set-point of one clock to the actual
/// position of the next. Everything is off by default; the axis is then in simulation, as Siemens'
/// technology objects have it: the actual position is the set-point that was there at the scan. In
/// the servo task, which runs *before* the interpolator at each clock, that is the one of a clock
/// ago: what the user program then reads.
///
///     set-point       r(k) = set_position(k - delay), rv likewise             transport, in clocks
///     position loop   u = kv (e + integral of e / integral_time) + velocity_feed_forward * rv,
///                     e = r - position; held for a clock
///     velocity loop   u -> velocity of the motor, with Coulomb and viscous friction:
///                     see velocity_loop.hpp; without kv the motor is at r at once
///     transmission    motor -> table, with backlash and windup: see transmission.hpp
///     encoder         position = resolution * round((m + noise) / resolution), m of motor or
///                     table, noise normal with the standard deviation `noise`
///     homing          the zero of the encoder is set so that the position read in the scan of the
///                     rising edge of `home` is `home_position` (MC_Home, direct: modes 0, 1)
///
/// Homing moves nothing: without kv the motor stays at its set-point. With kv the drive follows its
/// set-point by the homed position, so home the axis that makes the set-points to the same
/// position.
///
/// In steady motion at velocity V the first-order loop follows at a distance of
///     ((1 - velocity_feed_forward + d T) V + c T sign(V)) / kv
/// without integral action, and friction holds an axis at rest within c T / kv. The drive starts at
/// rest on its first set-point. Elapsed time is that between the scans, also when the task's clock
/// wanders.
struct ServoDrive {
    enum class Encoder : std::int64_t { motor, table };
    static constexpr std::int64_t longest_delay = 64;  ///< [clocks]

    AxisUnit unit = AxisUnit::mm;
    std::int64_t delay = 0;
    double kv = 0, integral_time = 0, velocity_feed_forward = 0;
    VelocityLoop loop;
    Transmission transmission;
    Encoder encoder = Encoder::motor;
    double resolution = 0, noise = 0;
    std::int64_t seed = 0;

    double set_position = 0, set_velocity = 0;
    bool home = false;
    double home_position = 0;

    double position = 0, velocity = 0;
    double motor_position = 0, table_position = 0;
    double following_error = 0;
    bool error = false;
    ServoError error_id = ServoError::none;

    struct SetPoint {
        double position = 0, velocity = 0;
    };
    std::array<SetPoint, longest_delay + 1> transport{};  ///< a ring
    std::int64_t newest = 0;
    bool checked = false, in_simulation = false, first_scan = true, last_home = false;
    bool has_velocity = false;                    ///< set_velocity has not always been 0
    double home_offset = 0;                       ///< position - what the encoder sees [u]
    ServoError contradiction = ServoError::none;  ///< of the parameters
    std::int64_t last_time = 0;
    double demand = 0;    ///< u [u/s], since the last scan
    double integral = 0;  ///< of e / integral_time [u]
    VelocityLoop::State motor;
    Transmission::State gear;
    Random random{0, "noise"};

    static constexpr std::string_view type = "servo_drive";
    static constexpr std::string_view doc =
        "drive, motor, mechanics and encoder of an axis; by default in simulation";
    static std::span<const Field> fields();
    void scan(const Scan& now);
    void shift(std::int64_t by) { last_time += by; }

  private:
    void check();
    ServoError copy(double elapsed);
    ServoError follow(std::int64_t time, bool homing);
    void start();
    SetPoint transported();
    ServoError move(const SetPoint& wanted, double elapsed, bool homing);
    VelocityLoop::State at_set_point(const SetPoint& wanted, double elapsed) const;
    double read_encoder(double true_position);
};

}  // namespace lineshaft
