#include "runtime/st/prelude/standard_source.hpp"

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE(
    "Structured Text: a user's source is none of the standard's, whatever its folder is called") {
    CHECK(st::is_standard_source(*st::standard_source()));
    CHECK_FALSE(st::is_standard_source({"(old)/axis.scl", ""}));
    CHECK_FALSE(st::is_standard_source({"axis.st", ""}));
}
