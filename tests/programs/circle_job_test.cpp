#include <cmath>

#include <catch2/catch.hpp>

#include "blocks/circle/circle_fit.hpp"
#include "tests/blocks/scanning.hpp"
#include "tests/programs/twin.hpp"
#include "tools/bench/hand_circle_axes.hpp"
#include "tools/bench/hand_circle_job.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// programs/paper/circle_job.scl and its twin.
struct CircleJob : Twin<HandCircleJob> {
    void scan(const Scan& now) {
        static const st::Library library = compiled({"circle_job.scl"});
        scan_both(library, "CircleJob", now);
    }
};

using State = CircleJob::State;
using Method = CircleJob::Method;

constexpr double pi = 3.14159265358979323846;
constexpr Method all_methods[] = {Method::immediate, Method::early, Method::centred,
                                  Method::balanced, Method::ramp};

CircleJob circle(Method method, double start = 0, double end = 2 * pi) {
    CircleJob c;
    c.method = method;
    c.start_angle = start;
    c.end_angle = end;
    return c;
}

void scan(CircleJob& c, Clock& clock, int times) {
    for (int i = 0; i < times; ++i) clock.scan(c);
}

/// Drives by hand to the state run, as axes that are in position at once would.
void engage(CircleJob& c, Clock& clock) {
    c.start = true;
    clock.scan(c);
    c.x_position = c.start_x;
    c.y_position = c.start_y;
    for (int i = 0; i < 20 && c.state != State::run; ++i) clock.scan(c);
    REQUIRE(c.state == State::run);
}

void poll_at(CircleJob& c, Clock& clock, double master_position) {
    c.master_position = master_position;
    clock.scan(c);
}

/// The whole method in a loop: MC_Servo, then the user program, then MC_Interpolator.
struct Loop {
    CircleJob circle;
    HandCircleAxes axes;
    Axis &g = axes.g, &x = axes.x, &y = axes.y;
    CircleFit fit;
    Clock clock;

    explicit Loop(const CircleJob& c) : circle(c) {
        fit.radius = c.radius;
        circle.start = true;
        clock.interval = std::llround(c.motion_clock * 1e9);
    }

    void scan() {
        const Scan now{.time = clock.time(), .interval = clock.interval, .index = clock.index};
        circle.master_position = g.position;
        circle.x_position = x.position;
        circle.x_velocity = x.velocity;
        circle.y_position = y.position;
        circle.y_velocity = y.velocity;
        circle.scan(now);
        axes.command(circle, now.time, now.interval);
        axes.interpolate(now.time, now.interval);
        fit.enable = axes.g_moves();
        fit.x = x.position;
        fit.y = y.position;
        fit.scan(now);
        ++clock.index;
        REQUIRE_FALSE((circle.error || axes.error()));
    }

    void run() {
        for (int i = 0; i < 200'000 && !circle.done; ++i) scan();
        REQUIRE(circle.done);
    }
};

}  // namespace

TEST_CASE("the circle goes from idle over approach, home and engage to run and done") {
    CircleJob c = circle(Method::immediate, 0.7, 0.7 + pi / 2);
    Clock clock;
    scan(c, clock, 5);
    CHECK(c.state == State::idle);
    CHECK_FALSE(c.approach);
    c.start = true;
    clock.scan(c);
    CHECK(c.state == State::approach);
    CHECK(c.approach);
    CHECK(c.start_x == Approx(20 * std::sin(0.7)));
    CHECK(c.start_y == Approx(20 * std::cos(0.7)));
    CHECK(c.steps == 31);
    CHECK(c.master_target == Approx(pi / 2));
    CHECK(c.master_velocity == 0.5);
    scan(c, clock, 10);
    CHECK(c.state == State::approach);
    c.x_position = c.start_x;
    scan(c, clock, 10);
    CHECK(c.state == State::approach);
    c.y_position = c.start_y;
    clock.scan(c);
    CHECK(c.state == State::home);
    CHECK(c.home);
    scan(c, clock, 2);
    CHECK(c.state == State::home);
    clock.scan(c);
    CHECK(c.state == State::engage);
    CHECK_FALSE(c.home);
    CHECK_FALSE(c.approach);
    CHECK(c.step_x == 1);
    CHECK(c.ratio_x == c.arc.chord_ratio(1).x);
    CHECK(c.ratio_y == c.arc.chord_ratio(1).y);
    CHECK_FALSE(c.execute);
    scan(c, clock, 3);
    CHECK(c.state == State::run);
    CHECK(c.execute);
    poll_at(c, clock, c.master_target);
    CHECK(c.state == State::done);
    CHECK(c.done);
    CHECK_FALSE(c.execute);
    scan(c, clock, 5);
    CHECK(c.state == State::done);
}

