#include <fstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/program/program.hpp"
#include "runtime/st/library/library.hpp"
#include "tests/folder.hpp"

namespace lineshaft::projects::step_charts {
namespace {

const std::string name_id = "38391c6d-6d4a-42f8-8ee7-9f45e5adafa8";
const std::string is_excluded_id = "01580b27-6378-448b-8ecb-0e4b795b58d6";

std::string attribute(const std::string& id, const std::string& text) {
    return "<o><v n=\"AttributeId\">{" + id + "}</v><o n=\"Value\"><v n=\"Value\">\"" + text +
           "\"</v></o></o>";
}

/// An element; `more` are attributes, and `inside` what it has beside them.
std::string element(const std::string& kind, const std::string& name, const std::string& more = {},
                    const std::string& inside = {}) {
    return "<o t=\"" + kind + "\">" + inside + "<l2 n=\"Attributes\">" + attribute(name_id, name) +
           more + "</l2></o>\n";
}

std::string list(const std::string& items) {
    return "<o n=\"ElementList\"><l2 n=\"InnerList\">" + items + "</l2></o>";
}

std::string step(const std::string& name, const std::string& actions = {},
                 const std::string& more = {}) {
    return element("SFCStep", name, more, list(actions));
}

std::string first(const std::string& name) {
    return step(name, {}, attribute("6844a48e-46c2-4cc8-a185-a478f3b99cc0", "TRUE"));
}

std::string action(const std::string& name, const std::string& qualifier,
                   const std::string& more = {}) {
    return element("SFCActionAssociation", name,
                   attribute("e174fc0d-80b0-4a9e-a530-ca239c249a50", qualifier) + more);
}

std::string transition(const std::string& condition) {
    return element("SFCTransition", condition);
}

std::string jump(const std::string& step) {
    return element("SFCJump", step);
}

std::string branch(bool is_parallel, const std::vector<std::string>& stretches) {
    std::string all;
    for (const std::string& one : stretches) all += "<o t=\"SFCSegment\">" + list(one) + "</o>";
    return element(
        "SFCBranch", "",
        attribute("23bdaa98-72ec-41f7-817b-9dede5697086", is_parallel ? "TRUE" : "FALSE"),
        list(all));
}

std::string unit(const std::string& elements, const std::string& behind = {}) {
    return "<TcPlcObject><POU Name=\"P\"><Declaration><![CDATA[PROGRAM P\nVAR a, b, c : BOOL; "
           "END_VAR\n]]></Declaration><Implementation><SFC><XmlArchive><Data><o "
           "t=\"SFCImplementationObject\"><o n=\"Root\" t=\"SFCSegment\">\n" +
           list(elements) + "</o></o></Data></XmlArchive></SFC></Implementation>" + behind +
           "</POU></TcPlcObject>\n";
}

struct Read {
    std::string text, messages;
};

/// SFCInit, SFCPause, SFCTip and SFCTipMode are used.
const std::string flags =
    "<ObjectProperties><XmlArchive><Data><o t=\"SFCProperty\"><d2 n=\"Flags\"><v>Init</v><o><v "
    "n=\"Use\">true</v><v n=\"Declare\">true</v></o><v>Pause</v><o><v n=\"Use\">true</v><v "
    "n=\"Declare\">true</v></o><v>Tip</v><o><v n=\"Use\">true</v><v "
    "n=\"Declare\">true</v></o><v>TipMode</v><o><v n=\"Use\">true</v><v "
    "n=\"Declare\">true</v></o></d2></o></Data></XmlArchive></ObjectProperties>";

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
        REQUIRE(diagnostic.mark.line > 0);
        made.messages += diagnostic.whole_message() + "\n";
    }
    return made;
}

TEST_CASE("elements of a chart of steps lead to those below") {
    const Read made =
        read(unit(first("Begin") + transition("a &lt;&gt; b;") +
                  step("Work", action("c", "L T#1s")) + transition("NOT a") + jump("Begin")));
    CHECK(made.text ==
          "\nINITIAL_STEP Begin:\nEND_STEP\nSTEP Work:\n    c(L, T#1s);\nEND_STEP\n"
          "TRANSITION FROM Begin TO Work := a <> b;\nEND_TRANSITION\n"
          "TRANSITION FROM Work TO Begin := NOT a;\nEND_TRANSITION\nEND_PROGRAM\n");
    CHECK(made.messages == "");
}

TEST_CASE("stretches of an alternative branch go on below it, and jumps do not") {
    const Read made = read(
        unit(first("Begin") +
             branch(false, {transition("a") + step("Left") + transition("b"),
                            branch(false, {transition("b") + jump("Last"), transition("c")})}) +
             step("Last") + transition("TRUE") + jump("Begin")));
    CHECK(made.messages == "");
    CHECK(made.text.substr(made.text.find("TRANSITION")) ==
          "TRANSITION FROM Begin TO Left := a;\nEND_TRANSITION\n"
          "TRANSITION FROM Left TO Last := b;\nEND_TRANSITION\n"
          "TRANSITION FROM Begin TO Last := b;\nEND_TRANSITION\n"
          "TRANSITION FROM Begin TO Last := c;\nEND_TRANSITION\n"
          "TRANSITION FROM Last TO Begin := TRUE;\nEND_TRANSITION\nEND_PROGRAM\n");
}

