#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "blocks/axis/axis_motion.hpp"
#include "blocks/axis/coupling.hpp"
#include "blocks/profile/cam.hpp"
#include "blocks/profile/curve.hpp"
#include "blocks/profile/transition.hpp"

namespace lineshaft {

/// Limits upwards and downwards, of dynamics that say where the speed grows and where it falls.
TransitionLimits limits_towards(double direction, const Dynamics& dynamics);

/// A motion that follows one master or two. Positions of masters are those that no MC_SetPosition
/// has moved: [m]; the slave's are its own: [u].
///
/// `geared`: the slave gets on the way of its guide, ratio x master, wherever it then is.
/// `positioned` and `cammed`: it follows a law, slave over master, which it joins at `sync_x` by a
/// SyncCurve over the master.
struct SyncMotion {
    enum class Law : std::int64_t { geared, positioned, cammed };
    enum class Stage : std::int64_t {
        waiting,        ///< for the master to come near
        approaching,    ///< on the curve
        in_transition,  ///< onto the guide
        in_sync,
    };

    static constexpr std::string_view stage_names[] = {"waiting", "approaching", "in_transition",
                                                       "in_sync"};

    Law law = Law::geared;
    Stage stage = Stage::in_sync;
    std::int64_t reached = 0;  ///< the command has been told of in_sync
    std::int64_t sure = 0;     ///< a curve's limits are kept if the master goes on as foreseen
    Coupling coupling;
    Dynamics dynamics;

    // Of `geared`.
    Moment start;
    Transition transition;   ///< `transition.guide` also foresees the master of a curve
    double offset = 0;       ///< of the slave from its guide
    double goal_offset = 0;  ///< the one that is caught up

    // Of a law.
    double direction = 1;  ///< of the master, on its way to sync_x
    double sync_x = 0, sync_y = 0;
    double cam_origin = 0;    ///< the cam's x is scaling * master + cam_origin
    double cam_rise = 0;      ///< the slave is scaling * cam(x) + cam_rise
    double last_periods = 0;  ///< of the cam, when it was looked at last
    SyncCurve curve;

    // Of the master as the slave sees it.
    MotionState shift;  ///< by phasing
    PointMotion shifting;

    TransitionLimits limits(double towards) const { return limits_towards(towards, dynamics); }

    /// The guide that a slave of two masters follows.
    MotionState guide(const MotionState& first, const MotionState& second) const;

    /// From the state of the slave onto the guide.
    PlanResult get_onto(const MotionState& slave, const MotionState& guide, const Moment& at);

    /// The law at the master's position x, of a cam by its table.
    CurvePoint law_at(double x, const Cam& cam) const;

    /// A command that waits for the end of this one begins as soon as it is in sync; that of a cam
    /// at its end.
    bool holds() const { return stage == Stage::in_sync && law != Law::cammed; }

    /// Sets sync_x to where the master comes to `position`, or, where that repeats every `repeats`
    /// > 0, to the first such place that is not nearer than the slave is to begin before.
    void meet(const MotionState& master, double position, double repeats);

    /// How far the master has to go to sync_x.
    double distance(const MotionState& master) const {
        return (sync_x - master.position) * direction;
    }

    /// From the state of the slave on the way to the law at `sync_x`. `period` of the slave: 0 if
    /// it is not modulo. `interval`: see foresee.
    CurveFault approach(const MotionState& slave, const MotionState& master, const Cam& cam,
                        double period, double interval);

    /// Whether the limits are kept on a curve. A master that accelerates may be at its velocity at
    /// any time: if they would not be to the end, those of `interval` [s] and of its velocity then
    /// count.
    CurveFault foresee(const SyncCurve& way, const MotionState& master,
                       const TransitionLimits& kept, double interval);

    /// Whether the slave is where the law has it, with its velocity.
    bool is_on_law(const MotionState& slave, const MotionState& master, const Cam& cam) const;
};

}  // namespace lineshaft
