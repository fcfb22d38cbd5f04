#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lineshaft {

inline constexpr std::size_t most_path_axes = 6;

/// A point or a direction in the space of the axes [u]; axes that are not there are 0.
using PathVector = std::array<double, most_path_axes>;

/// The axes whose way is the length of a path; the others follow by time, in proportion to it.
inline constexpr std::size_t path_space = 3;

/// A curve at one length: x(s) and its derivatives by s.
struct PathPoint {
    PathVector position{};  ///< x [u]
    PathVector tangent{};   ///< x', of length 1 on lines and arcs, shorter in a corner
    PathVector bend{};      ///< x'' [1/u]
    PathVector twist{};     ///< x''' [1/u^2]
};

enum class PathCurveKind : std::int64_t { line, arc, corner, spline };

/// A piece of a path over its length s in 0..length, with phi = s / radius and t = s / length:
///
///     line    x = origin + s u
///     arc     x = origin + radius (u cos phi + w sin phi) + s slope
///     corner  x = origin + s u + length (t^3 - t^4/2) (w - u)
///     spline  x = origin + m u + m^2 w + m^3 slope + m^4 fourth + m^5 fifth,
///             m the polynomial of t with the coefficients `map`
///
/// An arc's u and w are of length 1 and stand upright on each other, and slope is of the axes that
/// follow. A corner leads from the direction u into the direction w; it begins and ends without
/// curvature, and has half its length before the vertex, half behind it.
struct PathCurve {
    PathCurveKind kind = PathCurveKind::line;
    double length = 0;    ///< > 0 [u]
    double radius = 0;    ///< of an arc [u]
    PathVector origin{};  ///< start of a line or a corner, centre of an arc [u]
    PathVector u{},
        w{};             ///< directions: of a line; from the centre to the start, and tangent there
    PathVector slope{};  ///< of an arc
    PathVector fourth{}, fifth{};  ///< of a spline
    std::array<double, 6> map{};   ///< of a spline
    PathVector end{};              ///< where it ends: exactly what was asked for [u]

    bool is_line_or_arc() const {
        return kind == PathCurveKind::line || kind == PathCurveKind::arc;
    }

    /// s beyond an end is taken as that end.
    PathPoint at(double s) const;

    /// An axis moves along it.
    bool moves(std::size_t axis) const;

    /// One of the first three axes moves.
    bool is_in_space() const;

    /// The way of the first three axes from its start on, 0 where none of them moves; with its
    /// derivatives by s.
    struct Way {
        double way = 0, slope = 0, bend = 0, twist = 0;
    };
    Way way_at(double s) const;

    /// The greatest size that axis i's part of the tangent can have, on any such curve of this
    /// plane: |u_i| of a line, sqrt(u_i^2 + w_i^2) of an arc, the greater of both of a corner; of a
    /// spline no less than that.
    double share(std::size_t axis) const;

    /// Between which positions axis i stays.
    struct Extent {
        double least = 0, greatest = 0;
    };
    Extent extent(std::size_t axis) const;

    /// A line or an arc loses so much at its end, or at its start.
    void cut_end(double by);
    void cut_start(double by);
};

enum class PathFault : std::int64_t {
    none,
    not_finite,  ///< a number is NaN or infinite, or a quotient is beyond a double
    no_length,   ///< start and end are one point
    no_arc,      ///< the three points lie on one line, or two are one, or the centre is not as far
    limit_not_positive,  ///< a limit is zero, negative or not finite
    not_joined,          ///< it does not begin where the piece before ends
    full,                ///< no room for one more piece
};

/// A line. Its length is the way of the first `counted` axes; where they do not move, that of all.
/// On a fault `out` is unchanged, here and below.
PathFault line_to(const PathVector& from, const PathVector& to, PathCurve& out,
                  std::size_t counted = most_path_axes);

/// The arc from `from` through `border` to `to`.
PathFault arc_through(const PathVector& from, const PathVector& border, const PathVector& to,
                      PathCurve& out);

/// The arc about `centre`, counter-clockwise to one who looks at it from the tip of `normal`; from
/// a point to itself the whole circle. In the first three axes, from and to exactly where they are.
/// What is given is rounded: the radii of both ends may differ by the greater of a thousandth of
/// them and `rounding` [u], that by a tenth of them at most. The centre is moved to where both
/// ends are equally far, and not further than a tenth of the radius.
PathFault arc_about(const PathVector& from, const PathVector& centre, const PathVector& to,
                    const PathVector& normal, double rounding, PathCurve& out);

/// The arc whose radius is the length of `normal`, counter-clockwise as above, and at most a half
/// of the circle. By as much as above the ends may be further apart than the circle is wide, which
/// is made wider, and the tip of `normal` may be beside the upright on them.
PathFault arc_of_radius(const PathVector& from, const PathVector& to, const PathVector& normal,
                        double rounding, PathCurve& out);

/// Stands upright on the plane of an arc about a centre and points up: to where the third axis
/// grows, or in a plane that is upright itself the second, or the first. Where the three points are
/// on one line it is the last of the axes in which they do not differ; 0 where there is none.
PathVector normal_upwards(const PathVector& from, const PathVector& centre, const PathVector& to);

/// Lets the axes behind the first three go from `from` to `to` along an arc.
void let_follow(PathCurve& arc, const PathVector& from, const PathVector& to);

/// The corner from one line into another that begins at its end, `distance` [u] before the vertex
/// and behind it. It is 3/16 distance |w - u| away from the vertex, no nearer and no further.
PathCurve corner_between(const PathCurve& before, const PathCurve& after, double distance);

/// The first three axes alone; the others are 0.
PathVector in_space(PathVector a);

/// How large the direction's change is in the first three axes: |w - u|, 0 to 2.
double bend_between(const PathCurve& before, const PathCurve& after);

}  // namespace lineshaft
