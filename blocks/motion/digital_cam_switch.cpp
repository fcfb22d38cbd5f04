#include "blocks/motion/digital_cam_switch.hpp"

#include <algorithm>

namespace lineshaft {

namespace {

constexpr std::string_view output_names[] = {"Output1", "Output2", "Output3", "Output4",
                                             "Output5", "Output6", "Output7", "Output8"};
constexpr std::string_view on_time_names[] = {"OnTime1", "OnTime2", "OnTime3", "OnTime4",
                                              "OnTime5", "OnTime6", "OnTime7", "OnTime8"};
constexpr std::string_view off_time_names[] = {"OffTime1", "OffTime2", "OffTime3", "OffTime4",
                                               "OffTime5", "OffTime6", "OffTime7", "OffTime8"};

/// One of an array of fields.
Field element(Type type, std::string_view name, std::size_t offset, std::string_view unit,
              std::string_view doc) {
    Field field;
    field.name = name;
    field.doc = doc;
    field.unit = unit;
    field.direction = Direction::output;
    field.type = type;
    field.offset = offset;
    return field;
}

void add_tracks(std::vector<Field>& fields) {
    using B = DigitalCamSwitch;
    const std::size_t output = detail::offset_of(&B::outputs), on = detail::offset_of(&B::on_times),
                      off = detail::offset_of(&B::off_times);
    for (std::size_t i = 0; i < B::tracks; ++i) {
        const std::size_t place = i * sizeof(std::int64_t);
        fields.push_back(
            element(Type::boolean, output_names[i], output + i, "", "a cam of the track is on"));
        fields.push_back(element(Type::integer, on_time_names[i], on + place, "ns",
                                 "virtual time at which it went on last"));
        fields.push_back(element(Type::integer, off_time_names[i], off + place, "ns",
                                 "virtual time at which it went off last"));
    }
}

/// In the order of time; on before off, as cams that touch are one.
struct TrackChange {
    std::int64_t time;
    bool on;

    bool operator<(const TrackChange& other) const {
        return time != other.time ? time < other.time : on && !other.on;
    }
};

}  // namespace

std::span<const Field> DigitalCamSwitch::fields() {
    using B = DigitalCamSwitch;
    static const auto table = [] {
        std::vector<Field> fields{
            in_out("Axis", &B::axis, Axis::type, "that switches").one_of(axis_unit_names),
            in_out("Switches", &B::switches, CamSwitches::type, "cams and tracks"),
            input("Enable", &B::enable, "", "the outputs follow the axis; else they are off"),
            input("EnableMask", &B::enable_mask, "", "tracks that may be on: bit 0 is track 1"),
            input("ValueSource", &B::source, "", "set-point, or what the drive measures")
                .one_of(master_value_source_names),
            output("InOperation", &B::in_operation, "", "the outputs follow the axis"),
            output("Busy", &B::busy, "", "the block looks at the axis"),
            output("Error", &B::error, "", "the outputs are off"),
            output("ErrorID", &B::error_id, "", "why").one_of(motion_error_names)};
        add_tracks(fields);
        return fields;
    }();
    return table;
}

MotionError DigitalCamSwitch::check(const Context& context) const {
    if (axis == nowhere) return MotionError::no_axis;
    if (switches == nowhere) return MotionError::no_reference;
    const bool fits =
        context.instance<CamSwitches>(switches).unit == context.instance<Axis>(axis).unit;
    return fits ? MotionError::none : MotionError::other_unit;
}

void DigitalCamSwitch::scan(const Scan& now, const Context& context) {
    error_id = enable ? check(context) : MotionError::none;
    error = error_id != MotionError::none;
    busy = in_operation = enable && !error;
    if (!busy) return stop(now.time);
    const CamSwitches& table = context.instance<CamSwitches>(switches);
    const bool looked = motion.look(context.seen_instance<Axis>(axis), source);
    if (motion.is_empty()) return;
    const auto& to = motion.sample();
    const auto& from = motion.count > 1 ? motion.sample(1) : to;
    const Stretch way = Stretch{from.time,     to.time,     from.place,     to.place,
                                from.velocity, to.velocity, motion.further, motion.period}
                            .last_turn();
    if (!knows_cams)
        for (std::int64_t i = 0; i < table.cams.size; ++i) {
            const SwitchCam& cam = table.cams.rows[static_cast<std::size_t>(i)];
            cams[static_cast<std::size_t>(i)].begin(cam, table.track(cam.track), way);
        }
    const bool moves = knows_cams && looked;
    knows_cams = true;
    for (std::int64_t track = 1; track <= most_switch_tracks; ++track)
        pass(track, table, moves ? &way : nullptr, now.time);
}

void DigitalCamSwitch::stop(std::int64_t now) {
    for (std::size_t i = 0; i < tracks; ++i) show(i, false, now);
    motion = {};
    knows_cams = false;
}

void DigitalCamSwitch::show(std::size_t track, bool on, std::int64_t time) {
    if (outputs[track] == on) return;
    outputs[track] = on;
    (on ? on_times : off_times)[track] = time;
}

/// A track is on while one of its cams is, or more.
void DigitalCamSwitch::pass(std::int64_t number, const CamSwitches& table, const Stretch* way,
                            std::int64_t now) {
    std::array<TrackChange, most_switch_cams * 8> changes;
    std::size_t count = 0;
    int level = 0;
    for (std::int64_t i = 0; i < table.cams.size; ++i) {
        const SwitchCam& cam = table.cams.rows[static_cast<std::size_t>(i)];
        if (cam.track != number) continue;
        SwitchedCam& state = cams[static_cast<std::size_t>(i)];
        level += state.on ? 1 : 0;
        SwitchChanges own;
        if (way) state.pass(cam, table.track(number), *way, own);
        if (cam.mode == SwitchMode::time) state.expire(now, own);
        for (std::size_t n = 0; n < own.count; ++n)
            changes[count++] = {own.all[n].time, own.all[n].on};
    }
    std::sort(changes.begin(), changes.begin() + static_cast<std::ptrdiff_t>(count));
    const auto track = static_cast<std::size_t>(number - 1);
    const bool may_be_on = (enable_mask >> track & 1) != 0;
    for (std::size_t n = 0; n < count; ++n) {
        level += changes[n].on ? 1 : -1;
        show(track, may_be_on && level > 0, changes[n].time);
    }
    show(track, may_be_on && level > 0, now);
}

/// A time of 0 says that there has been none.
void DigitalCamSwitch::shift(std::int64_t by) {
    motion.shift(by);
    for (std::int64_t& time : on_times) time += time != 0 ? by : 0;
    for (std::int64_t& time : off_times) time += time != 0 ? by : 0;
    for (SwitchedCam& cam : cams) cam.until += by;
}

}  // namespace lineshaft
