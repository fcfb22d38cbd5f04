#include "runtime/st/library/test_suite.hpp"

#include <filesystem>
#include <numeric>
#include <random>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/st/library/test_sources.hpp"
#include "runtime/st/types/value_text.hpp"
#include "tests/runtime/st/instance.hpp"
#include "tests/source_folder.hpp"

using namespace lineshaft;

namespace {

st::TestSuite suite_of(const std::string& tests, const std::string& source = "") {
    Diagnostics out;
    const auto suite =
        st::compile_tests(st::source(tests), {st::source(source)}, standard_blocks(), out);
    INFO(out.render());
    REQUIRE(suite);
    return *suite;
}

std::string result_of(const st::TestSuite& suite, std::size_t test) {
    const st::TestResult result = suite.run(test);
    return fmt::format("{}:{} {}", result.mark.line, result.failure, fmt::join(result.calls, ", "));
}

st::TestSuite suite_of_file(const std::string& folder, const std::string& name) {
    st::SourcePool pool;
    std::vector<std::string> files;
    const std::string root = test::in_source("tests/st_tests/" + folder);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
        if (entry.path().extension() == ".st") files.push_back(entry.path().string());
    std::ranges::sort(files);
    for (const std::string& file : files) pool.add(st::read(file));
    const auto tests = st::read(root + "/" + name);
    Diagnostics out;
    const auto suite = st::compile_tests(tests, pool.needed_by(tests), standard_blocks(), out);
    INFO(out.render());
    REQUIRE(suite);
    return *suite;
}

}  // namespace

TEST_CASE("A test's result does not depend on what ran before it", "[st]") {
    const auto seed = std::random_device{}();
    INFO("seed " << seed);
    std::mt19937 random(seed);
    for (const auto& [folder, name] :
         {std::pair{"pass", "test_mocks.st"}, std::pair{"pass", "globals_test.scl"},
          std::pair{"pass", "test_counter.st"}, std::pair{"fail", "machine_test.st"}}) {
        const st::TestSuite together = suite_of_file(folder, name);
        std::vector<std::string> alone;
        for (std::size_t i = 0; i < together.tests().size(); ++i)
            alone.push_back(result_of(suite_of_file(folder, name), i));
        std::vector<std::size_t> order(alone.size());
        std::iota(order.begin(), order.end(), 0);
        for (int round = 0; round < 3; ++round) {
            std::ranges::shuffle(order, random);
            for (const std::size_t i : order) {
                INFO(name << ": " << together.tests()[i].name);
                CHECK(result_of(together, i) == alone[i]);
            }
        }
    }
}

TEST_CASE("Assertions of random numbers hold as those of C++ do, and show both values", "[st]") {
    const auto seed = std::random_device{}();
    INFO("seed " << seed);
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<std::int64_t> small(-3, 3), large;
    std::string tests;
    struct Wanted {
        std::int64_t a, b;
        bool holds;
        std::string message;
    };
    std::vector<Wanted> wanted;
    for (int i = 0; i < 300; ++i) {
        const bool near = random() % 2 == 0;
        const std::int64_t a = near ? small(random) : large(random) / 2;
        const std::int64_t b = near ? small(random) : large(random) / 2;
        const std::pair<std::string, bool> kinds[] = {{"EQ", a == b}, {"NEQ", a != b},
                                                      {"GT", a > b},  {"LT", a < b},
                                                      {"GE", a >= b}, {"LE", a <= b}};
        const auto& [name, holds] = kinds[random() % 6];
        tests += fmt::format(
            "TEST '{}'\nVAR a : LINT := {}; b : {} := {}; END_VAR\nASSERT_{}(a, b);\nEND_TEST\n", i,
            a, near ? "SINT" : "LINT", b, name);
        wanted.push_back({a, b, holds, name == "NEQ" ? "" : fmt::format("found {}", a)});
    }
    const st::TestSuite suite = suite_of(tests);
    REQUIRE(suite.tests().size() == wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const st::TestResult result = suite.run(i);
        INFO(wanted[i].a << " and " << wanted[i].b << ": " << result.failure);
        CHECK(result.failure.empty() == wanted[i].holds);
        if (!wanted[i].holds) CHECK(result.failure.ends_with(wanted[i].message));
    }
}

