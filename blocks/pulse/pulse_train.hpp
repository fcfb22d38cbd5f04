#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace lineshaft {

/// One line of a profile table: pulses whose rate goes from start to end, linearly in time.
struct PulseSegment {
    std::int64_t start_rate = 1;  ///< [Hz], at least 1
    std::int64_t end_rate = 1;    ///< [Hz], at least 1
    std::int64_t count = 1;       ///< pulses, 1 to 2,147,483,647

    bool operator==(const PulseSegment&) const = default;
};

/// When a new rate takes effect: at once, or with the next pulse.
enum class RateUpdate : std::int64_t { continuous, per_pulse };

/// A moment between two nanoseconds. The fraction keeps segments that follow each other from
/// drifting: it is carried from the end of one into the start of the next.
struct PulseTime {
    std::int64_t nanoseconds = 0;
    double fraction = 0;  ///< [ns], in [0, 1)

    /// To the nearest nanosecond, halves up.
    std::int64_t rounded() const { return nanoseconds + (fraction >= 0.5 ? 1 : 0); }
};

/// The pulses of one segment. Pulse k = 0 .. count-1 begins with its rising edge at t_k and lasts
/// until t_{k+1}; the segment ends with its last pulse, at t_count.
///
///     nominal time       T = 2 count / (f0 + f1)                          (manual)
///     rate               f(t) = f0 + (f1 - f0) t / T
///     continuous         t_k = 2 k / (f0 + sqrt(f0^2 + (f1^2 - f0^2) k / count))
///     per_pulse          t_0 = 0, t_{k+1} = t_k + 1 / f(t_k), f held at f1 after T
///
/// The first of these solves k = integral of f, so t_count = T. A constant rate gives
/// t_k = k / f both ways, and is reckoned in integers. Edges are rounded to the nearest nanosecond;
/// before that the closed form is good to 4e-16 of the segment's time (1 ns in a month), an end by
/// `continuous` is an exact quotient.
class PulseTrain {
  public:
    /// Rates and count must be in range.
    void begin(const PulseSegment& segment, RateUpdate rate_update, PulseTime start);

    const PulseSegment& segment() const { return segment_; }

    /// Rising edges taken or skipped so far.
    std::int64_t emitted() const { return emitted_; }

    /// Writes the next rising edges [ns] that are not later than `until`, at most `out.size()`.
    /// Returns their number.
    std::size_t take(std::int64_t until, std::span<std::int64_t> out);

    /// As `take`, without writing, and all of them.
    void skip(std::int64_t until);

    /// A time [ns] that is not later than the end: the end itself when `ends()` says so. With
    /// `per_pulse` only the pulses tell it; then this is a time until which they must be taken to
    /// know more, and not earlier than the next of them.
    std::int64_t end_not_before() const;

    /// The last pulse has ended at `time` [ns] or before. All edges up to `time` must be taken.
    bool ends(std::int64_t time) const;

    /// The end of a train whose edges have all been taken, or of a `continuous` one.
    PulseTime end() const;

    /// Whether these can be the numbers of a train whose edges up to `time` [ns] have been taken.
    bool is_possible(std::int64_t time) const;

    /// Rate of the pulse that is under way at `time` [Hz]; `continuous`: the rate at `time`.
    double rate(std::int64_t time) const;

  private:
    /// What a segment's edges have in common.
    struct Ramp {
        double rate;    ///< at its start [1/s]
        double growth;  ///< of the rate's square, a pulse [1/s^2]

        double offset(double pulse) const;  ///< of an edge from the start [ns]
    };

    bool is_closed_form() const;
    Ramp ramp() const;
    static std::int64_t rounded(double offset, const PulseTime& start);
    std::int64_t rounded(double offset) const;
    std::int64_t edge(std::int64_t pulse) const;
    std::int64_t count_at(std::int64_t time) const;
    void constant_rate_edges(std::int64_t first, std::span<std::int64_t> out) const;
    void ramp_edges(std::int64_t first, std::span<std::int64_t> out) const;
    std::size_t walk(std::int64_t until, std::int64_t* out, std::size_t most);
    double rate_at(double offset) const;
    PulseTime after_start(double offset) const;

    PulseSegment segment_;
    RateUpdate rate_update_ = RateUpdate::continuous;
    PulseTime start_;
    std::int64_t emitted_ = 0;
    double nominal_ = 0;    ///< T [ns]
    double slope_ = 0;      ///< (f1 - f0) / T [Hz/ns]
    double next_ = 0;       ///< per_pulse: t of pulse `emitted` [ns after the start]
    double last_rate_ = 1;  ///< per_pulse: of the pulse before it [Hz]
};

}  // namespace lineshaft
