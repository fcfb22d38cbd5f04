/// Random programs that are valid must load, run, and keep their invariants.

#include <cstdio>
#include <cstdlib>

#include "blocks/catalog.hpp"
#include "tests/fuzz/invariants.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Catalog catalog = standard_blocks();
    Choices choices({data, size});
    const RandomProgram program = random_program(choices, catalog);
    const std::string wrong = broken_invariant(program, catalog);
    if (wrong.empty()) return 0;
    std::fprintf(stderr, "%s\n%s\n", program.text.c_str(), wrong.c_str());
    std::abort();
}
