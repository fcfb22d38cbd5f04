#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/motion/moves.hpp"
#include "runtime/model/random.hpp"
#include "tests/blocks/motion/bench.hpp"
#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// A pin is set before an instant.
struct Event {
    std::int64_t at = 0;  ///< [ms]
    std::size_t pin = 0;
    double value = 0;
};
using Events = std::vector<Event>;

struct Pin {
    std::string name;
    Type type;
    std::vector<double> values;  ///< drawn from
};

constexpr double V = 100, A = 1000, J = 50000;  ///< greatest of all limits that are drawn
constexpr double least_J = 2500;                ///< with the factor of an override
constexpr std::int64_t length = 400;            ///< of a sequence [ms]
constexpr std::int64_t patience = 8000;         ///< until all stand, afterwards [ms]

struct Kind {
    const char *type, *pins;
};

constexpr Kind kinds[] = {
    {"MC_MoveAbsolute",
     "Execute Position Velocity Acceleration Deceleration Jerk Direction "
     "BufferMode ContinuousUpdate"},
    {"MC_MoveAbsolute", "Execute Position Velocity BufferMode"},
    {"MC_MoveRelative", "Execute Distance Velocity Deceleration BufferMode ContinuousUpdate"},
    {"MC_MoveAdditive", "Execute Distance Velocity Jerk BufferMode"},
    {"MC_MoveVelocity", "Execute Wanted Acceleration BufferMode Direction ContinuousUpdate"},
    {"MC_MoveContinuousAbsolute", "Execute Position EndVelocity Velocity BufferMode"},
    {"MC_MoveContinuousRelative", "Execute Distance EndVelocity Velocity BufferMode"},
    {"MC_Halt", "Execute Deceleration BufferMode"},
    {"MC_Stop", "Execute Deceleration Jerk"},
    {"MC_MoveSuperimposed", "Execute Distance VelocityDiff ContinuousUpdate"},
    {"MC_HaltSuperimposed", "Execute Deceleration"},
    {"MC_Home", "Execute Position HomingMode Signal"},
    {"MC_SetPosition", "Execute Position Relative"},
    {"MC_SetOverride", "Enable VelFactor AccFactor JerkFactor"},
    {"MC_Reset", "Execute"},
    {"MC_Power", "Enable"},
};

/// What a pin may be; `Wanted` is the Velocity of MC_MoveVelocity.
std::vector<double> values_of(std::string_view pin) {
    if (pin == "Position") return {0, 1, 5, 20, 40, -30, 350};
    if (pin == "Distance") return {0, 0.001, 3, 10, -10, 40, -60};
    if (pin == "Velocity" || pin == "VelocityDiff") return {-1, V, 50, 20, 5};
    if (pin == "Wanted") return {V, -V, 20, -40, 0};
    if (pin == "EndVelocity") return {0, 10, 50, -20};
    if (pin == "Acceleration" || pin == "Deceleration") return {-1, A, 300, 100};
    if (pin == "Jerk") return {-1, J, 5000};
    if (pin == "Direction") return {0, 1, 2, 3};
    if (pin == "BufferMode") return {0, 0, 0, 1, 2, 3, 4, 5};
    if (pin == "HomingMode") return {0, 1, 2};
    if (pin == "VelFactor") return {1, 0.5, 0};
    if (pin == "AccFactor" || pin == "JerkFactor") return {1, 0.5};
    return {0, 1};
}

Type type_of(std::string_view pin) {
    if (pin == "Direction" || pin == "BufferMode" || pin == "HomingMode") return Type::enumeration;
    return values_of(pin).size() == 2 && values_of(pin)[1] == 1 && !pin.ends_with("Factor")
               ? Type::boolean
               : Type::real;
}

/// One to four axes with a command block of each kind each, in three tasks with costs.
class Sequences {
  public:
    explicit Sequences(int axes) : axes_(axes), bench_(program()) {
        for (const Pin& pin : pins_) places_.push_back(bench_.live(pin.name));
        for (const std::string& name : commands_)
            watched_.push_back({name, &bench_.block<CommandBlock>(name), {}, {}});
        for (int i = 0; i < axes; ++i) axis_.push_back(&bench_.axis(fmt::format("x{}", i)));
    }

    Events draw(std::uint64_t seed) const {
        Random random(seed, "commands");
        const auto any = [&](std::size_t n) { return random.next() % n; };
        Events events;
        for (std::int64_t at = 0; at < length; at += static_cast<std::int64_t>(1 + any(12)))
            for (std::size_t n = 1 + any(6); n > 0; --n) {
                const std::size_t pin = any(pins_.size());
                const auto& values = pins_[pin].values;
                const bool is_power = pins_[pin].name.starts_with("MC_Power");
                const bool holds = pins_[pin].name.starts_with("MC_Stop") && any(3) != 0;
                if ((is_power && any(20) != 0) || holds) continue;
                events.push_back({at, pin, values[any(values.size())]});
            }
        return events;
    }

