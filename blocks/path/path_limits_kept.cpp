#include "blocks/path/path_limits_kept.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "blocks/path/path_bound.hpp"

namespace lineshaft {

namespace {

constexpr double backwards = 2;  ///< the quotient of what runs backwards

/// The motion of one axis, or of a vector in space.
struct AxisMotion {
    double velocity = 0, acceleration = 0, jerk = 0;
};

/// Path and axes at one instant.
struct Instant {
    double time = 0;  ///< within the phase [s]
    MotionState path;
    std::array<AxisMotion, most_path_axes> axes;
};

/// Greatest sizes of the derivatives of the place by time.
struct PathSizes {
    double velocity = 0, acceleration = 0, jerk = 0, fourth = 0, fifth = 0;
};

/// A phase where it is on one piece.
class PhaseOnPiece {
  public:
    PhaseOnPiece(const PathPiece& on, const PathPhase& of, double along, const PathLimit* braking)
        : piece(on), phase(of), offset(along), path(on.limits.path), halts(braking != nullptr) {
        if (!halts) return;
        path.acceleration = std::max(path.acceleration, braking->acceleration);
        path.jerk = std::max(path.jerk, braking->jerk);
    }

    Instant at(double t) const;
    double quotient(const Instant& a, const Instant& b, int deep) const;

  private:
    const PathPiece& piece;
    const PathPhase& phase;
    double offset;   ///< from the phase's positions to lengths of the piece's curve [u]
    PathLimit path;  ///< along it
    bool halts;