TEST_CASE("the slaves stand on the start point for the settling time before they are homed") {
    CircleJob c = circle(Method::early);
    Clock clock;
    c.settling_time = 0.5;
    c.start = true;
    scan(c, clock, 1000);
    CHECK(c.state == State::approach);
    c.x_position = c.start_x;
    c.y_position = c.start_y;
    scan(c, clock, 300);
    c.y_position = c.start_y + 0.001;
    scan(c, clock, 1);
    c.y_position = c.start_y;
    scan(c, clock, 499);
    CHECK(c.state == State::approach);
    CHECK_FALSE(c.home);
    scan(c, clock, 1);
    CHECK(c.state == State::home);
    CHECK(c.home);
}

TEST_CASE("start held true does one arc, a new rising edge does another") {
    CircleJob c = circle(Method::immediate);
    Clock clock;
    engage(c, clock);
    poll_at(c, clock, c.master_target);
    CHECK(c.done);
    scan(c, clock, 10);
    CHECK(c.state == State::done);
    c.start = false;
    clock.scan(c);
    CHECK(c.done);
    c.start = true;
    clock.scan(c);
    CHECK(c.state == State::approach);
    CHECK_FALSE(c.done);
    CHECK(c.ratio_x == 0);
    CHECK(c.ratio_y == 0);
}

namespace {

/// Checks that X changes from step i when the master reaches `angle`, and not before.
void check_switch(CircleJob& c, Clock& clock, std::int64_t i, double angle) {
    INFO("from step " << i << " at " << angle);
    REQUIRE(c.step_x == i);
    poll_at(c, clock, angle - 1e-12);
    REQUIRE(c.step_x == i);
    poll_at(c, clock, angle + 1e-12);
    REQUIRE(c.step_x == i + 1);
    REQUIRE(c.ratio_x == c.arc.chord_ratio(i + 1).x);
}

/// |k_{i+1} - k_i| v_G of X.
double velocity_change(const CircleJob& c, std::int64_t i) {
    return std::abs(c.arc.chord_ratio(i + 1).x - c.arc.chord_ratio(i).x) * c.speed / c.radius;
}

}  // namespace

TEST_CASE("immediate changes the ratio when the master reaches theta_i") {
    CircleJob c = circle(Method::immediate);
    Clock clock;
    engage(c, clock);
    for (std::int64_t i = 1; i < c.steps; ++i) check_switch(c, clock, i, c.arc.theta(i));
    CHECK(c.step_x == c.steps);
}

TEST_CASE("early changes the ratio v_G T before theta_i, T by equation (18)") {
    CircleJob c = circle(Method::early);
    Clock clock;
    engage(c, clock);
    for (std::int64_t i = 1; i < c.steps; ++i) {
        const double T = 100 / 5e4 + velocity_change(c, i) / 100;
        check_switch(c, clock, i, c.arc.theta(i) - 0.5 * T);
    }
}

TEST_CASE("early can round T up to whole motion clocks, or take it exactly") {
    for (const auto kind :
         {CircleJob::TransitionTime::paper_whole_clocks, CircleJob::TransitionTime::exact}) {
        CircleJob c = circle(Method::early);
        c.transition_time = kind;
        c.motion_clock = 0.002;
        Clock clock;
        engage(c, clock);
        for (std::int64_t i = 1; i < c.steps; ++i) {
            const double dv = velocity_change(c, i);
            const double whole = std::ceil((100 / 5e4 + dv / 100) / 0.002) * 0.002;
            const double exact = dv >= 0.2 ? 100 / 5e4 + dv / 100 : 2 * std::sqrt(dv / 5e4);
            const bool rounds = kind == CircleJob::TransitionTime::paper_whole_clocks;
            check_switch(c, clock, i, c.arc.theta(i) - 0.5 * (rounds ? whole : exact));
        }
    }
}

