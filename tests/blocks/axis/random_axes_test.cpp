#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/axis/gear_axis.hpp"
#include "blocks/axis/move.hpp"
#include "blocks/axis/virtual_axis.hpp"
#include "runtime/model/random.hpp"
#include "tests/blocks/profile/any_state_reference.hpp"
#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// What an axis is told before one scan. Each kind of axis takes what it knows.
struct Command {
    std::int64_t scan = 0;
    double target = 0, velocity = 1, end_velocity = 0, ratio = 0;  ///< `target` of `home` too
    double acceleration = 100, jerk = 1e4;                         ///< `move` only
    bool enable = true, execute = false, home = false;
};

/// A run of one axis.
struct Program {
    std::int64_t interval = millisecond, scans = 0;
    double acceleration = 100, jerk = 1e4, speed = 0;  ///< `speed` of a gear's master
    bool absolute = false, immediate = false;          ///< virtual axis
    std::vector<Command> commands;
};

class Draw {
  public:
    Draw(std::uint64_t seed, std::string_view axis) : random_(seed, axis) {}

    bool one_in(std::uint64_t n) { return random_.next() % n == 0; }
    double between(double least, double most) { return least + (most - least) * random_.share(); }
    double decades(double least, double most) { return std::pow(10, between(least, most)); }
    double either_way(double x) { return one_in(2) ? -x : x; }
    std::int64_t whole(double x) { return static_cast<std::int64_t>(x); }

    Command command(const Program& program) {
        Command c;
        c.target = one_in(8) ? 0 : either_way(decades(-3, 3));
        c.velocity = one_in(8) ? 0 : either_way(decades(-2, 2));
        c.end_velocity = one_in(2) ? 0 : std::abs(c.velocity) * between(0, one_in(8) ? 1.2 : 1);
        c.ratio = one_in(3) ? 0 : either_way(decades(-2, 0.5));
        c.acceleration = program.acceleration * (one_in(2) ? 1 : decades(-1, 1));
        c.jerk = program.jerk * (one_in(2) ? 1 : decades(-1, 1));
        c.enable = !one_in(5);
        c.execute = !one_in(4);
        c.home = one_in(10);
        return c;
    }

    Program program() {
        Program p;
        p.interval = millisecond * whole(decades(0, 1));
        p.acceleration = decades(1, 3);
        p.jerk = p.acceleration * decades(0, 3);
        p.speed = either_way(decades(-1, 1.5));
        p.absolute = one_in(2);
        p.immediate = one_in(4);
        for (std::int64_t i = 1 + whole(between(0, 6)); i > 0; --i) {
            p.scans += 2 + whole(decades(0, 3));  // an edge needs a scan without
            p.commands.push_back(command(p));
            p.commands.back().scan = p.scans;
        }
        p.scans += 2000;
        return p;
    }

  private:
    Random random_;
};

std::string describe(const Program& p) {
    std::string text = fmt::format(
        "every {} ns, acceleration {:.17g}, jerk {:.17g}, master {:.17g}, absolute {}, immediate "
        "{}\n",
        p.interval, p.acceleration, p.jerk, p.speed, p.absolute, p.immediate);
    for (const Command& c : p.commands)
        text += fmt::format(
            "scan {}: target {:.17g}, velocity {:.17g}, end velocity {:.17g}, ratio {:.17g}, "
            "acceleration {:.17g}, jerk {:.17g}, enable {}, execute {}, home {}\n",
            c.scan, c.target, c.velocity, c.end_velocity, c.ratio, c.acceleration, c.jerk, c.enable,
            c.execute, c.home);
    return text;
}

/// One motion that must end within two scans of the shortest duration there is, not before it.
template <class Axis>
struct Promise {
    std::int64_t begun = 0;
    double duration = 0;
    std::function<bool(const Axis&)> arrived;  ///< empty: nothing is promised
};

struct Limits {
    double velocity = 0, acceleration = 0, jerk = 0;
};

/// An axis under a program: its state, what it promised, and what may not be exceeded.
template <class Axis>
struct Ride {
    Program program;
    Axis axis;
    Promise<Axis> promise;
    Limits limits, coming;  ///< up to this scan, and from it on
    double goal = 0;        ///< velocity or ratio that is aimed at
    bool stops = false;
    std::int64_t time = 0;

