#include "blocks/axis/servo_drive.hpp"

#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

using Kind = VelocityLoop::Kind;

/// Scans until `clock.time()` is `duration` later, at a constant velocity of the set-point.
void ride(ServoDrive& drive, Clock& clock, double velocity, double duration) {
    const std::int64_t end = clock.index + std::llround(duration * 1e9) / clock.interval;
    drive.set_velocity = velocity;
    while (clock.index < end) {
        drive.set_position += velocity * seconds(clock.interval);
        clock.scan(drive);
    }
}

ServoDrive servo(double kv) {
    ServoDrive drive;
    drive.kv = kv;
    return drive;
}

ServoDrive first_order_servo(double kv, double T) {
    ServoDrive drive = servo(kv);
    drive.loop.kind = Kind::first_order;
    drive.loop.time_constant = T;
    return drive;
}

}  // namespace

TEST_CASE("a servo drive with nothing set is where its set-point is", "[servo]") {
    ServoDrive drive;
    drive.set_position = 12.5;
    drive.set_velocity = -3;
    drive.scan({});
    CHECK(drive.position == 12.5);
    CHECK(drive.table_position == 12.5);
    CHECK(drive.velocity == -3);
    CHECK(drive.following_error == 0);
}

TEST_CASE("a set-point arrives the delay later, to the clock", "[servo]") {
    for (const std::int64_t delay : {std::int64_t{1}, std::int64_t{7}, ServoDrive::longest_delay}) {
        ServoDrive drive;
        Clock clock;
        drive.delay = delay;
        clock.scan(drive);
        for (std::int64_t k = 1; k < 200; ++k) {
            drive.set_position = static_cast<double>(k);
            clock.scan(drive);
            CHECK(drive.position == static_cast<double>(std::max<std::int64_t>(0, k - delay)));
        }
    }
}

TEST_CASE("a position loop of gain kv leaves (1 - kv h)^n of a step", "[servo]") {
    ServoDrive drive = servo(50);
    Clock clock;
    clock.scan(drive);
    drive.set_position = 1;
    for (int n = 0; n <= 40; ++n) {
        clock.scan(drive);
        CHECK(drive.following_error == Approx(std::pow(1 - 50 * 1e-3, n)).epsilon(1e-12));
    }
}

TEST_CASE("a servo follows at ((1 - ff + d T) V + c T) / kv", "[servo]") {
    const double V = 100, kv = 50, T = 0.002;
    for (const double ff : {0.0, 0.85, 1.0}) {
        for (const double c : {0.0, 4000.0}) {
            for (const double d : {0.0, 30.0}) {
                ServoDrive drive = first_order_servo(kv, T);
                Clock clock;
                drive.velocity_feed_forward = ff;
                drive.loop.coulomb = c;
                drive.loop.viscous = d;
                clock.scan(drive);
                ride(drive, clock, V, 2);
                INFO("ff " << ff << ", c " << c << ", d " << d);
                CHECK(drive.following_error ==
                      Approx(((1 - ff + d * T) * V + c * T) / kv).margin(1e-10));
                CHECK(drive.velocity == Approx(V).epsilon(1e-12));
            }
        }
    }
}

TEST_CASE("a second-order servo follows at V / kv, friction or not", "[servo]") {
    for (const double c : {0.0, 4000.0}) {
        ServoDrive drive = servo(50);
        Clock clock;
        drive.loop = {.kind = Kind::second_order, .natural_frequency = 300, .coulomb = c};
        clock.scan(drive);
        ride(drive, clock, 100, 2);
        CHECK(drive.following_error == Approx(2).epsilon(1e-10));
    }
}

