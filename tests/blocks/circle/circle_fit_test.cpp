#include "blocks/circle/circle_fit.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

using std::numbers::pi;

struct Sample {
    double x, y;
};

std::vector<Sample> circle(double x, double y, double radius, double sweep, int n) {
    std::vector<Sample> samples;
    for (int i = 0; i < n; ++i) {
        const double phi = sweep * i / n;
        samples.push_back({x + radius * std::sin(phi), y + radius * std::cos(phi)});
    }
    return samples;
}

void feed(CircleFit& fit, const std::vector<Sample>& samples) {
    fit.enable = true;
    for (const Sample& s : samples) {
        fit.x = s.x;
        fit.y = s.y;
        fit.scan({});
    }
}

void stop(CircleFit& fit) {
    fit.enable = false;
    fit.scan({});
}

}  // namespace

TEST_CASE("a fit finds the centre and radius of an exact circle") {
    CircleFit fit;
    fit.radius = 20;
    feed(fit, circle(0.3, -0.2, 20.1, 2 * pi, 1000));
    // Sums of 1000 terms of size 1, in radii; the normal matrix of a full circle is near 1/2.
    const double tolerance = 1000 * epsilon * 20;
    CHECK(std::abs(fit.centre_x - 0.3) <= tolerance);
    CHECK(std::abs(fit.centre_y + 0.2) <= tolerance);
    CHECK(std::abs(fit.offset - std::hypot(0.3, 0.2)) <= tolerance);
    CHECK(std::abs(fit.fitted_radius - 20.1) <= tolerance);
    CHECK(fit.samples == 1000);
}

TEST_CASE("centre and offset are relative to the wanted centre") {
    CircleFit fit;
    fit.radius = 5;
    fit.x0 = 100;
    fit.y0 = -40;
    feed(fit, circle(100.03, -40.04, 5, 2 * pi, 360));
    CHECK(fit.centre_x == Approx(100.03).epsilon(1e-13));
    CHECK(fit.centre_y == Approx(-40.04).epsilon(1e-13));
    CHECK(fit.offset == Approx(0.05).epsilon(1e-9));
}

TEST_CASE("an arc of 30 degrees is enough for its centre") {
    CircleFit fit;
    fit.radius = 20;
    feed(fit, circle(0.1, 0.2, 20, pi / 6, 2000));
    // The arc's height is 1.7 % of its radius, so the normal matrix' condition is near 1e6.
    CHECK(std::abs(fit.centre_x - 0.1) <= 1e-8);
    CHECK(std::abs(fit.centre_y - 0.2) <= 1e-8);
    CHECK(std::abs(fit.fitted_radius - 20) <= 1e-8);
}

TEST_CASE("mean, largest and worst deviation are those of the samples") {
    CircleFit fit;
    fit.radius = 10;
    feed(fit, {{0, 10.5}, {9.75, 0}, {0, -10}, {-10.125, 0}});
    CHECK(fit.mean_deviation == Approx((0.5 + 0.25 + 0 + 0.125) / 4).epsilon(1e-14));
    CHECK(fit.largest_deviation == Approx(0.5).epsilon(1e-14));
    CHECK(fit.worst_x == 0);
    CHECK(fit.worst_y == 10.5);
    CHECK(fit.worst_x_share == 0);
}

TEST_CASE("before three samples that span a circle the wanted centre stands") {
    CircleFit fit;
    fit.radius = 10;
    fit.x0 = 1;
    fit.y0 = 2;
    for (const auto& samples : {std::vector<Sample>{{4, 9}}, std::vector<Sample>{{4, 9}, {6, -3}},
                                std::vector<Sample>{{0, 0}, {1, 1}, {2, 2}, {5, 5}}}) {
        stop(fit);
        feed(fit, samples);
        INFO(samples.size() << " samples");
        CHECK(fit.centre_x == 1);
        CHECK(fit.centre_y == 2);
        CHECK(fit.offset == 0);
        CHECK(fit.fitted_radius == 10);
    }
    stop(fit);
    feed(fit, {{11, 2}, {1, 12}, {-9, 2}});
    CHECK(fit.centre_x == Approx(1));
    CHECK(fit.centre_y == Approx(2));
}

TEST_CASE("samples of a standing axis make no centre") {
    CircleFit fit;
    fit.radius = 20;
    feed(fit, std::vector<Sample>(1'000'000, Sample{6.1, 19.1}));
    CHECK(fit.centre_x == 0);
    CHECK(fit.centre_y == 0);
    CHECK(fit.offset == 0);
    CHECK(fit.closing_gap == 0);
}

TEST_CASE("the closing gap counts to where the path ended") {
    CircleFit fit;
    fit.radius = 10;
    feed(fit, {{0, 10}, {10, 0}, {0, -10}, {-10, 0}});
    fit.x = 0.3;
    fit.y = 10.4;
    stop(fit);
    CHECK(fit.closing_gap == Approx(0.5));
    fit.x = 7;
    fit.scan({});
    CHECK(fit.closing_gap == Approx(0.5));
    CHECK(fit.samples == 4);
}

TEST_CASE("a rising edge of enable begins anew") {
    CircleFit fit;
    fit.radius = 20;
    feed(fit, circle(1, 1, 21, 2 * pi, 100));
    stop(fit);
    CHECK(fit.samples == 100);
    feed(fit, circle(-0.5, 0, 20, 2 * pi, 48));
    CHECK(fit.samples == 48);
    CHECK(fit.centre_x == Approx(-0.5));
    CHECK(std::abs(fit.centre_y) <= 1e-12);
    CHECK(fit.largest_deviation == Approx(0.5));
}

TEST_CASE("a fit that began anew knows nothing of the worst sample before") {
    CircleFit fit;
    fit.radius = 10;
    feed(fit, {{0, 11}, {10, 0}});
    stop(fit);
    feed(fit, {{10, 0}});
    CHECK(fit.largest_deviation == 0);
    CHECK(fit.worst_x == 10);
    CHECK(fit.worst_y == 0);
}

TEST_CASE("a sample that is no number is left out") {
    CircleFit fit, without;
    fit.radius = without.radius = 20;
    auto samples = circle(0.1, 0.2, 20, 2 * pi, 100);
    feed(without, samples);
    samples.insert(samples.begin() + 50, {not_a_number, 1});
    samples.insert(samples.begin() + 20, {1, -infinite});
    samples.insert(samples.begin() + 10, {1e300, largest});
    feed(fit, samples);
    CHECK(fit.samples == 100);
    CHECK(fit.centre_x == without.centre_x);
    CHECK(fit.centre_y == without.centre_y);
    CHECK(fit.mean_deviation == without.mean_deviation);
    CHECK(fit.largest_deviation == without.largest_deviation);
}

TEST_CASE("a rising edge with a sample that is no number begins anew with the next one") {
    CircleFit fit;
    fit.radius = 20;
    feed(fit, circle(1, 1, 21, 2 * pi, 100));
    stop(fit);
    feed(fit, {{not_a_number, 0}, {0, 20}, {20, 0}});
    CHECK(fit.samples == 2);
    CHECK(fit.mean_deviation == 0);
}
