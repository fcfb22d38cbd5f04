#include "runtime/source/text_hash.hpp"

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("a hash is 64-bit FNV-1a") {
    CHECK(text_hash("") == "cbf29ce484222325");
    CHECK(text_hash("a") == "af63dc4c8601ec8c");
    CHECK(text_hash("foobar") == "85944171f73967e8");
}
