#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "blocks/profile/constant_jerk.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// The user program of the two-axis constant-jerk line: one segment a sample to two `pto` channels.
///
/// A rising edge of `start` takes displacements and limits and sends the first sample; the leading
/// axis is the one with the larger displacement, the other's velocity and distance are multiplied
/// by `gamma` = small / large. `x_job`, `x_start_rate`, ... are wired to the channels; `x_busy`
/// comes back as previous(x.busy). `chain` says when the next sample is sent: when the leading
/// channel is idle, when both are, or in every scan (a timed interrupt). The leading one's
/// completion is the interrupt (`x_interrupt` to x.interrupt, event task `on: [inputs.start,
/// x.done, y.done]`); the other's is only asked for when the line waits for it. With `both` that is
/// two interrupts a sample, each at the task's cost, also the first, which only finds the other
/// channel busy. A channel still busy takes the segment into its queue. A sample whose pulses come
/// to 0 starts none.
///
/// `done` when both channels have ended; `time` is from the start of the scan that saw `start`, so
/// the cost of computing the first sample is in it, to the start of the scan that finds them idle.
///
/// Pulses of a sample: distance * pulses_per_length; `truncate` (as measured), to the `nearest`, or
/// `carry`: to the nearest with what that rounded off in the axis' samples before, so that an axis
/// is never more than half a pulse from its way at a sample's end, and none is lost.
///
/// Rates of a sample: `velocity` takes those of the axis at its two ends, truncated, as the paper
/// does; the first is then 0, which the channel clamps to 1 Hz. `fit` takes rates that put out the
/// count Q within the period T, whether or not a pulse keeps the rate it begins with:
///
///     m = Q / T, h = half the change of the rate, but at most m / 2 either way
///     c = h m / ((m^2 - h^2) T) if h > 0, else 0
///     f0 = m + c - h, f1 = m + c + h, rounded up
///
/// c makes up for pulses that keep their rate on a rising ramp: they lag by ln(f1 / f0) / 2 pulses
/// in all, which c T exceeds. Before the period ends the channel is idle, for less than a
/// pulse at the lower of the two rates.
///
/// `real: 32` reckons as the controller's REAL, `64` in double. `phases`: see ConstantJerk.
///
/// A displacement below `threshold_distance` or `threshold_pulses` does not move its axis. Limits
/// that are zero or negative set `unreasonable`, and nothing moves; an `interpolation_time` not
/// above 4 t1 sets `short_time`, a warning.
struct ConstantJerkLine {
    enum class Width : std::int64_t { real_32, real_64 };
    enum class Rounding : std::int64_t { truncate, nearest, carry };
    enum class Rates : std::int64_t { velocity, fit };
    enum class Chain : std::int64_t { leading, both, clock };
    enum class Error : std::int64_t { none, not_finite };

    Width real = Width::real_64;
    Rounding rounding = Rounding::truncate;
    Rates rates = Rates::velocity;
    ConstantJerkPhases phases = ConstantJerkPhases::cut;
    Chain chain = Chain::leading;
    double period = 0.05, pulses_per_length = 1;
    double threshold_distance = 0.001;
    std::int64_t threshold_pulses = 0;

    double acceleration = 1, jerk = 1, velocity = 1, interpolation_time = 0;
    bool start = false;

    /// What comes from one channel's side and goes to it: `x_count` in a program is x.count.
    struct Channel {
        double displacement = 0;
        bool busy = false;

        bool reverse = false, interrupt = true;
        std::int64_t job = 0, start_rate = 1, end_rate = 1, count = 1;

        double share = 0;     ///< of the leading axis' way: 1, gamma or 0
        double fraction = 0;  ///< pulses carried
    };
    Channel x, y;

    bool busy = false, done = false, unreasonable = false, short_time = false;
    ConstantJerkKind kind = ConstantJerkKind::none;
    double gamma = 0, time = 0;
    std::int64_t samples = 0;
    bool error = false;
    Error error_id = Error::none;

    bool x_leads = true, last_start = false, sending = false;
    std::int64_t started = 0;
    ConstantJerk<float> narrow;
    ConstantJerk<double> wide;

    static constexpr std::string_view type = "constant_jerk_line";
    static constexpr std::string_view doc = "user program of a two-axis line with constant jerk";
    static std::span<const Field> fields();
    void scan(const Scan& now);
    void shift(std::int64_t by) { started += by; }

  private:
    bool finite() const;
    void begin(const Scan& now);
    double effective(double displacement) const;
    void run(const Scan& now);
    bool may_send() const;
    void send();
    template <class Real>
    bool plan(ConstantJerk<Real>& profile, double way);
    template <class Real>
    void send(ConstantJerk<Real>& profile);
    template <class Real>
    bool pulses(Channel& channel, const ConstantJerkSample<Real>& sample);
    std::int64_t count_of(Channel& channel, double wanted) const;
    template <class Real>
    void set_rates(Channel& channel, Real start_rate, Real end_rate) const;
    void attach();
};

}  // namespace lineshaft
