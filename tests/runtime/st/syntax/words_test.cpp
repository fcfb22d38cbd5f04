#include "runtime/st/syntax/words.hpp"

#include <catch2/catch.hpp>

#include "runtime/st/types/elementary.hpp"

using namespace lineshaft;

TEST_CASE("Structured Text: the elementary types are those of the parser", "[st]") {
    for (const std::string_view name : st::elementary_names) {
        const st::Type* type = st::find_elementary(name);
        REQUIRE(type);
        CHECK(type->name == name);
    }
}
