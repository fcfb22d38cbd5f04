#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/axis/cam_table.hpp"
#include "blocks/inputs.hpp"
#include "runtime/model/random.hpp"
#include "tests/blocks/motion/sequences.hpp"
#include "tests/blocks/scanning.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// An axis and a slave with software limits, and a master whose measured position jumps, in tasks
/// of different intervals; each with commands whose pins change at random.
class LimitedAxes {
  public:
    static constexpr double lowest = -20, highest = 60;  ///< [mm], at first
    static constexpr std::int64_t length = 400;          ///< of a program [ms]
    static constexpr std::int64_t patience = 50'000;     ///< until all have come in [ms]

    LimitedAxes() : bench_(program()) {
        for (const Pin& pin : pins_) places_.push_back(bench_.live(pin.name));
        for (const char* name : {"x", "s"}) watched_.push_back({name, &bench_.axis(name)});
    }

    PinChanges draw(std::uint64_t seed) const {
        Random random(seed, "limits");
        PinChanges events;
        for (std::int64_t at = 0; at < length; at += 1 + random.below(12))
            for (std::uint64_t n = 1 + random.below(6); n > 0; --n) {
                const std::size_t pin = random.below(pins_.size());
                const auto& values = pins_[pin].values;
                if (pins_[pin].seldom && random.below(10) != 0) continue;
                events.push_back({at, pin, values[random.below(values.size())]});
            }
        return events;
    }

