#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "blocks/profile/seven_segment.hpp"

/// The equations of Liu 2023 as they stand in the paper, root formulas included, for a move whose
/// kind is known: an independent witness of the planner's times. They lose digits where the planner
/// does not, see seven_segment.hpp.
namespace lineshaft::closed_form {

/// Greater root of a x^2 + b x + c.
inline double quadratic(double a, double b, double c) {
    return (-b + std::sqrt(std::max(0.0, b * b - 4 * a * c))) / (2 * a);
}

struct Roots {
    std::array<double, 4> x{};
    int count = 0;

    void add(double root) { x[static_cast<std::size_t>(count++)] = root; }
    double least_positive() const {
        double least = HUGE_VAL;
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
            if (x[i] > 0) least = std::min(least, x[i]);
        return least;
    }
    double greatest() const { return *std::max_element(x.begin(), x.begin() + count); }
};

/// Real roots of a x^3 + b x^2 + c x + d by Shengjin's formulas.
inline Roots cubic(double a, double b, double c, double d) {
    const double A = b * b - 3 * a * c;
    const double B = b * c - 9 * a * d;
    const double C = c * c - 3 * b * d;
    const double discriminant = B * B - 4 * A * C;
    Roots roots;
    if (A == 0 && B == 0) {
        roots.add(-b / (3 * a));
    } else if (discriminant > 0) {
        const double root = std::sqrt(discriminant);
        const double y1 = A * b + 1.5 * a * (-B + root);
        const double y2 = A * b + 1.5 * a * (-B - root);
        roots.add((-b - std::cbrt(y1) - std::cbrt(y2)) / (3 * a));
    } else if (discriminant == 0) {
        roots.add(-b / a + B / A);
        roots.add(-B / A / 2);
    } else {
        const double t = (2 * A * b - 3 * a * B) / (2 * A * std::sqrt(A));
        const double angle = std::acos(std::clamp(t, -1.0, 1.0)) / 3;
        const double cosine = std::cos(angle);
        const double sine = std::sqrt(3) * std::sin(angle);
        roots.add((-b - 2 * std::sqrt(A) * cosine) / (3 * a));
        roots.add((-b + std::sqrt(A) * (cosine + sine)) / (3 * a));
        roots.add((-b + std::sqrt(A) * (cosine - sine)) / (3 * a));
    }
    return roots;
}

/// Greatest real root of x^4 + a x^3 + b x^2 + c x + d by Ferrari's formula.
inline double quartic(double a, double b, double c, double d) {
    const double p = b - 0.375 * a * a;
    const double q = c - 0.5 * a * b + 0.125 * a * a * a;
    const double r = d - 0.25 * a * c + a * a * b / 16 - 3 * a * a * a * a / 256;
    const double m = std::max(0.0, cubic(8, 8 * p, 2 * p * p - 8 * r, -q * q).greatest());
    const double root = std::sqrt(2 * m);
    double greatest = -HUGE_VAL;
    for (const double sign : {1.0, -1.0}) {
        const double square = -(2 * p + 2 * m + sign * 2 * q / root);
        if (square >= 0) greatest = std::max(greatest, 0.5 * (sign * root + std::sqrt(square)));
    }
    return greatest - 0.25 * a;
}

/// (12) to (15)
inline void one_ramp(const SevenSegment& p, int equation, std::array<double, 7>& T) {
    const double A = p.A, J = p.J, L = p.L, V = p.Vs, tm = A / J;
    switch (equation) {
        case 1:
            T[0] = T[2] = tm;
            T[1] = quadratic(A / 2, V + 1.5 * A * tm, tm * (2 * V + A * tm) - L);
            break;
        case 2:
            T[0] = T[2] = cubic(J, 0, 2 * V, -L).greatest();
            break;
        case 3:
            T[4] = T[6] = tm;
            T[5] = -quadratic(A / 2, V - 1.5 * A * tm, L - tm * (2 * V - A * tm));
            break;
        default:
            T[4] = T[6] = cubic(J, 0, -2 * V, L).least_positive();
    }
}

/// (16) to (19)
inline void cruise(const SevenSegment& p, std::array<double, 7>& T) {
    const double c = p.A * p.A / p.J, tm = p.A / p.J;
    const double up = p.Vm - p.Vs, down = p.Vm - p.Ve;
    T[0] = T[2] = up > c ? tm : std::sqrt(up / p.J);
    T[1] = up > c ? up / p.A - tm : 0;
    T[4] = T[6] = down > c ? tm : std::sqrt(down / p.J);
    T[5] = down > c ? down / p.A - tm : 0;
    const double ramps =
        0.5 * ((p.Vs + p.Vm) * (T[0] + T[1] + T[2]) + (p.Vm + p.Ve) * (T[4] + T[5] + T[6]));
    T[3] = (p.L - ramps) / p.Vm;
}

/// (21), (23), (30): the ramp at the slower end has jerk time `slow`, the other one `fast`.
inline void peak(const SevenSegment& p, int equation, std::array<double, 7>& T) {
    const double A = p.A, J = p.J, L = p.L, tm = A / J, c = A * tm;
    const double lo = std::min(p.Vs, p.Ve), hi = std::max(p.Vs, p.Ve), D = hi - lo;
    double fast = tm, fast_hold = 0, slow = tm, slow_hold = 0;
    if (equation == 9) {
        fast_hold = quadratic(A, 2 * hi + 3 * c,
                              2 * c * tm + 3 * hi * tm + (lo + hi) * (tm + D / A) / 2 - L);
        slow_hold = fast_hold + D / A;
    } else if (equation == 10) {
        const double k = J * J / (2 * A);
        fast = quartic(J / k, J * (2 * hi + c) / (2 * A) / k, 2 * hi / k,
                       ((lo + hi) * (D + c) / (2 * A) - L) / k);
        slow_hold = (D + J * fast * fast) / A - tm;
    } else {
        const double sum = quartic(0, 4 * (lo + hi) / J, -4 * L / J, -D * D / (J * J));
        slow = 0.5 * (sum + D / (J * sum));
        fast = 0.5 * (sum - D / (J * sum));
    }
    const std::size_t first = p.Ve >= p.Vs ? 0 : 4;
    const std::size_t second = 4 - first;
    T[first] = T[first + 2] = slow;
    T[first + 1] = slow_hold;
    T[second] = T[second + 2] = fast;
    T[second + 1] = fast_hold;
}

inline std::array<double, 7> times(const SevenSegment& p, MoveKind kind) {
    std::array<double, 7> T{};
    const int number = equation(kind);
    if (number <= 4)
        one_ramp(p, number, T);
    else if (number <= 8)
        cruise(p, T);
    else
        peak(p, number, T);
    return T;
}

}  // namespace lineshaft::closed_form
