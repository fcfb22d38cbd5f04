#include "blocks/profile/seven_segment.hpp"

#include <array>
#include <cstdlib>
#include <functional>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/blocks/profile/closed_form.hpp"
#include "tests/blocks/profile/oracle.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::oracle;

namespace {

/// The plan's times run in quadruple precision: the error is the plan's, not the evaluator's.
struct Run {
    Quad position = 0, velocity = 0, acceleration = 0;
    Quad greatest_velocity = 0, least_velocity = 0, greatest_acceleration = 0;
};

Run run(const SevenSegment& p, const SevenSegmentPlan& out) {
    constexpr std::array<int, 7> sign = {1, 0, -1, 0, -1, 0, 1};
    Run r;
    r.velocity = r.greatest_velocity = r.least_velocity = p.Vs;
    for (std::size_t i = 0; i < 7; ++i) {
        const Quad T = out.T[i];
        const Quad j = sign[i] * Quad(p.J);
        r.position += T * (r.velocity + T * (r.acceleration / 2 + T * j / 6));
        r.velocity += T * (r.acceleration + T * j / 2);
        r.acceleration += T * j;
        r.greatest_velocity = std::max(r.greatest_velocity, r.velocity);
        r.least_velocity = std::min(r.least_velocity, r.velocity);
        r.greatest_acceleration =
            std::max({r.greatest_acceleration, r.acceleration, -r.acceleration});
    }
    return r;
}

double in_ulp(Quad error, double of) {
    const double size = std::abs(static_cast<double>(error));
    return size == 0 ? 0 : size / ulp(of);
}

std::string brief(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", x);
    return text;
}

/// Figures of many plans; the first few that break a bar are printed.
struct Figures {
    std::vector<float> length_errors;  ///< [ulp of L]
    double end_velocity = 0;           ///< greatest error [ulp of Vm]
    double duration = 0;               ///< greatest relative distance from the optimum
    double limits = 0;                 ///< greatest relative excess over Vm, A
    std::array<long, move_kinds> seen{};
    int failures = 0;

    void fail(const SevenSegment& p, const std::string& why) {
        if (++failures <= 10) print_failure(why, line(p));
    }

