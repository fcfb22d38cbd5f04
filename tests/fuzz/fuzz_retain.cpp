/// A program, and how its file of retained values is damaged, mostly with its check made right: it
/// is refused, or runs for some scans.

#include <cstdlib>

#include "tests/fuzz/fuzz_folder.hpp"
#include "tests/fuzz/kept_runs.hpp"

using namespace lineshaft::test;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const FuzzFolder folder;
    static const auto runs = kept_runs(folder.path, true);
    if (size < 2) return 0;
    const KeptRun& run = *runs[data[0] % runs.size()];
    const bool mends = data[1] % 8 != 0;
    const std::string text = damaged(run.retained(), {data + 2, size - 2});
    const bool taken = run.begin(text, mends);
    if (size == 2 && !taken) std::abort();
    if (taken && !mends && text != run.retained()) std::abort();  // the check has not told it
    return 0;
}