    void begin(double duration, std::function<bool(const Axis&)> arrived) {
        promise = {time, duration, std::move(arrived)};
    }
    void allow(double v) {
        for (Limits* l : {&limits, &coming}) l->velocity = std::max(l->velocity, std::abs(v));
    }
    /// A motion that begins in this scan: the one before may have ended since the last.
    void begin_under(const Limits& next) {
        coming = next;
        limits = {std::max(limits.velocity, next.velocity),
                  std::max(limits.acceleration, next.acceleration),
                  std::max(limits.jerk, next.jerk)};
    }
};

double shortest_ramp(const MotionState& from, double to, double acceleration, double jerk) {
    VelocityRamp ramp;
    return ramp.plan(from.velocity, from.acceleration, to, acceleration, jerk) == PlanResult::ok
               ? ramp.duration
               : not_a_number;
}

double shortest_move(const MotionState& from, double to, SevenSegment problem) {
    const bool back = to < from.position || (to == from.position && from.velocity < 0);
    problem.L = std::abs(to - from.position);
    problem.Vs = back ? -from.velocity : from.velocity;
    if (from.acceleration != 0 || problem.Vs < 0 || problem.Vs > problem.Vm)
        return reference::duration({from.position, from.velocity, from.acceleration, to,
                                    back ? -problem.Ve : problem.Ve, problem.Vm, -problem.Vm,
                                    problem.A, problem.A, problem.J});
    SevenSegmentPlan shortest;
    return plan(problem, shortest) == PlanResult::ok ? shortest.duration : not_a_number;
}

template <class Axis>
MotionState state_of(const Axis& axis) {
    return {
        .position = axis.position, .velocity = axis.velocity, .acceleration = axis.acceleration};
}

// Of each kind of axis: `give` hands it the inputs of a scan, `judge` says what it should make of
// the command, compared with one that did not get it.

void set_up(Ride<VirtualAxis>& ride) {
    VirtualAxis& axis = ride.axis;
    axis.motion =
        ride.program.absolute ? VirtualAxis::Motion::absolute : VirtualAxis::Motion::velocity;
    axis.immediate = ride.program.immediate;
    axis.acceleration_limit = ride.program.acceleration;
    axis.jerk_limit = ride.program.jerk;
    axis.wanted_velocity = ride.program.absolute ? 1 : 0;
}

void give(Ride<VirtualAxis>& ride, const Command* c) {
    VirtualAxis& axis = ride.axis;
    axis.execute = c && c->execute;
    axis.home = c && c->home && !c->execute;
    if (!c) return;
    axis.enable = c->enable;
    axis.target = axis.home_position = c->target;
    axis.wanted_velocity = ride.program.absolute ? std::abs(c->velocity) + 0.01 : c->velocity;
    ride.allow(axis.wanted_velocity);
}

std::string judge(Ride<VirtualAxis>& ride, const VirtualAxis&, const Command* c) {
    const VirtualAxis& axis = ride.axis;
    if (!c) return axis.error ? "an error without a command" : "";
    const double A = ride.program.acceleration, J = ride.program.jerk;
    const double goal = c->enable && !ride.program.absolute ? c->velocity : 0;
    const bool follows = !ride.program.absolute || !c->enable;
    if (follows && (goal != ride.goal || (ride.program.absolute && !ride.stops))) {
        const bool at_once = ride.program.immediate;
        ride.begin(at_once ? 0 : shortest_ramp(state_of(axis), goal, A, J),
                   [goal](const VirtualAxis& a) { return a.velocity == goal && !a.acceleration; });
        ride.goal = goal;
        ride.stops = true;
    }
    if (!ride.program.absolute || !c->execute) return axis.error ? "refused to go on" : "";
    const bool may = c->enable;
    if (axis.error == may) return may ? "a move is refused" : "a move is not refused";
    if (!may) return "";
    const double L = std::abs(c->target - axis.position);
    ride.begin(
        ride.program.immediate ? L / axis.wanted_velocity
                               : shortest_move(state_of(axis), c->target,
                                               {.Vm = axis.wanted_velocity, .A = A, .J = J}),
        [to = c->target](const VirtualAxis& a) { return a.done && (a.home || a.position == to); });
    ride.stops = false;
    return "";
}

bool is_homed(const VirtualAxis& axis, const VirtualAxis& undisturbed) {
    return axis.home && !undisturbed.moving;
}

