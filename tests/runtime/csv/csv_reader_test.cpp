#include "runtime/csv/csv_reader.hpp"

#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "runtime/trace/csv_writer.hpp"
#include "tests/folder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

struct Read {
    std::optional<CsvTable> table;
    std::string said;  ///< without the folder
};

Read read_text(const std::string& text, const CsvOptions& options = {},
               const std::string& sidecar = {}) {
    const Folder folder;
    const std::string path = folder / "t.csv";
    std::ofstream(path, std::ios::binary) << text;
    if (!sidecar.empty()) std::ofstream(sidecar_path(path), std::ios::binary) << sidecar;
    Diagnostics out;
    Read result{read_csv(path, out, options), out.render()};
    const std::string place = folder / "";
    for (auto at = result.said.find(place); at != std::string::npos; at = result.said.find(place))
        result.said.erase(at, place.size());
    CHECK(result.table.has_value() == result.said.empty());
    return result;
}

std::vector<double> values(const Read& read, const char* name) {
    INFO(read.said);
    REQUIRE(read.table);
    const CsvColumn* column = read.table->find(name);
    REQUIRE(column);
    CHECK(column->values.size() == read.table->rows);
    return column->values;
}

using Values = std::vector<double>;

const char* const sidecar =
    R"({"dc:title": "A run", "lineshaft:program": "0123", "lineshaft:rows": 2,
 "tableSchema": {"columns": [
  {"titles": "time", "datatype": "double", "unit": "s"},
  {"titles": "a_on", "lineshaft:signal": "a.on", "datatype": {"base": "boolean", "format": "1|0"}},
  {"titles": "a.n", "datatype": "integer"},
  {"titles": "a.state", "datatype": "integer", "values": ["idle", "run"]}]}})";

}  // namespace

TEST_CASE("columns of a CSV file are found by name") {
    const Read read = read_text("time,a.x\n0,1\n0.5,-2.5e3\n");
    CHECK(values(read, "time") == Values{0, 0.5});
    CHECK(values(read, "a.x") == Values{1, -2500});
    CHECK(read.table->find("a.y") == nullptr);
    CHECK(read.table->rows == 2);
}

TEST_CASE("what other tools write is read as well") {
    CHECK(values(read_text("\xEF\xBB\xBF\"x\",y\r\n \"1\" , +2\r\n3,4"), "x") == Values{1, 3});
    CHECK(values(read_text("x;y [mm]\n1,5;2\n-0,25;3\n"), "x") == Values{1.5, -0.25});
    const Read quoted = read_text("\"a, \"\"b\"\"\",c\n1,2\n");
    CHECK(values(quoted, "a, \"b\"") == Values{1});
    const Read unit = read_text("time [s],x [mm/s]\n1,2\n");
    CHECK(values(unit, "x") == Values{2});
    CHECK(values(unit, "x [mm/s]") == Values{2});
    CHECK(unit.table->find("x")->unit == "mm/s");
}

TEST_CASE("an empty cell is a missing value") {
    const Read read = read_text("x,y\n,1\n2,\n");
    const Values x = values(read, "x"), y = values(read, "y");
    CHECK(std::isnan(x[0]));
    CHECK(x[1] == 2);
    CHECK(std::isnan(y[1]));
    CHECK(read.table->find("x")->is_missing(0));
    CHECK(std::isnan(values(read_text("x\n\n1\n"), "x")[0]));
}

TEST_CASE("a real that is not finite is read as what it is, a time is not") {
    const Read read = read_text("x,y\nINF,1\n-INF,1\nNaN,1\n,1\ninf,1\n-nan,1\n\"Infinity\",1\n");
    const Values x = values(read, "x");
    const double infinite = std::numeric_limits<double>::infinity();
    CHECK(x[0] == infinite);
    CHECK(x[1] == -infinite);
    CHECK(x[4] == infinite);
    CHECK(x[6] == infinite);
    const CsvColumn& column = *read.table->find("x");
    for (const std::size_t row : {2u, 3u, 5u}) {
        CHECK(std::isnan(x[row]));
        CHECK(column.is_missing(row) == (row == 3));
    }
    CHECK(read_text("time,x\nINF,1\n")
              .said.starts_with("t.csv:2:1: error[L0705]: 'INF' in column 'time' is not a time\n"));
}

