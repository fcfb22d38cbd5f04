#include "runtime/projects/twincat.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/box_trees.hpp"
#include "runtime/projects/drawings/function_charts.hpp"
#include "runtime/projects/drawings/step_charts.hpp"
#include "runtime/projects/event_classes.hpp"
#include "runtime/projects/xml.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"
#include "runtime/st/syntax/lexer.hpp"
#include "runtime/st/syntax/list_properties.hpp"
#include "runtime/st/syntax/words.hpp"

namespace lineshaft::projects {

namespace {

namespace fs = std::filesystem;
using st::Word;

/// What a declaration declares: its first word, behind comments and attributes.
Word declared_kind(const XmlFile& file, pugi::xml_node declaration) {
    static constexpr Word kinds[] = {Word::program_, Word::function_block_, Word::function_,
                                     Word::interface_, Word::class_};
    Diagnostics unread;
    const auto text =
        std::make_shared<const SourceFile>(SourceFile{"", file.plain(declaration) + "\n"});
    for (const st::Token& token : st::read_tokens(text, unread).tokens)
        if (std::ranges::find(kinds, token.word) != std::end(kinds)) return token.word;
    return Word::end_of_file;
}

/// The variables of a declaration, and their types as they are written; in one line each.
void know_declared(MadeVariables& variables, const XmlFile& file, pugi::xml_node declaration) {
    Diagnostics unread;
    const auto text =
        std::make_shared<const SourceFile>(SourceFile{"", file.plain(declaration) + "\n"});
    const auto tokens = st::read_tokens(text, unread).tokens;
    std::vector<std::string_view> names;
    for (auto it = tokens.begin(); it + 1 < tokens.end(); ++it) {
        const Word next = (it + 1)->word;
        if (st::is_name(it->word) && (next == Word::colon || next == Word::comma)) {
            names.push_back(it->text);
            continue;
        }
        if (it->word == Word::comma) continue;
        const auto end = std::find_if(it + 1, tokens.end(), [&](const st::Token& token) {
            return token.word == Word::assign || token.word == Word::semicolon ||
                   token.first_in_line;
        });
        const bool is_type = it->word == Word::colon && end != tokens.end() && !end->first_in_line;
        const std::size_t begin = (it + 1)->place.begin;
        for (const std::string_view name : names)
            if (is_type)
                variables.know(
                    name, std::string_view(text->text).substr(begin, end->place.begin - begin));
        names.clear();
    }
}

/// Writes one object's text.
class ObjectText {
  public:
    explicit ObjectText(const XmlFile& file) : file_(file) {}

    /// POU and interface, with what it has inside before its body.
    void add_unit(pugi::xml_node unit) {
        const pugi::xml_node declaration = unit.child("Declaration");
        const Word kind = declared_kind(file_, declaration);
        if (kind == Word::end_of_file) {
            out_.add(code::not_an_object, file_.mark_of_tag(unit),
                     fmt::format("'{}' declares neither a program nor a block, a function or an "
                                 "interface",
                                 name(unit)),
                     "its Declaration begins with PROGRAM, FUNCTION_BLOCK, FUNCTION or INTERFACE");
            return;
        }
        add_lines(declaration);
        add_with_variables(unit, kind != Word::function_, [&] {
            for (const pugi::xml_node part : unit.children()) add_member(part);
            add_body(unit, unit);
        });
        add_end(fmt::format("END_{}", st::shown(kind)), unit);
    }

    /// A type or a list of globals, which its declaration is all of but for a list's properties.
    void add_declaration(pugi::xml_node object) {
        add_lines(object.child("Declaration"));
        if (!object.child("Property")) return;
        const std::string block = fmt::format("{}_{}", st::list_properties, name(object));
        add_end(fmt::format("VAR_GLOBAL\n{} : {};\nEND_VAR", st::list_properties, block), object);
        add_end(fmt::format("FUNCTION_BLOCK {}", block), object);
        for (const pugi::xml_node property : object.children("Property")) add_property(property);
        add_end("END_FUNCTION_BLOCK", object);
    }

    std::shared_ptr<const SourceFile> finish(std::string part) {
        return text_.finish(file_.file()->path, std::move(part), out_);
    }

  private:
    std::string name(pugi::xml_node element) const {
        return file_.plain(element.attribute("Name"));
    }

    void add_lines(pugi::xml_node element) {
        if (!element) return;
        file_.copy(text_, element);
        text_.write("\n", file_.mark_of_tag(element));
    }

