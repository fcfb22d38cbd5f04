#include "blocks/catalog.hpp"

#include <span>
#include <string_view>
#include <vector>

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

struct Lack {
    std::string_view instead;
    std::vector<std::string_view> names;
};

void lack(Catalog& blocks, std::span<const Lack> table) {
    for (const Lack& row : table)
        for (const std::string_view name : row.names) blocks.lack(name, row.instead);
}

/// Blocks of SoftMotion, above all of its CNC.
void lack_of_softmotion(Catalog& blocks) {
    const Lack table[] = {
        {"G code is not run here: write its points as a path_table, and run along them with a "
         "group "
         "and MC_MovePath",
         {"SMC_NCDecoder", "SMC_NCInterpreter", "SMC_Interpolator", "SMC_ReadNCFile",
          "SMC_ReadNCFile2", "SMC_CheckVelocities", "SMC_SmoothPath", "SMC_RoundPath",
          "SMC_ToolCorr", "SMC_ToolLengthCorr", "SMC_LimitCircularVelocity", "SMC_OutQueue",
          "SMC_CNC_REF"}},
        {"take SMC_FollowPosition, which gives an axis a position of the program's own in each "
         "cycle",
         {"SMC_ControlAxisByPos", "SMC_ControlAxisByPosVel"}},
        {"take SMC_FollowVelocity, which gives an axis a velocity of the program's own in each "
         "cycle",
         {"SMC_ControlAxisByVel"}},
        {"leave it out: the axes of a group are Cartesian here, and their positions the "
         "coordinates",
         {"SMC_TRAFO_Gantry2", "SMC_TRAFO_Gantry3", "SMC_TRAFOF_Gantry2", "SMC_TRAFOF_Gantry3"}},
        {"read Error and ErrorID of the blocks themselves: an axis keeps no list of their errors",
         {"SMC_ReadFBError", "SMC_ClearFBError"}},
        {"take SMC3_ReinitDrive", {"SMC_ReinitDrive", "SMC_StartupDrive"}},
        {"leave it out: an axis counts in its own unit, and the gear of its motor is a "
         "transmission",
         {"SMC_ChangeGearingRatio"}},
        {"leave it out: commands say with Jerk whether the acceleration ramps, and an axis with "
         "default_jerk",
         {"SMC_SetRampType"}},
        {"an axis is led by its position here and has no torque: wire a servo_drive, whose "
         "mechanics have forces",
         {"SMC_SetTorque", "MC_SetTorqueLimit"}},
        {"leave it out: an axis has no brake, and takes no position from the run before",
         {"SMC_BrakeControl", "SMC_BrakeStatus", "SMC3_BrakeControl", "SMC3_BrakeStatus",
          "SMC3_PersistPosition"}},
        {"write the points of the cam as MC_CAM_REF in the program",
         {"SMC_ReadCAM", "SMC_WriteCAM"}}};
    lack(blocks, table);
}

/// What TwinCAT's interpolation has, and of its groups what the catalogue's have otherwise.
void lack_of_twincat(Catalog& blocks) {
    const Lack table[] = {
        {"a channel of the interpolation and its G code are not run here: make the axes a group "
         "with MC_AddAxisToGroup and MC_GroupEnable, write the points as a path_table, and run "
         "along them with MC_MovePath",
         {"CfgBuild3DGroup",
          "CfgBuildExt3DGroup",
          "CfgAddAxisToGroup",
          "CfgReconfigGroup",
          "CfgReconfigAxis",
          "CfgRead3DAxisIds",
          "CfgReadExt3DAxisIds",
          "ItpLoadProg",
          "ItpLoadProgEx",
          "ItpStartStop",
          "ItpStartStopEx",
          "ItpEStop",
          "ItpEStopEx",
          "ItpStepOnAfterEStop",
          "ItpStepOnAfterEStopEx",
          "ItpReset",
          "ItpResetEx2",
          "ItpSingleBlock",
          "ItpWriteRParams",
          "ItpWriteRParamsEx",
          "ItpReadRParams",
          "ItpReadRParamsEx",
          "ItpEnableDefaultGCode",
          "FB_NciFeedTable",
          "FB_NciFeedTablePreparation",
          "NCTOPLC_NCICHANNEL_REF",
          "PLCTONC_NCICHANNEL_REF"}},
        {"write the points as a path_table of the program, which MC_MovePath takes as PathData, or "
         "command each with MC_MoveLinearAbsolute and BufferMode mcBlendingLow",
         {"MC_MoveLinearAbsolutePreparation", "MC_MoveLinearRelativePreparation",
          "MC_MoveCircularAbsolutePreparation", "MC_MoveCircularRelativePreparation",
          "MC_BlendingPreparation", "MC_DwellTimePreparation", "MC_PATH_DATA_REF"}}};
    lack(blocks, table);
}

