#include "tests/programs/constant_jerk_line.hpp"

#include <algorithm>
#include <limits>

namespace lineshaft {

namespace {

constexpr std::string_view width_names[] = {"32", "64"};
constexpr std::string_view rounding_names[] = {"truncate", "nearest", "carry"};
constexpr std::string_view rates_names[] = {"velocity", "fit"};
constexpr std::string_view phases_names[] = {"cut", "whole"};
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

/// The field of a channel's member.
Field of(ConstantJerkLine::Channel ConstantJerkLine::*channel, Field field) {
    field.offset += detail::offset_of(channel);
    return field;
}

}  // namespace

std::span<const Field> ConstantJerkLine::fields() {
    using L = ConstantJerkLine;
    using C = ConstantJerkLine::Channel;
    static const Field list[] = {
        parameter("real", &L::real, "", "bits of the arithmetic").one_of(width_names),
        parameter("rounding", &L::rounding, "", "of a sample's pulses").one_of(rounding_names),
        parameter("rates", &L::rates, "", "of a sample: the axis' own, or such that it fits")
            .one_of(rates_names),
        parameter("phases", &L::phases, "", "a part of a sample is cut, or made whole")
            .one_of(phases_names),
        parameter("chain", &L::chain, "", "whose completion sends the next sample")
            .one_of(chain_names),
        parameter("period", &L::period, "s", "sampling period").above(0),
        parameter("pulses_per_length", &L::pulses_per_length, "pulses/cm", "of both axes").above(0),
        parameter("threshold_distance", &L::threshold_distance, "cm", "below it an axis stands")
            .at_least(0),
        parameter("threshold_pulses", &L::threshold_pulses, "", "likewise").at_least(0),
        input("acceleration", &L::acceleration, "cm/s^2", "limit of the leading axis").above(0),
        input("jerk", &L::jerk, "cm/s^3", "of the leading axis").above(0),
        input("velocity", &L::velocity, "cm/s", "limit of the leading axis").above(0),
        input("interpolation_time", &L::interpolation_time, "s", "time allowed; 0: not said")
            .at_least(0),
        input("start", &L::start, "", "rising edge: begin a line"),
        of(&L::x, input("x", &C::displacement, "cm", "displacement, signed")),
        of(&L::y, input("y", &C::displacement, "cm", "displacement, signed")),
        of(&L::x, input("x_busy", &C::busy, "", "channel X is under way").must_be_set()),
        of(&L::y, input("y_busy", &C::busy, "", "channel Y is under way").must_be_set()),
        of(&L::x, output("x_job", &C::job, "", "changes with each segment for channel X")),
        of(&L::x, output("x_start_rate", &C::start_rate, "Hz", "of the segment")),
        of(&L::x, output("x_end_rate", &C::end_rate, "Hz", "of the segment")),
        of(&L::x, output("x_count", &C::count, "", "of the segment")),
        of(&L::x, output("x_reverse", &C::reverse, "", "direction")),
        of(&L::x, output("x_interrupt", &C::interrupt, "", "the channel's completion is wanted")),
        of(&L::y, output("y_job", &C::job, "", "changes with each segment for channel Y")),
        of(&L::y, output("y_start_rate", &C::start_rate, "Hz", "of the segment")),
        of(&L::y, output("y_end_rate", &C::end_rate, "Hz", "of the segment")),
        of(&L::y, output("y_count", &C::count, "", "of the segment")),
        of(&L::y, output("y_reverse", &C::reverse, "", "direction")),
        of(&L::y, output("y_interrupt", &C::interrupt, "", "the channel's completion is wanted")),
        output("busy", &L::busy, "", "a line is under way"),
        output("done", &L::done, "", "the line has ended"),
        output("unreasonable", &L::unreasonable, "", "a limit is not above 0: no motion"),
        output("short_time", &L::short_time, "", "warning: interpolation_time is at most 4 t1"),
        output("kind", &L::kind, "", "of the profile").one_of(kind_names),
        output("gamma", &L::gamma, "", "smaller displacement / larger"),
        output("samples", &L::samples, "", "sent"),
        output("duration", &L::duration, "s", "since `start`, until both channels had ended"),
        output("error", &L::error, "", "an input is not a number; nothing is sent"),
        output("error_id", &L::error_id, "", "why").one_of(error_names),
    };
    return list;
}

bool ConstantJerkLine::finite() const {
    for (const double value :
         {acceleration, jerk, velocity, interpolation_time, x.displacement, y.displacement})
        if (!std::isfinite(value)) return false;
    return true;
}

void ConstantJerkLine::scan(const Scan& now) {
    error = !finite();
    error_id = error ? Error::not_finite : Error::none;
    if (error) return;
    const bool edge = rising_edge(start, last_start);
    if (edge && !busy) begin(now);
    if (busy) run(now);
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
    const double way_x = effective(x.displacement), way_y = effective(y.displacement);
    const double way = std::max(way_x, way_y);
    done = false;
    samples = 0;
    duration = 0;
    if (unreasonable || way == 0) return;
    x_leads = way_x >= way_y;
    gamma = std::min(way_x, way_y) / way;
    x.share = x_leads ? 1 : gamma;
    y.share = x_leads ? gamma : 1;
    for (Channel* channel : {&x, &y}) {
        channel->reverse = channel->displacement < 0;
        channel->fraction = 0;
    }
    unreasonable = !(real == Width::real_32 ? plan(narrow, way) : plan(wide, way));
    if (unreasonable) return;
    busy = sending = true;
    started = now.time;
}

template <class Real>
bool ConstantJerkLine::plan(ConstantJerk<Real>& profile, double way) {
    const bool good = profile.begin(
        {as<Real>(acceleration), as<Real>(jerk), as<Real>(velocity), as<Real>(period)},
        as<Real>(way), phases);
    kind = profile.kind();
    return good;
}

void ConstantJerkLine::run(const Scan& now) {
    if (sending && (now.time == started || may_send())) send();
    duration = seconds(now.time - started);
    if (sending || x.busy || y.busy) return attach();
    busy = false;
    done = true;
}

bool ConstantJerkLine::may_send() const {
    if (chain == Chain::clock) return true;
    if (chain == Chain::both) return !x.busy && !y.busy;
    return x_leads ? !x.busy : !y.busy;
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
    const std::int64_t count =
        count_of(channel, static_cast<double>(sample.distance * share * scale));
    if (count == 0) return false;
    channel.count = count;
    set_rates(channel, sample.start_velocity * share * scale, sample.end_velocity * share * scale);
    ++channel.job;
    return true;
}

std::int64_t ConstantJerkLine::count_of(Channel& channel, double wanted) const {
    if (rounding == Rounding::truncate) return whole(wanted);
    if (rounding == Rounding::carry) wanted += channel.fraction;
    const std::int64_t count = whole(wanted + 0.5);
    channel.fraction = wanted - static_cast<double>(count);
    return count;
}

template <class Real>
void ConstantJerkLine::set_rates(Channel& channel, Real start_rate, Real end_rate) const {
    if (rates == Rates::fit) {
        const auto T = as<Real>(period);
        const Real mean = static_cast<Real>(channel.count) / T;
        const Real half = std::clamp((end_rate - start_rate) / 2, -mean / 2, mean / 2);
        const Real spare = half > 0 ? half * mean / ((mean * mean - half * half) * T) : Real(0);
        start_rate = std::ceil(mean + spare - half);
        end_rate = std::ceil(mean + spare + half);
    }
    channel.start_rate = whole(static_cast<double>(start_rate));
    channel.end_rate = whole(static_cast<double>(end_rate));
}

void ConstantJerkLine::attach() {
    const bool only_leading = chain == Chain::leading && sending;
    x.interrupt = !only_leading || x_leads;
    y.interrupt = !only_leading || !x_leads;
}

}  // namespace lineshaft
