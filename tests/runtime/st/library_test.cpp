#include "runtime/st/library/library.hpp"

#include <cstring>
#include <random>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/st/library/retained.hpp"
#include "runtime/st/library/shortened.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/types/elementary.hpp"
#include "tests/allocations.hpp"
#include "tests/runtime/st/instance.hpp"
#include "tests/source_folder.hpp"

using namespace lineshaft;

namespace {

st::Library compiled(const std::string& text, const st::Options& options = {}) {
    Diagnostics out;
    auto library = st::compile({st::source(text)}, standard_blocks(), out, options);
    INFO(out.render());
    REQUIRE(library);
    return std::move(*library);
}

const Field& field(const BlockType& kind, std::string_view name) {
    for (const Field& f : kind.fields)
        if (f.name == name) return f;
    FAIL("no field " << name);
    return kind.fields.front();
}

}  // namespace

TEST_CASE("Structured Text: variables are fields of the kind", "[st]") {
    const st::Library library = compiled(
        "TYPE Mode : (idle, busy); END_TYPE\n"
        "FUNCTION_BLOCK Job\n"
        "VAR_INPUT CONSTANT gain : LREAL := 2.0; END_VAR\n"
        "VAR_INPUT speed : LREAL; {unit := 'mm/s'} n : INT; END_VAR\n"
        "VAR_OUTPUT mode : Mode; END_VAR\n"
        "VAR RETAIN table : ARRAY[1..2] OF DINT; delay : TON; END_VAR\n"
        "delay(IN := n > 0, PT := T#1ms); table[1] := n;\n"
        "END_FUNCTION_BLOCK\n");
    const BlockType& kind = library.kinds()[0];
    CHECK(kind.name == "Job");
    CHECK(field(kind, "gain").direction == Direction::parameter);
    CHECK(field(kind, "speed").direction == Direction::input);
    CHECK(field(kind, "speed").unit == "mm/s");
    CHECK(field(kind, "n").maximum == 32767);
    CHECK(field(kind, "mode").type == lineshaft::Type::enumeration);
    CHECK(field(kind, "mode").names[1] == "busy");
    CHECK(field(kind, "table[2]").direction == Direction::local);
    CHECK(field(kind, "delay.et").unit == "ns");
    CHECK(field(kind, "error").direction == Direction::output);
    std::vector<std::string> retained;
    for (const st::RetainedVariable& variable : st::retained(kind))
        retained.push_back(variable.path);
    CHECK(retained == std::vector<std::string>{"table[1]", "table[2]", "delay"});
}

TEST_CASE("Structured Text: of arrays so many elements are fields, and all variables", "[st]") {
    const st::Library library = compiled(
        "FUNCTION_BLOCK Inner VAR a : ARRAY[0..9] OF INT; n : INT; END_VAR n := 1; "
        "END_FUNCTION_BLOCK\n"
        "FUNCTION_BLOCK Job\n"
        "VAR log : ARRAY[0..99, 0..99] OF DINT; texts : ARRAY[0..4999] OF STRING[2]; END_VAR\n"
        "VAR inner : Inner; many : ARRAY[0..1] OF Inner; t : STRING[2]; END_VAR\n"
        "VAR_OUTPUT done : BOOL; END_VAR\n"
        "log[1, 1] := 1; inner(); done := TRUE;\n"
        "END_FUNCTION_BLOCK\n");
    const BlockType& kind = *std::ranges::find(library.kinds(), "Job", &BlockType::name);
    const auto shortened = st::shortened_variables(kind);
    CHECK(kind.find_readable("done"));
    CHECK(kind.find_readable("inner.n"));
    CHECK(kind.find_readable("log[40,95]"));
    CHECK_FALSE(kind.find_readable("log[40,96]"));
    CHECK_FALSE(kind.find_readable("many[0].n"));
    CHECK(st::find_text(kind, "t") == "t");
    CHECK(st::find_text(kind, "texts[4095]") == "texts[4095]");
    CHECK(st::find_text(kind, "texts[4096]").empty());
    CHECK(std::vector(shortened.begin(), shortened.end()) ==
          std::vector<std::string_view>{"log", "texts", "inner.a", "many"});
    CHECK(st::find_shortened(kind, "LOG[40,96]") == "log");
    CHECK(st::find_shortened(kind, "logs").empty());
    CHECK(st::shortened_variables(library.kinds()[0]).empty());
}

