#include "runtime/st/syntax/dialect.hpp"

#include <catch2/catch.hpp>

#include "runtime/st/syntax/lexer.hpp"

using namespace lineshaft;

TEST_CASE("Structured Text: the ending of a file's name is its dialect", "[st]") {
    CHECK(&st::dialect_of("axis.st") == &st::iec);
    for (const char* path : {"old.scl/AXIS.ST", "axis.St", "axis.sT"})
        CHECK(&st::dialect_of(path) == &st::iec);
    for (const char* path : {"axis.scl", "axis.s7dcl", "axis.udt", "axis.db", "st", "(axis.st)"})
        CHECK(&st::dialect_of(path) == &st::scl);
    for (const char* path : {"types.typ", "a/Global.var", "lib.fun", "Belt/IEC.prg"})
        CHECK(&st::dialect_of(path) == &st::automation_studio);
    const auto written = [](std::string_view text) { return &st::dialect_of("plc.st", text); };
    CHECK(written("CONFIGURATION Config0\r\n\r\n  RESOURCE Res0 ON PLC\r\n") == &st::matiec);
    CHECK(written("RESOURCE Cpu ON Controller // ON PLC") == &st::iec);
    CHECK(written("RESOURCE Cpu ON Controller\n// it runs ON PLC") == &st::iec);
    CHECK(written("{ attribute 'qualified_only'}\nVAR_GLOBAL") == &st::codesys);
    CHECK(written("// no attribute 'strict' here\n") == &st::iec);
    CHECK(written("USING System.Timer;\n") == &st::simatic_ax);
    CHECK(written("// USING x;\n    NAMESPACE Plant.Axes // of one\n") == &st::simatic_ax);
    CHECK(written("(* by\nUSING the timer of it;\nNAMESPACE 'x'\n*)") == &st::iec);
    CHECK(&st::dialect_of("plc.xml") == &st::codesys);
    CHECK(&st::dialect_of("plc.EXP") == &st::codesys_23);
    CHECK(&st::dialect_of("plc.xml", "lamp AT %QX0.12 : BOOL;") == &st::word_addressed);
    CHECK(&st::dialect_of("plc.EXP", "lamp AT %QX0.12 : BOOL;") == &st::word_addressed_23);
    CHECK(&st::dialect_of("plc.EXP", "%QX0.7 %QW0 %IX10.3 'of 10% X0.12'") == &st::codesys_23);
    CHECK(&st::dialect_of("plc.st", "lamp AT %QX0.12 : BOOL;") == &st::iec);
    for (const char* path : {"MAIN.TcPOU", "GVL.TcGVL", "T.TcDUT", "I.TcIO"})
        CHECK(&st::dialect_of(path) == &st::twincat);
}

TEST_CASE("Structured Text: a source is of the prelude by who reads it, not by its name", "[st]") {
    const auto file = [](std::string path) {
        return std::make_shared<const SourceFile>(SourceFile{std::move(path), "END"});
    };
    Diagnostics out;
    const st::Tokens user = st::read_tokens(file("(old)/axis.st"), out);
    CHECK_FALSE(user.source->is_prelude());
    CHECK(&user.tokens[0].place.dialect() == &st::iec);
    const st::Tokens prelude = st::read_tokens(file("axis.st"), out, st::SourceKind::prelude);
    CHECK(prelude.source->is_prelude());
    CHECK(&prelude.tokens[0].place.dialect() == &st::scl);
    CHECK(prelude.tokens[0].place.source == prelude.source.get());
}

TEST_CASE("Structured Text: a dialect is named for what the ending .st does not say", "[st]") {
    const auto dialect = [](std::string read_as, st::SourceKind kind, std::string text = "END") {
        const SourceFile file{
            .path = "a.st", .text = std::move(text), .read_as = std::move(read_as)};
        Diagnostics out;
        const auto read = st::read_tokens(std::make_shared<const SourceFile>(file), out, kind);
        return &read.tokens[0].place.dialect();
    };
    using enum st::SourceKind;
    for (const auto& [name, ending] : st::dialect_names()) {
        CAPTURE(name);
        const st::Dialect* const own = &st::dialect_of(ending);
        CHECK(dialect(std::string(ending), program) == own);
        st::read_plain_text_as(ending);
        CHECK(dialect("", program) == own);
        CHECK(dialect("", tests) == own);
        CHECK(dialect(".scl", program) == &st::scl);
        CHECK(dialect("", library) == &st::iec);
        CHECK(dialect("", program, "{attribute 'qualified_only'}") == own);
        CHECK(dialect("", library, "{attribute 'qualified_only'}") == &st::codesys);
        st::read_plain_text_as("");
        CHECK(dialect("", program) == &st::iec);
        CHECK(dialect("", program, "{attribute 'qualified_only'}") == &st::codesys);
    }
}
