#pragma once

#include <array>
#include <span>

#include "blocks/contour/command_path.hpp"
#include "blocks/contour/magnitude_statistics.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// The real-time contour error beside the two baselines of Li et al., scan by scan, with mean, root
/// mean square and greatest of each and of their differences while `enable` is true; a rising edge
/// begins anew. All three are magnitudes.
///
/// The spline goes through the nearest command point and up to `reach` on either side, as far as
/// they are known and remembered: an end's influence falls by 2 + sqrt(3) a point (by 1e-18 over
/// the reach), so that with a dozen points to the newest it agrees with the spline through the
/// whole record to well below a nanometre. `lineshaft contour` compares over the whole record.
/// An actual point ahead of the newest command waits, its estimate with it, until the command has
/// gone by it: before, the path that it is compared with is not there. A sample whose inputs are no
/// number, whose nearest point has left the memory, or behind which `most_waiting` others wait, is
/// left out.
struct ContourComparison {
    static constexpr std::int64_t reach = 32;         ///< [points]
    static constexpr std::int64_t most_waiting = 64;  ///< [samples]

    struct Sample {
        Point command, actual;  ///< [mm]
        double real_time = 0;   ///< [mm]
    };

    bool enable = false;
    double command_x = 0, command_y = 0, actual_x = 0, actual_y = 0;

    double real_time = 0, linear = 0, spline = 0;
    std::int64_t samples = 0, waiting = 0;
    double mean_points_back = 0;

    MagnitudeStatistics real_time_error, linear_error, spline_error, following_error;  ///< [mm]
    MagnitudeStatistics to_linear, to_spline;  ///< real-time less baseline [nm]
    MagnitudeStatistics points_back;
    bool last_enable = false;
    CommandPath path;
    std::array<Sample, most_waiting> ahead{};  ///< those that wait, the oldest first

    static constexpr std::string_view type = "contour_comparison";
    static constexpr std::string_view doc =
        "contour error in real time beside polyline and spline distance";
    static std::span<const Field> fields();
    void scan(const Scan& now);

  private:
    void begin();
    void take_passed();
    void wait(const Sample& sample);
    void take(const Sample& sample, std::int64_t back);
};

}  // namespace lineshaft
