#include "blocks/circle/path_circle.hpp"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "blocks/circle/path_move.hpp"
#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

using std::numbers::pi;

PathCircle circle(double radius) {
    PathCircle path;
    path.radius = radius;
    return path;
}

void scan_at(PathCircle& path, double length, double velocity = 0, double acceleration = 0) {
    path.length = length;
    path.path_velocity = velocity;
    path.path_acceleration = acceleration;
    path.scan({});
    REQUIRE_FALSE(path.error);
}

}  // namespace

TEST_CASE("a path circle starts at its start angle and runs in its direction") {
    PathCircle path = circle(20);
    scan_at(path, 0, 10);
    CHECK(path.x == 0);
    CHECK(path.y == 20);
    CHECK(path.velocity_x == 10);
    CHECK(path.velocity_y == 0);
    path.turn = PathCircle::Turn::counter_clockwise;
    scan_at(path, 0, 10);
    CHECK(path.velocity_x == -10);
    path.start_angle = pi / 2;
    path.centre_x = 5;
    path.centre_y = -7;
    scan_at(path, 0, 10);
    CHECK(path.x == Approx(25));
    CHECK(path.y == Approx(-7));
    CHECK(path.velocity_y == Approx(10));
}

TEST_CASE("a path circle closes exactly to the rounding of its angle") {
    for (const double radius : {0.5, 20.0, 60.0, 1e4}) {
        for (const auto turn : {PathCircle::Turn::clockwise, PathCircle::Turn::counter_clockwise}) {
            PathCircle path = circle(radius);
            path.turn = turn;
            path.centre_y = -radius;
            scan_at(path, 0);
            CHECK(path.x == 0);
            CHECK(path.y == 0);
            scan_at(path, 2 * pi * radius);
            CHECK(std::abs(path.x) <= 8 * epsilon * radius);
            CHECK(path.y == 0);
        }
    }
}

TEST_CASE("every point of a path circle is on it, and its velocity along it") {
    for (const auto turn : {PathCircle::Turn::clockwise, PathCircle::Turn::counter_clockwise}) {
        PathCircle path = circle(60);
        path.turn = turn;
        path.start_angle = 0.4;
        for (int i = -200; i <= 400; ++i) {
            scan_at(path, 2.7 * i, 200);
            REQUIRE(std::abs(std::hypot(path.x, path.y) - 60) <= 8 * epsilon * 60);
            REQUIRE(std::abs(std::hypot(path.velocity_x, path.velocity_y) - 200) <=
                    8 * epsilon * 200);
            REQUIRE(std::abs(path.x * path.velocity_x + path.y * path.velocity_y) <=
                    16 * epsilon * 60 * 200);
            REQUIRE(std::hypot(path.acceleration_x, path.acceleration_y) ==
                    Approx(200.0 * 200 / 60));
        }
    }
}

TEST_CASE("velocities and accelerations are the derivatives of the positions") {
    constexpr double h = 1e-4, v = 30, a = 70;
    const auto length = [](double t) { return t * (v + t * a / 2); };
    for (const auto turn : {PathCircle::Turn::clockwise, PathCircle::Turn::counter_clockwise}) {
        PathCircle path = circle(25);
        path.turn = turn;
        path.start_angle = 1;
        for (double t = 0; t < 3; t += 0.1) {
            PathCircle before = path, after = path;
            scan_at(before, length(t - h));
            scan_at(after, length(t + h));
            scan_at(path, length(t), v + a * t, a);
            REQUIRE((after.x - before.x) / (2 * h) == Approx(path.velocity_x).margin(1e-3));
            REQUIRE((after.y - before.y) / (2 * h) == Approx(path.velocity_y).margin(1e-3));
            REQUIRE((after.x - 2 * path.x + before.x) / (h * h) ==
                    Approx(path.acceleration_x).margin(1e-2));
            REQUIRE((after.y - 2 * path.y + before.y) / (h * h) ==
                    Approx(path.acceleration_y).margin(1e-2));
        }
    }
}

TEST_CASE("along a seven-segment move the axes' velocities and accelerations are continuous") {
    PathMove move;
    move.length = 120 * pi;
    move.velocity_limit = 200;
    move.acceleration_limit = 500;
    move.jerk_limit = 2000;
    move.execute = true;
    PathCircle path = circle(60);
    path.centre_y = -60;
    Clock clock;
    clock.scan(move);
    scan_at(path, move.position, move.velocity, move.acceleration);
    constexpr double dt = 1e-3;
    // d/dt of a t - v^2/R n: the jerk, 3 v a / R and v^3 / R^2 at most
    constexpr double most_jerk = 2000 + 3 * 200 * 500 / 60.0 + 200 * 200 * 200 / 3600.0;
    while (move.busy) {
        const PathCircle last = path;
        clock.scan(move);
        scan_at(path, move.position, move.velocity, move.acceleration);
        for (const auto member : {&PathCircle::velocity_x, &PathCircle::velocity_y})
            REQUIRE(std::abs(path.*member - last.*member) <= 800 * dt);
        for (const auto member : {&PathCircle::acceleration_x, &PathCircle::acceleration_y})
            REQUIRE(std::abs(path.*member - last.*member) <= most_jerk * dt);
    }
    REQUIRE(move.done);
    CHECK(std::abs(path.x) <= 1e-13);
    CHECK(path.y == 0);
}

TEST_CASE("an input of a path circle that is no number holds its outputs") {
    using Input = double PathCircle::*;
    for (const Input input :
         {&PathCircle::length, &PathCircle::path_velocity, &PathCircle::path_acceleration}) {
        for (const double bad : {not_a_number, infinite, -infinite}) {
            PathCircle path = circle(20);
            scan_at(path, 3, 10, 1);
            const double x = path.x, velocity_y = path.velocity_y, a = path.acceleration_x;
            path.*input = bad;
            path.scan({});
            CHECK(path.error);
            CHECK(path.error_id == PathCircle::Error::not_finite);
            CHECK(path.x == x);
            CHECK(path.velocity_y == velocity_y);
            CHECK(path.acceleration_x == a);
            scan_at(path, 4, 10, 1);
            CHECK(path.x != x);
        }
    }
}

TEST_CASE("extreme but finite inputs of a path circle are followed or refused") {
    const double extremes[] = {1e300, -1e300, largest, -largest, denormal, -denormal, -0.0, 1};
    for (const double radius : {1e300, largest, denormal, 1e-300, 1.0}) {
        for (const double length : extremes) {
            for (const double velocity : extremes) {
                PathCircle path = circle(radius);
                path.length = length;
                path.path_velocity = velocity;
                path.path_acceleration = -velocity;
                path.scan({});
                REQUIRE(std::isfinite(path.x));
                REQUIRE(std::isfinite(path.y));
                REQUIRE(std::isfinite(path.velocity_x));
                REQUIRE(std::isfinite(path.velocity_y));
                REQUIRE(std::isfinite(path.acceleration_x));
                REQUIRE(std::isfinite(path.acceleration_y));
            }
        }
    }
}
