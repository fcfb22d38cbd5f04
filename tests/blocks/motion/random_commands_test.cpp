#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "tests/blocks/motion/sequences.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr double V = 100, A = 1000, J = 50000;  ///< greatest of all limits that are drawn
constexpr double least_J = 2500;                ///< with the factor of an override

constexpr CommandDraw kinds[] = {
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
    {"MC_Home", "Execute Position HomingMode Signal BufferMode"},
    {"MC_SetPosition", "Execute Position Relative ExecutionMode"},
    {"MC_SetOverride", "Enable VelFactor AccFactor JerkFactor"},
    {"MC_Reset", "Execute"},
    {"MC_Power", "Enable EnablePositive EnableNegative"},
};

constexpr const char* three_tasks[] = {"servo", "interrupt", "main"};

/// One to four axes with a command block of each kind each, in three tasks with costs.
class Rules : public Sequences {
  public:
    explicit Rules(int number)
        : Sequences({.axes = number, .commands = kinds, .tasks = three_tasks, .modulo = true}) {
        for (const NamedCommand& command : commands())
            if (command.type != "MC_Power" && command.type != "MC_SetOverride")
                watched_.push_back({command.name, command.block, {}, {}});
    }

  private:
    struct Watched {
        std::string name;
        const CommandBlock* block;
        std::int64_t ticket = 0;
        Progress ended = Progress::sent;
    };

    void begin() override {
        for (Watched& w : watched_) w = {w.name, w.block, {}, {}};
        before_.clear();
    }

    std::string check() override {
        const std::string wrong = check_outputs();
        return wrong.empty() ? check_motion() : wrong;
    }

    bool ends(std::int64_t after) override {
        if (after == 99) set_all(".Execute", "MC_Reset", 1);
        if (after == 399) set_all(".Execute", "MC_Stop", 1);
        return after > 450 && all_stand();
    }

    bool all_stand() const {
        for (std::size_t i = 0; i < axes(); ++i)
            if (axis(i).velocity != 0 || axis(i).acceleration != 0 ||
                axis(i).state != AxisState::stopping || axis(i).active.told_end == 0)
                return false;
        return true;
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
        for (std::size_t i = 0; i < axes(); ++i) {
            const Axis& axis = this->axis(i);
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

    std::vector<Watched> watched_;
    std::vector<std::pair<MotionState, std::int64_t>> before_;
};

}  // namespace

/// LINESHAFT_SEQUENCES makes it longer: tools/long.
TEST_CASE("random commands to one to four axes break no rule") {
    for (int axes = 1; axes <= 4; ++axes) {
        Rules rules(axes);
        check_sequences(rules, count_of("LINESHAFT_SEQUENCES", 200) / 4,
                        fmt::format("{} axes", axes));
    }
}