TEST_CASE("an enumeration without a sign has numbers beyond 2^63") {
    const Read read = read_text("time,m\n0,18446744073709551615\n1,Far\n", {}, R"({"tableSchema":
        {"columns": [{"titles": "time", "datatype": "double"},
                     {"titles": "m", "datatype": "integer", "values": ["Near", "Far"],
                      "lineshaft:numbers": [0, 18446744073709551614]}]}})");
    REQUIRE(read.table);
    CHECK(read.table->find("m")->integer(0) == Wide{18446744073709551615u});
    CHECK(read.table->find("m")->integer(1) == Wide{18446744073709551614u});
}

TEST_CASE("cells of a column with names may be one of them, or its number") {
    const CsvOptions options{.names = {{"curve", {"line", "arc"}}}};
    CHECK(values(read_text("x,curve\n1,arc\n2,\"line\"\n3,1\n", options), "curve") ==
          Values{1, 0, 1});
    CHECK(std::isnan(values(read_text("x,curve\n1,\n", options), "curve")[0]));
    CHECK(read_text("x,curve\n1,bow\n", options).said ==
          "t.csv:2:3: error[L0705]: 'bow' in column 'curve' is not a number\n"
          "   2 | 1,bow\n"
          "     |   ^~~ write line, arc\n");
    CHECK_FALSE(read_text("x,curve\narc,arc\n", options).said.empty());
}

TEST_CASE("a header alone is a table of no rows") {
    CHECK(values(read_text("x,y\n"), "y").empty());
    CHECK(values(read_text("x,y"), "y").empty());
}

TEST_CASE("only the columns that are asked for are looked at") {
    const Read read = read_text("channel,time_ns,x\na,1,2\nb,3,4\n", {.columns = {"x", "time_ns"}});
    REQUIRE(read.table);
    REQUIRE(read.table->columns.size() == 2);
    CHECK(read.table->columns[0].name == "time_ns");
    CHECK(values(read, "x") == Values{2, 4});
}

TEST_CASE("the sidecar tells names, types and units") {
    const Read read =
        read_text("time,a_on,a.n,a.state\n0,1,9007199254740993,1\n1,0,,0\n", {}, sidecar);
    CHECK(values(read, "a.on") == Values{1, 0});
    CHECK(values(read, "a_on") == Values{1, 0});
    CHECK(read.table->find("a.n")->integer(0) == 9007199254740993);
    CHECK(read.table->find("a.n")->integer(1) == 0);
    CHECK(read.table->find("a.n")->is_missing(1));
    CHECK(read.table->find("a.state")->names == std::vector<std::string>{"idle", "run"});
    CHECK(read.table->find("a.state")->type == Type::enumeration);
    CHECK(read.table->find("time")->unit == "s");
    CHECK(read.table->metadata->title == "A run");
    CHECK(read.table->metadata->program == "0123");
}

TEST_CASE("what the writer wrote is read back bit by bit") {
    const Folder folder;
    TraceSetup setup;
    setup.signals = {{.name = "a.x", .type = Type::real, .unit = "mm", .names = {}},
                     {.name = "a.n", .type = Type::integer, .unit = {}, .names = {}},
                     {.name = "a.on", .type = Type::boolean, .unit = {}, .names = {}},
                     {.name = "a.u", .type = Type::unsigned_integer, .unit = {}, .names = {}}};
    const std::vector<double> reals{0.1, -1.0 / 3, 5e-324, 1.7976931348623157e308, -0.0};
    CsvWriter writer(folder / "t.csv", setup);
    for (std::size_t i = 0; i < reals.size(); ++i) {
        const std::uint64_t row[] = {i * 2'000'000,
                                     i,
                                     std::bit_cast<std::uint64_t>(reals[i]),
                                     (std::uint64_t{1} << 63) + i,
                                     i % 2,
                                     ~std::uint64_t{i}};
        writer.rows(row, 1);
    }
    OutputSet files;
    writer.hand_over(files, csv_sidecar(writer.written(), {}, {}, {}));
    REQUIRE(files.commit());
    Diagnostics out;
    const auto table = read_csv(folder / "t.csv", out);
    REQUIRE(table);
    REQUIRE(table->rows == reals.size());
    for (std::size_t i = 0; i < reals.size(); ++i) {
        CHECK(std::bit_cast<std::uint64_t>(table->find("a.x")->values[i]) ==
              std::bit_cast<std::uint64_t>(reals[i]));
        CHECK(static_cast<std::uint64_t>(table->find("a.n")->integer(i)) ==
              (std::uint64_t{1} << 63) + i);
        CHECK(table->find("a.on")->values[i] == static_cast<double>(i % 2));
        CHECK(table->find("a.u")->integer(i) == Wide{~std::uint64_t{i}});
        CHECK(table->find("time")->values[i] == static_cast<double>(i) * 2e-3);
    }
    CHECK(table->find("a.x")->unit == "mm");
    CHECK(table->find("a.u")->type == Type::integer);
}

