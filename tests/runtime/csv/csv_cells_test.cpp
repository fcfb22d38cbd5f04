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

TEST_CASE("a comma needs no quotes where semicolons stand between the cells", "[csv]") {
    CHECK(quoted("m[1,2]", ';') == "m[1,2]");
    CHECK(quoted("a;b", ';') == "\"a;b\"");
}

TEST_CASE("what stands between the cells", "[csv]") {
    CHECK(separator_of("time,scan") == ',');
    CHECK(separator_of("time;scan;p.m[1,2]") == ';');
    CHECK(separator_of("\"a;b\",c") == ',');
    CHECK(separator_of("p.m[1,2];time") == ';');
    CHECK(separator_of("time") == ',');
}

TEST_CASE("cells of a line", "[csv]") {
    CHECK(csv_cells("") == std::vector<std::string>{""});
    CHECK(csv_cells(",") == std::vector<std::string>{"", ""});
    CHECK(csv_cells("1;2,5", ';') == std::vector<std::string>{"1", "2,5"});
}