/// A command is a ratio, or at ratio 0 a move.
void set_up(Ride<GearAxis>& ride) {
    ride.axis.acceleration_limit = ride.program.acceleration;
    ride.axis.jerk_limit = ride.program.jerk;
    ride.axis.master_velocity = ride.program.speed;
}

void give(Ride<GearAxis>& ride, const Command* c) {
    GearAxis& axis = ride.axis;
    axis.master_position = ride.program.speed * seconds(ride.time);
    axis.move = c && c->execute && c->ratio == 0;
    axis.home = c && c->home;
    if (!c) return;
    axis.ratio = c->ratio;
    axis.target = axis.home_position = c->target;
    axis.move_velocity = std::abs(c->velocity) + 0.01;
    ride.allow(axis.move_velocity);
    ride.allow(axis.ratio * ride.program.speed);
}

std::string judge(Ride<GearAxis>& ride, const GearAxis& undisturbed, const Command* c) {
    const GearAxis& axis = ride.axis;
    const double A = ride.program.acceleration, J = ride.program.jerk;
    const bool begins = axis.ratio != ride.goal && !axis.moving;
    if (begins) {
        ride.goal = axis.ratio;
        ride.begin(shortest_ramp(state_of(axis), axis.ratio * axis.master_velocity, A, J),
                   [](const GearAxis& a) {
                       return a.in_gear && a.velocity == a.ratio * a.master_velocity;
                   });
    }
    if (!axis.move || !c) return axis.error ? "an error without a move" : "";
    const bool may = ride.goal == 0 && axis.velocity == 0 && !undisturbed.moving;
    if (axis.error == may) return may ? "a move is refused" : "a move is not refused";
    if (may)
        ride.begin(
            shortest_move(state_of(axis), c->target, {.Vm = axis.move_velocity, .A = A, .J = J}),
            [to = c->target](const GearAxis& a) {
                return !a.moving && (a.home || a.position == to);
            });
    return "";
}

bool is_homed(const GearAxis& axis, const GearAxis&) {
    return axis.home;
}

void set_up(Ride<Move>& ride) {
    ride.axis.start_velocity = ride.program.absolute ? 0 : ride.program.speed;
    ride.allow(ride.axis.start_velocity);
}

void give(Ride<Move>& ride, const Command* c) {
    Move& axis = ride.axis;
    axis.execute = c && c->execute;
    if (!axis.execute) return;
    axis.target = c->target;
    axis.velocity_limit = std::abs(c->velocity) + 0.01;
    axis.end_velocity = c->end_velocity;
    axis.acceleration_limit = c->acceleration;
    axis.jerk_limit = c->jerk;
}

std::string judge(Ride<Move>& ride, const Move&, const Command* c) {
    const Move& axis = ride.axis;
    if (!axis.execute || !c) return axis.error ? "an error without a move" : "";
    const double Vm = axis.velocity_limit;
    const bool may = c->end_velocity <= Vm;
    if (axis.error == may) return may ? "a move is refused" : "a move is not refused";
    if (!may) return "";
    const double a = axis.acceleration;
    const double turned = std::abs(axis.velocity + a * std::abs(a) / (2 * c->jerk));
    ride.begin_under({std::max({Vm, std::abs(axis.velocity), turned}),
                      std::max(c->acceleration, std::abs(a)), c->jerk});
    ride.begin(shortest_move(state_of(axis), c->target,
                             {.Ve = c->end_velocity, .Vm = Vm, .A = c->acceleration, .J = c->jerk}),
               [](const Move& moved) { return moved.done; });
    return "";
}

bool is_homed(const Move&, const Move&) {
    return false;
}

