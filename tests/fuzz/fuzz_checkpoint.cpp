/// A run that has begun, and how its checkpoint is damaged, the hash made right: it is refused, or
/// goes on for some scans, whatever comes of them.

#include <cstdlib>
#include <filesystem>

#include "tests/fuzz/fuzz_folder.hpp"
#include "tests/fuzz/kept_runs.hpp"

using namespace lineshaft::test;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const FuzzFolder folder;
    static const auto runs = kept_runs(folder.path, false);
    if (size == 0) return 0;
    const KeptRun& run = *runs[data[0] % runs.size()];
    if (size == 1 && !run.resume(run.checkpoint())) std::abort();
    run.resume(damaged(run.checkpoint(), {data + 1, size - 1}));
    return 0;
}
