#include "runtime/projects/plcopen_text.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

constexpr int deepest_type = 50;

struct Term {
    std::string_view element, text;
};
constexpr Term sections[] = {{"inputVars", "VAR_INPUT"},  {"outputVars", "VAR_OUTPUT"},
                             {"inOutVars", "VAR_IN_OUT"}, {"localVars", "VAR"},
                             {"tempVars", "VAR_TEMP"},    {"externalVars", "VAR_EXTERNAL"},
                             {"globalVars", "VAR_GLOBAL"}};
constexpr Term pou_kinds[] = {{"function", "FUNCTION"},
                              {"functionBlock", "FUNCTION_BLOCK"},
                              {"program", "PROGRAM"},
                              {"interface", "INTERFACE"}};

/// Empty: none of them.
template <std::size_t count>
std::string_view term_of(const Term (&words)[count], std::string_view element) {
    const auto* word = std::ranges::find(words, element, &Term::element);
    return word == std::end(words) ? std::string_view() : word->text;
}

pugi::xml_node first_element(pugi::xml_node node) {
    for (const pugi::xml_node child : node.children())
        if (child.type() == pugi::node_element) return child;
    return {};
}

/// What a type of the file is derived from, which is not such a type.
pugi::xml_node base_of(const XmlFile& file, pugi::xml_node kind) {
    const pugi::xml_node types = file.root().child("types").child("dataTypes");
    for (int depth = 0; depth < deepest_type && std::string_view(kind.name()) == "derived";
         ++depth) {
        const std::string name = file.plain(kind.attribute("name"));
        const pugi::xml_node declared = types.find_child([&](pugi::xml_node type) {
            return st::same_name(file.plain(type.attribute("name")), name);
        });
        kind = first_element(declared.child("baseType"));
    }
    return kind;
}

/// What CODESYS and TwinCAT have beside the element, beside its interface, or in it.
pugi::xml_node addition_of(pugi::xml_node element, const char* name) {
    if (const pugi::xml_node own = element.child(name)) return own;
    for (const pugi::xml_node owner : {element, element.child("interface")})
        for (const pugi::xml_node data : owner.child("addData").children("data"))
            if (const pugi::xml_node found = data.child(name)) return found;
    return {};
}

/// CODESYS writes ARRAY[*] as a pointer, and beside it what it was, and of which section.
pugi::xml_attribute open_array_of(pugi::xml_node variable, const char* name) {
    return addition_of(variable, "Attributes")
        .find_child_by_attribute("Attribute", "Name", name)
        .attribute("Value");
}

constexpr const char* open_array = "variable_length_array";
constexpr const char* open_array_scope = "variable_length_array_original_scope";

}  // namespace

std::shared_ptr<const SourceFile> PlcopenText::finish(pugi::xml_node named) {
    return text_.finish(file_.file()->path, file_.plain(named.attribute("name")), out_);
}

bool PlcopenText::add_plain(pugi::xml_node element) {
    const pugi::xml_node plain = addition_of(element, "InterfaceAsPlainText");
    if (!plain) return false;
    file_.copy(text_, plain);
    write("\n", plain);
    return true;
}

/// `EXTENDS a IMPLEMENTS b, c`
void PlcopenText::add_inheritance(pugi::xml_node element) {
    const pugi::xml_node inheritance = addition_of(element, "Inheritance");
    for (const auto& [name, word] :
         {Term{"Extends", " EXTENDS "}, Term{"Implements", " IMPLEMENTS "}}) {
        std::string_view before = word;
        for (const pugi::xml_node base : inheritance.children(name.data())) {
            write(before, base);
            file_.copy(text_, base);
            before = ", ";
        }
    }
}

void PlcopenText::add_interface(pugi::xml_node interface) {
    for (const pugi::xml_node section : interface.children())
        if (const std::string_view word = term_of(sections, section.name()); !word.empty())
            for (const pugi::xml_node list : lists_of(section)) add_section(list, word);
}

/// The lists of one that has variables of several kinds, as CODESYS writes it; else that one.
std::vector<pugi::xml_node> PlcopenText::lists_of(pugi::xml_node section) {
    std::vector<pugi::xml_node> lists;
    for (const pugi::xml_node data : section.child("addData").children("data"))
        for (const pugi::xml_node list : data.child("MixedAttrsVarList").children())
            lists.push_back(list);
    return lists.empty() ? std::vector{section} : lists;
}