TEST_CASE("Structured Text: with overflow_faults an integer's overflow is a fault", "[st]") {
    const unsigned seed = Catch::rngSeed() != 0 ? Catch::rngSeed() : 1;
    INFO("seed " << seed);
    std::mt19937_64 chance(seed);
    for (const char* name : {"SINT", "INT", "DINT", "LINT", "USINT", "UINT", "UDINT", "ULINT"}) {
        const st::Type& type = *st::find_elementary(name);
        const st::Library library = compiled(
            fmt::format("FUNCTION_BLOCK Job VAR_INPUT op : INT; a, b : {0}; END_VAR\n"
                        "VAR_OUTPUT x : {0}; END_VAR\n"
                        "CASE op OF 0: x := a + b; 1: x := a - b; 2: x := a * b; 3: x := a / b;\n"
                        "4: x := a MOD b; 5: x := -a; 6: x := a; x += b; END_CASE;\n"
                        "END_FUNCTION_BLOCK\n",
                        name),
            {.overflow_faults = true});
        st::Instances instances(library);
        const auto place = [&](std::string_view port) {
            return instances.memory(0) + field(library.kinds()[0], port).offset;
        };
        const auto some = [&] {
            const int bits = static_cast<int>(chance() % static_cast<unsigned>(type.bits + 1));
            const st::Wide value = bits == 0 ? 0 : st::Wide{chance() >> (64 - bits)};
            return st::wrapped(type, chance() % 4 == 0 ? st::largest(type) - value : value);
        };
        for (int i = 0; i < 4000; ++i) {
            const auto op = static_cast<std::int64_t>(chance() % 7);
            const st::Wide a = some(), b = some();
            if (type.is_unsigned_64() && (a >> 63 != 0 || b >> 63 != 0)) continue;  // no wire
            if (b == 0 && (op == 3 || op == 4)) continue;
            if (op == 3 && type.bits == 64 && b == -1) continue;
            const st::Wide right[] = {a + b, a - b, a * b, b == 0 ? 0 : a / b, b == 0 ? 0 : a % b,
                                      -a,    a + b};
            const st::Wide wanted = right[op];
            store(lineshaft::Type::integer, place("op"), op);
            store(lineshaft::Type::integer, place("a"), static_cast<std::int64_t>(a));
            store(lineshaft::Type::integer, place("b"), static_cast<std::int64_t>(b));
            instances.scan(i, 1);
            INFO(name << " op " << op << " of " << st::to_string(a) << " and " << st::to_string(b));
            const bool fits = wanted >= st::smallest(type) && wanted <= st::largest(type);
            CHECK(instances.text("error") == (fits ? "false" : "true"));
            if (fits)
                CHECK(std::get<std::int64_t>(load(lineshaft::Type::integer, place("x"))) ==
                      static_cast<std::int64_t>(wanted));
        }
    }
}

TEST_CASE("Structured Text: a wire's value beyond an input's type is a fault", "[st]") {
    const st::Library library = compiled(
        "FUNCTION_BLOCK Job VAR_INPUT n : SINT; r : REAL; END_VAR VAR_OUTPUT x : DINT; END_VAR\n"
        "x := n; END_FUNCTION_BLOCK\n");
    st::Instances instances(library);
    std::byte* n = instances.memory(0) + field(library.kinds()[0], "n").offset;
    std::byte* r = instances.memory(0) + field(library.kinds()[0], "r").offset;
    for (const std::int64_t value : {-129, -128, 0, 127, 128, 256}) {
        INFO(value);
        store(lineshaft::Type::integer, n, value);
        store(lineshaft::Type::real, r, 0.1);
        instances.scan(0, 1);
        const bool fits = value >= -128 && value <= 127;
        CHECK(instances.text("error") == (fits ? "false" : "true"));
        if (!fits) continue;
        CHECK(instances.text("x") == std::to_string(value));
        CHECK(instances.text("r") == "0.10000000149011612");
    }
}

