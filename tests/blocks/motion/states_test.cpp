#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/axis/axis_states.hpp"
#include "tests/source_folder.hpp"

using namespace lineshaft;

namespace {

std::vector<std::vector<std::string>> golden() {
    std::ifstream in(test::in_source("tests/blocks/motion/states.txt"));
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(in, line);) {
        std::istringstream cells(line);
        rows.emplace_back(std::istream_iterator<std::string>(cells),
                          std::istream_iterator<std::string>());
    }
    return rows;
}

std::string without_blanks(std::string_view text) {
    std::string out(text);
    std::erase(out, ' ');
    return out;
}

}  // namespace

/// states.txt was written from the text and the state diagram of PLCopen Part 1 v2.0, 2.1 and 3: a
/// dot stays, a bar is refused, a tilde too but for a buffered command, which waits (table 4).
TEST_CASE("every command in every state does what the standard says") {
    const auto rows = golden();
    const auto table = state_table();
    REQUIRE(rows.size() == table.size() + 1);
    REQUIRE(rows[0].size() == axis_state_count);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const auto& row = rows[i + 1];
        REQUIRE(row.size() == axis_state_count + 1);
        CHECK(row[0] == without_blanks(table[i].name));
        for (std::size_t s = 0; s < axis_state_count; ++s) {
            INFO(row[0] << " in " << rows[0][s]);
            const auto state = static_cast<AxisState>(s);
            const auto next = next_state(table[i].command, state);
            const std::string& cell = row[s + 1];
            REQUIRE(next.has_value() == (cell != "-" && cell != "~"));
            if (!next)
                CHECK((can_be_buffered(table[i].command) && can_be_followed(state)) ==
                      (cell == "~"));
            if (!next) continue;
            const std::string& wanted = cell == "." ? rows[0][s] : cell;
            CHECK(rows[0][static_cast<std::size_t>(*next)] == wanted);
        }
    }
}