    double percentile(double share) {
        if (length_errors.empty()) return 0;
        const auto n = static_cast<double>(length_errors.size() - 1);
        const auto middle = length_errors.begin() + static_cast<long>(share * n);
        std::nth_element(length_errors.begin(), middle, length_errors.end());
        return *middle;
    }
};

void check_states(const SevenSegment& p, const SevenSegmentPlan& out, Figures& figures) {
    for (std::size_t i = 0; i < 7; ++i) {
        if (!(out.T[i] >= 0)) figures.fail(p, "negative time");
        if (!(out.start[i].velocity >= 0)) figures.fail(p, "negative velocity");
        if (!(out.start[i].velocity <= p.Vm * (1 + 1e-12))) figures.fail(p, "start above Vm");
        if (!(std::abs(out.start[i].acceleration) <= p.A * (1 + 1e-12)))
            figures.fail(p, "start above A");
    }
    if (out.end.position != p.L) figures.fail(p, "end position is not L");
    if (out.reaches_Ve && out.end.velocity != p.Ve) figures.fail(p, "end velocity is not Ve");
    const bool alone = equation(out.kind) <= 4;
    if (!out.reaches_Ve && !alone) figures.fail(p, "Ve not reached");
}

void check_run(const SevenSegment& p, const SevenSegmentPlan& out, Figures& figures) {
    const Run r = run(p, out);
    const double length = in_ulp(r.position - p.L, p.L);
    const double velocity = in_ulp(r.velocity - out.end.velocity, p.Vm);
    const double over = std::max({static_cast<double>(r.greatest_velocity / p.Vm - 1),
                                  static_cast<double>(-r.least_velocity / p.Vm),
                                  static_cast<double>(r.greatest_acceleration / p.A - 1)});
    figures.length_errors.push_back(static_cast<float>(length));
    figures.end_velocity = std::max(figures.end_velocity, velocity);
    figures.limits = std::max(figures.limits, over);
    if (!(length <= 16)) figures.fail(p, "length off by " + brief(length) + " ulp");
    if (!(velocity <= 4)) figures.fail(p, "end velocity off by " + brief(velocity) + " ulp");
    if (!(over <= 1e-12)) figures.fail(p, "limit exceeded");
    if (!(r.acceleration <= 1e-12 * p.A && r.acceleration >= -1e-12 * p.A))
        figures.fail(p, "acceleration left at the end");
}

void check_optimum(const SevenSegment& p, const SevenSegmentPlan& out, Figures& figures) {
    const Quad critical = L1(p);
    const Quad grain = 4 * Quad(std::numeric_limits<double>::epsilon()) * critical;
    if (out.reaches_Ve ? p.L < critical - grain : p.L > critical + grain)
        return figures.fail(p, "reaches_Ve is wrong");
    const Optimum best = optimum(p, out.reaches_Ve);
    Quad duration = 0;
    for (const double T : out.T) duration += T;
    const double off = best.duration == 0 ? static_cast<double>(duration)
                                          : static_cast<double>(duration / best.duration - 1);
    figures.duration = std::max(figures.duration, std::abs(off));
    if (!(std::abs(off) <= 1e-12)) figures.fail(p, "duration off by " + brief(off));
    if (!(std::abs(out.duration - static_cast<double>(duration)) <= 4 * ulp(out.duration)))
        figures.fail(p, "duration is not the sum of the times");
}

void check(const SevenSegment& p, Figures& figures) {
    SevenSegmentPlan out;
    if (plan(p, out) != PlanResult::ok) return figures.fail(p, "not planned");
    if (p.L < 1e-100) {
        if (out.duration != 0 || out.end.velocity != p.Vs) figures.fail(p, "moves without length");
        return;
    }
    ++figures.seen[static_cast<std::size_t>(out.kind)];
    check_states(p, out, figures);
    check_run(p, out, figures);
    check_optimum(p, out, figures);
}

void report(const std::string& title, Figures& figures) {
    CHECK(figures.failures == 0);
    const double p99 = figures.percentile(0.99);
    CHECK(p99 <= 4);
    if (std::getenv("LINESHAFT_FIGURES") == nullptr) return;
    std::printf(
        "%-44s %8zu plans, length p99 %5.2f max %5.2f ulp, end velocity %4.2f ulp, "
        "limits %7.1e, duration %7.1e\n",
        title.c_str(), figures.length_errors.size(), p99, figures.percentile(1),
        figures.end_velocity, figures.limits, figures.duration);
}

/// Problems over decades of every quantity, in mm or in m.
SevenSegment random_limits(Random& random) {
    SevenSegment p;
    p.A = random.decades(-2, 5);
    p.J = p.A / random.decades(-4, 2);
    p.Vm = p.A * p.A / p.J * random.decades(-4, 4);
    return p;
}

double random_velocity(Random& random, double Vm) {
    switch (random.next() % 6) {
        case 0:
            return 0;
        case 1:
            return Vm;
        case 2:
            return Vm * random.decades(-8, 0);
        case 3:
            return Vm * (1 - random.decades(-12, 0));
        default:
            return Vm * random.unit();
    }
}

SevenSegment in_metres(SevenSegment p, bool metres) {
    if (metres)
        for (double* quantity : {&p.Vs, &p.Ve, &p.Vm, &p.A, &p.J, &p.L}) *quantity *= 1e-3;
    return p;
}

SevenSegment random_problem(Random& random) {
    SevenSegment p = random_limits(random);
    p.Vs = random_velocity(random, p.Vm);
    p.Ve = random.one_in(6) ? p.Vs : random_velocity(random, p.Vm);
    const auto first = static_cast<double>(L1(p));
    const auto second = static_cast<double>(L2(p));
    if (second == 0) p.L = p.Vm * p.A / p.J * random.decades(-6, 6);
    switch (second == 0 ? 6 : first == 0 ? 2 + random.next() % 4 : random.next() % 6) {
        case 0:
            p.L = first * random.unit();
            break;
        case 1:
            p.L = first * random.decades(-6, 0);
            break;
        case 2:
            p.L = random.between(first, second);
            break;
        case 3:
            p.L = first + (second - first) * random.decades(-12, 0);
            break;
        case 4:
            p.L = second * (1 + random.decades(-6, 6));
            break;
        case 5:
            p.L = second * random.decades(-6, 3);
            break;
        default:
            break;
    }
    return in_metres(p, random.one_in(2));
}

constexpr double up(double x) {
    return std::nextafter(x, HUGE_VAL);
}
constexpr double down(double x) {
    return std::nextafter(x, 0.0);
}

/// x, or one or two representable numbers beside it.
double beside(Random& random, double x) {
    const std::array<double, 5> near = {x, up(x), down(x), up(up(x)), down(down(x))};
    return near[random.next() % 5];
}

double c_of(const SevenSegment& p) {
    return p.A * p.A / p.J;
}

/// Random limits and velocities with Vm well above A^2/J.
SevenSegment fast_problem(Random& random) {
    SevenSegment p = random_limits(random);
    p.Vm = c_of(p) * (3 + random.decades(-2, 3));
    p.Vs = random_velocity(random, p.Vm - 2 * c_of(p));
    p.Ve = random_velocity(random, p.Vm - 2 * c_of(p));
    return p;
}

using Make = std::function<SevenSegment(Random&)>;

SevenSegment any(Random& random) {
    return random_problem(random);
}

SevenSegment unequal(Random& random) {
    SevenSegment p = random_problem(random);
    while (p.Vs == p.Ve) p = random_problem(random);
    return p;
}

SevenSegment with_length(SevenSegment p, Quad L) {
    p.L = static_cast<double>(L);
    return p;
}

/// A deceleration from above A^2/J or below it whose length is not monotone down to Ve.
SevenSegment far_deceleration(Random& random) {
    SevenSegment p = random_limits(random);
    const double c = c_of(p);
    const bool trapezoidal = random.one_in(2);
    p.Vs = trapezoidal ? c * (1.5 + random.decades(-6, 3)) : c * 1.5 * random.decades(-5, 0);
    p.Ve = (trapezoidal ? c / 2 : p.Vs / 3) * (random.one_in(4) ? 0 : random.unit());
    p.Vm = p.Vs * (random.one_in(2) ? 1 : 1 + random.unit());
    return p;
}

/// Greatest length of a deceleration from Vs.
Quad turning_length(const SevenSegment& p) {
    const Quad c = Quad(p.A) * p.A / p.J;
    const Quad V = p.Vs;
    return ramp(V, V > Quad(1.5) * c ? c / 2 : V / 3, p).length;
}

struct Family {
    const char* name;
    Make make;
};

const std::vector<Family>& families() {
    static const std::vector<Family> list = {
        {"L = L1",
         [](Random& r) {
             const auto p = unequal(r);
             return with_length(p, L1(p));
         }},
        {"L = L1, one ulp above",
         [](Random& r) {
             auto p = unequal(r);
             p.L = up(static_cast<double>(L1(p)));
             return p;
         }},
        {"L beside L1",
         [](Random& r) {
             auto p = unequal(r);
             p.L = beside(r, static_cast<double>(L1(p)));
             return p;
         }},
        {"L = L2",
         [](Random& r) {
             const auto p = any(r);
             return with_length(p, L2(p));
         }},
        {"L beside L2",
         [](Random& r) {
             auto p = any(r);
             p.L = beside(r, static_cast<double>(L2(p)));
             return p;
         }},
        {"T2 = T6 = 0",
         [](Random& r) {
             auto p = fast_problem(r);
             p.Ve = p.Vs;
             return with_length(p, length_over(Quad(p.Vs) + Quad(p.A) * p.A / p.J, p));
         }},
        {"border of equations 9 and 10",
         [](Random& r) {
             auto p = fast_problem(r);
             p.L = beside(
                 r, static_cast<double>(length_over(Quad(std::max(p.Vs, p.Ve)) + c_of(p), p)));
             return p;
         }},
        {"border of equations 10 and 11",
         [](Random& r) {
             auto p = fast_problem(r);
             p.Ve = std::min(p.Vm, p.Vs + c_of(p) * r.unit());
             if (r.one_in(2)) std::swap(p.Vs, p.Ve);
             p.L = beside(
                 r, static_cast<double>(length_over(Quad(std::min(p.Vs, p.Ve)) + c_of(p), p)));
             return p;
         }},
        {"border of equations 1 and 2",
         [](Random& r) {
             auto p = fast_problem(r);
             p.Vs = random_velocity(r, p.Vm - 2 * c_of(p));
             p.Ve = p.Vm;
             p.L = beside(r, static_cast<double>(ramp(p.Vs, Quad(p.Vs) + c_of(p), p).length));
             return p;
         }},
        {"border of equations 3 and 4",
         [](Random& r) {
             auto p = fast_problem(r);
             p.Vs = c_of(p) * (1.5 + r.decades(-3, 3));
             p.Vm = p.Vs * (1 + r.unit());
             p.Ve = r.one_in(2) ? 0 : c_of(p) * 0.5 * r.unit();
             p.L = beside(r, static_cast<double>(ramp(p.Vs, Quad(p.Vs) - c_of(p), p).length));
             return p;
         }},
        {"Vs = Ve = Vm",
         [](Random& r) {
             auto p = any(r);
             p.Vs = p.Ve = p.Vm;
             return p;
         }},
        {"Vs = Ve, tiny L",
         [](Random& r) {
             auto p = any(r);
             p.Ve = p.Vs;
             p.L = p.Vm * p.A / p.J * r.decades(-30, -6);
             return p;
         }},
        {"max(Vs, Ve) = Vm",
         [](Random& r) {
             auto p = any(r);
             (r.one_in(2) ? p.Vs : p.Ve) = p.Vm;
             return with_length(
                 p, r.one_in(2) ? L1(p) * Quad(1.5) : L1(p) + (L2(p) - L1(p)) * r.unit());
         }},
        {"Vs and Ve beside Vm",
         [](Random& r) {
             auto p = any(r);
             p.Vs = std::min(p.Vm, beside(r, p.Vm));
             p.Ve = std::min(p.Vm, beside(r, p.Vm));
             p.L *= r.unit();
             return p;
         }},
        {"Vs beside Ve",
         [](Random& r) {
             auto p = any(r);
             p.Ve = std::min(p.Vm, beside(r, p.Vs));
             p.L *= r.unit();
             return p;
         }},
        {"Vs = 0",
         [](Random& r) {
             auto p = any(r);
             p.Vs = 0;
             return p;
         }},
        {"Ve = 0",
         [](Random& r) {
             auto p = any(r);
             p.Ve = 0;
             return p;
         }},
        {"Vs = Ve = 0",
         [](Random& r) {
             auto p = any(r);
             p.Vs = p.Ve = 0;
             return p;
         }},
        {"dv = A^2/J",
         [](Random& r) {
             auto p = fast_problem(r);
             p.A = std::exp2(double(r.next() % 10));
             p.J = std::exp2(double(r.next() % 16));
             const double c = c_of(p);
             p.Vs = c * double(r.next() % 64) / 8;
             p.Ve = p.Vs + c;
             p.Vm = p.Ve + c * (r.one_in(3) ? 0 : r.one_in(2) ? 1 : r.decades(-3, 2));
             if (r.one_in(2)) std::swap(p.Vs, p.Ve);
             const Quad a = L1(p), b = L2(p);
             const std::array<Quad, 5> L = {a, b, a * r.unit(), a + (b - a) * r.unit(), b * 2};
             return with_length(p, L[r.next() % 5]);
         }},
        {"only decelerate, length not monotone",
         [](Random& r) {
             const auto p = far_deceleration(r);
             return with_length(p, L1(p) * (r.one_in(2) ? r.unit() : 1 - r.decades(-6, 0)));
         }},
        {"far deceleration with a peak",
         [](Random& r) {
             const auto p = far_deceleration(r);
             const Quad first = L1(p);
             const Quad turn = turning_length(p);
             return with_length(
                 p, first + (turn - first) * (r.one_in(2) ? r.unit() : r.decades(-12, 0)));
         }},
        {"only decelerate, beside the turning point",
         [](Random& r) {
             auto p = far_deceleration(r);
             const double c = c_of(p);
             p.Ve = (p.Vs > 1.5 * c ? c / 2 : p.Vs / 3) * (1 - r.decades(-12, -4));
             return with_length(p, L1(p) * (1 - r.decades(-14, -6)));
         }},
        {"L = 0",
         [](Random& r) {
             auto p = any(r);
             p.L = r.one_in(2) ? 0 : r.decades(-323, -101);
             return p;
         }},
        {"tiny L",
         [](Random& r) {
             auto p = any(r);
             p.L *= r.decades(-20, -6);
             return p;
         }},
    };
    return list;
}

}  // namespace

