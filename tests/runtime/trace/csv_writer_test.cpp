#include "runtime/trace/csv_writer.hpp"

#include <bit>
#include <limits>
#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "runtime/version.hpp"
#include "tests/allocations.hpp"
#include "tests/folder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;
namespace fs = std::filesystem;

namespace {

Signal signal(const char* name, Type type, const char* unit = "") {
    return {.name = name, .type = type, .unit = unit, .names = {}};
}

std::uint64_t word(double value) {
    return std::bit_cast<std::uint64_t>(value);
}
std::uint64_t word(std::int64_t value) {
    return static_cast<std::uint64_t>(value);
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

TraceSetup setup() {
    static constexpr std::string_view states[] = {"idle", "run"};
    TraceSetup setup;
    setup.signals = {signal("a.on", Type::boolean), signal("a.x", Type::real, "mm"),
                     signal("a.state", Type::enumeration), signal("a.n", Type::integer)};
    setup.signals[2].names = ValueNames(states);
    return setup;
}

/// Empty, or what went wrong.
std::string finish(CsvWriter& writer, const TraceOrigin& origin = {}) {
    OutputSet files;
    writer.hand_over(files, csv_sidecar(writer.written(), origin, {}, {}));
    files.commit();
    return files.error();
}
std::string finish(CsvWriter&& writer) {
    return finish(writer);
}

/// One column of reals, written and read back.
std::vector<std::string> cells(const std::vector<double>& values) {
    const Folder folder;
    const std::string path = folder / "t.csv";
    TraceSetup one;
    one.signals = {signal("a.x", Type::real)};
    CsvWriter writer(path, one);
    for (const double value : values) {
        const std::uint64_t row[] = {0, 0, word(value)};
        writer.rows(row, 1);
    }
    REQUIRE(finish(writer).empty());
    std::istringstream text(read(path));
    std::vector<std::string> result;
    std::string line;
    std::getline(text, line);
    while (std::getline(text, line)) result.push_back(line.substr(4));
    return result;
}

}  // namespace

TEST_CASE("a trace is a CSV file of one header row and a row a scan") {
    const Folder folder;
    const std::string path = folder / "t.csv";
    CsvWriter writer(path, setup());
    const std::uint64_t rows[] = {0,          0, 1, word(0.1),  1, word(std::int64_t{-7}),
                                  12'500'000, 5, 0, word(-0.0), 0, word(std::int64_t{1} << 62)};
    writer.rows(rows, 2);
    CHECK(finish(writer).empty());
    CHECK(read(path) ==
          "time,scan,a.on,a.x,a.state,a.n\n"
          "0,0,1,0.1,1,-7\n"
          "0.0125,5,0,-0,0,4611686018427387904\n");
}

TEST_CASE("what is not finite is written as in CSVW") {
    CHECK(cells({not_a_number, infinite, -infinite, 1}) ==
          std::vector<std::string>{"NaN", "INF", "-INF", "1"});
}

TEST_CASE("the sidecar tells columns, units, types, program and version") {
    const Folder folder;
    const std::string path = folder / "t.csv";
    CsvWriter writer(path, setup());
    const std::uint64_t row[] = {0, 0, 1, 0, 1, 2};
    writer.rows(row, 1);
    REQUIRE(finish(writer, {.title = "A \"title\" with umlaut \u00e4", .program = "0123"}).empty());
    const auto json = nlohmann::json::parse(read(path + "-metadata.json"));
    CHECK(json["@context"] == "http://www.w3.org/ns/csvw");
    CHECK(json["url"] == "t.csv");
    CHECK(json["dc:title"] == "A \"title\" with umlaut \u00e4");
    CHECK(json["lineshaft:version"] == version());
    CHECK(json["lineshaft:program"] == "0123");
    CHECK(json["lineshaft:rows"] == 1);
    const auto& columns = json["tableSchema"]["columns"];
    REQUIRE(columns.size() == 6);
    CHECK(columns[0]["titles"] == "time");
    CHECK(columns[0]["unit"] == "s");
    CHECK(columns[1]["datatype"] == "integer");
    CHECK(columns[2]["datatype"]["format"] == "1|0");
    CHECK(columns[3]["unit"] == "mm");
    CHECK(columns[3]["datatype"] == "double");
    CHECK_FALSE(columns[2].contains("unit"));
    CHECK(columns[4]["values"] == nlohmann::json{"idle", "run"});
    CHECK_FALSE(columns[5].contains("values"));
}

TEST_CASE("a trace appears under its name only when it is whole") {
    const Folder folder;
    const std::string path = folder / "t.csv";
    {
        std::ofstream(path) << "old";
        CsvWriter writer(path, setup());
        CHECK(read(path) == "old");
        CHECK(fs::exists(path + ".part"));
        CHECK(finish(writer).empty());
    }
    CHECK(read(path) == "time,scan,a.on,a.x,a.state,a.n\n");
    CHECK_FALSE(fs::exists(path + ".part"));
    CHECK_FALSE(fs::exists(path + "-metadata.json.part"));
}

TEST_CASE("a folder in the way is told") {
    const Folder folder;
    const std::string path = folder / "t.csv";
    fs::create_directory(path);
    CsvWriter writer(path, setup());
    CHECK(finish(writer) == "cannot write '" + path + "': it is a directory");
    CHECK_FALSE(fs::exists(path + ".part"));
}

TEST_CASE("a folder that is not there, or a file in its place, is told") {
    const Folder folder;
    const std::string missing = folder / "none/t.csv";
    CHECK(finish(CsvWriter(missing, setup())) ==
          "cannot open '" + missing + "': No such file or directory");
    std::ofstream(folder / "file") << "";
    const std::string below_file = folder / "file/t.csv";
    CHECK(finish(CsvWriter(below_file, setup())) ==
          "cannot open '" + below_file + "': Not a directory");
}

TEST_CASE("a name longer than the file system takes is told") {
    const Folder folder;
    const std::string path = folder / (std::string(300, 'x') + ".csv");
    CHECK(finish(CsvWriter(path, setup())) == "cannot open '" + path + "': File name too long");
}

TEST_CASE("a full disk is told") {
    const Folder folder;
    const std::string path = folder / "t.csv";
    fs::create_symlink("/dev/full", path + ".part");
    CsvWriter writer(path, setup());
    const std::uint64_t row[] = {0, 0, 1, 0, 1, 2};
    for (int i = 0; i < 10'000; ++i) writer.rows(row, 1);
    CHECK(finish(writer) == "cannot write '" + path + "': No space left on device");
    CHECK_FALSE(fs::exists(path));
}

TEST_CASE("a full disk is told by the sidecar, too") {
    const Folder folder;
    const std::string path = folder / "t.csv";
    fs::create_symlink("/dev/full", path + "-metadata.json.part");
    CHECK(finish(CsvWriter(path, setup())) ==
          "cannot write '" + path + "-metadata.json': No space left on device");
}

TEST_CASE("a folder that may not be written to is told") {
    if (::geteuid() == 0) return;  // nothing is forbidden to root
    const Folder folder;
    fs::create_directory(folder / "closed");
    fs::permissions(folder / "closed", fs::perms::none);
    const std::string path = folder / "closed/t.csv";
    CHECK(finish(CsvWriter(path, setup())) == "cannot open '" + path + "': Permission denied");
    fs::permissions(folder / "closed", fs::perms::owner_all);
}

TEST_CASE("rows of a block are written without allocating") {
    const Folder folder;
    CsvWriter writer(folder / "t.csv", setup());
    std::vector<std::uint64_t> block(6 * 1024, 1);
    const std::int64_t before = test::allocations();
    for (int i = 0; i < 10; ++i) writer.rows(block.data(), 1024);
    CHECK(test::allocations() == before);
    CHECK(finish(writer).empty());
}