TEST_CASE("centred calls so that the job starts half a transition before theta_i") {
    CircleJob c = circle(Method::centred);
    c.lead = 3;
    Clock clock;
    engage(c, clock);
    for (std::int64_t i = 1; i < c.steps; ++i) {
        const double dv = velocity_change(c, i);
        const double T = dv >= 0.2 ? 100 / 5e4 + dv / 100 : 2 * std::sqrt(dv / 5e4);
        const double known_delay = 3 * 0.001 + 0.0005;  // lead, and half a scan on average
        check_switch(c, clock, i, c.arc.theta(i) - 0.5 * (T / 2 + known_delay));
    }
}

TEST_CASE("early has its own switching angle for each axis") {
    CircleJob c = circle(Method::early);
    Clock clock;
    engage(c, clock);
    // Near the start X's velocity hardly changes, Y's changes most: Y's T is longer.
    const double theta = c.arc.theta(1);
    const double dv_y = std::abs(c.arc.chord_ratio(2).y - c.arc.chord_ratio(1).y) * 0.5;
    poll_at(c, clock, theta - 0.5 * (0.002 + dv_y / 100) + 1e-9);
    CHECK(c.step_y == 2);
    CHECK(c.step_x == 1);
}

TEST_CASE("a counter-clockwise arc leaves the start point to the other side") {
    for (const Method method : all_methods) {
        CircleJob there = circle(method, 0, pi / 2), back = circle(method, 0, -pi / 2);
        Clock a, b;
        engage(there, a);
        engage(back, b);
        CHECK(there.ratio_x > 19);
        CHECK(back.ratio_x == -there.ratio_x);
        CHECK(back.ratio_y == there.ratio_y);
        CHECK(back.master_target == there.master_target);
    }
}

TEST_CASE("an arc of one step is driven with one ratio") {
    for (const Method method : all_methods) {
        INFO("method " << static_cast<int>(method));
        CircleJob c = circle(method, 0.5, 0.53);
        Loop loop(c);
        loop.run();
        CHECK(loop.circle.steps == 1);
        CHECK(loop.circle.step_x == 1);
        const Point end = loop.circle.arc.at(loop.circle.arc.sweep);
        const double missed = std::hypot(loop.x.position - end.x, loop.y.position - end.y);
        // The velocity's ramp begins up to three clocks after the master.
        const double late = 10 * 0.03 * 0.003 / 2;
        CHECK(missed <= (method == Method::ramp ? late : 64 * epsilon * 20));
    }
}

TEST_CASE("an arc of no length and inputs that are no numbers are errors") {
    CircleJob c = circle(Method::early, 1, 1);
    Clock clock;
    clock.scan(c);
    CHECK(c.error);
    CHECK(c.error_id == CircleJob::Error::arc_is_empty);
    CHECK(c.state == State::idle);
    for (double HandCircleJob::*input :
         {&HandCircleJob::master_position, &HandCircleJob::x_position, &HandCircleJob::x_velocity,
          &HandCircleJob::y_position, &HandCircleJob::y_velocity}) {
        CircleJob good = circle(Method::early);
        engage(good, clock);
        CircleJob bad = good;
        bad.*input = not_a_number;
        clock.scan(bad);
        CHECK(bad.error);
        CHECK(bad.error_id == CircleJob::Error::not_finite);
        CHECK(bad.ratio_x == good.ratio_x);
        CHECK(bad.state == State::run);
        bad.*input = good.*input;
        clock.scan(bad);
        CHECK_FALSE(bad.error);
    }
}

