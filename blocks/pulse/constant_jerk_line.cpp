#include "blocks/pulse/constant_jerk_line.hpp"

#include <algorithm>
#include <limits>

namespace lineshaft {

namespace {

constexpr std::string_view width_names[] = {"32", "64"};
constexpr std::string_view rounding_names[] = {"truncate", "nearest", "carry"};
constexpr std::string_view chain_names[] = {"leading", "both", "clock"};
constexpr std::string_view kind_names[] = {"none", "no_constant_acceleration", "no_cruise", "full"};
constexpr std::string_view error_names[] = {"none", "not_finite"};
constexpr double most_pulses = 2'147'483'647;  // of a double integer

std::int64_t whole(double value) {
    return value > 0 ? static_cast<std::int64_t>(std::min(value, most_pulses)) : 0;
}

/// To the width of the arithmetic; what a float cannot hold is its largest.
template <class Real>
Real as(double value) {
    constexpr double most = std::numeric_limits<Real>::max();
    return static_cast<Real>(std::clamp(value, -most, most));
}

}  // namespace

std::span<const Field> ConstantJerkLine::fields() {
    using L = ConstantJerkLine;
    static const Field list[] = {
        parameter("real", &L::real, "", "bits of the arithmetic").one_of(width_names),
        parameter("rounding", &L::rounding, "", "of a sample's pulses").one_of(rounding_names),
        parameter("chain", &L::chain, "", "whose completion sends the next sample")
            .one_of(chain_names),
        parameter("period", &L::period, "s", "sampling period"),
        parameter("pulses_per_length", &L::pulses_per_length, "pulses/cm", "of both axes").above(0),
        parameter("threshold_distance", &L::threshold_distance, "cm", "below it an axis stands")
            .at_least(0),
        parameter("threshold_pulses", &L::threshold_pulses, "", "likewise").at_least(0),
        input("acceleration", &L::acceleration, "cm/s^2", "limit of the leading axis"),
        input("jerk", &L::jerk, "cm/s^3", "of the leading axis"),
        input("velocity", &L::velocity, "cm/s", "limit of the leading axis"),
        input("interpolation_time", &L::interpolation_time, "s", "time allowed; 0: not said"),
        input("x", &L::x_displacement, "cm", "displacement, signed"),
        input("y", &L::y_displacement, "cm", "displacement, signed"),
        input("start", &L::start, "", "rising edge: begin a line"),
        input("x_busy", &L::x_busy, "", "channel X is under way").must_be_set(),
        input("y_busy", &L::y_busy, "", "channel Y is under way").must_be_set(),
        output("x_job", &L::x_job, "", "changes with each segment for channel X"),
        output("x_start_rate", &L::x_start_rate, "Hz", "of the segment"),
        output("x_end_rate", &L::x_end_rate, "Hz", "of the segment"),
        output("x_count", &L::x_count, "", "of the segment"),
        output("x_reverse", &L::x_reverse, "", "direction"),
        output("x_interrupt", &L::x_interrupt, "", "the channel's completion is wanted"),
        output("y_job", &L::y_job, "", "changes with each segment for channel Y"),
        output("y_start_rate", &L::y_start_rate, "Hz", "of the segment"),
        output("y_end_rate", &L::y_end_rate, "Hz", "of the segment"),
        output("y_count", &L::y_count, "", "of the segment"),
        output("y_reverse", &L::y_reverse, "", "direction"),
        output("y_interrupt", &L::y_interrupt, "", "the channel's completion is wanted"),
        output("busy", &L::busy, "", "a line is under way"),
        output("done", &L::done, "", "the line has ended"),
        output("unreasonable", &L::unreasonable, "", "a limit is not above 0: no motion"),
        output("short_time", &L::short_time, "", "warning: interpolation_time is at most 4 t1"),
        output("kind", &L::kind, "", "of the profile").one_of(kind_names),
        output("gamma", &L::gamma, "", "smaller displacement / larger"),
        output("samples", &L::samples, "", "sent"),
        output("time", &L::time, "s", "since `start`, until both channels had ended"),
        output("error", &L::error, "", "an input is no number; nothing is sent"),
        output("error_id", &L::error_id, "", "why").one_of(error_names),
    };
    return list;
}

bool ConstantJerkLine::finite() const {
    for (const double value :
         {acceleration, jerk, velocity, interpolation_time, x_displacement, y_displacement})
        if (!std::isfinite(value)) return false;
    return true;
}

void ConstantJerkLine::scan(const Scan& now) {
    error = !finite();
    error_id = error ? Error::not_finite : Error::none;
    if (error) return;
    const bool edge = start && !last_start;
    last_start = start;
    if (edge && !busy) begin(now);
    if (busy) run(now);
    publish();
}

double ConstantJerkLine::effective(double displacement) const {
    const double way = std::abs(displacement);
    const bool stands =
        way < threshold_distance || way * pulses_per_length < static_cast<double>(threshold_pulses);
    return stands ? 0 : way;
}

void ConstantJerkLine::begin(const Scan& now) {
    unreasonable =
        !(acceleration > 0 && jerk > 0 && velocity > 0 && period > 0) || interpolation_time < 0;
    short_time =
        !unreasonable && interpolation_time > 0 && interpolation_time <= 4 * acceleration / jerk;
    const double way_x = effective(x_displacement), way_y = effective(y_displacement);
    const double way = std::max(way_x, way_y);
    done = false;
    samples = 0;
    time = 0;
    if (unreasonable || way == 0) return;
    x_leads = way_x >= way_y;
    gamma = std::min(way_x, way_y) / way;
    x = {.job = x.job, .reverse = x_displacement < 0, .share = x_leads ? 1 : gamma};
    y = {.job = y.job, .reverse = y_displacement < 0, .share = x_leads ? gamma : 1};
    unreasonable = !(real == Width::real_32 ? plan(narrow, way) : plan(wide, way));
    if (unreasonable) return;
    busy = sending = true;
    started = now.time;
}

template <class Real>
bool ConstantJerkLine::plan(ConstantJerk<Real>& profile, double way) {
    const bool good = profile.begin(
        {as<Real>(acceleration), as<Real>(jerk), as<Real>(velocity), as<Real>(period)},
        as<Real>(way));
    kind = profile.kind();
    return good;
}

void ConstantJerkLine::run(const Scan& now) {
    if (sending && (now.time == started || may_send())) send();
    time = seconds(now.time - started);
    if (sending || x_busy || y_busy) return attach();
    busy = false;
    done = true;
}

bool ConstantJerkLine::may_send() const {
    if (chain == Chain::clock) return true;
    if (chain == Chain::both) return !x_busy && !y_busy;
    return x_leads ? !x_busy : !y_busy;
}

void ConstantJerkLine::send() {
    if (real == Width::real_32)
        send(narrow);
    else
        send(wide);
}

/// Samples that make no pulse start no segment, and are passed over.
template <class Real>
void ConstantJerkLine::send(ConstantJerk<Real>& profile) {
    ConstantJerkSample<Real> sample;
    for (bool sent = false; !sent;) {
        sending = profile.next(sample);
        if (!sending) return;
        const bool x_sent = pulses(x, sample);
        const bool y_sent = pulses(y, sample);
        sent = x_sent || y_sent;
        ++samples;
    }
}

template <class Real>
bool ConstantJerkLine::pulses(Channel& channel, const ConstantJerkSample<Real>& sample) {
    if (channel.share == 0) return false;
    const auto scale = as<Real>(pulses_per_length);
    const auto share = as<Real>(channel.share);
    double wanted = static_cast<double>(sample.distance * share * scale);
    if (rounding == Rounding::carry) wanted += channel.fraction;
    if (rounding == Rounding::nearest) wanted += 0.5;
    const std::int64_t count = whole(wanted);
    if (rounding == Rounding::carry) channel.fraction = wanted - static_cast<double>(count);
    if (count == 0) return false;
    channel.count = count;
    channel.start_rate = whole(static_cast<double>(sample.start_velocity * share * scale));
    channel.end_rate = whole(static_cast<double>(sample.end_velocity * share * scale));
    ++channel.job;
    return true;
}

void ConstantJerkLine::attach() {
    const bool only_leading = chain == Chain::leading && sending;
    x.interrupt = !only_leading || x_leads;
    y.interrupt = !only_leading || !x_leads;
}

void ConstantJerkLine::publish() {
    x_job = x.job;
    x_start_rate = x.start_rate;
    x_end_rate = x.end_rate;
    x_count = x.count;
    x_reverse = x.reverse;
    x_interrupt = x.interrupt;
    y_job = y.job;
    y_start_rate = y.start_rate;
    y_end_rate = y.end_rate;
    y_count = y.count;
    y_reverse = y.reverse;
    y_interrupt = y.interrupt;
}

}  // namespace lineshaft