TEST_CASE("random moves are exact, optimal and inside their limits") {
    Random random{1};
    Figures figures;
    for (auto i = test::count_of("LINESHAFT_PROBLEMS", 50000); i > 0; --i)
        check(random_problem(random), figures);
    report("random moves", figures);
    for (std::size_t kind = 0; kind < move_kinds; ++kind) {
        INFO(name(static_cast<MoveKind>(kind)));
        CHECK(figures.seen[kind] > 0);
    }
}

TEST_CASE("moves on the borders between the kinds are exact, optimal and inside their limits") {
    const std::int64_t count = test::count_of("LINESHAFT_PROBLEMS", 60000) / 20;
    std::uint64_t seed = 100;
    for (const Family& family : families()) {
        Random random{++seed};
        Figures figures;
        for (std::int64_t i = 0; i < count; ++i)
            check(in_metres(family.make(random), random.one_in(2)), figures);
        INFO(family.name);
        report(family.name, figures);
    }
}

namespace {

struct Set {
    SevenSegment problem;
    MoveKind kind;
};

/// 24 sets [mm, s]: the 16 kinds, then eight on their borders.
const std::array<Set, 24> sets = {{
    {{10, 200, 200, 500, 5000, 20}, MoveKind::accelerate_trapezoidal},
    {{10, 200, 200, 500, 5000, 5}, MoveKind::accelerate_triangular},
    {{120, 10, 200, 500, 5000, 20}, MoveKind::decelerate_trapezoidal},
    {{120, 10, 200, 500, 5000, 10}, MoveKind::decelerate_triangular},
    {{10, 20, 80, 500, 5000, 30}, MoveKind::cruise_rising_both},
    {{10, 50, 80, 500, 5000, 30}, MoveKind::cruise_rising_first},
    {{50, 60, 80, 500, 5000, 25}, MoveKind::cruise_rising_neither},
    {{20, 10, 80, 500, 5000, 30}, MoveKind::cruise_falling_both},
    {{50, 10, 80, 500, 5000, 30}, MoveKind::cruise_falling_second},
    {{60, 50, 80, 500, 5000, 25}, MoveKind::cruise_falling_neither},
    {{10, 20, 200, 500, 5000, 30}, MoveKind::peak_rising_both},
    {{10, 40, 200, 500, 5000, 20}, MoveKind::peak_rising_first},
    {{10, 40, 200, 500, 5000, 10}, MoveKind::peak_rising_neither},
    {{20, 10, 200, 500, 5000, 30}, MoveKind::peak_falling_both},
    {{40, 10, 200, 500, 5000, 20}, MoveKind::peak_falling_second},
    {{40, 10, 200, 500, 5000, 10}, MoveKind::peak_falling_neither},
    {{0, 100, 200, 500, 5000, 15}, MoveKind::accelerate_trapezoidal},  // L = L1
    {{0, 0, 100, 500, 5000, 30}, MoveKind::cruise_rising_both},        // L = L2
    {{50, 50, 50, 500, 5000, 30}, MoveKind::cruise_rising_neither},    // Vs = Ve = Vm
    {{0, 0, 200, 500, 5000, 10}, MoveKind::peak_rising_neither},       // T2 = T6 = 0
    {{10, 60, 200, 500, 5000, 20}, MoveKind::peak_rising_first},       // dv = A^2/J
    {{100, 0, 100, 500, 5000, 25}, MoveKind::cruise_falling_second},   // Vs = Vm
    {{60, 0, 200, 500, 5000, 6.5}, MoveKind::decelerate_triangular},   // not monotone down to Ve
    {{20, 20, 200, 500, 5000, 1e-6}, MoveKind::peak_rising_neither},   // Vs = Ve, tiny L
}};

SevenSegmentPlan planned(const SevenSegment& problem) {
    SevenSegmentPlan out;
    INFO(line(problem));
    REQUIRE(plan(problem, out) == PlanResult::ok);
    return out;
}

}  // namespace

