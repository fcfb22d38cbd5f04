#pragma once

#include <cstddef>
#include <span>

#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

enum class TimerKind : std::size_t { ton, tof, tp };

inline constexpr std::string_view timer_names[] = {"ton", "tof", "tp"};
inline constexpr std::string_view timer_docs[] = {
    "on-delay timer: q rises when in has been true for pt",
    "off-delay timer: q falls when in has been false for pt",
    "pulse timer: q is true for pt after a rising edge of in"};

/// Timers of IEC 61131-3:2013, table 46. All times are whole ns. The clock is the start time of the
/// task's scan, the same for all its blocks: nothing is summed up, and a second call in one scan
/// changes nothing.
///
/// TON, on-delay: the scan that finds `in` true for the first time has et = 0; q rises in the first
/// scan with et >= pt and falls with `in`.
/// TOF, off-delay: q rises with `in`; the scan that finds `in` false again has et = 0; q falls in
/// the first scan with et >= pt.
/// TP, pulse: a rising edge of `in` makes q true, with et = 0, until the first scan with et >= pt.
/// Not retriggerable: an edge during the pulse, or in the scan that ends it, is lost.
///
/// `et` stops at `pt` and stays there, of TON and TP until `in` is false, of TOF until it is true.
/// pt <= 0 is no time: q of TON and TOF follows `in` at once, TP gives no pulse.
/// The standard leaves open what a new `pt` does while time runs, and vendors differ. Here the `pt`
/// of each scan counts until the time is up; after that it has no effect before the next start.
/// With `answers_later`, as in MatIEC, the call that starts a timer does not look at `pt`: with
/// pt <= 0 the next one ends it.
/// With `keeps_pt`, as in Siemens' controllers, it has none from the start on: `preset` counts.
template <TimerKind kind>
struct Timer {
    bool in = false;
    std::int64_t pt = 0;

    bool q = false;
    std::int64_t et = 0;

    bool running = false;  ///< TON: since `in` rose; TOF: since it fell
    bool last_in = false;  ///< TP
    bool keeps_pt = false, answers_later = false;
    std::int64_t start = 0;
    std::int64_t preset = 0;  ///< pt at the start

    static constexpr std::string_view type = timer_names[static_cast<std::size_t>(kind)];
    static constexpr std::string_view doc = timer_docs[static_cast<std::size_t>(kind)];
    static std::span<const Field> fields();
    static constexpr auto main_input = &Timer::in;
    void scan(const Scan& now);
    void shift(std::int64_t by) { start += by; }

  private:
    void begin(const Scan& now);
    bool elapsed(const Scan& now);
    std::int64_t limit() const { return keeps_pt ? preset : pt; }
};

using Ton = Timer<TimerKind::ton>;
using Tof = Timer<TimerKind::tof>;
using Tp = Timer<TimerKind::tp>;

template <>
void Ton::scan(const Scan& now);
template <>
void Tof::scan(const Scan& now);
template <>
void Tp::scan(const Scan& now);

}  // namespace lineshaft
