#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <dlfcn.h>

#include "blocks/catalog.hpp"
#include "runtime/model/value.hpp"
#include "runtime/st/code/native/compile.hpp"
#include "runtime/st/library/library.hpp"
#include "tests/source_folder.hpp"
#include "tools/bench/quickest.hpp"

/// Three small programs, tools/bench/peers.st, scanned here, by C++ by hand, and by what another
/// compiler made, which `peers` builds and names in LINESHAFT_PEER.
using namespace lineshaft;

namespace {

constexpr int scans = 1000;
constexpr std::int64_t interval = 1'000'000;

struct Arithmetic {
    std::int32_t n = 0, i = 0, j = 0;
    double out = 0, x = 0, y = 0;

    [[gnu::noinline]] void scan(std::int64_t) {
        i = n * 3 + 7;
        j = (i - n) / 2 + i % 5;
        x = i * 0.5 + y;
        y = (x - j) / 3;
        out = x * y + 1;
    }
};

struct Blinky {
    std::int32_t n = 0;
    double out = 0;
    bool runs = false, q = false;
    std::int64_t begin = 0;

    /// TON of 5 ms; its input is false for the scan behind the one in which it is done.
    [[gnu::noinline]] void scan(std::int64_t now) {
        const bool in = !q;
        if (in && !runs) begin = now;
        runs = in;
        q = in && now - begin >= 5 * interval;
        if (q) out = 1 - out;
    }
};

struct Sequence {
    std::int32_t n = 0, state = 0, count = 0;
    double out = 0;

    [[gnu::noinline]] void scan(std::int64_t) {
        switch (state) {
            case 0:
                count = 0;
                state = n % 3 == 0 ? 2 : 1;
                break;
            case 1:
                count = count + 1;
                if (count > 2) state = 3;
                break;
            case 2:
                state = 4;
                break;
            case 3:
                out = out + 1;
                state = 5;
                break;
            case 4:
                out = out - 0.5;
                state = 5;
                break;
            default:
                state = 0;
        }
    }
};

std::shared_ptr<const SourceFile> programs() {
    std::ifstream file(test::in_source("tools/bench/peers.st"));
    return std::make_shared<const SourceFile>(
        SourceFile{"peers.st", {std::istreambuf_iterator<char>(file), {}}});
}

/// What comes in, another in each scan.
std::int32_t input(int scan) {
    return (scan * 37) % 64;
}

/// What each way leaves after so many scans from the beginning.
template <class Block>
double result_by_hand() {
    Block block;
    for (int i = 0; i < scans; ++i) {
        block.n = input(i);
        block.scan(i * interval);
    }
    return block.out;
}

void measure(benchmark::State& state, const auto& scan, double result, double wanted) {
    if (result != wanted) return state.SkipWithError("the results differ");
    Quickest least;
    for (auto _ : state)
        least.time([&] {
            for (int i = 0; i < scans; ++i) scan(i);
        });
    least.count(state, scans);
}

template <class Block>
void in_cpp(benchmark::State& state) {
    Block block;
    benchmark::DoNotOptimize(block);
    const auto scan = [&](int i) {
        block.n = input(i);
        block.scan(i * interval);
        benchmark::DoNotOptimize(block);
    };
    measure(state, scan, 0, 0);
}

enum class Way { copied, compiled };

template <class Block>
void in_structured_text(benchmark::State& state, const char* name, Way way) {
    const auto no = [](const std::string& why) { std::fprintf(stderr, "%s\n", why.c_str()); };
    st::compile_natively(way == Way::compiled ? +no : nullptr);
    Diagnostics out;
    const std::size_t before = st::end_compiling();
    const auto library = st::compile({programs()}, standard_blocks(), out);
    if (!library) return state.SkipWithError(out.render().c_str());
    if (way == Way::compiled && st::end_compiling() == before)
        return state.SkipWithError("nothing was compiled");
    const auto kind = std::ranges::find(library->kinds(), name, &BlockType::name);
    std::vector<std::uint64_t> memory(kind->size / 8);
    auto* block = reinterpret_cast<std::byte*>(memory.data());
    kind->construct(block);
    std::byte* const n = block + kind->find_settable("n")->offset;
    const Context context{kind->context, nullptr};
    const auto scan = [&](int i) {
        const std::int64_t value = input(i);
        std::memcpy(n, &value, sizeof value);
        kind->scan_blocks(block, 1, {i * interval, interval, i}, context);
    };
    for (int i = 0; i < scans; ++i) scan(i);
    const Field* field = kind->find_readable("out");
    const Value result = load(field->type, block + field->offset);
    measure(state, scan, std::get<double>(result), result_by_hand<Block>());
}

/// Runs the object that `peers` made: `NAME_begin()`, then `NAME_scan(n, now)` gives `out`.
template <class Block>
void by_peer(benchmark::State& state, const std::string& name) {
    const char* file = std::getenv("LINESHAFT_PEER");
    void* const object = file ? ::dlopen(file, RTLD_NOW) : nullptr;
    const auto find = [&](const char* what) {
        return object ? ::dlsym(object, (name + what).c_str()) : nullptr;
    };
    const auto begin = reinterpret_cast<void (*)()>(find("_begin"));
    const auto call = reinterpret_cast<double (*)(std::int32_t, std::int64_t)>(find("_scan"));
    if (!begin || !call) return state.SkipWithError("LINESHAFT_PEER has no such scan");
    begin();
    double result = 0;
    for (int i = 0; i < scans; ++i) result = call(input(i), i * interval);
    const auto scan = [&](int i) { benchmark::DoNotOptimize(call(input(i), i * interval)); };
    measure(state, scan, result, result_by_hand<Block>());
}

template <class Block>
void add(const char* name) {
    const auto called = [&](const char* way) { return std::string(name) + "/" + way; };
    benchmark::RegisterBenchmark(called("cpp").c_str(), in_cpp<Block>);
    benchmark::RegisterBenchmark(called("copied").c_str(), in_structured_text<Block>, name,
                                 Way::copied);
    benchmark::RegisterBenchmark(called("compiled").c_str(), in_structured_text<Block>, name,
                                 Way::compiled);
    benchmark::RegisterBenchmark(called("peer").c_str(), by_peer<Block>, name);
}

}  // namespace

int main(int count, char** arguments) {
    add<Arithmetic>("Arithmetic");
    add<Blinky>("Blinky");
    add<Sequence>("Sequence");
    benchmark::Initialize(&count, arguments);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