TEST_CASE("24 sets of every kind end within 1.3e-14 mm and 4 ulp of L") {
    std::array<int, 12> solved{};
    double greatest = 0;
    for (const Set& set : sets) {
        INFO(line(set.problem));
        Figures figures;
        check(set.problem, figures);
        CHECK(figures.failures == 0);
        const SevenSegmentPlan out = planned(set.problem);
        CHECK(name(out.kind) == name(set.kind));
        const double error =
            std::abs(static_cast<double>(run(set.problem, out).position - set.problem.L));
        CHECK(error <= 1.3e-14);
        CHECK(error <= 4 * ulp(set.problem.L));
        CHECK(std::abs(out.displacement_error() - error) <= 0.01 * ulp(set.problem.L));
        greatest = std::max(greatest, error);
        ++solved[static_cast<std::size_t>(equation(out.kind))];
    }
    CHECK(std::count(solved.begin() + 1, solved.end(), 0) == 0);
    if (std::getenv("LINESHAFT_FIGURES") != nullptr)
        std::printf("24 sets: displacement error %.1e mm at most\n", greatest);
}

TEST_CASE("a move is evaluated from each segment's own start") {
    for (const Set& set : sets) {
        INFO(line(set.problem));
        const SevenSegment& p = set.problem;
        const SevenSegmentPlan out = planned(p);
        CHECK(out.at(-1).position == 0);
        CHECK(out.at(0).velocity == p.Vs);
        CHECK(out.at(out.duration).position == p.L);
        CHECK(out.at(out.duration + 1).velocity == out.end.velocity);
        CHECK(out.at(out.duration * (1 - 1e-15)).position == Approx(p.L).epsilon(1e-14));
        for (int i = 1; i < 1000; ++i) {
            const MotionState state = out.at(out.duration * i / 1000);
            CHECK(state.velocity >= 0);
            CHECK(state.velocity <= out.peak * (1 + 1e-14));
            CHECK(std::abs(state.acceleration) <= p.A * (1 + 1e-14));
            CHECK(std::abs(state.jerk) <= p.J);
        }
        for (const double t : out.begin) {
            const MotionState before = out.at(std::nextafter(t, -1.0));
            const MotionState after = out.at(t);
            CHECK(std::abs(before.position - after.position) <= 1e-14 * p.L);
            CHECK(std::abs(before.velocity - after.velocity) <= 1e-13 * p.Vm);
            CHECK(std::abs(before.acceleration - after.acceleration) <= 1e-12 * p.A);
        }
    }
}

