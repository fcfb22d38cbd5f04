#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/program/program.hpp"
#include "runtime/st/library/library.hpp"
#include "tests/folder.hpp"

namespace lineshaft::projects::grids {
namespace {

std::string network(const std::string& rows, const std::string& more = "") {
    return "<network" + more + ">\n" + rows + "</network>\n";
}

std::string row(const std::string& cells) {
    return "<row>" + cells + "</row>\n";
}

std::string contact(const std::string& name, const std::string& type = "open",
                    const std::string& more = "") {
    return "<contact type=\"" + type + "\" name=\"" + name + "\"" + more + "/>";
}

std::string coil(const std::string& name, const std::string& type = "open") {
    return "<coil type=\"" + type + "\" name=\"" + name + "\"/>";
}

std::string operand(const std::string& name, const std::string& type = "input") {
    return "<analog type=\"" + type + "\" name=\"" + name + "\"/>";
}

std::string part(const std::string& kind, const std::string& position, const std::string& type,
                 const std::string& pins) {
    return "<" + kind + " position=\"" + position + "\" type=\"" + type + "\">" + pins + "</" +
           kind + ">";
}

std::string pins(const std::string& input, const std::string& output = "") {
    return "<input name=\"" + input + "\"/>" +
           (output.empty() ? "" : "<output name=\"" + output + "\"/>");
}

constexpr const char* enable =
    "<input name=\"EN\" ENO=\"true\"/><output name=\"ENO\" ENO=\"true\"/>";

struct Read {
    std::string text, messages;
};

/// A program with variables a to d (BOOL), x to z (INT), and a timer: the text behind them, and
/// what compiling it says.
Read read(const std::string& networks) {
    const test::Folder folder;
    const auto write = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder / name, std::ios::binary) << text;
    };
    write("IEC.prg",
          "<Program SubType=\"IEC\" xmlns=\"http://br-automation.co.at/AS/Program\"><Files>"
          "<File>Variables.var</File><File>Cyclic.ld</File></Files></Program>\n");
    write(
        "Variables.var",
        "VAR\n\ta, b, c, d : BOOL;\n\tx, y, z : INT;\n\ttimer : TON;\n\tlink : UDINT;\nEND_VAR\n");
    write("Cyclic.ld", "PROGRAM _CYCLIC\n<?xml version=\"1.0\"?>\n<networks>\n" + networks +
                           "</networks>\nEND_PROGRAM\n");
    Diagnostics out;
    const Project project = read_project(folder / "IEC.prg", {}, out);
    if (out.empty()) st::compile(project.sources, standard_blocks(), out);
    Read made;
    for (const auto& source : project.sources) made.text += source->text;
    const std::size_t end = made.text.find("END_VAR\n");
    if (end != std::string::npos) made.text.erase(0, end + 9);
    for (const Diagnostic& diagnostic : out.list())
        made.messages +=
            std::to_string(diagnostic.mark.line) + ": " + diagnostic.whole_message() + "\n";
    return made;
}

std::string text_of(const std::string& networks) {
    const Read made = read(networks);
    CHECK(made.messages == "");
    return made.text;
}

TEST_CASE("cells of a ladder in a row are an AND, rows that are joined an OR") {
    CHECK(
        text_of(network(row(contact("a") + contact("b", "closed") + "<line/>" + coil("d")) +
                        row(contact("c", "open", " or=\"true\"") + "<empty/><empty/><empty/>"))) ==
        "d := (a OR c) AND NOT b;\nEND_PROGRAM\n");
    CHECK(text_of(network(row(contact("a", "positive transition") + coil("b", "set")) +
                          row("<empty or=\"true\"/>" + coil("c", "negated")))) ==
          "VAR\n    _edge1 : BOOL;\nEND_VAR\n_edge1 := EDGEPOS(a);\nIF _edge1 THEN\nb := TRUE;\n"
          "END_IF\nc := NOT _edge1;\nEND_PROGRAM\n");
}

