#include "tools/lineshaft/block_text.hpp"

#include "tests/runtime/names/small_blocks.hpp"
#include "tests/runtime/st/instance.hpp"

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

TEST_CASE("a kind of block is listed with the variables of which not all is known") {
    Diagnostics out;
    const Catalog catalog = small_catalog();
    const auto library = st::compile({st::source("FUNCTION_BLOCK Logger\n"
                                                 "VAR_OUTPUT log : ARRAY[0..4999] OF INT; END_VAR\n"
                                                 "log[0] := 1;\n"
                                                 "END_FUNCTION_BLOCK\n")},
                                     catalog, out);
    REQUIRE(library);
    const BlockType& kind = library->kinds().front();
    CHECK(
        block_text(kind).find("\nnot all of log\n  of a block's arrays 4096 elements are known") !=
        std::string::npos);
    CHECK(block_json(kind).at("shortened")[0] == "log");
    CHECK_FALSE(block_json(*catalog.find("gain")).contains("shortened"));
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
