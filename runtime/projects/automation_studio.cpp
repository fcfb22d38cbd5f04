#include "runtime/projects/automation_studio.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <span>

#include <fmt/format.h>

#include "runtime/projects/drawings/grids.hpp"
#include "runtime/projects/packages.hpp"
#include "runtime/projects/xml.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"
#include "runtime/source/yaml.hpp"
#include "runtime/st/syntax/lexer.hpp"

namespace lineshaft::projects {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view mapp_form = ".var";

/// Endings of files with statements that are not read; any other, a list of revisions, says nothing
/// of what runs.
constexpr std::string_view unread_languages[] = {".ab",  ".as",  ".c",  ".cfc",
                                                 ".cpp", ".fbd", ".il", ".sfc"};

std::string beginning_of(const fs::path& file) {
    std::string start(4096, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    return start;
}

struct MappType {
    std::string_view kind, type;
};

constexpr MappType types_of_elements[] = {{"assembly", "McAssemblyType"},
                                          {"assembly6d", "Mc6DAssemblyType"},
                                          {"axis", "McAxisType"},
                                          {"pickcore", "MpPickCoreType"},
                                          {"pickobjectlist", "MpPickObjectListType"},
                                          {"pickregister", "MpPickRegisterType"},
                                          {"processpoint", "McProcessPointType"},
                                          {"sector", "McSectorType"},
                                          {"segment", "McSegmentType"},
                                          {"trackingpath", "McTrackingPathType"},
                                          {"trafficmanager", "MpTrafficManagerType"},
                                          {"virtsegment", "McSegmentType"},
                                          {"visioncomponent", "ViComponentType"}};

/// What the list `processpointlist` or `trafficobjectlist` has, `<Selector
/// ID="ProcessPoint[0]">` and `<Selector ID="TrafficObject[1]" Value="Station">`, whose property
/// Name is the variable's.
constexpr MappType types_in_lists[] = {{"ProcessPoint", "McProcessPointType"},
                                       {"Path", "MpTrafficPathType"},
                                       {"Station", "MpTrafficStationType"},
                                       {"Waypoint", "MpTrafficWaypointType"}};

std::string_view find_type(std::span<const MappType> types, std::string_view kind) {
    const auto found = std::ranges::find(types, kind, &MappType::kind);
    return found == types.end() ? std::string_view{} : found->type;
}

std::string_view type_of_element(std::string_view kind) {
    const std::string_view type = find_type(types_of_elements, kind);
    if (!type.empty()) return type;
    return kind.starts_with("axesgroup") ? "McAxesGroupType" : "MpComIdentType";
}

/// A folder may be called as a word of the language.
bool is_one_name(const std::string& text) {
    Diagnostics unread;
    const auto file = std::make_shared<const SourceFile>(SourceFile{"name.prg", text});
    const auto tokens = st::read_tokens(file, unread).tokens;
    return tokens.size() == 2 && tokens[0].word == st::Word::name;
}

/// One program of Automation Studio.
class IecProgram {
  public:
    IecProgram(const XmlFile& list, const Reading& to) : list_(list), to_(to) {}

    void read() {
        for (const pugi::xml_node file : list_.root().child("Files").children("File"))
            add(list_.plain(file), list_, file);
        add_objects(list_, "");
        const Mark place = list_.mark_of_tag(list_.root());
        const std::string name = folder().filename().string();
        use_packages(place);
        for (const auto& [path, mark] : types_) add_types(path, mark);
        for (const auto& [path, mark] : functions_) add_functions(path, mark);
        add_function_bodies(place);
        Excerpts text;
        text.append(usings_);
        const char* const quote = is_one_name(name) ? "" : "\"";
        text.write(fmt::format("PROGRAM {0}{1}{0}\n", quote, name), place);
        text.append(variables_);
        if (has_start_) text.write("VAR _has_started : BOOL; END_VAR\n", place);
        if (!made_.declarations().empty())
            text.write("VAR\n" + made_.declarations() + "END_VAR\n", place);
        text.append(actions_);
        if (has_start_)
            text.write("IF NOT _has_started THEN _has_started := TRUE; _INIT(); END_IF\n", place);
        text.append(body_);
        text.write("END_PROGRAM\n", place);
        to_.project.add(text.finish(list_.file()->path, name, mistakes_));
    }

  private:
    fs::path folder() const {
        std::error_code unknown;
        return fs::absolute(list_.file()->path, unknown).lexically_normal().parent_path();
    }

    /// `Cyclic.st`, or `\Logical\Other\Cyclic.st` from the folder of the whole project.
    std::string path_of(std::string text) const {
        std::ranges::replace(text, '\\', '/');
        if (!text.starts_with('/'))
            return (fs::path(list_.file()->path).parent_path() / text).lexically_normal().string();
        text.erase(0, 1);
        const std::string first = fs::path(text).begin()->string();
        fs::path root = folder();
        while (root != root.root_path() && root.filename() != first) root = root.parent_path();
        fs::path made = (root.parent_path() / text).lexically_normal();
        std::error_code unknown;
        if (fs::path(list_.file()->path).is_relative())
            made = made.lexically_proximate(fs::current_path(unknown));
        return made.string();
    }

    /// Files and packages, which have such a list themselves; `folder` is where it stands.
    void add_objects(const XmlFile& list, const std::string& folder) {
        for (const pugi::xml_node object : list.root().child("Objects").children("Object")) {
            std::string named = list.plain(object);
            if (!named.starts_with('\\')) named.insert(0, folder);
            const std::string kind = list.plain(object.attribute("Type"));
            if (kind == "File") add(named, list, object);
            if (kind == "Package") add_package(named + "/", list.mark_of_tag(object));
        }
    }

    void add_package(const std::string& folder, const Mark& mark) {
        const auto path = to_.resolve(path_of(folder + "Package.pkg"), mark, mistakes_);
        if (!path || !packages_.insert(*path).second) return;
        if (const auto list = XmlFile::read(*path, mistakes_, mark)) add_objects(*list, folder);
    }

    void add(const std::string& named, const XmlFile& list, pugi::xml_node file) {
        const Mark mark = list.mark_of_tag(file);
        const std::string ending = extension_of(named);
        if (ending == ".uam") return;  // which methods OPC UA sees
        if (ending == ".ld") return add_ladders(named, mark);
        if (ending != ".st" && ending != ".var") {
            if (!is_structured_text(named)) return refuse(mark, named, ending);
            const auto path = to_.resolve(path_of(named), mark, mistakes_);
            const bool is_local = list.plain(file.attribute("Private")) == "true";
            if (!path) return;
            if (is_local && ending == ".typ")
                types_.emplace_back(*path, mark);
            else if (is_local && ending == ".fun")
                functions_.emplace_back(*path, mark);
            else
                read_sources(to_, *path, mark);
            return;
        }
        const auto path = to_.resolve(path_of(named), mark, mistakes_);
        auto source = path ? read_source(*path, mistakes_, mark) : nullptr;
        if (!source) return;
        const PlacedFile text(source);
        if (ending == ".var") {
            add_constants(text);
            variables_.copy(text, {0, text.text().size()});
            variables_.write("\n", mark);
        } else {
            add_bodies(text);
        }
    }

    /// What the packages above have for themselves.
    void use_packages(const Mark& mark) {
        std::string last;
        for (const std::string& file :
             private_files_above(fs::path(list_.file()->path).parent_path())) {
            Diagnostics unread;
            const auto path =
                is_structured_text(file) ? to_.resolve(file, mark, unread) : std::nullopt;
            if (!path) continue;
            read_sources(to_, *path, mark);
            std::string space = private_space_of(file);
            if (space != last) usings_.write(fmt::format("USING {};\n", space), mark);
            last = std::move(space);
        }
    }

    /// `_Belt_Types`, of the folder and the file.
    static std::string space_of(const std::string& path) {
        std::string name = "_";
        const fs::path file(path);
        for (const fs::path& part : {file.parent_path().parent_path(), file.parent_path()})
            name += part.filename().string() + "_";
        name += file.stem().string();
        for (char& c : name)
            if (!is_letter(c) && !is_digit(c)) c = '_';
        return name;
    }

    static bool has_types(const std::shared_ptr<const SourceFile>& file) {
        Diagnostics unread;
        const st::Tokens found = st::read_tokens(file, unread);
        return std::ranges::any_of(
            found.tokens, [](const st::Token& token) { return token.word == st::Word::type_; });
    }

    /// Types that it has for itself stand in a namespace of theirs, with the constants that it has.
    void add_types(const std::string& path, const Mark& mark) {
        const auto source = read_source(path, mistakes_, mark);
        if (!source || !has_types(source)) return;
        const std::string space = space_of(path);
        Excerpts text;
        text.append(usings_);
        text.write(fmt::format("NAMESPACE {}\n", space), mark);
        text.copy(PlacedFile(source), {0, source->text.size()});
        text.append(constants_);
        text.write("\nEND_NAMESPACE\n", mark);
        to_.project.add(text.finish(path));
        usings_.write(fmt::format("USING {};\n", space), mark);
    }

    /// Functions that it has for itself may name these types.
    void add_functions(const std::string& path, const Mark& mark) {
        const auto source = read_source(path, mistakes_, mark);
        if (!source) return;
        Excerpts text;
        text.append(usings_);
        text.copy(PlacedFile(source), {0, source->text.size()});
        to_.project.add(text.finish(path));
    }

    /// Its files say what these do, under the names that `.fun` declares.
    void add_function_bodies(const Mark& place) {
        if (bodies_of_functions_.is_empty()) return;
        Excerpts text;
        text.append(usings_);
        text.write("\n", place);
        text.append(bodies_of_functions_);
        to_.project.add(text.finish(list_.file()->path, "functions"));
    }

    /// `VAR CONSTANT ... END_VAR` as constants beside all.
    void add_constants(const PlacedFile& file) {
        Diagnostics unread;
        const st::Tokens found = st::read_tokens(file.file(), unread);
        const auto& tokens = found.tokens;
        for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
            if (tokens[i].word != st::Word::var_ || tokens[i + 1].word != st::Word::constant_)
                continue;
            std::size_t last = i + 1;
            while (last + 1 < tokens.size() && tokens[last].word != st::Word::end_var_) ++last;
            const Mark place = file.mark({tokens[i].place.begin, tokens[i].place.end});
            constants_.write("\nVAR_GLOBAL ", place);
            constants_.copy(file, {tokens[i + 1].place.begin, tokens[last].place.end});
            constants_.write("\n", place);
        }
    }

    void refuse(const Mark& mark, const std::string& named, const std::string& ending) {
        if (std::ranges::find(unread_languages, ending) == std::end(unread_languages)) return;
        mistakes_.add(
            code::not_supported, mark,
            fmt::format("'{}' is neither Structured Text nor a ladder, and nothing else is "
                        "read of a program of Automation Studio",
                        named),
            "convert it to Structured Text, or leave it out");
    }

    /// Each PROGRAM, ACTION and FUNCTION of a file.
    void add_bodies(const PlacedFile& file) {
        Diagnostics unread;
        const st::Tokens found = st::read_tokens(file.file(), unread);
        const auto& tokens = found.tokens;
        for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
            const std::string unit = lower(std::string(tokens[i].place.text()));
            const bool is_program = unit == "program", is_action = unit == "action";
            if (!is_program && !is_action && !unit.starts_with("function")) continue;
            const std::string end = "end_" + unit;
            std::size_t last = i + 1;
            while (last < tokens.size() && !st::same_name(tokens[last].place.text(), end)) ++last;
            const std::size_t begin = tokens[i].place.begin;
            const bool is_closed = last < tokens.size();
            if (!is_program)
                copy(is_action ? actions_ : bodies_of_functions_, file, begin,
                     is_closed ? tokens[last].place.end : file.text().size());
            else
                add_program(file, tokens[i + 1],
                            is_closed ? tokens[last].place.begin : file.text().size());
            i = last;
        }
    }

