#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/group/axes_group.hpp"
#include "runtime/model/random.hpp"
#include "tests/blocks/motion/sequences.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// A group whose commands come from two tasks at random, and its axes, which also get commands and
/// lose their power. No axis leaves its limits in any scan; in the end the group moves once more.
class RandomGroup {
  public:
    static constexpr std::int64_t length = 600, patience = 20'000;  ///< [ms]

    RandomGroup() : bench_(program()) {
        for (const Pin& pin : pins_) places_.push_back(bench_.live(pin.name));
    }

    PinChanges draw(std::uint64_t seed) const {
        lineshaft::Random random(seed, "groups");
        PinChanges events;
        for (std::int64_t at = 20; at < length;
             at += 1 + static_cast<std::int64_t>(random.below(15)))
            for (std::uint64_t n = 1 + random.below(6); n > 0; --n) {
                const std::size_t pin = random.below(pins_.size());
                const Pin& drawn = pins_[pin];
                if (drawn.seldom && random.below(8) != 0) continue;
                events.push_back({at, pin, drawn.values[random.below(drawn.values.size())]});
            }
        return events;
    }

    /// What goes wrong; empty for nothing.
    std::string run(const PinChanges& events) {
        bench_.restart();
        for (Last& last : last_) last = {};
        auto next = events.begin();
        for (std::int64_t at = 0; at < length + patience; ++at) {
            for (; next != events.end() && next->at <= at; ++next) set(next->pin, next->value);
            if (at == length / 2) bench_.resume(bench_.checkpoint(), at);
            if (at > length && ends(at - length)) return {};
            bench_.step();
            if (const std::string wrong = check(); !wrong.empty())
                return fmt::format("at {} ms: {}", at, wrong);
        }
        const auto& group = bench_.block<AxesGroup>("group");
        return fmt::format("it does not end: group in {}, {} mm along",
                           group_state_names[static_cast<std::size_t>(group.state)],
                           group.distance);
    }

    std::string text(const PinChanges& events) const {
        std::string text;
        for (const PinChange& e : events)
            text += fmt::format("  {:4} ms  {} = {}\n", e.at, pins_[e.pin].name, e.value);
        return text;
    }

  private:
    struct Pin {
        std::string name;
        Type type;
        std::vector<double> values;  ///< drawn from
        bool seldom = false;
    };
    struct Last {
        bool known = false;
        double position = 0, velocity = 0, acceleration = 0;
    };
    struct Kind {
        const char *name, *type, *pins;
        bool seldom = false;
    };

    static constexpr const char* names_[] = {"x", "y", "turn"};
    static constexpr double V[] = {80, 40, 120}, A[] = {800, 600, 900}, J[] = {2e4, 1e4, 3e4};

    static std::vector<double> values_of(std::string_view pin) {
        if (pin.starts_with("Position") || pin.starts_with("EndPoint"))
            return {0, 5, 10, 25, -10, -30, 40, 61};
        if (pin.starts_with("Distance")) return {0, 3, 10, -10, 30};
        if (pin.starts_with("AuxPoint")) return {0, 5, 12, -20, 30};
        if (pin == "Velocity") return {-1, 100, 20, 1};
        if (pin == "Acceleration" || pin == "Deceleration") return {-1, 2000, 300};
        if (pin == "Jerk") return {-1, 1e5, 3000};
        if (pin == "BufferMode") return {0, 1, 1, 2, 3, 4, 5};
        if (pin == "TransitionMode") return {0, 1, 2, 3};
        if (pin == "TransitionParameter") return {0, 0.1, 1, 8, 40};
        if (pin == "CircMode") return {0, 1, 2};
        if (pin == "VelFactor") return {1, 0.5, 0, 2};
        return {0, 1};
    }

    static Type type_of(std::string_view pin) {
        for (const char* name : {"BufferMode", "TransitionMode", "CircMode", "PathChoice"})
            if (pin == name) return Type::enumeration;
        return pin == "Execute" || pin == "Enable" || pin == "FreesGroup" ? Type::boolean
                                                                          : Type::real;
    }

