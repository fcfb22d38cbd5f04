#include "tests/blocks/path/least_duration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <sleef.h>

namespace lineshaft {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

constexpr double launch_way = 2;  ///< from standstill, and to it [u]

/// One place of one piece.
struct Place {
    double s = 0;
    PathPoint x;
    const PathPiece* piece = nullptr;

    bool is_corner() const { return piece->curve.kind == PathCurveKind::corner; }
    const PathLimit& path() const { return piece->limits.path; }
    const PathLimit& axis(std::size_t i) const { return piece->limits.axes[i]; }
};

double greatest_velocity(const Place& at) {
    double v = at.path().velocity;
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (at.x.tangent[i] != 0) v = std::min(v, at.axis(i).velocity / std::abs(at.x.tangent[i]));
    return v;
}

/// What is bounded at a place: x' and so on of an axis, and its limits.
struct Bounded {
    double tangent = 0, bend = 0, twist = 0;
    PathLimit limit;
};

/// All that is bounded at a place; in a corner the whole vector, too.
struct Rows {
    std::array<Bounded, most_path_axes + 1> list;
    std::size_t count = 0;
    bool is_corner = false;
    PathLimit path;

    explicit Rows(const Place& at) : is_corner(at.is_corner()), path(at.path()) {
        list[count++] = {1, 0, 0, path};
        for (std::size_t i = 0; i < most_path_axes; ++i)
            if (at.x.tangent[i] != 0 || at.x.bend[i] != 0)
                list[count++] = {at.x.tangent[i], at.x.bend[i], at.x.twist[i], at.axis(i)};
    }

    bool keeps_acceleration(double w, double a) const {
        double square = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double y = list[i].tangent * a + 2 * list[i].bend * w;
            if (std::abs(y) > list[i].limit.acceleration * rounding) return false;
            square += i > 0 ? y * y : 0;
        }
        return !is_corner || std::sqrt(square) <= path.acceleration * rounding;
    }

    /// With the slope of the acceleration by the way.
    bool keeps_jerk(double v, double a, double slope) const {
        double square = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const Bounded& x = list[i];
            const double y = v * (x.tangent * slope + 3 * x.bend * a + x.twist * v * v);
            if (std::abs(y) > x.limit.jerk * rounding) return false;
            square += i > 0 ? y * y : 0;
        }
        return !is_corner || std::sqrt(square) <= path.jerk * rounding;
    }

    static constexpr double rounding = 1 + 1e-9;
};

/// Both limits of the acceleration at a place with v^2/2 = w; false where there is none.
bool range_of_acceleration(const Place& at, double w, double& least, double& most) {
    least = -at.path().acceleration;
    most = at.path().acceleration;
    const auto bounded = [&](double tangent, double bend, double limit) {
        const double across = 2 * bend * w;
        if (std::abs(tangent) < 1e-12) {
            if (std::abs(across) > limit) most = -infinite;
            return;
        }
        const double p = (-limit - across) / tangent, q = (limit - across) / tangent;
        least = std::max(least, std::min(p, q));
        most = std::min(most, std::max(p, q));
    };
    for (std::size_t i = 0; i < most_path_axes; ++i)
        bounded(at.x.tangent[i], at.x.bend[i], at.axis(i).acceleration);
    return least <= most;
}

/// The greatest w up to `most` of which `holds`, which does for all below it.
template <class Holds>
double greatest_that(double most, const Holds& holds) {
    if (holds(most)) return most;
    double low = 0, high = most;
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        (holds(middle) ? low : high) = middle;
    }
    return low;
}

/// From standstill with the jerk J for t1, then with another one for t2.
struct Launch {
    double J = 1, t1 = 0, t2 = 0, other = 0;

    double duration() const { return t1 + t2; }
    MotionState at(double t) const {
        MotionState s = MotionState{0, 0, 0, J}.after(std::min(t, t1));
        s.jerk = other;
        return t > t1 ? s.after(t - t1) : s;
    }
};

/// The soonest one over the way s to (v, a); infinite where there is none.
Launch launch_to(double s, double v, double a, double J) {
    const auto rest = [&](double t1, double& t2) {
        const double v1 = 0.5 * J * t1 * t1, a1 = J * t1;
        t2 = 2 * (v - v1) / (a1 + a);
        return J * t1 * t1 * t1 / 6 + t2 * (v1 + t2 * (2 * a1 + a) / 6) - s;
    };
    Launch best{J, infinite, 0, 0};
    const double most = std::sqrt(2 * v / J);
    constexpr int parts = 16;
    double t2 = 0;
    for (int k = 0; k < parts; ++k) {
        double low = most * k / parts, high = most * (k + 1) / parts;
        const double first = rest(low, t2);
        if ((first > 0) == (rest(high, t2) > 0)) continue;
        for (int step = 0; step < 50; ++step) {
            const double middle = 0.5 * (low + high);
            ((rest(middle, t2) > 0) == (first > 0) ? low : high) = middle;
        }
        rest(low, t2);
        const double jerk = (a - J * low) / t2;
        if (t2 > 0 && std::abs(jerk) <= J * Rows::rounding && low + t2 < best.duration())
            best = {J, low, t2, jerk};
    }
    return best;
}

