#include "runtime/csv/csv_time.hpp"

#include <cmath>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"

namespace lineshaft {

std::size_t line_of(std::size_t row) {
    return row + 2;
}

std::optional<std::int64_t> time_of(const CsvColumn& time, std::size_t row, const Unit& unit,
                                    std::int64_t shift, const Reader& read, const Node& file) {
    constexpr double most = 0x1p62;
    static const Unit nanosecond = *Unit::parse("ns");
    const double at = std::round(convert(time.values[row], unit, nanosecond));
    if (std::abs(at) + static_cast<double>(shift) < most)
        return static_cast<std::int64_t>(at) + shift;
    read.fail(code::not_a_time, file,
              fmt::format("the time in line {} of '{}' lies more than 146 years away", line_of(row),
                          file.text),
              "times are in s, or in the unit of a title such as 'time [ms]'");
    return {};
}

}  // namespace lineshaft
