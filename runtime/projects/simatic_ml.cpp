#include "runtime/projects/simatic_ml.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/flag_nets.hpp"
#include "runtime/projects/drawings/simatic_access.hpp"
#include "runtime/projects/memory_bytes.hpp"
#include "runtime/projects/organization_blocks.hpp"
#include "runtime/projects/xml.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::projects {

namespace {

/// `FB` of `<SW.Blocks.FB>`.
std::string_view kind_of(pugi::xml_node object) {
    const std::string_view name = object.name();
    return name.substr(std::min(name.rfind('.') + 1, name.size()));
}

bool is_structure(std::string_view type) {
    return lower(type).ends_with("struct");
}

/// Writes one object's text.
class SimaticObject {
  public:
    explicit SimaticObject(const XmlFile& file) : file_(file), access_(file) {}

    /// What a tag table has of them.
    void add_memory_bytes(pugi::xml_node table, Project& project) {
        MemoryBytes bytes;
        for (const auto tag : table.child("ObjectList").children("SW.Tags.PlcTag"))
            bytes.add(file_.plain(attributes(tag).child("Name")),
                      file_.plain(attributes(tag).child("LogicalAddress")));
        const std::string name = file_.plain(attributes(table).child("Name"));
        write(bytes.add_to(project, name, place(table)), table);
    }

    void add(pugi::xml_node object) {
        const std::string_view kind = kind_of(object);
        if (kind == "FB") add_block(object, "FUNCTION_BLOCK");
        if (kind == "FC") add_block(object, "FUNCTION");
        if (kind == "OB") add_block(object, "ORGANIZATION_BLOCK");
        if (kind == "GlobalDB" || kind == "InstanceDB") add_data_block(object);
        if (kind == "PlcStruct") add_type(object);
        if (kind == "PlcTagTable") add_tags(object);
    }

    std::shared_ptr<const SourceFile> finish(std::string part) {
        auto made =
            std::make_shared<SourceFile>(*text_.finish(file_.file()->path, std::move(part), out_));
        made->read_as = ".scl";
        return made;
    }

  private:
    Mark place(pugi::xml_node node) const { return file_.mark_of_tag(node); }
    void write(std::string_view words, pugi::xml_node at) { text_.write(words, place(at)); }
    static pugi::xml_node attributes(pugi::xml_node object) {
        return object.child("AttributeList");
    }
    static pugi::xml_node sections(pugi::xml_node object) {
        return attributes(object).child("Interface").child("Sections");
    }
    void write_name(pugi::xml_node object) {
        write("\"", object);
        file_.copy(text_, attributes(object).child("Name"));
        write("\"", object);
    }

    // Declarations.

    /// `NAME "block" : Type`, its variables, its networks.
    void add_block(pugi::xml_node object, std::string_view word) {
        write(fmt::format("{} ", word), object);
        write_name(object);
        for (const auto section : sections(object).children("Section"))
            if (const auto result = section.child("Member"); name_of(section) == "Return") {
                write(" : ", result);
                file_.copy(text_, result.attribute("Datatype"));
            }
        write("\n", object);
        const bool is_graph = language_of(object) == "GRAPH";
        if (is_graph)
            out_.add(code::not_supported, place(object),
                     fmt::format("'{}' is in GRAPH, and only SCL, LAD and FBD are read",
                                 file_.plain(attributes(object).child("Name"))),
                     "write it in one of these");
        for (const auto section : sections(object).children("Section"))
            if (!is_graph || name_of(section) != "Static") add_section(section);
        const Excerpts body = is_graph ? Excerpts{} : body_of(object);
        if (!variables_.declarations().empty())
            write("VAR_TEMP\n" + variables_.declarations() + "END_VAR\n", object);
        write("BEGIN\n", object);
        text_.append(body);
        write(fmt::format("END_{}\n", word), object);
    }

    std::string language_of(pugi::xml_node object) const {
        return file_.plain(attributes(object).child("ProgrammingLanguage"));
    }
    std::string name_of(pugi::xml_node node) const { return file_.plain(node.attribute("Name")); }

    void add_section(pugi::xml_node section) {
        static constexpr std::pair<std::string_view, std::string_view> words[] = {
            {"Input", "VAR_INPUT"}, {"Output", "VAR_OUTPUT"}, {"InOut", "VAR_IN_OUT"},
            {"Static", "VAR"},      {"Temp", "VAR_TEMP"},     {"Constant", "VAR CONSTANT"}};
        for (const auto& [name, word] : words)
            if (name == name_of(section) && section.child("Member")) {
                write(fmt::format("{}\n", word), section);
                for (const auto member : section.children("Member")) {
                    add_member(member);
                    variables_.know(name_of(member), file_.plain(member.attribute("Datatype")));
                }
                write("END_VAR\n", section);
            }
    }