class Lattice {
  public:
    Lattice(const WholeWay& way, double step, double acceleration);

    double least();

  private:
    double ds, da, dw;
    std::size_t launch_steps;
    long most_a = 0, most_w = 0;
    std::vector<Place> left, right;  ///< of each step
    std::vector<double> now, next, velocities;

    double velocity(long w) const { return velocities[static_cast<std::size_t>(w)]; }
    double& value(std::vector<double>& of, long w, long a) const {
        return of[static_cast<std::size_t>(w * (2 * most_a + 1) + a + most_a)];
    }
    double launch_jerk(bool ahead) const;
    bool keeps_limits(const Launch& launch, bool ahead) const;
    void from_rest(std::vector<double>& out, bool ahead);
    void step_back(std::size_t k);
};

Lattice::Lattice(const WholeWay& way, double step, double acceleration)
    : ds(step),
      da(acceleration),
      dw(0.5 * step * acceleration),
      launch_steps(static_cast<std::size_t>(std::lround(launch_way / step))) {
    double greatest_v = 0, greatest_a = 0;
    for (const PathPiece* piece : way.pieces) {
        const auto steps = std::lround(piece->curve.length / ds);
        for (long k = 0; k < steps; ++k) {
            const double part = piece->curve.length / static_cast<double>(steps);
            const double a = part * static_cast<double>(k), b = a + part;
            left.push_back({a, piece->curve.at(a), piece});
            right.push_back({b, piece->curve.at(b), piece});
            greatest_v = std::max(greatest_v, greatest_velocity(left.back()));
        }
        greatest_a = std::max(greatest_a, piece->limits.path.acceleration);
    }
    most_a = static_cast<long>(greatest_a / da);
    most_w = static_cast<long>(0.5 * greatest_v * greatest_v / dw);
    const auto size = static_cast<std::size_t>((most_w + 1) * (2 * most_a + 1));
    now.assign(size, infinite);
    next.assign(size, infinite);
    for (long w = 0; w <= most_w; ++w)
        velocities.push_back(std::sqrt(2 * dw * static_cast<double>(w)));
}

double Lattice::launch_jerk(bool ahead) const {
    double jerk = infinite;
    for (std::size_t k = 0; k < launch_steps; ++k) {
        const Place& at = ahead ? left[k] : right[right.size() - 1 - k];
        jerk = std::min(jerk, at.path().jerk);
        for (std::size_t i = 0; i < most_path_axes; ++i)
            if (at.x.tangent[i] != 0)
                jerk = std::min(jerk, at.axis(i).jerk / std::abs(at.x.tangent[i]));
    }
    return jerk;
}

/// At several instants.
bool Lattice::keeps_limits(const Launch& launch, bool ahead) const {
    constexpr int instants = 12;
    for (int i = 1; i <= instants; ++i) {
        const MotionState s = launch.at(launch.duration() * i / instants);
        const auto step = std::min(launch_steps - 1, static_cast<std::size_t>(s.position / ds));
        const std::size_t k = ahead ? step : left.size() - 1 - step;
        const double within = s.position - ds * static_cast<double>(step);
        const double part = ahead ? within : ds - within;
        Place at = left[k];
        at.x = at.piece->curve.at(at.s + part);
        const double sign = ahead ? 1 : -1;
        const Rows rows(at);
        if (s.velocity > greatest_velocity(at) ||
            !rows.keeps_acceleration(0.5 * s.velocity * s.velocity, sign * s.acceleration) ||
            !rows.keeps_jerk(s.velocity, sign * s.acceleration, s.jerk / s.velocity))
            return false;
    }
    return true;
}

/// How long the first steps take to each point, or the last ones from it.
void Lattice::from_rest(std::vector<double>& out, bool ahead) {
    const double J = launch_jerk(ahead), way = ds * static_cast<double>(launch_steps);
    const double alone = Sleef_cinz_cbrtd1_u10purec(4.5 * J * way * way);
    for (long w = 1; w <= most_w && velocity(w) <= alone; ++w)
        for (long a = 0; a <= most_a; ++a) {
            const Launch launch = launch_to(way, velocity(w), da * static_cast<double>(a), J);
            if (launch.duration() < infinite && keeps_limits(launch, ahead))
                value(out, w, ahead ? a : -a) = launch.duration();
        }
}

