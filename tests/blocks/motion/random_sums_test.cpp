#include <cmath>
#include <deque>
#include <optional>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "tests/blocks/motion/sequences.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr CommandDraw summed_commands[] = {
    {"MC_MoveAbsolute", "Execute Position Velocity BufferMode ContinuousUpdate"},
    {"MC_MoveAbsolute", "Execute Execute Position Velocity Deceleration BufferMode"},
    {"MC_MoveRelative", "Execute Distance Velocity BufferMode ContinuousUpdate"},
    {"MC_MoveRelative", "Execute Execute Distance Acceleration BufferMode"},
    {"MC_MoveAdditive", "Execute Distance Velocity BufferMode"},
    {"MC_MoveVelocity", "Execute Wanted BufferMode"},
    {"MC_MoveContinuousAbsolute", "Execute Position EndVelocity BufferMode"},
    {"MC_MoveContinuousRelative", "Execute Distance EndVelocity Velocity BufferMode"},
    {"MC_Halt", "Execute Deceleration BufferMode"},
    {"MC_MoveSuperimposed", "Execute Execute Distance VelocityDiff ContinuousUpdate"},
    {"MC_MoveSuperimposed", "Execute Distance VelocityDiff Deceleration"},
    {"MC_HaltSuperimposed", "Execute Deceleration"},
    {"MC_SetOverride", "Enable VelFactor VelFactor"},
};
constexpr const char* one_task[] = {"servo"};

/// What an axis does by the commands that it has taken, added up: where it ends when all that is
/// asked for has been covered. It sees what the commands ask and have been told, and where the axis
/// is when one aborts another; what is superimposed it plans itself.
class Ledger {
  public:
    Ledger(const Axis& axis, CommandRules rules)
        : axis_(&axis), keeps_(rules_of(rules).keeps_superimposed) {}

    /// Where the axis will end; empty where it goes on, or where a move has begun between two
    /// scans at a place that is nowhere written.
    std::optional<double> end() const { return end_; }
    /// What has waited is aborted; it may have begun in the same scan, between two.
    void forget() {
        end_ = {};
        moves_ = true;
        goes_on_ = false;
    }
    void stands_at(double position) { end_ = position; }

    /// A command begins and aborts the motion, and what is superimposed.
    void abort_with(const Request& c) {
        const MotionState now = axis_->total();
        using enum Command;
        if (c.command == move_additive && is_discrete() && end_)
            end_ = *end_ - left() + c.position;
        else if (c.command == move_additive && is_discrete())
            end_ = {};
        else if (c.command == halt)
            end_ = stopping_position(now, axis_->dynamics_of(c));
        else
            end_ = is_absolute(c.command) ? c.position : now.position + c.position;
        superimposed_ = {};
        on_top_ = 0;
        go(c);
    }

    /// A command begins where the one before ends, or where a motion that goes on is.
    void follow_with(const Request& c, bool at_once) {
        if (goes_on_ && at_once) end_ = axis_->total().position + left();
        if (goes_on_ && !at_once && !passes_) end_ = {};
        if (c.command == Command::halt && goes_on_)
            end_ = at_once ? std::optional(end_of_halt(c)) : std::nullopt;
        if (is_absolute(c.command))
            end_ = c.position + (keeps_ ? on_top_ : 0);
        else if (end_ && c.command != Command::halt)
            *end_ += c.position;
        superimposed_.counted = superimposed_.exists && is_absolute(c.command) && !keeps_;
        go(c);
    }

    /// It has passed its position: what waits from now on begins elsewhere.
    void passed() { passes_ = false; }
    void done() { moves_ = goes_on_ = false; }

    void change(const Request& from, const Request& to) {
        if (end_) *end_ += to.position - from.position;
    }

    void superimpose(const Request& c) {
        if (!moves_) goes_on_ = false;
        drop(left());
        on_top_ += c.position - left();
        begin_superimposed(c, c.position);
        if (end_) *end_ += c.position;
        superimposed_.counted = false;
    }

    void change_superimposed(const Request& from, const Request& to) {
        const double more = to.position - from.position;
        if (end_ && !is_made_up_for()) *end_ += more;
        on_top_ += more;
        begin_superimposed(to, left() + more);
    }