TEST_CASE("the equations of the paper give the same times where they keep their digits") {
    Random random{7};
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
        SevenSegment p = random_limits(random);
        p.Vm = c_of(p) * random.decades(-1, 1);
        p.Vs = p.Vm * random.between(0.05, 0.95);
        p.Ve = p.Vm * random.between(0.05, 0.95);
        const Quad first = L1(p);
        const Quad second = L2(p);
        const std::array<Quad, 3> lengths = {first * random.between(0.1, 0.9),
                                             first + (second - first) * random.between(0.1, 0.9),
                                             second * random.between(1, 5)};
        p.L = static_cast<double>(lengths[random.next() % 3]);
        const SevenSegmentPlan out = planned(p);
        const std::array<double, 7> T = closed_form::times(p, out.kind);
        for (std::size_t k = 0; k < 7; ++k) {
            const double off = std::abs(T[k] - out.T[k]) / out.duration;
            worst = std::max(worst, off);
            if (off <= 1e-10) continue;
            print_failure("times differ", line(p));
            FAIL(name(out.kind));
        }
    }
    if (std::getenv("LINESHAFT_FIGURES") != nullptr)
        std::printf("closed forms: times differ by %.1e of the duration at most\n", worst);
}

TEST_CASE("a move says what it cannot plan and leaves the plan as it was") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    const double huge = std::numeric_limits<double>::max();
    SevenSegmentPlan out = planned({0, 0, 10, 10, 100, 5});
    const auto result = [&](const SevenSegment& p) { return plan(p, out); };
    CHECK(result({0, 0, 0, 1, 1, 1}) == PlanResult::limit_not_positive);
    CHECK(result({0, 0, 1, -1, 1, 1}) == PlanResult::limit_not_positive);
    CHECK(result({0, 0, 1, 1, nan, 1}) == PlanResult::limit_not_positive);
    CHECK(result({0, 0, inf, 1, 1, 1}) == PlanResult::limit_not_positive);
    CHECK(result({nan, 0, 1, 1, 1, 1}) == PlanResult::not_finite);
    CHECK(result({0, nan, 1, 1, 1, 1}) == PlanResult::not_finite);
    CHECK(result({0, 0, 1, 1, 1, nan}) == PlanResult::not_finite);
    CHECK(result({0, 0, 1, 1, 1, inf}) == PlanResult::not_finite);
    CHECK(result({-1, 0, 1, 1, 1, 1}) == PlanResult::velocity_above_limit);
    CHECK(result({0, 1.5, 1, 1, 1, 1}) == PlanResult::velocity_above_limit);
    CHECK(result({2, 0, 1, 1, 1, 1}) == PlanResult::velocity_above_limit);
    CHECK(result({0, 0, 1, 1, 1, -1}) == PlanResult::negative_length);
    CHECK(result({0, 0, 1e-300, 1, 1, huge}) == PlanResult::not_finite);
    CHECK(out.end.position == 5);
}

