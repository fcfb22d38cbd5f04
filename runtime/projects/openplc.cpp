#include "runtime/projects/openplc.hpp"

#include <algorithm>
#include <fstream>
#include <set>

#include <fmt/format.h>

#include "runtime/projects/drawings/rung_graphs.hpp"
#include "runtime/projects/plcopen.hpp"
#include "runtime/projects/xml.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"
#include "runtime/source/yaml.hpp"
#include "runtime/st/syntax/cursor.hpp"
#include "runtime/st/syntax/dialect.hpp"

namespace lineshaft::projects {

namespace fs = std::filesystem;

namespace {

using st::Word;

constexpr YamlLimits json_limits{.bytes = 16U << 20, .nodes = 2'000'000};
constexpr const char* sources_of_projects[] = {"pous", "datatypes"};

/// The folder of the project that a file stands below; empty: none.
fs::path project_of(const fs::path& file) {
    std::error_code unknown;
    for (fs::path at = file.parent_path();; at = at.parent_path()) {
        const fs::path listed = at / "project.json";
        if (fs::exists(listed, unknown) && is_openplc_project(listed)) return listed;
        if (!at.has_relative_path()) return {};
    }
}

/// One element of the XML for each of a list.
class ProjectText {
  public:
    Excerpts read(const Node& project) {
        const Node* data = project.find("data");
        const Node* configuration = data ? data->find("configuration") : nullptr;
        const Node* resource = configuration ? configuration->find("resource") : nullptr;
        write("<project><types><dataTypes>", project.mark);
        if (data)
            for (const Node& type : list(*data, "dataTypes")) add_type(type);
        write("</dataTypes></types><instances><configurations><configuration><resource>",
              project.mark);
        if (resource) {
            add_tasks(*resource);
            write("<globalVars>", resource->mark);
            for (const Node& variable : list(*resource, "globalVariables")) add_variable(variable);
            write("</globalVars>", resource->mark);
        }
        write("</resource></configuration></configurations></instances></project>", project.mark);
        return std::move(made_);
    }

    static const std::vector<Node>& list(const Node& of, std::string_view key) {
        static const std::vector<Node> none;
        const Node* found = of.find(key);
        return found ? found->items : none;
    }

  private:
    void write(std::string_view words, const Mark& place) { made_.write(words, place); }

    void add(const char* attribute, const Node* value) {
        if (value && !value->text.empty())
            write(fmt::format(" {}=\"{}\"", attribute, as_xml(value->text)), value->mark);
    }

    void add_tasks(const Node& resource) {
        for (const Node& task : list(resource, "tasks")) {
            const Node *name = task.find("name"), *triggering = task.find("triggering");
            write("<task", task.mark);
            add("name", name);
            if (!triggering || triggering->text == "Cyclic") add("interval", task.find("interval"));
            add("priority", task.find("priority"));
            write(">", task.mark);
            for (const Node& instance : list(resource, "instances")) {
                const Node* of = instance.find("task");
                if (!of || !name || !st::same_name(of->text, name->text)) continue;
                write("<pouInstance", instance.mark);
                add("name", instance.find("name"));
                add("typeName", instance.find("program"));
                write("/>", instance.mark);
            }
            write("</task>", task.mark);
        }
    }

    void add_variable(const Node& variable) {
        write("<variable", variable.mark);
        add("name", variable.find("name"));
        add("address", variable.find("location"));
        write("><type>", variable.mark);
        add_type_named(variable.find("type"), variable.mark);
        write("</type>", variable.mark);
        add_value(variable);
        write("</variable>", variable.mark);
    }

    /// `{"definition": "base-type", "value": "INT"}`, of arrays `ARRAY [0..9] OF INT`.
    void add_type_named(const Node* type, const Mark& place) {
        write("<derived", place);
        add("name", type ? type->find("value") : nullptr);
        write("/>", place);
    }

    /// A text, of what is in a structure `{"simpleValue": {"value": "5"}}`.
    void add_value(const Node& of) {
        const Node* value = of.find("initialValue");
        if (const Node* simple = value ? value->find("simpleValue") : nullptr)
            value = simple->find("value");
        if (!value || value->text.empty()) return;
        write("<initialValue><simpleValue", value->mark);
        add("value", value);
        write("/></initialValue>", value->mark);
    }

    void add_type(const Node& type) {
        write("<dataType", type.mark);
        add("name", type.find("name"));
        write("><baseType>", type.mark);
        const Node* derivation = type.find("derivation");
        const std::string_view kind = derivation ? std::string_view(derivation->text) : "";
        if (kind == "enumerated") {
            write("<enum><values>", type.mark);
            for (const Node& value : list(type, "values")) {
                write("<value", value.mark);
                add("name", value.find("description"));
                write("/>", value.mark);
            }
            write("</values></enum>", type.mark);
        } else if (kind == "structure") {
            write("<struct>", type.mark);
            for (const Node& member : list(type, "variable")) add_variable(member);
            write("</struct>", type.mark);
        } else {
            add_array(type);
        }
        write("</baseType>", type.mark);
        add_value(type);
        write("</dataType>", type.mark);
    }