    /// What goes wrong; empty for nothing.
    std::string run(const PinChanges& events) {
        bench_.restart();
        for (Watched& w : watched_) w = {w.name, w.axis};
        stood_ = false;
        set_all("MC_Power", "Enable", 1);
        auto next = events.begin();
        for (std::int64_t at = 0; at < length + patience; ++at) {
            if (at == length) let_go();
            if (at == length + 50) set_all("MC_Stop", "Execute", 1);
            for (; next != events.end() && next->at <= at; ++next) set(next->pin, next->value);
            if (at > length + 100 && come_in(at)) return {};
            bench_.step();
            for (Watched& w : watched_)
                if (const std::string wrong = check(w); !wrong.empty())
                    return fmt::format("at {} ms, {}: {}", at, w.name, wrong);
        }
        std::string text = "an axis does not come in:";
        for (const Watched& w : watched_)
            text +=
                fmt::format(" {} at {} with {} in {}", w.name, w.axis->position, w.axis->velocity,
                            axis_state_names[static_cast<std::size_t>(w.axis->state)]);
        return text;
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
    /// What an axis showed in its last scan.
    struct Watched {
        std::string name;
        const Axis* axis;
        std::int64_t time = -1;
        double position = 0, velocity = 0, relocated = 0;
        bool limited = false, followed = false, failed = false;
        double most_a = A;  ///< so far, of what was written, too
    };

    static constexpr double A = 2000, J = 1e5;  ///< greatest that are drawn

    static std::vector<double> values_of(std::string_view pin) {
        if (pin == "Position") return {0, 5, 20, 40, 55, 60, -20, 61, 58, 90, -35};
        if (pin == "Distance") return {0, 3, 10, -10, 40, -60, 100};
        if (pin == "Velocity" || pin == "VelocityDiff") return {-1, 100, 50, 200, 5};
        if (pin == "Wanted") return {100, -100, 20, -40, 200, 0};
        if (pin == "EndVelocity") return {0, 10, 50, -20, -80, 100};
        if (pin == "Acceleration" || pin == "Deceleration") return {-1, A, 300, 100};
        if (pin == "Jerk") return {-1, J, 5000, 0};
        if (pin == "Direction") return {0, 1, 2, 3};
        if (pin == "BufferMode") return {0, 0, 0, 1, 2, 3, 4, 5};
        if (pin == "HomingMode") return {0, 1, 2};
        if (pin == "VelFactor") return {1, 0.5, 0};
        if (pin == "AccFactor" || pin == "JerkFactor") return {1, 0.5};
        if (pin == "ParameterNumber") return {2, 3, 4, 5, 9, 13, 15, 17};
        if (pin == "Value") return {-20, 60, 40, -5, 0, 1, 100, 500, 2000, 5e4};
        if (pin == "RatioNumerator") return {1, -1, 2, 0.3};
        if (pin == "MasterSyncPosition") return {20, 50, -40};
        if (pin == "SlaveSyncPosition") return {0, 30, 59, 65};
        if (pin == "MasterStartDistance") return {0, 20};
        if (pin == "Transition") return {0, 1, 2};
        if (pin == "PhaseShift") return {0, 20, -50};
        if (pin == "SlaveScaling") return {1, -1, 3};
        if (pin == "AccelerationScale") return {1, -1, 0.3};
        if (pin == "actual_position") return {0, 10, 50, 55, -60, 400};
        return {0, 1};
    }

    static Type type_of(std::string_view pin) {
        if (pin == "ParameterNumber") return Type::integer;
        for (const char* name :
             {"Direction", "BufferMode", "HomingMode", "Transition", "ExecutionMode"})
            if (pin == name) return Type::enumeration;
        for (const char* name : {"Execute", "Enable", "EnablePositive", "EnableNegative",
                                 "Relative", "ContinuousUpdate", "Signal", "CatchUp"})
            if (pin == name) return Type::boolean;
        return Type::real;
    }

    struct Kind {
        const char *type, *pins;
    };

    static std::span<const Kind> commands() {
        static constexpr Kind table[] = {
            {"MC_MoveAbsolute",
             "Execute Position Velocity Acceleration Deceleration Jerk BufferMode "
             "ContinuousUpdate"},
            {"MC_MoveAbsolute", "Execute Position Deceleration BufferMode"},
            {"MC_MoveRelative", "Execute Distance Velocity Deceleration BufferMode"},
            {"MC_MoveAdditive", "Execute Distance Velocity Jerk BufferMode"},
            {"MC_MoveVelocity", "Execute Wanted Acceleration Deceleration BufferMode Direction"},
            {"MC_MoveContinuousAbsolute", "Execute Position EndVelocity Velocity BufferMode"},
            {"MC_MoveContinuousRelative", "Execute Distance EndVelocity Velocity BufferMode"},
            {"MC_Halt", "Execute Deceleration Jerk BufferMode"},
            {"MC_Stop", "Execute Deceleration Jerk"},
            {"MC_MoveSuperimposed", "Execute Distance VelocityDiff ContinuousUpdate"},
            {"MC_HaltSuperimposed", "Execute Deceleration"},
            {"MC_Home", "Execute Position HomingMode Signal BufferMode"},
            {"MC_SetPosition", "Execute Position Relative ExecutionMode"},
            {"MC_SetOverride", "Enable VelFactor AccFactor JerkFactor"},
            {"MC_WriteParameter", "Execute ParameterNumber Value"},
            {"MC_WriteParameter", "Execute ParameterNumber Value ExecutionMode"},
            {"MC_AccelerationProfile", "Execute AccelerationScale BufferMode"},
            {"MC_MotionInPosition", "Enable Position Wanted Acceleration"},
            {"MC_Reset", "Execute"},
            {"MC_Power", "Enable EnablePositive EnableNegative"}};
        return table;
    }

    static std::span<const Kind> couplings() {
        static constexpr Kind table[] = {
            {"MC_GearIn", "Execute RatioNumerator Transition CatchUp BufferMode"},
            {"MC_GearIn", "Execute RatioNumerator BufferMode"},
            {"MC_GearInPos",
             "Execute MasterSyncPosition SlaveSyncPosition RatioNumerator MasterStartDistance"},
            {"MC_CamIn", "Execute SlaveScaling MasterSyncPosition BufferMode"},
            {"MC_PhasingAbsolute", "Execute PhaseShift"},
            {"MC_GearOut", "Execute"},
            {"MC_MotionInPosition", "Enable Position Wanted Acceleration"},
            {"MC_MoveAbsolute", "Execute Position Deceleration BufferMode"},
            {"MC_Stop", "Execute Deceleration Jerk"},
            {"MC_MoveSuperimposed", "Execute Distance VelocityDiff"},
            {"MC_SetPosition", "Execute Position Relative ExecutionMode"},
            {"MC_WriteParameter", "Execute ParameterNumber Value"},
            {"MC_Reset", "Execute"},
            {"MC_Power", "Enable EnablePositive EnableNegative"}};
        return table;
    }

    std::string program() {
        std::string text = fmt::format(R"(
tasks:
  servo: {{every: 1 ms, priority: 20, cost: 0.3 ms}}
  slow: {{every: 2 ms, priority: 10}}
  main: {{every: 5 ms, priority: 1, cost: 2 ms}}
blocks:
  x: {{type: axis, task: servo, default_jerk: 2e4 mm/s^3, software_limits: true, lowest_position: {0} mm, highest_position: {1} mm}}
  s: {{type: axis, task: slow, default_jerk: 2e4 mm/s^3, software_limits: true, lowest_position: {0} mm, highest_position: {1} mm}}
  m: {{type: axis, task: servo, has_drive: true}}
  jog: {{type: MC_MoveVelocity, task: main, Axis: m}}
  move: {{type: MC_MoveAbsolute, task: main, Axis: m}}
  rename: {{type: MC_SetPosition, task: main, Axis: m, Position: 7 mm}}
  wave: {{type: cam_table, task: main, points: [[0 mm, -20 mm], [50 mm, 60 mm], [100 mm, -20 mm]]}}
  push: {{type: cam_table, task: main, unit: mm/s^2, master_unit: s, points: [[0 s, 0 mm/s^2], [0.1 s, 500 mm/s^2], [0.3 s, -300 mm/s^2], [0.4 s, 0 mm/s^2]]}}
  select: {{type: MC_CamTableSelect, task: main, Master: m, Slave: s, CamTable: wave, Periodic: true, Execute: true}}
)",
                                       lowest, highest);
        add_pins("jog", "Execute Wanted");
        add_pins("move", "Execute Position BufferMode");
        add_pins("rename", "Execute");
        add_pins("m", "actual_position", true);
        std::size_t number = 0;
        const auto add = [&](const Kind& kind, const char* references) {
            constexpr const char* task_names[] = {"servo", "slow", "main"};
            const std::string name = fmt::format("{}_{}", kind.type, number++);
            text += fmt::format("  {}: {{type: {}, task: {}, {}}}\n", name, kind.type,
                                task_names[number % 3], references);
            const std::string_view type = kind.type;
            add_pins(name, kind.pins, type == "MC_Power" || type == "MC_Stop");
        };
        for (const Kind& kind : commands())
            add(kind, std::string_view(kind.type) == "MC_AccelerationProfile"
                          ? "Axis: x, TimeAcceleration: push"
                          : "Axis: x");
        for (const Kind& kind : couplings()) {
            const std::string_view type = kind.type;
            const bool leads = type.starts_with("MC_GearIn") || type.starts_with("MC_Phasing");
            const char* measured = "Master: m, Slave: s, MasterValueSource: mcActualValue";
            add(kind, type == "MC_CamIn"     ? "Master: m, Slave: s, CamTableID: select.CamTableID"
                      : type == "MC_GearIn"  ? (number % 2 == 0 ? measured : "Master: x, Slave: s")
                      : leads                ? "Master: m, Slave: s"
                      : type == "MC_GearOut" ? "Slave: s"
                                             : "Axis: s");
        }
        for (const char* axis : {"x", "s"})
            text += fmt::format(
                "  {0}_in: {{type: MC_MoveAbsolute, task: main, Axis: {0}, "
                "Position: 10 mm, Velocity: 100 mm/s}}\n",
                axis);
        return text;
    }