    void halt_superimposed(const Request& c) {
        if (!superimposed_.exists) return;
        const double left_before = left();
        begin_superimposed(c, 0);
        drop(left_before - left());
        on_top_ -= left_before - left();
    }

    void superimposed_done() { superimposed_.exists = false; }

    void override_changed() {
        if (superimposed_.exists) begin_superimposed(superimposed_.request, left());
        if (axis_->doing != Axis::Doing::moving_to_point && axis_->paused == 0) passed();
    }

  private:
    struct Superimposed {
        bool exists = false, counted = false;
        Request request;
        PointMotion motion;
        double to = 0;
    };

    void go(const Request& c) {
        using enum Command;
        moves_ = true;
        absolute_ = is_absolute(c.command);
        passes_ = c.command == move_continuous_absolute || c.command == move_continuous_relative;
        goes_on_ = passes_ || c.command == move_velocity;
        if (c.command == move_velocity) end_ = {};
    }

    bool is_discrete() const { return !goes_on_ && (moves_ || superimposed_.exists); }
    bool is_made_up_for() const { return superimposed_.counted && moves_ && absolute_; }

    double end_of_halt(const Request& c) const {
        MotionState beneath = axis_->total();
        const MotionState on_top = superimposed_.exists ? state() : MotionState{};
        beneath.velocity -= on_top.velocity;
        beneath.acceleration -= on_top.acceleration;
        return stopping_position(beneath, axis_->dynamics_of(c)) + left();
    }

    void drop(double way) {
        if (end_ && !is_made_up_for()) *end_ -= way;
    }

    MotionState state() const {
        const PointMotion& m = superimposed_.motion;
        return m.plan.at(m.start.until(axis_->scan_time));
    }
    double left() const { return superimposed_.exists ? superimposed_.to - state().position : 0; }

    /// What is superimposed begins here; an override of 0 stops it on its way.
    void begin_superimposed(const Request& c, double left) {
        const MotionState from = superimposed_.exists ? state() : MotionState{};
        Dynamics d = axis_->dynamics_of(c);
        const double speed = axis_->asked_of(c).velocity;
        const bool halts = c.command == Command::halt_superimposed;
        const bool stands = halts || d.velocity == 0;
        if (d.velocity == 0) d.velocity = speed;
        const double stop = stopping_position(from, d);
        superimposed_.to = halts ? stop : from.position + left;
        superimposed_.motion.begin(from, stands ? stop : superimposed_.to, 0, d,
                                   {axis_->scan_time});
        superimposed_.exists = true;
        superimposed_.request = c;
    }

    const Axis* axis_;
    bool keeps_;         ///< absolute moves that wait end further by what has come on top
    double on_top_ = 0;  ///< since the last aborting command, with what is still to come
    std::optional<double> end_ = 0;
    bool moves_ = false, goes_on_ = false, passes_ = false, absolute_ = false;
    Superimposed superimposed_;
};

/// One axis without limits, whose commands come one in a scan.
class Sums : public Sequences {
  public:
    explicit Sums(CommandRules rules)
        : Sequences({.commands = summed_commands,
                     .tasks = one_task,
                     .length = 1500,
                     .patience = 600000,
                     .pause = 2,
                     .at_once = 1,
                     .rules = rules}),
          ledger_(axis(0), rules),
          rules_(rules) {
        for (const NamedCommand& command : commands()) seen_.push_back({command.block, {}, {}, {}});
    }

    std::int64_t judged = 0;

  private:
    struct Seen {
        const CommandBlock* block;
        std::int64_t ticket = 0;
        Request request;
        bool active = false;
    };

    void begin() override {
        ledger_ = Ledger(axis(0), rules_);
        for (Seen& s : seen_) s = {s.block, {}, {}, {}};
        queue_.clear();
        sent_ = nullptr;
    }

    std::string check() override {
        take_queue();
        take_ends();
        if (sent_) take(*sent_);
        sent_ = nullptr;
        take_changes();
        for (Seen& s : seen_)
            if (s.block->job.ticket != s.ticket) {
                s.ticket = s.block->job.ticket;
                s.request = s.block->job.request;
                s.active = false;
                std::erase(queue_, &s);
                sent_ = &s;
            }
        return axis(0).state == AxisState::standstill && queue_.empty() ? judge() : "";
    }