    void add_array(const Node& type) {
        write("<array>", type.mark);
        for (const Node& each : list(type, "dimensions")) {
            const Node* range = each.find("dimension");
            if (!range) continue;
            const std::size_t dots = range->text.find("..");
            write(
                fmt::format(
                    "<dimension lower=\"{}\" upper=\"{}\"/>", as_xml(range->text.substr(0, dots)),
                    as_xml(dots == std::string::npos ? range->text : range->text.substr(dots + 2))),
                range->mark);
        }
        write("<baseType>", type.mark);
        add_type_named(type.find("baseType"), type.mark);
        write("</baseType></array>", type.mark);
    }

    Excerpts made_;
};

/// The mistakes of the text that it was made of are those of what it has.
void add_plcopen(const Reading& to, const std::shared_ptr<const SourceFile>& xml) {
    const std::size_t before = to.project.sources.size();
    if (const auto file = XmlFile::parse(xml, to.out)) read_plcopen_of_matiec(to, *file);
    if (xml->mistakes.empty()) return;
    for (std::size_t i = before; i < to.project.sources.size(); ++i) {
        SourceFile made = *to.project.sources[i];
        made.mistakes.insert(made.mistakes.begin(), xml->mistakes.begin(), xml->mistakes.end());
        to.project.sources[i] = std::make_shared<const SourceFile>(std::move(made));
    }
}

/// What such a project keeps in `project.json` itself was another editor's.
void refuse_inside(const Reading& to, const Node& project) {
    const Node* data = project.find("data");
    if (!data) return;
    if (const auto& inside = ProjectText::list(*data, "pous"); !inside.empty())
        to.out.add(code::not_supported, inside.front().mark, "POUs in project.json are not read",
                   "save each in a file below pous/, or export the project as PLCopen XML");
}

/// The declarations of a POU, whose addresses stand behind the types there.
class Declarations {
  public:
    explicit Declarations(const std::shared_ptr<const SourceFile>& file) : text_(file) {
        Diagnostics told_by_who_compiles;
        static_cast<st::Tokens&>(p_) = st::read_tokens(file, told_by_who_compiles);
        while (!p_.is(Word::end_of_file) && !is_kind()) p_.take();
        kind_ = p_.take().word;
        name_ = p_.here();
    }

    /// The kind of POU in PLCopen XML.
    std::string_view kind() const {
        return kind_ == Word::program_          ? "program"
               : kind_ == Word::function_block_ ? "functionBlock"
                                                : "function";
    }
    const st::Token& name() const { return name_; }

    /// All of the text, with addresses where the language has them. `variables`: as elements of
    /// XML, whose types a drawing asks for.
    Excerpts read(std::string& variables) {
        for (; !p_.is(Word::end_of_file); p_.take()) {
            if (p_.is(Word::semicolon)) colon_ = {};
            if (p_.is(Word::at_) && colon_.end != 0) move_address();
            if (!p_.is(Word::colon)) continue;
            colon_ = p_.here().place;
            const std::string type =
                fmt::format("<derived name=\"{}\"/>", as_xml(p_.next().place.text()));
            if (p_.last().place.begin == name_.place.begin)
                variables = fmt::format("<returnType>{}</returnType>", type) + variables;
            else
                variables += fmt::format("<variable name=\"{}\"><type>{}</type></variable>",
                                         as_xml(p_.last().text), type);
        }
        made_.copy_to(text_, copied_, text_.text().size());
        return std::move(made_);
    }

  private:
    bool is_kind() const {
        return p_.is(Word::program_) || p_.is(Word::function_block_) || p_.is(Word::function_);
    }

    void move_address() {
        const st::Place at = p_.here().place;
        if (colon_.begin < copied_) return;
        made_.copy_to(text_, copied_, colon_.begin);
        made_.write(" ", at.mark());
        made_.copy(text_, {at.begin, p_.next().place.end});
        made_.write(" ", at.mark());
        made_.copy_to(text_, copied_, at.begin);
        copied_ = p_.next().place.end;
    }