/// What B&R's motion had before mapp.
void lack_of_br(Catalog& blocks) {
    const Lack table[] = {
        {"ACP10_MC is not here, whose blocks take an axis by its address: give PLCopen's blocks an "
         "axis of the program, PLCopen.MC_Power with VAR_IN_OUT Axis : AXIS_REF",
         {"ACP10AXIS_typ", "ACP10VAXIS_typ"}}};
    lack(blocks, table);
}

/// Instructions of S7-1200, S7-1500 and S7-1500T for which there is no block.
void lack_of_siemens(Catalog& blocks) {
    const Lack table[] = {
        {"an axis is led by its position here and has no torque: wire a servo_drive, whose "
         "mechanics have forces",
         {"MC_TorqueLimiting", "MC_TorqueRange", "MC_TorqueAdditive"}},
        {"take MC_TouchProbe, whose trigger is a signal",
         {"MC_MeasuringInput", "MC_MeasuringInputCyclic"}},
        {"take MC_AbortTrigger, which ends MC_TouchProbe", {"MC_AbortMeasuringInput"}},
        {"take MC_DigitalCamSwitch, which has several cams and tracks",
         {"MC_OutputCam", "MC_CamTrack"}},
        {"leave it out: an axis has no control word and no encoders here",
         {"MC_SetAxisSTW", "MC_SaveAbsoluteEncoderData", "MC_SetSensor"}},
        {"take MC_MoveSuperimposed, which adds a distance to the slave's way",
         {"MC_OffsetRelative", "MC_OffsetAbsolute"}},
        {"take MC_CombineAxes, which adds a second master", {"MC_LeadingValueAdditive"}},
        {"take MC_MoveVelocity, or MC_MotionInPosition with set-points of the program",
         {"MC_MotionInVelocity"}},
        {"take MC_MoveSuperimposed", {"MC_MotionInSuperimposed"}},
        {"write the points of the cam as a cam_table in the program",
         {"MC_InterpolateCam", "MC_CopyCamData"}},
        {"find it in the points that the program has of its cam",
         {"MC_GetCamLeadingValue", "MC_GetCamFollowingValue", "MC_GetCamFollowingValueCyclic"}},
        {"take MC_WriteParameter: 9 is the velocity, 13 the acceleration, 15 the deceleration, 17 "
         "the jerk of commands that give none",
         {"MC_ChangeDynamic", "MC_WriteParam"}},
        {"take MC_ReadParameter, or a tag of the axis", {"MC_ReadParam"}},
        {"call the commands themselves, each at the Done of the one before or with a BufferMode",
         {"MC_CommandTable"}},
        {"leave it out, and call MC_GearIn or MC_CamIn again when the slave has power",
         {"MC_SynchronizedMotionSimulation"}},
        {"take MC_SetCartesianTransform, whose coordinates mcPCS are those of one product",
         {"MC_SetOcsFrame", "MC_TrackConveyorBelt"}},
        {"leave it out: the axes of a group are Cartesian here, and lead the tool itself",
         {"MC_DefineTool", "MC_SetTool", "MC_KinematicsTransformation",
          "MC_InverseKinematicsTransformation", "MC_KinematicsMotionSimulation"}},
        {"give each axis software_limits, lowest_position and highest_position",
         {"MC_DefineWorkspaceZone", "MC_DefineKinematicsZone", "MC_SetWorkspaceZoneActive",
          "MC_SetWorkspaceZoneInactive", "MC_SetKinematicsZoneActive",
          "MC_SetKinematicsZoneInactive"}}};
    lack(blocks, table);
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
    blocks.add<ReadSetPosition>();
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
    blocks.add<GroupReadSetPosition>();
    blocks.add<GroupReadActualVelocity>();
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
    lack_of_twincat(blocks);
    lack_of_br(blocks);
    lack_of_softmotion(blocks);
    blocks.add_libraries(vendor_libraries());
    return blocks;
}

}  // namespace

const Catalog& standard_blocks() {
    static const Catalog blocks = make_catalog();
    return blocks;
}

}  // namespace lineshaft
