#include <fstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/program/program.hpp"
#include "runtime/st/library/library.hpp"
#include "tests/folder.hpp"

namespace lineshaft::projects::function_charts {
namespace {

std::string value(const std::string& name, const std::string& text) {
    return "<v n=\"" + name + "\">" + text + "</v>";
}

std::string quoted(const std::string& text) {
    return "\"" + text + "\"";
}

/// Elements and connections; pins have numbers of their own.
class Chart {
  public:
    int input(const std::string& text, int x, int y) {
        const int out = ++pins_;
        add("CFCInputElement", named("Output", pin(out)) + label(text), x, y);
        return out;
    }
    /// What it takes is connected.
    void output(const std::string& text, int from, int x, int y,
                const std::string& storage = "None", bool is_negated = false) {
        const int in = ++pins_;
        add("CFCOutputElement", named("Input", pin(in, is_negated, storage)) + label(text), x, y);
        connect(from, in);
    }
    void element(const std::string& kind, const std::string& text, int from, int x, int y) {
        std::string inside = label(text);
        if (from > 0) {
            const int in = ++pins_;
            inside += named("Input", pin(in));
            connect(from, in);
        }
        add(kind, inside, x, y);
    }
    struct Box {
        std::string type, call = "Operator", instance = {};
        std::vector<std::string> inputs = {}, outputs = {""};
        std::string kind = "CFCBoxElement";
    };
    struct Pins {
        std::vector<int> in, out;
    };
    Pins box(const Box& box, int x, int y) {
        Pins made;
        std::string ins, outs, texts;
        for (const std::string& name : box.inputs) {
            made.in.push_back(++pins_);
            ins += "<o>" + pin(pins_) + "</o>";
            texts += "<o>" + value("Text", quoted(name)) + "</o>";
        }
        for (const std::string& name : box.outputs) {
            made.out.push_back(++pins_);
            outs += "<o>" + pin(pins_) + "</o>";
            if (box.kind == "CFCBoxElement") texts += "<o>" + value("Text", quoted(name)) + "</o>";
        }
        texts += "<o>" + value("Text", quoted(box.type)) + "</o>";
        if (!box.instance.empty()) texts += "<o>" + value("Text", quoted(box.instance)) + "</o>";
        const std::string output = box.kind == "CFCBoxElement"
                                       ? list("Outputs", "CFCOutputPin", outs)
                                       : named("Output", pin(made.out.front()));
        add(box.kind,
            list("Inputs", "CFCInputPin", ins) + output + list("Texts", "CFCText", texts) +
                value("KindOfCall", box.call),
            x, y);
        return made;
    }
    void connect(int from, int to) {
        items_ += "<o t=\"CFCConnection\">" + value("SourcePinId", number(from)) +
                  value("DestPinId", number(to)) + "</o>\n";
    }

    /// A unit with variables a to c (BOOL), x to z (INT), and a timer.
    std::string unit(const std::string& properties = {}) const {
        return "<TcPlcObject><POU Name=\"P\"><Declaration><![CDATA[PROGRAM P\nVAR a, b, c : BOOL; "
               "x, y, z : INT; timer : TON; END_VAR\n]]></Declaration><Implementation><CFC>"
               "<XmlArchive><Data><o t=\"CFCImplementationObject\"><o n=\"Items\"><l2 "
               "n=\"InnerList\">\n" +
               items_ + "</l2></o></o></Data></XmlArchive></CFC></Implementation>" + properties +
               "</POU></TcPlcObject>\n";
    }

  private:
    static std::string number(int pin) { return std::to_string(pin) + "L"; }
    static std::string pin(int id, bool is_negated = false, const std::string& storage = "None") {
        return value("Negated", is_negated ? "true" : "false") + value("SetReset", storage) +
               value("Id", number(id));
    }
    static std::string named(const std::string& name, const std::string& inside) {
        return "<o n=\"" + name + "\">" + inside + "</o>";
    }
    static std::string label(const std::string& text) {
        return named("Text", value("Text", quoted(text)));
    }
    static std::string list(const std::string& name, const std::string& kind,
                            const std::string& inside) {
        return named(name, "<l2 n=\"InnerList\" cet=\"" + kind + "\">" + inside + "</l2>");
    }
    void add(const std::string& kind, const std::string& inside, int x, int y) {
        items_ += "<o t=\"" + kind + "\">" + inside +
                  value("Bounds", quoted(std::to_string(x) + ", " + std::to_string(y) + ", 0, 0")) +
                  "</o>\n";
    }