    /// Those that have waited and begin, one behind the other.
    void take_queue() {
        while (!queue_.empty()) {
            Seen& s = *queue_.front();
            const Progress p = s.block->job.progress;
            if (p == Progress::waiting) return;
            queue_.pop_front();
            const Axis::Running& active = axis(0).active;
            const bool anew = s.block->job.ticket != s.ticket;
            if (anew && (active.ticket != s.ticket || active.request != s.request)) continue;
            if (p == Progress::failed) continue;
            if (p == Progress::aborted) ledger_.forget();
            if (p == Progress::aborted) continue;
            ledger_.follow_with(s.request, false);
            for (Seen& other : seen_)
                if (is_move(other)) other.active = false;
            s.active = true;
        }
    }

    void take_ends() {
        for (Seen& s : seen_) {
            if (s.active && s.block->job.progress == Progress::reached) ledger_.passed();
            if (!s.active || !is_end(s.block->job.progress)) continue;
            s.active = false;
            if (s.block->job.progress != Progress::done) continue;
            if (is_superimposed(s.request.command))
                ledger_.superimposed_done();
            else
                ledger_.done();
        }
    }

    void take(Seen& s) {
        const Progress p = s.block->job.progress;
        const Request& c = s.request;
        if (p == Progress::failed || p == Progress::sent) return;
        if (p == Progress::waiting) return queue_.push_back(&s);
        if (c.command == Command::set_override) return ledger_.override_changed();
        if (c.command == Command::halt_superimposed) {
            ledger_.halt_superimposed(c);
        } else if (c.command == Command::move_superimposed) {
            ledger_.superimpose(c);
        } else if (c.mode == BufferMode::aborting) {
            ledger_.abort_with(c);
            queue_.clear();
        } else {
            ledger_.follow_with(c, true);
        }
        for (Seen& other : seen_)
            if (is_superimposed(other.request.command) == is_superimposed(c.command) ||
                (c.mode == BufferMode::aborting && !is_superimposed(c.command)))
                other.active = false;
        s.active = !is_end(p);
        if (p != Progress::done) return;
        if (is_superimposed(c.command))
            ledger_.superimposed_done();
        else
            ledger_.done();
    }

    /// Continuous update, as far as the axis has taken it.
    void take_changes() {
        for (Seen& s : seen_) {
            const Axis& x = axis(0);
            const bool on_top = is_superimposed(s.request.command);
            const Request& in_force = on_top ? x.added.request : x.active.request;
            if (!s.active || in_force.command != s.request.command || in_force == s.request)
                continue;
            if (s.block->job.request != in_force) continue;
            if (on_top)
                ledger_.change_superimposed(s.request, in_force);
            else
                ledger_.change(s.request, in_force);
            s.request = in_force;
        }
    }

    static bool is_move(const Seen& s) { return !is_superimposed(s.request.command); }

    /// What goes on is halted, without blending: SoftMotion refuses that.
    bool ends(std::int64_t) override {
        const Axis& x = axis(0);
        const bool holds = x.state == AxisState::continuous_motion && x.active.exists() &&
                           x.doing == Axis::Doing::holding && queue_.empty() && !x.added.exists();
        if (holds) {
            set_all(".BufferMode", "MC_Halt_", static_cast<double>(BufferMode::buffered));
            set_all(".Execute", "MC_Halt_", 1);
        }
        return x.state == AxisState::standstill && queue_.empty() && !sent_;
    }

    std::string judge() {
        const double at = axis(0).total().position, wanted = ledger_.end().value_or(at);
        if (ledger_.end()) ++judged;
        ledger_.stands_at(at);
        if (std::abs(at - wanted) <= 1e-9) return {};
        return fmt::format("it stands at {}, and what was asked for ends at {}", at, wanted);
    }

    Ledger ledger_;
    CommandRules rules_;
    std::vector<Seen> seen_;
    std::deque<Seen*> queue_;
    Seen* sent_ = nullptr;
};

}  // namespace

/// LINESHAFT_SUMS makes it longer: tools/long.
TEST_CASE("random sums: an axis ends where the ways lead that were asked for and covered") {
    for (const CommandRules rules : {CommandRules::plcopen, CommandRules::softmotion}) {
        Sums sums(rules);
        const std::int64_t count = count_of("LINESHAFT_SUMS", 100);
        check_sequences(sums, count, command_rules_names[static_cast<std::size_t>(rules)]);
        CHECK(sums.judged >= count);
    }
}
