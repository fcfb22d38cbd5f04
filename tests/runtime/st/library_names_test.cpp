#include "runtime/st/library/library_names.hpp"

#include <algorithm>
#include <set>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/st/library/library.hpp"
#include "runtime/st/syntax/parser.hpp"

using namespace lineshaft;

namespace {

std::shared_ptr<const SourceFile> file(const std::string& path, const std::string& text) {
    return std::make_shared<const SourceFile>(SourceFile{path, text});
}

/// What the parser finds declared in a file of a library, for others.
std::vector<std::string> parsed_names(const LibraryFile& library) {
    Diagnostics out;
    st::Tree tree;
    st::parse(st::read_tokens(file(std::string(library.path), std::string(library.text)), out,
                              st::SourceKind::library),
              tree, out);
    INFO(out.render());
    CHECK(out.empty());
    std::vector<std::string> names;
    for (const st::TypeDeclaration& type : tree.types) {
        names.emplace_back(type.name.text);
        for (const st::Argument& value : type.type->values) names.emplace_back(value.name.text);
    }
    for (const st::Pou* unit : tree.units)
        if (unit->kind != st::PouKind::function ||
            !std::islower(static_cast<unsigned char>(unit->name.text.front())))
            names.emplace_back(unit->name.text.substr(unit->name.text.rfind('.') + 1));
    for (const st::DeclarationBlock& block : tree.globals)
        for (const st::Declaration* variable : block.declarations)
            names.emplace_back(variable->name.text);
    for (const auto& [source, scopes] : tree.scopes)
        for (const st::Scope& scope : scopes)  // or in it, as SysFile.SysTypes
            CHECK((std::string(scope.path) + ".").starts_with(std::string(library.library) + "."));
    std::ranges::sort(names);
    return names;
}

/// The kinds that sources bring along, or what is wrong.
std::string compiled(std::vector<std::shared_ptr<const SourceFile>> sources) {
    Diagnostics out;
    const auto library = st::compile(sources, standard_blocks(), out);
    std::string all;
    if (library)
        for (const BlockType& kind : library->kinds()) all += std::string(kind.name) + ' ';
    return out.render() + all;
}

}  // namespace

TEST_CASE("libraries declare for others what their lines say", "[st][libraries]") {
    for (const LibraryFile& library : standard_blocks().libraries()) {
        INFO(library.path);
        auto names = st::declared_in(library);
        std::ranges::sort(names);
        const auto parsed = parsed_names(library);
        CHECK(std::ranges::equal(names, parsed));
    }
}

namespace {

/// A constant that is a structure has memory as variables have.
bool has_global_memory(std::string_view text) {
    if (text.find("\nVAR_GLOBAL\n") != text.npos) return true;
    for (std::size_t at = 0; (at = text.find("\nVAR_GLOBAL CONSTANT\n", at)) != text.npos; ++at) {
        const std::string_view list = text.substr(at, text.find("END_VAR", at) - at);
        if (list.find(":= (") != list.npos) return true;
    }
    return false;
}

}  // namespace

TEST_CASE("each library compiles, and has no kind but of its variables and numbered addresses",
          "[st][libraries]") {
    for (const LibraryFile& library : standard_blocks().libraries()) {
        INFO(library.path);
        const std::string kinds =
            compiled({file("use.st", "USING " + std::string(library.library) + ";\n")});
        const bool has_variables =
            std::ranges::any_of(standard_blocks().libraries(), [&](const LibraryFile& file) {
                return file.library == library.library && has_global_memory(file.text);
            });
        const bool numbers_addresses = kinds.ends_with("statics ");
        CHECK(kinds ==
              std::string(has_variables ? "globals " : "") + (numbers_addresses ? "statics " : ""));
    }
}

TEST_CASE("a name of a library brings along all that its file needs", "[st][libraries]") {
    for (const LibraryFile& library : standard_blocks().libraries()) {
        const auto names = st::declared_in(library);  // each takes the same files
        if (names.empty()) continue;
        const std::string name = std::string(library.library) + "." + std::string(names.front());
        INFO(library.path);
        const std::string said =
            compiled({file("a.st", "PROGRAM p VAR v : " + name + "; END_VAR END_PROGRAM\n")});
        CHECK(said.find("blocks/libraries") == std::string::npos);
    }
}