TEST_CASE("stretches of a parallel branch are entered and left together, steps row by row") {
    const std::string macro =
        element("SFCMacro", "m", {},
                "<o n=\"Segment\" t=\"SFCSegment\">" +
                    list(step("Right") + transition("b") + step("Right2")) + "</o>");
    const Read made =
        read(unit(first("Begin") + transition("a") +
                  branch(true, {step("Left") + transition("c") + step("Left2"), macro}) +
                  transition("TRUE") + jump("Begin")));
    CHECK(made.messages == "");
    CHECK(made.text.find("STEP Left:\nEND_STEP\nSTEP Right:\nEND_STEP\nSTEP Left2:") !=
          std::string::npos);
    CHECK(made.text.find("FROM Begin TO (Left, Right) := a;") != std::string::npos);
    CHECK(made.text.find("FROM (Left2, Right2) TO Begin := TRUE;") != std::string::npos);
}

TEST_CASE("what steps call, named transitions, flags and what is left out of the build") {
    const std::string kept = attribute("a6b08bd8-b696-47e3-9cbf-7408b61c9ff8", "Enter") +
                             attribute("700a583f-b4d4-43e4-8c14-629c7cd3bec8", "Work") +
                             attribute("a2621e18-7de3-4ea6-ae6d-89e9e0b7befd", "Leave") +
                             attribute("6844a48e-46c2-4cc8-a185-a478f3b99cc0", "TRUE");
    const auto routine = [](const std::string& kind, const std::string& name,
                            const std::string& text) {
        return "<" + kind + " Name=\"" + name + "\"><Implementation><ST><![CDATA[" + text +
               "]]></ST></Implementation></" + kind + ">";
    };
    const Read made = read(
        unit(step("Begin", action("a", "N") + action("b", "N", attribute(is_excluded_id, "TRUE")),
                  kept) +
                 transition("Ready") + jump("Begin"),
             routine("Action", "Enter", "SFCInit := FALSE; sfctip := TRUE;") +
                 routine("Action", "Work", ";") + routine("Action", "Leave", ";") +
                 routine("Transition", "Ready", "c") + flags));
    CHECK(made.messages == "");
    CHECK(made.text.find("VAR\n    SFCInit : BOOL;\n    SFCTip : BOOL;\nEND_VAR\n") !=
          std::string::npos);
    CHECK(made.text.find("INITIAL_STEP Begin:\n    a(N);\n    Enter(_ENTRY);\n    Work(_ACTIVE);\n"
                         "    Leave(_EXIT);\nEND_STEP\n"
                         "TRANSITION FROM Begin TO Begin := Ready();\n") != std::string::npos);
}

TEST_CASE("a chart that an action is has its flags in the block") {
    std::string text = unit(first("Begin") + transition("a") + jump("Begin"), flags);
    text.insert(text.find("</POU>"),
                "</Action><Action Name=\"Go\"><Implementation><ST><![CDATA[SFCTip := "
                "TRUE;]]></ST></Implementation></Action>");
    text.insert(text.find("<Implementation>"),
                "<Implementation><ST><![CDATA[Run(); Go();]]></ST></Implementation><Action "
                "Name=\"Run\">");
    const Read made = read(text);
    CHECK(made.messages == "");
    CHECK(made.text.find("VAR\n    SFCTip : BOOL;\nEND_VAR\n") != std::string::npos);
}

TEST_CASE("what of a chart of steps is not read is told at its place") {
    CHECK(read(unit(first("Begin") + transition("a"))).messages ==
          "no step stands behind this transition (transition a)\n");
    CHECK(read(unit(first("Begin") + transition("a") + transition("b") + jump("Begin"))).messages ==
          "no step stands before this transition (transition b)\n");
    CHECK(read(unit(first("Begin") + transition("") + jump("Begin"))).messages ==
          "this transition has no condition (transition)\n");
    CHECK(read(unit(element("SFCStep", "Begin",
                            attribute("6844a48e-46c2-4cc8-a185-a478f3b99cc0", "TRUE"),
                            "<o n=\"EmbeddedMainAction\"></o>") +
                    transition("a") + jump("Begin")))
              .messages == "an action that is kept in its step is not read (step Begin)\n");
    CHECK(read(unit(first("Begin") + branch(true, {step("Left") + transition("a"), step("Right")}) +
                    transition("b") + jump("Begin")))
              .messages.starts_with("a stretch of this branch ends with a transition (branch)\n"));
    CHECK(read(unit(element("SFCNote", "n")))
              .messages.starts_with("'SFCNote' of a chart is not supported (SFCNote n)\n"));
    std::string nothing = unit("");
    nothing.replace(nothing.find("<XmlArchive>"),
                    nothing.find("</SFC>") - nothing.find("<XmlArchive>"), "");
    CHECK(read(nothing).messages == "this chart is not as TwinCAT keeps one\n");
}

}  // namespace
}  // namespace lineshaft::projects::step_charts