    /// `"name" : Type := value;`
    void add_member(pugi::xml_node member) {
        write("    \"", member);
        file_.copy(text_, member.attribute("Name"));
        write("\" : ", member);
        file_.copy(text_, member.attribute("Datatype"));
        if (is_structure(file_.plain(member.attribute("Datatype")))) {
            write("\n", member);
            for (const auto part : member.children("Member")) add_member(part);
            write("    END_STRUCT", member);
        }
        if (const auto value = member.child("StartValue"); value && !file_.plain(value).empty()) {
            write(" := ", value);
            file_.copy(text_, value);
        }
        write(";\n", member);
        if (kind_ != Kind::data_block) warn_of_elements(member);
    }

    void warn_of_elements(pugi::xml_node member) {
        if (member.child("Subelement") || member.child("Sections").find_node(has_start_value))
            out_.warn(
                code::not_supported, place(member),
                fmt::format("the start values of parts of '{}' are not read", name_of(member)),
                "give them in a data block, or where the block begins");
    }
    static bool has_start_value(pugi::xml_node node) {
        return std::string_view(node.name()) == "StartValue";
    }

    void add_type(pugi::xml_node object) {
        write("TYPE ", object);
        write_name(object);
        write("\nSTRUCT\n", object);
        for (const auto section : sections(object).children("Section"))
            for (const auto member : section.children("Member")) add_member(member);
        write("END_STRUCT;\nEND_TYPE\n", object);
    }

    /// It has members of its own, or is an instance; values of their parts are assigned.
    void add_data_block(pugi::xml_node object) {
        kind_ = Kind::data_block;
        if (const auto number = attributes(object).child("Number")) {
            write("{S7_BlockNumber := \"", number);
            file_.copy(text_, number);
            write("\"}\n", number);
        }
        write("DATA_BLOCK ", object);
        write_name(object);
        write("\n", object);
        if (const auto of = attributes(object).child("InstanceOfName")) {
            write("\"", of);
            file_.copy(text_, of);
            write("\"\n", of);
        } else {
            for (const auto section : sections(object).children("Section")) add_section(section);
        }
        write("BEGIN\n", object);
        const bool is_instance = kind_of(object) == "InstanceDB";
        for (const auto section : sections(object).children("Section"))
            for (const auto member : section.children("Member"))
                add_values(member, "", is_instance);
        write("END_DATA_BLOCK\n", object);
    }

    /// `list[2].x := 3;`: what the declaration does not say.
    void add_values(pugi::xml_node member, const std::string& before, bool is_instance) {
        const std::string name =
            fmt::format("{}\"{}\"{}", before, name_of(member), indices_of(member));
        const bool is_one = name.find(an_index) == name.npos;
        if (const auto value = member.child("StartValue"); value && is_instance && is_one)
            add_value(name, value);
        for (const auto element : member.children("Subelement"))
            if (const auto value = element.child("StartValue"))
                add_value(indexed(name, file_.plain(element.attribute("Path"))), value);
        for (const auto part : member.children("Member")) add_values(part, name + ".", is_instance);
        for (const auto section : member.child("Sections").children("Section")) {
            if (is_memory_of_edge(member, section)) continue;
            for (const auto part : section.children("Member")) add_values(part, name + ".", true);
        }
    }

    /// What R_TRIG and F_TRIG keep is no part that is named.
    bool is_memory_of_edge(pugi::xml_node member, pugi::xml_node section) const {
        const std::string type = file_.plain(member.attribute("Datatype"));
        return (type == "R_TRIG" || type == "F_TRIG") &&
               section.attribute("Name").value() == std::string_view("Static");
    }
    static constexpr char an_index = '\1';

    /// `[1,1]`, with a mark in place of each number, of an array of two dimensions.
    std::string indices_of(pugi::xml_node member) const {
        const std::string type = lower(file_.plain(member.attribute("Datatype")));
        if (!type.starts_with("array")) return {};
        std::string made;
        const std::size_t end = type.find(']');
        for (std::size_t at = 0; (at = type.find("..", at)) < end; at += 2)
            made += fmt::format("{}{}", made.empty() ? '[' : ',', an_index);
        return made.empty() ? made : made + ']';
    }
    /// `2,5` are those of all arrays on the way, from the outermost on.
    static std::string indexed(const std::string& name, std::string_view path) {
        std::string made;
        for (const char c : name) {
            if (c != an_index) {
                made += c;
                continue;
            }
            const std::size_t end = std::min(path.find(','), path.size());
            made += path.substr(0, end);
            path.remove_prefix(std::min(end + 1, path.size()));
        }
        return made;
    }

