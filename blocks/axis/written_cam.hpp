#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "blocks/axis/cam_table.hpp"
#include "blocks/axis/job.hpp"
#include "blocks/profile/cam.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/kept_state.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// What a scan of WrittenCam does.
enum class CamAction : std::int64_t {
    rest,
    write,     ///< a point is put at Row
    complete,  ///< the points up to Row are the cam from now on
    evaluate,  ///< a cam is looked at, at Master
    measure,   ///< a cam is looked at as a whole
};

/// A cam that a program makes while it runs: point by point, then as a whole. What is followed
/// stays as it is until then. Its CamTableID names it by its place in the machine's memory: it may
/// be a variable of a block in Structured Text.
struct WrittenCam {
    /// CamTableIDs from here on, by the place and CamTableId's flags.
    static constexpr std::int64_t first_id = std::int64_t{1} << 31;

    CamAction action = CamAction::rest;
    std::int64_t row = 0, given = 0;  ///< `given` of the derivatives: 0, 1 or 2
    std::int64_t other = 0;           ///< CamTableID of the cam that is looked at; 0: its own
    CamPoint point;
    double velocity = 0, acceleration = 0;  ///< of the point
    bool periodic = false, master_absolute = true, slave_absolute = true;

    bool done = false, error = false;
    MotionError error_id = MotionError::none;
    std::int64_t id = 0;
    double y = 0, slope = 0, bend = 0;
    double least = 0, greatest = 0, greatest_slope = 0, greatest_bend = 0;
    double first = 0, last = 0;  ///< of the master

    std::int64_t mark = 0;  ///< the place that `id` says: who follows it looks whether it is there
    CamTable::Points cam, draft;

    static constexpr std::string_view type = "written_cam";
    static constexpr std::string_view doc = "a cam that a program writes point by point";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);

    /// The cam of a CamTableID: a cam_table or one that is written; without points where there is
    /// none.
    static Cam find(const Context& context, const CamTableId& id);
    /// The same of one that has been found before; it may be gone.
    static Cam followed(const Context& context, const CamTableId& id);

  private:
    MotionError act(const Context& context);
    MotionError write();
    MotionError complete(const Context& context);
    Cam looked_at(const Context& context) const;
    MotionError evaluate(const Context& context);
    MotionError measure(const Context& context);
};

bool is_valid(const WrittenCam& cam, const KeptState& machine);

}  // namespace lineshaft