    void add_end(std::string_view word, pugi::xml_node element) {
        text_.write(fmt::format("{}\n", word), file_.mark_of_tag(element));
    }

    void add_member(pugi::xml_node part) {
        const std::string_view kind = part.name();
        if (kind == "Method") return add_routine(part, part, "END_METHOD");
        if (kind == "Property") return add_property(part);
        if (kind == "Transition") return add_transition(part);
        if (kind != "Action") return;
        text_.write("ACTION ", file_.mark_of_tag(part));
        file_.copy(text_, part.attribute("Name"));
        text_.write(":\n", file_.mark_of_tag(part));
        add_lines(part.child("Declaration"));
        add_body(part, part);
        add_end("END_ACTION", part);
    }

    /// A condition, as a method that says whether it holds.
    void add_transition(pugi::xml_node transition) {
        const Mark place = file_.mark_of_tag(transition);
        text_.write("METHOD ", place);
        file_.copy(text_, transition.attribute("Name"));
        text_.write(" : BOOL\n", place);
        const std::string body = file_.plain(transition.child("Implementation").child("ST"));
        const bool is_expression = !body.empty() && body.find(":=") == std::string::npos;
        if (is_expression) {
            file_.copy(text_, transition.attribute("Name"));
            text_.write(" := ", place);
        }
        add_body(transition, transition);
        add_end(is_expression && !body.ends_with(';') ? ";\nEND_METHOD" : "END_METHOD", transition);
    }

    void add_routine(pugi::xml_node routine, pugi::xml_node named, std::string_view end) {
        add_lines(routine.child("Declaration"));
        add_with_variables(routine, false, [&] { add_body(routine, named); });
        add_end(end, routine);
    }

    /// What `add` writes, behind the variables that its drawn bodies have of their own. `is_kept`:
    /// they keep their values from scan to scan.
    template <class Add>
    void add_with_variables(pugi::xml_node owner, bool is_kept, Add add) {
        MadeVariables variables;
        know_declared(variables, file_, owner.child("Declaration"));
        const auto outer = std::exchange(variables_, &variables);
        const bool was_kept = std::exchange(is_kept_, is_kept);
        const Excerpts before = std::exchange(text_, {});
        add();
        const Excerpts rest = std::exchange(text_, before);
        if (!variables.declarations().empty())
            text_.write(fmt::format("VAR\n{}END_VAR\n", variables.declarations()),
                        file_.mark_of_tag(owner));
        text_.append(rest);
        variables_ = outer;
        is_kept_ = was_kept;
    }

    void add_property(pugi::xml_node property) {
        add_lines(property.child("Declaration"));
        const auto add = [&](const char* element, std::string_view begin, std::string_view end) {
            const pugi::xml_node accessor = property.child(element);
            if (!accessor) return;
            add_end(begin, accessor);
            add_routine(accessor, property, end);
        };
        add("Get", "GET", "END_GET");
        add("Set", "SET", "END_SET");
        add_end("END_PROPERTY", property);
    }

    /// `named` is what a message calls it.
    void add_body(pugi::xml_node routine, pugi::xml_node named) {
        const pugi::xml_node implementation = routine.child("Implementation");
        for (const pugi::xml_node body : implementation.children()) {
            if (body.type() != pugi::node_element) continue;
            const std::string_view kind = body.name();
            if (kind == "ST")
                add_lines(body);
            else if (kind == "NWL")
                text_.append(text_of_box_trees(file_, out_, *variables_, is_kept_, body));
            else if (kind == "CFC")
                text_.append(text_of_function_chart(file_, out_, *variables_, is_kept_, body));
            else if (kind == "SFC")
                text_.append(text_of_step_chart(file_, out_, *variables_, body, unit_of(routine)));
            else
                out_.add(code::not_supported, file_.mark_of_tag(body),
                         fmt::format("the body of '{}' is drawn ({}), and only Structured Text, "
                                     "LD, FBD, SFC and CFC are read",
                                     name(named), kind),
                         "convert it to Structured Text in its editor, or leave it out");
        }
    }

    static pugi::xml_node unit_of(pugi::xml_node part) {
        while (part.parent() && std::string_view(part.name()) != "POU") part = part.parent();
        return part;
    }

