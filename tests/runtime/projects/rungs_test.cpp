#include <fstream>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/program/program.hpp"
#include "runtime/st/library/library.hpp"
#include "tests/folder.hpp"

namespace lineshaft::projects::rungs {
namespace {

struct Read {
    std::string text, messages;
};

/// A block of TIA Portal with variables a to d (BOOL), x to z (INT), r (REAL), a timer, a counter:
/// what its network becomes, and what compiling it says.
Read read(const std::string& network, const std::string& language = "LAD") {
    const test::Folder folder;
    std::ofstream(folder / "Block.s7dcl", std::ios::binary)
        << "{ S7_PreferredLanguage := \"LAD\" }\nFUNCTION_BLOCK \"Block\"\n"
           "VAR a, b, c, d : Bool; x, y, z : Int; r : Real; t : TON_TIME; n : CTU_INT;\n"
           "list : ARRAY[1..2] OF \"Other\"; END_VAR\n"
           "{ S7_Language := \""
        << language << "\" }\nNETWORK\n"
        << network
        << "END_NETWORK\nEND_FUNCTION_BLOCK\n"
           "FUNCTION_BLOCK \"Other\"\nVAR_INPUT in : Bool; END_VAR\nVAR_OUTPUT out : Bool; "
           "END_VAR\n"
           "BEGIN\n#out := #in;\nEND_FUNCTION_BLOCK\n"
           "FUNCTION \"Twice\" : Int\nVAR_INPUT value : Int; END_VAR\nBEGIN\n#Twice := 2 * "
           "#value;\n"
           "END_FUNCTION\n";
    Diagnostics out;
    const Project project = read_project(folder / "Block.s7dcl", {}, out);
    if (out.empty()) st::compile(project.sources, standard_blocks(), out);
    Read made;
    for (const auto& source : project.sources) made.text += source->text;
    const std::size_t begin = made.text.find("NETWORK\n") + 8;
    made.text = made.text.substr(begin, made.text.find("END_NETWORK") - begin);
    for (const Diagnostic& diagnostic : out.list())
        made.messages +=
            std::to_string(diagnostic.mark.line) + ": " + diagnostic.whole_message() + "\n";
    return made;
}

std::string text_of(const std::string& network, const std::string& language = "LAD") {
    const Read made = read(network, language);
    CHECK(made.messages == "");
    return made.text;
}

std::string rung(const std::string& steps, const std::string& from = "powerrail",
                 const std::string& end = "") {
    return "RUNG wire#" + from + "\n" + steps + "\nEND_RUNG" + (end.empty() ? "" : " wire#" + end) +
           "\n";
}

TEST_CASE("steps of a rung in a row are an AND, rungs that end at a wire an OR") {
    CHECK(text_of(rung("Contact( #a )\nwire#w1\nI_Contact( #b )\nCoil( #d )") +
                  rung("Contact( #c )", "powerrail", "w1")) == "#d := (#a OR #c) AND NOT #b;\n");
    CHECK(text_of(rung("Contact( #a )\nwire#w1\nS_Coil( #b )") + rung("R_Coil( #c )", "w1")) ==
          "_wire1 := #a;\nIF _wire1 THEN\n#b := TRUE;\nEND_IF\nIF _wire1 THEN\n#c := FALSE;\n"
          "END_IF\n");
    CHECK(text_of(rung("Contact( #a ) Not() Coil( #b ) I_Coil( #c )")) ==
          "_wire1 := NOT #a;\n#b := _wire1;\n#c := NOT _wire1;\n");
}

TEST_CASE("edges have their bits, timers and counters power as an input") {
    CHECK(text_of(rung("P_Contact( operand := #a, bit := #b )\nCoil( #d )")) ==
          "_wire1 := #a AND NOT #b;\n#b := #a;\n#d := _wire1;\n");
    CHECK(text_of(rung("Contact( #a )\n{ S7_Templates := \"time_type := Time\" }\n"
                       "#t.TON(\npt := T#1s,\net =>\n)\nCoil( #d )")) ==
          "#t.TON(IN := #a, Q => _wire1, pt := T#1s);\n#d := _wire1;\n");
    CHECK(text_of(rung("Contact( #a )\n#t.TON{ time_type := Time }( PT := T#1s, ET => )")) ==
          "#t.TON(IN := #a, PT := T#1s);\n");
    CHECK(text_of(rung("Contact( #a ) #n.CTU( r := #b, pv := 3, cv => #x )")) ==
          "#n.CTU(CU := #a, r := #b, pv := 3, cv => #x);\n");
    CHECK(text_of(rung("Contact( #a ) S_RS( operand := #d, s1 := wire#w1 )") +
                  rung("Contact( #b )", "powerrail", "w1")) ==
          "_wire2 := #a;\n_wire1 := #b;\n#d := _wire1 OR (#d AND NOT _wire2);\n");
}

TEST_CASE("boxes do something where power is at them, and it goes on") {
    CHECK(text_of(rung("Contact( #a )\n{ S7_Templates := \"SrcType := Int\" }\n"
                       "Add( in1 := #x, in2 := 2, in3 := #y, out => #z )")) ==
          "IF #a THEN\n#z := (#x + 2) + #y;\nEND_IF\n");
    CHECK(text_of(rung("Contact( #a ) Move( in := 3, out1 => #x, out2 => #y ) Coil( #b )")) ==
          "_wire1 := #a;\nIF _wire1 THEN\n#x := MOVE(3);\n#y := MOVE(3);\nEND_IF\n#b := _wire1;\n");
    CHECK(text_of(rung("{ S7_Templates := \"[SrcType := Real, DestType := Int]\" }\n"
                       "Convert( in := #r, out => #x )")) == "#x := REAL_TO_INT(#r);\n");
    CHECK(text_of(rung("Gt{ SrcType := Int }( IN1 := #x, IN2 := 6 ) Coil( #b )")) ==
          "#b := #x > 6;\n");
    CHECK(
        text_of(rung("{ S7_Templates := \"SrcType := Int\";\nS7_Expression := \"in1 * (in2+1)\" }\n"
                     "Calculate( in1 := #x, in2 := #y, out => #z )")) == "#z := #x * (#y+1);\n");
    CHECK(text_of(rung("Contact( #a ) #list[2]( in := #b, out => #c )")) ==
          "IF #a THEN\n#list[2](in := #b, out => #c);\nEND_IF\n");
    CHECK(text_of(rung("\"Twice\"( value := #x, Ret_Val => #y )")) ==
          "#y := \"Twice\"(value := #x);\n");
    CHECK(text_of(rung("Limit( min := 0, in := #x, max := 9, out => #y )")) ==
          "#y := LIMIT(MN := 0, IN := #x, MX := 9);\n");
    CHECK(text_of(rung("Strg_Val( in := '5', format := 16#0, p := 1, out => #y )")) ==
          "STRG_VAL(in := '5', format := 16#0, p := 1, out => #y);\n");
}

TEST_CASE("a box calculates in the type that its template says") {
    const auto box = [](const std::string& type, const std::string& call) {
        return text_of(rung("{ S7_Templates := \"SrcType := " + type + "\" }\n" + call));
    };
    CHECK(box("DInt", "Mul( in1 := #x, in2 := 100, out => #x )") == "#x := TO_DINT(#x) * 100;\n");
    CHECK(box("Int", "Mul( in1 := #x, in2 := #y, out => #z )") == "#z := #x * #y;\n");
    CHECK(box("Real", "Neg( in := #x, out => #r )") == "#r := -TO_REAL(#x);\n");
    CHECK(box("DWord", "Rol( in := #x, n := #y, out => #z )") == "#z := ROL(TO_DWORD(#x), #y);\n");
    CHECK(box("Time", "Add( in1 := T#1s, in2 := #t.ET, out => #t.PT )") ==
          "#t.PT := T#1s + #t.ET;\n");
}

TEST_CASE("ENO is that of the block that is called, or of a box that generates it") {
    CHECK(text_of(rung("Contact( #a ) \"Twice\"( value := #x, Ret_Val => #y ) Coil( #b )")) ==
          "#y := \"Twice\"(EN := #a, value := #x, ENO => _wire1);\n#b := _wire1;\n");
    CHECK(text_of(rung("#list[2]( in := #b, out => #c ) Coil( #d )")) ==
          "#list[2](in := #b, out => #c, ENO => _wire1);\n#d := _wire1;\n");
    const auto box = [](const std::string& type, const std::string& call) {
        return text_of(rung("Contact( #a ) { S7_Templates := \"" + type +
                            "\"; S7_GenerateENO := \"TRUE\" }\n" + call + " Coil( #b )"));
    };
    CHECK(box("SrcType := Int", "Sub( in1 := #x, in2 := #y, out => #z )") ==
          "#z := SUB(EN := #a, #x, #y, ENO => _wire1);\n#b := _wire1;\n");
    CHECK(box("SrcType := Int", "Neg( in := #x, out => #z )") ==
          "#z := MUL(EN := #a, -1, #x, ENO => _wire1);\n#b := _wire1;\n");
    CHECK(box("[SrcType := Real, DestType := Int]", "Convert( in := #r, out => #x )") ==
          "#x := REAL_TO_INT(EN := #a, #r, ENO => _wire1);\n#b := _wire1;\n");
    CHECK(box("value_type := Int", "Limit( min := 0, in := #x, max := 9, out => #y )") ==
          "#y := LIMIT(EN := #a, MN := 0, IN := #x, MX := 9, ENO => _wire1);\n#b := _wire1;\n");
    CHECK(box("Card := 1", "Move( in := 3, out1 => #x )") ==
          "_wire1 := #a;\nIF _wire1 THEN\n#x := MOVE(3);\nEND_IF\n#b := _wire1;\n");
    CHECK(text_of(rung("Contact( #a ) ReturnFalse()")) ==
          "IF #a THEN\nENO := FALSE;\nRETURN;\nEND_IF\n");
}

TEST_CASE("a network has a label, jumps and returns") {
    CHECK(text_of("Label( again )\n" + rung("Contact( #a ) JumpCoil( again )") +
                  rung("Contact( #b ) Return()")) ==
          "again: ;\nIF #a THEN\nGOTO again;\nEND_IF\nIF #b THEN\nRETURN;\nEND_IF\n");
}

TEST_CASE("a rung of FBD begins with what leads to its first gate") {
    CHECK(text_of("RUNG #a\nA( in2 := #b, in3 := #c )\nO( in2 := #d )\nCoil( #d )\nEND_RUNG\n",
                  "FBD") == "#d := (#a AND #b AND #c) OR #d;\n");
    CHECK(text_of("RUNG\nO( in1 := #a, in2 := #b )\nX( in2 := #c )\nCoil( #d )\nEND_RUNG\n",
                  "FBD") == "#d := (#a OR #b) XOR #c;\n");
}

TEST_CASE("what is wrong with rungs is told at its place") {
    const auto messages_of = [](const std::string& network) { return read(network).messages; };
    CHECK(messages_of(rung("Contact( #missing ) Coil( #a )")) == "8: 'missing' is not declared\n");
    CHECK(messages_of("RUNG wire#powerrail\nCoil( #a )\n") ==
          "9: expected END_RUNG, found 'END_NETWORK' (network 1, here)\n");
    CHECK(messages_of(rung("Contact #a")) ==
          "9: expected '(', found 'END_RUNG' (network 1, here)\n");
    CHECK(messages_of(rung("TON( pt := T#1s )")) == "8: TON has no instance (network 1, TON)\n");
    CHECK(messages_of(rung("Contact( )\nCoil( #a )")) ==
          "8: there is nothing at operand of Contact (network 1, Contact)\n");
    CHECK(messages_of(rung("Coil( #a )", "w1")) ==
          "7: nothing leads to wire#w1 (network 1, its rung)\n");
    CHECK(messages_of(rung("Contact( #a )", "powerrail", "w1")) ==
          "7: nothing takes what leads to wire#w1 (network 1, its rung)\n");
    CHECK(messages_of(rung("wire#w1 Coil( #a )") + rung("Contact( #b )", "w1", "w1")) ==
          "7: the wires lead round in a circle (network 1, its rung)\n");
    CHECK(messages_of(rung("IsArrayContact( #x ) Coil( #a )")) ==
          "8: the instruction IsArrayContact is not supported (network 1, IsArrayContact)\n");
}

}  // namespace
}  // namespace lineshaft::projects::rungs
