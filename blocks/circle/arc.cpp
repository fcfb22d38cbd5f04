#include "blocks/circle/arc.hpp"

#include <sleef.h>

namespace lineshaft {

Point Arc::at(double theta, double rho) const {
    const double phi = start + direction * theta;
    return {rho * Sleef_cinz_sind1_u10purec(phi), rho * Sleef_cinz_cosd1_u10purec(phi)};
}

Point Arc::slope(double theta) const {
    const Point p = at(theta);
    return {direction * p.y, -direction * p.x};
}

}  // namespace lineshaft