    const XmlFile& file_;
    Diagnostics out_;
    Excerpts text_;
    MadeVariables* variables_ = nullptr;  ///< of drawn bodies, where they are declared
    bool is_kept_ = true;                 ///< from scan to scan
};

std::int64_t number_of(const XmlFile& file, pugi::xml_node element) {
    const std::string text = file.plain(element);
    std::int64_t value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

/// Cycle times are in microseconds.
ProjectTask task_of(const XmlFile& file, pugi::xml_node element) {
    constexpr std::int64_t longest_us = 86'400'000'000;
    ProjectTask task{
        .name = {file.plain(element.attribute("Name")), file.mark_of_tag(element)},
        .every = 1000 * std::clamp<std::int64_t>(number_of(file, element.child("CycleTime")), 0,
                                                 longest_us),
        .priority = number_of(file, element.child("Priority"))};
    for (const pugi::xml_node call : element.children("PouCall"))
        task.programs.push_back(
            {{file.plain(call.child("Name")), file.mark_of_tag(call.child("Name"))}});
    return task;
}

/// `TcUnit` of `TcUnit,1.2.0.0,www.tcunit.org`.
std::string before_comma(const std::string& reference) {
    return reference.substr(0, reference.find(','));
}

/// A project does not list projects.
bool is_same_form(const fs::path& a, const fs::path& b) {
    return extension_of(a) == extension_of(b);
}

/// MSBuild writes `%28` for a bracket in a name.
std::string unescaped(std::string name) {
    for (std::size_t at = name.find('%'); at != std::string::npos; at = name.find('%', at + 1)) {
        unsigned letter = 0;
        const char *digits = name.data() + at + 1, *end = digits + 2;
        if (at + 2 < name.size() && std::from_chars(digits, end, letter, 16).ptr == end)
            name.replace(at, 3, 1, static_cast<char>(letter));
    }
    return name;
}

}  // namespace

std::string path_beside(const fs::path& named_by, std::string text) {
    std::ranges::replace(text, '\\', '/');
    std::error_code unknown;
    const fs::path folder = named_by.parent_path();
    const fs::path path = (folder / text).lexically_normal();
    if (fs::exists(path, unknown)) return path.string();
    fs::path found = folder;
    for (const fs::path& step : fs::path(text).lexically_normal()) {
        fs::path next = found / step;
        if (!fs::exists(next, unknown))
            for (const auto& entry : fs::directory_iterator(found.empty() ? "." : found, unknown))
                if (lower(entry.path().filename().string()) == lower(step.string()))
                    next = found / entry.path().filename();
        found = next;
    }
    return fs::exists(found, unknown) ? found.lexically_normal().string() : path.string();
}

void add_twincat_objects(const Reading& to, const XmlFile& file, std::string_view read_as) {
    for (const pugi::xml_node object : file.root().children()) {
        const std::string_view kind = object.name();
        if (kind == "Task") to.project.tasks.push_back(task_of(file, object));
        const bool is_unit = kind == "POU" || kind == "Itf";
        if (!is_unit && kind != "DUT" && kind != "GVL" && kind != "EnumerationTextList") continue;
        ObjectText text(file);
        if (is_unit)
            text.add_unit(object);
        else
            text.add_declaration(object);
        SourceFile made = *text.finish(file.plain(object.attribute("Name")));
        made.read_as = read_as;
        to.project.add(std::make_shared<const SourceFile>(std::move(made)));
    }
}

void read_twincat_object(const Reading& to, const std::string& path, const Mark& where) {
    const auto file = XmlFile::read(path, to.out, where);
    if (!file) return;
    const pugi::xml_node root = file->root();
    if (std::string_view(root.name()) != "TcPlcObject")
        return to.out.add(code::not_an_object, file->mark_of_tag(root),
                          fmt::format("<{}> is no object of TwinCAT", root.name()),
                          "its files begin with <TcPlcObject>");
    add_twincat_objects(to, *file);
}

void read_plcproj(const Reading& to, const std::string& path, const Mark& where) {
    const auto file = XmlFile::read(path, to.out, where);
    if (!file) return;
    for (const pugi::xml_node group : file->root().children("ItemGroup"))
        for (const pugi::xml_node item : group.children()) {
            const pugi::xml_attribute include = item.attribute("Include");
            const Mark mark = file->mark(file->part(include));
            const std::string_view kind = item.name();
            if (kind == "PlaceholderReference" || kind == "LibraryReference")
                to.project.libraries.push_back({before_comma(file->plain(include)), mark});
            if (kind != "Compile") continue;
            const std::string named = path_beside(path, unescaped(file->plain(include)));
            if (!is_source(named) || is_same_form(named, path)) continue;
            if (const auto allowed = to.resolve(named, mark, to.out))
                read_sources(to, *allowed, mark);
        }
    read_event_classes(to, path, where);
}

}  // namespace lineshaft::projects
