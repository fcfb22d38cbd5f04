#pragma once

namespace lineshaft {

/// From the motor to the table: backlash, then a shaft that friction winds up, and what the drive
/// makes up of it in time.
///
/// Backlash, a play of width b:     p = clamp(p, x - b/2, x + b/2)
///
/// Windup: friction over stiffness. z1 depends on the way, not on the time (Dahl 1968); z2 follows
/// z1 in time, also while the axis stands:
///
///     y = p - (c + k/2) z1 + (k/2) z2
///     dz1 = (s - z1) |dp| / l1,   s = sign of dp
///     dz2/dt = (z1 - z2) / T      (both exact over an interval in which p moves uniformly)
///
/// So the table lags by c in steady motion; after a reversal the lag builds up to c + k within the
/// pre-sliding travel l1, and k decays in the time T, as when the integral action of a position
/// loop makes up friction: with l1 short the deviation from steady motion is k e^(-t / T), a
/// reversal error that lasts a time, whatever the velocity. Before its first motion the axis has no
/// windup. z1 and z2 are contractions of what they were: nothing adds up.
struct Transmission {
    double backlash = 0;           ///< b [u], not below 0
    double windup = 0;             ///< c [u]
    double breakaway_windup = 0;   ///< k [u], in addition to c
    double presliding_travel = 0;  ///< l1 [u], not below 0; 0: at once
    double breakaway_time = 0;     ///< T [s], not below 0; 0: at once

    struct State {
        double driven = 0;      ///< p [u], behind the backlash
        double presliding = 0;  ///< z1, -1..1
        double breakaway = 0;   ///< z2, -1..1
    };

    /// `state`, after the motor has moved to `motor` [u] in `elapsed` [s], not below 0.
    State advance(const State& state, double motor, double elapsed) const;
    /// y [u].
    double table(const State& state) const;
};

}  // namespace lineshaft