TEST_CASE("Structured Text: a source without a variable runs", "[st]") {
    const st::Library library =
        compiled("FUNCTION Nothing : Void\nEND_FUNCTION\nPROGRAM Main\nNothing();\nEND_PROGRAM\n");
    st::Instances instances(library);
    instances.scan(0, 1);
    CHECK(instances.text("error") == "false");
}

TEST_CASE("Structured Text: a fault has its place and the calls that led there", "[st]") {
    const st::Library library = compiled(
        "FUNCTION Ratio : INT\nVAR_INPUT a, b : INT; END_VAR\nRatio := a / b;\nEND_FUNCTION\n"
        "FUNCTION_BLOCK Part\nVAR x : INT; END_VAR\nx := Ratio(1, 0);\nEND_FUNCTION_BLOCK\n"
        "PROGRAM Main\nVAR p : Part; END_VAR\np();\nEND_PROGRAM\n");
    st::Instances instances(library);
    instances.scan(0, 1);
    const st::FaultPlace fault = library.fault(library.kinds()[1], instances.memory(1));
    CHECK(fault.fault == st::Fault::division_by_zero);
    CHECK(fault.mark.line == 3);
    CHECK(fault.calls ==
          std::vector<std::string>{"Ratio (line 3)", "Part (line 7)", "Main (line 11)"});
}

TEST_CASE("Structured Text: executed instructions are counted by class", "[st]") {
    const st::Library library = compiled(
        "PROGRAM Main\nVAR i, n : DINT; x : LREAL; t : TON; END_VAR\n"
        "FOR i := 1 TO 10 DO n := n + i; x := x + 0.5; END_FOR;\nt(IN := TRUE, PT := T#1s);\n"
        "END_PROGRAM\n",
        {.times = st::InstructionTimes{}});
    st::Instances instances(library);
    for (int i = 0; i < 2; ++i) instances.scan(i, 1);
    const auto counts = library.counts(instances.memory(0));
    CHECK(counts[static_cast<std::size_t>(st::OpClass::real)] == 10);
    CHECK(counts[static_cast<std::size_t>(st::OpClass::call)] == 1);
    CHECK(counts[static_cast<std::size_t>(st::OpClass::integer)] >= 10);
}

TEST_CASE("Structured Text: a scan allocates nothing", "[st]") {
    const std::string name = GENERATE("texts.st", "texts_of_times.st");
    const st::Library library = compiled(st::read(test::in_source("tests/st/" + name))->text);
    st::Instances instances(library);
    std::vector<std::byte*> places{instances.memory(0)};
    const BlockType& kind = library.kinds()[0];
    const auto before = test::allocations();
    for (int i = 0; i < 100; ++i) kind.scan_blocks(places[0], 1, {}, {kind.context, places.data()});
    CHECK(test::allocations() == before);
}

TEST_CASE(
    "Structured Text: TwinCAT writes reals as it did, and leaves bits that a "
    "register has",
    "[st]") {
    const auto file = std::make_shared<const SourceFile>(SourceFile{
        "Main.TcPOU",
        "PROGRAM Main\n"
        "VAR\n"
        "    one : LREAL := 1.0; large : REAL := -3.402823E38; is_same : BOOL; n : INT;\n"
        "END_VAR\n"
        "is_same := LREAL_TO_STRING(one / 3.0) = '0.333333333333333'\n"
        "    AND LREAL_TO_STRING(one * 1.5E14) = '1.5E14'\n"
        "    AND LREAL_TO_STRING(one * -0.000012) = '-1.2E-5'\n"
        "    AND REAL_TO_STRING(large) = '-3.402823E38'\n"
        "    AND LREAL_TO_STRING(one * 999999.0) = '999999.0'\n"
        "    AND TO_STRING(LREAL_TO_REAL(one * 1000000.0)) = '1.0E6';\n"
        "n := LREAL_TO_INT(one * 70000.0);\n"
        "n := LREAL_TO_INT(one * 3.0E10);\n"
        "END_PROGRAM\n"});
    Diagnostics out;
    const auto library = st::compile({file}, standard_blocks(), out);
    INFO(out.render());
    REQUIRE(library);
    st::Instances instances(*library);
    instances.scan(0, 1'000'000);
    CHECK(instances.text("is_same") == "true");
    CHECK(instances.faults() == std::vector<std::string>{"12 out_of_range"});
}
