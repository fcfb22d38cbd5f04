#include <fstream>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/program/program.hpp"
#include "runtime/st/library/library.hpp"
#include "tests/folder.hpp"

namespace lineshaft::projects::flag_nets {
namespace {

/// A network of SimaticML: a contact at `a`, part 9, and a coil at `d` where that leads to one.
struct Net {
    std::string parts = {}, wires = {}, labels = {};
    int count = 100;

    static std::string constant(const std::string& value) {
        return "<Constant><ConstantValue>" + value + "</ConstantValue></Constant>";
    }
    /// The access to a variable, `list[2]` or a number.
    std::string access(const std::string& text) {
        const std::string id = std::to_string(++count);
        const std::size_t index = text.find('[');
        const bool is_number = text.find_first_not_of("0123456789") == text.npos;
        std::string symbol = "<Symbol><Component Name=\"" + text.substr(0, index) + "\"";
        if (index == text.npos)
            symbol += "/></Symbol>";
        else
            symbol += " AccessModifier=\"Array\"><Access Scope=\"LiteralConstant\">" +
                      constant(text.substr(index + 1, text.size() - index - 2)) +
                      "</Access></Component></Symbol>";
        parts += "<Access Scope=\"" + std::string(is_number ? "LiteralConstant" : "LocalVariable") +
                 "\" UId=\"" + id + "\">" + (is_number ? constant(text) : symbol) + "</Access>";
        return "<IdentCon UId=\"" + id + "\"/>";
    }
    static std::string pin(const std::string& part, const std::string& name) {
        return "<NameCon UId=\"" + part + "\" Name=\"" + name + "\"/>";
    }
    void wire(const std::string& from, const std::string& to) {
        wires += "<Wire>" + from + to + "</Wire>";
    }
    /// A connection to a label, which the network has.
    std::string label(const std::string& name) {
        const std::string id = std::to_string(++count), word = "<Label Name=\"" + name + "\"/>";
        parts += "<Access Scope=\"Label\" UId=\"" + id + "\">" + word + "</Access>";
        labels += "<LabelDeclaration UId=\"99\">" + word + "</LabelDeclaration>";
        return "<IdentCon UId=\"" + id + "\"/>";
    }
    /// `end`: a variable, a number, or `power`; behind '>' what the pin leads to, also `>coil`,
    /// behind '@' a label.
    void connect(const std::string& name, const std::string& end) {
        if (end == "power") return wire(pin("8", "out"), pin("9", name));
        if (end[0] == '@') return wire(label(end.substr(1)), pin("9", name));
        if (end[0] != '>') return wire(access(end), pin("9", name));
        if (end != ">coil") return wire(pin("9", name), access(end.substr(1)));
        wire(pin("9", name), pin("10", "in"));
        wire(access("d"), pin("10", "operand"));
        parts += "<Part Name=\"Coil\" UId=\"10\"/>";
    }
};

constexpr auto* other_block =
    "FUNCTION_BLOCK \"DryBox\"\nVAR_INPUT in : Int; END_VAR\nVAR_OUTPUT out : Int; END_VAR\n"
    "BEGIN\n#out := #in;\nEND_FUNCTION_BLOCK\nDATA_BLOCK \"box\" \"DryBox\"\nBEGIN\n"
    "END_DATA_BLOCK\n";

void write_block(const std::filesystem::path& file, const Net& net) {
    std::string members;
    for (const auto& [name, type] : {std::pair{"a", "Bool"},
                                     {"b", "Bool"},
                                     {"c", "Bool"},
                                     {"d", "Bool"},
                                     {"x", "Int"},
                                     {"y", "Int"},
                                     {"z", "Int"},
                                     {"t", "IEC_TIMER"},
                                     {"pt", "Time"},
                                     {"list", "Array[0..9] of Int"},
                                     {"bits", "Array[0..9] of Bool"}})
        members += std::string("<Member Name=\"") + name + "\" Datatype=\"" + type + "\"/>";
    std::ofstream(file, std::ios::binary)
        << "<Document><Engineering version=\"V17\"/><SW.Blocks.FB ID=\"0\"><AttributeList>"
           "<Interface><Sections><Section Name=\"Static\">"
        << members
        << "</Section></Sections></Interface><Name>Block</Name>"
           "<ProgrammingLanguage>LAD</ProgrammingLanguage></AttributeList><ObjectList>"
           "<SW.Blocks.CompileUnit ID=\"1\"><AttributeList><NetworkSource><FlgNet><Labels>"
        << net.labels << "</Labels><Parts>" << net.parts << "</Parts><Wires>" << net.wires
        << "</Wires></FlgNet></NetworkSource></AttributeList></SW.Blocks.CompileUnit>"
           "</ObjectList></SW.Blocks.FB></Document>\n";
}

/// What the network becomes, then what compiling it says.
std::string read(const std::string& part,
                 const std::vector<std::pair<std::string, std::string>>& ends) {
    Net net;
    net.wire("<Powerrail/>", Net::pin("8", "in"));
    net.wire(net.access("a"), Net::pin("8", "operand"));
    net.parts += "<Part Name=\"Contact\" UId=\"8\"/>" + part;
    for (const auto& [name, end] : ends) net.connect(name, end);
    const test::Folder folder;
    write_block(folder / "Block.xml", net);
    std::ofstream(folder / "Other.scl", std::ios::binary) << other_block;
    Diagnostics out;
    Project project = read_project(folder / "Block.xml", {}, out);
    for (auto& source : read_project(folder / "Other.scl", {}, out).sources)
        project.sources.push_back(source);
    if (out.empty()) st::compile(project.sources, standard_blocks(), out);
    std::string made = project.sources.front()->text;
    const std::size_t begin = made.find("BEGIN\n") + 6;
    made = made.substr(begin, made.find("END_FUNCTION_BLOCK") - begin);
    for (const Diagnostic& diagnostic : out.list()) made += diagnostic.whole_message() + "\n";
    return made;
}

std::string part(const std::string& name, const std::string& inside = "") {
    return "<Part Name=\"" + name + "\" UId=\"9\">" + inside + "</Part>";
}

TEST_CASE("contacts that find edges have power at 'pre'") {
    CHECK(read(part("PContact"),
               {{"pre", "power"}, {"operand", "b"}, {"bit", "c"}, {"out", ">coil"}}) ==
          "_wire1 := #b AND NOT #c;\n#c := #b;\n#d := #a AND _wire1;\n");
    CHECK(read(part("NContact"),
               {{"operand", "b"}, {"bit", "c"}, {"pre", "power"}, {"out", ">coil"}}) ==
          "_wire1 := NOT #b AND #c;\n#c := #b;\n#d := #a AND _wire1;\n");
}

TEST_CASE("what stands at a pin that a part does not have is refused") {
    CHECK_THAT(
        read(part("PContact"), {{"in", "power"}, {"operand", "b"}, {"bit", "c"}, {"out", ">coil"}}),
        Catch::EndsWith(
            "the instruction P_Contact has no input 'in' here (network 1, PContact 9)\n"));
    CHECK_THAT(
        read(part("Coil"), {{"in", "power"}, {"operand", "b"}, {"q", ">c"}}),
        Catch::EndsWith("the instruction Coil has no output 'q' here (network 1, Coil 9)\n"));
    CHECK_THAT(read(part("Add"),
                    {{"en", "power"}, {"in1", "x"}, {"in2", "y"}, {"in", "z"}, {"out", ">z"}}),
               Catch::EndsWith("the instruction Add has no input 'in' here (network 1, Add 9)\n"));
}

TEST_CASE("inputs that count by their places do so by their names, in whatever order wires stand") {
    const std::string type = "<TemplateValue Name=\"SrcType\" Type=\"Type\">Int</TemplateValue>";
    CHECK(read(part("Sub", type), {{"in2", "y"}, {"en", "power"}, {"in1", "x"}, {"out", ">z"}}) ==
          "IF #a THEN\n#z := #x - #y;\nEND_IF\n");
    CHECK(read(part("Sel", type), {{"in1", "y"}, {"in0", "x"}, {"g", "b"}, {"out", ">z"}}) ==
          "#z := SEL(#b, #x, #y);\n");
}

TEST_CASE("a jump has a label, and goes to it where power is") {
    CHECK(read(part("Jump"), {{"in", "power"}, {"label", "@M001"}}) ==
          "M001: ;\nIF #a THEN\nGOTO M001;\nEND_IF\n");
    CHECK(read(part("JumpNot"), {{"in", "power"}, {"label", "@END"}}) ==
          "\"END\": ;\nIF NOT #a THEN\nGOTO \"END\";\nEND_IF\n");
}

TEST_CASE("a block ends where power is, with an ENO that the coil says") {
    for (const std::string coil : {"Return", "ReturnTrue"})
        CHECK(read(part(coil), {{"in", "power"}}) == "IF #a THEN\nRETURN;\nEND_IF\n");
    CHECK(read(part("ReturnFalse"), {{"in", "power"}}) ==
          "IF #a THEN\nENO := FALSE;\nRETURN;\nEND_IF\n");
}

TEST_CASE("a timer may stand as a coil") {
    CHECK(read(part("CoilTON"), {{"in", "power"}, {"operand", "t"}, {"value", "pt"}}) ==
          "#t.TON(IN := #a, PT := #pt);\n");
    CHECK(read(part("CoilTOF"), {{"value", "pt"}, {"operand", "t"}, {"in", "power"}}) ==
          "#t.TOF(IN := #a, PT := #pt);\n");
}

TEST_CASE("Move goes by bits, S_Move is an assignment") {
    CHECK(read(part("Move"), {{"en", "power"}, {"in", "x"}, {"out1", ">y"}}) ==
          "IF #a THEN\n#y := MOVE(#x);\nEND_IF\n");
    CHECK(read(part("S_Move"), {{"en", "power"}, {"in", "x"}, {"out", ">y"}}) ==
          "IF #a THEN\n#y := #x;\nEND_IF\n");
}

TEST_CASE("a block whose name ends as that of a part is called as others are") {
    const std::string call =
        "<Call UId=\"9\"><CallInfo Name=\"DryBox\" BlockType=\"FB\"><Instance "
        "Scope=\"GlobalVariable\" UId=\"99\"><Component Name=\"box\"/></Instance>"
        "</CallInfo></Call>";
    CHECK(read(call, {{"en", "power"}, {"in", "x"}, {"out", ">y"}}) ==
          "IF #a THEN\n\"box\"(in := #x, out => #y);\nEND_IF\n");
}

TEST_CASE("blocks are moved, and rows of bits are set and reset") {
    CHECK(read(part("MoveBlockI"),
               {{"en", "power"}, {"in", "list[0]"}, {"count", "3"}, {"out", ">list[5]"}}) ==
          "IF #a THEN\nMOVE_BLK(in := #list[0], count := 3, out => #list[5]);\nEND_IF\n");
    CHECK(read(part("MoveBlockU"),
               {{"en", "power"}, {"in", "list[0]"}, {"count", "3"}, {"out", ">list[5]"}}) ==
          "IF #a THEN\nUMOVE_BLK(in := #list[0], count := 3, out => #list[5]);\nEND_IF\n");
    CHECK(read(part("SET_BF"), {{"en", "power"}, {"S_BIT", "bits[2]"}, {"COUNT", "3"}}) ==
          "IF #a THEN\nFOR _bit1 := 0 TO MIN(3 - 1, UPPER_BOUND(#bits, 1) - (2)) DO\n"
          "#bits[2 + _bit1] := TRUE;\nEND_FOR\nEND_IF\n");
    const std::string reset =
        "IF #a THEN\nFOR _bit1 := 0 TO MIN(#x - 1, UPPER_BOUND(#bits, 1) - (2)) DO\n"
        "#bits[2 + _bit1] := FALSE;\nEND_FOR\nEND_IF\n";
    CHECK(read(part("RESET_BF"), {{"in", "power"}, {"operand", "bits[2]"}, {"count", "x"}}) ==
          reset);
    CHECK(read(part("RBitfield"), {{"en", "power"}, {"operand", "bits[2]"}, {"n", "x"}}) == reset);
    CHECK_THAT(
        read(part("SET_BF"), {{"en", "power"}, {"S_BIT", "b"}, {"COUNT", "3"}}),
        Catch::EndsWith("SET_BF is supported from an element of an ARRAY of BOOL of one "
                        "dimension on, and this is no such element (network 1, SET_BF 9)\n"));
}

}  // namespace
}  // namespace lineshaft::projects::flag_nets