    PathSizes sizes(const Instant& a, const Instant& b) const;
    bool goes_back(const Instant& a, const Instant& b) const;
    double of_path(const PathSizes& most) const;
    double bound(const Instant& a, const Instant& b) const;
};

Instant PhaseOnPiece::at(double t) const {
    Instant out{t, phase.after(t), {}};
    const double v = out.path.velocity, a = out.path.acceleration, j = out.path.jerk;
    const PathPoint x = piece.curve.at(out.path.position + offset);
    for (std::size_t i = 0; i < most_path_axes; ++i)
        out.axes[i] = {x.tangent[i] * v, x.tangent[i] * a + x.bend[i] * v * v,
                       x.tangent[i] * j + 3 * x.bend[i] * v * a + x.twist[i] * v * v * v};
    return out;
}

/// Within a phase the acceleration is greatest at an end, and the velocity there or where that is
/// 0.
PathSizes PhaseOnPiece::sizes(const Instant& a, const Instant& b) const {
    const MotionState &p = a.path, &q = b.path;
    const double c = std::abs(phase.slope);
    PathSizes out;
    out.velocity = std::max(p.velocity, q.velocity);
    if (p.acceleration > 0 && q.acceleration < 0) {
        const double square = p.acceleration * p.acceleration;
        out.velocity = c > 0 ? std::sqrt(p.velocity * p.velocity + square / c)
                             : p.velocity - square / (2 * p.jerk);
    }
    out.acceleration = std::max(std::abs(p.acceleration), std::abs(q.acceleration));
    out.jerk = c > 0 ? c * out.velocity : std::abs(p.jerk);
    out.fourth = c * out.acceleration;
    out.fifth = c * out.jerk;
    return out;
}

/// The least velocity lies at an end, or where the acceleration is 0.
bool PhaseOnPiece::goes_back(const Instant& a, const Instant& b) const {
    constexpr double rounding = 1e-10;
    const MotionState &p = a.path, &q = b.path;
    double least = std::min(p.velocity, q.velocity);
    if (p.acceleration < 0 && q.acceleration > 0) {
        const double square = p.acceleration * p.acceleration;
        const double energy = p.velocity * p.velocity - square / std::abs(phase.slope);
        least = phase.slope == 0 ? p.velocity - square / (2 * p.jerk) : energy < 0 ? -1e300 : 0;
    }
    return least < -rounding * path.velocity;
}

double PhaseOnPiece::of_path(const PathSizes& most) const {
    return std::max({most.velocity / path.velocity, most.acceleration / path.acceleration,
                     most.jerk / path.jerk});
}

double acceleration_rate(const PathBound& x, const PathSizes& s) {
    const double v = s.velocity, a = s.acceleration;
    return x.tangent * s.fourth + 4 * x.bend * v * s.jerk + 3 * x.bend * a * a +
           6 * x.twist * v * v * a + x.fourth * v * v * v * v;
}

double jerk_rate(const PathBound& x, const PathSizes& s) {
    const double v = s.velocity, a = s.acceleration, v3 = v * v * v;
    return x.tangent * s.fifth + x.bend * (5 * v * s.fourth + 10 * a * s.jerk) +
           x.twist * (10 * v * v * s.jerk + 15 * v * a * a) + 10 * x.fourth * v3 * a +
           x.fifth * v3 * v * v;
}

double velocity_rate(const PathBound& x, const PathSizes& s) {
    const double v = s.velocity;
    return x.tangent * s.jerk + 3 * x.bend * v * s.acceleration + x.twist * v * v * v;
}

double quotient_of(const AxisMotion& a, const AxisMotion& b, const PathBound& x,
                   const PathSizes& most, double off, const PathLimit& limit) {
    const auto greatest = [&](double first, double second, double rate, double allowed) {
        return (std::max(std::abs(first), std::abs(second)) + off * rate) / allowed;
    };
    const double velocity = std::max(std::abs(a.velocity), std::abs(b.velocity));
    return std::max(
        {std::min(velocity + off * velocity_rate(x, most), x.tangent * most.velocity) /
             limit.velocity,
         greatest(a.acceleration, b.acceleration, acceleration_rate(x, most), limit.acceleration),
         greatest(a.jerk, b.jerk, jerk_rate(x, most), limit.jerk)});
}

AxisMotion size_in_space(const Instant& at) {
    AxisMotion square;
    for (std::size_t i = 0; i < path_space; ++i) {
        square.acceleration += at.axes[i].acceleration * at.axes[i].acceleration;
        square.jerk += at.axes[i].jerk * at.axes[i].jerk;
    }
    return {0, std::sqrt(square.acceleration), std::sqrt(square.jerk)};
}

/// Over what is linear between two instants no value is greater than the greater of both; from that
/// a value is away by dt^2/8 of its second derivative at most.
double PhaseOnPiece::bound(const Instant& a, const Instant& b) const {
    const double dt = b.time - a.time, off = dt * dt / 8;
    if (goes_back(a, b)) return backwards;
    const PathSizes most = sizes(a, b);
    double out = of_path(most);
    if (piece.curve.kind == PathCurveKind::corner && !halts) {
        PathLimit limit = path;
        limit.velocity = no_path_limit.velocity;
        out = std::max(out, quotient_of(size_in_space(a), size_in_space(b),
                                        bound_of_corner(piece.curve), most, off, limit));
    }
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (piece.bounds[i].tangent > 0)
            out = std::max(out, quotient_of(a.axes[i], b.axes[i], piece.bounds[i], most, off,
                                            piece.limits.axes[i]));
    return out;
}

double PhaseOnPiece::quotient(const Instant& a, const Instant& b, int deep) const {
    const double all = bound(a, b);
    if (all <= 1 + 1e-11 || deep == 0) return all;
    const Instant middle = at(0.5 * (a.time + b.time));
    return std::max(quotient(a, middle, deep - 1), quotient(middle, b, deep - 1));
}

}  // namespace

bool keeps_limits(const PathPieces& pieces, const PathCourse& course, double base,
                  std::span<double> quotients, const PathLimit* braking) {
    constexpr int deepest = 5;
    constexpr double rounding = 1e-9;
    bool all = true;
    std::uint64_t k = pieces.first;
    for (std::size_t n = 0; n < course.count; ++n) {
        const PathPhase& phase = course.phases[n];
        const double lasts = course.end_of(n) - phase.begin;
        const double way = phase.after(lasts).position - phase.start.position;
        double t = 0, worst = 0;
        for (bool is_over = false; !is_over;) {
            const double left = pieces[k].end() - base - phase.start.position;
            is_over = k + 1 == pieces.count || left >= way * (1 - rounding);
            const double until = is_over                 ? lasts
                                 : left > way * rounding ? time_at_way(phase, lasts, left)
                                                         : 0;
            const PhaseOnPiece part(pieces[k], phase, base - pieces[k].begin, braking);
            if (until > t)
                worst = std::max(worst, part.quotient(part.at(t), part.at(until), deepest));
            t = std::max(t, until);
            if (!is_over || (left <= way * (1 + rounding) && k + 1 < pieces.count)) ++k;
        }
        quotients[n] = worst;
        all = all && worst <= 1 + 1e-11;
    }
    return all;
}

}  // namespace lineshaft
