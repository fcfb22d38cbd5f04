#include "runtime/source/text_hash.hpp"

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("a hash is 64-bit XXH3") {
    CHECK(text_hash("") == "2d06800538d394c2");
    CHECK(text_hash("a") == "e6c632b61e964e1f");
    CHECK(text_hash("foobar") == "d78fda63144c5c84");
}