TEST_CASE("a program takes of libraries what nobody else has", "[st][libraries]") {
    const std::string use = "PROGRAM p VAR b : BLINK; END_VAR b(ENABLE := TRUE); END_PROGRAM\n";
    CHECK(compiled({file("a.st", use)}) == "p ");
    const std::string own = "FUNCTION_BLOCK Blink VAR_INPUT x : INT; END_VAR END_FUNCTION_BLOCK\n";
    CHECK(compiled({file("a.st", own + "PROGRAM p VAR b : BLINK; c : Util.BLINK; END_VAR\n"
                                       "b(x := 1); c(ENABLE := TRUE); END_PROGRAM\n")}) ==
          "Blink p ");
    CHECK(compiled({file("a.st", use), file("b.st", own)}).find("has no argument 'ENABLE'") !=
          std::string::npos);
    CHECK(compiled({file("a.scl", use)}).find("'BLINK' is not a type") != std::string::npos);
    CHECK(compiled({file("a.st", "PROGRAM p VAR t : LREAL; END_VAR t := PI; END_PROGRAM\n")}) ==
          "p ");
}

namespace {

/// The libraries whose files a source takes along.
std::string taken_for(const std::string& text) {
    Diagnostics out;
    st::Tree tree;
    st::Tokens tokens = st::read_tokens(file("a.st", text), out);
    st::LibraryNames names(standard_blocks(), {});
    names.note_libraries(tokens);
    st::parse(std::move(tokens), tree, out);
    names.add_files(tree, out);
    CHECK(out.empty());
    std::set<std::string> libraries;
    for (const auto& [source, scopes] : tree.scopes)
        for (const st::Scope& scope : scopes)
            if (!scope.path.empty()) libraries.emplace(scope.path);
    return fmt::format("{}", fmt::join(libraries, " "));
}

}  // namespace

TEST_CASE("what a library's own variables are called takes no other one along", "[st][libraries]") {
    const std::pair<const char*, const char*> all[] = {
        {"Util", "Util __SYSTEM"},                           // RESET
        {"Tc2_ControllerToolbox", "Tc2_ControllerToolbox"},  // bError
        {"Siemens.Step7", "Siemens.Step7"},                  // status
        {"Tc2_Utilities", "Tc2_System Tc2_Utilities"},       // integral
        {"McAxis", "McAxis McBase"},                         // Axis
        {"MpAxis", "McAxis McBase MpAxis MpBase"}};          // Info, which it has of others
    for (const auto& [library, taken] : all)
        CHECK(taken_for(fmt::format("USING {};\nPROGRAM p ; END_PROGRAM\n", library)) == taken);
}

TEST_CASE("a library whose namespace the sources declare is theirs", "[st][libraries]") {
    CHECK(compiled({file("a.st",
                         "NAMESPACE Util\nTYPE T : INT; END_TYPE\nEND_NAMESPACE\n"
                         "PROGRAM p VAR a : Util.T; b : Util.BLINK; END_VAR\n"
                         "a := 1; b(); END_PROGRAM\n")})
              .find("the namespace 'Util' has no 'BLINK'") != std::string::npos);
}

TEST_CASE("what the catalogue has is a library's once that is taken", "[st][libraries]") {
    const std::string declare = "PROGRAM p VAR axis : AXIS_REF; m : MC_MoveAbsolute; b : BOOL;\n";
    const std::string call = "END_VAR m(Axis := axis, Execute := b, Options := o); END_PROGRAM\n";
    CHECK(compiled({file("a.st", declare +
                                     "END_VAR m(Axis := axis, ContinuousUpdate := b, Other := b);\n"
                                     "END_PROGRAM\n")})
              .find("MC_MOVEABSOLUTE has no argument 'Other'") != std::string::npos);
    CHECK(compiled({file("a.st", declare + "o : BOOL; " + call)})
              .find("expected Tc2_MC2.ST_MoveOptions, found BOOL") != std::string::npos);
    CHECK(compiled({file("a.st", declare + "o : ST_MoveOptions; " + call)}) == "p ");
    CHECK(compiled({file("a.TcPOU", declare + "o : BOOL; " + call)})
              .find("expected Tc2_MC2.ST_MoveOptions, found BOOL") != std::string::npos);
    const SourceFile said{
        .path = "a.st", .text = declare + "o : BOOL; " + call, .read_as = ".tcpou"};
    CHECK(compiled({std::make_shared<const SourceFile>(said)})
              .find("expected Tc2_MC2.ST_MoveOptions, found BOOL") != std::string::npos);
}

