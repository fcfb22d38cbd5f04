#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <random>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/st/library/test_suite.hpp"
#include "runtime/st/syntax/lexer.hpp"
#include "tests/count_of.hpp"
#include "tests/runtime/st/instance.hpp"
#include "tests/source_folder.hpp"

using namespace lineshaft;

namespace {

std::optional<st::Library> library_of(const std::string& text, Diagnostics& out) {
    static const Catalog catalog = standard_blocks();
    return st::compile({st::source(text)}, catalog, out, {.fuel = 2000});
}

/// Within 0.1 s of the processor, of which a busy machine takes more.
bool compiles_soon(const std::string& text) {
    for (int i = 0; i < 5; ++i) {
        Diagnostics out;
        const std::clock_t begun = std::clock();
        library_of(text, out);
        if (std::clock() - begun < CLOCKS_PER_SEC / 10) return true;
    }
    return false;
}

/// Compiles it soon, and if it is right scans it a few times with little fuel. It must come back.
void try_out(const std::string& text) {
    Diagnostics out;
    const std::clock_t begun = std::clock();
    const auto library = library_of(text, out);
    CHECK((std::clock() - begun < CLOCKS_PER_SEC / 10 || compiles_soon(text)));
    CHECK(library.has_value() == out.empty());
    if (!out.empty()) {
        CHECK(!out.render().empty());
        for (const Diagnostic& d : out.list()) CHECK(d.mark.line > 0);
    }
    if (!library) return;
    for (const BlockType& kind : library->kinds())
        if (kind.size > 1 << 20) return;
    st::Instances instances(*library);
    for (int i = 0; i < 3; ++i) instances.scan(i, 1);
}

/// The same of a file of tests.
void try_tests(const std::string& text) {
    Diagnostics out;
    const auto suite =
        st::compile_tests(st::source(text), {}, standard_blocks(), out, {.fuel = 2000});
    CHECK(suite.has_value() == out.empty());
    for (const Diagnostic& d : out.list()) CHECK(d.mark.line > 0);
    for (std::size_t i = 0; suite && i < suite->tests().size(); ++i) {
        const st::TestResult result = suite->run(i);
        CHECK((result.failure.empty() || result.mark.line > 0));
    }
}

/// Each with the blocks that it tests before it.
std::vector<std::string> tests() {
    const std::string root = test::in_source("tests/st_tests/");
    std::vector<std::string> texts;
    for (const auto& [tested, test] : {std::pair{"pass/counter.st", "pass/test_counter.st"},
                                       std::pair{"pass/mocks.st", "pass/test_mocks.st"},
                                       std::pair{"pass/values.st", "pass/tests/values_test.st"},
                                       std::pair{"fail/machine.st", "fail/machine_test.st"}})
        texts.push_back(st::read(root + tested)->text + st::read(root + test)->text);
    return texts;
}

std::vector<std::string> sources() {
    std::vector<std::string> texts;
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(test::in_source("tests/st")))
        if (entry.is_regular_file() && entry.path().extension() != ".md") paths.push_back(entry);
    std::ranges::sort(paths);
    for (const auto& path : paths) texts.push_back(st::read(path.string())->text);
    return texts;
}

/// Tries the text so many times, each time with another word left out, doubled or exchanged.
void exchange_words(const std::string& text, int times, std::mt19937& random,
                    void (*attempt)(const std::string&)) {
    Diagnostics out;
    const auto source = st::source(text);
    const st::Tokens read = st::read_tokens(source, out);
    const auto& tokens = read.tokens;
    for (int i = 0; i < times; ++i) {
        const auto& a = tokens[random() % tokens.size()];
        const auto& b = tokens[random() % tokens.size()];
        std::string changed = text;
        changed.replace(a.place.begin, a.place.end - a.place.begin,
                        random() % 3 == 0 ? std::string() : std::string(b.place.text()));
        INFO("'" << a.place.text() << "' at byte " << a.place.begin << " changed to '"
                 << b.place.text() << "' in " << text.substr(0, 60));
        attempt(changed);
    }
}

}  // namespace

TEST_CASE("Structured Text: sources cut off anywhere, and with one byte changed", "[st]") {
    std::mt19937 random(7);
    const std::string bytes = "();:=.,'\"#%[]{}*/ \nA5_-+\xC3\x00";
    const bool all = std::getenv("LINESHAFT_ALL_BYTES") != nullptr;
    for (const std::string& text : sources()) {
        for (std::size_t end = all ? 0 : random() % 99; end < text.size();
             end += all ? 1 : 1 + random() % 1200)
            try_out(text.substr(0, end));
        for (std::size_t i = 0; i < (all ? text.size() : 5); ++i) {
            std::string changed = text;
            const std::size_t at = all ? i : random() % text.size();
            changed[at] = bytes[random() % bytes.size()];
            INFO("byte " << at << " changed to '" << changed[at] << "' in " << text.substr(0, 60));
            try_out(changed);
        }
    }
}

TEST_CASE("Structured Text: tests cut off anywhere, with words left out, doubled and exchanged",
          "[st]") {
    const auto seed = std::random_device{}();
    INFO("seed " << seed);
    std::mt19937 random(seed);
    for (const std::string& text : tests()) {
        try_tests(text);
        for (std::size_t end = random() % 99; end < text.size(); end += 1 + random() % 99)
            try_tests(text.substr(0, end));
        exchange_words(text, 60, random, try_tests);
    }
}

/// LINESHAFT_WORDS makes it longer: tools/long.
TEST_CASE("Structured Text: sources with words left out, doubled and exchanged", "[st]") {
    std::mt19937 random(8);
    for (const std::string& text : sources()) {
        exchange_words(text, static_cast<int>(test::count_of("LINESHAFT_WORDS", 5)), random,
                       try_out);
    }
}

TEST_CASE("Structured Text: nesting without end is told with its place", "[st]") {
    const auto repeated = [](const std::string& text, int times) {
        std::string all;
        for (int i = 0; i < times; ++i) all += text;
        return all;
    };
    const auto told = [](const std::string& body) {
        Diagnostics out;
        st::compile({st::source("PROGRAM p VAR x : DINT; END_VAR\n" + body + "\nEND_PROGRAM\n")},
                    standard_blocks(), out);
        std::string codes;
        for (const Diagnostic& d : out.list()) codes += fmt::format("{} ", d.code);
        return codes;
    };
    constexpr int many = 100'000;
    CHECK(told("x := " + repeated("(", many) + "1" + repeated(")", many) + ";") == "L0912 ");
    CHECK(told(repeated("IF x = 1 THEN ", many) + repeated("END_IF;", many)) == "L0912 ");
    CHECK(told("x := " + repeated("-", many) + "1;") == "L0912 ");
    CHECK(told("x := 1" + repeated("+ x", many) + ";") == "L0912 ");
    CHECK(told("x := x" + repeated("[1", many) + repeated("]", many) + ";") == "L0912 ");
    CHECK(told(repeated("(*", many) + repeated("*)", many)) == "L0912 ");
    CHECK(told(repeated("(*", many)) == "L0912 ");
    CHECK(told(repeated("(*", 200) + repeated("*)", 200)).empty());
    CHECK(told(repeated("(*", 200)) == "L0901 ");
    CHECK(told("x := " + repeated("(", 60) + "1" + repeated(")", 60) + ";").empty());
}
