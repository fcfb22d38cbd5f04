#include "blocks/axis/written_cam.hpp"

#include <algorithm>
#include <cmath>

#include "blocks/axis/axis.hpp"
#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view action_names[] = {"rest", "write", "complete", "evaluate", "measure"};

/// Those that are in use, of points that may be written or may not.
auto first_of(auto& points) {
    const auto most = static_cast<std::int64_t>(most_cam_points);
    return std::span(points.rows)
        .first(static_cast<std::size_t>(std::clamp<std::int64_t>(points.size, 0, most)));
}

}  // namespace

std::span<const Field> WrittenCam::fields() {
    using W = WrittenCam;
    static const Field table[] = {
        input("action", &W::action, "", "of this scan").one_of(action_names),
        input("row", &W::row, "", "of the point, from 1 on; when the cam is complete: of the last"),
        input("given", &W::given, "", "0: the position, 1: velocity too, 2: acceleration too")
            .at_least(0)
            .at_most(2),
        input("master", &W::point, &CamPoint::x, "", "position of the master"),
        input("slave", &W::point, &CamPoint::y, "", "position of the slave"),
        input("velocity", &W::velocity, "", "slave per master"),
        input("acceleration", &W::acceleration, "", "of the slave per master, twice"),
        input("curve", &W::point, &CamPoint::curve, "", "to the next point")
            .one_of(cam_curve_names),
        input("cam", &W::other, "", "CamTableID of the cam that is looked at; 0: its own"),
        input("periodic", &W::periodic, "", "the cam begins anew at its end"),
        input("master_absolute", &W::master_absolute, "", "as of MC_CamTableSelect"),
        input("slave_absolute", &W::slave_absolute, "", "as of MC_CamTableSelect"),
        output("done", &W::done, "", "what the scan was to do is done"),
        output("error", &W::error, "", "it cannot be done"),
        output("error_id", &W::error_id, "", "why").one_of(motion_error_names),
        output("cam_table_id", &W::id, "", "for MC_CamIn; 0: there is no cam yet"),
        output("slave_at", &W::y, "", "position of the slave at `master`"),
        output("velocity_at", &W::slope, "", "slave per master there"),
        output("acceleration_at", &W::bend, "", "of the slave per master, twice, there"),
        output("first", &W::first, "", "position of the master at the beginning"),
        output("last", &W::last, "", "position of the master at the end"),
        output("least", &W::least, "", "position of the slave on the whole cam"),
        output("greatest", &W::greatest, "", "position of the slave on the whole cam"),
        output("greatest_velocity", &W::greatest_slope, "", "size of slave per master"),
        output("greatest_acceleration", &W::greatest_bend, "", "size of that per master"),
    };
    return table;
}

void WrittenCam::scan(const Scan&, const Context& context) {
    error_id = act(context);
    error = error_id != MotionError::none;
    done = !error && action != CamAction::rest;
}

MotionError WrittenCam::act(const Context& context) {
    switch (action) {
        case CamAction::write:
            return write();
        case CamAction::complete:
            return complete(context);
        case CamAction::evaluate:
            return evaluate(context);
        case CamAction::measure:
            return measure(context);
        case CamAction::rest:
            break;
    }
    return MotionError::none;
}

MotionError WrittenCam::write() {
    if (row < 1 || row > static_cast<std::int64_t>(most_cam_points))
        return MotionError::out_of_range;
    if (!all_finite(point.x, point.y, velocity, acceleration)) return MotionError::not_finite;
    CamPoint& written = draft.rows[static_cast<std::size_t>(row - 1)];
    written = point;
    written.slope = given > 0 ? velocity : NAN;
    written.bend = given > 1 ? acceleration : NAN;
    return MotionError::none;
}

MotionError WrittenCam::complete(const Context& context) {
    if (row < 2 || row > static_cast<std::int64_t>(most_cam_points)) return MotionError::no_cam;
    draft.size = row;
    if (complete_cam(first_of(draft), periodic).fault != CamFault::none) return MotionError::no_cam;
    cam = draft;
    mark = context.place_of(*this);
    id = first_id + CamTableId{mark / 8 - 1, periodic, master_absolute, slave_absolute}.number();
    return MotionError::none;
}

namespace {

/// Whether there is room for a block at the place, in a block of the program: its number is
/// anybody's.
bool is_within_a_block(const Context& context, std::int64_t place) {
    for (int number = 0; number < context.blocks; ++number) {
        const std::int64_t begin = context.instances[number] - context.memory;
        const auto size = static_cast<std::int64_t>(context.types[number]->size);
        if (place >= begin && place + static_cast<std::int64_t>(sizeof(WrittenCam)) <= begin + size)
            return true;
    }
    return false;
}

std::int64_t place_of(const CamTableId& id) {
    return (id.table + 1) * 8 - WrittenCam::first_id;
}

}  // namespace

Cam WrittenCam::find(const Context& context, const CamTableId& id) {
    const bool is_known = is_instance<CamTable>(context, id.table) ||
                          is_within_a_block(context, lineshaft::place_of(id));
    return is_known ? followed(context, id) : Cam{};
}

Cam WrittenCam::followed(const Context& context, const CamTableId& id) {
    const std::int64_t place = lineshaft::place_of(id);
    if (place < 0) return context.instance<CamTable>(id.table).cam(id.periodic);
    WrittenCam& found = context.at<WrittenCam>(place);
    const bool is_there = found.mark == place;
    return is_there ? Cam{first_of(found.cam), id.periodic} : Cam{};
}

Cam WrittenCam::looked_at(const Context& context) const {
    if (other != 0) return find(context, CamTableId::of(other));
    return cam.size == 0 ? Cam{} : Cam{first_of(cam), periodic};
}

MotionError WrittenCam::evaluate(const Context& context) {
    const Cam seen = looked_at(context);
    if (seen.points.empty()) return MotionError::no_cam;
    if (!std::isfinite(point.x)) return MotionError::not_finite;
    const CurvePoint found = seen.at(point.x);
    y = found.y;
    slope = found.slope;
    bend = found.bend;
    return MotionError::none;
}

MotionError WrittenCam::measure(const Context& context) {
    const Cam seen = looked_at(context);
    if (seen.points.empty()) return MotionError::no_cam;
    const Range values = seen.values();
    const CamExtremes most = seen.extremes();
    first = seen.begin();
    last = seen.points.back().x;
    least = values.least;
    greatest = values.greatest;
    greatest_slope = most.slope;
    greatest_bend = most.bend;
    return MotionError::none;
}

bool is_valid(const WrittenCam& cam, const KeptState&) {
    const auto may_be = [](const CamTable::Points& points) {
        return points.size >= 0 && points.size <= static_cast<std::int64_t>(most_cam_points) &&
               std::ranges::all_of(points.rows, [](const CamPoint& p) {
                   return is_one_of(p.curve, CamCurve::quintic);
               });
    };
    const auto is_finite = [](const CamPoint& p) { return all_finite(p.x, p.y, p.slope, p.bend); };
    return may_be(cam.cam) && may_be(cam.draft) && cam.mark >= 0 &&
           std::ranges::all_of(
               std::span(cam.cam.rows).first(static_cast<std::size_t>(cam.cam.size)), is_finite);
}

}  // namespace lineshaft
