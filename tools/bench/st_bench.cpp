#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "blocks/catalog.hpp"
#include "runtime/st/library.hpp"
#include "tools/bench/quickest.hpp"

using namespace lineshaft;

namespace {

// A body of 77 operations: a PID controller, a clamp, a quintic, a CASE, eight passes of a WHILE.
constexpr const char* body = R"(
VAR_INPUT wanted, actual : LREAL; kp : LREAL := 2.0; ki : LREAL := 0.5; kd : LREAL := 0.1; END_VAR
VAR_OUTPUT out, path : LREAL; state : DINT; END_VAR
VAR sum, last, e, s, u : LREAL; i, n, k : DINT; END_VAR
e := wanted - actual;
sum := sum + e * ki;
u := kp * e + sum + kd * (e - last);
last := e;
IF u > 10.0 THEN u := 10.0; ELSIF u < -10.0 THEN u := -10.0; END_IF;
out := u;
s := s + 0.001;
IF s > 1.0 THEN s := s - 1.0; END_IF;
path := s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
CASE state OF
    0: state := 1;
    1: IF path > 0.5 THEN state := 2; END_IF;
    2: IF path < 0.5 THEN state := 0; END_IF;
ELSE
    state := 0;
END_CASE;
i := 0;
n := k;
WHILE i < 8 DO
    n := n * 3 + i;
    i := i + 1;
END_WHILE;
k := n;
)";

/// The same in C++, of the same types.
struct Body {
    double wanted = 0, actual = 0, kp = 2, ki = 0.5, kd = 0.1;
    double out = 0, path = 0;
    std::int32_t state = 0;
    double sum = 0, last = 0, e = 0, s = 0, u = 0;
    std::int32_t i = 0, n = 0, k = 0;

    [[gnu::noinline]] void scan() {
        e = wanted - actual;
        sum = sum + e * ki;
        u = kp * e + sum + kd * (e - last);
        last = e;
        if (u > 10)
            u = 10;
        else if (u < -10)
            u = -10;
        out = u;
        s = s + 0.001;
        if (s > 1) s = s - 1;
        path = s * s * s * (10 + s * (-15 + 6 * s));
        switch (state) {
            case 0:
                state = 1;
                break;
            case 1:
                if (path > 0.5) state = 2;
                break;
            case 2:
                if (path < 0.5) state = 0;
                break;
            default:
                state = 0;
        }
        i = 0;
        n = k;
        while (i < 8) {
            n = static_cast<std::int32_t>(static_cast<std::uint32_t>(n) * 3U +
                                          static_cast<std::uint32_t>(i));
            i = i + 1;
        }
        k = n;
    }
};

std::shared_ptr<const SourceFile> bodies(int count) {
    std::string text;
    for (int i = 0; i < count; ++i)
        text += "FUNCTION_BLOCK Body" + std::to_string(i) + body + "END_FUNCTION_BLOCK\n";
    return std::make_shared<const SourceFile>(SourceFile{"bodies.st", text});
}

constexpr int scans = 1000;

void in_cpp(benchmark::State& state) {
    Body block;
    block.wanted = 1;
    Quickest least;
    for (auto _ : state) {
        least.time([&] {
            for (int i = 0; i < scans; ++i) {
                block.scan();
                benchmark::DoNotOptimize(block);
            }
        });
    }
    least.count(state, scans);
}
BENCHMARK(in_cpp);

void in_structured_text(benchmark::State& state) {
    Diagnostics out;
    const auto library = st::compile({bodies(1)}, standard_blocks(), out);
    const BlockType& kind = library->kinds()[0];
    std::vector<std::uint64_t> memory(kind.size / 8);
    auto* block = reinterpret_cast<std::byte*>(memory.data());
    kind.construct(block);
    Quickest least;
    for (auto _ : state) {
        least.time([&] {
            for (int i = 0; i < scans; ++i) kind.scan_blocks(block, 1, {}, {kind.context, nullptr});
        });
    }
    least.count(state, scans);
    if (std::getenv("ST_LISTING")) std::puts(library->listing().c_str());
}
BENCHMARK(in_structured_text);

/// A multiply and an add after the other, the measure of the machine.
void multiply_add(benchmark::State& state) {
    double x = 1;
    Quickest least;
    for (auto _ : state) {
        least.time([&] {
            for (int i = 0; i < scans; ++i) {
                for (int k = 0; k < 10; ++k) x = x * 0.999 + 0.5;
                benchmark::DoNotOptimize(x);
            }
        });
    }
    least.count(state, 10 * scans);
}
BENCHMARK(multiply_add);

void compile_200(benchmark::State& state) {
    const auto source = bodies(200);
    Quickest least;
    for (auto _ : state) {
        least.time([&] {
            Diagnostics out;
            benchmark::DoNotOptimize(st::compile({source}, standard_blocks(), out));
        });
    }
    least.count(state, 1);
}
BENCHMARK(compile_200);

}  // namespace

BENCHMARK_MAIN();