void PlcopenText::add_section(pugi::xml_node section, std::string_view word) {
    write(word, section);
    for (const auto& [name, meaning] :
         {Term{"constant", " CONSTANT"}, Term{"retain", " RETAIN"},
          Term{"nonretain", " NON_RETAIN"}, Term{"persistent", " PERSISTENT"}})
        if (file_.plain(section.attribute(name.data())) == "true") write(meaning, section);
    write("\n", section);
    for (const pugi::xml_node variable : section.children("variable")) {
        const bool is_lent = file_.plain(open_array_of(variable, open_array_scope)) == "Inout" &&
                             word != "VAR_IN_OUT";
        if (is_lent) write("END_VAR\nVAR_IN_OUT\n", variable);
        add_variable(variable);
        if (is_lent) write(fmt::format("END_VAR\n{}\n", word), variable);
    }
    write("END_VAR\n", section);
}

/// `%QW0.1.0.0` names a point of a bus, which has no place in an image of bytes.
void PlcopenText::add_variable(pugi::xml_node variable) {
    write("  ", variable);
    file_.copy(text_, variable.attribute("name"));
    if (const pugi::xml_attribute address = variable.attribute("address")) {
        write(" AT ", variable);
        const std::string text = file_.plain(address);
        if (is_of_matiec_ && std::ranges::count(text, '.') > 1)
            write(fmt::format("{}*", text.substr(0, 2)), variable);
        else
            file_.copy(text_, address);
    }
    add_declared(variable, "type");
    write(";\n", variable);
}

/// What stands behind the name of a variable or a type.
void PlcopenText::add_declared(pugi::xml_node declared, const char* type) {
    write(" : ", declared);
    if (const pugi::xml_attribute open = open_array_of(declared, open_array))
        file_.copy(text_, open);
    else
        add_type_of(declared.child(type), 0);
    if (const pugi::xml_node value = declared.child("initialValue")) {
        write(" := ", value);
        const std::string_view quote = quote_of(declared.child(type), value.child("simpleValue"));
        write(quote, value);
        add_value(value, 0);
        write(quote, value);
    }
}

/// The editors of OpenPLC and Beremiz keep texts without those that they compile them with.
std::string_view PlcopenText::quote_of(pugi::xml_node type, pugi::xml_node value) const {
    const std::string kind = lower(std::string(base_of(file_, first_element(type)).name()));
    const std::string_view quote = kind == "string" ? "'" : kind == "wstring" ? "\"" : "";
    const std::string text = file_.plain(value.attribute("value"));
    const bool has_quotes = text.starts_with(quote) || text.ends_with(quote);
    return value && is_of_matiec_ && !has_quotes ? quote : "";
}

void PlcopenText::add_type_of(pugi::xml_node type, int depth) {
    const pugi::xml_node kind = first_element(type);
    const std::string_view name = kind.name();
    if (depth > deepest_type)
        return out_.add(code::too_deep_or_large, file_.mark_of_tag(kind),
                        fmt::format("types are nested deeper than {} levels", deepest_type));
    if (!kind)
        return out_.add(code::not_an_object, file_.mark_of_tag(type ? type : file_.root()),
                        "a type has no element", "such as <INT/> or <derived name=\"T\"/>");
    if (name == "derived") return file_.copy(text_, kind.attribute("name"));
    if (name == "array") return add_array(kind, depth + 1);
    if (name == "struct") return add_struct(kind, depth + 1);
    if (name == "enum") return add_enumeration(kind);
    if (name.starts_with("subrange")) return add_subrange(kind, depth + 1);
    if (name == "string" || name == "wstring") return add_text_type(kind);
    if (name == "pointer" || name == "reference") {
        write(name == "pointer" ? "POINTER TO " : "REFERENCE TO ", kind);
        return add_type_of(kind.child("baseType"), depth + 1);
    }
    const Part tag = file_.tag(kind);
    file_.copy(text_, Part{tag.begin + 1, tag.end});
}

void PlcopenText::add_array(pugi::xml_node array, int depth) {
    write("ARRAY[", array);
    std::string_view before;
    for (const pugi::xml_node dimension : array.children("dimension")) {
        write(before, dimension);
        file_.copy(text_, dimension.attribute("lower"));
        write("..", dimension);
        file_.copy(text_, dimension.attribute("upper"));
        before = ", ";
    }
    write("] OF ", array);
    add_type_of(array.child("baseType"), depth);
}

void PlcopenText::add_struct(pugi::xml_node structure, int depth) {
    if (depth > 1)
        return out_.add(code::not_supported, file_.mark_of_tag(structure),
                        "a structure has a name of its own here",
                        "declare it as a data type, and name that");
    write("STRUCT\n", structure);
    for (const pugi::xml_node variable : structure.children("variable")) add_variable(variable);
    write("END_STRUCT", structure);
}

