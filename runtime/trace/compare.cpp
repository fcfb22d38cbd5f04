#include "runtime/trace/compare.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

/// Doubles in their order as integers, 0 and -0 the same.
std::int64_t ordinal(double value) {
    const auto bits = std::bit_cast<std::int64_t>(value);
    return bits < 0 ? std::numeric_limits<std::int64_t>::min() - bits : bits;
}

double distance(Wide a, Wide b) {
    return static_cast<double>(a > b ? a - b : b - a);
}

bool are_finite(const CsvColumn& a, const CsvColumn& b, std::size_t row) {
    return a.is_finite(row) && b.is_finite(row);
}

/// A cell that is empty, NaN, INF or -INF is the same as such a one only.
bool deviates(const CsvColumn& a, const CsvColumn& b, std::size_t row, double tolerance) {
    if (std::isnan(a.values[row]) && std::isnan(b.values[row]))
        return a.is_missing(row) != b.is_missing(row);
    if (!are_finite(a, b, row)) return a.values[row] != b.values[row];
    if (a.type != Type::real) return distance(a.integer(row), b.integer(row)) > tolerance;
    return std::abs(a.values[row] - b.values[row]) > tolerance;
}

double distance(const CsvColumn& a, const CsvColumn& b, std::size_t row) {
    if (!are_finite(a, b, row)) return 0;
    if (a.type != Type::real) return distance(a.integer(row), b.integer(row));
    return std::abs(a.values[row] - b.values[row]);
}

ColumnDistance distance(const CsvTable& a, const CsvTable& b, std::size_t column,
                        std::size_t rows) {
    ColumnDistance apart{.column = column};
    double sum = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        const double d = distance(a.columns[column], b.columns[column], row);
        sum += d * d;
        if (!(d > apart.greatest)) continue;
        apart.greatest = d;
        apart.row = row;
    }
    apart.rms = rows == 0 ? 0 : std::sqrt(sum / static_cast<double>(rows));
    return apart;
}

std::string names_of(const CsvTable& table) {
    std::string text;
    for (const CsvColumn& column : table.columns) text += (text.empty() ? "" : ", ") + column.name;
    return text;
}

/// Between the first two rows [s].
std::optional<double> interval(const CsvTable& table) {
    const CsvColumn* time = table.find("time");
    if (!time || table.rows < 2) return {};
    return std::round((time->values[1] - time->values[0]) * 1e9) / 1e9;
}

/// The program's hash where the sidecar does not tell the form.
const std::string& form_of(const CsvMetadata& metadata) {
    return metadata.form.empty() ? metadata.program : metadata.form;
}

std::string made_by(const CsvMetadata& metadata, const std::string& what) {
    for (const auto& [name, value] : metadata.made_by)
        if (name == what) return value;
    return {};
}

void check_columns(const CsvTable& a, const CsvTable& b, const auto& fail) {
    const auto name = [](const CsvColumn& column) { return column.name; };
    if (!std::ranges::equal(a.columns, b.columns, {}, name, name))
        return fail("the columns differ",
                    fmt::format("{} has: {}; --common compares what both have", a.header->path,
                                names_of(a)));
    for (std::size_t i = 0; i < a.columns.size(); ++i) {
        const CsvColumn &x = a.columns[i], &y = b.columns[i];
        if (x.unit != y.unit)
            fail(fmt::format("column '{}' is in '{}' and in '{}'", x.name, y.unit, x.unit), "");
        if (x.type != y.type || x.names != y.names || x.numbers != y.numbers)
            fail(fmt::format("column '{}' is {} and {}", x.name, name_of(y.type), name_of(x.type)),
                 "");
    }
}

}  // namespace

double Tolerances::of(const CsvColumn& column) const {
    const auto it = columns.find(column.name);
    if (it != columns.end()) return it->second;
    return column.type == Type::real ? all : 0;
}

std::uint64_t ulp_distance(double a, double b) {
    const std::int64_t x = ordinal(a), y = ordinal(b);
    return x > y ? static_cast<std::uint64_t>(x) - static_cast<std::uint64_t>(y)
                 : static_cast<std::uint64_t>(y) - static_cast<std::uint64_t>(x);
}

std::vector<RunDifference> run_differences(const CsvMetadata& a, const CsvMetadata& b) {
    std::vector<RunDifference> list;
    const auto add = [&](const std::string& what, std::string x, std::string y) {
        if (x != y && std::ranges::find(list, what, &RunDifference::what) == list.end())
            list.push_back({what, std::move(x), std::move(y)});
    };
    for (const CsvMetadata* side : {&a, &b})
        for (const auto& [what, value] : side->made_by)
            add(what, made_by(a, what), made_by(b, what));
    add("version", a.version, b.version);
    add("form of the program", a.form, b.form);
    return list;
}

void check_comparable(const CsvTable& a, const CsvTable& b, bool same_program, Diagnostics& out) {
    const auto fail = [&](const std::string& what, const std::string& help) {
        out.add(code::traces_cannot_be_compared, {b.header, 0, 0, 1},
                fmt::format("the trace cannot be compared with '{}': {}", a.header->path, what),
                help);
    };
    check_columns(a, b, fail);
    if (same_program && a.metadata && b.metadata && form_of(*a.metadata) != form_of(*b.metadata))
        fail("it comes from another program", "--any-program compares all the same");
    const auto x = interval(a), y = interval(b);
    if (x && y && *x != *y)
        fail(fmt::format("its interval is {} s, not {} s", format_number(*y), format_number(*x)),
             "record both with the same task and 'every'");
}

void keep_common(CsvTable& a, CsvTable& b) {
    std::vector<CsvColumn> ours, theirs;
    for (CsvColumn& x : a.columns) {
        const auto y = std::ranges::find(b.columns, x.name, &CsvColumn::name);
        if (y == b.columns.end() || y->unit != x.unit || y->type != x.type || y->names != x.names ||
            y->numbers != x.numbers)
            continue;
        ours.push_back(std::move(x));
        theirs.push_back(std::move(*y));
    }
    a.columns = std::move(ours);
    b.columns = std::move(theirs);
}

TraceComparison compare(const CsvTable& a, const CsvTable& b, const Tolerances& tolerances) {
    TraceComparison result;
    result.compared = std::min(a.rows, b.rows);
    std::vector<double> tolerance;
    for (const CsvColumn& column : a.columns) tolerance.push_back(tolerances.of(column));
    double greatest = 0;
    for (std::size_t row = 0; row < result.compared; ++row) {
        const std::size_t before = result.cells;
        for (std::size_t i = 0; i < a.columns.size(); ++i) {
            const CsvColumn &x = a.columns[i], &y = b.columns[i];
            if (!deviates(x, y, row, tolerance[i])) continue;
            ++result.cells;
            if (!result.first) result.first = {row, i};
            if (x.type != Type::real || !are_finite(x, y, row)) continue;
            const double distance = std::abs(x.values[row] - y.values[row]);
            if (!(distance > greatest)) continue;
            greatest = distance;
            result.greatest = {row, i};
        }
        if (result.cells != before) ++result.rows;
    }
    for (std::size_t i = 0; i < a.columns.size(); ++i)
        if (const auto apart = distance(a, b, i, result.compared); apart.greatest > 0)
            result.apart.push_back(apart);
    return result;
}

}  // namespace lineshaft