    PlacedFile text_;
    st::Cursor p_;
    Word kind_ = Word::end_of_file;
    st::Token name_;
    st::Place colon_;
    std::size_t copied_ = 0;
    Excerpts made_;
};

std::shared_ptr<const SourceFile> with_text(const SourceFile& file, std::string text) {
    SourceFile made = file;
    made.text = std::move(text);
    return std::make_shared<const SourceFile>(std::move(made));
}

/// Blanks, in as many lines.
std::string blanked(std::string_view text) {
    std::string made(text);
    std::ranges::replace_if(
        made, [](char c) { return c != '\n'; }, ' ');
    return made;
}

void read_ladder(const Reading& to, const std::shared_ptr<const SourceFile>& source) {
    const std::string_view text = source->text;
    const std::size_t begin = text.find("\n{\n"), end = text.rfind("\n}");
    if (begin == text.npos || end == text.npos || end < begin)
        return to.out.add(code::not_an_object, {source, 1, 1, 1}, "a ladder has no rungs here",
                          "they are an object of JSON behind the declarations");
    const auto ladder =
        parse_yaml(with_text(*source, blanked(text.substr(0, begin)) +
                                          std::string(text.substr(begin, end + 2 - begin))),
                   to.out, json_limits);
    if (!ladder) return;
    Declarations declarations(with_text(*source, std::string(text.substr(0, begin + 1))));
    std::string variables;
    const Excerpts declared = declarations.read(variables);
    const Mark place = declarations.name().place.mark();
    const std::size_t behind_result =
        variables.starts_with("<returnType>") ? variables.find("</returnType>") + 13 : 0;
    Excerpts xml;
    xml.write("<project><types><pous><pou", place);
    xml.write(fmt::format(" name=\"{}\" pouType=\"{}\"><interface>{}<localVars>{}</localVars>",
                          declarations.name().text, declarations.kind(),
                          variables.substr(0, behind_result), variables.substr(behind_result)),
              place);
    xml.write("</interface><InterfaceAsPlainText><xhtml><![CDATA[", place);
    xml.append(declared);
    xml.write("]]></xhtml></InterfaceAsPlainText><body>", place);
    Diagnostics drawn;
    xml.append(ladder_of_rungs(*ladder, drawn));
    xml.write("</body></pou></pous></types></project>", place);
    add_plcopen(to, xml.finish(source->path, {}, drawn));
}

/// In C++ or Python: its pins are here, and do nothing.
void read_pins(const Reading& to, const SourceFile& file) {
    constexpr std::string_view last = "END_VAR";
    const std::size_t end = file.text.rfind(last);
    if (end == file.text.npos) return;
    std::string variables;
    Declarations declarations(
        with_text(file, file.text.substr(0, end + last.size()) + "\nEND_FUNCTION_BLOCK\n"));
    SourceFile made = *declarations.read(variables).finish(file.path);
    made.read_as = ".matiec";
    to.project.add(std::make_shared<const SourceFile>(std::move(made)));
    to.out.warn(code::not_supported, declarations.name().place.mark(),
                fmt::format("'{}' is written in {}, so this does nothing", declarations.name().text,
                            extension_of(file.path) == ".py" ? "Python" : "C++"),
                "write what the program needs of it in Structured Text");
}

}  // namespace

bool is_openplc_project(const fs::path& file) {
    if (lower(file.filename().string()) != "project.json") return false;
    std::string start(4096, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    return start.find("\"plc-project\"") != std::string::npos;
}

bool is_openplc_pou(const fs::path& file) {
    constexpr std::string_view endings[] = {".st", ".ld", ".fbd", ".sfc", ".il", ".cpp", ".py"};
    if (std::ranges::none_of(endings, [&](auto e) { return extension_of(file) == e; }))
        return false;
    const fs::path project = project_of(file);
    return !project.empty() &&
           file.string().starts_with((project.parent_path() / "pous" / "").string());
}

bool is_left_to_openplc(const fs::path& file) {
    const fs::path project = project_of(file);
    constexpr const char* folders[] = {"pous", "datatypes", "build"};
    return !project.empty() && std::ranges::any_of(folders, [&](const char* folder) {
        return file.string().starts_with((project.parent_path() / folder / "").string());
    });
}

void read_openplc_project(const Reading& to, const std::string& path, const Mark& where) {
    const auto source = read_source(path, to.out, where, json_limits);
    if (!source) return;
    const auto project = parse_yaml(source, to.out, json_limits);
    if (!project) return;
    refuse_inside(to, *project);
    std::vector<std::string> files;
    std::error_code error;
    for (const char* folder : sources_of_projects)
        for (fs::recursive_directory_iterator entry(fs::path(path).parent_path() / folder, error),
             end;
             !error && entry != end; entry.increment(error))
            if (is_openplc_pou(entry->path()) || extension_of(entry->path()) == ".st")
                files.push_back(entry->path().string());
    std::ranges::sort(files);
    for (const std::string& file : files)
        if (const auto allowed = to.resolve(file, where, to.out)) read_sources(to, *allowed, where);
    add_plcopen(to, ProjectText().read(*project).finish(source->path));
}

void read_openplc_pou(const Reading& to, const std::string& path, const Mark& where) {
    const auto source = read_source(path, to.out, where, json_limits);
    if (!source) return;
    if (extension_of(path) == ".ld") return read_ladder(to, source);
    if (extension_of(path) == ".cpp" || extension_of(path) == ".py") return read_pins(to, *source);
    if (extension_of(path) != ".st")
        return to.out.add(code::not_supported, {source, 1, 1, 1},
                          "only ladders and Structured Text of OpenPLC Editor 4 are read",
                          "export the project as PLCopen XML");
    std::string variables;
    SourceFile made = *Declarations(source).read(variables).finish(source->path);
    made.read_as = ".matiec";
    to.project.add(std::make_shared<const SourceFile>(std::move(made)));
}

}  // namespace lineshaft::projects