void PlcopenText::add_enumeration(pugi::xml_node enumeration) {
    write("(", enumeration);
    std::string_view before;
    for (const pugi::xml_node value : enumeration.child("values").children("value")) {
        write(before, value);
        file_.copy(text_, value.attribute("name"));
        if (const pugi::xml_attribute number = value.attribute("value")) {
            write(" := ", value);
            file_.copy(text_, number);
        }
        before = ", ";
    }
    write(")", enumeration);
    if (const pugi::xml_node base = enumeration.child("baseType")) {
        write(" ", base);
        add_type_of(base, 0);
    }
}

void PlcopenText::add_subrange(pugi::xml_node subrange, int depth) {
    const pugi::xml_node range = subrange.child("range");
    add_type_of(subrange.child("baseType"), depth);
    write("(", subrange);
    file_.copy(text_, range.attribute("lower"));
    write("..", subrange);
    file_.copy(text_, range.attribute("upper"));
    write(")", subrange);
}

void PlcopenText::add_text_type(pugi::xml_node type) {
    write(upper(std::string_view(type.name())), type);
    const pugi::xml_attribute length = type.attribute("length");
    if (!length) return;
    write("[", type);
    file_.copy(text_, length);
    write("]", type);
}

void PlcopenText::add_value(pugi::xml_node value, int depth) {
    if (depth > deepest_type)
        return out_.add(code::too_deep_or_large, file_.mark_of_tag(value),
                        fmt::format("values are nested deeper than {} levels", deepest_type));
    if (const pugi::xml_node simple = value.child("simpleValue"))
        return file_.copy(text_, simple.attribute("value"));
    if (const pugi::xml_node array = value.child("arrayValue")) {
        write("[", array);
        add_list(array, "repetitionValue", depth + 1);
        return write("]", array);
    }
    const pugi::xml_node structure = value.child("structValue");
    write("(", value);
    add_list(structure, "member", depth + 1);
    write(")", value);
}

/// `3(0), 1` of an array, `x := 1, y := 2` of a structure.
void PlcopenText::add_list(pugi::xml_node values, const char* key, int depth) {
    const bool is_array = std::string_view(key) == "repetitionValue";
    std::string_view before;
    for (const pugi::xml_node value : values.children("value")) {
        write(before, value);
        const pugi::xml_attribute first = value.attribute(key);
        const bool is_repeated = first && is_array;
        file_.copy(text_, first);
        if (first) write(is_array ? "(" : " := ", value);
        add_value(value, depth);
        if (is_repeated) write(")", value);
        before = ", ";
    }
}

BodyText PlcopenText::body_of(pugi::xml_node owner, pugi::xml_node named) {
    BodyContext context{file_,       out_,     NetworkTypes(declared_, pou_),
                        *variables_, is_kept_, is_of_matiec_};
    BodyText all;
    for (const pugi::xml_node body : owner.children("body")) {
        const BodyText made = body_text(context, body, file_.plain(named.attribute("name")));
        all.members.append(made.members);
        all.statements.append(made.statements);
    }
    return all;
}

void PlcopenText::add_body(pugi::xml_node owner, pugi::xml_node named) {
    const BodyText body = body_of(owner, named);
    text_.append(body.members);
    text_.append(body.statements);
}

/// `rest` stands behind the declarations, which those of its networks follow.
void PlcopenText::add_variables(const MadeVariables& made, Excerpts rest, pugi::xml_node owner) {
    if (!made.declarations().empty())
        write(fmt::format("VAR\n{}END_VAR\n", made.declarations()), owner);
    text_.append(rest);
}

void PlcopenText::add_member(pugi::xml_node member) {
    const bool is_method = std::string_view(member.name()) == "Method";
    const pugi::xml_node interface = member.child("interface");
    if (!is_method) {
        const BodyText body = body_of(member, member);
        text_.append(body.members);
        write("ACTION ", member);
        file_.copy(text_, member.attribute("name"));
        write(":\n", member);
        text_.append(body.statements);
        return write("END_ACTION\n", member);
    }
    if (!add_plain(member)) {
        write("METHOD ", member);
        file_.copy(text_, member.attribute("name"));
        if (const pugi::xml_node result = interface.child("returnType")) {
            write(" : ", result);
            add_type_of(result, 0);
        }
        write("\n", member);
        add_interface(interface);
    }
    add_own_body(member, member);
    write("END_METHOD\n", member);
}

/// Adds the body of what declares variables that are gone when it returns.
void PlcopenText::add_own_body(pugi::xml_node owner, pugi::xml_node named) {
    MadeVariables variables;
    const auto outer =
        std::make_pair(std::exchange(variables_, &variables), std::exchange(is_kept_, false));
    Excerpts head = std::exchange(text_, {});
    add_body(owner, named);
    Excerpts rest = std::exchange(text_, std::move(head));
    add_variables(variables, std::move(rest), owner);
    std::tie(variables_, is_kept_) = outer;
}

