#include "runtime/projects/codesys_export.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "runtime/projects/twincat.hpp"
#include "runtime/projects/xml.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/lexer.hpp"

namespace lineshaft::projects {

namespace {

constexpr std::string_view first_tag = "<ExportFile";

pugi::xml_node member(pugi::xml_node object, std::string_view name) {
    for (const pugi::xml_node child : object.children())
        if (child.attribute("Name").value() == name) return child;
    return {};
}

struct ExportedObject {
    pugi::xml_node object;  ///< with its texts
    std::string id = {}, owner = {}, name = {};
    std::string_view element = {};  ///< as TwinCAT calls it; empty: it has no text
};

/// By the first word of a declaration.
struct DeclaredElement {
    std::string_view word, element;
};
constexpr DeclaredElement declared_elements[] = {
    {"program", "POU"},   {"function_block", "POU"}, {"function", "POU"},  {"interface", "Itf"},
    {"type", "DUT"},      {"var_global", "GVL"},     {"method", "Method"}, {"property", "Property"},
    {"action", "Action"}, {"class", "POU"}};

/// The objects as those of TwinCAT, which are the same but for their frame.
class ExportText {
  public:
    explicit ExportText(const XmlFile& file) : file_(file) {
        for (const pugi::xml_node view : file.root().children("StructuredView"))
            for (const pugi::xml_node top : view.children())
                for (const pugi::xml_node list : top.children())
                    for (const pugi::xml_node entry : list.children()) add(entry);
    }

    std::shared_ptr<const SourceFile> text() {
        write("<TcPlcObject>\n", file_.root());
        for (const ExportedObject& one : objects_)
            if (is_of_its_own(one.element)) write_object(one);
        write("</TcPlcObject>\n", file_.root());
        return made_.finish(file_.file()->path, "TcPlcObject");
    }

  private:
    static bool is_of_its_own(std::string_view element) {
        return element == "POU" || element == "Itf" || element == "DUT" || element == "GVL";
    }

    void add(pugi::xml_node entry) {
        const pugi::xml_node meta = member(entry, "MetaObject");
        const auto text = [&](std::string_view name) { return file_.plain(member(meta, name)); };
        ExportedObject made{.object = member(entry, "Object"),
                            .id = text("Guid"),
                            .owner = text("ParentGuid"),
                            .name = text("Name")};
        const bool is_plain = made.name.find_first_of("<>&\"") == made.name.npos;
        if (!made.object || !is_plain || is_left_out(meta)) return;
        made.element = element_of(made);
        by_owner_[made.owner].push_back(objects_.size());
        objects_.push_back(std::move(made));
    }

    /// Its property «exclude from build».
    bool is_left_out(pugi::xml_node meta) const {
        for (const pugi::xml_node entry : member(meta, "Properties").children())
            for (const pugi::xml_node value : entry.child("Value").children())
                if (lower(file_.plain(member(value, "ExcludeFromBuild"))) == "true") return true;
        return false;
    }

    static pugi::xml_node lines_of(pugi::xml_node part) {
        return member(member(part, "TextDocument"), "TextLines");
    }

    std::string_view element_of(const ExportedObject& one) const {
        std::string declared;
        for (const pugi::xml_node line : lines_of(member(one.object, "Interface")).children())
            declared += file_.plain(member(line, "Text")) + "\n";
        Diagnostics unread;
        const auto source = std::make_shared<const SourceFile>(SourceFile{"", declared});
        for (const st::Token& token : st::read_tokens(source, unread).tokens) {
            const std::string word = lower(token.text);
            const auto* known = std::ranges::find(declared_elements, word, &DeclaredElement::word);
            if (known != std::end(declared_elements)) return known->element;
        }
        if (one.name == "Get" || one.name == "Set") return one.name == "Get" ? "Get" : "Set";
        return member(one.object, "Implementation") ? "Action" : "";
    }

    void write(std::string_view words, pugi::xml_node at) {
        made_.write(words, file_.mark_of_tag(at));
    }

    /// As they stand, with their entities.
    void write_lines(pugi::xml_node lines) {
        for (const pugi::xml_node line : lines.children()) {
            for (const Part part : file_.texts(member(line, "Text"))) made_.copy(file_, part);
            write("\n", line);
        }
    }

    void write_object(const ExportedObject& one) {
        write(fmt::format("<{} Name=\"{}\">\n", one.element, one.name), one.object);
        if (const pugi::xml_node lines = lines_of(member(one.object, "Interface"))) {
            write("<Declaration>", lines);
            write_lines(lines);
            write("</Declaration>\n", lines);
        }
        if (const pugi::xml_node body = member(one.object, "Implementation")) {
            const pugi::xml_node lines = lines_of(body);
            write("<Implementation>", body);
            write(lines ? "<ST>" : "<Drawing/>", body);
            write_lines(lines);
            write(lines ? "</ST></Implementation>\n" : "</Implementation>\n", body);
        }
        if (const auto owned = by_owner_.find(one.id); owned != by_owner_.end())
            for (const std::size_t i : owned->second)
                if (const ExportedObject& part = objects_[i];
                    !part.element.empty() && !is_of_its_own(part.element))
                    write_object(part);
        write(fmt::format("</{}>\n", one.element), one.object);
    }

    const XmlFile& file_;
    std::vector<ExportedObject> objects_;
    std::map<std::string, std::vector<std::size_t>> by_owner_;
    Excerpts made_;
};

}  // namespace

bool is_codesys_export(const std::filesystem::path& file) {
    std::string start(256, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    return start.find(first_tag) != std::string::npos;
}

void read_codesys_export(const Reading& to, const std::string& path, const Mark& where) {
    const auto file = XmlFile::read(path, to.out, where);
    if (!file) return;
    if (std::string_view(file->root().name()) != first_tag.substr(1))
        return to.out.add(code::not_an_object, file->mark_of_tag(file->root()),
                          fmt::format("<{}> is no export of CODESYS", file->root().name()),
                          "its files begin with <ExportFile>");
    if (const auto objects = XmlFile::parse(ExportText(*file).text(), to.out))
        add_twincat_objects(to, *objects, ".xml");
}

}  // namespace lineshaft::projects
