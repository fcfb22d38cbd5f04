#include "blocks/logic/signal.hpp"

#include <bit>
#include <limits>

#include <sleef.h>

namespace lineshaft {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// 1 - exp(-dt / T); not a number where T is no time constant.
double share_of(std::int64_t step, double time_constant) {
    if (!all_finite(time_constant) || time_constant < 0) return not_a_number;
    return time_constant > 0 ? -Sleef_cinz_expm1d1_u10purec(-seconds(step) / time_constant) : 1;
}

std::uint64_t bits(double x) {
    return std::bit_cast<std::uint64_t>(x);
}

struct Share {
    std::int64_t step = 0;            ///< [ns]
    std::uint64_t time_constant = 0;  ///< its bits
    double share = 1;
};

/// Where share_of() is kept among those used lately: under jitter all filters of a task meet the
/// same new interval, and the exponential takes ten times as long as the rest. A thread has its
/// own, so that nobody waits; what is found is what would be computed.
Share& recent_share(std::int64_t step, double time_constant) {
    constexpr int size_bits = 8;
    thread_local Share recent[1 << size_bits];
    const std::uint64_t mixed =
        (static_cast<std::uint64_t>(step) ^ bits(time_constant) >> 20) * 0x9e3779b97f4a7c15u;
    return recent[mixed >> (64 - size_bits)];
}

}  // namespace

std::span<const Field> Scale::fields() {
    using S = Scale;
    static const Field table[] = {
        parameter("in_unit", &S::in_unit, "", "unit of `in`; left out: plain numbers")
            .one_of(number_unit_names),
        parameter("unit", &S::unit, "", "unit of `out`; left out: plain numbers")
            .one_of(number_unit_names),
        input("in", &S::in, "{in_unit}", "the number").must_be_set(),
        input("in_low", &S::in_low, "{in_unit}", "gives out_low"),
        input("in_high", &S::in_high, "{in_unit}", "gives out_high").must_be_set(),
        input("out_low", &S::out_low, "{unit}", "out at in_low"),
        input("out_high", &S::out_high, "{unit}", "out at in_high").must_be_set(),
        output("out", &S::out, "{unit}", "the number in the new range"),
        output("error", &S::error, "", number_error_doc),
        output("error_id", &S::error_id, "", "why").one_of(number_error_names),
    };
    return table;
}

void Scale::scan(const Scan&) {
    NumberError wrong = finite_error(in, in_low, in_high, out_low, out_high);
    const double range = in_high - in_low;
    if (wrong == NumberError::none && range == 0) wrong = NumberError::wrong_limits;
    if (wrong == NumberError::none && !all_finite(range)) wrong = NumberError::overflow;
    settle(*this,
           wrong == NumberError::none ? out_low + (in - in_low) / range * (out_high - out_low) : 0,
           wrong);
}

std::span<const Field> FilterPt1::fields() {
    using F = FilterPt1;
    static const Field table[] = {
        parameter("unit", &F::unit, "", number_unit_doc).one_of(number_unit_names),
        input("in", &F::in, "{unit}", "the number").must_be_set(),
        input("time_constant", &F::time_constant, "s", "T: a step is passed on to 63 % after it")
            .at_least(0)
            .must_be_set(),
        output("out", &F::out, "{unit}", "the number smoothed"),
        output("error", &F::error, "", number_error_doc),
        output("error_id", &F::error_id, "", "why").one_of(number_error_names),
    };
    return table;
}

void FilterPt1::scan(const Scan& now) {
    const std::int64_t step = now.time - last_time;
    if (step != share_step || bits(time_constant) != bits(share_constant)) {
        const Share& recent = recent_share(step, time_constant);
        if (recent.step != step || recent.time_constant != bits(time_constant))
            return follow_with_new_share(now);
        share_step = step;
        share_constant = time_constant;
        share = recent.share;
    }
    follow(now);
}

inline void FilterPt1::follow(const Scan& now) {
    const double from = started ? out : in;
    const double next = from + (in - from) * share;
    if (!all_finite(next)) return tell_why_not_finite();
    report(*this, NumberError::none);
    out = next;
    started = true;
    last_time = now.time;
}

void FilterPt1::follow_with_new_share(const Scan& now) {
    share_step = now.time - last_time;
    share_constant = time_constant;
    share = share_of(share_step, time_constant);
    recent_share(share_step, time_constant) = {share_step, bits(time_constant), share};
    follow(now);
}

void FilterPt1::tell_why_not_finite() {
    if (!all_finite(in, time_constant))
        report(*this, NumberError::not_finite);
    else
        report(*this, time_constant < 0 ? NumberError::wrong_limits : NumberError::overflow);
}

}  // namespace lineshaft