TEST_CASE("a file that is not there, a folder and an empty file are told") {
    Diagnostics out;
    CHECK_FALSE(read_csv("/nonexistent/t.csv", out));
    CHECK(out.render() ==
          "error[L0001]: cannot read '/nonexistent/t.csv': No such file or directory\n");
    const Folder folder;
    Diagnostics of_folder;
    CHECK_FALSE(read_csv(folder / "", of_folder));
    CHECK(of_folder.render().find("Is a directory") != std::string::npos);
    CHECK(read_text("").said ==
          "t.csv: error[L0701]: the file is empty\n     | the first line names the columns\n");
}

TEST_CASE("mistakes of a CSV file are told with their places") {
    CHECK(read_text("x,y\n1,2\n1,fast\n").said ==
          "t.csv:3:3: error[L0705]: 'fast' in column 'y' is not a number\n"
          "   3 | 1,fast\n"
          "     |   ^~~~ leave the cell empty where there is no value\n");
    CHECK(read_text("\xC3\xA4,y\n\xC3\xA4,1\n").said.starts_with("t.csv:2:1: error[L0705]: "));
    CHECK(read_text("x,y\n1,2,3\n").said ==
          "t.csv:2:1: error[L0704]: the row has 3 cells instead of 2\n"
          "   2 | 1,2,3\n"
          "     | ^~~~~ with decimal commas, semicolons stand between the cells\n");
    CHECK(read_text("x,y\n1,2\n1").said ==
          "t.csv:3:1: error[L0706]: the row has 1 cell instead of 2: the file is cut\n"
          "   3 | 1\n"
          "     | ^\n");
    for (const char* word : {"nan(", "infinite", "0x10", "1 2", "1e999", "true", "+-1", "1,5;"})
        CHECK(read_text(fmt::format("x,y\n1,{}\n", word)).said.find("error[L070") !=
              std::string::npos);
    CHECK(read_text("x,x\n1,2\n")
              .said.starts_with("t.csv:1:3: error[L0703]: two columns are called 'x'"));
    CHECK(read_text("1,2\n3,4\n").said.starts_with("t.csv:1:1: error[L0701]: '1' is not a name"));
    CHECK(read_text("x,\n1,2\n").said.starts_with("t.csv:1:3: error[L0701]: a column has no name"));
    CHECK(read_text("time,a.x\n1,2\n", {.columns = {"a.y"}}).said ==
          "t.csv:1:1: error[L0702]: 't.csv' has no column 'a.y'\n"
          "   1 | time,a.x\n"
          "     | ^~~~~~~~ known: time, a.x\n");
}