    void add_program(const PlacedFile& file, const st::Token& name, std::size_t end) {
        Excerpts body;
        copy(body, file, name.place.end, end);
        put_program(name.place.text(), body, file.mark({name.place.begin, name.place.end}));
    }

    void put_program(std::string_view name, const Excerpts& body, const Mark& place) {
        if (st::same_name(name, "_exit")) return;
        if (!st::same_name(name, "_init")) return body_.append(body);
        has_start_ = true;
        put_action(name, body, place);
    }

    void put_action(std::string_view name, const Excerpts& body, const Mark& place) {
        actions_.write(fmt::format("ACTION {}:\n", name), place);
        actions_.append(body);
        actions_.write("END_ACTION\n", place);
    }

    /// Each PROGRAM and ACTION of a `.ld`: its first line, and then what is drawn.
    void add_ladders(const std::string& named, const Mark& mark) {
        constexpr std::string_view begin_of_all = "<networks", end_of_all = "</networks>";
        const auto path = to_.resolve(path_of(named), mark, mistakes_);
        const auto source =
            path ? read_source(*path, mistakes_, mark, {.bytes = XmlLimits{}.bytes}) : nullptr;
        if (!source) return;
        const std::string& text = source->text;
        for (std::size_t from = 0;;) {
            const std::size_t begin = text.find(begin_of_all, from);
            const std::size_t last = text.find(end_of_all, begin);
            if (last == text.npos) break;
            const std::size_t end = last + end_of_all.size();
            add_ladder(*source, {from, begin}, {begin, end});
            from = end;
        }
    }

