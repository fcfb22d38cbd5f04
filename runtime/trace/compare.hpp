#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/csv/csv_reader.hpp"

namespace lineshaft {

/// How far two values may lie apart, in the unit of their column.
struct Tolerances {
    double all = 0;                         ///< for real columns without one of their own
    std::map<std::string, double> columns;  ///< by name
    double of(const CsvColumn& column) const;
};

/// A cell in which two traces differ by more than the tolerance.
struct Deviation {
    std::size_t row = 0;
    std::size_t column = 0;  ///< of either table
};

/// How far the values of a column lie apart where both traces have one, whatever is tolerated.
struct ColumnDistance {
    std::size_t column = 0;  ///< of either table
    double greatest = 0, rms = 0;
    std::size_t row = 0;  ///< of the greatest
};

struct TraceComparison {
    std::optional<Deviation> first;     ///< by row, then column
    std::optional<Deviation> greatest;  ///< by the plain distance, among reals
    std::size_t cells = 0;              ///< that deviate
    std::size_t rows = 0;               ///< that hold such cells
    std::size_t compared = 0;           ///< rows that both have
    std::vector<ColumnDistance> apart;  ///< the columns with any distance

    bool same(const CsvTable& a, const CsvTable& b) const { return !first && a.rows == b.rows; }
};

/// Something in which two runs differ; empty where one of them does not have it.
struct RunDifference {
    std::string what;
    std::string a, b;
};

/// What differs in what made two traces, by their sidecars: parameters, seed, controller, ...
std::vector<RunDifference> run_differences(const CsvMetadata& a, const CsvMetadata& b);

/// L0708 unless both have the same columns in the same order with the same units and types, the
/// same interval, and programs of the same form, see Meaning (asked only when `same_program`): else
/// there is nothing to compare.
void check_comparable(const CsvTable& a, const CsvTable& b, bool same_program, Diagnostics& out);

/// Leaves the columns that both have with the same unit and type, in the order of `a`.
void keep_common(CsvTable& a, CsvTable& b);

/// Compares two comparable tables cell by cell, as far as both have rows. A missing value equals a
/// missing one only, NaN equals NaN, an infinite value the same one.
TraceComparison compare(const CsvTable& a, const CsvTable& b, const Tolerances& tolerances);

/// How many doubles lie between two finite ones, and one more; 0 for equal ones, and for 0 and -0.
std::uint64_t ulp_distance(double a, double b);

}  // namespace lineshaft