/// Limits between two scans, by differences: an acceleration with slopes up to J bends a velocity
/// by J dt^2 / 4 at most from the trapezoid, a position by J dt^3 / 12.
template <class Axis>
std::string continuity(const Ride<Axis>& ride, const Axis& before, bool homed) {
    constexpr double rounding = 1e-9;
    const Axis& axis = ride.axis;
    const auto [V, A, J] = ride.limits;
    const double dt = seconds(ride.program.interval);
    const double dx = axis.position - before.position, dv = axis.velocity - before.velocity;
    const double beside_x = dx - dt * (axis.velocity + before.velocity) / 2;
    const double beside_v = dv - dt * (axis.acceleration + before.acceleration) / 2;
    const double grain = rounding * (1 + std::abs(axis.position) + std::abs(before.position));
    if (!homed && std::abs(dx) > V * dt * (1 + rounding) + grain) return "a jump";
    if (std::abs(axis.velocity) > V * (1 + rounding)) return "too fast";
    if (ride.program.immediate && std::is_same_v<Axis, VirtualAxis>) return "";
    if (std::abs(axis.acceleration) > A * (1 + rounding)) return "accelerates too much";
    if (std::abs(axis.acceleration - before.acceleration) > (J * dt + A) * rounding + J * dt)
        return "a jerk too great";
    if (std::abs(beside_v) > J * dt * dt / 4 + rounding * (1 + V)) return "a step in the velocity";
    if (!homed && std::abs(beside_x) > J * dt * dt * dt / 12 + grain)
        return "a step in the position";
    return "";
}

/// What is wrong with the way that the promise is kept.
template <class Axis>
std::string punctuality(Ride<Axis>& ride) {
    if (!ride.promise.arrived) return "";
    const double late = seconds(ride.time - ride.promise.begun) - ride.promise.duration;
    const bool arrived = ride.promise.arrived(ride.axis);
    if (!(std::abs(late) < 1e18)) return "cannot be planned";
    if (!arrived) return late > 2 * seconds(ride.program.interval) ? "late" : "";
    ride.promise = {};
    if (late < -2e-9) return "too early";
    return late > 2 * seconds(ride.program.interval) ? "late" : "";
}

/// The first thing that goes wrong under the program; empty when nothing does.
template <class Axis>
std::string failure_of(const Program& program) {
    const Limits limits{.acceleration = program.acceleration, .jerk = program.jerk};
    Ride<Axis> ride{
        .program = program, .axis = {}, .promise = {}, .limits = limits, .coming = limits};
    set_up(ride);
    std::size_t next = 0;
    for (std::int64_t i = 0; i < program.scans; ++i) {
        const bool commanded = next < program.commands.size() && program.commands[next].scan == i;
        const Command* command = commanded ? &program.commands[next++] : nullptr;
        const Axis before = ride.axis;
        ride.time = i * program.interval;
        const Scan scan{.time = ride.time, .interval = program.interval, .index = i};
        give(ride, nullptr);
        Axis undisturbed = ride.axis;
        if (command) {
            undisturbed.scan(scan);
            give(ride, command);
        }
        ride.axis.scan(scan);
        std::string failure = judge(ride, undisturbed, command);
        if (failure.empty() && i > 0)
            failure = continuity(ride, before, is_homed(ride.axis, undisturbed));
        ride.limits = ride.coming;
        if (failure.empty()) failure = punctuality(ride);
        if (!failure.empty()) return fmt::format("{} at scan {}", failure, i);
    }
    return "";
}

/// As few of the commands as still fail.
template <class Axis>
Program shrunk(Program program) {
    for (std::size_t i = program.commands.size(); i-- > 0;) {
        Program fewer = program;
        fewer.commands.erase(fewer.commands.begin() + static_cast<std::ptrdiff_t>(i));
        if (!failure_of<Axis>(fewer).empty()) program = fewer;
    }
    return program;
}

std::uint64_t programs() {
    const char* const wanted = std::getenv("LINESHAFT_AXES");
    return wanted == nullptr ? 1000 : std::strtoull(wanted, nullptr, 10);
}

template <class Axis>
void drive() {
    for (std::uint64_t seed = 1; seed <= programs(); ++seed) {
        const Program program = Draw(seed, Axis::type).program();
        if (failure_of<Axis>(program).empty()) continue;
        const Program least = shrunk<Axis>(program);
        FAIL_CHECK(Axis::type << ", seed " << seed << ": " << failure_of<Axis>(least) << "\n"
                              << describe(least));
    }
    SUCCEED();
}

}  // namespace

TEST_CASE("randomly driven virtual axes do not jump, keep their limits and are in time") {
    drive<VirtualAxis>();
}

TEST_CASE("randomly driven gear axes do not jump, keep their limits and are in time") {
    drive<GearAxis>();
}

TEST_CASE("randomly driven moves do not jump, keep their limits and are in time") {
    drive<Move>();
}
