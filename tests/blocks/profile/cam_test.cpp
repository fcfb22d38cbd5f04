#include "blocks/profile/cam.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/blocks/profile/oracle.hpp"

using namespace lineshaft;
using oracle::Random;

namespace {

constexpr double open = NAN;

struct Made {
    std::vector<CamPoint> points;
    Cam cam;

    explicit Made(std::vector<CamPoint> given, bool periodic = false) : points(std::move(given)) {
        REQUIRE(complete_cam(points, periodic).fault == CamFault::none);
        cam = {points, periodic};
    }
};

CamPoint point(double x, double y, CamCurve curve, double slope = open, double bend = open) {
    return {x, y, slope, bend, curve};
}

CamProblem problem_of(std::vector<CamPoint> points) {
    return complete_cam(points, false);
}

}  // namespace

TEST_CASE("a cam goes through its points with the velocities and accelerations given") {
    using enum CamCurve;
    const Made m({point(0, 0, quintic, 0, 0), point(90, 20, quintic, 0.5, -0.01),
                  point(180, 50, cubic, 0.25, 0), point(270, 40, linear), point(360, 0, linear)});
    CHECK(m.cam.at(0).y == 0);
    CHECK(m.cam.at(90).y == 20);
    CHECK(m.cam.at(90).slope == Approx(0.5));
    CHECK(m.cam.at(90).bend == Approx(-0.01));
    const CurvePoint before = m.cam.at(std::nextafter(90, 0));
    CHECK(before.slope == Approx(0.5));
    CHECK(before.bend == Approx(-0.01));
    CHECK(m.cam.at(180).slope == Approx(0.25));
    CHECK(m.cam.at(std::nextafter(270, 0)).slope == Approx(-40.0 / 90));
    CHECK(m.cam.at(300).y == Approx(40 - 40.0 / 3));
    CHECK(m.cam.at(300).bend == 0);
}

TEST_CASE("a cam that is not periodic stands beyond its ends") {
    const Made m({point(10, 1, CamCurve::cubic), point(20, 3, CamCurve::cubic)});
    CHECK(m.cam.at(9).y == 1);
    CHECK(m.cam.at(9).slope == 0);
    CHECK(m.cam.at(25).y == 3);
    CHECK(m.cam.periods(25) == 1);
    CHECK(m.cam.periods(15) == 0);
    CHECK(m.cam.periods(5) == -1);
}

TEST_CASE("velocities that are not given are those of a spline: without a jump of acceleration") {
    Random random{3};
    for (const bool periodic : {false, true}) {
        std::vector<CamPoint> points;
        for (double x = 0; points.size() < 12; x += random.decades(-1, 1))
            points.push_back(point(x, random.between(-5, 5), CamCurve::cubic));
        if (periodic) points.back().y = points.front().y + 7;
        const Made m(points, periodic);
        for (std::size_t i = 1; i + 1 < points.size(); ++i) {
            const double x = points[i].x;
            const CurvePoint before = m.cam.at(std::nextafter(x, -1)), after = m.cam.at(x);
            CHECK(after.y == points[i].y);
            CHECK(before.slope == Approx(after.slope).margin(1e-9));
            CHECK(before.bend == Approx(after.bend).margin(1e-9));
        }
        const CurvePoint first = m.cam.at(points.front().x);
        const CurvePoint last = m.cam.at(std::nextafter(points.back().x, 0));
        if (periodic) {
            CHECK(first.slope == Approx(last.slope).margin(1e-9));
            CHECK(first.bend == Approx(last.bend).margin(1e-9));
            const CurvePoint later = m.cam.at(points.front().x + 5 * m.cam.length());
            CHECK(later.y == Approx(points.front().y + 35));
        } else {
            CHECK(std::abs(first.bend) <= 1e-9);
            CHECK(std::abs(last.bend) <= 1e-9);
        }
    }
}

TEST_CASE("a cam of many points follows the function that they are of") {
    std::vector<CamPoint> points;
    for (int i = 0; i <= 360; ++i)
        points.push_back(point(i, std::sin(i * M_PI / 180), CamCurve::quintic));
    const Made m(points, true);
    double most = 0;
    for (double x = 0; x < 720; x += 0.37)
        most = std::max(most, std::abs(m.cam.at(x).y - std::sin(x * M_PI / 180)));
    CHECK(most < 1e-9);
}

TEST_CASE("a cam whose master does not rise is refused at the point where it does not") {
    using enum CamCurve;
    CHECK(problem_of({point(0, 0, cubic)}).fault == CamFault::too_few_points);
    const CamProblem falls =
        problem_of({point(0, 0, cubic), point(5, 1, cubic), point(5, 2, cubic)});
    CHECK(falls.fault == CamFault::not_monotonic);
    CHECK(falls.point == 2);
    const CamProblem nan = problem_of({point(0, 0, cubic), point(1, NAN, cubic)});
    CHECK(nan.fault == CamFault::not_finite);
    CHECK(nan.point == 1);
}

TEST_CASE("a cam and its area stay between what is seen of them") {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        Random random{seed};
        std::vector<CamPoint> points;
        for (int i = 0; i < 6; ++i)
            points.push_back(point(10 * i, random.between(-50, 50), CamCurve::quintic));
        const Made m(points);
        const double scale = random.between(-2, 2), offset = random.between(-20, 20);
        Range values{m.cam.at(0).y, m.cam.at(0).y}, areas;
        for (int i = 0; i < 50'000; ++i) {
            const double x = i * 1e-3, y = m.cam.at(x).y;
            const double area = scale * m.cam.area(x) + offset * x;
            values = {std::min(values.least, y), std::max(values.greatest, y)};
            areas = {std::min(areas.least, area), std::max(areas.greatest, area)};
        }
        INFO("seed " << seed);
        CHECK(m.cam.values().least == Approx(values.least).margin(0.05));
        CHECK(m.cam.values().greatest == Approx(values.greatest).margin(0.05));
        CHECK(m.cam.areas(scale, offset).least == Approx(areas.least).margin(0.2));
        CHECK(m.cam.areas(scale, offset).greatest == Approx(areas.greatest).margin(0.2));
    }
}
