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
/// x.done, y.done]`); the other's is only asked for when the line waits for it. A channel still
/// busy takes the segment into its queue. A sample whose pulses come to 0 starts none. `done` when
/// both channels have ended; `time` is from `start` until then.
///
/// Pulses of a sample: distance * pulses_per_length, truncated (as measured), to the nearest, or
/// with the fraction carried into the axis' next sample. Rates are truncated.
/// `real: 32` reckons as the controller's REAL, `64` in double.
///
/// A displacement below `threshold_distance` or `threshold_pulses` does not move its axis. Limits
/// that are zero or negative set `unreasonable`, and nothing moves; an `interpolation_time` not
/// above 4 t1 sets `short_time`, a warning.
struct ConstantJerkLine {
    enum class Width : std::int64_t { real_32, real_64 };
    enum class Rounding : std::int64_t { truncate, nearest, carry };
    enum class Chain : std::int64_t { leading, both, clock };
    enum class Error : std::int64_t { none, not_finite };

    Width real = Width::real_64;
    Rounding rounding = Rounding::truncate;
    Chain chain = Chain::leading;
    double period = 0.05, pulses_per_length = 1;
    double threshold_distance = 0.001;
    std::int64_t threshold_pulses = 0;

    double acceleration = 1, jerk = 1, velocity = 1, interpolation_time = 0;
    double x_displacement = 0, y_displacement = 0;
    bool start = false, x_busy = false, y_busy = false;

    /// What goes to one channel.
    struct Channel {
        std::int64_t job = 0, start_rate = 1, end_rate = 1, count = 1;
        bool reverse = false, interrupt = true;
        double share = 0;     ///< of the leading axis' way: 1, gamma or 0
        double fraction = 0;  ///< pulses carried
    };
    std::int64_t x_job = 0, x_start_rate = 1, x_end_rate = 1, x_count = 1;
    std::int64_t y_job = 0, y_start_rate = 1, y_end_rate = 1, y_count = 1;
    bool x_reverse = false, y_reverse = false, x_interrupt = true, y_interrupt = true;
    bool busy = false, done = false, unreasonable = false, short_time = false;
    ConstantJerkKind kind = ConstantJerkKind::none;
    double gamma = 0, time = 0;
    std::int64_t samples = 0;
    bool error = false;
    Error error_id = Error::none;

    Channel x, y;
    bool x_leads = true, last_start = false, sending = false;
    std::int64_t started = 0;
    ConstantJerk<float> narrow;
    ConstantJerk<double> wide;

    static constexpr std::string_view type = "constant_jerk_line";
    static constexpr std::string_view doc = "user program of a two-axis line with constant jerk";
    static std::span<const Field> fields();
    void scan(const Scan& now);

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
    void attach();
    void publish();
};

}  // namespace lineshaft
