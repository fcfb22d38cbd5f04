#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/program/program.hpp"
#include "runtime/projects/xml.hpp"
#include "runtime/st/library/library.hpp"
#include "tests/folder.hpp"

namespace lineshaft::projects {
namespace {

std::string write(const test::Folder& folder, const std::string& name, const std::string& bytes) {
    const std::string path = folder / name;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
}

std::string utf16(const std::string& ascii, bool big_endian, bool mark) {
    std::string bytes = mark ? (big_endian ? "\xFE\xFF" : "\xFF\xFE") : "";
    for (const char c : ascii) {
        if (big_endian) bytes += '\0';
        bytes += c;
        if (!big_endian) bytes += '\0';
    }
    return bytes;
}

/// The body is in line 9, from column 28 on.
std::string pou(const std::string& body) {
    return R"(<?xml version="1.0" encoding="utf-8"?>
<TcPlcObject Version="1.1.0.1" ProductVersion="3.1.4024.0">
  <POU Name="Ramp" Id="{1}" SpecialFunc="None">
    <Declaration><![CDATA[FUNCTION_BLOCK Ramp
VAR_INPUT step : INT; END_VAR
VAR_OUTPUT value : INT; END_VAR
]]></Declaration>
    <Implementation>
      <ST><![CDATA[        )" +
           body + R"(]]></ST>
    </Implementation>
    <Folder Name="inner" Id="{2}" />
    <Method Name="Reset" Id="{3}" FolderPath="inner\">
      <Declaration><![CDATA[METHOD Reset
VAR_INPUT first : INT; END_VAR]]></Declaration>
      <Implementation>
        <ST><![CDATA[value := first; // no end of line]]></ST>
      </Implementation>
    </Method>
  </POU>
</TcPlcObject>
)";
}

std::string found(const std::string& path, bool compiled = true) {
    Diagnostics out;
    const Project project = read_project(path, {}, out);
    if (out.empty() && compiled) st::compile(project.sources, standard_blocks(), out);
    return out.render();
}

}  // namespace

TEST_CASE("a POU of TwinCAT is one text, its methods before its body") {
    const test::Folder folder;
    Diagnostics out;
    const Project project =
        read_project(write(folder, "Ramp.TcPOU", pou("value := value + step;")), {}, out);
    CHECK(out.render() == "");
    REQUIRE(project.sources.size() == 1);
    CHECK(project.sources[0]->part == "Ramp");
    CHECK(project.sources[0]->text == R"(FUNCTION_BLOCK Ramp
VAR_INPUT step : INT; END_VAR
VAR_OUTPUT value : INT; END_VAR

METHOD Reset
VAR_INPUT first : INT; END_VAR
value := first; // no end of line
END_METHOD
        value := value + step;
END_FUNCTION_BLOCK
)");
    CHECK(st::compile(project.sources, standard_blocks(), out));
    CHECK(out.render() == "");
}

TEST_CASE("a message stands at the line and column of the XML file, in any encoding") {
    const test::Folder folder;
    const std::string text = pou("value := steps;");
    const std::string tail = R"(:9:37: error[L0904]: 'steps' is not declared
   9 |       <ST><![CDATA[        value := steps;]]></ST>
     |                                     ^~~~~ did you mean 'step'?
)";
    const std::string marked = "\xEF\xBB\xBF" + text;
    for (const std::string& bytes :
         {text, marked, utf16(text, false, true), utf16(text, true, true),
          utf16(text, false, false), utf16(text, true, false)}) {
        const std::string path = write(folder, "Ramp.TcPOU", bytes);
        CHECK(found(path) == path + tail);
    }
}

TEST_CASE("columns count characters, and what was made for an element has its place") {
    const test::Folder folder;
    const std::string path =
        write(folder, "Ramp.TcPOU", pou("(* äöü € *) speed := 1; IF TRUE THEN"));
    const std::string messages = found(path);
    CHECK(messages.find(path + ":9:41: error") == std::string::npos);
    CHECK(messages.find(path + ":3:3: error[L0902]") != std::string::npos);
    CHECK(found(write(folder, "Ramp.TcPOU", pou("(* äöü € *) speed := 1;")))
              .starts_with(path + ":9:40: "));
}

TEST_CASE("properties, actions and interfaces become their words") {
    const test::Folder folder;
    Diagnostics out;
    const Project project = read_project(
        write(folder, "A.TcIO",
              R"(<TcPlcObject><Itf Name="I_A"><Declaration><![CDATA[INTERFACE I_A]]></Declaration>
<Method Name="M"><Declaration><![CDATA[METHOD M : BOOL]]></Declaration></Method>
<Property Name="P"><Declaration><![CDATA[PROPERTY P : INT]]></Declaration>
<Get Name="Get"><Declaration><![CDATA[]]></Declaration></Get><Set Name="Set"/></Property>
</Itf><POU Name="A"><Declaration><![CDATA[{attribute 'PROGRAM'} (* FUNCTION *) PROGRAM A]]></Declaration>
<Implementation><ST><![CDATA[B();]]></ST></Implementation><Action Name="B"><Implementation><ST><![CDATA[;]]></ST></Implementation></Action></POU></TcPlcObject>)"),
        {}, out);
    CHECK(out.render() == "");
    REQUIRE(project.sources.size() == 2);
    CHECK(project.sources[0]->text ==
          "INTERFACE I_A\nMETHOD M : BOOL\nEND_METHOD\nPROPERTY P : "
          "INT\nGET\n\nEND_GET\nSET\nEND_SET\n"
          "END_PROPERTY\nEND_INTERFACE\n");
    CHECK(project.sources[1]->text ==
          "{attribute 'PROGRAM'} (* FUNCTION *) PROGRAM A\nACTION "
          "B:\n;\nEND_ACTION\nB();\nEND_PROGRAM\n");
}

TEST_CASE("a project of TwinCAT has the files that it lists, its tasks and libraries") {
    const test::Folder folder;
    write(folder, "plc/POUs (100 %)/Ramp.TcPOU", pou("value := step;"));
    write(folder, "plc/POUs/Old.TcPOU", pou("value := nothing;"));
    write(folder, "plc/PlcTask.TcTTO",
          R"(<TcPlcObject><Task Name="PlcTask"><CycleTime>2000</CycleTime><Priority>20</Priority>
<PouCall><Name>MAIN</Name></PouCall></Task></TcPlcObject>)");
    const std::string list =
        R"(<Project xmlns="http://schemas.microsoft.com/developer/msbuild/2003">
  <ItemGroup>
    <Compile Include="pous %28100 %%29\RAMP.TcPOU"><SubType>Code</SubType></Compile>
    <Compile Include="PlcTask.TcTTO" />
    <None Include="Plc.tmc" />
    <PlaceholderReference Include="Tc2_MC2" />
  </ItemGroup>
</Project>
)";
    const std::string path = write(folder, "plc/Plc.plcproj", list);
    for (const std::string& named : {path, folder / "plc"}) {
        Diagnostics out;
        const Project project = read_project(named, {}, out);
        CHECK(out.render() == "");
        REQUIRE(project.sources.size() == 1);
        CHECK(project.sources[0]->path == folder / "plc/POUs (100 %)/Ramp.TcPOU");
        REQUIRE(project.tasks.size() == 1);
        CHECK(project.tasks[0].name.text == "PlcTask");
        CHECK(project.tasks[0].every == 2'000'000);
        CHECK(project.tasks[0].priority == 20);
        REQUIRE(project.tasks[0].programs.size() == 1);
        CHECK(project.tasks[0].programs[0].text == "MAIN");
        REQUIRE(project.libraries.size() == 1);
        CHECK(project.libraries[0].text == "Tc2_MC2");
    }
    std::string wrong = list;
    wrong.replace(wrong.find("PlcTask.TcTTO"), 13, "..\\Else.TcPOU");
    write(folder, "Else.TcPOU", pou(";"));
    CHECK(found(write(folder, "plc/Plc.plcproj", wrong)).starts_with(path + ":4:23: error[L0002]"));
    wrong.replace(wrong.find("..\\Else.TcPOU"), 13, "None.TcPOU");
    CHECK(found(write(folder, "plc/Plc.plcproj", wrong)).starts_with(path + ":4:23: error[L0001]"));
}

TEST_CASE("a drawn body is told by the POU's name") {
    const test::Folder folder;
    std::string text = pou(";");
    text.replace(text.find("<ST>"), 4, "<UML>");
    text.replace(text.find("</ST>"), 5, "</UML>");
    const std::string path = write(folder, "Ramp.TcPOU", text);
    CHECK(found(path).starts_with(path +
                                  ":9:7: error[L0903]: the body of 'Ramp' is drawn (UML), "
                                  "and only Structured Text, LD, FBD, SFC and CFC are read\n"));
}

TEST_CASE("a transition is a method that says whether it holds") {
    const test::Folder folder;
    std::string text = pou("IF Done() AND Half() THEN value := 0; END_IF");
    const auto transition = [](const std::string& name, const std::string& body) {
        return "<Transition Name=\"" + name + "\"><Implementation><ST><![CDATA[" + body +
               "]]></ST></Implementation></Transition>";
    };
    text.insert(text.find("    <Method"),
                transition("Done", "value > 10") + transition("Half", "Half := value > 5;"));
    Diagnostics out;
    const Project project = read_project(write(folder, "Ramp.TcPOU", text), {}, out);
    CHECK(out.render() == "");
    REQUIRE(project.sources.size() == 1);
    CHECK(project.sources[0]->text.find("METHOD Done : BOOL\nDone := value > 10\n;\nEND_METHOD\n"
                                        "METHOD Half : BOOL\nHalf := value > 5;\nEND_METHOD\n") !=
          std::string::npos);
    CHECK(st::compile(project.sources, standard_blocks(), out));
    CHECK(out.render() == "");
}

TEST_CASE("XML that is cut, grows or is no XML is refused at a place") {
    const test::Folder folder;
    const std::string whole = pou("value := step;");
    const std::size_t end = whole.rfind('>');
    for (std::size_t size = 0; size < end; ++size) {
        const std::string path = write(folder, "Cut.TcPOU", whole.substr(0, size));
        const std::string messages = found(path, false);
        CHECK(messages.starts_with(path + ":"));
        CHECK(messages.find(": error[L0110]: ") != std::string::npos);
    }
    std::string laughs = "<!DOCTYPE x [<!ENTITY a \"aaaaaaaaaa\">";
    for (char c = 'b'; c < 'k'; ++c)
        laughs += std::string("<!ENTITY ") + c + " \"" + std::string(10, '&') + "\">";
    const std::string path =
        write(folder, "Laugh.TcDUT",
              laughs +
                  "]><TcPlcObject><DUT Name=\"A\"><Declaration>TYPE A : "
                  "INT &lt; &#50; &k; END_TYPE</Declaration></DUT></TcPlcObject>");
    Diagnostics out;
    const Project project = read_project(path, {}, out);
    CHECK(out.render() == "");
    REQUIRE(project.sources.size() == 1);
    CHECK(project.sources[0]->text == "TYPE A : INT < 2 &k; END_TYPE\n");
}

TEST_CASE("XML beyond a limit is refused") {
    const test::Folder folder;
    const std::string path = write(folder, "a.xml", "<a><b c=\"1\" d=\"2\"/></a>");
    const auto refused = [&](const XmlLimits& limits) {
        Diagnostics out;
        CHECK(!XmlFile::read(path, out, {}, limits));
        return out.list().at(0).message;
    };
    CHECK(refused({.bytes = 10}).find("more than 10 bytes") != std::string::npos);
    CHECK(refused({.tags = 2}) == "the file has more than 2 tags");
    CHECK(refused({.attributes = 1}) == "the file has more than 1 attributes");
}

TEST_CASE("nesting without end is read, or refused, without a deep stack") {
    const test::Folder folder;
    std::string text;
    for (int i = 0; i < 300'000; ++i) text += "<a>";
    std::string whole = text;
    for (int i = 0; i < 300'000; ++i) whole += "</a>";
    CHECK(found(write(folder, "a.TcPOU", text), false).find("L0110") != std::string::npos);
    CHECK(found(write(folder, "a.TcPOU", whole), false).find("error[L0111]: <a> is no object") !=
          std::string::npos);
}

}  // namespace lineshaft::projects
