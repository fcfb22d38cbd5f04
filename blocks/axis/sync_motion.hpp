#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "blocks/axis/axis_motion.hpp"
#include "blocks/axis/coupling.hpp"
#include "blocks/profile/cam.hpp"
#include "blocks/profile/curve.hpp"
#include "blocks/profile/forecast.hpp"
#include "blocks/profile/stepped_transition.hpp"
#include "blocks/profile/timed_motion.hpp"
#include "blocks/profile/transition.hpp"

namespace lineshaft {

/// Positions that have been added to others are rounded so much.
inline constexpr double sum_rounding = 0x1p-40;

/// Limits upwards and downwards, of dynamics that say where the speed grows and where it falls.
TransitionLimits limits_towards(double direction, const Dynamics& dynamics);

/// Where a slave is to be on its law, if the master moves as foreseen.
struct Meeting {
    double time = 0;  ///< from the start of the approach [s]; infinite: the master does not come
    MotionState state;

    bool agrees(const Meeting& other) const;
};

/// A motion that follows one master or two. Positions of masters are those that no MC_SetPosition
/// has moved: [m]; the slave's are its own: [u].
///
/// `geared`: the slave gets on the way of its guide, ratio x master, wherever it then is.
/// `positioned` and `cammed`: it follows a law, slave over master, which it joins at `sync_x`: by a
/// SyncCurve over the master, as long as that keeps the limits and does not turn round, else by a
/// TimedMotion to where they will meet, planned anew whenever that changes. A slave whose master
/// does not come any more waits in rest. One that stands and has no start_distance, and would turn
/// round far beyond both ends of its way, stays there until a shorter curve is enough.
struct SyncMotion {
    enum class Law : std::int64_t { geared, positioned, cammed };
    enum class Stage : std::int64_t {
        waiting,        ///< for the master to come near
        approaching,    ///< on its way to the law
        in_transition,  ///< onto the guide
        in_sync,
    };

    static constexpr std::string_view stage_names[] = {"waiting", "approaching", "in_transition",
                                                       "in_sync"};

    /// How it approaches its law.
    enum class Way : std::int64_t { curve, timed, rest };

    Law law = Law::geared;
    Stage stage = Stage::in_sync;
    std::int64_t reached = 0;  ///< the command has been told of in_sync
    Coupling coupling;
    Dynamics dynamics;

    // `geared` alone uses these.
    Moment start;
    Transition transition;
    std::int64_t in_steps = 0;    ///< of the axis' transition_quantum, not by `transition`
    std::int64_t steps_left = 0;  ///< behind the one that began at `start`
    MotionState step;             ///< at its start; its acceleration lasts for the step
    double offset = 0;            ///< of the slave from its guide
    double goal_offset = 0;       ///< the one that is caught up

    // A law has these.
    double direction = 1;  ///< of the master, on its way to sync_x
    double sync_x = 0, sync_y = 0;
    double cam_origin = 0;            ///< the cam's x is scaling * master + cam_origin
    double cam_rise = 0;              ///< the slave is scaling * cam(x) + cam_rise
    double last_periods = 0;          ///< of the cam, when it was looked at last
    std::int64_t period_is_open = 0;  ///< at the seam of two, until the master moves
    std::int64_t ends_at =
        0;  ///< of a cam that is not periodic: 1 its end, -1 its beginning, 0 both
    std::int64_t finished = 0;  ///< it has been executed

    // An approach has these.
    Way way = Way::curve;
    CurvePoint joins;  ///< the law at sync_x
    Meeting meeting;
    SyncCurve curve;
    TimedMotion timed;
    Moment looked;    ///< when the axis looked last,
    MotionState led;  ///< and its master then

    // The master is seen so by the slave.
    MotionState shift;  ///< by phasing
    PointMotion shifting;

    TransitionLimits limits(double towards) const { return limits_towards(towards, dynamics); }

    /// The guide that a slave of two masters follows.
    MotionState guide(const MotionState& first, const MotionState& second) const;

    /// From the state of the slave onto the guide.
    PlanResult get_onto(const MotionState& slave, const MotionState& guide, const Moment& at);

    /// A point of the cam, as one of the axes.
    CurvePoint on_axis(const CurvePoint& of_cam) const;

    /// With no jerk and no acceleration that the slave could not follow.
    MotionState as_foreseen(MotionState guide) const;

    /// The next whole step of `quantum` seconds towards the guide.
    PlanResult step_towards(const MotionState& slave, const MotionState& guide, const Moment& at,
                            double quantum);

    /// The law at the master's position x, of a cam by its table.
    CurvePoint law_at(double x, const Cam& cam) const;

    void enter_period(double periods) {
        last_periods = periods;
        period_is_open = 0;
    }

    /// The period of a cam that a master is in; where two meet, that in the direction of the
    /// master.
    double period_from(double master, double towards, const Cam& cam) const;

    /// A command that waits for the end of this one begins as soon as it is in sync; that of a cam
    /// at its end.
    bool holds() const { return stage == Stage::in_sync && (law != Law::cammed || finished != 0); }

    /// Limits of a motion that keeps its direction, or turns round.
    TransitionLimits limits_of(const SyncCurve& on, const Dynamics& d) const;

    /// Sets sync_x to where the master comes to `position`, or, where that repeats every `repeats`
    /// > 0, to the first such place that is not nearer than the slave is to begin before.
    void meet(const MotionState& master, double position, double repeats);

    /// How far the master has to go to sync_x.
    double distance(const MotionState& master) const {
        return (sync_x - master.position) * direction;
    }

    /// Begins the approach to the law at `sync_x`. `period` of the slave: 0 if it is not modulo. A
    /// master that is not `steady`, as one that is measured, moves by so much noise that nothing
    /// but a curve follows it.
    CurveFault approach(const MotionState& slave, const Forecast& master, const Cam& cam,
                        double period, bool steady, const Moment& at);

    /// Goes on with it from another state: the meeting has changed, or the curve cannot be kept.
    CurveFault approach_anew(const MotionState& slave, const Forecast& master, bool keeps_curve,
                             bool steady, const Moment& at);

    /// When and how the slave is to be on its law; the forecast begins at `start`.
    Meeting meet(const Forecast& master) const;

    /// What an approach lacks that has just failed.
    Shortage shortage(const MotionState& slave, const Forecast& master, bool steady) const;

    /// What there is to choose from.
    struct Choice {
        bool steady = true;       ///< what a master does is foreseen: a curve, a timed motion
        bool on_its_way = false;  ///< it has left before
        bool kept_curve = false;  ///< the one that it is on
    };
    /// The first way of these that keeps the limits, those first that do not turn round.
    CurveFault choose(const MotionState& slave, const Forecast& master, const Meeting& goal,
                      const Dynamics& d, const Choice& from);
    bool choose_curve(const SyncCurve& tried, const Forecast& master, const Dynamics& d,
                      bool may_turn, CurveFault& fault);
    /// A slave that stands may leave later.
    bool choose_later(const MotionState& slave, const Forecast& master, const Dynamics& d,
                      CurveFault& fault);
    bool choose_timed(const MotionState& slave, const Meeting& goal, const Dynamics& d,
                      bool may_turn, CurveFault& fault);

    /// Whether the slave is where the law has it, with its velocity.
    bool is_on_law(const MotionState& slave, const MotionState& master, const Cam& cam) const;
    /// The same but for its acceleration, which may jump at the points of a cam.
    bool is_beside_law(const MotionState& slave, const MotionState& master, const Cam& cam) const;
};

}  // namespace lineshaft