    void add_ladder(const SourceFile& source, Part heading, Part drawn) {
        SourceFile alone = source;
        for (std::size_t i = 0; i < alone.text.size(); ++i)
            if ((i < drawn.begin || i >= drawn.end) && alone.text[i] != '\n') alone.text[i] = ' ';
        const auto file =
            XmlFile::parse(std::make_shared<const SourceFile>(std::move(alone)), mistakes_);
        if (!file) return;
        const Excerpts body = text_of_grid(*file, mistakes_, made_, file->root());
        const Mark place = file->mark_of_tag(file->root());
        const std::string_view before = std::string_view(source.text).substr(heading.begin);
        const auto name_behind = [&](std::string_view word) {
            const std::size_t at = before.substr(0, heading.end - heading.begin).rfind(word);
            if (at == before.npos) return std::string_view();
            std::string_view name = before.substr(at + word.size());
            name.remove_prefix(std::min(name.find_first_not_of(' '), name.size()));
            return name.substr(0, name.find_first_of(" :\r\n"));
        };
        if (const auto program = name_behind("PROGRAM "); !program.empty())
            put_program(program, body, place);
        else if (const auto action = name_behind("ACTION "); !action.empty())
            put_action(action, body, place);
        else
            mistakes_.add(code::not_supported, place,
                          "what is drawn here is neither a PROGRAM nor an ACTION",
                          "write it in Structured Text");
    }

