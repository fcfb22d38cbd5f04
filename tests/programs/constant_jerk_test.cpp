#include "tests/programs/constant_jerk.hpp"

#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "runtime/model/random.hpp"

using namespace lineshaft;

namespace {

struct Course {
    std::vector<ConstantJerkSample<double>> samples;
    ConstantJerkKind kind = ConstantJerkKind::none;
    double distance = 0;
};

Course course(const ConstantJerkLimits<double>& limits, double distance,
              ConstantJerkPhases phases = ConstantJerkPhases::cut) {
    ConstantJerk<double> profile;
    REQUIRE(profile.begin(limits, distance, phases));
    Course result;
    result.kind = profile.kind();
    for (ConstantJerkSample<double> s; profile.next(s);) {
        result.samples.push_back(s);
        result.distance += s.distance;
    }
    return result;
}

constexpr ConstantJerkLimits<double> limits{1, 1, 1.5, 0.05};

}  // namespace

TEST_CASE("a full move takes its phases in whole samples and covers its distance") {
    const Course c = course(limits, 7.5);
    CHECK(c.kind == ConstantJerkKind::full);
    CHECK(c.samples.size() == 150);
    CHECK(c.distance == Approx(7.5).epsilon(1e-12));
    CHECK(c.samples[75].start_velocity == Approx(1.5).epsilon(1e-12));
}

TEST_CASE("a short move scales acceleration and jerk and still takes 4 t1") {
    for (const double distance : {0.01, 1.5, 2.0}) {
        const Course c = course(limits, distance);
        CHECK(c.kind == ConstantJerkKind::no_constant_acceleration);
        CHECK(c.samples.size() == 80);
        CHECK(c.distance == Approx(distance).epsilon(1e-12));
    }
}

TEST_CASE("without cruise a part of a sample is cut") {
    const Course c = course(limits, 3);
    CHECK(c.kind == ConstantJerkKind::no_cruise);
    CHECK(c.samples.size() == 92);
    CHECK(c.distance == Approx(2.99).epsilon(1e-12));
}

TEST_CASE("whole phases fill the distance with a sample of cruise in place of the part") {
    const Course c = course(limits, 3, ConstantJerkPhases::whole);
    CHECK(c.samples.size() == 93);
    CHECK(c.distance == Approx(3).epsilon(1e-14));
    CHECK(course(limits, 1.5, ConstantJerkPhases::whole).samples.size() == 80);
    CHECK(course(limits, 7.5, ConstantJerkPhases::whole).samples.size() == 150);
}

TEST_CASE("whole phases cover any distance within the limits, at most two samples late") {
    Random random(8, "whole phases");
    const auto pick = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random.next() % 10'000) / 10'000;
    };
    for (int i = 0; i < 5000; ++i) {
        const double T = pick(0.01, 0.1);
        const double samples = 1 + std::floor(pick(0, 30)), a = pick(0.1, 5);
        const double j = a / (samples * T * (i % 2 == 0 ? 1 : pick(0.5, 1)));
        const ConstantJerkLimits<double> any{a, j, pick(0.01, 10), T};
        const double distance = pick(0.001, 20);
        INFO("a " << a << ", j " << j << ", v " << any.velocity << ", T " << T << ", " << distance);
        const Course c = course(any, distance, ConstantJerkPhases::whole);
        REQUIRE(c.distance == Approx(distance).epsilon(1e-11));
        double acceleration = 0;
        for (const ConstantJerkSample<double>& s : c.samples) {
            REQUIRE(s.end_velocity <= any.velocity * (1 + 1e-9));
            const double mean = (s.end_velocity - s.start_velocity) / T;
            REQUIRE(std::abs(mean) <= a * (1 + 1e-9));
            REQUIRE(std::abs(mean - acceleration) <= j * T * (1 + 1e-9));
            acceleration = mean;
        }
        if (i % 2 != 0 || any.velocity < a * a / j) continue;
        const double t1 = a / j, t2 = any.velocity / a - t1;
        const double longest = any.velocity * (2 * t1 + t2);
        const double t2_short = (std::sqrt(t1 * t1 + 4 * distance / a) - 3 * t1) / 2;
        const double ideal = distance >= longest          ? t1 * 2 + t2 + distance / any.velocity
                             : distance > 2 * a * t1 * t1 ? 4 * t1 + 2 * t2_short
                                                          : 4 * t1;
        const double excess = static_cast<double>(c.samples.size()) - ideal / T;
        REQUIRE(excess > -1e-6);
        REQUIRE(excess < 2);
    }
}

TEST_CASE("velocity runs from rest to rest within its limits") {
    for (const double distance : {0.3, 2.4, 3.75, 20.0}) {
        const Course c = course(limits, distance);
        double v = 0;
        for (const ConstantJerkSample<double>& s : c.samples) {
            REQUIRE(s.start_velocity == v);
            REQUIRE(s.end_velocity <= 1.5 + 1e-12);
            REQUIRE(std::abs(s.end_velocity - v) <= 0.05 + 1e-12);
            v = s.end_velocity;
        }
        CHECK(std::abs(v) < 1e-12);
    }
}

TEST_CASE("a velocity that the acceleration overshoots lowers the acceleration") {
    const Course c = course({1, 1, 0.5, 0.05}, 4);
    CHECK(c.distance == Approx(4).epsilon(1e-12));
    for (const auto& s : c.samples) REQUIRE(s.end_velocity <= 0.5 + 1e-12);
}

TEST_CASE("a phase of too many samples is refused") {
    ConstantJerk<double> profile;
    CHECK_FALSE(profile.begin({1, 1, 1, 1e-9}, 1));
    ConstantJerkSample<double> sample;
    CHECK_FALSE(profile.next(sample));
    ConstantJerk<float> narrow;
    CHECK_FALSE(narrow.begin({1, 1e-38f, 3e38f, 1e-3f}, 1));
}
