#include "tests/fuzz/random_program.hpp"

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/model/random.hpp"
#include "tests/fuzz/invariants.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

TEST_CASE("random programs load, run and keep their invariants") {
    const Catalog catalog = standard_blocks();
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        Random random(seed, "program");
        std::vector<std::uint8_t> bytes(1000);
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
        Choices choices(bytes);
        const RandomProgram program = random_program(choices, catalog);
        INFO("seed " << seed << '\n' << program.text);
        REQUIRE(broken_invariant(program, catalog) == "");
    }
}
