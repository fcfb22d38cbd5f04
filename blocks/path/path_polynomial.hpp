#pragma once

#include <array>
#include <cstddef>

namespace lineshaft {

/// Its degree is five at most; the coefficient of t^k stands in place k.
using PathPolynomial = std::array<double, 6>;

inline PathPolynomial derivative_of(const PathPolynomial& p) {
    PathPolynomial out{};
    for (std::size_t k = 1; k < p.size(); ++k) out[k - 1] = static_cast<double>(k) * p[k];
    return out;
}

inline double value_of(const PathPolynomial& p, double t) {
    double sum = 0;
    for (std::size_t k = p.size(); k-- > 0;) sum = sum * t + p[k];
    return sum;
}

}  // namespace lineshaft
