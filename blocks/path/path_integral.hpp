#pragma once

#include <cstddef>

namespace lineshaft {

/// The integral of f over 0..end, by Gauss' rule of five places in each of some parts.
template <int parts = 8, class Function>
double integral_until(double end, const Function& f) {
    constexpr double places[] = {0.0, 0.5384693101056831, 0.9061798459386640};
    constexpr double weights[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
    double sum = 0;
    for (int part = 0; part < parts; ++part) {
        const double middle = end * (part + 0.5) / parts, half = 0.5 * end / parts;
        sum += weights[0] * f(middle);
        for (std::size_t k = 1; k < 3; ++k)
            sum += weights[k] * (f(middle - half * places[k]) + f(middle + half * places[k]));
    }
    return sum * 0.5 * end / parts;
}

}  // namespace lineshaft