/// Over a way with v^2/2 = w at its ends and a quadratic between: Simpson's rule; infinite where
/// that comes down to 0.
double time_over(double ds, double w, double v, double a, double then, double v_then) {
    const double control = w + 0.5 * a * ds;
    if (!(control > 0)) return infinite;
    const double middle = std::sqrt(0.5 * (w + then) + control);
    return ds / 6 * (1 / v + 4 / middle + 1 / v_then);
}

/// The least time from the left of step k, from that of its right.
void Lattice::step_back(std::size_t k) {
    const Rows from(left[k]), to(right[k]);
    const auto most_of = [&](const Place& at) {
        const double v = greatest_velocity(at);
        return std::min(most_w, static_cast<long>(0.5 * v * v / dw * (1 + 1e-12)));
    };
    const long here = most_of(left[k]), there = most_of(right[k]);
    for (long w = 1; w <= here; ++w) {
        const double energy = dw * static_cast<double>(w), v = velocity(w);
        const long reach =
            std::min(2 * most_a, static_cast<long>(from.path.jerk / v * ds / da) + 1);
        for (long a = -most_a; a <= most_a; ++a) {
            const double rate = da * static_cast<double>(a);
            if (!from.keeps_acceleration(energy, rate)) continue;
            double best = infinite;
            const long first = std::max({-most_a, a - reach, 1 - w - a});
            const long last = std::min({most_a, a + reach, there - w - a});
            for (long b = first; b <= last; ++b) {
                const long u = w + a + b;
                const double rest = value(next, u, b);
                if (!(rest < best)) continue;
                const double time =
                    rest + time_over(ds, energy, v, rate, dw * static_cast<double>(u), velocity(u));
                const double slope = static_cast<double>(b - a) * da / ds;
                if (time < best && from.keeps_jerk(v, rate, slope) &&
                    to.keeps_jerk(velocity(u), da * static_cast<double>(b), slope))
                    best = time;
            }
            value(now, w, a) = best;
        }
    }
}

double Lattice::least() {
    const std::size_t steps = left.size();
    from_rest(next, false);
    for (std::size_t k = steps - launch_steps; k-- > launch_steps;) {
        std::fill(now.begin(), now.end(), infinite);
        step_back(k);
        std::swap(now, next);
    }
    std::fill(now.begin(), now.end(), infinite);
    from_rest(now, true);
    double best = infinite;
    for (std::size_t i = 0; i < now.size(); ++i) best = std::min(best, now[i] + next[i]);
    return best;
}

}  // namespace

double WholeWay::length() const {
    double sum = 0;
    for (const PathPiece* piece : pieces) sum += piece->curve.length;
    return sum;
}

std::vector<WholeWay> ways_between_stops(std::span<const PathPiece> ring, std::uint64_t pieces,
                                         std::uint64_t stretches) {
    std::vector<WholeWay> out(1);
    std::uint64_t stretch = 0;
    for (std::uint64_t k = 0; k < pieces; ++k) {
        out.back().pieces.push_back(&ring[k]);
        if (ring[k].end() < ring[stretch].stretch.end) continue;
        if (stretch + 1 < stretches && ring[stretch].stretch.joint == 0) out.emplace_back();
        ++stretch;
    }
    return out;
}

double least_without_jerk(const WholeWay& way, int places_per_piece) {
    std::vector<Place> places;
    double begin = 0;
    for (const PathPiece* piece : way.pieces) {
        for (int k = 0; k <= places_per_piece; ++k) {
            const double s = piece->curve.length * k / places_per_piece;
            places.push_back({begin + s, piece->curve.at(s), piece});
        }
        begin += piece->curve.length;
    }
    std::vector<double> most(places.size(), 0.0);
    const auto step_of = [&](std::size_t i) { return places[i + 1].s - places[i].s; };
    for (std::size_t i = places.size() - 1; i-- > 1;) {
        const double v = greatest_velocity(places[i]), ds = step_of(i);
        most[i] = greatest_that(0.5 * v * v, [&](double w) {
            double a = 0, b = 0;
            return range_of_acceleration(places[i], w, a, b) &&
                   w + std::max(a * ds, -w) <= most[i + 1];
        });
    }
    double w = 0, time = 0;
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        const double ds = step_of(i);
        double a = 0, b = 0;
        range_of_acceleration(places[i], w, a, b);
        const double then = ds > 0 ? std::min(most[i + 1], w + b * ds) : std::min(w, most[i + 1]);
        if (ds > 1e-12 * begin) time += 2 * ds / (std::sqrt(2 * w) + std::sqrt(2 * then));
        w = then;
    }
    return time;
}

double least_of_lattice(const WholeWay& way, double step, double acceleration) {
    return Lattice(way, step, acceleration).least();
}

}  // namespace lineshaft
