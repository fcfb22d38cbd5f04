#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"
#include "tests/programs/constant_jerk.hpp"

namespace lineshaft {

/// programs/paper/jerk_line.st written by hand in C++, for its test.
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
    double gamma = 0, duration = 0;
    std::int64_t samples = 0;
    bool error = false;
    Error error_id = Error::none;

    bool x_leads = true, last_start = false, sending = false;
    std::int64_t started = 0;
    ConstantJerk<float> narrow;
    ConstantJerk<double> wide;

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
    std::int64_t count_of(Channel& channel, double wanted) const;
    template <class Real>
    void set_rates(Channel& channel, Real start_rate, Real end_rate) const;
    void attach();
};

}  // namespace lineshaft
