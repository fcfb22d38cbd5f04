#include "runtime/csv/csv_cells.hpp"

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("what is quoted comes back", "[csv]") {
    for (const char* text : {"", "plain", "a,b", "say \"it\"", "\"", ",\",\"", "a;b"}) {
        INFO(text);
        CHECK(unquoted(quoted(text)) == text);
        CHECK(csv_cells("1," + quoted(text) + ",2") == std::vector<std::string>{"1", text, "2"});
    }
}

TEST_CASE("cells of a line", "[csv]") {
    CHECK(csv_cells("") == std::vector<std::string>{""});
    CHECK(csv_cells(",") == std::vector<std::string>{"", ""});
    CHECK(csv_cells("1;2,5", ';') == std::vector<std::string>{"1", "2,5"});
}
