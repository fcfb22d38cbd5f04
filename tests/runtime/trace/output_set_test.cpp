#include "runtime/trace/output_set.hpp"

#include <catch2/catch.hpp>

#include "tests/folder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;
namespace fs = std::filesystem;

namespace {

std::unique_ptr<OutputFile> file_of(const std::string& path, const std::string& text) {
    auto file = std::make_unique<OutputFile>(path);
    file->write(text);
    return file;
}

}  // namespace

TEST_CASE("the files of a set appear together, with their sidecars") {
    const Folder folder;
    std::ofstream(folder / "b.csv-metadata.json") << "of before";
    OutputSet set;
    set.add(file_of(folder / "a.csv", "a"), "of a");
    set.add(file_of(folder / "b.csv", "b"));
    CHECK_FALSE(fs::exists(folder / "a.csv"));
    CHECK(set.commit());
    CHECK(read(folder / "a.csv") == "a");
    CHECK(read(folder / "a.csv-metadata.json") == "of a");
    CHECK(read(folder / "b.csv") == "b");
    CHECK_FALSE(fs::exists(folder / "b.csv-metadata.json"));
    CHECK(std::distance(fs::directory_iterator(fs::path(folder / "a.csv").parent_path()), {}) == 3);
}

TEST_CASE("when one file of a set cannot be written, those of before stay") {
    const Folder folder;
    for (const char* name : {"a.csv", "a.csv-metadata.json"}) std::ofstream(folder / name) << "old";
    OutputSet set;
    set.add(file_of(folder / "a.csv", "new"), "of new");
    set.add(file_of("/dev/full", "lost"));
    CHECK_FALSE(set.commit());
    CHECK(set.error() == "cannot write '/dev/full': No space left on device");
    CHECK(read(folder / "a.csv") == "old");
    CHECK(read(folder / "a.csv-metadata.json") == "old");
}

TEST_CASE("two writers of one name have a part each, and the last one wins") {
    const Folder folder;
    const std::string path = folder / "t.txt";
    OutputFile first(path), second(path);
    first.write("first");
    second.write("second");
    CHECK(first.part() == path + ".part");
    CHECK(second.part() == path + ".part2");
    CHECK(second.commit());
    CHECK(read(path) == "second");
    OutputFile third(path);
    CHECK(third.part() == path + ".part2");
    CHECK(first.commit());
    CHECK(read(path) == "first");
    third.write("third");
    CHECK(third.commit());
    CHECK(read(path) == "third");
    CHECK(std::distance(fs::directory_iterator(fs::path(path).parent_path()), {}) == 1);
}

TEST_CASE("a part that its writer has left is taken over") {
    const Folder folder;
    const std::string path = folder / "t.txt";
    { OutputFile(path).write("a long text that nobody finished"); }
    OutputFile file(path);
    CHECK(file.part() == path + ".part");
    file.write("short");
    CHECK(file.commit());
    CHECK(read(path) == "short");
}

TEST_CASE("a set is taken up where it was saved, in whatever part that is") {
    const Folder folder;
    const std::string path = folder / "t.txt";
    std::string state;
    {
        const OutputFile other(path);
        OutputSet set;
        set.add(file_of(path, "kept"), "of kept");
        StateWriter out;
        set.save(out);
        state = out.bytes();
    }
    OutputSet set;
    StateReader in(state);
    set.restore(in, {path});
    CHECK(in.at_end());
    OutputSet of_others;
    StateReader again(state);
    of_others.restore(again, {folder / "other.txt"});
    CHECK(!again.ok());
    CHECK(set.commit());
    CHECK(read(path) == "kept");
    CHECK(read(path + "-metadata.json") == "of kept");
}