    /// What goes wrong; empty for nothing.
    std::string run(const Events& events) {
        bench_.restart();
        for (Watched& w : watched_) w = {w.name, w.block, {}, {}};
        before_.clear();
        for (const std::size_t pin : powers_) set(pin, 1);
        auto next = events.begin();
        for (std::int64_t at = 0; at < length + patience; ++at) {
            if (at == length) let_go();
            if (at == length + 100) set_all(".Execute", "MC_Reset", 1);
            if (at == length + 400) set_all(".Execute", "MC_Stop", 1);
            for (; next != events.end() && next->at <= at; ++next) set(next->pin, next->value);
            bench_.step();
            std::string wrong = check_outputs();
            if (wrong.empty()) wrong = check_motion();
            if (!wrong.empty()) return fmt::format("at {} ms: {}", at, wrong);
            if (at > length + 450 && all_stand()) return {};
        }
        return "it does not end";
    }

    Events shrunk(Events events) {
        for (std::size_t size = events.size() / 2; size > 0; size /= 2)
            for (std::size_t i = 0; i + size <= events.size();) {
                Events less = events;
                const auto first = less.begin() + static_cast<std::ptrdiff_t>(i);
                less.erase(first, first + static_cast<std::ptrdiff_t>(size));
                if (run(less).empty())
                    i += size;
                else
                    events = std::move(less);
            }
        return events;
    }

    std::string text(const Events& events) const {
        std::string text;
        for (const Event& e : events)
            text += fmt::format("  {:4} ms  {} = {}\n", e.at, pins_[e.pin].name, e.value);
        return text;
    }

  private:
    struct Watched {
        std::string name;
        const CommandBlock* block;
        std::int64_t ticket = 0;
        Progress ended = Progress::sent;
    };

    std::string program() {
        std::string text =
            "tasks:\n"
            "  servo: {every: 1 ms, priority: 20, cost: 0.3 ms}\n"
            "  interrupt: {every: 2 ms, priority: 10}\n"
            "  main: {every: 5 ms, priority: 1, cost: 2 ms}\n"
            "blocks:\n";
        constexpr const char* tasks[] = {"servo", "interrupt", "main"};
        std::size_t number = 0;
        for (int i = 0; i < axes_; ++i) {
            const bool modulo = i % 2 == 1;
            text += fmt::format(
                "  x{}: {{type: axis, task: servo, unit: {}, default_jerk: 2e4 {}/s^3}}\n", i,
                modulo ? "deg, modulo: true, period: 360 deg" : "mm", modulo ? "deg" : "mm");
            for (const Kind& kind : kinds) {
                const std::string name = fmt::format("{}_{}", kind.type, number++);
                text += fmt::format("  {}: {{type: {}, task: {}, Axis: x{}}}\n", name, kind.type,
                                    tasks[number % 3], i);
                add_pins(name, kind);
            }
        }
        return text;
    }

    void add_pins(const std::string& name, const Kind& kind) {
        const std::string_view type = kind.type;
        if (type != "MC_Power" && type != "MC_SetOverride") commands_.push_back(name);
        std::istringstream pins(kind.pins);
        for (std::string pin; pins >> pin;) {
            if (type == "MC_Power") powers_.push_back(pins_.size());
            pins_.push_back(
                {name + "." + (pin == "Wanted" ? "Velocity" : pin), type_of(pin), values_of(pin)});
        }
    }

    void set(std::size_t pin, double value) {
        const Type type = pins_[pin].type;
        store(type, places_[pin],
              type == Type::boolean ? Value(value != 0)
              : type == Type::real  ? Value(value)
                                    : Value(static_cast<std::int64_t>(value)));
    }

    void set_all(std::string_view ending, std::string_view beginning, double value) {
        for (std::size_t i = 0; i < pins_.size(); ++i)
            if (pins_[i].name.ends_with(ending) && pins_[i].name.starts_with(beginning))
                set(i, value);
    }

    /// No command any more, power, no override.
    void let_go() {
        set_all(".Execute", "", 0);
        set_all(".Enable", "", 1);
        set_all("Factor", "", 1);
    }

    bool all_stand() const {
        return std::ranges::all_of(axis_, [](const Axis* axis) {
            return axis->velocity == 0 && axis->acceleration == 0 &&
                   axis->state == AxisState::stopping && axis->active.told_end != 0;
        });
    }

    std::string check_outputs() {
        for (Watched& w : watched_) {
            const CommandBlock& b = *w.block;
            if (b.done + b.busy + b.command_aborted + b.error > 1)
                return w.name + ": outputs that exclude each other";
            if (b.active && !b.busy) return w.name + ": active and not busy";
            if (b.error != (b.error_id != MotionError::none))
                return w.name + ": ErrorID does not go with Error";
            if (w.ticket != b.job.ticket) w = {w.name, w.block, b.job.ticket, Progress::sent};
            if (is_end(w.ended) && b.job.progress != w.ended)
                return w.name + ": a job that has ended goes on";
            w.ended = b.job.progress;
        }
        return {};
    }