    static void copy(Excerpts& to, const PlacedFile& file, std::size_t begin, std::size_t end) {
        to.copy(file, {begin, end});
        to.write("\n", file.mark({begin, begin}));
    }

    const XmlFile& list_;
    const Reading& to_;
    Excerpts usings_, constants_, variables_, actions_, bodies_of_functions_, body_;
    std::vector<std::pair<std::string, Mark>> types_, functions_;  ///< files that declare its own
    std::set<std::string> packages_;                               ///< lists that were read
    MadeVariables made_;
    Diagnostics mistakes_;
    bool has_start_ = false;
};

/// A global variable of what is configured, of which several configurations may tell.
void declare(const Reading& to, const XmlFile& file, pugi::xml_node element,
             pugi::xml_attribute name, std::string_view type) {
    const std::string id = file.plain(name);
    const Mark place = file.mark_of_tag(element);
    const auto is_there = [&](const auto& other) {
        return other->part == id && other->read_as == mapp_form;
    };
    if (type.empty() || !is_one_name(id) || std::ranges::any_of(to.project.sources, is_there))
        return;
    Excerpts text;
    text.write("VAR_GLOBAL\n", place);
    file.copy(text, name);
    text.write(fmt::format(" : {};\nEND_VAR\n", type), place);
    SourceFile made = *text.finish(file.file()->path, id);
    made.read_as = mapp_form;
    to.project.add(std::make_shared<const SourceFile>(std::move(made)));
}

