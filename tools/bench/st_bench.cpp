#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>

#include "blocks/catalog.hpp"
#include "runtime/model/value.hpp"
#include "runtime/st/code/native/compile.hpp"
#include "runtime/st/library/library.hpp"
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

/// The same in C++, of the same types. The compiler does not see how often the loop goes round, nor
/// what comes in: else it makes one product of the eight passes.
struct Body {
    double wanted = 0, actual = 0, kp = 2, ki = 0.5, kd = 0.1;
    double out = 0, path = 0;
    std::int32_t state = 0;
    double sum = 0, last = 0, e = 0, s = 0, u = 0;
    std::int32_t i = 0, n = 0, k = 0, passes = 8;

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
        while (i < passes) {
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

// What programs consist of besides: structures, arrays, calls, texts, comments; 50 lines.
constexpr const char* station = R"(
FUNCTION_BLOCK Station#
{ S7_Optimized_Access := 'TRUE' }
VAR_INPUT
    start, stop, sensor : BOOL;   // from the conveyor
    speed : LREAL; {unit := 'mm/s'}
END_VAR
VAR_OUTPUT
    busy, done : BOOL;
    count : DINT;
END_VAR
VAR
    state : DINT;
    delay : TON;
    parts : ARRAY[0..15] OF Part#;
    best : Part#;
    sum : LREAL;
    i, last : INT;
    name : STRING[20];
END_VAR
(* the sequence of the station *)
REGION sequence
    CASE state OF
        0:  busy := FALSE;
            IF start AND NOT stop THEN state := 10; END_IF;
        10: busy := TRUE;
            delay(IN := sensor, PT := T#250ms);
            IF delay.Q THEN state := 20; END_IF;
        20: parts[last].length := speed * 0.25;
            parts[last].good := speed > 1.0 AND speed < 100.0;
            last := (last + 1) MOD 16;
            count := count + 1;
            state := 30;
        30: done := TRUE;
            name := CONCAT('part ', DINT_TO_STRING(count));
            state := 0;
    ELSE
        state := 0;
    END_CASE;
END_REGION
sum := 0.0;
FOR i := 0 TO 15 DO
    IF parts[i].good AND (parts[i].length > best.length OR i = 0) THEN
        best := parts[i];
    END_IF;
    sum := sum + Mean#(a := parts[i].length, b := best.length);
END_FOR;
END_FUNCTION_BLOCK
TYPE Part# : STRUCT length : LREAL; good : BOOL; END_STRUCT; END_TYPE
FUNCTION Mean# : LREAL
VAR_INPUT a, b : LREAL; END_VAR
Mean# := (a + b) / 2.0;
END_FUNCTION)";

std::shared_ptr<const SourceFile> stations(int lines) {
    std::string text;
    for (int number = 0; std::ranges::count(text, '\n') < lines; ++number)
        for (const char* c = station; *c; ++c)
            *c == '#' && c[-1] != 'T' ? text += std::to_string(number) : text += *c;
    return std::make_shared<const SourceFile>(SourceFile{"stations.st", text});
}

constexpr int scans = 1000;

/// What comes in, another in each scan.
double wanted(int scan) {
    return 2.0 + 0.125 * ((scan * 37) % 64);
}

void in_cpp(benchmark::State& state) {
    Body block;
    benchmark::DoNotOptimize(block);
    Quickest least;
    for (auto _ : state) {
        least.time([&] {
            for (int i = 0; i < scans; ++i) {
                block.wanted = wanted(i);
                block.scan();
                benchmark::DoNotOptimize(block);
            }
        });
    }
    least.count(state, scans);
}
BENCHMARK(in_cpp);

enum class Way { interpreted, native, compiled };

/// `compiled` waits for the compiler where the cache has nothing yet.
std::optional<st::Library> made(const std::shared_ptr<const SourceFile>& source, Way way) {
    const auto tell = [](const std::string& why) { std::fprintf(stderr, "%s\n", why.c_str()); };
    st::compile_natively(way == Way::compiled ? +tell : nullptr);
    Diagnostics out;
    auto library =
        st::compile({source}, standard_blocks(), out, {.native = way != Way::interpreted});
    if (way == Way::compiled) st::end_compiling();
    return library;
}

void in_structured_text(benchmark::State& state, Way way) {
    const auto library = made(bodies(1), way);
    const BlockType& kind = library->kinds()[0];
    std::vector<std::uint64_t> memory(kind.size / 8);
    auto* block = reinterpret_cast<std::byte*>(memory.data());
    kind.construct(block);
    std::byte* const input = block + kind.find_settable("wanted")->offset;
    const Scan now;  // which the executive makes once for all blocks of a task
    const Context context{kind.context, nullptr};
    const auto scan = [&](int i) {
        const double value = wanted(i);
        std::memcpy(input, &value, sizeof value);
        kind.scan_blocks(block, 1, now, context);
    };
    Quickest least;
    Body same;
    for (auto _ : state) {
        least.time([&] {
            for (int i = 0; i < scans; ++i) scan(i);
        });
        for (int i = 0; i < scans; ++i) {
            same.wanted = wanted(i);
            same.scan();
        }
    }
    least.count(state, scans);
    const auto result = [&](const char* name) {
        return load(kind.find_readable(name)->type, block + kind.find_readable(name)->offset);
    };
    const bool agrees = result("out") == Value{same.out} && result("path") == Value{same.path} &&
                        result("state") == Value{std::int64_t{same.state}} &&
                        result("k") == Value{std::int64_t{same.k}};
    if (!agrees) state.SkipWithError("Structured Text and C++ differ");
    if (std::getenv("ST_LISTING")) std::puts(library->listing().c_str());
}
BENCHMARK_CAPTURE(in_structured_text, native, Way::native);
BENCHMARK_CAPTURE(in_structured_text, compiled, Way::compiled);
BENCHMARK_CAPTURE(in_structured_text, interpreted, Way::interpreted);

void empty_block(benchmark::State& state, Way way) {
    const auto library = made(std::make_shared<const SourceFile>(SourceFile{
                                  "empty.st", "FUNCTION_BLOCK Empty\nEND_FUNCTION_BLOCK\n"}),
                              way);
    const BlockType& kind = library->kinds()[0];
    std::vector<std::uint64_t> memory(kind.size / 8);
    auto* block = reinterpret_cast<std::byte*>(memory.data());
    kind.construct(block);
    const Scan now;
    const Context context{kind.context, nullptr};
    Quickest least;
    for (auto _ : state) {
        least.time([&] {
            for (int i = 0; i < scans; ++i) kind.scan_blocks(block, 1, now, context);
        });
    }
    least.count(state, scans);
}
BENCHMARK_CAPTURE(empty_block, native, Way::native);
BENCHMARK_CAPTURE(empty_block, compiled, Way::compiled);
BENCHMARK_CAPTURE(empty_block, interpreted, Way::interpreted);

// A method of an instance, called plainly and through an interface.
constexpr const char* calls = R"(
INTERFACE Adds
METHOD Add : LREAL
VAR_INPUT a : LREAL; END_VAR
END_METHOD
END_INTERFACE
FUNCTION_BLOCK Plain
VAR one : Sum; y : LREAL; i : DINT; END_VAR
FOR i := 1 TO 1000 DO y := one.Add(a := 1.0); END_FOR;
END_FUNCTION_BLOCK
FUNCTION_BLOCK Found
VAR one : Sum; any : Adds; y : LREAL; i : DINT; END_VAR
any := one;
FOR i := 1 TO 1000 DO y := any.Add(a := 1.0); END_FOR;
END_FUNCTION_BLOCK
FUNCTION_BLOCK Sum IMPLEMENTS Adds
VAR s : LREAL; END_VAR
METHOD Add : LREAL
VAR_INPUT a : LREAL; END_VAR
s := s * 0.5 + a;
Add := s;
END_METHOD
END_FUNCTION_BLOCK
)";

void call(benchmark::State& state, std::string_view name) {
    const auto library =
        made(std::make_shared<const SourceFile>(SourceFile{"calls.st", calls}), Way::native);
    const BlockType& kind = *std::ranges::find(library->kinds(), name, &BlockType::name);
    std::vector<std::uint64_t> memory(kind.size / 8);
    auto* block = reinterpret_cast<std::byte*>(memory.data());
    kind.construct(block);
    const Scan now;
    const Context context{kind.context, nullptr};
    Quickest least;
    for (auto _ : state) least.time([&] { kind.scan_blocks(block, 1, now, context); });
    least.count(state, 1000);
}
BENCHMARK_CAPTURE(call, plain, "Plain");
BENCHMARK_CAPTURE(call, found, "Found");

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

void compile(benchmark::State& state, const std::shared_ptr<const SourceFile>& source, Way way) {
    made(source, way);  // then it is in the cache
    Quickest least;
    for (auto _ : state)
        least.time([&] {
            if (!made(source, way)) state.SkipWithError("it is wrong");
        });
    least.count(state, 1);
}
BENCHMARK_CAPTURE(compile, 200_bodies, bodies(200), Way::native);
BENCHMARK_CAPTURE(compile, 200_bodies_from_cache, bodies(200), Way::compiled);
BENCHMARK_CAPTURE(compile, 200_bodies_interpreted, bodies(200), Way::interpreted);
BENCHMARK_CAPTURE(compile, 10000_lines, stations(10'000), Way::native);

}  // namespace

BENCHMARK_MAIN();
