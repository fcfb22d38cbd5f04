#include "runtime/trace/output_file.hpp"

#include <thread>

#include <catch2/catch.hpp>
#include <sys/stat.h>

#include "tests/folder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;
namespace fs = std::filesystem;

TEST_CASE("an abandoned file stays in its part, the one before under its name") {
    const Folder folder;
    const std::string path = folder / "t.txt";
    std::ofstream(path) << "old";
    {
        OutputFile file(path);
        file.write("new");
    }
    CHECK(read(path) == "old");
    CHECK(read(path + ".part") == "new");
}

TEST_CASE("a device is written to as it is and stays a device") {
    OutputFile file("/dev/full");
    CHECK_FALSE(file.is_regular());
    file.write("lost");
    CHECK_FALSE(file.commit());
    CHECK(file.error() == "cannot write '/dev/full': No space left on device");
    CHECK(fs::is_character_file("/dev/full"));
    CHECK_FALSE(fs::exists("/dev/full.part"));
}

TEST_CASE("a pipe is written to as it is") {
    const Folder folder;
    const std::string path = folder / "pipe";
    REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
    std::string text;
    std::jthread reader([&] { text = read(path); });
    OutputFile file(path);
    file.write("to the reader");
    CHECK(file.commit());
    reader.join();
    CHECK(text == "to the reader");
    CHECK_FALSE(fs::exists(path + ".part"));
}
