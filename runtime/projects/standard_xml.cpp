#include "runtime/projects/standard_xml.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "runtime/projects/xml.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft::projects {

namespace {

/// A name there, and in PLCopen TC6.
struct Renamed {
    std::string_view standard, plcopen;
};
constexpr Renamed renamed_sections[] = {
    {"InputVars", "inputVars"}, {"OutputVars", "outputVars"},     {"InoutVars", "inOutVars"},
    {"InOutVars", "inOutVars"}, {"ExternalVars", "externalVars"}, {"TempVars", "tempVars"},
    {"Vars", "localVars"},      {"GlobalVars", "globalVars"}};
constexpr Renamed renamed_pous[] = {
    {"Program", "program"}, {"FunctionBlock", "functionBlock"}, {"Function", "function"}};
constexpr Renamed renamed_elements[] = {{"LeftPowerRail", "leftPowerRail"},
                                        {"RightPowerRail", "rightPowerRail"},
                                        {"Contact", "contact"},
                                        {"Coil", "coil"},
                                        {"DataSource", "inVariable"},
                                        {"DataSink", "outVariable"},
                                        {"Block", "block"}};

template <std::size_t count>
std::string_view renamed(const Renamed (&names)[count], std::string_view name) {
    const auto* found = std::ranges::find(names, name, &Renamed::standard);
    return found == std::end(names) ? std::string_view() : found->plcopen;
}

/// `LdSection` of `xsi:type="smcext:LdSection"`.
std::string_view kind_of_element(pugi::xml_node node) {
    const std::string_view type = node.attribute("xsi:type").value();
    return type.substr(type.rfind(':') + 1);
}

constexpr int deepest = 50;

/// Where a line of a network comes from.
struct PointOut {
    std::size_t element = 0;
    pugi::xml_attribute pin = {};  ///< of a block
};

class StandardXml {
  public:
    StandardXml(const XmlFile& file, Diagnostics& out) : file_(file), out_(out) {}

    std::shared_ptr<const SourceFile> read() {
        const pugi::xml_node root = file_.root();
        const pugi::xml_node types = root.child("Types");
        write("<project><types><dataTypes>", root);
        for_each_declared(types, [&](pugi::xml_node node) {
            if (std::string_view(node.name()) == "DataTypeDecl") add_data_type(node);
        });
        write("</dataTypes><pous>", root);
        for_each_declared(types, [&](pugi::xml_node node) {
            if (const auto kind = renamed(renamed_pous, node.name()); !kind.empty())
                add_pou(node, kind);
        });
        write("</pous></types><instances><configurations>", root);
        for (const pugi::xml_node configuration :
             root.child("Instances").children("Configuration")) {
            write("<configuration>", configuration);
            add_sections(configuration);
            for (const pugi::xml_node resource : configuration.children("Resource"))
                add_resource(resource);
            write("</configuration>", configuration);
        }
        write("</configurations></instances></project>", root);
        return xml_.finish(file_.file()->path);
    }

  private:
    void write(std::string_view words, pugi::xml_node at) {
        xml_.write(words, file_.mark_of_tag(at));
    }

    /// As the file has it, with its entities.
    void copy(Part part) { file_.PlacedFile::copy(xml_, part); }

    void add_attribute(std::string_view name, Part value, pugi::xml_node at) {
        const std::string_view quote =
            file_.text(value).find('"') == std::string_view::npos ? "\"" : "'";
        write(fmt::format(" {}={}", name, quote), at);
        copy(value);
        write(quote, at);
    }
    void add_attribute(std::string_view name, pugi::xml_attribute value, pugi::xml_node at) {
        if (value) add_attribute(name, file_.part(value), at);
    }

    template <class Add>
    void for_each_declared(pugi::xml_node space, const Add& add, int depth = 0) {
        for (const pugi::xml_node node : space.children()) {
            const std::string_view name = node.name();
            const bool is_space = name == "GlobalNamespace" || name == "NamespaceDecl";
            if (is_space && depth < deepest)
                for_each_declared(node, add, depth + 1);
            else
                add(node);
        }
    }