TEST_CASE("a speed that no double can turn into an angular velocity is an error") {
    for (const double radius : {1e300, 1e-300}) {
        CircleJob c = circle(Method::balanced);
        c.radius = radius;
        c.speed = radius > 1 ? 1e-10 : 1e10;
        Clock clock;
        clock.scan(c);
        CHECK(c.error_id == CircleJob::Error::not_finite);
    }
}

TEST_CASE("balanced brings the mean deviation to a quarter of the sagitta, both ways round") {
    for (const double end : {2 * pi, -2 * pi}) {
        Loop loop(circle(Method::balanced, 0, end));
        loop.run();
        CHECK(loop.fit.mean_deviation <= 0.27 * loop.circle.sagitta);
        CHECK(loop.fit.mean_deviation >= 0.24 * loop.circle.sagitta);
        CHECK(loop.fit.offset <= 1e-4);
        CHECK(loop.fit.closing_gap <= 1e-4);
    }
}

TEST_CASE("ramp leaves no polygon") {
    for (const double end : {2 * pi, -2 * pi}) {
        Loop loop(circle(Method::ramp, 0, end));
        loop.run();
        CHECK(loop.fit.mean_deviation <= 1e-4);
        CHECK(loop.fit.offset <= 1e-4);
        CHECK(loop.fit.closing_gap <= 1e-4);
    }
}

TEST_CASE("a second circle is as good as the first") {
    Loop loop(circle(Method::balanced, 0.7, 2));
    loop.run();
    const double first = loop.fit.mean_deviation;
    loop.circle.start = false;
    loop.scan();
    loop.circle.start = true;
    loop.scan();
    REQUIRE_FALSE(loop.circle.done);
    loop.run();
    CHECK(loop.fit.mean_deviation == Approx(first).epsilon(1e-6));
}

TEST_CASE("steps that take less than a scan of the user program are an error") {
    for (const Method method : all_methods) {
        INFO("method " << static_cast<int>(method));
        CircleJob c = circle(method);
        c.step = 0.1;
        c.start = true;
        const std::int64_t step_time = 10 * millisecond;
        Clock slow{.interval = step_time + millisecond};
        slow.scan(c);
        CHECK(c.error);
        CHECK(c.error_id == CircleJob::Error::steps_too_fast);
        CHECK(c.state == State::idle);
        Clock fast{.interval = millisecond};
        fast.scan(c);
        CHECK_FALSE(c.error);
        CHECK(c.state == State::approach);
    }
}

TEST_CASE("methods that steer by position need steps that outlast a change of ratio") {
    for (const Method method : all_methods) {
        INFO("method " << static_cast<int>(method));
        CircleJob c = circle(method);
        const bool steers = method == Method::balanced || method == Method::ramp;
        c.step = 0.01;  // 1 ms
        Clock clock{.interval = 500 * microsecond};
        clock.scan(c);
        CHECK(c.error == steers);
        c.start_angle = 6.2825;  // one step
        clock.scan(c);
        CHECK_FALSE(c.error);
    }
}

TEST_CASE("a slave far away from the arc gets no ratio that is no number") {
    for (const Method method : {Method::balanced, Method::ramp}) {
        for (const double place : {1e300, -largest}) {
            CircleJob c = circle(method);
            Clock clock;
            engage(c, clock);
            c.x_position = place;
            c.y_velocity = place;
            for (int i = 1; i < 500; ++i) {
                poll_at(c, clock, i * 5e-4);
                REQUIRE(std::isfinite(c.ratio_x));
                REQUIRE(std::isfinite(c.ratio_y));
                REQUIRE(std::isfinite(c.acceleration_x));
            }
        }
    }
}

namespace {

/// Two ulps a function call, at most three calls a value.
double rounding(double size) {
    return 8 * epsilon * size;
}

}  // namespace

TEST_CASE("a full circle starts and ends at (0, R) and runs clockwise") {
    const SteppedArc arc = SteppedArc::between(20, 0, 2 * pi, 1);
    CHECK(arc.steps == 126);  // round(2 pi 20 / 1)
    CHECK(arc.direction == 1);
    CHECK(arc.at(0).x == 0);
    CHECK(arc.at(0).y == 20);
    CHECK(arc.at(pi / 2).x == Approx(20));
    CHECK(std::abs(arc.at(arc.sweep).x) <= rounding(20));
    CHECK(arc.at(arc.sweep).y == 20);
}

