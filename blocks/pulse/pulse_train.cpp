#include "blocks/pulse/pulse_train.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft {

namespace {

constexpr std::int64_t second = 1'000'000'000;

/// Above the rounding of the rates' sum and below what a look too many costs.
constexpr double safe_share = 1 - 1e-9;

double square(double x) {
    return x * x;
}

PulseTime normalized(std::int64_t nanoseconds, double fraction) {
    const double whole = std::floor(fraction);
    return {nanoseconds + static_cast<std::int64_t>(whole), fraction - whole};
}

}  // namespace

void PulseTrain::begin(const PulseSegment& segment, RateUpdate rate_update, PulseTime start) {
    segment_ = segment;
    rate_update_ = rate_update;
    start_ = start;
    emitted_ = 0;
    next_ = 0;
    const auto f0 = static_cast<double>(segment.start_rate);
    const auto f1 = static_cast<double>(segment.end_rate);
    nominal_ = 2 * static_cast<double>(segment.count) * second / (f0 + f1);
    slope_ = (f1 - f0) / nominal_;
    last_rate_ = f0;
}

std::size_t PulseTrain::take(std::int64_t until, std::span<std::int64_t> out) {
    if (!is_closed_form()) return walk(until, out.data(), out.size());
    const std::int64_t due = count_at(until) - emitted_;
    const std::size_t taken = std::min(out.size(), static_cast<std::size_t>(due));
    if (segment_.start_rate == segment_.end_rate)
        constant_rate_edges(emitted_, out.first(taken));
    else
        ramp_edges(emitted_, out.first(taken));
    emitted_ += static_cast<std::int64_t>(taken);
    return taken;
}

void PulseTrain::skip(std::int64_t until) {
    if (is_closed_form())
        emitted_ = std::max(emitted_, count_at(until));
    else
        walk(until, nullptr, static_cast<std::size_t>(segment_.count));
}

std::int64_t PulseTrain::end_not_before() const {
    if (is_closed_form() || emitted_ == segment_.count) return end().rounded();
    const auto left = static_cast<double>(segment_.count - emitted_);
    const double fastest =
        std::max(rate_at(next_), static_cast<double>(segment_.end_rate)) / second;
    const double earliest = next_ + left / fastest * safe_share - 1;
    return rounded(std::max(next_, earliest));
}

bool PulseTrain::ends(std::int64_t time) const {
    return emitted_ == segment_.count && end().rounded() <= time;
}

PulseTime PulseTrain::end() const {
    if (!is_closed_form()) return after_start(next_);
    const std::int64_t rates = segment_.start_rate + segment_.end_rate;
    const std::int64_t dividend = 2 * segment_.count * second;
    const double rest = static_cast<double>(dividend % rates) / static_cast<double>(rates);
    return normalized(start_.nanoseconds + dividend / rates, start_.fraction + rest);
}

double PulseTrain::rate(std::int64_t time) const {
    if (is_closed_form())
        return rate_at(static_cast<double>(time - start_.nanoseconds) - start_.fraction);
    return last_rate_;
}

bool PulseTrain::is_possible(std::int64_t time) const {
    constexpr std::int64_t most_rate = 100'000, most_count = 2'147'483'647;
    constexpr std::int64_t far = std::int64_t{1} << 61;
    const auto within = [](std::int64_t value, std::int64_t most) {
        return value >= 1 && value <= most;
    };
    if (!within(segment_.start_rate, most_rate) || !within(segment_.end_rate, most_rate) ||
        !within(segment_.count, most_count) || rate_update_ < RateUpdate::continuous ||
        rate_update_ > RateUpdate::per_pulse || start_.nanoseconds < -far ||
        start_.nanoseconds > far || !(start_.fraction >= 0 && start_.fraction < 1))
        return false;
    PulseTrain same;
    same.begin(segment_, rate_update_, start_);
    if (same.nominal_ != nominal_ || same.slope_ != slope_ || emitted_ < 0 ||
        emitted_ > segment_.count)
        return false;
    if (is_closed_form()) return emitted_ == count_at(time);
    const double longest = static_cast<double>(segment_.count) * second;
    if (!(next_ >= 0 && next_ <= longest) || !(last_rate_ >= 1 && last_rate_ <= most_rate))
        return false;
    return emitted_ == segment_.count || rounded(next_) > time;
}