    /// `Common\Servo` is Servo.
    void add_type_name(pugi::xml_node name) {
        for (Part part : file_.texts(name)) {
            const std::string_view text = file_.text(part);
            const std::size_t space = text.rfind('\\'), of = text.rfind(' ');
            const bool is_array = of != text.npos && space != text.npos && of < space;
            if (is_array) {
                copy({part.begin, part.begin + of + 1});
                part.begin += space + 1;
            } else if (space != text.npos) {
                part.begin += space + 1;
            }
            copy(part);
        }
    }

    /// What stands in <Type>, <BaseType> or <ResultType>, or is one of the specifications itself.
    void add_type(pugi::xml_node type) {
        if (!type || nested_ > deepest) return;
        ++nested_;
        add_type_within(type);
        --nested_;
    }

    void add_type_within(pugi::xml_node type) {
        const pugi::xml_node name = type.child("TypeName"),
                             made = type.child("InstantlyDefinedType");
        if (made) return add_specification(made);
        if (const std::string_view kind = kind_of_element(type); !kind.empty())
            return add_specification(type);
        write("<derived name=\"", type);
        add_type_name(name ? name : type);
        write("\"/>", type);
    }

    void add_specification(pugi::xml_node type) {
        const std::string_view kind = kind_of_element(type);
        if (kind == "StructTypeSpec") {
            write("<struct>", type);
            for (const pugi::xml_node member : type.children("Member")) add_variable(member);
            return write("</struct>", type);
        }
        if (kind.starts_with("Enum")) return add_enumerators(type);
        if (kind == "ArrayTypeSpec") return add_array(type);
        if (kind == "SubrangeTypeSpec") return add_subrange(type);
        add_type(type.child("BaseType"));
    }

    void add_enumerators(pugi::xml_node type) {
        write("<enum><values>", type);
        for (const pugi::xml_node value : type.children("Enumerator")) {
            write("<value", value);
            add_attribute("name", value.attribute("name"), value);
            add_attribute("value", value.attribute("value"), value);
            write("/>", value);
        }
        write("</values>", type);
        if (const pugi::xml_node base = type.child("BaseType")) {
            write("<baseType>", base);
            add_type(base);
            write("</baseType>", base);
        }
        write("</enum>", type);
    }

    void add_array(pugi::xml_node type) {
        write("<array>", type);
        for (const pugi::xml_node dimension : type.children("DimensionSpec")) {
            const pugi::xml_node range = dimension.child("IndexRange");
            write("<dimension", dimension);
            add_attribute("lower", range.attribute("lower"), range);
            add_attribute("upper", range.attribute("upper"), range);
            write("/>", dimension);
        }
        write("<baseType>", type);
        add_type(type.child("BaseType"));
        write("</baseType></array>", type);
    }

    void add_subrange(pugi::xml_node type) {
        const pugi::xml_node range = type.child("Range");
        write("<subrangeSigned><range", type);
        add_attribute("lower", range.attribute("lower"), range);
        add_attribute("upper", range.attribute("upper"), range);
        write("/><baseType>", type);
        add_type(type.child("BaseType"));
        write("</baseType></subrangeSigned>", type);
    }

    void add_value(pugi::xml_node value, std::string_view tag, int depth = 0) {
        if (!value || depth > deepest) return;
        write(fmt::format("<{}", tag), value);
        add_attribute("member", value.attribute("member"), value);
        add_attribute("repetitionValue", value.attribute("repetitionValue"), value);
        write(">", value);
        if (const pugi::xml_node simple = value.child("SimpleValue")) {
            write("<simpleValue", simple);
            add_attribute("value", simple.attribute("value"), simple);
            write("/>", simple);
        }
        for (const auto& [standard, plcopen] :
             {Renamed{"ArrayValue", "arrayValue"}, Renamed{"StructValue", "structValue"}}) {
            const pugi::xml_node list = value.child(standard.data());
            if (!list) continue;
            write(fmt::format("<{}>", plcopen), list);
            for (const pugi::xml_node each : list.children("Value"))
                add_value(each, "value", depth + 1);
            write(fmt::format("</{}>", plcopen), list);
        }
        write(fmt::format("</{}>", tag), value);
    }

