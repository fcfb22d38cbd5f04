#pragma once

#include <cstdint>
#include <string>

namespace lineshaft {

/// Which moment of the clock a virtual time has. Virtual times do not depend on it.
class Pacer {
  public:
    static constexpr double unpaced = 0, least = 1e-6, most = 1e6;

    /// `speed`: virtual seconds a second, above 0, or unpaced.
    explicit Pacer(double speed) : speed_(speed) {}

    double speed() const { return speed_; }
    bool is_paced() const { return speed_ != unpaced; }
    void set_speed(double speed) { speed_ = speed; }

    /// The virtual time `time` is at `wall`.
    void anchor(std::int64_t time, std::int64_t wall);
    /// Everything is so much later [ns].
    void put_off(std::int64_t by) { wall_ += by; }

    /// When `time` is due on the clock, and the virtual time that is due at `wall` [ns].
    std::int64_t due(std::int64_t time) const;
    std::int64_t time_at(std::int64_t wall) const;

    static std::int64_t now();                   ///< CLOCK_MONOTONIC [ns]
    static void sleep_until(std::int64_t wall);  ///< or until a signal comes
    static void take_sleep_at_its_word();        ///< this thread: no slack of 50 us

    /// This thread before all others, its memory in place: SCHED_FIFO at `priority`, 1 to 99; not
    /// so the threads that it starts. Empty, or why that is not allowed.
    static std::string be_realtime(int priority);

  private:
    double speed_;
    std::int64_t time_ = 0, wall_ = 0;  ///< what is due when [ns]
};

}  // namespace lineshaft