bool PulseTrain::is_closed_form() const {
    return rate_update_ == RateUpdate::continuous || segment_.start_rate == segment_.end_rate;
}

PulseTime PulseTrain::after_start(double offset) const {
    const double whole = std::floor(offset);
    return normalized(start_.nanoseconds + static_cast<std::int64_t>(whole),
                      start_.fraction + (offset - whole));
}

double PulseTrain::rate_at(double offset) const {
    const double t = std::clamp(offset, 0.0, nominal_);
    return t < nominal_ ? static_cast<double>(segment_.start_rate) + slope_ * t
                        : static_cast<double>(segment_.end_rate);
}

double PulseTrain::Ramp::offset(double pulse) const {
    return 2.0 * second * pulse / (rate + std::sqrt(square(rate) + growth * pulse));
}

PulseTrain::Ramp PulseTrain::ramp() const {
    const auto f0 = static_cast<double>(segment_.start_rate);
    const double squares = square(static_cast<double>(segment_.end_rate)) - square(f0);
    return {f0, squares / static_cast<double>(segment_.count)};
}

std::int64_t PulseTrain::rounded(double offset, const PulseTime& start) {
    return start.nanoseconds + static_cast<std::int64_t>(offset + (start.fraction + 0.5));
}

std::int64_t PulseTrain::rounded(double offset) const {
    return rounded(offset, start_);
}

std::int64_t PulseTrain::edge(std::int64_t pulse) const {
    const std::int64_t f = segment_.start_rate;
    if (f != segment_.end_rate) return rounded(ramp().offset(static_cast<double>(pulse)));
    const auto rest = static_cast<double>(pulse * second % f);
    return pulse * second / f + rounded(rest / static_cast<double>(f));
}

/// From the integral of the rate, then set right by the edges themselves.
std::int64_t PulseTrain::count_at(std::int64_t time) const {
    const double t =
        std::clamp(static_cast<double>(time - start_.nanoseconds) - start_.fraction, 0.0, nominal_);
    const double passed = (static_cast<double>(segment_.start_rate) + slope_ * t / 2) * t / second;
    std::int64_t count = std::min(static_cast<std::int64_t>(passed) + 1, segment_.count);
    while (count > 0 && edge(count - 1) > time) --count;
    while (count < segment_.count && edge(count) <= time) ++count;
    return count;
}

void PulseTrain::constant_rate_edges(std::int64_t first, std::span<std::int64_t> out) const {
    const std::int64_t f = segment_.start_rate;
    const std::int64_t step = second / f, rest_step = second % f;
    std::int64_t whole = first * second / f;
    std::int64_t rest = first * second % f;
    for (std::int64_t& time : out) {
        time = whole + rounded(static_cast<double>(rest) / static_cast<double>(f));
        const bool carry = rest + rest_step >= f;
        whole += step + carry;
        rest += rest_step - (carry ? f : 0);
    }
}

void PulseTrain::ramp_edges(std::int64_t first, std::span<std::int64_t> out) const {
    const Ramp ramp = this->ramp();
    const PulseTime start = start_;
    for (std::int64_t& time : out) time = rounded(ramp.offset(static_cast<double>(first++)), start);
}

std::size_t PulseTrain::walk(std::int64_t until, std::int64_t* out, std::size_t most) {
    std::size_t taken = 0;
    while (taken < most && emitted_ < segment_.count) {
        const std::int64_t time = rounded(next_);
        if (time > until) break;
        if (out) out[taken] = time;
        ++taken;
        ++emitted_;
        last_rate_ = rate_at(next_);
        next_ += second / last_rate_;
    }
    return taken;
}

}  // namespace lineshaft
