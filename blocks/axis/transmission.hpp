#pragma once

namespace lineshaft {

/// From the motor to the table: backlash, then a shaft of finite stiffness that friction winds up.
///
/// Backlash, a play of width b:     p = clamp(p, x - b/2, x + b/2)
///
/// Windup: friction over stiffness. It depends on the way, not on the time (Dahl 1968; the second
/// element and with it the breakaway by Bliman and Sorine 1995):
///
///     y = p - (c + k/2) z1 + (k/2) z2
///     dz_i = (s - z_i) |dp| / l_i,   s = sign of dp    (exact over each interval)
///
/// So the table lags by c in steady motion; after a reversal the lag builds up to c + k within the
/// pre-sliding travel l1, and k decays over the travel l2: with l1 << l2 the deviation from steady
/// motion is k e^(-travel / l2), a reversal error that lasts a way, whatever the velocity.
/// An axis that stands keeps its windup; before its first motion it has none.
struct Transmission {
    double backlash = 0;           ///< b [u], not below 0
    double windup = 0;             ///< c [u]
    double breakaway_windup = 0;   ///< k [u], in addition to c
    double presliding_travel = 0;  ///< l1 [u]; 0: at once
    double breakaway_travel = 0;   ///< l2 [u]; 0: at once

    struct State {
        double driven = 0;      ///< p [u], behind the backlash
        double presliding = 0;  ///< z1
        double breakaway = 0;   ///< z2
    };

    /// `state`, after the motor has moved to `motor` [u].
    State advance(const State& state, double motor) const;
    /// y [u].
    double table(const State& state) const;
};

}  // namespace lineshaft
