#include "blocks/contour/contour_error.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

ContourError ridden(int scans) {
    ContourError block;
    for (int i = 0; i < scans; ++i) {
        block.command_x = i;
        block.actual_x = i - 3.2;
        block.actual_y = -0.5;
        block.scan({});
    }
    return block;
}

}  // namespace

TEST_CASE("contour and following error of a straight ride", "[contour]") {
    const ContourError block = ridden(50);
    CHECK(block.contour_error == -0.5);
    CHECK(block.absolute_error == 0.5);
    CHECK(block.following_error == Approx(std::sqrt(3.2 * 3.2 + 0.25)));
    CHECK(block.points_back == 3);
    CHECK(block.normal_y == 1);
    CHECK_FALSE(block.error);
}

TEST_CASE("feedback that is no number sets error and keeps the last estimate", "[contour]") {
    for (const double bad : {not_a_number, infinite, -infinite}) {
        ContourError block = ridden(50);
        block.command_x = 50;
        block.actual_y = bad;
        block.scan({});
        CHECK(block.error_id == ContourError::Error::not_finite);
        CHECK(block.contour_error == -0.5);
        CHECK(block.points_back == 3);
        block.command_x = 51;
        block.actual_x = 47.8;
        block.actual_y = 0.25;
        block.scan({});
        CHECK_FALSE(block.error);
        CHECK(block.contour_error == 0.25);
    }
}

TEST_CASE("a command that is no number is not remembered", "[contour]") {
    ContourError block = ridden(50);
    block.command_x = not_a_number;
    block.scan({});
    CHECK(block.error);
    CHECK(block.path.size() == 50);
}

TEST_CASE("an estimate out of reach is held and told", "[contour]") {
    ContourError block = ridden(1000);
    block.actual_x = 10;
    block.scan({});
    CHECK(block.out_of_reach);
    CHECK_FALSE(block.error);
    CHECK(block.contour_error == -0.5);
    block.actual_x = 995;
    block.scan({});
    CHECK_FALSE(block.out_of_reach);
}
