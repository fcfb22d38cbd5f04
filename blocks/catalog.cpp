#include "blocks/catalog.hpp"

#include "blocks/axis/axis.hpp"
#include "blocks/axis/axis_valid.hpp"
#include "blocks/axis/cam_table.hpp"
#include "blocks/axis/servo_drive.hpp"
#include "blocks/axis/written_cam.hpp"
#include "blocks/circle/circle_fit.hpp"
#include "blocks/circle/path_circle.hpp"
#include "blocks/circle/path_move.hpp"
#include "blocks/contour/contour_comparison.hpp"
#include "blocks/contour/contour_error.hpp"
#include "blocks/contour/cross_coupling.hpp"
#include "blocks/contour/path_rectangle.hpp"
#include "blocks/group/group_administration.hpp"
#include "blocks/group/group_moves.hpp"
#include "blocks/group/group_reads.hpp"
#include "blocks/group/group_valid.hpp"
#include "blocks/group/path_table.hpp"
#include "blocks/libraries/libraries.hpp"
#include "blocks/logic/arithmetic.hpp"
#include "blocks/logic/bistable.hpp"
#include "blocks/logic/boolean.hpp"
#include "blocks/logic/compare.hpp"
#include "blocks/logic/counter.hpp"
#include "blocks/logic/edge.hpp"
#include "blocks/logic/select.hpp"
#include "blocks/logic/signal.hpp"
#include "blocks/logic/timer.hpp"
#include "blocks/motion/cam_switches.hpp"
#include "blocks/motion/cam_table_select.hpp"
#include "blocks/motion/digital_cam_switch.hpp"
#include "blocks/motion/digital_signals.hpp"
#include "blocks/motion/motion_valid.hpp"
#include "blocks/motion/moves.hpp"
#include "blocks/motion/probes.hpp"
#include "blocks/motion/reads.hpp"
#include "blocks/motion/settings.hpp"
#include "blocks/motion/state_commands.hpp"
#include "blocks/motion/synchronous.hpp"
#include "blocks/other_valid.hpp"
#include "blocks/pulse/pto.hpp"

