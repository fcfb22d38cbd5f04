#include <fstream>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/program/program.hpp"
#include "runtime/st/library/library.hpp"
#include "tests/folder.hpp"

namespace lineshaft::projects {
namespace {

std::string in(const std::string& lines) {
    return "<connectionPointIn>" + lines + "</connectionPointIn>";
}

/// A line from an element.
std::string from(int id, const std::string& pin = "") {
    return "<connection refLocalId=\"" + std::to_string(id) + "\"" +
           (pin.empty() ? "" : " formalParameter=\"" + pin + "\"") + "/>";
}

std::string element(const std::string& tag, int id, int y, const std::string& inside,
                    const std::string& more = "") {
    return "<" + tag + " localId=\"" + std::to_string(id) + "\" " + more + "><position x=\"" +
           std::to_string(id) + "\" y=\"" + std::to_string(y) + "\"/>" + inside + "</" + tag +
           ">\n";
}

std::string contact(int id, int y, const std::string& variable, const std::string& lines,
                    const std::string& more = "") {
    return element("contact", id, y, in(lines) + "<variable>" + variable + "</variable>", more);
}

std::string coil(int id, int y, const std::string& variable, const std::string& lines,
                 const std::string& more = "") {
    return element("coil", id, y, in(lines) + "<variable>" + variable + "</variable>", more);
}

std::string in_variable(int id, const std::string& expression) {
    return element("inVariable", id, 0, "<expression>" + expression + "</expression>");
}

std::string out_variable(int id, int y, const std::string& expression, const std::string& lines,
                         const std::string& more = "") {
    return element("outVariable", id, y, in(lines) + "<expression>" + expression + "</expression>",
                   more);
}

std::string input(const std::string& name, const std::string& lines, const std::string& more = "") {
    return "<variable formalParameter=\"" + name + "\" " + more + ">" + in(lines) + "</variable>";
}

std::string box(int id, int y, const std::string& type, const std::string& inputs,
                const std::vector<std::string>& outputs, const std::string& more = "") {
    std::string pins;
    for (const std::string& output : outputs)
        pins += "<variable formalParameter=\"" + output + "\"><connectionPointOut/></variable>";
    return element("block", id, y,
                   "<inputVariables>" + inputs + "</inputVariables><outputVariables>" + pins +
                       "</outputVariables>",
                   "typeName=\"" + type + "\" " + more);
}

std::string variable(const std::string& name, const std::string& type) {
    return "<variable name=\"" + name + "\"><type>" + type + "</type></variable>";
}

/// A program with variables a to d (BOOL), x to z (INT) and a timer.
std::string program(const std::string& language, const std::string& body,
                    const std::string& more = "", const std::string& kind = "program") {
    std::string variables = variable("timer", "<derived name=\"TON\"/>");
    for (const std::string name : {"a", "b", "c", "d"}) variables += variable(name, "<BOOL/>");
    for (const std::string name : {"x", "y", "z"}) variables += variable(name, "<INT/>");
    if (kind == "function") variables = variables.substr(variables.find("<variable name=\"a\""));
    return "<project xmlns=\"http://www.plcopen.org/xml/tc6_0201\"><types><pous>\n"
           "<pou name=\"P\" pouType=\"" +
           kind + "\"><interface>" +
           (kind == "function" ? "<returnType><BOOL/></returnType>" : "") + "<localVars>" +
           variables + "</localVars></interface>" + more + "<body><" + language + ">\n" + body +
           "</" + language + "></body></pou></pous></types></project>\n";
}

struct Read {
    std::string text, messages, warnings;
};

/// The text behind the program's own variables, and what compiling it says.
Read read(const std::string& xml) {
    const test::Folder folder;
    const std::string path = folder / "project.xml";
    std::ofstream(path, std::ios::binary) << xml;
    Diagnostics out;
    const Project project = read_project(path, {}, out);
    if (out.empty()) st::compile(project.sources, standard_blocks(), out);
    Read made;
    for (const auto& source : project.sources) made.text += source->text;
    const std::size_t end = made.text.find("END_VAR\n");
    if (end != std::string::npos) made.text.erase(0, end + 8);
    for (const Diagnostic& diagnostic : out.list()) {
        REQUIRE(diagnostic.mark.file);
        REQUIRE(diagnostic.mark.line > 0);
        made.messages += std::to_string(diagnostic.mark.line) + ":" +
                         std::to_string(diagnostic.mark.column) + ": " +
                         diagnostic.whole_message() + "\n";
    }
    for (const Diagnostic& warning : out.warnings())
        made.warnings += std::to_string(warning.mark.line) + ": " + warning.whole_message() + "\n";
    return made;
}

std::string ladder(const std::string& body) {
    const Read made = read(program("LD", element("leftPowerRail", 0, 0, "") + body));
    CHECK(made.messages == "");
    return made.text;
}

std::string diagram(const std::string& body) {
    const Read made = read(program("FBD", body));
    CHECK(made.messages == "");
    return made.text;
}

}  // namespace

TEST_CASE("contacts in series are AND, lines that meet are OR, coils take what comes") {
    CHECK(ladder(contact(1, 10, "a", from(0)) + contact(2, 20, "b", from(0), "negated=\"true\"") +
                 contact(3, 10, "c", from(1) + from(2)) + coil(4, 10, "d", from(3))) ==
          "d := (a OR NOT b) AND c;\nEND_PROGRAM\n");
    CHECK(ladder(contact(1, 10, "a", from(0)) + coil(2, 10, "b", from(1), "negated=\"true\"") +
                 contact(3, 20, "c", from(0)) + coil(4, 20, "d", from(3), "storage=\"set\"") +
                 contact(5, 30, "b", from(0)) + coil(6, 30, "d", from(5), "storage=\"reset\"")) ==
          "b := NOT a;\nIF c THEN d := TRUE; END_IF\nIF b THEN d := FALSE; END_IF\n"
          "END_PROGRAM\n");
}

TEST_CASE("networks are evaluated from top to bottom, or as executionOrderId says") {
    const auto body = [](const std::string& first, const std::string& second) {
        return contact(1, 50, "a", from(0)) + coil(2, 50, "b", from(1), first) +
               contact(3, 10, "b", from(0)) + coil(4, 10, "c", from(3), second);
    };
    CHECK(ladder(body("", "")) == "c := b;\nb := a;\nEND_PROGRAM\n");
    CHECK(ladder(body("executionOrderId=\"1\"", "executionOrderId=\"2\"")) ==
          "b := a;\nc := b;\nEND_PROGRAM\n");
}

TEST_CASE("what several coils take is evaluated once") {
    CHECK(ladder(contact(1, 10, "a", from(0)) + contact(2, 10, "b", from(1)) +
                 coil(3, 10, "a", from(2)) + coil(4, 20, "c", from(2))) ==
          "VAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := a AND b;\na := _wire1;\nc := _wire1;\n"
          "END_PROGRAM\n");
}

TEST_CASE("edges of contacts and coils are R_TRIG and F_TRIG") {
    CHECK(ladder(contact(1, 10, "a", from(0), "edge=\"rising\"") +
                 coil(2, 10, "b", from(1), "edge=\"falling\"")) ==
          "VAR\n    _edge1 : R_TRIG;\n    _edge2 : F_TRIG;\nEND_VAR\n_edge1(CLK := a);\n"
          "_edge2(CLK := _edge1.Q);\nb := _edge2.Q;\nEND_PROGRAM\n");
}

TEST_CASE("boxes are operators, calls of functions, and calls of blocks") {
    CHECK(diagram(in_variable(1, "x") + in_variable(2, "y") + in_variable(3, "3") +
                  box(4, 0, "ADD", input("IN1", from(1)) + input("IN2", from(2)), {"OUT"}) +
                  box(5, 0, "MAX", input("IN1", from(4, "OUT")) + input("IN2", from(3)), {"OUT"}) +
                  out_variable(6, 0, "z", from(5, "OUT"))) == "z := MAX(x + y, 3);\nEND_PROGRAM\n");
    CHECK(diagram(in_variable(1, "a") + in_variable(2, "T#1s") +
                  box(3, 0, "TON", input("IN", from(1), "negated=\"true\"") + input("PT", from(2)),
                      {"Q", "ET"}, "instanceName=\"timer\"") +
                  out_variable(4, 0, "b", from(3, "Q"), "negated=\"true\"")) ==
          "timer(IN := NOT a, PT := T#1s);\nb := NOT timer.Q;\nEND_PROGRAM\n");
}

TEST_CASE("a box calls a METHOD or an ACTION of the instance beside it") {
    const auto call = [](const std::string& kind) {
        return "<addData><data name=\"fbdcalltype\"><CallType xmlns=\"\">" + kind +
               "</CallType></data></addData>";
    };
    const auto with = [](std::string drawn, const std::string& more) {
        return drawn.insert(drawn.rfind("</block>"), more);
    };
    const std::string beside = "instanceName=\"motor\"";
    std::string xml = program(
        "FBD", in_variable(1, "a") + in_variable(2, "x") +
                   with(box(3, 0, "Motor.Stop", input("EN", from(1)) + input("way", from(2)),
                            {"ENO", "Stop"}, beside),
                        call("method")) +
                   out_variable(4, 5, "b", from(3, "Stop")) +
                   with(box(5, 10, "Motor.Find", "", {"at"}, beside), call("method")) +
                   out_variable(6, 15, "y", from(5, "at")) +
                   with(box(7, 20, "Motor.Stop", input("way", from(2)), {"Stop"}, beside),
                        call("method")) +
                   with(box(8, 30, "Motor.Turn", "", {}, beside), call("action")));
    xml.insert(xml.find("<variable name=\"a\""), variable("motor", "<derived name=\"Motor\"/>"));
    const auto method = [](const std::string& name, const std::string& interface) {
        return "<data name=\"method\"><Method name=\"" + name + "\"><interface>" + interface +
               "</interface><body><ST><xhtml>;</xhtml></ST></body></Method></data>";
    };
    xml.insert(xml.find("<pou name"),
               "<pou name=\"Motor\" pouType=\"functionBlock\"><interface/><actions><action "
               "name=\"Turn\"><body><ST><xhtml>;</xhtml></ST></body></action></actions><body><ST>"
               "<xhtml>;</xhtml></ST></body><addData>" +
                   method("Stop", "<returnType><BOOL/></returnType><inputVars>" +
                                      variable("way", "<INT/>") + "</inputVars>") +
                   method("Find", "<outputVars>" + variable("at", "<INT/>") + "</outputVars>") +
                   "</addData></pou>\n");
    const Read made = read(xml);
    CHECK(made.messages == "");
    CHECK(made.text.substr(made.text.rfind("END_VAR\n") + 8) ==
          "IF a THEN b := motor.Stop(x); END_IF\nmotor.Stop(x);\nmotor.Find(at => _wire1);\n"
          "y := _wire1;\nmotor.Turn();\nEND_PROGRAM\n");
}

TEST_CASE("a box with EN is called while it is TRUE, and ENO says so") {
    CHECK(diagram(
              in_variable(1, "a") + in_variable(2, "x") + in_variable(3, "y") +
              box(4, 0, "ADD", input("EN", from(1)) + input("IN1", from(2)) + input("IN2", from(3)),
                  {"ENO", "OUT"}) +
              out_variable(5, 0, "z", from(4, "OUT")) + out_variable(6, 5, "b", from(4, "ENO"))) ==
          "VAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := a;\nIF _wire1 THEN z := x + y; END_IF\n"
          "b := _wire1;\nEND_PROGRAM\n");
}

TEST_CASE("a line that goes around has the value of the last scan") {
    CHECK(diagram(in_variable(1, "x") +
                  box(2, 0, "ADD", input("IN1", from(1)) + input("IN2", from(2, "OUT")), {"OUT"}) +
                  out_variable(3, 0, "z", from(2, "OUT"))) ==
          "VAR\n    _wire1 : INT;\nEND_VAR\n_wire1 := x + _wire1;\nz := _wire1;\nEND_PROGRAM\n");
    CHECK(diagram(box(1, 0, "TON", input("IN", from(1, "Q"), "negated=\"true\""), {"Q"},
                      "instanceName=\"timer\"")) == "timer(IN := NOT timer.Q);\nEND_PROGRAM\n");
}

TEST_CASE("jumps, labels and returns of networks") {
    CHECK(diagram(in_variable(1, "a") + element("jump", 2, 0, in(from(1)), "label=\"L\"") +
                  in_variable(3, "x") + out_variable(4, 10, "y", from(3)) +
                  element("label", 5, 20, "", "label=\"L\"") + in_variable(6, "y") +
                  out_variable(7, 30, "z", from(6)) + in_variable(8, "b") +
                  element("return", 9, 40, in(from(8)))) ==
          "VAR\n    _jump1 : INT;\nEND_VAR\n_jump1 := 0;\nIF a THEN _jump1 := 1; END_IF\n"
          "IF _jump1 = 0 THEN\ny := x;\nEND_IF\nIF _jump1 = 1 THEN _jump1 := 0; END_IF\n"
          "IF _jump1 = 0 THEN\nz := y;\nIF b THEN RETURN; END_IF\nEND_IF\nEND_PROGRAM\n");
}

TEST_CASE("a message about a network names it and its element") {
    CHECK(read(program("LD", element("leftPowerRail", 0, 0, "") + contact(1, 10, "a", from(0)) +
                                 coil(2, 10, "b", from(1)) + contact(3, 20, "nobody", from(0)) +
                                 coil(4, 20, "c", from(3))))
              .messages == "6:124: 'nobody' is not declared (network 2, contact 3)\n");
    CHECK(read(program("FBD", out_variable(1, 0, "x", from(7))))
              .warnings.starts_with(
                  "3: a line comes from '7', which is no element of this body, and is left out\n"
                  "3: nothing leads to this variable (network 1, variable 1)\n"));
    CHECK(read(program("FBD", in_variable(1, "x") + "<spiral localId=\"2\"/>\n")).messages ==
          "4:1: <spiral> is no element of a network\n");
}

TEST_CASE("a function keeps nothing that an edge could be told by") {
    CHECK(
        read(program("LD",
                     element("leftPowerRail", 0, 0, "") +
                         contact(1, 0, "a", from(0), "edge=\"rising\"") + coil(2, 0, "P", from(1)),
                     "", "function"))
            .messages ==
        "4:1: an edge needs a variable that is kept from scan to scan (network 1, contact 1)\n");
}

TEST_CASE("a chart's divergences and convergences, actions and conditions") {
    const auto step = [](int id, const std::string& name, const std::string& lines,
                         const std::string& more = "") {
        return element("step", id, id, lines.empty() ? "" : in(lines),
                       "name=\"" + name + "\" " + more);
    };
    const auto transition = [](int id, const std::string& condition, const std::string& lines) {
        return element("transition", id, id,
                       in(lines) + "<condition>" + condition + "</condition>");
    };
    const auto inline_st = [](const std::string& text) {
        return "<inline name=\"\"><ST><p>" + text + "</p></ST></inline>";
    };
    const std::string body =
        step(1, "Begin", from(9), "initialStep=\"true\"") + transition(2, inline_st("a"), from(1)) +
        element("simultaneousDivergence", 3, 3, in(from(2))) + step(4, "Left", from(3)) +
        step(5, "Right", from(3)) +
        element("actionBlock", 6, 6,
                in(from(4)) +
                    "<action qualifier=\"L\" duration=\"T#1s\"><reference name=\"b\"/></action>" +
                    "<action><inline><ST><p>x := x + 1;</p></ST></inline></action>" +
                    "<action qualifier=\"S\"><reference name=\"motor.Turn\"/></action>") +
        element("simultaneousConvergence", 7, 7, in(from(4)) + in(from(5))) +
        transition(8, "<reference name=\"Ready\"/>", from(7)) +
        element("selectionConvergence", 9, 9, in(from(8))) +
        element("selectionDivergence", 10, 10, in(from(1))) +
        transition(11, "<connectionPointIn>" + from(12) + "</connectionPointIn>", from(10)) +
        contact(12, 12, "c ; ", from(13)) + element("leftPowerRail", 13, 13, "") +
        element("jumpStep", 14, 14, in(from(11)), "targetName=\"Begin\"");
    const Read made =
        read(program("SFC", body,
                     "<transitions><transition name=\"Ready\"><body><ST><p>:= Left.T > T#2s;</p>"
                     "</ST></body></transition></transitions>"));
    CHECK(made.messages == "8:285: 'motor' is not declared\n");
    CHECK(made.text == R"(ACTION _action1:
x := x + 1;

END_ACTION
INITIAL_STEP Begin:
END_STEP
STEP Left:
    b(L, T#1s);
    _action1;
    motor.Turn(S);
END_STEP
STEP Right:
END_STEP
TRANSITION FROM Begin TO (Left, Right) := a;
END_TRANSITION
TRANSITION FROM (Left, Right) TO Begin :=  Left.T > T#2s;
END_TRANSITION
TRANSITION FROM Begin TO Begin := c;
END_TRANSITION
END_PROGRAM
)");
}

TEST_CASE("what CODESYS keeps at a step are its actions") {
    const auto own = [](const std::string& kind, const std::string& name) {
        return "<attribute guid=\"" + kind + "\">" + name + "</attribute>";
    };
    const std::string attributes = "<addData><data name=\"x\"><attributes>" +
                                   own("a6b08bd8-b696-47e3-9cbf-7408b61c9ff8", "Enter") +
                                   own("700a583f-b4d4-43e4-8c14-629c7cd3bec8", "Work") +
                                   own("a2621e18-7de3-4ea6-ae6d-89e9e0b7befd", "") +
                                   "</attributes></data></addData>";
    const auto action = [](const std::string& name) {
        return "<action name=\"" + name + "\"><body><ST><p>x := x + 1;</p></ST></body></action>";
    };
    const Read made = read(program(
        "SFC",
        element("step", 1, 1, in(from(2)) + attributes, "name=\"Begin\" initialStep=\"true\"") +
            element("transition", 2, 2,
                    in(from(1)) + "<condition><inline><ST><p>a</p></ST></inline></condition>") +
            element("jumpStep", 3, 3, in(from(2)), "targetName=\"Begin\""),
        "<actions>" + action("Enter") + action("Work") + "</actions>"));
    CHECK(made.messages == "");
    CHECK(made.text.find("INITIAL_STEP Begin:\n    Enter(_ENTRY);\n    Work(_ACTIVE);\nEND_STEP") !=
          std::string::npos);
}

/// A program that CODESYS has drawn freely, beside an empty text.
std::string free_chart(const std::string& body) {
    std::string xml = program("ST", "<p></p>");
    xml.insert(xml.find("</body>"),
               "<addData><data name=\"cfc\"><CFC>" + body + "</CFC></data></addData>");
    return xml;
}

TEST_CASE("a chart that CODESYS has drawn freely goes by the numbers of its elements from 0 on") {
    const auto wire = [](int id, const std::string& lines) {
        return element("connector", id, 0, in(lines), "name=\"\"");
    };
    const Read made = read(free_chart(
        out_variable(1, 0, "z", from(2), "executionOrderId=\"2\"") + wire(2, from(3, "Out1")) +
        box(3, 40, "ADD", input("In1", from(4)) + input("In2", from(5)), {"Out1"},
            "executionOrderId=\"1\"") +
        in_variable(4, "x") + wire(5, from(6)) + in_variable(6, "y") +
        out_variable(7, 90, "x", from(8), "executionOrderId=\"0\"") + in_variable(8, "5")));
    CHECK(made.messages == "");
    CHECK(
        made.text ==
        "VAR\n    _wire1 : INT;\nEND_VAR\nx := 5;\n_wire1 := x + y;\nz := _wire1;\nEND_PROGRAM\n");
    CHECK(read(free_chart("")).text == "END_PROGRAM\n");
    CHECK(read(free_chart(element("spring", 1, 0, "")))
              .messages.find("<spring> is no element of a network") != std::string::npos);
}

TEST_CASE("a rung of CODESYS goes on behind a box at its ENO, and calls a function once") {
    CHECK(ladder(contact(1, 0, "a", from(0)) + in_variable(2, "x") +
                 box(3, 0, "MOVE", input("EN", from(1)) + input("", from(2)), {"ENO", "Out1"}) +
                 contact(4, 0, "b", from(3)) + coil(5, 0, "c", from(4)) +
                 out_variable(6, 0, "y", from(3, "Out1"))) ==
          "VAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := a;\nIF _wire1 THEN y := x; END_IF\n"
          "c := _wire1 AND b;\nEND_PROGRAM\n");
    const Read made =
        read(program("LD", element("leftPowerRail", 0, 0, "") + contact(1, 0, "a", from(0)) +
                               box(2, 0, "Elsewhere", input("In", from(1)), {"Out1"}) +
                               coil(3, 0, "b", from(2)) + coil(4, 1, "c", from(2))));
    CHECK(made.text.find("_wire1 := Elsewhere(a);\nb := _wire1;\nc := _wire1;\n") !=
          std::string::npos);
}

TEST_CASE("an instruction list is what its results are stored in") {
    const Read made = read(program("IL", R"(LD a (* why *)
AND( b
ORN c
)
ST d
S a
CAL timer(IN := d,
          PT := T#1s)
LD x
ADD 2
MAX y
GT z
JMPC end
LDN a
end: STN b
RETC
)"));
    CHECK(made.messages == "");
    CHECK(made.text == R"(VAR
    _result1 : BOOL;
    _result2 : BOOL;
    _jump3 : INT;
END_VAR
_jump3 := 0;
d := a AND (b OR (NOT c));
_result1 := d;
IF _result1 THEN a := TRUE; END_IF
timer(IN := d, PT := T#1s);
_result2 := MAX(x + 2, y) > z;
IF MAX(x + 2, y) > z THEN _jump3 := 1; END_IF
IF _jump3 = 0 THEN
_result2 := NOT a;
END_IF
IF _jump3 = 1 THEN _jump3 := 0; END_IF
IF _jump3 = 0 THEN
b := NOT _result2;
IF NOT b THEN
RETURN;
END_IF
END_IF
END_PROGRAM
)");
    CHECK(read(program("IL", "LD a\nJMP nowhere\n")).messages ==
          "4:1: there is no label 'nowhere' in this body\n");
    CHECK(read(program("IL", "LD\nST b\n")).messages == "3:1: LD has no operand\n");
}

TEST_CASE("branches that end with a jump join nothing, and an action may have a chart") {
    const std::string chart =
        element("step", 1, 1, "", "name=\"Begin\" initialStep=\"true\"") +
        element("selectionDivergence", 2, 2, in(from(1))) +
        element("transition", 3, 3,
                in(from(2)) + "<condition><inline><ST><p>a</p></ST></inline></condition>") +
        element("step", 4, 4, in(from(3)), "name=\"Work\"") +
        element("transition", 5, 5,
                in(from(2)) + "<condition><inline><ST><p>b</p></ST></inline></condition>") +
        element("jumpStep", 6, 6, in(from(5)), "targetName=\"Begin\"") +
        element("selectionConvergence", 7, 7, in(from(4)) + in(from(6))) +
        element("transition", 8, 8,
                in(from(7)) + "<condition><inline><ST><p>c</p></ST></inline></condition>") +
        element("jumpStep", 9, 9, in(from(8)), "targetName=\"Begin\"");
    const Read made = read(program(
        "ST", "<p>Run();</p>",
        "<actions><action name=\"Run\"><body><SFC>" + chart + "</SFC></body></action></actions>"));
    CHECK(made.messages == "");
    CHECK(made.text == R"(ACTION Run:
INITIAL_STEP Begin:
END_STEP
STEP Work:
END_STEP
TRANSITION FROM Begin TO Work := a;
END_TRANSITION
TRANSITION FROM Begin TO Begin := b;
END_TRANSITION
TRANSITION FROM Work TO Begin := c;
END_TRANSITION
END_ACTION
Run();
END_PROGRAM
)");
}

TEST_CASE("a drawn body that is cut, or lacks an element, is read or told at a place") {
    const std::string body =
        element("leftPowerRail", 0, 0, "") + contact(1, 10, "a", from(0)) + in_variable(2, "T#1s") +
        box(3, 10, "TON", input("IN", from(1)) + input("PT", from(2)), {"Q"},
            "instanceName=\"timer\"") +
        coil(4, 10, "b", from(3, "Q")) + element("jump", 5, 20, in(from(4)), "label=\"L\"") +
        element("label", 6, 30, "", "label=\"L\"");
    const std::string whole = program("LD", body);
    CHECK(read(whole).messages == "");
    for (std::size_t size = 0; size < whole.rfind('>'); ++size)
        CHECK(read(whole.substr(0, size)).messages.find("this file is not XML") !=
              std::string::npos);
    std::size_t refused = 0;
    for (std::size_t begin = whole.find("<LD>"); begin < whole.find("</LD>"); begin += 7) {
        const std::size_t end = whole.find('"', begin + 1);
        std::string text = whole;
        text.erase(begin, end - begin);
        refused += read(text).messages.empty() ? 0U : 1U;
    }
    CHECK(refused > 14);
}

}  // namespace lineshaft::projects