void PlcopenText::add_property(pugi::xml_node property) {
    const pugi::xml_node interface = property.child("interface");
    if (!add_plain(property)) {
        write("PROPERTY ", property);
        file_.copy(text_, property.attribute("name"));
        write(" : ", property);
        add_type_of(interface.child("returnType"), 0);
        write("\n", property);
    }
    for (const auto& [element, word] : {Term{"GetAccessor", "GET"}, Term{"SetAccessor", "SET"}}) {
        const pugi::xml_node accessor = property.child(element.data());
        if (!accessor) continue;
        write(fmt::format("{}\n", word), accessor);
        if (!add_plain(accessor)) add_interface(accessor.child("interface"));
        add_own_body(accessor, property);
        write(fmt::format("END_{}\n", word), accessor);
    }
    write("END_PROPERTY\n", property);
}

void PlcopenText::add_data(pugi::xml_node owner) {
    for (const pugi::xml_node data : owner.child("addData").children("data"))
        for (const pugi::xml_node member : data.children()) {
            const std::string_view kind = member.name();
            if (kind == "Method") add_member(member);
            if (kind == "Property") add_property(member);
        }
}

void PlcopenText::add_pou(pugi::xml_node pou) {
    const std::string type = file_.plain(pou.attribute("pouType"));
    const std::string_view kind = term_of(pou_kinds, type);
    if (kind.empty())
        return out_.add(code::not_an_object, file_.mark_of_tag(pou),
                        fmt::format("'{}' is no kind of POU", type),
                        "pouType is function, functionBlock or program");
    const pugi::xml_node interface = pou.child("interface");
    if (!add_plain(pou)) {
        write(fmt::format("{} ", kind), pou);
        file_.copy(text_, pou.attribute("name"));
        add_inheritance(pou);
        if (const pugi::xml_node result = interface.child("returnType")) {
            write(" : ", result);
            add_type_of(result, 0);
        }
        write("\n", pou);
        add_interface(interface);
    }
    MadeVariables variables;
    variables_ = &variables;
    is_kept_ = kind != "FUNCTION";
    pou_ = file_.plain(pou.attribute("name"));
    Excerpts head = std::exchange(text_, {});
    add_data(pou);
    for (const pugi::xml_node action : pou.child("actions").children("action")) add_member(action);
    add_body(pou, pou);
    Excerpts rest = std::exchange(text_, std::move(head));
    add_variables(variables, std::move(rest), pou);
    write(fmt::format("END_{}\n", kind), pou);
}

void PlcopenText::add_interface_of_blocks(pugi::xml_node interface) {
    if (!add_plain(interface)) {
        write("INTERFACE ", interface);
        file_.copy(text_, interface.attribute("name"));
        add_inheritance(interface);
        write("\n", interface);
    }
    for (const pugi::xml_node method : interface.child("Methods").children("Method"))
        add_member(method);
    for (const pugi::xml_node property : interface.child("Properties").children("Property"))
        add_property(property);
    write("END_INTERFACE\n", interface);
}

void PlcopenText::add_attributes(pugi::xml_node element) {
    const auto value_of = [&](const char* name) {
        return addition_of(element, "Attributes")
            .find_child_by_attribute("Attribute", "Name", name);
    };
    for (const char* name : {"qualified_only", "strict", "to_string"})
        if (value_of(name)) write(fmt::format("{{attribute '{}'}}\n", name), element);
    const std::string mode = file_.plain(value_of("pack_mode").attribute("Value"));
    if (!mode.empty() && std::ranges::all_of(mode, is_digit))
        write(fmt::format("{{attribute 'pack_mode' := '{}'}}\n", mode), element);
}

void PlcopenText::add_type(pugi::xml_node type) {
    if (add_plain(type)) return;
    add_attributes(type);
    write("TYPE ", type);
    file_.copy(text_, type.attribute("name"));
    add_inheritance(type);
    add_declared(type, "baseType");
    write(";\nEND_TYPE\n", type);
}

void PlcopenText::add_union(pugi::xml_node type) {
    if (add_plain(type)) return;
    add_attributes(type);
    write("TYPE ", type);
    file_.copy(text_, type.attribute("name"));
    write(" : UNION\n", type);
    for (const pugi::xml_node variable : type.children("variable")) add_variable(variable);
    write("END_UNION\nEND_TYPE\n", type);
}

void PlcopenText::add_globals(pugi::xml_node list) {
    if (add_plain(list)) return;
    for (const pugi::xml_node part : lists_of(list)) {
        add_attributes(list);
        add_section(part, "VAR_GLOBAL");
    }
}

}  // namespace lineshaft::projects