namespace lineshaft {

namespace {

/// Instructions of S7-1500 and S7-1500T for which there is no block.
void lack_of_siemens(Catalog& blocks) {
    for (const char* torque : {"MC_TorqueLimiting", "MC_TorqueRange", "MC_TorqueAdditive"})
        blocks.lack(torque,
                    "an axis is led by its position here and has no torque: wire a servo_drive, "
                    "whose mechanics have forces");
    for (const char* probe : {"MC_MeasuringInput", "MC_MeasuringInputCyclic"})
        blocks.lack(probe, "take MC_TouchProbe, whose trigger is a signal");
    blocks.lack("MC_AbortMeasuringInput", "take MC_AbortTrigger, which ends MC_TouchProbe");
    for (const char* cam : {"MC_OutputCam", "MC_CamTrack"})
        blocks.lack(cam, "take MC_DigitalCamSwitch, which has several cams and tracks");
    for (const char* drive : {"MC_SetAxisSTW", "MC_SaveAbsoluteEncoderData", "MC_SetSensor"})
        blocks.lack(drive, "leave it out: an axis has no control word and no encoders here");
    for (const char* offset : {"MC_OffsetRelative", "MC_OffsetAbsolute"})
        blocks.lack(offset, "take MC_MoveSuperimposed, which adds a distance to the slave's way");
    blocks.lack("MC_LeadingValueAdditive", "take MC_CombineAxes, which adds a second master");
    blocks.lack("MC_MotionInVelocity",
                "take MC_MoveVelocity, or MC_MotionInPosition with set-points of the program");
    blocks.lack("MC_MotionInSuperimposed", "take MC_MoveSuperimposed");
    blocks.lack("MC_SynchronizedMotionSimulation",
                "leave it out: an axis that loses its power leaves its gear or its cam");
    for (const char* cam :
         {"MC_GetCamLeadingValue", "MC_GetCamFollowingValue", "MC_GetCamFollowingValueCyclic"})
        blocks.lack(cam, "reckon it of the points of the cam in the program");
    for (const char* cam : {"MC_InterpolateCam", "MC_CopyCamData"})
        blocks.lack(cam, "write the points of the cam as a cam_table in the program");
}

Catalog make_catalog() {
    Catalog blocks;
    blocks.add<ServoDrive>();
    blocks.add<Axis>();
    blocks.add<Power>();
    blocks.add<Reset>();
    blocks.add<Stop>();
    blocks.add<Halt>();
    blocks.add<MoveAbsolute>();
    blocks.add<MoveRelative>();
    blocks.add<MoveAdditive>();
    blocks.add<MoveVelocity>();
    blocks.add<MoveContinuousAbsolute>();
    blocks.add<MoveContinuousRelative>();
    blocks.add<MoveSuperimposed>();
    blocks.add<HaltSuperimposed>();
    blocks.add<GearIn>();
    blocks.add<GearOut>();
    blocks.add<GearInPos>();
    blocks.add<CamTable>();
    blocks.add<WrittenCam>();
    blocks.add<CamTableSelect>();
    blocks.add<CamIn>();
    blocks.add<CamOut>();
    blocks.add<PhasingAbsolute>();
    blocks.add<PhasingRelative>();
    blocks.add<CombineAxes>();
    blocks.add<PositionProfile>();
    blocks.add<VelocityProfile>();
    blocks.add<AccelerationProfile>();
    blocks.add<MotionInPosition>();
    blocks.add<Home>();
    blocks.add<SetPosition>();
    blocks.add<SetOverride>();
    blocks.add<ReadStatus>();
    blocks.add<ReadMotionState>();
    blocks.add<ReadAxisInfo>();
    blocks.add<ReadAxisError>();
    blocks.add<ReadActualPosition>();
    blocks.add<ReadActualVelocity>();
    blocks.add<ReadParameter>();
    blocks.add<ReadBoolParameter>();
    blocks.add<WriteParameter>();
    blocks.add<WriteBoolParameter>();
    blocks.add<TouchProbe>();
    blocks.add<AbortTrigger>();
    blocks.add<CamSwitches>();
    blocks.add<DigitalCamSwitch>();
    blocks.add<DigitalInputs>();
    blocks.add<DigitalOutputs>();
    blocks.add<ReadDigitalInput>();
    blocks.add<ReadDigitalOutput>();
    blocks.add<WriteDigitalOutput>();
    blocks.add<AxesGroup>();
    blocks.add<PathTable>();
    blocks.add<AddAxisToGroup>();
    blocks.add<RemoveAxisFromGroup>();
    blocks.add<UngroupAllAxes>();
    blocks.add<GroupEnable>();
    blocks.add<GroupDisable>();
    blocks.add<GroupReset>();
    blocks.add<GroupStop>();
    blocks.add<GroupHalt>();
    blocks.add<GroupInterrupt>();
    blocks.add<GroupContinue>();
    blocks.add<GroupSetOverride>();
    blocks.add<SetCartesianTransform>();
    blocks.add<GroupPower>();
    blocks.add<GroupReadStatus>();
    blocks.add<GroupReadError>();
    blocks.add<GroupReadActualPosition>();
    blocks.add<MoveLinearAbsolute>();
    blocks.add<MoveLinearRelative>();
    blocks.add<MoveCircularAbsolute>();
    blocks.add<MoveCircularRelative>();
    blocks.add<MoveDirectAbsolute>();
    blocks.add<MoveDirectRelative>();
    blocks.add<MovePath>();
    blocks.add<CircleFit>();
    blocks.add<PathCircle>();
    blocks.add<PathMove>();
    blocks.add<PathRectangle>();
    blocks.add<ContourError>();
    blocks.add<ContourComparison>();
    blocks.add<CrossCoupling>();
    blocks.add<Pto>();
    blocks.add<Ton>();
    blocks.add<Tof>();
    blocks.add<Tp>();
    blocks.add<Ctu>();
    blocks.add<Ctd>();
    blocks.add<Ctud>();
    blocks.add<RTrig>();
    blocks.add<FTrig>();
    blocks.add<Sr>();
    blocks.add<Rs>();
    blocks.add<And>();
    blocks.add<Or>();
    blocks.add<Xor>();
    blocks.add<Not>();
    blocks.add<Gt>();
    blocks.add<Ge>();
    blocks.add<Eq>();
    blocks.add<Le>();
    blocks.add<Lt>();
    blocks.add<Ne>();
    blocks.add<Hysteresis>();
    blocks.add<Sel>();
    blocks.add<Mux>();
    blocks.add<Limit>();
    blocks.add<Min>();
    blocks.add<Max>();
    blocks.add<MoveValue>();
    blocks.add<Add>();
    blocks.add<Sub>();
    blocks.add<Mul>();
    blocks.add<Div>();
    blocks.add<Mod>();
    blocks.add<Abs>();
    blocks.add<LrealToLint>();
    blocks.add<LrealToTime>();
    blocks.add<Scale>();
    blocks.add<FilterPt1>();
    for (const char* torque : {"MC_TorqueControl", "MC_ReadActualTorque"})
        blocks.lack(torque,
                    "an axis is led by its position here and has no torque: move it with "
                    "MC_MoveVelocity within Acceleration and Jerk, or wire a servo_drive, whose "
                    "mechanics have forces");
    lack_of_siemens(blocks);
    blocks.add_libraries(vendor_libraries());
    return blocks;
}

}  // namespace

const Catalog& standard_blocks() {
    static const Catalog blocks = make_catalog();
    return blocks;
}

}  // namespace lineshaft
