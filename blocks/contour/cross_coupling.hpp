#pragma once

#include <span>

#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Cross-coupled controller of two axes (Koren 1980): moves the set-points of both against the
/// contour error e, along the path's normal n (to the left, where e is above 0), so that the axes
/// correct it together whatever their lags are:
///
///     w = gain e + integral,   integral += gain e h / integral_time,   |w| <= limit
///     x = command_x - w n_x,   y likewise
///
/// With axes that pass a slow correction on as it is, an error e0 becomes e0 / (1 + gain); the
/// integral takes the rest. It stops where w is at its limit (anti-windup). With `enable` false or
/// an input that is no number the correction is 0 and the integral is forgotten; the set-points
/// are held while the command is no number.
struct CrossCoupling {
    enum class Error : std::int64_t {
        none,
        not_finite,  ///< an input is NaN or infinite, or the set-point would be
    };

    double gain = 0, integral_time = 0, limit = 1;

    bool enable = true;
    double command_x = 0, command_y = 0;
    double contour_error = 0, normal_x = 0, normal_y = 0;

    double x = 0, y = 0, correction = 0;
    bool error = false;
    Error error_id = Error::none;

    double integral = 0;  ///< [mm]

    static constexpr std::string_view type = "cross_coupling";
    static constexpr std::string_view doc =
        "cross-coupled controller: corrects the contour error of two axes";
    static std::span<const Field> fields();
    void scan(const Scan& now);

  private:
    void control(double interval);
};

}  // namespace lineshaft
