#include "tools/lineshaft/codes.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
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

/// Every code that is named in the sources below `folder`; one that stands there as it is counts as
/// unknown.
std::set<std::string> codes_below(const std::filesystem::path& folder) {
    std::map<std::string, std::string> by_name;
    for (const CodeText& text : diagnostic_codes()) by_name.emplace(text.name, text.code);
    std::set<std::string> codes;
    static const std::regex code("\\bcode::([a-z_]+)|\"(L[0-9]{4})\"");
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string ending = entry.path().extension().string();
        if (!entry.is_regular_file() || (ending != ".cpp" && ending != ".hpp")) continue;
        const std::string text = contents(entry.path());
        for (std::sregex_iterator it(text.begin(), text.end(), code), end; it != end; ++it)
            codes.insert((*it)[1].matched ? by_name[(*it)[1]] : "not named: " + (*it)[2].str());
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
        CHECK(!text.name.empty());
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