    void add_value(const std::string& name, pugi::xml_node value) {
        if (file_.plain(value).empty()) return;
        write(fmt::format("    {} := ", name), value);
        file_.copy(text_, value);
        write(";\n", value);
    }

    /// Tags, and constants of the user.
    void add_tags(pugi::xml_node table) {
        const auto list = table.child("ObjectList");
        add_tags(list, "SW.Tags.PlcTag", "VAR_GLOBAL\n");
        add_tags(list, "SW.Tags.PlcUserConstant", "VAR_GLOBAL CONSTANT\n");
    }
    void add_tags(pugi::xml_node list, const char* kind, std::string_view word) {
        if (!list.child(kind)) return;
        write(word, list);
        for (const auto tag : list.children(kind)) {
            write("    ", tag);
            write_name(tag);
            if (const auto address = attributes(tag).child("LogicalAddress")) {
                write(" AT ", address);
                file_.copy(text_, address);
            }
            write(" : ", tag);
            file_.copy(text_, attributes(tag).child("DataTypeName"));
            if (const auto value = attributes(tag).child("Value")) {
                write(" := ", value);
                file_.copy(text_, value);
            }
            const auto plain = [&](const char* what) {
                return file_.plain(attributes(tag).child(what));
            };
            if (MemoryBytes::is_always_true(plain("Name"), plain("LogicalAddress")))
                write(" := TRUE", tag);
            write(";\n", tag);
        }
        write("END_VAR\n", list);
    }

    // Bodies.

    Excerpts body_of(pugi::xml_node object) {
        Excerpts made;
        int network = 0;
        for (const auto unit : object.child("ObjectList").children("SW.Blocks.CompileUnit"))
            made.append(network_text(unit, ++network));
        return made;
    }

    Excerpts network_text(pugi::xml_node unit, int number) {
        const auto source = attributes(unit).child("NetworkSource");
        if (const auto text = source.child("StructuredText")) return access_.statements(text);
        if (const auto net = source.child("FlgNet"))
            return text_of_flag_net(file_, out_, variables_, net, number);
        if (source.first_child())
            out_.add(code::not_supported, place(source),
                     fmt::format("network {} is in {}, and only SCL, LAD and FBD are read", number,
                                 language_of(unit)),
                     "write it in one of these");
        return {};
    }

    enum class Kind : std::uint8_t { other, data_block };

    const XmlFile& file_;
    SimaticAccess access_;
    Diagnostics out_;
    MadeVariables variables_;
    Excerpts text_;
    Kind kind_ = Kind::other;
};

OrganizationBlock organization_block_of(const XmlFile& file, pugi::xml_node object) {
    const auto attributes = object.child("AttributeList");
    const std::string number = file.plain(attributes.child("Number"));
    std::int64_t counted = 0;
    std::from_chars(number.data(), number.data() + number.size(), counted);
    return organization_block({file.plain(attributes.child("Name")), file.mark_of_tag(object)},
                              counted, file.plain(attributes.child("SecondaryType")));
}

bool is_read(pugi::xml_node object) {
    static constexpr std::string_view kinds[] = {
        "FB", "FC", "OB", "GlobalDB", "InstanceDB", "PlcStruct", "PlcTagTable"};
    return std::string_view(object.name()).starts_with("SW.") &&
           std::ranges::find(kinds, kind_of(object)) != std::end(kinds);
}

}  // namespace

bool is_simatic_ml(const std::filesystem::path& file) {
    std::string start(65'536, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    std::erase(start, '\0');
    return start.find("<Document") != std::string::npos &&
           (start.find("<SW.Blocks.") != std::string::npos ||
            start.find("<SW.Types.PlcStruct") != std::string::npos ||
            start.find("<SW.Tags.PlcTagTable") != std::string::npos);
}

void read_simatic_ml(const Reading& to, const std::string& path, const Mark& where) {
    const auto file = XmlFile::read(path, to.out, where);
    if (!file) return;
    for (const auto object : file->root().children()) {
        if (!is_read(object)) continue;
        SimaticObject made(*file);
        made.add(object);
        if (kind_of(object) == "PlcTagTable") made.add_memory_bytes(object, to.project);
        if (kind_of(object) == "OB")
            to.project.organization_blocks.push_back(organization_block_of(*file, object));
        to.project.add(
            made.finish(std::string(object.name()) + file->plain(object.attribute("ID"))));
    }
}

}  // namespace lineshaft::projects
