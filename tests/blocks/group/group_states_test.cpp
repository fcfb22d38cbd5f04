#include "blocks/group/group_states.hpp"

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/source_folder.hpp"

using namespace lineshaft;

/// states.txt: a dot stays, a bar is refused. It was written from the state diagram of PLCopen Part
/// 4 v1.0 and its notes as the manuals of CODESYS SoftMotion and TwinCAT have them; the text itself
/// was not at hand.
TEST_CASE("every command in every state of a group does what the standard says") {
    std::ifstream in(test::in_source("tests/blocks/group/states.txt"));
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(in, line);) {
        std::istringstream cells(line);
        rows.emplace_back(std::istream_iterator<std::string>(cells),
                          std::istream_iterator<std::string>());
    }
    const auto table = group_state_table();
    REQUIRE(rows.size() == table.size() + 1);
    REQUIRE(rows[0].size() == group_state_count);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const auto& row = rows[i + 1];
        REQUIRE(row.size() == group_state_count + 1);
        CHECK(row[0] == table[i].name);
        for (std::size_t s = 0; s < group_state_count; ++s) {
            INFO(row[0] << " in " << rows[0][s]);
            const auto next = next_state(table[i].command, static_cast<GroupState>(s));
            const std::string& cell = row[s + 1];
            REQUIRE(next.has_value() == (cell != "-"));
            if (!next) continue;
            const std::string& wanted = cell == "." ? rows[0][s] : cell;
            CHECK(rows[0][static_cast<std::size_t>(*next)] == wanted);
        }
    }
}
