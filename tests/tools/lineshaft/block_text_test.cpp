#include "tools/lineshaft/block_text.hpp"

#include "tests/runtime/names/small_blocks.hpp"

using namespace lineshaft;

TEST_CASE("a kind of block is listed with its references and locals") {
    const Catalog catalog = small_catalog().add<Display>();
    CHECK(block_text(*catalog.find("display")) ==
          "display: Shows a counter\n"
          "\nreferences\n"
          "  counter            counter    that is shown (must be set)\n"
          "\noutputs\n"
          "  shown                         its count\n"
          "\nlocals\n"
          "  highest                       greatest count so far\n");
    const auto fields = block_json(*catalog.find("display")).at("fields");
    CHECK(fields[0] == nlohmann::ordered_json{{"name", "counter"},
                                              {"direction", "reference"},
                                              {"refers", "counter"},
                                              {"doc", "that is shown"},
                                              {"required", true}});
    CHECK(fields[2].at("direction") == "local");
    CHECK(fields[2].at("type") == "integer");
}

TEST_CASE("a kind of block is listed with units, limits and defaults") {
    CHECK(block_text(*small_catalog().find("gain")) ==
          "gain: Multiplies\n"
          "\nparameters\n"
          "  unit                          of x and y (default mm)\n"
          "                                mm | rad\n"
          "  factor                        y / x (default 1, above 0, below 100)\n"
          "\ninputs\n"
          "  x                  unit       taken (must be set)\n"
          "\noutputs\n"
          "  y                  unit       factor * x\n"
          "  rate               unit/s     nothing, for its unit\n"
          "\nexample\n"
          "  my_gain: {type: gain, task: main, x: 1 mm}\n");
}