TEST_CASE("boxes of a ladder are two cells wide, and called with what leads to them") {
    CHECK(text_of(network(
              row(contact("a") + part("function", "top", "Compare!", enable) + "<empty/>") +
              row("<empty/>" + part("function", "middle", "Compare!", pins("", "56")) +
                  operand("d", "output")) +
              row("<empty/>" + part("function", "bottom", "Compare!", pins("&lt;!x &lt; 3")) +
                  "<empty/>"))) == "IF a THEN\nd := x < 3;\nEND_IF\nEND_PROGRAM\n");
    CHECK(text_of(network(
              row("<empty/><functionblock position=\"header\" name=\"timer\" type=\"TON\"/>"
                  "<empty/>") +
              row(contact("a") + part("functionblock", "top", "TON", pins("IN", "Q")) + coil("d")) +
              row(operand("T#1s") + part("functionblock", "bottom", "TON", pins("PT", "ET")) +
                  "<empty/>"))) == "timer(IN := a, PT := T#1s);\nd := timer.Q;\nEND_PROGRAM\n");
    CHECK(text_of(network(row(operand("x") + part("function", "top", "MOVE", pins("IN", "40")) +
                              operand("y", "output")) +
                          row(operand("3") + part("function", "bottom", "MOVE", pins("", "40")) +
                              operand("z", "output")))) == "y := x;\nz := 3;\nEND_PROGRAM\n");
    CHECK(text_of(network(row(operand("x") + part("function", "topbottom", "ABS", pins("IN", "4")) +
                              part("function", "topbottom", "INT_TO_REAL", pins("IN", "8")) +
                              part("function", "topbottom", "TRUNC", pins("IN", "4")) + "<line/>" +
                              operand("link", "output")))) ==
          "link := TRUNC(INT_TO_REAL(ABS(x)));\nEND_PROGRAM\n");
    CHECK(text_of(network(row(contact("x", "address") +
                              part("function", "topbottom", "MOVE", pins("IN", "7")) +
                              operand("link", "output")))) == "link := ADR(x);\nEND_PROGRAM\n");
}

TEST_CASE("a ladder jumps, returns, and leaves out what is commented") {
    CHECK(text_of(network(row(contact("a") + coil("end", "jump"))) +
                  network(row(contact("b") + coil("c")), " commented=\"1\"") +
                  network(row(contact("b") + coil("d"))) +
                  network(row(contact("b") + coil("", "return")), " label=\"end\"")) ==
          "VAR\n    _jump1 : INT;\nEND_VAR\n_jump1 := 0;\nIF a THEN\n_jump1 := 1;\nEND_IF\n"
          "IF _jump1 = 0 THEN\nd := b;\nEND_IF\nIF _jump1 = 1 THEN _jump1 := 0; END_IF\n"
          "IF _jump1 = 0 THEN\nIF b THEN\nRETURN;\nEND_IF\nEND_IF\nEND_PROGRAM\n");
}

TEST_CASE("what a ladder cannot say is told at its place") {
    const auto messages_of = [](const std::string& networks) { return read(networks).messages; };
    CHECK(messages_of(network(row("<contact type=\"open\"/>" + coil("d")))) ==
          "5: an operand is missing here (network 1, contact )\n");
    CHECK(messages_of(network(row(contact("missing") + coil("d")))) ==
          "5: 'missing' is not declared (network 1, contact missing)\n");
    CHECK(messages_of(network("") + network(row("<empty/>" + coil("d")))) ==
          "7: nothing leads to this coil (network 2, coil d)\n");
    CHECK(messages_of(network(row(contact("a") + coil("gone", "jump")))) ==
          "5: there is no label 'gone' in this body (network 1, coil gone)\n");
    CHECK(
        messages_of(network(row("<empty/>" + part("function", "topbottom", "ABS", pins("IN", "4")) +
                                operand("x", "output")))) ==
        "5: nothing leads to an input of this box (network 1, function )\n");
    CHECK(messages_of(network(row("<wheel/>"))) ==
          "5: 'wheel' of a ladder is not supported (network 1, wheel )\n");
}

TEST_CASE("an action block leads on what leads to it") {
    const std::string block =
        "<actionblock position=\"topbottom\"><input qualifier=\"N\"/>"
        "<output name=\"timer\"/></actionblock>";
    CHECK(text_of(network(row(block + coil("d")))) == "timer();\nd := TRUE;\nEND_PROGRAM\n");
    CHECK(text_of(network(row(contact("a") + block + coil("d")))) ==
          "VAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := a;\nIF _wire1 THEN\ntimer();\nEND_IF\n"
          "d := _wire1;\nEND_PROGRAM\n");
    CHECK(text_of(network(row(contact("a") + block + "<empty/>"))) ==
          "IF a THEN\ntimer();\nEND_IF\nEND_PROGRAM\n");
}

}  // namespace
}  // namespace lineshaft::projects::grids
