#pragma once

#include <algorithm>
#include <cmath>

#include "blocks/profile/peak_equations.hpp"

namespace lineshaft {

/// What rounding took from a sum, exactly (Knuth).
inline double sum_error(double a, double b, double sum) {
    const double bb = sum - a;
    return (a - (sum - bb)) + (b - bb);
}

/// A number with twice the digits, for what is left of great terms that cancel.
struct Twice {
    double high, low = 0;

    static Twice sum(double a, double b, double low) {
        const double s = a + b;
        return {s, sum_error(a, b, s) + low};
    }
    static Twice product(double a, double b) {
        const double p = a * b;
        return {p, product_error(a, b, p)};
    }
    friend Twice operator+(Twice a, Twice b) { return sum(a.high, b.high, a.low + b.low); }
    friend Twice operator-(Twice a, Twice b) { return sum(a.high, -b.high, a.low - b.low); }
    friend Twice operator*(Twice a, Twice b) {
        const double p = a.high * b.high;
        return sum(p, product_error(a.high, b.high, p) + (a.high * b.low + a.low * b.high), 0);
    }
    friend Twice operator/(Twice a, double b) {
        const double q = a.high / b;
        return sum(q, (a - Twice{q} * Twice{b}).value() / b, 0);
    }
    friend Twice root(Twice a) {
        const double r = std::sqrt(std::max(a.value(), 0.0));
        return r > 0 ? sum(r, (a - Twice{r} * Twice{r}).value() / (2 * r), 0) : Twice{0};
    }
    double value() const { return high + low; }
};

}  // namespace lineshaft
