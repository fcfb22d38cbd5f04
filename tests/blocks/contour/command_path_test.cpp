#include "blocks/contour/command_path.hpp"

#include <cmath>

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("a straight path: exact to rounding, left is positive", "[contour]") {
    for (const double angle : {0.0, 0.7, 1.5707963267948966, 3.0, -2.0}) {
        const double c = std::cos(angle), s = std::sin(angle);
        CommandPath path;
        for (int i = 0; i < 100; ++i) path.add({0.025 * i * c, 0.025 * i * s});
        for (const double error : {0.3, -0.3, 1e-6, 0.0}) {
            const double along = 2.0111;
            const ContourEstimate e = path.estimate({along * c - error * s, along * s + error * c});
            CHECK(std::abs(e.signed_error - error) < 2e-15);
            CHECK(e.points_back == 19);
            CHECK(std::abs(e.normal.x + s) < 1e-13);
            CHECK(std::abs(e.normal.y - c) < 1e-13);
        }
    }
}

TEST_CASE("a circle: off by the square of the foot's way to the command point over 2 R",
          "[contour]") {
    const double R = 20, step = 0.1, inside = 0.05;
    CommandPath path;
    for (int i = 0; i < 200; ++i)
        path.add({R * std::cos(i * step / R), R * std::sin(i * step / R)});
    for (const double share : {0.0, 0.2, 0.45}) {
        const double s = share * step, angle = (15 + s) / R;
        const ContourEstimate e =
            path.estimate({(R - inside) * std::cos(angle), (R - inside) * std::sin(angle)});
        CHECK(e.points_back == 49);
        CHECK(e.signed_error - inside ==
              Approx((R - inside) / R * s * s / (2 * R)).epsilon(1e-5).margin(1e-13));
        CHECK(e.signed_error - inside <= step * step / (8 * R));
    }
}

TEST_CASE("at the newest point the last step is the tangent, at the first the first", "[contour]") {
    CommandPath path;
    for (const Point p : {Point{0, 0}, Point{1, 0}, Point{2, 1}}) path.add(p);
    const ContourEstimate newest = path.estimate({2, 3}), first = path.estimate({-0.4, 0.5});
    CHECK(newest.at_newest);
    CHECK(newest.is_ahead);
    CHECK_FALSE(path.estimate({1.5, 0.6}).is_ahead);
    CHECK(newest.points_back == 0);
    CHECK(newest.signed_error == Approx(2 * std::sqrt(0.5)));
    CHECK(first.points_back == 2);
    CHECK_FALSE(first.out_of_reach);
    CHECK(first.signed_error == Approx(0.5));
}

TEST_CASE("a command that stands adds no point and divides by no zero", "[contour]") {
    CommandPath path;
    CHECK(path.add({1, 1}));
    for (int i = 0; i < 1000; ++i) CHECK_FALSE(path.add({1, 1}));
    CHECK(path.size() == 1);
    const ContourEstimate alone = path.estimate({1, 3});
    CHECK(alone.signed_error == 2);
    CHECK(alone.is_ahead);
    CHECK_FALSE(path.estimate({1, 1}).is_ahead);
    CHECK(alone.normal.x == 0);
    CHECK(path.add({2, 1}));
    CHECK(path.estimate({1.9, 3}).signed_error == Approx(2));
}

TEST_CASE("a path that turns back on itself still has a tangent", "[contour]") {
    CommandPath path;
    for (const Point p : {Point{0, 0}, Point{1, 0}, Point{0, 0}}) path.add(p);
    CHECK(path.estimate({1.2, 0.25}).points_back == 1);
    CHECK(path.estimate({1.2, 0.25}).signed_error == Approx(0.25));
}

TEST_CASE("a nearest point that may have left the memory is told", "[contour]") {
    CommandPath path;
    for (int i = 0; i < 2 * CommandPath::capacity; ++i) path.add({1.0 * i, 0});
    const double oldest = static_cast<double>(CommandPath::capacity);
    CHECK_FALSE(path.estimate({oldest + 1, 1}).out_of_reach);
    CHECK(path.estimate({oldest + 0.4, 1}).out_of_reach);
    CHECK(path.estimate({0, 1}).out_of_reach);
}
