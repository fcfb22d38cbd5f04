#include "runtime/source/diagnostic.hpp"

#include <chrono>

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace lineshaft;

namespace {

std::shared_ptr<const SourceFile> file_of(std::string text, std::string path = "a.yaml") {
    return std::make_shared<const SourceFile>(SourceFile{std::move(path), std::move(text)});
}

std::string shown(std::string text, int line, int column, int length, std::string help = {}) {
    const Mark mark{file_of(std::move(text)), line, column, length};
    return render({"L0203", mark, "wrong", std::move(help)});
}

}  // namespace

TEST_CASE("a diagnostic reads like a compiler's") {
    std::string text;
    for (int i = 1; i < 9; ++i) text += "# line\n";
    text += "    master_velocity: shaft.velocty\nlast: 1\n";
    const Mark mark{file_of(text, "programs/02_gear.yaml"), 9, 22, 13};
    const Diagnostic diagnostic{"L0203", mark, "unknown port 'velocty' on 'shaft' (axis)",
                                "did you mean 'shaft.velocity'?"};
    CHECK(render(diagnostic) ==
          "programs/02_gear.yaml:9:22: error[L0203]: unknown port 'velocty' on 'shaft' (axis)\n"
          "   9 |     master_velocity: shaft.velocty\n"
          "     |                      ^~~~~~~~~~~~~ did you mean 'shaft.velocity'?\n");
}

TEST_CASE("a diagnostic without help ends at the caret") {
    CHECK(shown("abc", 1, 2, 1) == "a.yaml:1:2: error[L0203]: wrong\n   1 | abc\n     |  ^\n");
}

TEST_CASE("a diagnostic without a place shows file, message and help") {
    CHECK(render({"L0001", {}, "no such file", ""}) == "error[L0001]: no such file\n");
    CHECK(render({"L0001", {}, "no such file", "is it here?"}) ==
          "error[L0001]: no such file\n     | is it here?\n");
    CHECK(render({"L0105", {file_of(""), 0, 0, 1}, "empty", ""}) ==
          "a.yaml: error[L0105]: empty\n");
}

TEST_CASE("a place after the line's or the file's end has a caret all the same") {
    CHECK(shown("ab\n", 1, 3, 1) == "a.yaml:1:3: error[L0203]: wrong\n   1 | ab\n     |   ^\n");
    CHECK(shown("ab\n", 1, 99, 9) == "a.yaml:1:99: error[L0203]: wrong\n   1 | ab\n     |   ^\n");
    CHECK(shown("ab\n", 2, 1, 1) == "a.yaml:2:1: error[L0203]: wrong\n   2 |\n     | ^\n");
    CHECK(shown("", 7, 3, 1) == "a.yaml:7:3: error[L0203]: wrong\n   7 |\n     | ^\n");
    CHECK(shown("ab\ncd", 1, 2, 50) == "a.yaml:1:2: error[L0203]: wrong\n   1 | ab\n     |  ^\n");
    CHECK(shown("ab", 1, -3, -7) == "a.yaml:1:-3: error[L0203]: wrong\n   1 | ab\n     | ^\n");
}

TEST_CASE("columns count characters and the byte order mark is none") {
    CHECK(shown("\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80x: y", 1, 4, 1) ==
          "a.yaml:1:4: error[L0203]: wrong\n"
          "   1 | \xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80x: y\n     |    ^\n");
    CHECK(shown("\xEF\xBB\xBFkey", 1, 1, 3) ==
          "a.yaml:1:1: error[L0203]: wrong\n   1 | key\n     | ^~~\n");
}

