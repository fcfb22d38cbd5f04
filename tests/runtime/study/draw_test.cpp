#include "runtime/study/draw.hpp"

#include <cmath>
#include <set>
#include <variant>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

constexpr int count = 20'000;

RandomParameter parameter(Distribution distribution, double a, double b, const char* unit = "mm") {
    return {.name = "p",
            .distribution = distribution,
            .a = a,
            .b = b,
            .unit = Unit::parse(unit).value(),
            .choices = {},
            .mark = {}};
}

double number(const std::string& text) {
    return std::get<Quantity>(parse_quantity(text)).number;
}

struct Moments {
    double mean = 0, deviation = 0, least = 1e300, greatest = -1e300;
};

template <class Transform>
Moments moments(const RandomParameter& p, const Transform& transform) {
    Moments m;
    double squares = 0;
    for (int i = 0; i < count; ++i) {
        const double value = transform(number(draw(p, 1, i)));
        m.mean += value / count;
        squares += value * value / count;
        m.least = std::min(m.least, value);
        m.greatest = std::max(m.greatest, value);
    }
    m.deviation = std::sqrt(squares - m.mean * m.mean);
    return m;
}

Moments moments(const RandomParameter& p) {
    return moments(p, [](double value) { return value; });
}

}  // namespace

TEST_CASE("a draw depends on seed, name and index alone, and is the same on every machine") {
    RandomParameter p = parameter(Distribution::uniform, 5, 10, "mm/s");
    CHECK(draw(p, 1, 0) == draw(p, 1, 0));
    CHECK(draw(p, 1, 0) != draw(p, 1, 1));
    CHECK(draw(p, 1, 0) != draw(p, 2, 0));
    RandomParameter other = p;
    other.name = "q";
    CHECK(draw(p, 1, 0) != draw(other, 1, 0));
    CHECK(draw(p, 1, 0).ends_with(" mm/s"));
}

TEST_CASE("uniform draws fill their range evenly") {
    const Moments m = moments(parameter(Distribution::uniform, 5, 10));
    CHECK(m.least >= 5);
    CHECK(m.greatest <= 10);
    CHECK(m.mean == Approx(7.5).margin(5 * 5 / std::sqrt(12.0 * count)));
    CHECK(m.deviation == Approx(5 / std::sqrt(12.0)).epsilon(0.02));
}

TEST_CASE("the logarithm of a log-uniform draw is uniform") {
    const Moments m = moments(parameter(Distribution::log_uniform, 0.01, 100),
                              [](double value) { return std::log10(value); });
    CHECK(m.least >= -2);
    CHECK(m.greatest <= 2);
    CHECK(m.mean == Approx(0).margin(5 * 4 / std::sqrt(12.0 * count)));
    CHECK(m.deviation == Approx(4 / std::sqrt(12.0)).epsilon(0.02));
}

TEST_CASE("normal draws have their mean, deviation and shares within one and two deviations") {
    const RandomParameter p = parameter(Distribution::normal, -3, 2);
    const Moments m = moments(p);
    CHECK(m.mean == Approx(-3).margin(5 * 2 / std::sqrt(1.0 * count)));
    CHECK(m.deviation == Approx(2).epsilon(0.03));
    const auto share = [&](double deviations) {
        return moments(p, [&](double v) { return std::abs(v + 3) < 2 * deviations ? 1.0 : 0.0; })
            .mean;
    };
    CHECK(share(1) == Approx(0.6827).margin(0.017));
    CHECK(share(2) == Approx(0.9545).margin(0.008));
}

TEST_CASE("integers and choices come up equally often, limits included") {
    std::multiset<std::string> integers, choices;
    RandomParameter choice = parameter(Distribution::choice, 0, 0, "");
    choice.choices = {"early", "immediate", "ramp"};
    for (int i = 0; i < count; ++i) {
        integers.insert(draw(parameter(Distribution::integer, -1, 2, ""), 1, i));
        choices.insert(draw(choice, 1, i));
    }
    for (const char* value : {"-1", "0", "1", "2"})
        CHECK(static_cast<double>(integers.count(value)) == Approx(count / 4.0).margin(300));
    for (const std::string& value : choice.choices)
        CHECK(static_cast<double>(choices.count(value)) == Approx(count / 3.0).margin(340));
}

TEST_CASE("times are drawn in whole nanoseconds, other numbers with nine digits") {
    for (int i = 0; i < 1000; ++i) {
        const std::string text = draw(parameter(Distribution::uniform, 1, 2, "us"), 1, i);
        CHECK(to_nanoseconds(std::get<Quantity>(parse_quantity(text))).has_value());
        const std::string length = draw(parameter(Distribution::uniform, 1, 2), 1, i);
        CHECK(length.size() <= std::string("1.00000000 mm").size());
    }
}

TEST_CASE("probes are where a mistake would show") {
    using Texts = std::vector<std::string>;
    CHECK(probes(parameter(Distribution::uniform, 0.5, 10)) == Texts{"0.5 mm", "10 mm"});
    CHECK(probes(parameter(Distribution::integer, -1, 2, "")) == Texts{"-1", "2"});
    CHECK(probes(parameter(Distribution::normal, 20, 0.1)) == Texts{"20 mm"});
}
