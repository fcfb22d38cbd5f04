#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lineshaft {

inline constexpr std::size_t most_path_axes = 6;

/// A point or a direction in the space of the axes [u]; axes that are not there are 0.
using PathVector = std::array<double, most_path_axes>;

/// A curve at one length: x(s) and its derivatives by s.
struct PathPoint {
    PathVector position{};  ///< x [u]
    PathVector tangent{};   ///< x', of length 1
    PathVector bend{};      ///< x'' [1/u]
    PathVector twist{};     ///< x''' [1/u^2]
};

enum class PathCurveKind : std::int64_t { line, arc };

/// A piece of a path over its length s in 0..length, with phi = s / radius:
///
///     line    x = origin + s u
///     arc     x = origin + radius (u cos phi + w sin phi)
///
/// u and w are of length 1 and stand upright on each other.
struct PathCurve {
    PathCurveKind kind = PathCurveKind::line;
    double length = 0;    ///< > 0 [u]
    double radius = 0;    ///< of an arc [u]
    PathVector origin{};  ///< start of a line, centre of an arc [u]
    PathVector u{}, w{};  ///< direction of a line; from the centre to the start, and tangent there
    PathVector end{};     ///< where it ends: exactly what was asked for [u]

    /// s beyond an end is taken as that end.
    PathPoint at(double s) const;

    /// The greatest size that axis i's part of the tangent can have, on any such curve of this
    /// plane: |u_i| of a line, sqrt(u_i^2 + w_i^2) of an arc.
    double share(std::size_t axis) const;
};

enum class PathFault : std::int64_t {
    none,
    not_finite,          ///< a number is NaN or infinite, or a quotient is beyond a double
    no_length,           ///< start and end are one point
    no_arc,              ///< the three points lie on one line, or the centre is not equally far
    limit_not_positive,  ///< a limit is zero, negative or not finite
    not_joined,          ///< it does not begin where the piece before ends
    full,                ///< no room for one more piece
};

/// A line. On a fault `out` is unchanged, here and below.
PathFault line_to(const PathVector& from, const PathVector& to, PathCurve& out);

/// The arc from `from` through `border` to `to`.
PathFault arc_through(const PathVector& from, const PathVector& border, const PathVector& to,
                      PathCurve& out);

/// The arc about `centre`, the shorter way or the longer one. The radius at the end may be off by
/// 1e-6 of it: the centre is moved to where both ends are equally far. The half of a circle has no
/// plane and is no_arc.
PathFault arc_about(const PathVector& from, const PathVector& centre, const PathVector& to,
                    bool longer, PathCurve& out);

}  // namespace lineshaft