pugi::xml_attribute name_of_part(const XmlFile& file, pugi::xml_node part) {
    for (const pugi::xml_node property : part.children("Property"))
        if (file.plain(property.attribute("ID")) == "Name") return property.attribute("Value");
    return {};
}

/// Empty of what no variable stands for.
std::string_view type_of_part(const XmlFile& file, pugi::xml_node part) {
    const std::string id = file.plain(part.attribute("ID"));
    const std::string kind = id.substr(0, id.find('['));
    return find_type(types_in_lists,
                     kind == "TrafficObject" ? file.plain(part.attribute("Value")) : kind);
}

}  // namespace

bool is_iec_program(const fs::path& file) {
    const std::string start = beginning_of(file);
    const bool is_named_so = lower(file.filename().string()) == "iec.prg";
    return start.find("<Program SubType=\"IEC\"") != start.npos ||
           (is_named_so && start.find("br-automation.co.at/AS/Program") != start.npos);
}

bool is_of_hardware(const fs::path& file) {
    std::error_code unknown;
    fs::path folder = file.parent_path();
    for (; folder.has_filename(); folder = folder.parent_path())
        if (folder.filename() == "Physical")
            return fs::exists(folder.parent_path() / "Logical", unknown);
    return false;
}

bool is_mapp_configuration(const fs::path& file) {
    const bool is_of_mapp = std::ranges::any_of(file.parent_path(), [](const fs::path& folder) {
        const std::string name = lower(folder.string());
        return name.starts_with("mapp") || name.starts_with("exos");
    });
    const std::string ending = extension_of(file);
    const bool is_named_so = ending.starts_with(".mp") || ending == ".axis";
    if (!is_named_so && !(is_of_mapp && is_of_hardware(file))) return false;
    return beginning_of(file).find("<Configuration") != std::string::npos;
}

void read_mapp_configuration(const Reading& to, const std::string& path, const Mark& where) {
    const auto file = XmlFile::read(path, to.out, where);
    if (!file) return;
    for (const pugi::xml_node element : file->root().children("Element")) {
        const std::string kind = file->plain(element.attribute("Type"));
        declare(to, *file, element, element.attribute("ID"), type_of_element(kind));
        if (kind != "processpointlist" && kind != "trafficobjectlist") continue;
        for (const pugi::xml_node part : element.children("Selector"))
            declare(to, *file, part, name_of_part(*file, part), type_of_part(*file, part));
    }
}

void read_iec_program(const Reading& to, const std::string& path, const Mark& where) {
    const auto file = XmlFile::read(path, to.out, where);
    if (!file) return;
    if (std::string_view(file->root().name()) != "Program")
        return to.out.add(
            code::not_an_object, file->mark_of_tag(file->root()),
            fmt::format("<{}> is no program of Automation Studio", file->root().name()),
            "its files begin with <Program SubType=\"IEC\">");
    IecProgram(*file, to).read();
}

}  // namespace lineshaft::projects