    void add_pins(const std::string& block, const char* names, bool seldom = false) {
        std::istringstream pins(names);
        for (std::string pin; pins >> pin;)
            pins_.push_back({block + "." + (pin == "Wanted" ? "Velocity" : pin), type_of(pin),
                             values_of(pin), seldom});
    }

    void set(std::size_t pin, double value) {
        const Type type = pins_[pin].type;
        store(type, places_[pin],
              type == Type::boolean ? Value(value != 0)
              : type == Type::real  ? Value(value)
                                    : Value(static_cast<std::int64_t>(value)));
    }

    void set_all(std::string_view beginning, std::string_view ending, double value) {
        for (std::size_t i = 0; i < pins_.size(); ++i)
            if (pins_[i].name.starts_with(beginning) && pins_[i].name.ends_with(ending))
                set(i, value);
    }

    /// No command any more, power, no override.
    void let_go() {
        set_all("", ".Execute", 0);
        for (const char* level : {".Enable", ".EnablePositive", ".EnableNegative", "Factor"})
            set_all("", level, 1);
        set_all("MC_MotionIn", ".Enable", 0);
    }

    /// At the end all axes with limits stand, lose their errors, and go to where they are inside.
    bool come_in(std::int64_t at) {
        if (!stood_) {
            stood_ = std::ranges::all_of(watched_, [](const Watched& w) {
                return !w.axis->software_limits ||
                       (w.axis->velocity == 0 && w.axis->acceleration == 0);
            });
            if (stood_) set_all("MC_Stop", "Execute", 0);
            return false;
        }
        set_all("MC_Reset", "Execute", at % 50 < 25 ? 1 : 0);
        for (Watched& w : watched_)
            if (w.axis->state == AxisState::standstill) bench_.set(w.name + "_in.Execute", true);
        return std::ranges::all_of(watched_, [&](const Watched& w) {
            const Axis& axis = *w.axis;
            const bool is_due =
                axis.software_limits && axis.lowest_position <= 10 && 10 <= axis.highest_position;
            return !is_due || bench_.is(w.name + "_in.Done");
        });
    }

