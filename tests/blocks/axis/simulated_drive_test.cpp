#include "blocks/axis/simulated_drive.hpp"

#include <catch2/catch.hpp>

#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

TEST_CASE("a simulated drive is where its set-point is") {
    SimulatedDrive drive;
    drive.set_position = 12.5;
    drive.set_velocity = -3;
    drive.scan({});
    CHECK(drive.position == 12.5);
    CHECK(drive.velocity == -3);
}

TEST_CASE("a simulated drive stays where it is while its set-point is no number") {
    SimulatedDrive drive;
    drive.set_position = 1;
    drive.scan({});
    for (const double bad : {not_a_number, infinite, -infinite}) {
        drive.set_position = bad;
        drive.set_velocity = 5;
        drive.scan({});
        CHECK(drive.position == 1);
        CHECK(drive.velocity == 0);
        drive.set_position = 2;
        drive.set_velocity = bad;
        drive.scan({});
        CHECK(drive.position == 1);
    }
    drive.set_velocity = 0;
    drive.scan({});
    CHECK(drive.position == 2);
}
