#include "runtime/trace/compare.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

CsvTable table(const std::vector<double>& times, const std::vector<double>& values) {
    CsvTable out;
    out.header = std::make_shared<const SourceFile>(SourceFile{"t.csv", "time,a.x"});
    out.columns.resize(2);
    out.columns[0].name = out.columns[0].title = "time";
    out.columns[0].values = times;
    out.columns[1].name = out.columns[1].title = "a.x";
    out.columns[1].unit = "mm";
    out.columns[1].values = values;
    out.rows = times.size();
    return out;
}

const std::vector<double> times{0, 0.002, 0.004};

std::string said(const CsvTable& a, const CsvTable& b, bool same_program = true) {
    Diagnostics out;
    check_comparable(a, b, same_program, out);
    return out.render();
}

}  // namespace

TEST_CASE("the distance in ulp counts the doubles between") {
    const double above = std::nextafter(1.0, 2.0);
    CHECK(ulp_distance(1, 1) == 0);
    CHECK(ulp_distance(1, above) == 1);
    CHECK(ulp_distance(above, 1) == 1);
    CHECK(ulp_distance(0.0, -0.0) == 0);
    CHECK(ulp_distance(5e-324, -5e-324) == 2);
    CHECK(ulp_distance(-1, -above) == 1);
    CHECK(ulp_distance(1, 2) == std::uint64_t{1} << 52);
    const double most = std::numeric_limits<double>::max();
    CHECK(ulp_distance(most, -most) == 2 * ulp_distance(most, 0));
}

TEST_CASE("equal tables are the same, a bit of difference is found") {
    const CsvTable a = table(times, {1, 2, 3});
    CHECK(compare(a, a, {}).same(a, a));
    const CsvTable b = table(times, {1, std::nextafter(2.0, 3.0), 4});
    const TraceComparison found = compare(a, b, {});
    REQUIRE(found.first);
    CHECK(found.first->row == 1);
    CHECK(found.first->column == 1);
    CHECK(found.greatest->row == 2);
    CHECK(found.rows == 2);
    CHECK(found.cells == 2);
}

TEST_CASE("the tolerance of a column goes before that of all") {
    const CsvTable a = table(times, {1, 2, 3}), b = table(times, {1, 2.5, 3});
    CHECK(compare(a, b, {.all = 0.5, .columns = {}}).same(a, b));
    CHECK_FALSE(compare(a, b, {.all = 0.49, .columns = {}}).same(a, b));
    CHECK(compare(a, b, {.all = 0, .columns = {{"a.x", 0.5}}}).same(a, b));
    CHECK_FALSE(compare(a, b, {.all = 1, .columns = {{"a.x", 0.1}}}).same(a, b));
}

TEST_CASE("a missing value equals a missing one only") {
    const CsvTable a = table(times, {1, missing, 3}), b = table(times, {1, 2, 3});
    CHECK(compare(a, a, {}).same(a, a));
    CHECK(compare(a, b, {.all = 1e9, .columns = {}}).first->row == 1);
    CHECK(compare(b, a, {.all = 1e9, .columns = {}}).first->row == 1);
}

TEST_CASE("whole numbers are compared exactly, whatever the tolerance of reals") {
    CsvTable a = table(times, {1, 2, 3}), b = a;
    a.columns[1].type = b.columns[1].type = Type::integer;
    constexpr std::int64_t large = std::int64_t{1} << 53;
    a.columns[1].values[2] = b.columns[1].values[2] = static_cast<double>(large);
    a.columns[1].large = {{2, large + 1}};
    b.columns[1].large = {{2, large}};
    CHECK(compare(a, b, {.all = 1e9, .columns = {}}).first->row == 2);
}

TEST_CASE("integers beyond those with a sign lie as far apart as they do") {
    CsvTable a = table(times, {1, 2, 3}), b = a;
    a.columns[1].type = b.columns[1].type = Type::integer;
    constexpr Wide most = (Wide{1} << 64) - 1;
    a.columns[1].large = {{2, most}};
    b.columns[1].large = {{2, -(Wide{1} << 63)}};
    CHECK(compare(a, b, {}).first->row == 2);
    CHECK(compare(a, b, {}).apart.front().greatest == 0x1.8p64);
    b.columns[1].large = {{2, most - 2}};
    CHECK(compare(a, b, {.all = 0, .columns = {{"a.x", 2}}}).same(a, b));
    CHECK_FALSE(compare(a, b, {.all = 0, .columns = {{"a.x", 1}}}).same(a, b));
}

TEST_CASE("tables of other length differ, though their rows agree") {
    const CsvTable a = table(times, {1, 2, 3}), b = table({0, 0.002}, {1, 2});
    const TraceComparison found = compare(a, b, {});
    CHECK_FALSE(found.first);
    CHECK(found.compared == 2);
    CHECK_FALSE(found.same(a, b));
}

TEST_CASE("tables of other columns, units, intervals or programs are not compared") {
    const CsvTable a = table(times, {1, 2, 3});
    CHECK(said(a, a).empty());
    CsvTable other = a;
    other.columns[1].name = "a.y";
    CHECK(said(a, other).find("the columns differ") != std::string::npos);
    other = a;
    other.columns[1].unit = "m";
    CHECK(said(a, other).find("column 'a.x' is in 'm' and in 'mm'") != std::string::npos);
    other = a;
    other.columns[1].type = Type::boolean;
    CHECK(said(a, other).find("is boolean and real") != std::string::npos);
    CHECK(
        said(a, table({0, 0.004, 0.008}, {1, 2, 3})).find("its interval is 0.004 s, not 0.002 s") !=
        std::string::npos);
    CsvTable one = a, two = a;
    one.metadata.emplace().program = "1";
    two.metadata.emplace().program = "2";
    CHECK(said(one, two).find("it comes from another program") != std::string::npos);
    CHECK(said(one, two, false).empty());
}