    void add_variable(pugi::xml_node variable) {
        write("<variable", variable);
        add_attribute("name", variable.attribute("name"), variable);
        const pugi::xml_node address = variable.child("Address");
        const std::string place = file_.plain(address.attribute("address")).substr(0, 2);
        if (place == "%I" || place == "%Q" || place == "%M")
            add_attribute("address", address.attribute("address"), address);
        write("><type>", variable);
        add_type(variable.child("Type"));
        write("</type>", variable);
        add_value(variable.child("InitialValue"), "initialValue");
        write("</variable>", variable);
    }

    void add_sections(pugi::xml_node owner) {
        for (const pugi::xml_node section : owner.children()) {
            const std::string_view tag = renamed(renamed_sections, section.name());
            if (tag.empty()) continue;
            write(fmt::format("<{}", tag), section);
            for (const char* flag : {"constant", "retain"})
                add_attribute(flag, section.attribute(flag), section);
            write(">", section);
            for (const pugi::xml_node variable : section.children("Variable"))
                add_variable(variable);
            write(fmt::format("</{}>", tag), section);
        }
    }

    void add_data_type(pugi::xml_node type) {
        const pugi::xml_node specification = type.child("UserDefinedTypeSpec");
        write("<dataType", type);
        add_attribute("name", type.attribute("name"), type);
        write("><baseType>", type);
        add_type(specification);
        write("</baseType>", type);
        add_value(specification.child("InitialValue"), "initialValue");
        write("</dataType>", type);
    }

    void add_pou(pugi::xml_node pou, std::string_view kind) {
        write("<pou", pou);
        add_attribute("name", pou.attribute("name"), pou);
        write(fmt::format(" pouType=\"{}\"><interface>", kind), pou);
        if (const pugi::xml_node result = pou.child("ResultType")) {
            write("<returnType>", result);
            add_type(result);
            write("</returnType>", result);
        }
        add_sections(pou.child("Parameters"));
        add_sections(pou);
        write("</interface>", pou);
        for (const pugi::xml_node body : pou.child("MainBody").children("BodyContent"))
            add_body(body, pou);
        write("</pou>", pou);
    }

    void add_body(pugi::xml_node body, pugi::xml_node pou) {
        const std::string_view kind = kind_of_element(body);
        if (kind == "ST") return add_statements(body.child("ST"));
        if (kind != "LD" && kind != "LdSection" && kind != "FBD")
            return out_.add(code::not_supported, file_.mark_of_tag(body),
                            fmt::format("this body of '{}' is in {}, which is not read",
                                        file_.plain(pou.attribute("name")), kind),
                            "write it in ST, LD or FBD");
        const std::size_t first = elements_;
        points_.clear();
        for (const char* network : {"Rung", "Network"})  // lines may lead to later ones
            for (const pugi::xml_node each : body.children(network)) note_points(each);
        elements_ = first;
        const std::string_view language = kind == "FBD" ? "FBD" : "LD";
        write(fmt::format("<body><{}>", language), body);
        for (const char* network : {"Rung", "Network"})
            for (const pugi::xml_node each : body.children(network)) add_network(each);
        write(fmt::format("</{}></body>", language), body);
    }

    void add_statements(pugi::xml_node text) {
        if (!text) return;
        write("<body><ST><xhtml>", text);
        for (const Part part : file_.texts(text)) {
            const bool is_data = file_.text(part).find('<') != std::string_view::npos;
            if (is_data) write("<![CDATA[", text);
            copy(part);
            if (is_data) write("]]>", text);
        }
        write("</xhtml></ST></body>", text);
    }

    /// Numbers its elements; there may be points of the same name in others.
    void note_points(pugi::xml_node network) {
        for (const pugi::xml_node element : network.children())
            if (is_element(element)) note_points(element, ++elements_);
    }

    void add_network(pugi::xml_node network) {
        std::size_t number = elements_;
        note_points(network);
        for (const pugi::xml_node element : network.children())
            if (is_element(element)) add_element(element, ++number);
    }

    static bool is_element(pugi::xml_node node) {
        const std::string_view name = node.name();
        return name == "LdObject" || name == "FbdObject";
    }

    void note_points(pugi::xml_node element, std::size_t number) {
        const auto note = [&](pugi::xml_node owner, pugi::xml_attribute pin) {
            for (const pugi::xml_node point : owner.children("ConnectionPointOut"))
                points_[point.attribute("connectionPointOutId").value()] = {number, pin};
        };
        note(element, {});
        for (const char* list : {"OutputVariables", "InOutVariables"})
            for (const pugi::xml_node pin : element.child(list).children())
                note(pin, pin.attribute("parameterName"));
    }

