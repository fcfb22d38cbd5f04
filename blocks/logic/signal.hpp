#pragma once

#include <span>

#include "blocks/logic/number.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

/// Conditioning of analog signals.
namespace lineshaft {

/// A straight line through (in_low, out_low) and (in_high, out_high), as Siemens' NORM_X and
/// SCALE_X in one:
///     out = out_low + (in - in_low) / (in_high - in_low) * (out_high - out_low).
/// It goes on beyond both ends: a `limit` behind it cuts. Error: in_low = in_high.
struct Scale {
    NumberUnit in_unit{}, unit{};
    double in = 0, in_low = 0, in_high = 1, out_low = 0, out_high = 1;

    double out = 0;
    bool error = false;
    NumberError error_id = NumberError::none;

    static constexpr std::string_view type = "scale";
    static constexpr std::string_view doc = "a number from one range to another, linearly";
    static std::span<const Field> fields();
    static constexpr auto main_input = &Scale::in;
    void scan(const Scan& now);
};

/// First-order low-pass filter (Siemens: Filter_PT1): T out' + out = in. Exact for an input that
/// holds its value between scans, whatever their distance dt:
///     out += (in - out) (1 - exp(-dt / T)).
/// The first scan has out = in; so has every scan with T = 0. Error: T < 0.
struct FilterPt1 {
    NumberUnit unit{};
    double in = 0;
    double time_constant = 0;

    double out = 0;
    bool error = false;
    NumberError error_id = NumberError::none;

    bool started = false;
    std::int64_t last_time = 0;
    std::int64_t share_step = 0;  ///< `share` holds for this dt [ns] and the next line's T
    double share_constant = 0;
    double share = 1;  ///< 1 - exp(-dt / T); not a number where T is no time constant

    static constexpr std::string_view type = "filter_pt1";
    static constexpr std::string_view doc = "first-order low-pass filter";
    static std::span<const Field> fields();
    static constexpr auto main_input = &FilterPt1::in;
    void scan(const Scan& now);
    void shift(std::int64_t by) { last_time += by; }

  private:
    void follow(const Scan& now);
    [[gnu::noinline]] void follow_with_new_share(const Scan& now);
    [[gnu::cold]] void tell_why_not_finite();
};

}  // namespace lineshaft