    /// Outside of the limits, where it was put, it may only come nearer.
    static std::string check(Watched& w) {
        const Axis& axis = *w.axis;
        if (axis.scan_time == w.time) return {};
        const Watched last = w;
        const bool steps = axis.sync.coupling.transition != TransitionMode::jerk_limited;
        const bool is_led = axis.led_at > last.time;
        const bool follows = axis.doing == Axis::Doing::following_axes || is_led || steps;
        w = {w.name,
             &axis,
             axis.scan_time,
             axis.position,
             axis.velocity,
             axis.relocated,
             axis.software_limits,
             follows,
             axis.state == AxisState::error_stop,
             std::max({last.most_a, axis.default_acceleration, axis.default_deceleration})};
        if (!all_finite(axis.position, axis.velocity, axis.acceleration, axis.jerk))
            return "a set-point is not finite";
        if (last.time < 0) return {};
        const double before = last.position + (axis.relocated - last.relocated);
        const double low = std::min(axis.lowest_position, before);
        const double high = std::max(axis.highest_position, before);
        if (axis.software_limits && last.limited &&
            !(low <= axis.position && axis.position <= high))
            return fmt::format("{} after {} is outside of {}..{}", axis.position, before, low,
                               high);
        if (follows || last.followed) return {};
        return check_velocity(last, w, before);
    }

    /// The position moves as the velocity says, and an axis whose velocity jumps has an error.
    static std::string check_velocity(const Watched& last, const Watched& now, double before) {
        const double t = seconds(now.time - last.time);
        const double most = now.most_a * t, way = now.position - before;
        if (way < std::min({last.velocity, now.velocity, 0.0}) * t - most * t - 1e-8 ||
            way > std::max({last.velocity, now.velocity, 0.0}) * t + most * t + 1e-8)
            return fmt::format("the way is {} at velocities {} and {}", way, last.velocity,
                               now.velocity);
        if (std::abs(now.velocity - last.velocity) > 2 * most * (1 + 1e-9) + 1e-9 && !last.failed &&
            !now.failed)
            return fmt::format("the velocity jumps from {} to {} in {}", last.velocity,
                               now.velocity,
                               axis_state_names[static_cast<std::size_t>(now.axis->state)]);
        return {};
    }

    std::vector<Pin> pins_;
    MotionBench bench_;
    std::vector<std::byte*> places_;
    std::vector<Watched> watched_;
    bool stood_ = false;
};

}  // namespace

TEST_CASE("a cam that begins as a gear is reached looks for its end in a table of its own") {
    LimitedAxes axes;
    CHECK(axes.run(axes.draw(3907)) == "");
}

/// LINESHAFT_LIMITS makes it longer: tools/long.
TEST_CASE("random programs never lead an axis out of its software limits") {
    const auto begin = static_cast<std::uint64_t>(count_of("LINESHAFT_SEED", 1));
    const auto count = static_cast<std::uint64_t>(count_of("LINESHAFT_LIMITS", 120));
    LimitedAxes axes;
    for (std::uint64_t seed = begin; seed < begin + count; ++seed) {
        const PinChanges events = axes.draw(seed);
        if (axes.run(events).empty()) continue;
        const PinChanges less =
            shrunk(events, [&](const PinChanges& some) { return !axes.run(some).empty(); });
        FAIL(fmt::format("seed {}: {}\n{}", seed, axes.run(less), axes.text(less)));
    }
}
