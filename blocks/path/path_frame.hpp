#pragma once

#include <array>

#include "blocks/path/path_curve.hpp"

namespace lineshaft {

/// Where a coordinate system stands in another one: turned about its own axes, then moved. Of the
/// first three axes; the others are the same in both.
struct PathFrame {
    using Rows = std::array<std::array<double, path_space>, path_space>;

    std::array<double, path_space> shift{};        ///< of its origin [u]
    Rows turn{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< columns: its axes

    /// Turned about z, then about the y that has been turned, then about the x of both,
    /// right-handed (DIN 9300: yaw, pitch, roll) [deg]. Quarters of a turn are exact.
    static PathFrame of(const std::array<double, path_space>& shift,
                        const std::array<double, path_space>& about_x_y_z);

    /// From this system to the other one, and back.
    PathVector place(const PathVector& point) const;
    PathVector direction(const PathVector& vector) const;
    PathCurve curve(const PathCurve& curve) const;
    PathFrame inverse() const;

    bool operator==(const PathFrame&) const = default;
};

}  // namespace lineshaft