    /// Each phase of each motion keeps the limits, or what it was begun with and comes back from;
    /// from scan to scan nothing jumps.
    std::string check_motion() {
        constexpr double s = 1e-3, slack = 1 + 1e-9;
        std::string wrong;
        for (std::size_t i = 0; i < axis_.size(); ++i) {
            const Axis& axis = *axis_[i];
            const MotionState now = axis.total();
            if (before_.size() <= i) before_.push_back({now, axis.renamed});
            const auto [old, renamed] = before_[i];
            before_[i] = {now, axis.renamed};
            const double most_v = std::max(std::abs(old.velocity), std::abs(now.velocity));
            const double way = std::abs(now.position - old.position);
            if (std::abs(now.acceleration) > 2 * A * slack) wrong = "acceleration";
            if (std::abs(now.jerk) > 2 * J * slack) wrong = "jerk";
            if (renamed == axis.renamed && way > (most_v + A * s) * s * slack + 1e-9)
                wrong = fmt::format("the position jumps from {} to {}", old.position, now.position);
            if (std::abs(now.velocity - old.velocity) > 2 * A * s * slack + 1e-9)
                wrong = fmt::format("the velocity jumps from {} to {}", old.velocity, now.velocity);
            if (std::abs(now.acceleration - old.acceleration) > 2 * J * s * slack + 1e-6)
                wrong = fmt::format("the acceleration jumps from {} to {}", old.acceleration,
                                    now.acceleration);
            if (wrong.empty()) wrong = check_phases(axis);
            if (!wrong.empty()) return fmt::format("x{}: {}", i, wrong);
        }
        return {};
    }

    static std::string check_phases(const Axis& axis) {
        std::string wrong;
        if (axis.doing == Axis::Doing::moving_to_point)
            wrong = check_phases(axis.point_motion.plan.phases, axis.point_motion.plan.count);
        else if (axis.doing == Axis::Doing::following_velocity)
            wrong = check_phases(axis.velocity_motion.ramp.phases,
                                 static_cast<std::size_t>(axis.velocity_motion.ramp.count));
        if (wrong.empty() && axis.added.exists())
            wrong = check_phases(axis.added_motion.plan.phases, axis.added_motion.plan.count);
        return wrong;
    }

    /// In closed form: a velocity is greatest where the acceleration passes zero.
    template <class Phases>
    static std::string check_phases(const Phases& phases, std::size_t count) {
        if (count == 0) return {};
        const MotionState& first = phases[0].start;
        const double least_v =
            std::abs(first.velocity) + first.acceleration * first.acceleration / (2 * least_J);
        const double most_v = std::max(V, least_v) * (1 + 1e-9);
        const double most_a = std::max(A, std::abs(first.acceleration)) * (1 + 1e-9);
        for (std::size_t i = 0; i < count; ++i) {
            const MotionState& s = phases[i].start;
            const double turn = s.jerk != 0 ? -s.acceleration / s.jerk : 0;
            const double at = std::clamp(turn, 0.0, phases[i].duration);
            for (const double t : {0.0, at, phases[i].duration}) {
                const MotionState state = s.after(t);
                if (std::abs(state.velocity) > most_v)
                    return fmt::format("a plan has velocity {}", state.velocity);
                if (std::abs(state.acceleration) > most_a)
                    return fmt::format("a plan has acceleration {}", state.acceleration);
                if (std::abs(state.jerk) > J * (1 + 1e-9))
                    return fmt::format("a plan has jerk {}", state.jerk);
            }
        }
        return {};
    }

    int axes_;
    std::vector<Pin> pins_;
    std::vector<std::size_t> powers_;
    std::vector<std::string> commands_;
    MotionBench bench_;
    std::vector<std::byte*> places_;
    std::vector<Watched> watched_;
    std::vector<const Axis*> axis_;
    std::vector<std::pair<MotionState, std::int64_t>> before_;
};

}  // namespace

/// LINESHAFT_SEQUENCES makes it longer: tools/long.
TEST_CASE("random commands to one to four axes break no rule") {
    const char* wanted = std::getenv("LINESHAFT_SEQUENCES");
    const std::int64_t count = wanted ? std::atoll(wanted) : 200;
    for (int axes = 1; axes <= 4; ++axes) {
        Sequences sequences(axes);
        for (std::int64_t seed = 1; seed <= count / 4; ++seed) {
            const Events events = sequences.draw(static_cast<std::uint64_t>(seed));
            if (sequences.run(events).empty()) continue;
            const Events less = sequences.shrunk(events);
            FAIL(fmt::format("{} axes, seed {}: {}\n{}", axes, seed, sequences.run(less),
                             sequences.text(less)));
        }
    }
}