    std::string items_;
    int pins_ = 0;
};

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
    if (end != std::string::npos) made.text.erase(0, end + 9);
    for (const Diagnostic& diagnostic : out.list()) {
        REQUIRE(diagnostic.mark.line > 0);
        made.messages += diagnostic.whole_message() + "\n";
    }
    return made;
}

std::string text_of(const Chart& chart, const std::string& properties = {}) {
    const Read made = read(chart.unit(properties));
    CHECK(made.messages == "");
    return made.text;
}

const std::string by_data_flow =
    "<ObjectProperties><XmlArchive><Data><o t=\"CFCProperty\"><v "
    "n=\"UseExplicitExecutionOrder\">false</v></o></Data></XmlArchive></ObjectProperties>";

TEST_CASE("elements of a chart are evaluated as they stand in its file") {
    Chart chart;
    const auto timer = chart.box({.type = "TON",
                                  .call = "FunctionBlock",
                                  .instance = "timer",
                                  .inputs = {"IN", "PT"},
                                  .outputs = {"Q", "ET"}},
                                 10, 20);
    chart.connect(chart.input("a", 1, 21), timer.in[0]);
    chart.connect(chart.input("T#1s", 1, 22), timer.in[1]);
    chart.output("b", timer.out[0], 30, 1);
    const auto sum = chart.box({.type = "ADD", .inputs = {"", ""}}, 10, 2);
    chart.connect(chart.input("x", 1, 2), sum.in[0]);
    chart.connect(chart.input("y + 1", 1, 3), sum.in[1]);
    chart.output("z", sum.out[0], 30, 2);
    chart.output("c", timer.out[0], 30, 3, "Set");
    chart.output("a", timer.out[0], 30, 4, "None", true);
    CHECK(text_of(chart) ==
          "timer(IN := a, PT := T#1s);\nb := timer.Q;\nz := x + (y + 1);\n"
          "IF timer.Q THEN\nc := TRUE;\nEND_IF\na := NOT timer.Q;\nEND_PROGRAM\n");
}

TEST_CASE("a chart that orders itself follows its data flow, then positions from top to bottom") {
    Chart chart;
    const auto above = chart.box({.type = "GT", .inputs = {"", ""}}, 20, 10);
    chart.output("a", above.out[0], 30, 10);
    const auto sum = chart.box({.type = "ADD", .inputs = {"", ""}}, 10, 30);
    chart.connect(chart.input("x", 1, 10), above.in[0]);
    chart.connect(sum.out[0], above.in[1]);
    chart.connect(chart.input("y", 1, 30), sum.in[0]);
    chart.connect(chart.input("z", 1, 31), sum.in[1]);
    chart.output("y", chart.input("z", 1, 2), 30, 2);
    CHECK(text_of(chart, by_data_flow) == "y := z;\na := x > (y + z);\nEND_PROGRAM\n");
    CHECK(read(chart.unit()).messages.find("taken before it is evaluated") != std::string::npos);
}

TEST_CASE("what goes back in a chart has the value of the last scan") {
    Chart chart;
    const auto either = chart.box({.type = "OR", .inputs = {"", ""}}, 10, 1);
    const auto above = chart.box({.type = "GT", .inputs = {"", ""}}, 20, 1);
    chart.connect(chart.input("a", 1, 1), either.in[0]);
    chart.connect(above.out[0], either.in[1]);
    chart.connect(chart.input("x", 1, 2), above.in[0]);
    chart.connect(chart.input("y", 1, 3), above.in[1]);
    chart.output("b", either.out[0], 30, 1);
    CHECK(text_of(chart) ==
          "VAR\n    _wire1 : BOOL;\n    _wire2 : BOOL;\nEND_VAR\n_wire2 := a OR _wire1;\n"
          "_wire1 := x > y;\nb := _wire2;\nEND_PROGRAM\n");
}

TEST_CASE("a function of a chart is called once, also where several take its result") {
    Chart chart;
    const auto made = chart.box({.type = "INT_TO_BOOL", .call = "Function", .inputs = {""}}, 10, 1);
    chart.connect(chart.input("x", 1, 1), made.in[0]);
    chart.output("x", chart.input("y", 1, 2), 30, 2);
    chart.output("a", made.out[0], 30, 3);
    chart.output("b", made.out[0], 30, 4);
    CHECK(text_of(chart) ==
          "VAR\n    _wire1 : BOOL;\nEND_VAR\n_wire1 := INT_TO_BOOL(x);\nx := y;\na := _wire1;\n"
          "b := _wire1;\nEND_PROGRAM\n");
}

TEST_CASE("what goes back through operators of bits in a chart is a truth, or of their type") {
    Chart chart;
    const auto no = chart.box({.type = "NOT", .inputs = {""}}, 10, 1);
    const auto both = chart.box({.type = "AND", .inputs = {"", ""}}, 20, 1);
    chart.output("b", no.out[0], 30, 1);
    chart.connect(chart.input("a", 1, 1), both.in[0]);
    chart.connect(no.out[0], both.in[1]);
    chart.connect(both.out[0], no.in[0]);
    CHECK(text_of(chart) ==
          "VAR\n    _wire1 : BOOL;\n    _wire2 : BOOL;\nEND_VAR\n"
          "_wire2 := NOT _wire1;\n_wire1 := a AND _wire2;\nb := _wire2;\n"
          "END_PROGRAM\n");
}

TEST_CASE("a box of a chart calls a METHOD of the instance beside it") {
    Chart chart;
    const auto find = chart.box({.type = "Motor.Find",
                                 .call = "Method",
                                 .instance = "motor",
                                 .inputs = {"EN", "one"},
                                 .outputs = {"ENO", "at", "found"}},
                                10, 1);
    chart.connect(chart.input("a", 1, 1), find.in[0]);
    chart.connect(chart.input("x", 1, 2), find.in[1]);
    chart.output("y", find.out[1], 30, 2);
    chart.output("b", find.out[2], 30, 3);
    const auto sum = chart.box({.type = "Motor.Sum",
                                .call = "Method",
                                .instance = "motor",
                                .inputs = {"one"},
                                .outputs = {"Sum"}},
                               10, 5);
    chart.connect(chart.input("x", 1, 6), sum.in[0]);
    chart.output("z", sum.out[0], 30, 6);
    chart.box({.type = "Motor.Turn", .call = "Action", .instance = "motor", .outputs = {}}, 10, 8);
    CHECK(
        read(chart.unit()).text ==
        "VAR\n    _wire1 : INT;\n    _wire2 : BOOL;\n    _wire3 : INT;\nEND_VAR\nIF a THEN\n"
        "motor.Find(one := x, at => _wire1, found => _wire2);\nEND_IF\ny := _wire1;\n"
        "b := _wire2;\n_wire3 := motor.Sum(one := x);\nz := _wire3;\nmotor.Turn();\nEND_PROGRAM\n");
}

TEST_CASE("jumps, returns and labels of a chart") {
    Chart chart;
    chart.element("CFCReturnElement", "", chart.input("a", 1, 1), 10, 1);
    chart.element("CFCJumpElement", "last", chart.input("b", 1, 2), 10, 2);
    chart.output("x", chart.input("1", 1, 3), 10, 3);
    chart.element("CFCLabelElement", "last", 0, 10, 4);
    chart.output("y", chart.input("2", 1, 5), 10, 5);
    const Read made = read(chart.unit());
    CHECK(made.messages == "");
    CHECK(made.text.find("IF a THEN\nRETURN;\nEND_IF\n") != std::string::npos);
    CHECK(made.text.find("IF b THEN\n_jump1 := 1;\nEND_IF\n") != std::string::npos);
}

TEST_CASE("what of a chart is not read is told at its place") {
    Chart chart;
    chart.element("CFCMacroElement", "m", 0, 4, 5);
    CHECK(read(chart.unit()).messages ==
          "'CFCMacroElement' of a chart is not supported (m at 4, 5)\n");
    Chart open;
    const auto sum = open.box({.type = "ADD", .inputs = {"", ""}}, 10, 2);
    open.connect(open.input("x", 1, 2), sum.in[0]);
    open.output("z", sum.out[0], 30, 2);
    CHECK(read(open.unit()).messages ==
          "nothing leads to an input of this box (box ADD at 10, 2)\n"
          "expected INT, found BOOL (box ADD at 10, 2)\n");
    Chart selector;
    selector.output(
        "x",
        selector
            .box({.type = "Part", .inputs = {}, .outputs = {"n"}, .kind = "CFCSelectorElement"}, 10,
                 2)
            .out[0],
        30, 2);
    CHECK(read(selector.unit()).messages == "");
    Chart nothing;
    std::string xml = nothing.unit();
    xml.replace(xml.find("<XmlArchive>"), xml.find("</CFC>") - xml.find("<XmlArchive>"), "");
    CHECK(read(xml).messages == "this chart is not as TwinCAT keeps one\n");
}

}  // namespace
}  // namespace lineshaft::projects::function_charts