    static std::span<const Kind> commands() {
        static constexpr Kind table[] = {
            {"line", "MC_MoveLinearAbsolute",
             "Execute Execute Position1 Position2 Position4 Velocity BufferMode TransitionMode "
             "TransitionParameter"},
            {"next", "MC_MoveLinearAbsolute",
             "Execute Execute Position1 Position2 Acceleration Jerk BufferMode TransitionMode "
             "TransitionParameter"},
            {"way", "MC_MoveLinearRelative",
             "Execute Execute Distance1 Distance2 Velocity BufferMode TransitionMode "
             "TransitionParameter"},
            {"circle", "MC_MoveCircularAbsolute",
             "Execute Execute CircMode AuxPoint1 AuxPoint2 EndPoint1 EndPoint2 EndPoint4 "
             "PathChoice BufferMode Velocity"},
            {"arc", "MC_MoveCircularRelative",
             "Execute Execute CircMode AuxPoint1 AuxPoint3 EndPoint1 EndPoint2 PathChoice "
             "BufferMode"},
            {"direct", "MC_MoveDirectAbsolute",
             "Execute Position1 Position2 Position4 BufferMode TransitionMode "
             "TransitionParameter"},
            {"path", "MC_MovePath",
             "Execute BufferMode TransitionMode TransitionParameter Velocity"},
            {"interrupt", "MC_GroupInterrupt", "Execute Execute FreesGroup"},
            {"go_on", "MC_GroupContinue", "Execute"},
            {"override", "MC_GroupSetOverride", "Enable VelFactor"},
            {"halt", "MC_GroupHalt", "Execute", true},
            {"stop", "MC_GroupStop", "Execute", true},
            {"disable", "MC_GroupDisable", "Execute", true},
            {"enable", "MC_GroupEnable", "Execute", true},
            {"reset", "MC_GroupReset", "Execute", true},
            {"remove", "MC_RemoveAxisFromGroup", "Execute", true},
            {"add_x", "MC_AddAxisToGroup", "Execute", true}};
        return table;
    }