    void add_lines(pugi::xml_node owner) {
        for (const pugi::xml_node point : owner.children("ConnectionPointIn")) {
            write("<connectionPointIn>", point);
            for (const pugi::xml_node line : point.children("Connection")) {
                const PointOut from = points_[line.attribute("refConnectionPointOutId").value()];
                write(fmt::format("<connection refLocalId=\"{}\"", from.element), line);
                add_attribute("formalParameter", from.pin, line);
                write("/>", line);
            }
            write("</connectionPointIn>", point);
        }
    }

    void add_pins(pugi::xml_node block, const char* list, std::string_view tag) {
        write(fmt::format("<{}>", tag), block);
        for (const pugi::xml_node each : block.child(list).children()) {
            if (!each.attribute("parameterName")) continue;
            write("<variable", each);
            add_attribute("formalParameter", each.attribute("parameterName"), each);
            add_attribute("negated", each.attribute("negated"), each);
            write(">", each);
            add_lines(each);
            if (tag != "inputVariables") write("<connectionPointOut/>", each);
            write("</variable>", each);
        }
        write(fmt::format("</{}>", tag), block);
    }

    void add_element(pugi::xml_node element, std::size_t number) {
        const std::string_view kind = kind_of_element(element),
                               tag = renamed(renamed_elements, kind);
        if (tag.empty())
            return out_.add(code::not_supported, file_.mark_of_tag(element),
                            fmt::format("<{}> of the type {} is no element of a network here",
                                        element.name(), kind),
                            "draw it with contacts, coils and blocks, or write it in ST");
        write(fmt::format("<{} localId=\"{}\"", tag, number), element);
        for (const char* flag : {"negated", "typeName", "instanceName"})
            add_attribute(flag, element.attribute(flag), element);
        add_attribute("edge", element.attribute("edge"), element);
        add_attribute("storage", element.attribute("latch"), element);
        write(">", element);
        if (tag == "block") {
            add_pins(element, "InputVariables", "inputVariables");
            add_pins(element, "InOutVariables", "inOutVariables");
            add_pins(element, "OutputVariables", "outputVariables");
        } else {
            add_lines(element);
            const pugi::xml_attribute operand = element.attribute("operand"),
                                      identifier = element.attribute("identifier");
            const pugi::xml_attribute named = operand ? operand : identifier;
            const std::string_view name = operand ? "variable" : "expression";
            if (named) {
                write(fmt::format("<{}>", name), element);
                copy(file_.part(named));
                write(fmt::format("</{}>", name), element);
            }
        }
        write(fmt::format("</{}>", tag), element);
    }

    void add_resource(pugi::xml_node resource) {
        write("<resource>", resource);
        add_sections(resource);
        for (const pugi::xml_node task : resource.children("Task")) {
            write("<task", task);
            for (const char* attribute : {"name", "priority", "interval"})
                add_attribute(attribute, task.attribute(attribute), task);
            write(">", task);
            for (const pugi::xml_node program : resource.children("ProgramInstance"))
                if (file_.plain(program.attribute("associatedTaskName")) ==
                    file_.plain(task.attribute("name")))
                    add_instance(program);
            write("</task>", task);
        }
        write("</resource>", resource);
    }

    void add_instance(pugi::xml_node program) {
        write("<pouInstance", program);
        add_attribute("name", program.attribute("instanceName"), program);
        add_attribute("typeName", program.attribute("typeName"), program);
        write("/>", program);
    }

    const XmlFile& file_;
    Diagnostics& out_;
    Excerpts xml_;
    int nested_ = 0;                          ///< types in types
    std::size_t elements_ = 0;                ///< of networks so far
    std::map<std::string, PointOut> points_;  ///< of one network
};

}  // namespace

bool is_standard_xml(const XmlFile& file) {
    return file.text().find("TC65SC65BWG7TF10") != std::string_view::npos;
}

std::shared_ptr<const SourceFile> plcopen_of_standard_xml(const XmlFile& file, Diagnostics& out) {
    return StandardXml(file, out).read();
}

}  // namespace lineshaft::projects
