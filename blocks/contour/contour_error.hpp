#pragma once

#include <span>

#include "blocks/contour/command_path.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Real-time contour error of two axes (Li et al.): how far the actual point is from the commanded
/// path, scan by scan, whatever the following error; see CommandPath for how, and for what it does
/// at the newest point, at standstill and on the way back.
///
/// It remembers the last CommandPath::capacity different command points. When the nearest may have
/// left them, `out_of_reach` is true and the last estimate is held; likewise, with `error`, while
/// an input is no number. In the scan of a held estimate the command point is remembered all the
/// same, unless its distance from 0 is beyond the range of numbers when squared.
struct ContourError {
    enum class Error : std::int64_t {
        none,
        not_finite,  ///< an input is NaN or infinite, or the distance is
    };

    double command_x = 0, command_y = 0, actual_x = 0, actual_y = 0;

    double contour_error = 0, absolute_error = 0, following_error = 0;
    double normal_x = 0, normal_y = 0;
    std::int64_t points_back = 0;
    bool at_newest = false, out_of_reach = false, error = false;
    Error error_id = Error::none;

    CommandPath path;

    static constexpr std::string_view type = "contour_error";
    static constexpr std::string_view doc =
        "contour error of two axes in real time, with the side of the path";
    static std::span<const Field> fields();
    void scan(const Scan& now);

  private:
    bool measure();
};

}  // namespace lineshaft
