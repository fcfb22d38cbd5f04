#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/csv/csv_metadata.hpp"
#include "runtime/model/value.hpp"
#include "runtime/source/diagnostic.hpp"

namespace lineshaft {

/// One column of numbers.
struct CsvColumn {
    std::string name;   ///< of the signal where the sidecar tells it, else the title without unit
    std::string title;  ///< as the header has it
    std::string unit;  ///< from the sidecar, or from a title `name [unit]`; empty: none, or unknown
    Type type = Type::real;          ///< from the sidecar; without one all are real
    std::vector<std::string> names;  ///< of an enumeration; cells may have them
    std::vector<Wide> numbers;       ///< of the names; empty: 0, 1, 2, ...
    std::vector<double> values;      ///< a row each; not a number where the cell is empty, too

    struct Large {
        std::size_t row;
        Wide value;
    };
    std::vector<Large> large;              ///< integers from 2^53 on, which `values` rounds; by row
    std::vector<std::size_t> not_numbers;  ///< rows whose cell is NaN; from the first on

    /// The number of the name that stands at `place`.
    Wide number(std::size_t place) const {
        return numbers.empty() ? static_cast<Wide>(place) : numbers[place];
    }
    /// The cell is empty.
    bool is_missing(std::size_t row) const {
        return values[row] != values[row] && !std::ranges::binary_search(not_numbers, row);
    }
    bool is_finite(std::size_t row) const { return std::isfinite(values[row]); }
    /// Exact, of 64 bits with or without a sign; 0 where the cell is empty. Not of reals.
    Wide integer(std::size_t row) const;
};

/// The columns that were asked for, in the order of the file.
struct CsvTable {
    std::shared_ptr<const SourceFile> header;  ///< path and first line, for messages
    std::vector<CsvColumn> columns;
    std::size_t rows = 0;
    std::string crc32;                    ///< Checksum of all bytes of the file
    std::optional<CsvMetadata> metadata;  ///< of the sidecar, if there is one

    /// By name or title; null when there is none.
    const CsvColumn* find(std::string_view name) const;

    /// As `find`; L0702 with a suggestion when there is none, at `where` or else at the header.
    const CsvColumn* require(std::string_view name, Diagnostics& out, Mark where = {}) const;
};

struct CsvOptions {
    std::vector<std::string> columns =
        {};  ///< names or titles; empty: all. Others are not looked at
    std::map<std::string, std::vector<std::string>> names =
        {};  ///< of columns whose cells may be the names of 0, 1, 2 and so on
    std::size_t most_rows = static_cast<std::size_t>(-1);  ///< that may be kept in memory
    bool last_row_may_be_cut = false;  ///< what a crash left: read up to the last full row
};

/// Reads a CSV file (RFC 4180) whose first line names its columns and whose cells are numbers,
/// or names of them, empty where a value is missing: a trace, or what another tool wrote. Reals may
/// be NaN, INF and -INF, or nan, inf, infinity; times may not. Quoted cells, lines that end with CR
/// LF or CR, a byte order mark and blanks around numbers are taken; with semicolons between cells
/// the decimal point may be a comma. A pipe will do. Empty when anything is wrong; then `out` says
/// what, at most 20 mistakes:
///   L0001  the file cannot be read
///   L0701  empty file, a first line that names no columns, or a program (YAML)
///   L0702  a column that was asked for is not there
///   L0703  two columns of one name
///   L0704  a row with more or fewer cells than the header
///   L0705  no number, or not one of the column's type
///   L0706  the file is cut: the sidecar tells of more rows, or the last one has no line end
///   L0707  the sidecar cannot be understood
///   L0710  more rows than allowed
std::optional<CsvTable> read_csv(const std::string& path, Diagnostics& out,
                                 const CsvOptions& options = {});

}  // namespace lineshaft