TEST_CASE("numbers of any size are planned without harm or refused") {
    Random random{8};
    int plans = 0;
    for (int i = 0; i < 200000; ++i) {
        SevenSegment p;
        for (double* quantity : {&p.Vm, &p.A, &p.J, &p.L}) *quantity = random.decades(-300, 300);
        p.Vs = p.Vm * random.unit();
        p.Ve = p.Vm * random.unit();
        SevenSegmentPlan out;
        if (plan(p, out) != PlanResult::ok) continue;
        ++plans;
        bool sound = std::isfinite(out.duration);
        for (std::size_t k = 0; k < 7; ++k) {
            const MotionState& s = out.start[k];
            sound = sound && out.T[k] >= 0 && out.T[k] <= out.duration && s.velocity >= 0 &&
                    std::isfinite(s.position) && std::isfinite(s.velocity) &&
                    std::isfinite(s.acceleration);
        }
        if (sound) continue;
        print_failure("not sound", line(p));
        FAIL();
    }
    CHECK(plans > 0);
}

TEST_CASE("the sign of a zero makes no difference to a plan") {
    for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        SevenSegment positive = random_problem(random);
        SevenSegment negative = positive;
        for (double SevenSegment::*zero :
             {&SevenSegment::Vs, &SevenSegment::Ve, &SevenSegment::L}) {
            if (random.one_in(2)) continue;
            positive.*zero = 0.0;
            negative.*zero = -0.0;
        }
        SevenSegmentPlan expected, got;
        REQUIRE(plan(positive, expected) == PlanResult::ok);
        REQUIRE(plan(negative, got) == PlanResult::ok);
        CHECK(got.T == expected.T);
        CHECK(got.duration == expected.duration);
        CHECK(got.end.velocity == expected.end.velocity);
        CHECK(got.kind == expected.kind);
        CHECK(got.reaches_Ve == expected.reaches_Ve);
    }
}
