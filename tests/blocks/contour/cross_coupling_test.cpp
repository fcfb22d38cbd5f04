#include "blocks/contour/cross_coupling.hpp"

#include <catch2/catch.hpp>

#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

CrossCoupling coupling() {
    CrossCoupling block;
    block.gain = 2;
    block.command_x = 10;
    block.command_y = 20;
    block.contour_error = 0.1;
    block.normal_x = 0.6;
    block.normal_y = 0.8;
    return block;
}

}  // namespace

TEST_CASE("cross coupling moves the set-points against the error", "[contour]") {
    CrossCoupling block = coupling();
    block.scan({});
    CHECK(block.correction == Approx(0.2));
    CHECK(block.x == Approx(10 - 0.2 * 0.6));
    CHECK(block.y == Approx(20 - 0.2 * 0.8));
    block.enable = false;
    block.scan({});
    CHECK(block.correction == 0);
    CHECK(block.x == 10);
}

TEST_CASE("the integral grows by gain e h / Ti and stops at the limit", "[contour]") {
    CrossCoupling block = coupling();
    Clock clock;
    block.integral_time = 0.1;
    for (int i = 0; i < 300; ++i) clock.scan(block);
    CHECK(block.correction == Approx(0.2 + 0.2 * 300 * 1e-3 / 0.1));
    for (int i = 0; i < 10'000; ++i) clock.scan(block);
    CHECK(block.correction == 1);
    block.contour_error = -0.1;
    clock.scan(block);
    CHECK(block.correction < 1);
}

TEST_CASE("an error that is no number: no correction", "[contour]") {
    CrossCoupling block = coupling();
    block.scan({});
    block.contour_error = not_a_number;
    block.scan({});
    CHECK(block.error);
    CHECK(block.correction == 0);
    CHECK(block.x == 10);
    CHECK(block.y == 20);
}
