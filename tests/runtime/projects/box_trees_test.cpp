#include <fstream>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/program/program.hpp"
#include "runtime/st/library/library.hpp"
#include "tests/folder.hpp"

namespace lineshaft::projects::box_trees {
namespace {

enum : unsigned { negated = 1, set = 2, jump = 4, return_ = 8, rising = 16 };

std::string value(const std::string& name, const std::string& text) {
    return "<v n=\"" + name + "\">" + text + "</v>";
}

std::string operand(const std::string& text, unsigned flags = 0, const std::string& type = "BOOL") {
    return "<o n=\"Operand\" t=\"Operand\">" + value("Operand", "\"" + text + "\"") +
           value("Type", "\"" + type + "\"") + "<o n=\"Flags\" t=\"Flags\">" +
           value("Flags", std::to_string(flags)) + "</o></o>";
}

std::string leaf(const std::string& text, unsigned flags = 0, const std::string& type = "BOOL") {
    return "<o t=\"BoxTreeOperand\">" + operand(text, flags, type) + "</o>\n";
}

/// A tree as a member of another.
std::string as(const std::string& name, std::string tree) {
    return tree.empty() ? "<n n=\"" + name + "\" />" : tree.insert(2, " n=\"" + name + "\"");
}

std::string assign(const std::string& tree, const std::vector<std::string>& targets) {
    std::string all;
    for (const std::string& target : targets) all += target;
    return "<o t=\"BoxTreeAssign\"><o n=\"OutputItems\" t=\"OutputItemList\"><l2 "
           "n=\"OutputItems\" cet=\"Operand\">" +
           all + "</l2></o>" + as("RValue", tree) + "</o>\n";
}

std::string wire(int number, const std::string& tree = "") {
    return "<o t=\"BoxTreeDemux\">" + value("VarId", std::to_string(number)) + as("Input", tree) +
           "</o>";
}

struct Box {
    std::string type, call = "Function", instance = {};
    std::vector<std::string> inputs, names = {}, outputs = {""}, takers = {"<n />"};
    bool has_en = false, has_eno = false;
    std::string more = {};
};

std::string box(const Box& box) {
    const auto all = [](const std::vector<std::string>& texts, const std::string& before,
                        const std::string& after) {
        std::string made;
        for (const std::string& text : texts) made += before + text + after;
        return made;
    };
    const std::string instance =
        box.instance.empty() ? "<n n=\"Operand\" />" : value("Operand", "\"" + box.instance + "\"");
    return "<o t=\"BoxTreeBox\">" + value("BoxType", "\"" + box.type + "\"") +
           "<o n=\"Instance\" t=\"Operand\">" + instance +
           "</o><o n=\"OutputItems\" t=\"OutputItemList\"><l2 n=\"OutputItems\">" +
           all(box.takers, "", "") + "</l2></o><l2 n=\"InputItems\">" + all(box.inputs, "", "") +
           "</l2><o n=\"InputParam\"><l2 n=\"Names\">" + all(box.names, "<v>", "</v>") +
           "</l2></o><o n=\"OutputParam\"><l2 n=\"Names\">" + all(box.outputs, "<v>", "</v>") +
           "</l2></o>" + value("CallType", box.call) + value("EN", box.has_en ? "true" : "false") +
           value("ENO", box.has_eno ? "true" : "false") + box.more + "</o>\n";
}

std::string network(const std::string& trees, const std::string& label = "",
                    const std::string& more = "") {
    return "<o>" + value("Label", "\"" + label + "\"") + more + "<l2 n=\"NetworkItems\">\n" +
           trees + "</l2></o>\n";
}

/// A unit with variables a to d (BOOL), x to z (INT), and a timer where it keeps something.
std::string unit(const std::string& networks, const std::string& kind = "PROGRAM") {
    const bool keeps = kind == "PROGRAM";
    return "<TcPlcObject><POU Name=\"P\"><Declaration><![CDATA[" + kind + " P" +
           (keeps ? "" : " : BOOL") + "\nVAR a, b, c, d : BOOL; x, y, z : INT; " +
           (keeps ? "timer : TON; " : "") +
           "END_VAR\n]]></Declaration><Implementation><NWL><XmlArchive><Data>"
           "<o t=\"NWLImplementationObject\"><l2 n=\"NetworkList\" cet=\"Network\">\n" +
           networks + "</l2></o></Data></XmlArchive></NWL></Implementation></POU></TcPlcObject>\n";
}

struct Read {
    std::string text, messages;
};

/// The text behind the unit's own variables, and what compiling it says.
Read read(const std::string& xml) {
    const test::Folder folder;
    const std::string path = folder / "P.TcPOU";
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
        made.messages +=
            std::to_string(diagnostic.mark.line) + ": " + diagnostic.whole_message() + "\n";
    }
    return made;
}

/// With a FUNCTION_BLOCK Motor in a file of its own, of which the unit has an instance.
std::string text_with_motor(const std::string& networks) {
    const test::Folder folder;
    std::string xml = unit(networks);
    xml.replace(xml.find("timer"), 5, "motor : Motor; timer");
    std::ofstream(folder / "P.TcPOU", std::ios::binary) << xml;
    std::ofstream(folder / "Motor.st") << "FUNCTION_BLOCK Motor VAR n : INT; END_VAR\n"
                                          "METHOD Sum : INT VAR_INPUT one : INT; END_VAR\n"
                                          "VAR_OUTPUT isLarge : BOOL; END_VAR\nSum := one;\n"
                                          "END_METHOD\nMETHOD Find VAR_OUTPUT at : INT; END_VAR\n"
                                          "at := n; END_METHOD\nACTION Turn: n := 5; END_ACTION\n"
                                          "END_FUNCTION_BLOCK\n";
    Diagnostics out;
    std::vector<std::shared_ptr<const SourceFile>> sources;
    std::string text;
    for (const char* name : {"P.TcPOU", "Motor.st"}) {
        const Project project = read_project(folder / name, {}, out);
        sources.insert(sources.end(), project.sources.begin(), project.sources.end());
        if (text.empty()) text = sources.front()->text;
    }
    st::compile(sources, standard_blocks(), out);
    CHECK(out.empty());
    for (const Diagnostic& diagnostic : out.list()) UNSCOPED_INFO(diagnostic.whole_message());
    return text.substr(text.find("END_VAR\n") + 8);
}

std::string text_of(const std::string& networks) {
    const Read made = read(unit(networks));
    CHECK(made.messages == "");
    return made.text;
}

std::string messages_of(const std::string& networks, const std::string& kind = "PROGRAM") {
    return read(unit(networks, kind)).messages;
}

TEST_CASE("trees of TwinCAT's networks are expressions, assignments and calls") {
    CHECK(text_of(network(assign(
              box({.type = "AND", .inputs = {leaf("a"), leaf("b", negated), leaf("c", rising)}}),
              {operand("d")}))) ==
          "\nVAR\n    _edge1 : R_TRIG;\nEND_VAR\n"
          "_edge1(CLK := c);\nd := a AND NOT b AND _edge1.Q;\nEND_PROGRAM\n");
    CHECK(text_of(
              network(assign(leaf("a"), {operand("b"), operand("c", negated), operand("d", set)}) +
                      assign(leaf("a"), {operand("d", set | negated)}))) ==
          "\nVAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := a;\nb := _wire1;\nc := NOT _wire1;\n"
          "IF _wire1 THEN\nd := TRUE;\nEND_IF\nIF a THEN\nd := FALSE;\nEND_IF\nEND_PROGRAM\n");
    CHECK(text_of(network(box({.type = "TON",
                               .call = "FunctionBlock",
                               .instance = "timer",
                               .inputs = {leaf("a"), leaf("T#1s", 0, "TIME")},
                               .names = {"IN", "PT"},
                               .outputs = {"Q", "ET"},
                               .takers = {operand("b"), "<n />"}}))) ==
          "\ntimer(IN := a, PT := T#1s);\nb := timer.Q;\nEND_PROGRAM\n");
    CHECK(text_of(network(box({.type = "TON",
                               .call = "FunctionBlock",
                               .instance = "timer",
                               .inputs = {leaf("a")},
                               .names = {"IN"},
                               .outputs = {"Q"},
                               .takers = {"<n />", operand("\?\?\?")}}))) ==
          "\ntimer(IN := a);\nEND_PROGRAM\n");
    CHECK(text_of(network(box(
              {.type = "LIMIT",
               .inputs = {leaf("x", 0, "INT"), leaf("y", 0, "INT"), leaf("9", 0, "INT")},
               .takers = {operand("z", 0, "INT")}}))) == "\nz := LIMIT(x, y, 9);\nEND_PROGRAM\n");
}

TEST_CASE("a box of TwinCAT's networks may be named by the sign of its operator") {
    const auto made = [](const std::string& type, const std::string& call) {
        return text_of(network(
            assign(box({.type = type,
                        .call = call,
                        .inputs = {leaf("1", 0, "INT"), leaf("x", 0, "INT"), leaf("y", 0, "INT")}}),
                   {operand("z", 0, "INT")})));
    };
    CHECK(made("+", "Add") == "\nz := 1 + x + y;\nEND_PROGRAM\n");
    CHECK(made("-", "Minus") == "\nz := 1 - x - y;\nEND_PROGRAM\n");
    CHECK(text_of(network(assign(box({.type = "&lt;&gt;",
                                      .call = "Ne",
                                      .inputs = {leaf("x", 0, "INT"), leaf("y", 0, "INT")}}),
                                 {operand("a")}))) == "\na := x <> y;\nEND_PROGRAM\n");
}

TEST_CASE("a box of TwinCAT's networks calls a METHOD or an ACTION of the instance beside it") {
    const std::string enabled = leaf("a");
    const std::string sum = box({.type = "Motor.Sum",
                                 .call = "Method",
                                 .instance = "motor",
                                 .inputs = {enabled, leaf("x", 0, "INT")},
                                 .names = {"EN", "one"},
                                 .outputs = {"ENO", "Sum", "isLarge"},
                                 .takers = {operand(""), operand("z", 0, "INT"), operand("c")},
                                 .has_en = true,
                                 .has_eno = true});
    CHECK(text_with_motor(network(sum)) ==
          "\nVAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := a;\nIF _wire1 THEN\n"
          "z := motor.Sum(one := x, isLarge => c);\nEND_IF\nEND_PROGRAM\n");
    const auto call = [&](const std::string& type, const std::string& kind,
                          const std::vector<std::string>& outputs,
                          const std::vector<std::string>& takers) {
        return box({.type = type,
                    .call = kind,
                    .instance = "motor",
                    .inputs = {enabled},
                    .names = {"EN"},
                    .outputs = outputs,
                    .takers = takers,
                    .has_en = true,
                    .has_eno = true});
    };
    CHECK(text_with_motor(network(call("Motor.Turn", "Action", {"ENO"}, {operand("")}))) ==
          "\nVAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := a;\nIF _wire1 THEN\nmotor.Turn();\n"
          "END_IF\nEND_PROGRAM\n");
    CHECK(text_with_motor(network(call("Motor.Find", "Method", {"ENO", "at"},
                                       {operand(""), operand("y", 0, "INT")}))) ==
          "\nVAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := a;\nIF _wire1 THEN\n"
          "motor.Find(at => y);\nEND_IF\nEND_PROGRAM\n");
    CHECK(text_with_motor(network(call("Motor.Sum", "Method", {"ENO", "Sum", "isLarge"},
                                       {operand(""), operand(""), operand("")}))) ==
          "\nVAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := a;\nIF _wire1 THEN\n"
          "motor.Sum();\nEND_IF\nEND_PROGRAM\n");
}

TEST_CASE("a wire of TwinCAT's networks has its value from where it is defined") {
    CHECK(text_of(network(wire(7, leaf("a")) + assign(wire(7), {operand("a", set | negated)}) +
                          assign(wire(7), {operand("b")}))) ==
          "\nVAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := a;\n"
          "IF _wire1 THEN\na := FALSE;\nEND_IF\nb := _wire1;\nEND_PROGRAM\n");
}

TEST_CASE("a box with EN in TwinCAT's networks does nothing while it is FALSE") {
    const std::string sum = box({.type = "ADD",
                                 .inputs = {leaf("a"), leaf("x", 0, "INT"), leaf("1", 0, "INT")},
                                 .names = {"EN"},
                                 .outputs = {"ENO", ""},
                                 .takers = {"<n />", operand("y", 0, "INT")},
                                 .has_en = true,
                                 .has_eno = true});
    CHECK(text_of(network(assign(sum, {operand("b")}))) ==
          "\nVAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := a;\nIF _wire1 THEN\ny := x + 1;\nEND_IF\n"
          "b := _wire1;\nEND_PROGRAM\n");
    CHECK(
        text_of(network(assign(box({.type = "GE",
                                    .inputs = {leaf("a"), leaf("x", 0, "INT"), leaf("1", 0, "INT")},
                                    .names = {"EN"},
                                    .has_en = true}),
                               {operand("b")}))) == "\nb := a AND (x >= 1);\nEND_PROGRAM\n");
}

TEST_CASE("a box of TwinCAT's networks may have Structured Text in it") {
    const std::string more =
        value("ProvidesSTSnippet", "true") +
        "<o n=\"STSnippet\" t=\"STSnippet\"><o n=\"STSnippet\"><o n=\"TextDocument\">" +
        value("TextBlobForSerialisation", "\"IF x &gt; 1 THEN\n    y := 2;\nEND_IF\"") +
        "</o></o></o>";
    CHECK(text_of(network(box({.type = "EXECUTE",
                               .call = "None",
                               .inputs = {leaf("a")},
                               .names = {"EN"},
                               .outputs = {"ENO"},
                               .has_en = true,
                               .more = more}))) ==
          "\nIF a THEN\nIF x > 1 THEN\n    y := 2;\nEND_IF\nEND_IF\nEND_PROGRAM\n");
}

TEST_CASE("jumps, returns and networks that are left out in TwinCAT's networks") {
    CHECK(text_of(network(assign(leaf("a"), {operand("end", jump)})) +
                  network(assign(leaf("b"), {operand("c")})) +
                  network(assign(leaf("b"), {operand("d")}), "end") +
                  network(assign(leaf("no"), {operand("d")}), "why not",
                          value("OutCommented", "true")) +
                  network(assign(leaf("b"), {operand("", return_)}))) ==
          "\nVAR\n    _jump1 : INT;\nEND_VAR\n_jump1 := 0;\nIF a THEN\n_jump1 := 1;\nEND_IF\n"
          "IF _jump1 = 0 THEN\nc := b;\nEND_IF\nIF _jump1 = 1 THEN _jump1 := 0; END_IF\n"
          "IF _jump1 = 0 THEN\nd := b;\nIF b THEN\nRETURN;\nEND_IF\nEND_IF\nEND_PROGRAM\n");
}

TEST_CASE("a box in one of several branches is called with what leads to all of them") {
    const std::string timer = box({.type = "TON",
                                   .call = "FunctionBlock",
                                   .instance = "timer",
                                   .inputs = {leaf("a")},
                                   .names = {"IN"},
                                   .outputs = {"Q"}});
    const auto branches = [&](const std::string& mode) {
        return "<o t=\"BoxTreeParallel\">" + as("Input", leaf("c")) + "<l2 n=\"Trees\">" +
               leaf("b") + timer + "</l2>" + value("Mode", mode) + "</o>";
    };
    CHECK(text_of(network(assign(branches("Sequential"), {operand("d")}))) ==
          "\nVAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := c;\ntimer(IN := _wire1 AND a);\n"
          "d := (_wire1 AND b) OR timer.Q;\nEND_PROGRAM\n");
    CHECK(text_of(network(assign(branches("BoxShortCircuit"), {operand("d")}))) ==
          "\nVAR\n    _wire1 : BOOL;\n    _wire2 : BOOL;\nEND_VAR\n_wire1 := c AND NOT b;\n"
          "_wire2 := FALSE;\nIF _wire1 THEN\ntimer(IN := a);\n_wire2 := timer.Q;\nEND_IF\n"
          "d := (c AND b) OR _wire2;\nEND_PROGRAM\n");
}

TEST_CASE("what TwinCAT's networks cannot say is told at its place") {
    CHECK(messages_of(network(assign(leaf("??\?"), {operand("b")}))) ==
          "5: an operand is missing here (network 1, ??\?)\n");
    CHECK(messages_of(network("") + network(assign(leaf("missing"), {operand("b")}))) ==
          "7: 'missing' is not declared (network 2, missing)\n");
    CHECK(messages_of(network(assign(wire(3), {operand("b")}))) ==
          "5: the wire 3 leads here, and nothing leads to it (network 1, a line)\n");
    CHECK(messages_of(network("", "", value("ILActive", "true"))) ==
          "4: an instruction list of TwinCAT is not supported (network 1, a list)\n");
    CHECK(messages_of(network(assign("<o t=\"BoxTreeMux\"></o>", {operand("b")}))) ==
          "5: 'BoxTreeMux' of a network is not supported (network 1, a line)\n");
    CHECK(messages_of(network(assign(leaf("a"), {operand("gone", jump)}))) ==
          "5: there is no label 'gone' in this body (network 1, gone)\n");
    CHECK(messages_of(network(
              assign(box({.type = "OR", .inputs = {leaf("a"), leaf("")}}), {operand("b")}))) ==
          "5: nothing leads to an input of this box (network 1, box OR)\n");
    CHECK(messages_of(network(assign(leaf("a", rising), {operand("b")})), "FUNCTION") ==
          "5: an edge needs a variable that is kept from scan to scan (network 1, a)\n");
}

TEST_CASE("a network of TwinCAT that is cut or too deep is read or told, and not crashed on") {
    std::string deep = leaf("a");
    for (int i = 0; i < 2000; ++i) deep = box({.type = "NOT", .inputs = {deep}});
    CHECK(messages_of(network(assign(deep, {operand("b")}))).find("more than 400 elements") !=
          std::string::npos);
    std::string wires = wire(0, box({.type = "Any", .inputs = {leaf("x", 0, "")}}));
    for (int i = 1; i < 40; ++i)
        wires += wire(i, box({.type = "Any", .inputs = {wire(i - 1), wire(i - 1)}}));
    CHECK(messages_of(network(wires)).find("longer than 65536 characters") != std::string::npos);
    const std::string whole = unit(network(
        wire(1, leaf("a")) +
        assign(box({.type = "AND", .inputs = {wire(1), leaf("b", negated)}}), {operand("c")})));
    const std::vector<std::string> parts = {"<o ", "<v ", "<l2 ", "n=\"", "t=\""};
    for (const std::string& part : parts)
        for (std::size_t at = whole.find(part); at != std::string::npos;
             at = whole.find(part, at + 1)) {
            std::string cut = whole;
            cut.replace(at, part.size(), part == "n=\"" || part == "t=\"" ? "m=\"" : part);
            read(cut);
            read(whole.substr(0, at) + "</o>");
        }
}

}  // namespace
}  // namespace lineshaft::projects::box_trees
