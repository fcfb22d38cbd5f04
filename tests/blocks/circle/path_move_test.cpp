#include "blocks/circle/path_move.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "blocks/inputs.hpp"
#include "runtime/model/random.hpp"
#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr double limit_v = 80, limit_a = 500, limit_j = 5000;

PathMove path(double length, double start_velocity = 0, double end_velocity = 0) {
    PathMove move;
    move.length = length;
    move.start_velocity = start_velocity;
    move.end_velocity = end_velocity;
    move.velocity_limit = limit_v;
    move.acceleration_limit = limit_a;
    move.jerk_limit = limit_j;
    move.execute = true;
    return move;
}

/// Scans until `done`, or too many times.
void finish(PathMove& move, Clock& clock) {
    for (int i = 0; i < 100'000 && !move.done; ++i) clock.scan(move);
    REQUIRE(move.done);
}

void check_within_limits(const PathMove& move) {
    REQUIRE(move.velocity >= 0);
    REQUIRE(move.velocity <= move.greatest_velocity * (1 + 4 * epsilon));
    REQUIRE(std::abs(move.acceleration) <= move.greatest_acceleration * (1 + 4 * epsilon));
    REQUIRE(std::abs(move.jerk) <= limit_j);
    REQUIRE(move.busy + move.done + move.error <= 1);
}

}  // namespace

TEST_CASE("a move along a path keeps its limits, jumps nowhere and ends exactly at its length") {
    for (const double length : {30.0, 0.31, 1e-9, 1e4}) {
        INFO("length " << length);
        PathMove move = path(length);
        Clock clock;
        clock.scan(move);
        CHECK(move.position == 0);
        while (move.busy) {
            check_within_limits(move);
            const double v = move.velocity, a = move.acceleration, x = move.position;
            clock.scan(move);
            REQUIRE(std::abs(move.acceleration - a) <= limit_j * 1e-3 * (1 + 1e-9));
            REQUIRE(std::abs(move.velocity - v) <= limit_a * 1e-3 * (1 + 1e-9));
            REQUIRE(move.position >= x);
            REQUIRE(move.position - x <= limit_v * 1e-3 * (1 + 1e-12) + epsilon * length);
        }
        CHECK(move.done);
        CHECK(seconds(clock.time() - clock.interval) >= move.duration);
        CHECK(move.position == length);
        CHECK(move.velocity == 0);
        CHECK(move.jerk == 0);
        CHECK(move.greatest_velocity <= limit_v);
        CHECK(move.greatest_acceleration <= limit_a);
        CHECK(move.displacement_error <= 4 * epsilon * length);
    }
}

TEST_CASE("after an end velocity the move goes on with it, from its length at its end") {
    PathMove move = path(40, 0, 30);
    Clock clock;
    finish(move, clock);
    for (int i = 0; i < 5000; ++i) {
        const double late = seconds(clock.time()) - move.duration;
        clock.scan(move);
        REQUIRE(move.velocity == 30);
        REQUIRE(move.acceleration == 0);
        REQUIRE(std::abs(move.position - (40 + 30 * late)) <= 4 * epsilon * 200);
    }
    CHECK(move.done);
}

TEST_CASE("a path too short for the end velocity is left at what can be reached") {
    PathMove move = path(2, 60);
    Clock clock;
    finish(move, clock);
    CHECK(move.kind == MoveKind::decelerate_triangular);
    CHECK(move.velocity > 0);
    CHECK(move.velocity < 60);
    CHECK(move.position > 2);
}

TEST_CASE(
    "each edge of execute begins at 0 with the inputs of then; done lasts one scan at least") {
    PathMove move = path(10);
    Clock clock;
    clock.scan(move);
    move.length = 20;
    move.execute = false;
    finish(move, clock);
    CHECK(move.position == 10);
    clock.scan(move);
    CHECK_FALSE(move.done);
    CHECK_FALSE(move.busy);
    move.execute = true;
    clock.scan(move);
    CHECK(move.position == 0);
    finish(move, clock);
    CHECK(move.position == 20);
    clock.scan(move);
    CHECK(move.done);
}

TEST_CASE("a move along a path that cannot be is refused until execute falls") {
    const auto refused = [](double PathMove::*input, double value) {
        PathMove move = path(10);
        move.*input = value;
        Clock clock;
        clock.scan(move);
        clock.scan(move);
        REQUIRE(move.error == (move.error_id != PathMoveError::none));
        CHECK(move.position == 0);
        const PathMoveError why = move.error_id;
        move.execute = false;
        move.*input = path(10).*input;
        clock.scan(move);
        CHECK_FALSE(move.error);
        return why;
    };
    CHECK(refused(&PathMove::length, -1) == PathMoveError::negative_length);
    CHECK(refused(&PathMove::velocity_limit, 0) == PathMoveError::limit_not_positive);
    CHECK(refused(&PathMove::jerk_limit, -1) == PathMoveError::limit_not_positive);
    CHECK(refused(&PathMove::end_velocity, 81) == PathMoveError::velocity_above_limit);
    CHECK(refused(&PathMove::start_velocity, 81) == PathMoveError::velocity_above_limit);
    CHECK(refused(&PathMove::length, not_a_number) == PathMoveError::not_finite);
    CHECK(refused(&PathMove::acceleration_limit, infinite) == PathMoveError::not_finite);
}

TEST_CASE("no input makes an output of a move along a path that is no number") {
    constexpr double values[] = {0,      1,     -1,       largest, -largest,     denormal,
                                 1e-300, 1e300, infinite, epsilon, not_a_number, 3};
    Random random(7, "path_move");
    const auto any = [&] { return values[random.next() % std::size(values)]; };
    for (int i = 0; i < 20'000; ++i) {
        PathMove move = path(any(), any(), any());
        move.velocity_limit = any();
        move.acceleration_limit = any();
        move.jerk_limit = any();
        Clock clock;
        for (int scan = 0; scan < 4; ++scan) {
            clock.scan(move);
            REQUIRE(all_finite(move.position, move.velocity, move.acceleration, move.jerk));
            REQUIRE(all_finite(move.duration, move.displacement_error, move.greatest_velocity));
        }
    }
}
