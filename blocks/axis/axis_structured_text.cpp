#include "blocks/axis/axis.hpp"

namespace lineshaft {

// The bits of StatusWord and ErrorWord: Siemens, S7-1500 Motion Control, tags of the positioning
// and synchronous axis. A position is reached at once, so Done and Standstill come together. No
// part may have the name of a field: of Siemens' Modulo there are its parts.
const std::string_view Axis::structured_text = R"(
FUNCTION "AXIS_REF.ActualPosition" : LREAL
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.ActualPosition" := SEL(axis.has_drive, axis.position, axis.actual_position);
    IF axis.has_drive AND axis.modulo THEN
        "AXIS_REF.ActualPosition" :=
            axis.actual_position - FLOOR(axis.actual_position / axis.period) * axis.period;
    END_IF;
END_FUNCTION

FUNCTION "AXIS_REF.ActualVelocity" : LREAL
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.ActualVelocity" := SEL(axis.has_drive, axis.velocity, axis.actual_velocity);
END_FUNCTION

FUNCTION "AXIS_REF.VelocitySetpoint" : LREAL
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.VelocitySetpoint" := axis.velocity;
END_FUNCTION

TYPE "AXIS_REF.Positioning" : STRUCT Distance, FollowingError : LREAL; END_STRUCT END_TYPE

FUNCTION "AXIS_REF.StatusPositioning" : "AXIS_REF.Positioning"
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.StatusPositioning".FollowingError :=
        SEL(axis.has_drive, 0.0, axis.position - axis.actual_position);
    "AXIS_REF.StatusPositioning".Distance :=
        SEL(axis.state = discrete_motion, 0.0,
            axis.goal - (axis.position + axis.turns * axis.period));
END_FUNCTION

FUNCTION "AXIS_REF.StatusWord" : DWORD
VAR_INPUT axis : AXIS_REF; END_VAR
VAR_TEMP word : DWORD; power : LREAL; END_VAR
    power := axis.velocity * axis.acceleration;
    word.%X0 := axis.state <> disabled;
    word.%X1 := axis.error;
    word.%X5 := axis.homed;
    word.%X6 := axis.state = standstill;
    word.%X7 := axis.velocity = 0;
    word.%X8 := axis.state = discrete_motion AND axis.stopped = 0;
    word.%X9 := axis.jogs = 1;
    word.%X10 := axis.state = continuous_motion AND axis.jogs = 0;
    word.%X11 := axis.state = homing;
    word.%X12 := axis.acceleration = 0;
    word.%X13 := power > 0 OR axis.velocity = 0 AND axis.acceleration <> 0;
    word.%X14 := power < 0;
    word.%X15 := axis.software_limits AND axis.position <= axis.lowest_position;
    word.%X16 := axis.software_limits AND axis.position >= axis.highest_position;
    word.%X21 := axis.state = synchronized_motion AND axis.synchronization <> in_sync;
    word.%X22 := axis.state = synchronized_motion AND axis.synchronization = in_sync;
    word.%X23 := axis.superimposed >= 0;
    "AXIS_REF.StatusWord" := word;
END_FUNCTION

FUNCTION "AXIS_REF.ErrorWord" : DWORD
VAR_INPUT axis : AXIS_REF; END_VAR
VAR_TEMP word : DWORD; END_VAR
    CASE axis.error_id OF
        none: ;
        software_limit: word.%X8 := TRUE;
        no_master, master_loop, master_stands, sync_passed, sync_limits: word.%X14 := TRUE;
    ELSE
        word.%X2 := TRUE;  // UserFault
    END_CASE;
    "AXIS_REF.ErrorWord" := word;
END_FUNCTION

TYPE "AXIS_REF.Error" : STRUCT Number : UDINT; END_STRUCT END_TYPE

FUNCTION "AXIS_REF.ErrorDetail" : "AXIS_REF.Error"
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.ErrorDetail".Number := TO_UDINT(axis.error_id);
END_FUNCTION

FUNCTION "AXIS_REF.WarningWord" : DWORD
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.WarningWord" := 0;
END_FUNCTION

TYPE "AXIS_REF.HomingOf" : STRUCT HomePosition, ReferencingVelocity : LREAL; END_STRUCT END_TYPE

FUNCTION "AXIS_REF.Homing" : "AXIS_REF.HomingOf"
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.Homing".HomePosition := 0.0;
END_FUNCTION

FUNCTION "AXIS_REF.Modulo.Enable" : BOOL
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.Modulo.Enable" := axis.modulo;
END_FUNCTION

FUNCTION "AXIS_REF.Modulo.Length" : LREAL
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.Modulo.Length" := axis.period;
END_FUNCTION

FUNCTION "AXIS_REF.Modulo.StartValue" : LREAL
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.Modulo.StartValue" := 0.0;
END_FUNCTION

TYPE "AXIS_REF.Overrides" : STRUCT Velocity : LREAL; END_STRUCT END_TYPE

FUNCTION "AXIS_REF.Override" : "AXIS_REF.Overrides"
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.Override".Velocity := 100 * axis.velocity_factor;
END_FUNCTION

TYPE "AXIS_REF.Drive" : STRUCT InOperation, CommunicationOK, Error : BOOL; END_STRUCT END_TYPE

FUNCTION "AXIS_REF.StatusDrive" : "AXIS_REF.Drive"
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.StatusDrive".InOperation := axis.state <> disabled;
    "AXIS_REF.StatusDrive".CommunicationOK := TRUE;
END_FUNCTION

TYPE "AXIS_REF.Limits" : STRUCT
    Active : BOOL;
    MinPosition, MaxPosition : LREAL;
END_STRUCT END_TYPE

FUNCTION "AXIS_REF.PositionLimits_SW" : "AXIS_REF.Limits"
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.PositionLimits_SW".Active := axis.software_limits;
    "AXIS_REF.PositionLimits_SW".MinPosition := axis.lowest_position;
    "AXIS_REF.PositionLimits_SW".MaxPosition := axis.highest_position;
END_FUNCTION

TYPE "AXIS_REF.Dynamics" : STRUCT
    Velocity, Acceleration, Deceleration, EmergencyDeceleration, Jerk : LREAL;
END_STRUCT END_TYPE

FUNCTION "AXIS_REF.DynamicDefaults" : "AXIS_REF.Dynamics"
VAR_INPUT axis : AXIS_REF; END_VAR
    "AXIS_REF.DynamicDefaults".Velocity := axis.default_velocity;
    "AXIS_REF.DynamicDefaults".Acceleration := axis.default_acceleration;
    "AXIS_REF.DynamicDefaults".Deceleration := axis.default_deceleration;
    "AXIS_REF.DynamicDefaults".EmergencyDeceleration := axis.default_deceleration;
    "AXIS_REF.DynamicDefaults".Jerk := axis.default_jerk;
END_FUNCTION
)";

}  // namespace lineshaft
