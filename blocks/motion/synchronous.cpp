#include "blocks/motion/synchronous.hpp"

#include <algorithm>

#include "blocks/axis/cam_table.hpp"

namespace lineshaft {

namespace {

using C = Coupling;

template <class T>
Field coupled(std::string_view name, T C::*member, std::string_view unit, std::string_view doc) {
    Field f = detail::field(Direction::input, name, member, unit, doc);
    f.offset += detail::offset_of(&CommandBlock::pins) + detail::offset_of(&Request::coupling);
    return f;
}

template <class T>
Field linked(MasterLink C::*link, std::string_view name, T MasterLink::*member,
             std::string_view unit, std::string_view doc) {
    Field f = detail::field(Direction::input, name, member, unit, doc);
    f.offset += detail::offset_of(&CommandBlock::pins) + detail::offset_of(&Request::coupling) +
                detail::offset_of(link);
    return f;
}

Field master(std::string_view name = "Master", MasterLink C::*link = &C::master) {
    Field f = linked(link, name, &MasterLink::axis, "", "that is followed").one_of(axis_unit_names);
    f.direction = Direction::in_out;
    f.refers = Axis::type;
    f.required = true;
    return f;
}

Field source(std::string_view name = "MasterValueSource", MasterLink C::*link = &C::master) {
    return linked(link, name, &MasterLink::source, "", "set-point, or what the drive measures")
        .one_of(master_value_source_names);
}

Field numerator(std::string_view name = "RatioNumerator", MasterLink C::*link = &C::master) {
    return linked(link, name, &MasterLink::numerator, "", "slave / master is this ...");
}

Field denominator(std::string_view name = "RatioDenominator", MasterLink C::*link = &C::master) {
    return linked(link, name, &MasterLink::denominator, "", "... over this; not 0");
}

Field of_slave(Field f) {
    if (f.unit == "{Axis}/s") f.unit = "{Slave}/s";
    if (f.unit == "{Axis}/s^2") f.unit = "{Slave}/s^2";
    if (f.unit == "{Axis}/s^3") f.unit = "{Slave}/s^3";
    return f;
}

Field of_master(Field f) {
    if (f.unit == "{Axis}/s") f.unit = "{Master}/s";
    if (f.unit == "{Axis}/s^2") f.unit = "{Master}/s^2";
    if (f.unit == "{Axis}/s^3") f.unit = "{Master}/s^3";
    return f;
}

Field start_distance() {
    return coupled("MasterStartDistance", &C::start_distance, "{Master}",
                   "of the master before it is met, where the slave leaves; 0: at once, or later "
                   "where it stands and would swing out")
        .at_least(0);
}

/// With Slave in place of Axis.
std::vector<Field> slave_table(std::initializer_list<Field> inputs, const Field& first_output,
                               std::initializer_list<Field> outputs = {}) {
    std::vector<Field> fields = pin::table(inputs, first_output);
    fields.front().name = "Slave";
    fields.front().doc = "that follows";
    fields.insert(fields.end(), outputs);
    return fields;
}

std::vector<Field> phasing_table() {
    auto table = slave_table(
        {master(), pin::continuous_update(),
         input("PhaseShift", &CommandBlock::pins, &Request::position, "{Master}",
               "above 0: the slave leads"),
         of_master(pin::velocity()), of_master(pin::acceleration()), of_master(pin::deceleration()),
         of_master(pin::jerk()), pin::buffer_mode()},
        pin::done("the shift is reached"),
        {output("AbsolutePhaseShift", &Phasing::shift, "{Master}", "shift of the master now"),
         output("CoveredPhaseShift", &Phasing::covered_shift, "{Master}",
                "that the command has added so far")});
    table.push_back(local("Halts", &CommandBlock::pins, &Request::halts, "",
                          "1: the shift ends where it then stands"));
    return table;
}

}  // namespace

std::span<const Field> GearIn::fields() {
    static const auto fields = slave_table(
        {master(), pin::continuous_update(), numerator(), denominator(), source(),
         of_slave(pin::velocity("greatest while it catches up; below 0: the axis' own")),
         of_slave(pin::acceleration()), of_slave(pin::deceleration()), of_slave(pin::jerk()),
         pin::buffer_mode(),
         coupled("Transition", &C::transition, "", "what is limited on the way")
             .one_of(transition_mode_names),
         input("CatchUp", &GearIn::catch_up, "", "makes up the position lost on the way")},
        pin::reached("InGear", "slave velocity = ratio * master velocity"));
    return fields;
}

void GearIn::scan(const Scan& now, const Context& context) {
    pins.coupling.catch_up = catch_up ? 1 : 0;
    run(now, context);
}

std::span<const Field> GearInPos::fields() {
    static const auto fields = slave_table(
        {master(), numerator(), denominator(), source(),
         coupled("MasterSyncPosition", &C::master_sync, "{Master}", "of the master, in sync"),
         coupled("SlaveSyncPosition", &C::slave_sync, "{Slave}", "of the slave, in sync"),
         coupled("SyncMode", &C::sync_mode, "", "of a modulo slave: which of its positions")
             .one_of(sync_mode_names),
         start_distance(), of_slave(pin::velocity()), of_slave(pin::acceleration()),
         of_slave(pin::deceleration()), of_slave(pin::jerk()), pin::buffer_mode()},
        pin::reached("InSync", "the positions have been met"),
        {output("StartSync", &GearInPos::start_sync, "", "the slave has left to meet the master")});
    return fields;
}

void GearInPos::scan(const Scan& now, const Context& context) {
    run(now, context);
    start_sync = busy && progress_of(job, context) >= Progress::approaching;
}

std::span<const Field> CamIn::fields() {
    static const auto fields = slave_table(
        {master(), pin::continuous_update(),
         coupled("CamTableID", &C::cam, "", "of MC_CamTableSelect"),
         coupled("MasterOffset", &C::master_offset, "{Master}", "of the master on the cam"),
         coupled("SlaveOffset", &C::slave_offset, "{Slave}", "of the slave"),
         coupled("MasterScaling", &C::master_scaling, "", "of the master on the cam; not 0"),
         coupled("SlaveScaling", &C::slave_scaling, "", "of the slave"), start_distance(),
         coupled("MasterSyncPosition", &C::master_sync, "{Master}", "on the cam, where it is met"),
         coupled("StartMode", &C::start_mode, "", "of the slave").one_of(start_mode_names),
         input("StaysCoupled", &CamIn::stays_coupled, "",
               "of a cam that is not periodic: the slave stands beyond its ends, and comes back"),
         input(
             "Appends", &CamIn::appends, "",
             "a periodic cam begins anew where it has ended, else where it began: the slave jumps"),
         source(), of_slave(pin::velocity()), of_slave(pin::acceleration()),
         of_slave(pin::deceleration()), of_slave(pin::jerk()), pin::buffer_mode()},
        pin::reached("InSync", "the slave is on the cam"),
        {output("StartSync", &CamIn::start_sync, "", "the slave has left to meet the cam"),
         output("EndOfProfile", &CamIn::end_of_profile, "",
                "for a scan: the cam has come to its end")});
    return fields;
}

void CamIn::scan(const Scan& now, const Context& context) {
    pins.coupling.stays = stays_coupled ? 1 : 0;
    pins.coupling.falls = appends ? 0 : 1;
    run(now, context);
    const Progress at = progress_of(job, context);
    start_sync = busy && at >= Progress::approaching;
    const bool known = job.told_by != nowhere && (job.told_by == context.task ||
                                                  context.is_published(job.told_by, job.told_in));
    end_of_profile = known && job.told_value > ends;
    if (known) ends = job.told_value;
}

std::span<const Field> PhasingAbsolute::fields() {
    static const auto fields = phasing_table();
    return fields;
}

std::span<const Field> PhasingRelative::fields() {
    static const auto fields = phasing_table();
    return fields;
}

void Phasing::scan(const Scan& now, const Context& context) {
    run(now, context);
    if (axis != nowhere) shift = context.seen_instance<Axis>(axis).sync.shift.position;
    covered_shift = covered(context, &Axis::phased);
}

namespace {

std::vector<Field> profile_table(std::string_view reference, std::string_view scale,
                                 std::string_view unit, std::string_view of_table,
                                 const Field& first_output) {
    return pin::table(
        {in_out(reference, &Profile::table, CamTable::type, of_table),
         coupled("TimeScale", &C::master_scaling, "", "time = this times the table's; above 0"),
         coupled(scale, &C::slave_scaling, "", "of the table's values"),
         coupled("Offset", &C::slave_offset, unit, "of the scaled values"), pin::buffer_mode()},
        first_output);
}

}  // namespace

std::span<const Field> PositionProfile::fields() {
    static const auto fields = profile_table("TimePosition", "PositionScale", "{Axis}",
                                             "points over time: from the axis' position, velocity "
                                             "and acceleration to rest without any",
                                             pin::done("the profile has come to its end"));
    return fields;
}

std::span<const Field> VelocityProfile::fields() {
    static const auto fields =
        profile_table("TimeVelocity", "VelocityScale", "{Axis}/s",
                      "points over time: from the axis' velocity and acceleration to no "
                      "acceleration; where its default_jerk is 0 that may jump",
                      pin::reached("ProfileCompleted", "the last velocity is kept"));
    return fields;
}

std::span<const Field> AccelerationProfile::fields() {
    static const auto fields =
        profile_table("TimeAcceleration", "AccelerationScale", "{Axis}/s^2",
                      "points over time: from the axis' acceleration to none; where its "
                      "default_jerk is 0 that may jump",
                      pin::reached("ProfileCompleted", "the velocity at its end is kept"));
    return fields;
}

/// A profile has its own beginning: blending is waiting.
void Profile::scan(const Scan& now, const Context& context) {
    pins.coupling.cam = table == nowhere ? 0 : CamTableId{table}.number();
    const BufferMode wanted = pins.mode;
    pins.mode = std::min(wanted, BufferMode::buffered);
    run(now, context);
    pins.mode = wanted;
}

std::span<const Field> command_kinds::gear_out_fields() {
    static const auto fields = slave_table({}, pin::done("the slave is free"));
    return fields;
}

std::span<const Field> command_kinds::combine_fields() {
    static const auto fields = slave_table(
        {master("Master1"), master("Master2", &C::second), pin::continuous_update(),
         coupled("CombineMode", &C::combine, "", "what becomes of both").one_of(combine_mode_names),
         numerator("GearRatioNumeratorM1"), denominator("GearRatioDenominatorM1"),
         numerator("GearRatioNumeratorM2", &C::second),
         denominator("GearRatioDenominatorM2", &C::second), source("MasterValueSourceM1"),
         source("MasterValueSourceM2", &C::second), of_slave(pin::acceleration()),
         of_slave(pin::deceleration()), of_slave(pin::jerk()), pin::buffer_mode()},
        pin::reached("InSync", "the slave follows both"));
    return fields;
}

}  // namespace lineshaft