TEST_CASE("Coulomb friction leaves a reversal spike that a second-order loop works off",
          "[servo]") {
    std::vector<double> spikes;
    for (const double c : {0.0, 4000.0}) {
        ServoDrive drive = servo(50);
        Clock clock;
        drive.loop = {.kind = Kind::second_order, .natural_frequency = 300, .coulomb = c};
        clock.scan(drive);
        ride(drive, clock, 1, 1);
        double greatest = 0;
        for (int i = 0; i < 1000; ++i) {
            ride(drive, clock, -1, 1e-3);
            greatest = std::max(greatest, std::abs(drive.following_error));
        }
        spikes.push_back(greatest);
        CHECK(drive.following_error == Approx(-0.02).epsilon(1e-6));
    }
    CHECK(spikes[0] < 0.0205);  // V / kv, sampled
    CHECK(spikes[1] > 2 * spikes[0]);
}

TEST_CASE("friction holds an axis at rest within c T / kv", "[servo]") {
    for (const double share : {0.99, 1.01}) {
        ServoDrive drive = first_order_servo(50, 0.002);
        Clock clock;
        drive.loop.coulomb = 4000;
        clock.scan(drive);
        drive.set_position = share * 4000 * 0.002 / 50;
        for (int i = 0; i < 2000; ++i) clock.scan(drive);
        CHECK((drive.position == 0) == (share < 1));
    }
}

TEST_CASE("a motor's encoder does not see the backlash, the table's does", "[servo]") {
    ServoDrive drive;
    Clock clock;
    drive.transmission.backlash = 0.5;
    clock.scan(drive);
    drive.set_position = 10;
    clock.scan(drive);
    CHECK(drive.position == 10);
    CHECK(drive.table_position == 9.75);
    drive.encoder = ServoDrive::Encoder::table;
    clock.scan(drive);
    CHECK(drive.position == 9.75);
}

TEST_CASE("a reversal of the axis deviates the table by k exp(-t / T), at any speed", "[servo]") {
    for (const double speed : {5.0, 50.0}) {
        ServoDrive drive;
        Clock clock;
        drive.transmission.breakaway_windup = 0.22;
        drive.transmission.breakaway_time = 1.4;
        clock.scan(drive);
        ride(drive, clock, speed, 20);
        ride(drive, clock, -speed, 0.7);
        CHECK(drive.table_position - drive.motor_position ==
              Approx(0.22 * std::exp(-0.5)).epsilon(1e-5));
        drive.set_position = drive.motor_position;
        ride(drive, clock, 0, 0.7);
        CHECK(drive.table_position - drive.motor_position ==
              Approx(0.22 * std::exp(-1.0)).epsilon(1e-5));
    }
}

TEST_CASE("homing sets the actual position and moves nothing", "[servo]") {
    for (const bool simulated : {true, false}) {
        ServoDrive drive;
        Clock clock;
        if (!simulated) drive.transmission.windup = 0.015;
        drive.encoder = ServoDrive::Encoder::table;
        clock.scan(drive);
        ride(drive, clock, 10, 2);
        const double motor = drive.motor_position;
        CHECK(motor == drive.set_position);
        CHECK(drive.position == (simulated ? motor : motor - 0.015));
        drive.home = true;
        drive.home_position = 20;
        clock.scan(drive);
        CHECK(drive.position == 20);
        CHECK(drive.motor_position == motor);
        ride(drive, clock, 10, 1);
        CHECK(drive.position == Approx(30).epsilon(1e-12));
        drive.home_position = 7;  // no edge
        ride(drive, clock, 10, 1);
        CHECK(drive.position == Approx(40).epsilon(1e-12));
    }
}

TEST_CASE("a position loop homed with its set-point stays where it is", "[servo]") {
    ServoDrive drive = servo(50);
    Clock clock;
    clock.scan(drive);
    ride(drive, clock, 10, 2);
    ride(drive, clock, 0, 5);
    const double motor = drive.motor_position;
    drive.home = true;
    drive.home_position = drive.set_position = 0;
    clock.scan(drive);
    for (int i = 0; i < 100; ++i) clock.scan(drive);
    CHECK(drive.position == 0);
    CHECK(drive.motor_position == motor);
}

