#include "tools/lineshaft/codes.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <catch2/catch.hpp>

#include "tests/source_folder.hpp"

using namespace lineshaft;

namespace {

std::string contents(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

/// Every code that stands in the sources below `folder`, the table itself left out.
std::set<std::string> codes_below(const std::filesystem::path& folder) {
    std::set<std::string> codes;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file() || entry.path().filename() == "codes.cpp") continue;
        const std::string text = contents(entry.path());
        static const std::regex code("\"(L[0-9]{4})\"");
        for (std::sregex_iterator it(text.begin(), text.end(), code), end; it != end; ++it)
            codes.insert((*it)[1]);
    }
    return codes;
}

}  // namespace

TEST_CASE("codes: the table is ascending and every entry says something") {
    const auto codes = diagnostic_codes();
    CHECK(std::ranges::adjacent_find(codes, std::ranges::greater_equal{}, &CodeText::code) ==
          codes.end());
    for (const CodeText& text : codes) {
        INFO(text.code);
        CHECK(!text.title.empty());
        CHECK(text.paragraph.size() > 100);
        CHECK(find_code(text.code) == &text);
    }
    CHECK(find_code("L9999") == nullptr);
    CHECK(find_code("") == nullptr);
    CHECK(find_code("l0404") == find_code("L0404"));
}

TEST_CASE("codes: every code of the sources is in the table, and none besides") {
    const std::filesystem::path root = test::in_source("");
    std::set<std::string> used = codes_below(root / "runtime");
    used.merge(codes_below(root / "tools"));
    std::set<std::string> known;
    for (const CodeText& text : diagnostic_codes()) known.emplace(text.code);
    CHECK(used == known);
}