TEST_CASE("blank lines at the end are no rows") {
    for (const char* end : {"\n", "\n\n", "\n\n\n", "\r\n\r\n", "\n  \n", "\n\r", "\n\n "}) {
        INFO(end);
        CHECK(values(read_text(std::string("x,y\n1,2\n3,4") + end), "y") == Values{2, 4});
        CHECK(values(read_text(std::string("x\n1\n3") + end), "x") == Values{1, 3});
        CHECK(values(read_text(std::string("x\n1\n3") + end, {.most_rows = 2}), "x") ==
              Values{1, 3});
        CHECK(values(read_text(std::string("x\n1\n3") + end, {.last_row_may_be_cut = true}), "x") ==
              Values{1, 3});
    }
    CHECK(values(read_text("x\n1\n\n3\n"), "x").size() == 3);
    CHECK(read_text("x,y\n1,2\n\n3,4\n").said ==
          "t.csv:3:1: error[L0704]: the row has 1 cell instead of 2\n   3 |\n     | ^\n");
    const std::string said = read_text("x,y\n" + std::string(100'000, '\n') + "1,2\n").said;
    CHECK(said.size() < 4000);
    CHECK(read_text("x\n1\n\n\n3\n", {.most_rows = 3}).said.find("L0710") != std::string::npos);
    CHECK(values(read_text("time\n1\n\n", {}, sidecar), "time").size() == 2);
}

TEST_CASE("no more rows than allowed are read") {
    CHECK(values(read_text("x\n1\n2\n", {.most_rows = 2}), "x") == Values{1, 2});
    CHECK(read_text("x\n1\n2\n3\n", {.most_rows = 2}).said.find("error[L0710]: more than 2 rows") !=
          std::string::npos);
}

TEST_CASE("mistakes are bounded") {
    std::string text = "x,y\n";
    for (int i = 0; i < 100'000; ++i) text += "a,b\n";
    const std::string said = read_text(text).said;
    CHECK(said.size() < 4000);
    CHECK(said.find("the rest of the file is not read") != std::string::npos);
    CHECK(read_text("x\n" + std::string(3 << 20, '1')).said.find("line 2 has more than") !=
          std::string::npos);
}

TEST_CASE("values that a column's type does not have are told") {
    CHECK(read_text("a_on\n2\n1\n", {}, sidecar).said.find("'2' in column 'a_on'") !=
          std::string::npos);
    CHECK(read_text("a.state\noff\n1\n", {}, sidecar).said.find("'off' in column") !=
          std::string::npos);
    CHECK(values(read_text("a.state\n2\n1\n", {}, sidecar), "a.state") == Values{2, 1});
    CHECK(read_text("a.n\n1.5\n1\n", {}, sidecar).said.find("'1.5' in column") !=
          std::string::npos);
}

TEST_CASE("a file shorter than its sidecar tells is told, and a sidecar that is none") {
    CHECK(read_text("time\n1\n", {}, sidecar)
              .said.starts_with(
                  "t.csv: error[L0706]: the file has 1 rows, where its sidecar tells of 2\n"));
    CHECK(read_text("time\n1\n2", {}, sidecar).said.find("its last row has no end") !=
          std::string::npos);
    for (const char* text :
         {"{", "[]", "{}", "{\"tableSchema\": 1}", "{\"tableSchema\": {\"columns\": 1}}"})
        CHECK(read_text("time\n1\n", {}, text).said.find("error[L0707]") != std::string::npos);
}

TEST_CASE("what a crash left is read up to its last full row") {
    const CsvOptions cut{.last_row_may_be_cut = true};
    CHECK(values(read_text("x,y\n1,2\n3,4\n5", cut), "x") == Values{1, 3});
    CHECK(values(read_text("x,y\n1,2\n3,4", cut), "y") == Values{2});
    CHECK(values(read_text("x,y\n1,2\n3,4\n", cut), "y") == Values{2, 4});
    CHECK(read_text("x,y\n1\n3,4", cut).said.find("error[L0704]") != std::string::npos);
}

TEST_CASE("a line ends with LF, CR LF or CR, also where the file is read in parts") {
    for (const char* end : {"\n", "\r\n", "\r"}) {
        std::string text = fmt::format("x,y{}", end);
        Values wanted;
        for (int i = 0; i < 300'000; ++i) {
            text += fmt::format("{},{}{}", i, i % 7, end);
            wanted.push_back(i);
        }
        CHECK((values(read_text(text), "x") == wanted));
    }
    CHECK(values(read_text("x\r1\n2\r\n3\r"), "x") == Values{1, 2, 3});
    CHECK(read_text("x,y\r1,2\r3\r").said.find("t.csv:3:1: error[L0704]") != std::string::npos);
}

TEST_CASE("of a file with mistakes everywhere some are told, and little is kept") {
    std::string titles = "1", rows = "x\n";
    for (int i = 0; i < 100'000; ++i) titles += ",1", rows += "?\n";
    for (const std::string& text : {titles + "\n", rows, "x\n" + titles + "\n"}) {
        Diagnostics out;
        const Folder folder;
        std::ofstream(folder / "t.csv", std::ios::binary) << text;
        CHECK_FALSE(read_csv(folder / "t.csv", out));
        CHECK(out.count() <= 21);
        std::size_t kept = 0;
        std::set<const SourceFile*> files;
        for (const Diagnostic& d : out.list())
            if (files.insert(d.mark.file.get()).second) kept += d.mark.file->text.size();
        CHECK(kept <= text.size() + 100);
    }
}
