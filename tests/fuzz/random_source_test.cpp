#include "tests/fuzz/random_source.hpp"

#include <cstdlib>
#include <regex>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/model/random.hpp"
#include "tests/fuzz/st_invariants.hpp"
#include "tests/runtime/st/instance.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes random_bytes(std::uint64_t seed) {
    Random random(seed, "source");
    Bytes bytes(1500);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
    return bytes;
}

/// What the program's `x` is after a scan, or its fault; nothing if it is refused.
std::string value_of(const std::string& program) {
    static const Catalog catalog = standard_blocks();
    Diagnostics out;
    const auto library = st::compile({st::source(program)}, catalog, out);
    if (!library) return {};
    st::Instances instances(*library);
    instances.scan(0, 1);
    const auto faults = instances.faults();
    const std::string value = faults.empty() ? instances.text("x") : faults.front();
    return value == "-nan" ? "nan" : value;
}

}  // namespace

TEST_CASE("random Structured Text compiles, runs, and goes on from a checkpoint", "[st]") {
    const Catalog catalog = standard_blocks();
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const Bytes bytes = random_bytes(seed);
        Choices choices(bytes);
        const std::string source =
            random_source(choices, seed % 2 == 0 ? Pointers::tame : Pointers::wild);
        INFO("seed " << seed << '\n' << source);
        REQUIRE(broken_invariant(source, 50, seed, catalog) == "");
    }
}

TEST_CASE("what is folded when compiling is what the machine computes", "[st]") {
    const char* const types[] = {"INT",   "DINT",  "SINT", "LINT", "USINT", "UINT",
                                 "UDINT", "ULINT", "BYTE", "WORD", "DWORD", "LWORD",
                                 "REAL",  "LREAL", "TIME", "BOOL"};
    const std::regex literal("([A-Z]+)#[-0-9A-Za-z#_.]+");
    int compared = 0;
    for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
        const Bytes bytes = random_bytes(seed);
        Choices choices(bytes);
        const char* const type = types[seed % std::size(types)];
        const std::string constant = random_constant(choices, type);
        std::string variables, computed, rest = constant;
        int number = 0;
        for (std::smatch match; std::regex_search(rest, match, literal); rest = match.suffix()) {
            const std::string name = match[1] == "T"    ? "TIME"
                                     : match[1] == "LT" ? "LTIME"
                                                        : match[1].str();
            variables += fmt::format("v{} : {} := {};\n", ++number, name, match.str());
            computed += fmt::format("{}v{}", match.prefix().str(), number);
        }
        computed += rest;
        const auto program = [&](const std::string& of) {
            return fmt::format("PROGRAM p VAR {} x : {}; END_VAR\nx := {}; END_PROGRAM\n",
                               variables, type, of);
        };
        INFO("seed " << seed << '\n' << program(constant) << program(computed));
        const std::string folded = value_of(program(constant)),
                          machine = value_of(program(computed));
        if (folded.empty()) continue;
        CHECK(folded == machine);
        ++compared;
    }
    CHECK(compared > 1500);
}