TEST_CASE("integral action makes up friction: the following error decays to 0", "[servo]") {
    ServoDrive drive = first_order_servo(20, 0.002);
    Clock clock;
    drive.integral_time = 0.5;
    drive.velocity_feed_forward = 1;
    drive.loop.coulomb = 1500;
    clock.scan(drive);
    ride(drive, clock, 10, 10);
    CHECK(std::abs(drive.following_error) < 1e-6);
    ride(drive, clock, -10, 0.2);
    CHECK(drive.following_error < -0.1);
    ride(drive, clock, -10, 10);
    CHECK(std::abs(drive.following_error) < 1e-6);
}

TEST_CASE("an encoder reads whole steps", "[servo]") {
    ServoDrive drive;
    drive.resolution = 0.25;
    for (const auto& [position, reading] :
         {std::pair{0.12, 0.0}, {0.13, 0.25}, {-0.13, -0.25}, {7.0, 7.0}}) {
        drive.set_position = position;
        drive.scan({});
        CHECK(drive.position == reading);
        CHECK(drive.motor_position == position);
    }
}

TEST_CASE("noise is normal with its standard deviation, one sequence a seed", "[servo]") {
    ServoDrive a, b, other;
    for (ServoDrive* drive : {&a, &b, &other}) drive->noise = 0.01;
    a.seed = b.seed = 5;
    other.seed = 6;
    const int count = 100'000;
    double sum = 0, squares = 0;
    int within = 0, equal = 0;
    for (int i = 0; i < count; ++i) {
        for (ServoDrive* drive : {&a, &b, &other}) drive->scan({});
        REQUIRE(a.position == b.position);
        equal += a.position == other.position ? 1 : 0;
        sum += a.position;
        squares += a.position * a.position;
        within += std::abs(a.position) < 0.01 ? 1 : 0;
    }
    CHECK(equal == 0);
    CHECK(std::abs(sum / count) < 4 * 0.01 / std::sqrt(count));
    CHECK(std::sqrt(squares / count) == Approx(0.01).epsilon(4 / std::sqrt(2.0 * count)));
    CHECK(static_cast<double>(within) / count == Approx(0.6827).margin(0.006));
}

TEST_CASE("settings that contradict each other are an error", "[servo]") {
    ServoDrive drifting = first_order_servo(0, 0.01), stiff = servo(50);
    ServoDrive untimed = first_order_servo(50, 0);
    stiff.loop.coulomb = 1;
    drifting.scan({});
    stiff.scan({});
    untimed.scan({});
    ServoDrive integrating;
    integrating.integral_time = 1;
    integrating.scan({});
    CHECK(integrating.error_id == ServoError::no_position_loop);
    CHECK(drifting.error_id == ServoError::no_position_loop);
    CHECK(stiff.error_id == ServoError::no_velocity_loop);
    CHECK(untimed.error_id == ServoError::no_time_constant);
}

TEST_CASE("a drive holds while its set-point is no number, and goes on from there", "[servo]") {
    ServoDrive drive = servo(50);
    Clock clock;
    drive.set_position = 1;
    clock.scan(drive);
    drive.set_position = infinite;
    clock.scan(drive);
    CHECK(drive.error);
    CHECK(drive.position == 1);
    drive.set_position = 2;
    clock.scan(drive);
    CHECK_FALSE(drive.error);
    CHECK(drive.position == 1);
    clock.scan(drive);
    CHECK(drive.position == Approx(1.05));
}

TEST_CASE("a drive without a position loop tells the velocity that its positions make") {
    ServoDrive plain, delayed;
    delayed.delay = 2;
    Clock clock;
    for (int i = 0; i < 10; ++i) {
        plain.set_position = delayed.set_position = 0.02 * i;
        const Scan now{clock.time(), clock.interval, clock.index++};
        plain.scan(now);
        delayed.scan(now);
    }
    CHECK(plain.velocity == Approx(20));
    CHECK(delayed.velocity == Approx(20));
    CHECK(delayed.position == Approx(0.14));
    plain.set_velocity = 7;
    plain.scan({clock.time(), clock.interval, clock.index});
    CHECK(plain.velocity == 7);
}