TEST_CASE("an end below the start runs counter-clockwise") {
    const SteppedArc arc = SteppedArc::between(10, pi / 2, 0, 1);
    CHECK(arc.direction == -1);
    CHECK(arc.sweep == pi / 2);
    CHECK(arc.steps == 16);
    CHECK(arc.at(0).x == 10);
    CHECK(arc.at(0.1).y > 0);
    CHECK(arc.at(arc.sweep).y == 10);
}

TEST_CASE("the steps of an arc end exactly at its end") {
    for (const double end : {2 * pi, -2 * pi, 1.0, 0.1, 5.5}) {
        for (const double step : {1.0, 0.5, 0.37, 1e-3}) {
            const SteppedArc arc = SteppedArc::between(20, 0, end, step);
            CHECK(arc.theta(0) == 0);
            CHECK(arc.theta(arc.steps) == arc.sweep);
            CHECK(arc.sweep == std::abs(end));
        }
    }
}

TEST_CASE("chord ratios times the step angle lead from point to point") {
    for (const double end : {2 * pi, -2 * pi, 1.3}) {
        const SteppedArc arc = SteppedArc::between(20, 0.4, end, 1);
        Point p = arc.at(0);
        for (std::int64_t i = 1; i <= arc.steps; ++i) {
            const Point k = arc.chord_ratio(i);
            p.x += k.x * arc.step_angle();
            p.y += k.y * arc.step_angle();
            const Point on_arc = arc.at(arc.theta(i));
            INFO("step " << i);
            const double tolerance = rounding(20) * static_cast<double>(i + 1);
            REQUIRE(std::abs(p.x - on_arc.x) <= tolerance);
            REQUIRE(std::abs(p.y - on_arc.y) <= tolerance);
            REQUIRE(std::abs(std::hypot(on_arc.x, on_arc.y) - 20) <= rounding(20));
        }
    }
}

TEST_CASE("chord ratios are those of equation (7)") {
    const SteppedArc arc = SteppedArc::between(50, 0, 2 * pi, 1);
    const double d = 2 * pi / 314;
    for (const std::int64_t i : {1, 2, 79, 157, 314}) {
        const double n = static_cast<double>(i);
        const double x = 50 * (std::sin(n * d) - std::sin((n - 1) * d)) / d;
        const double y = 50 * (std::cos(n * d) - std::cos((n - 1) * d)) / d;
        CHECK(std::abs(arc.chord_ratio(i).x - x) <= rounding(50) / d);
        CHECK(std::abs(arc.chord_ratio(i).y - y) <= rounding(50) / d);
    }
}

TEST_CASE("the sagitta is the height of the arc over the chord") {
    for (const double radius : {20.0, 50.0, 100.0}) {
        const SteppedArc arc = SteppedArc::between(radius, 0, 2 * pi, 1);
        const Point a = arc.at(arc.theta(4)), b = arc.at(arc.theta(5));
        const double middle = std::hypot((a.x + b.x) / 2, (a.y + b.y) / 2);
        CHECK(std::abs(arc.sagitta() - (radius - middle)) <= rounding(radius));
        CHECK(arc.sagitta() == Approx(1.0 / (8 * radius)).epsilon(0.01));
    }
}

TEST_CASE("an arc has at least one step, and no more than can be counted") {
    CHECK(SteppedArc::between(20, 0, 1e-9, 1).steps == 1);
    CHECK(SteppedArc::between(20, 0, 0.01, 1).steps == 1);
    CHECK(SteppedArc::between(20, 0, denormal, 1).steps == 1);
    for (const double step : {denormal, 1e-300, 1e-15}) {
        const SteppedArc arc = SteppedArc::between(20, 0, 2 * pi, step);
        CHECK(arc.steps > 1'000'000);
        CHECK(arc.theta(arc.steps) == arc.sweep);
        CHECK(arc.theta(arc.steps - 1) < arc.sweep);
    }
}