TEST_CASE("a file of TwinCAT's takes nothing of SoftMotion for a name", "[st][libraries]") {
    const std::string text =
        "PROGRAM p VAR group : AXES_GROUP_REF; enable : MC_GroupEnable; "
        "other : MC_SetCoordinateTransform; END_VAR\n"
        "enable(AxesGroup := group, Execute := TRUE); END_PROGRAM\n";
    const std::string in_twincat = compiled({file("a.TcPOU", text)});
    CHECK(in_twincat.find("'MC_SetCoordinateTransform' is not a type") != std::string::npos);
    CHECK(in_twincat.find("AxesGroup") == std::string::npos);
    CHECK(compiled({file("a.EXP", text)}).find("called without 'AxisGroup'") != std::string::npos);
}

TEST_CASE("names that nobody has may be of libraries that are not here", "[st][libraries]") {
    const auto project = file("a.plcproj", "one\ntwo\n");
    const auto source = file("a.st",
                             "PROGRAM p VAR a : FB_JsonReadWriteDataType; b : INT; END_VAR\n"
                             "a.ResetDocument(); b := F_Foreign(b); b := TRUE;\n"
                             "END_PROGRAM\n");
    Diagnostics out;
    st::Options options;
    options.references = {{"Tc2_Standard", {project, 1, 1}},
                          {"system_visuinputs", {project, 1, 1}},
                          {"Tc3_JsonXml", {project, 2, 1}}};
    CHECK_FALSE(st::compile({source}, standard_blocks(), out, options));
    const std::string told = out.render();
    CHECK(told.find("a.plcproj:2:1: error[L0927]: 2 names that nobody declares may be of libraries "
                    "that are not here: Tc3_JsonXml") != std::string::npos);
    CHECK(told.find("`sources:` takes several projects; FB_JsonReadWriteDataType (a.st:1), "
                    "F_Foreign (a.st:2)") != std::string::npos);
    CHECK(told.find("a.st:2:44: error[L0905]") != std::string::npos);
    CHECK(out.count() == 2);
    Diagnostics apart;
    options.references = {{"Tc2_Standard", {project, 1, 1}}, {"Tc3_Module", {project, 2, 1}}};
    CHECK_FALSE(st::compile({source}, standard_blocks(), apart, options));
    CHECK(apart.render().find("a.st:1:19: error[L0904]") != std::string::npos);
    CHECK(apart.render().find("L0927") == std::string::npos);
}

TEST_CASE("of several libraries one that the project refers to is meant", "[st][libraries]") {
    const auto project = file("a.plcproj", "one\n");
    const auto compiled_with = [&](const std::string& library, const std::string& value) {
        Diagnostics out;
        st::Options options;
        options.references = {{library, {project, 1, 1}}};
        const auto source =
            file("a.EXP", "PROGRAM p VAR d : MC_Direction; END_VAR d := MC_Direction." + value +
                              "; END_PROGRAM\n");
        st::compile({source}, standard_blocks(), out, options);
        return out.render();
    };
    CHECK(compiled_with("Tc2_MC2", "MC_Positive_Direction") == "");
    CHECK(compiled_with("SM3_Basic", "positive") == "");
    CHECK(compiled_with("SM3_Basic", "MC_Positive_Direction").find("L0904") != std::string::npos);
}

TEST_CASE("a block that is mostly another's may be of a library that is not here",
          "[st][libraries]") {
    const auto project = file("a.plcproj", "one\ntwo\n");
    const auto source = file("a.TcPOU",
                             "PROGRAM p VAR r : FB_SoERead; go, e : BOOL; v : UINT; END_VAR\n"
                             "r(bExecute := go, nIdn := 32770, pDstBuf := ADR(v), cbBufLen := 2);\n"
                             "e := r.bError; END_PROGRAM\n");
    const auto told_with = [&](const std::vector<std::string>& references) {
        Diagnostics out;
        st::Options options;
        for (const std::string& name : references)
            options.references.push_back({name, {project, 1, 1}});
        st::compile({source}, standard_blocks(), out, options);
        return out.render();
    };
    CHECK(
        told_with({"Tc2_MC2", "Tc2_Drive"})
            .find("a name that nobody declares may be of libraries that are not here: Tc2_Drive") !=
        std::string::npos);
    CHECK(told_with({"Tc2_MC2", "Tc2_Drive"}).find("L0907") == std::string::npos);
    CHECK(told_with({"Tc2_MC2_Drive", "Tc2_Drive"}).find("has no argument 'nIdn'") !=
          std::string::npos);
    CHECK(told_with({"Tc2_MC2"}).find("has no argument 'nIdn'") != std::string::npos);
}
