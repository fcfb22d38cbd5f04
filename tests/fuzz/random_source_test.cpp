#include "tests/fuzz/random_source.hpp"

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/model/random.hpp"
#include "tests/fuzz/st_invariants.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

TEST_CASE("random Structured Text compiles, runs, and goes on from a checkpoint", "[st]") {
    const Catalog catalog = standard_blocks();
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        Random random(seed, "source");
        std::vector<std::uint8_t> bytes(1000);
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
        Choices choices(bytes);
        const std::string source = random_source(choices);
        INFO("seed " << seed << '\n' << source);
        REQUIRE(broken_invariant(source, 50, seed, catalog) == "");
    }
}