TEST_CASE("nothing in a file or a message reaches the terminal as a control") {
    CHECK(shown("a\x1B[31m\tb\r\n", 1, 7, 2) ==
          "a.yaml:1:7: error[L0203]: wrong\n   1 | a?[31m b\n     |       ^~\n");
    CHECK(shown("a\xFF\xC0\x80z", 1, 5, 1) ==
          "a.yaml:1:5: error[L0203]: wrong\n   1 | a???z\n     |     ^\n");
    CHECK(shown("a\xE2\x80\xAE"
                "b\xC2\x9B",
                1, 1, 1) == "a.yaml:1:1: error[L0203]: wrong\n   1 | a?b?\n     | ^\n");
    CHECK(render({"L0001", {file_of("", "x\ny"), 0, 0, 1}, "bad\n\x07name", ""}) ==
          "x?y: error[L0001]: bad??name\n");
    CHECK(render({"L0001", {}, std::string(2000, 'm'), ""}) ==
          "error[L0001]: " + std::string(1000, 'm') + "...\n");
    CHECK(render({"L0001", {}, std::string(1000, 'm'), ""}) ==
          "error[L0001]: " + std::string(1000, 'm') + "\n");
}

TEST_CASE("a long line is shown as a window around the mark") {
    const std::string line = std::string(300, 'a') + "WRONG" + std::string(300, 'b');
    CHECK(shown(line, 1, 301, 5, "help") ==
          "a.yaml:1:301: error[L0203]: wrong\n   1 | ..." + std::string(40, 'a') + "WRONG" +
              std::string(55, 'b') + "...\n     | " + std::string(43, ' ') + "^~~~~ help\n");
    CHECK(shown(line, 1, 1, 1) ==
          "a.yaml:1:1: error[L0203]: wrong\n   1 | " + std::string(100, 'a') + "...\n     | ^\n");
    CHECK(shown(line, 1, 606, 1) == "a.yaml:1:606: error[L0203]: wrong\n   1 | ..." +
                                        std::string(40, 'b') + "\n     | " + std::string(43, ' ') +
                                        "^\n");
    CHECK(shown(std::string(100, 'a'), 1, 90, 1) == "a.yaml:1:90: error[L0203]: wrong\n   1 | " +
                                                        std::string(100, 'a') + "\n     | " +
                                                        std::string(89, ' ') + "^\n");
    CHECK(shown(line, 1, 1, 10'000).find(std::string(99, '~') + "\n") != std::string::npos);
}

TEST_CASE("line numbers of more than four digits widen both rows") {
    const std::string text = std::string(12344, '\n') + "x";
    CHECK(shown(text, 12345, 1, 1) ==
          "a.yaml:12345:1: error[L0203]: wrong\n12345 | x\n      | ^\n");
}

TEST_CASE("diagnostics are sorted by place, equal ones shown once") {
    const auto a = file_of("x\ny\n", "a");
    const auto b = file_of("x\ny\n", "b");
    Diagnostics all;
    CHECK(all.empty());
    CHECK(all.render().empty());
    all.add("L0003", {b, 1, 1, 1}, "fourth");
    all.add("L0002", {a, 2, 1, 1}, "third");
    all.add("L0001", {a, 1, 1, 1}, "first");
    all.add("L0002", {a, 1, 1, 1}, "second");
    all.add("L0001", {a, 1, 1, 1}, "first");
    all.add("L0000", {}, "before all");
    CHECK_FALSE(all.empty());
    CHECK(all.list().size() == 6);
    CHECK(all.render() ==
          "error[L0000]: before all\n"
          "a:1:1: error[L0001]: first\n   1 | x\n     | ^\n"
          "a:1:1: error[L0002]: second\n   1 | x\n     | ^\n"
          "a:2:1: error[L0002]: third\n   2 | y\n     | ^\n"
          "b:1:1: error[L0003]: fourth\n   1 | x\n     | ^\n");
}

TEST_CASE("a limit ends the list with the number left out") {
    Diagnostics all;
    for (int i = 0; i < 60; ++i) all.add("L0001", {}, fmt::format("m{}", 100 + i));
    CHECK(all.render(2) == "error[L0001]: m100\nerror[L0001]: m101\n... and 58 more\n");
    CHECK(all.render().find("... and 10 more\n") != std::string::npos);
    CHECK(all.render(60).find("more") == std::string::npos);
    CHECK(all.render(0) == "... and 60 more\n");
}

TEST_CASE("the nearest name") {
    const std::vector<std::string> names{"velocity", "position", "jerk", "q"};
    using Names = std::vector<std::string>;
    for (const char* word : {"velocty", "velcoity", "vlecoity", "Velocity", "VELOCITY", "vel"})
        CHECK(nearest(word, names) == Names{"velocity"});
    CHECK(nearest("jrek", names) == Names{"jerk"});
    CHECK(nearest("jrke", names).empty());
    CHECK(nearest("jerks", names) == Names{"jerk"});
    for (const char* word : {"acceleration", "x", "q1", "", "ve"})
        CHECK(nearest(word, names).empty());
    CHECK(nearest("Q", names) == Names{"q"});
    CHECK(nearest("velocity", {}).empty());
    CHECK(nearest("tonf", {"ton", "tof", "ton", "tp"}) == Names{"ton", "tof"});
    CHECK(nearest("done", {"home", "moving"}).empty());
    CHECK(nearest("master", {"master_unit"}).empty());
    CHECK(nearest("x.a", {"x.b", "y.a"}).empty());
    CHECK(nearest("abcdefghijkl", {"abcdefghi"}) == Names{"abcdefghi"});
    CHECK(nearest("abcdefghijklmnop", {"bbcdefghijkl"}).empty());
    CHECK(nearest("MC_GearInPosition", {"MC_Gear", "MC_GearIn", "MC_GearInPos"}) ==
          Names{"MC_GearInPos"});
    CHECK(nearest("MC_GearInPosition", {"MC_Gear", "MC_GearIn"}).empty());
}

TEST_CASE("a suggestion is the nearest name or the names there are") {
    CHECK(suggest("velocty", {"velocity"}) == "did you mean 'velocity'?");
    CHECK(suggest("tonf", {"ton", "tof"}, "a.") == "did you mean 'a.ton' or 'a.tof'?");
    CHECK(suggest("ratio", {"velocity", "jerk"}) == "known: velocity, jerk");
    CHECK(suggest("ratio", {}).empty());
    std::vector<std::string> many(12, "velocity");
    CHECK(suggest("ratio", many).ends_with("velocity, velocity"));
    many.emplace_back("velocity");
    CHECK(suggest("ratio", many).ends_with("velocity, ..."));
}

TEST_CASE("hostile sizes are answered quickly") {
    const auto start = std::chrono::steady_clock::now();
    Diagnostics all;
    const auto file = file_of(std::string(1 << 20, 'x'));
    for (int i = 0; i < 20'000; ++i) all.add("L0001", {file, 1, 1'000'000 + i, 9}, "m");
    CHECK(all.render().ends_with("... and 19950 more\n"));
    const std::vector<std::string> names(10'000, std::string(64 << 10, 'y'));
    CHECK(nearest(std::string(64 << 10, 'x'), names).empty());
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
}

TEST_CASE("warnings are no errors until they are taken strictly") {
    Diagnostics all;
    const Mark mark{file_of("x\n"), 1, 1, 1};
    all.warn("L0803", mark, "nothing uses x");
    all.warn("L0803", mark, "nothing uses x");
    CHECK(all.empty());
    CHECK(all.warnings().size() == 1);
    CHECK(all.render() == "a.yaml:1:1: warning[L0803]: nothing uses x\n   1 | x\n     | ^\n");
    all.be_strict();
    CHECK_FALSE(all.empty());
    CHECK(all.warnings().empty());
    CHECK(all.render() == "a.yaml:1:1: error[L0803]: nothing uses x\n   1 | x\n     | ^\n");
}

TEST_CASE("what a file has too many of is counted, and kept as far as it is shown") {
    Diagnostics out;
    const std::string much(100'000, 'x');
    for (int i = 1; i <= 3000; ++i) out.add("L0203", {nullptr, i, 1, 1}, much + std::to_string(i));
    CHECK(out.count() == 3000);
    CHECK(out.list().size() == 1000);
    CHECK(out.list().front().message.size() < 5000);
    CHECK(out.render(1).ends_with("... and 2999 more\n"));
}
