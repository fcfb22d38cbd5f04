/// Any bytes as a recording: refused with messages that have places, or played back for some scans.

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "blocks/catalog.hpp"
#include "runtime/run/single_run.hpp"
#include "tests/fuzz/fuzz_folder.hpp"

using namespace lineshaft;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const test::FuzzFolder folder;
    static const std::string program = folder.path + "/p.yaml";
    static const bool written = [] {
        std::ofstream(folder.path + "/s.st")
            << "FUNCTION_BLOCK Io\nVAR_INPUT g : ARRAY[1..4] OF LREAL; b : BOOL; i : INT; END_VAR\n"
               "VAR_OUTPUT n : LINT; END_VAR\nn := n + 1;\nEND_FUNCTION_BLOCK\n";
        std::ofstream(program)
            << "lineshaft: 1\ntasks: {main: {every: 2 ms}}\nsources: s.st\ninputs: {go: false}\n"
               "blocks:\n  io: {type: Io, task: main}\n  x: {type: axis, task: main}\n"
               "  f: {type: MC_MoveVelocity, task: main, Axis: x, Execute: inputs.go}\n"
               "run: {for: 20 ms}\n";
        return true;
    }();
    const std::string path = folder.path + "/r.yaml";
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    LoadOptions options;
    options.recording = path;
    Diagnostics out;
    auto loaded = load_program(program, options, standard_blocks(), out);
    if (!written || loaded.has_value() != out.empty()) std::abort();
    for (const Diagnostic& d : out.list())
        if (!d.mark.file || d.message.empty()) std::abort();
    if (!loaded) return 0;
    loaded->linked.machine.end = std::min<std::int64_t>(loaded->linked.machine.end, 20'000'000);
    RunOptions how;
    how.flush = false;
    run(*loaded, how);
    return 0;
}
