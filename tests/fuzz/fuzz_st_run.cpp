/// Random programs in Structured Text compile, run, and are the same bytes by native code and by
/// the machine, whose memory was moved. Pointers lead where they may not, too.

#include <cstdio>
#include <cstdlib>

#include "blocks/catalog.hpp"
#include "tests/fuzz/random_source.hpp"
#include "tests/fuzz/st_invariants.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Catalog catalog = standard_blocks();
    Choices choices({data, size});
    const std::string source =
        random_source(choices, choices.below(2) == 0 ? Pointers::tame : Pointers::wild);
    const bool loops = source.find("END_FOR") != source.npos ||
                       source.find("UNTIL") != source.npos ||
                       source.find("END_WHILE") != source.npos;
    const std::string wrong = broken_invariant(source, loops ? 100 : 1000, size, catalog);
    if (wrong.empty()) return 0;
    std::fprintf(stderr, "%s\n%s\n", source.c_str(), wrong.c_str());
    std::abort();
}