TEST_CASE("TEARDOWN runs after an assertion that failed, and after a fault", "[st]") {
    const st::TestSuite suite = suite_of(
        "SETUP VAR n : INT; END_VAR END_SETUP\n"
        "TEST 'fails'\nn := 1; ASSERT_TRUE(FALSE);\nEND_TEST\n"
        "TEST 'faults'\nn := 1 / n;\nEND_TEST\n"
        "TEST 'passes'\nn := 5;\nEND_TEST\n"
        "TEARDOWN ASSERT_EQ(n, 4); END_TEARDOWN\n");
    CHECK(suite.run(0).failure == "ASSERT_TRUE(FALSE): expected TRUE, found FALSE");
    CHECK(suite.run(1).is_fault);
    CHECK(suite.run(1).failure == "the fault division_by_zero");
    CHECK(suite.run(2).failure == "ASSERT_EQ(n, 4): expected 4, found 5");
}

TEST_CASE("Blocks with tests do what they do without", "[st]") {
    const std::string body =
        "VAR n, sum : DINT; t : TON; END_VAR\n"
        "n := n + 1; sum := sum + n * n; t(IN := n > 2, PT := T#2ms);\n"
        "IF t.Q THEN sum := -sum; END_IF;\n";
    const auto library = [&] {
        Diagnostics out;
        return *st::compile({st::source("PROGRAM Main\n" + body + "END_PROGRAM")},
                            standard_blocks(), out);
    }();
    st::Instances instances(library);
    for (int i = 0; i < 6; ++i) instances.scan(i * 1'000'000, 1'000'000);
    const st::TestSuite suite =
        suite_of(fmt::format("TEST 'same'\nVAR m : Main; i : INT; END_VAR\n"
                             "FOR i := 0 TO 5 DO\nm();\nADVANCE_TIME(T#1ms);\nEND_FOR;\n"
                             "ASSERT_EQ(m.sum, {});\nEND_TEST",
                             instances.text("sum")),
                 "PROGRAM Main\n" + body + "END_PROGRAM");
    CHECK(suite.run(0).failure.empty());
}

