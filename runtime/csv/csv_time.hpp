#pragma once

#include <cstdint>
#include <optional>

#include "runtime/csv/csv_reader.hpp"
#include "runtime/source/reader.hpp"

namespace lineshaft {

/// The line of the file that a person sees.
std::size_t line_of(std::size_t row);

/// The time in a row of the column `time`, given in `unit`, in ns and moved by `shift` [ns]. L0308
/// at `file`, the node that names the file, when it lies more than 146 years (2^62 ns) away.
std::optional<std::int64_t> time_of(const CsvColumn& time, std::size_t row, const Unit& unit,
                                    std::int64_t shift, const Reader& read, const Node& file);

}  // namespace lineshaft
