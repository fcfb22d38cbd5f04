#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace lineshaft {

struct Range {
    double least = 0, greatest = 0;

    double size() const { return std::max(std::abs(least), std::abs(greatest)); }
};

/// c[0] + c[1] x + ... + c[N] x^N.
template <std::size_t N>
struct Polynomial {
    std::array<double, N + 1> c{};

    double at(double x) const {
        double y = c[N];
        for (std::size_t i = N; i-- > 0;) y = y * x + c[i];
        return y;
    }

    Polynomial<(N > 0 ? N - 1 : 0)> slope() const {
        Polynomial<(N > 0 ? N - 1 : 0)> s;
        for (std::size_t i = 1; i <= N; ++i) s.c[i - 1] = static_cast<double>(i) * c[i];
        return s;
    }
};

template <std::size_t N, std::size_t M>
Polynomial<N + M> operator*(const Polynomial<N>& a, const Polynomial<M>& b) {
    Polynomial<N + M> product;
    for (std::size_t i = 0; i <= N; ++i)
        for (std::size_t j = 0; j <= M; ++j) product.c[i + j] += a.c[i] * b.c[j];
    return product;
}

template <std::size_t N, std::size_t M>
Polynomial<std::max(N, M)> operator+(const Polynomial<N>& a, const Polynomial<M>& b) {
    Polynomial<std::max(N, M)> sum;
    for (std::size_t i = 0; i <= N; ++i) sum.c[i] += a.c[i];
    for (std::size_t i = 0; i <= M; ++i) sum.c[i] += b.c[i];
    return sum;
}

/// Where a polynomial changes its sign within an interval, in rising order.
template <std::size_t N>
struct Zeros {
    std::array<double, N> x{};
    std::size_t count = 0;
};

/// Between two neighbouring zeros of its slope a polynomial is monotonic: its own zeros are
/// bisected there, down to neighbouring numbers.
template <std::size_t N>
Zeros<N> zeros(const Polynomial<N>& p, double low, double high) {
    Zeros<N> found;
    const auto bisect = [&](double a, double b) {
        const bool rises = p.at(b) > 0;
        if ((p.at(a) > 0) == rises) return;
        for (double m = 0.5 * (a + b); m > a && m < b; m = 0.5 * (a + b))
            ((p.at(m) > 0) == rises ? b : a) = m;
        found.x[found.count++] = b;
    };
    double last = low;
    if constexpr (N > 1) {
        const auto turns = zeros(p.slope(), low, high);
        for (std::size_t i = 0; i < turns.count; ++i) {
            bisect(last, turns.x[i]);
            last = turns.x[i];
        }
    }
    bisect(last, high);
    return found;
}

/// What a polynomial comes to within an interval.
template <std::size_t N>
Range range(const Polynomial<N>& p, double low, double high) {
    Range r{std::min(p.at(low), p.at(high)), std::max(p.at(low), p.at(high))};
    if constexpr (N > 1) {
        const auto turns = zeros(p.slope(), low, high);
        for (std::size_t i = 0; i < turns.count; ++i) {
            const double y = p.at(turns.x[i]);
            r = {std::min(r.least, y), std::max(r.greatest, y)};
        }
    }
    return r;
}

}  // namespace lineshaft