TEST_CASE("Values are shown as the language writes them", "[st]") {
    CHECK(st::time_literal(0) == "T#0s");
    CHECK(st::time_literal(-1'500'000'000) == "T#-1s500ms");
    CHECK(st::time_literal(93'784'005'006'007) == "T#1d2h3m4s5ms6us7ns");
    CHECK(st::time_literal(std::numeric_limits<std::int64_t>::min()) ==
          "T#-106751d23h47m16s854ms775us808ns");
    CHECK(st::text_literal("it's $5\n") == "'it$'s $$5$0A'");
}

TEST_CASE("Files of tests find the sources that they name", "[st]") {
    const auto file = [](const std::string& path, const std::string& text) {
        return std::make_shared<const SourceFile>(SourceFile{path, text});
    };
    st::SourcePool pool;
    pool.add(file("a/far.st", "TYPE Same : INT; END_TYPE"));
    pool.add(file("a/b/near.st", "TYPE Same : INT; END_TYPE"));
    pool.add(file("a/b/x.st", "FUNCTION X : INT VAR a : Helper; END_VAR END_FUNCTION"));
    pool.add(file("a/helper.st", "TYPE Helper : (red, green); END_TYPE"));
    pool.add(file("a/nobody.st", "TYPE Nobody : INT; END_TYPE FUNCTION ( broken"));
    pool.add(file("a/b/other_test.st", "TEST 'other' END_TEST FUNCTION Same : INT END_FUNCTION"));
    const auto names = [&](const std::string& path, const std::string& text) {
        std::string found;
        for (const auto& source : pool.needed_by(file(path, text))) found += source->path + " ";
        return found;
    };
    CHECK(names("a/b/test_x.st", "TEST 'x' END_TEST") == "a/b/x.st a/helper.st ");
    CHECK(names("a/b/x_test.st", "TEST 'x' END_TEST") == "a/b/x.st a/helper.st ");
    CHECK(names("a/b/y.st", "TEST 'y' VAR s : SAME; END_VAR END_TEST") == "a/b/near.st ");
    CHECK(names("a/y.st", "TEST 'y' VAR s : Same; END_VAR END_TEST") == "a/far.st ");
    CHECK(names("a/y.st", "TEST 'y' VAR i : INT; END_VAR i := red; END_TEST") == "a/helper.st ");
    CHECK(names("a/y.st", "TEST 'y' VAR red : INT; END_VAR red := 1; END_TEST").empty());
    CHECK(names("a/y.st", "TEST 'y' ASSERT_TRUE(TRUE); END_TEST").empty());
    pool.add(
        file("a/derived.st", "TYPE Derived EXTENDS Base : STRUCT b : INT; END_STRUCT END_TYPE"));
    pool.add(file("a/base.st", "TYPE Base : STRUCT a : INT; END_STRUCT END_TYPE"));
    CHECK(names("a/y.st", "TEST 'y' VAR d : Derived; END_VAR END_TEST") ==
          "a/derived.st a/base.st ");
    pool.add(file("a/list.st", "VAR_GLOBAL supply : Supply; END_VAR"));
    pool.add(file("a/supply.st", "FUNCTION_BLOCK Supply END_FUNCTION_BLOCK"));
    CHECK(names("a/y.st", "TEST 'y' supply(); END_TEST") == "a/supply.st a/list.st ");
    CHECK(names("a/y.st", "TEST 'y' VAR s : Supply; END_VAR supply(); END_TEST") ==
          "a/supply.st a/list.st ");
    CHECK(names("a/y.st", "TEST 'y' VAR s : Supply; END_VAR END_TEST") == "a/supply.st ");
}

TEST_CASE("Files of tests find bodies beside what B&R declares in a file of its own", "[st]") {
    const auto file = [](const std::string& path, const std::string& text) {
        return std::make_shared<const SourceFile>(SourceFile{path, text});
    };
    st::SourcePool pool;
    pool.add(file("lib/Lib.fun",
                  "FUNCTION Twice : REAL VAR_INPUT x : REAL; END_VAR END_FUNCTION "
                  "FUNCTION_BLOCK Adder VAR_INPUT x : REAL; END_VAR END_FUNCTION_BLOCK"));
    pool.add(file("lib/Twice.st", "FUNCTION Twice Twice := 2.0 * x; END_FUNCTION"));
    pool.add(file("lib/parts/Adder.st", "FUNCTION_BLOCK Adder END_FUNCTION_BLOCK"));
    pool.add(file("other/Adder.st", "FUNCTION_BLOCK Adder END_FUNCTION_BLOCK"));
    const auto names = [&](const std::string& path, const std::string& text) {
        std::string found;
        for (const auto& source : pool.needed_by(file(path, text))) found += source->path + " ";
        return found;
    };
    CHECK(names("lib/y.st", "TEST 'y' ASSERT_EQ(Twice(1.0), REAL#2.0); END_TEST") ==
          "lib/Lib.fun lib/Twice.st ");
    CHECK(names("lib/y.st", "TEST 'y' VAR a : Adder; END_VAR a(x := Twice(1.0)); END_TEST") ==
          "lib/Lib.fun lib/parts/Adder.st lib/Twice.st ");
    CHECK(names("lib/twice_test.st", "TEST 'y' END_TEST") == "lib/Twice.st lib/Lib.fun ");
    CHECK(names("other/y.st", "TEST 'y' VAR a : Adder; END_VAR END_TEST") == "other/Adder.st ");
}