    std::string program() {
        std::string text =
            fmt::format(R"(
tasks:
  servo: {{every: 1 ms, priority: 20, cost: 0.2 ms}}
  main: {{every: 3 ms, priority: 1, cost: 1 ms}}
blocks:
  x: {{type: axis, task: servo, software_limits: true, lowest_position: -40 mm, highest_position: 60 mm, default_velocity: {} mm/s, default_acceleration: {} mm/s^2, default_deceleration: {} mm/s^2, default_jerk: {} mm/s^3}}
  group: {{type: axes_group, task: servo, default_velocity: 60 mm/s, default_acceleration: 700 mm/s^2, default_jerk: 9000 mm/s^3}}
  y: {{type: axis, task: servo, default_velocity: {} mm/s, default_acceleration: {} mm/s^2, default_deceleration: {} mm/s^2, default_jerk: {} mm/s^3}}
  turn: {{type: axis, task: servo, unit: deg, modulo: true, period: 50 deg, default_velocity: {} deg/s, default_acceleration: {} deg/s^2, default_deceleration: {} deg/s^2, default_jerk: {} deg/s^3}}
  points: {{type: path_table, task: main, points: [[5 mm, 5 mm], [10 mm, 5 mm], [10 mm, 15 mm], [11 mm, 30 mm, 0 mm, spline], [2 mm, 25 mm, 0 mm, spline], [0 mm, 18 mm, 0 mm, cubic], [6 mm, 12 mm, 0 mm, cubic], [-4 mm, 2 mm, 0 mm, cubic], [-4 mm, 8 mm]]}}
  add_y: {{type: MC_AddAxisToGroup, task: servo, AxesGroup: group, Axis: y, IdentInGroup: 2, Execute: true}}
  add_turn: {{type: MC_AddAxisToGroup, task: servo, AxesGroup: group, Axis: turn, IdentInGroup: 4, Execute: add_y.Done}}
  last: {{type: MC_MoveLinearAbsolute, task: main, AxesGroup: group, Position1: 7 mm, Position2: -3 mm, Position4: 11 deg}}
  power: {{type: MC_Power, task: main, Axis: y, Enable: true}}
  own: {{type: MC_MoveAbsolute, task: main, Axis: x, Position: 20 mm}}
)",
                        V[0], A[0], A[0], J[0], V[1], A[1], A[1], J[1], V[2], A[2], A[2], J[2]);
        int count = 0;
        for (const Kind& kind : commands()) {
            std::string more;
            if (kind.name == std::string_view("path")) more = ", PathData: points";
            if (kind.name == std::string_view("add_x")) more = ", Axis: x, IdentInGroup: 1";
            if (kind.name == std::string_view("enable")) more = ", Execute: true";
            text += fmt::format("  {}: {{type: {}, task: {}, AxesGroup: group{}}}\n", kind.name,
                                kind.type, count++ % 2 == 0 ? "servo" : "main", more);
            std::istringstream pins(kind.pins);
            for (std::string pin; pins >> pin;)
                pins_.push_back({fmt::format("{}.{}", kind.name, pin), type_of(pin), values_of(pin),
                                 kind.seldom});
        }
        pins_.push_back({"power.Enable", Type::boolean, {0, 1, 1}, true});
        pins_.push_back({"own.Execute", Type::boolean, {0, 1}, true});
        return text;
    }

    void set(std::size_t pin, double value) {
        const Type type = pins_[pin].type;
        Value to = value;
        if (type == Type::boolean) to = value != 0;
        if (type == Type::enumeration) to = static_cast<std::int64_t>(value);
        store(type, places_[pin], to);
    }

    /// Every axis within its limits, and moved as its velocity and acceleration say.
    std::string check() {
        constexpr double dt = 1e-3, more = 1 + 1e-9;
        for (std::size_t i = 0; i < 3; ++i) {
            const Axis& axis = bench_.axis(names_[i]);
            Last& last = last_[i];
            const double position = axis.total().position;
            const auto wrong = [&](const char* what, double is, double most) {
                return fmt::format("{}: {} of {} where {} is the most", names_[i], what, is, most);
            };
            if (!(std::abs(axis.velocity) <= V[i] * more))
                return wrong("velocity", axis.velocity, V[i]);
            if (!(std::abs(axis.acceleration) <= A[i] * more))
                return wrong("acceleration", axis.acceleration, A[i]);
            if (!(std::abs(axis.jerk) <= J[i] * more)) return wrong("jerk", axis.jerk, J[i]);
            if (i == 0 && !(axis.position >= -40 && axis.position <= 60))
                return wrong("position", axis.position, 60);
            if (last.known) {
                const double way = position - last.position;
                const double straight = 0.5 * (last.velocity + axis.velocity) * dt;
                if (!(std::abs(way - straight) <= J[i] * dt * dt * dt + 1e-9))
                    return wrong("way in a scan", way, straight);
                if (!(std::abs(axis.velocity - last.velocity) <= A[i] * dt * more))
                    return wrong("change of velocity", axis.velocity - last.velocity, A[i] * dt);
                if (!(std::abs(axis.acceleration - last.acceleration) <= J[i] * dt * more + 1e-6))
                    return wrong("change of acceleration", axis.acceleration - last.acceleration,
                                 J[i] * dt);
            }
            last = {true, position, axis.velocity, axis.acceleration};
        }
        return {};
    }

    /// Lets all go, brings the group to standby, and moves it once more.
    bool ends(std::int64_t after) {
        const auto put = [&](const char* pin, double value) {
            for (std::size_t i = 0; i < pins_.size(); ++i)
                if (pins_[i].name == pin) set(i, value);
        };
        if (after == 1)
            for (std::size_t i = 0; i < pins_.size(); ++i) {
                if (pins_[i].name.ends_with(".Execute")) set(i, 0);
                if (pins_[i].name == "power.Enable") set(i, 1);
            }
        if (after == 10) put("override.VelFactor", 1), put("override.Enable", 0);
        if (after == 20) put("override.Enable", 1), put("halt.Execute", 1);
        if (after == 4000) put("reset.Execute", 1), put("add_x.Execute", 1);
        if (after == 5000) put("enable.Execute", 1);
        if (after == 5020) bench_.set("last.Execute", true);
        if (after < 5030) return false;
        if (!bench_.is("last.Done")) return false;
        REQUIRE(bench_.number("x.position") == 7);
        REQUIRE(bench_.number("y.position") == -3);
        REQUIRE(bench_.number("turn.position") == 11);
        bench_.set("last.Execute", false);
        return true;
    }

    std::vector<Pin> pins_;
    MotionBench bench_;
    std::vector<std::byte*> places_;
    Last last_[3];
};

}  // namespace

/// LINESHAFT_GROUPS makes it longer: tools/long.
TEST_CASE("random groups never lead their axes out of their limits") {
    const auto begin = static_cast<std::uint64_t>(count_of("LINESHAFT_SEED", 1));
    const auto count = static_cast<std::uint64_t>(count_of("LINESHAFT_GROUPS", 15));
    RandomGroup group;
    for (std::uint64_t seed = begin; seed < begin + count; ++seed) {
        const PinChanges events = group.draw(seed);
        if (group.run(events).empty()) continue;
        const PinChanges less =
            shrunk(events, [&](const PinChanges& some) { return !group.run(some).empty(); });
        FAIL(fmt::format("seed {}: {}\n{}", seed, group.run(less), group.text(less)));
    }
}
