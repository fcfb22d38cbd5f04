#include "runtime/projects/solution.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/projects/twincat.hpp"
#include "runtime/projects/xml.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"
#include "runtime/source/yaml.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace fs = std::filesystem;

namespace {

/// A namespace is a name: `LCLS General` is LCLS_General where nothing else is said.
std::string as_name(std::string text) {
    for (char& c : text)
        if (!is_letter(c) && !is_digit(c)) c = '_';
    return text.empty() || is_digit(text.front()) ? "_" + text : text;
}

void add_plcproj(std::vector<std::string>& to, const std::string& path) {
    std::error_code unknown;
    if (fs::is_regular_file(path, unknown) && std::ranges::find(to, path) == to.end())
        to.push_back(path);
}

void follow(std::vector<std::string>& to, const std::string& path, int levels);

/// Projects of TwinCAT in a solution: each in quotes, behind its name.
void follow_solution(std::vector<std::string>& to, const std::string& path, int levels) {
    Diagnostics unread;
    const auto file = read_source(path, unread);
    if (!file) return;
    std::string_view rest = file->text;
    while (!rest.empty()) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
        if (!line.starts_with("Project(")) continue;
        for (std::size_t at = line.find('"'); at != line.npos; at = line.find('"', at + 1)) {
            const std::size_t end = line.find('"', at + 1);
            if (end == line.npos) break;
            const std::string named(line.substr(at + 1, end - at - 1));
            if (is_solution(named) || extension_of(named) == ".plcproj")
                follow(to, path_beside(path, named), levels);
            at = end;
        }
    }
}

void follow_elements(std::vector<std::string>& to, const XmlFile& file, pugi::xml_node element,
                     int levels) {
    const std::string& path = file.file()->path;
    for (const pugi::xml_node child : element.children()) {
        const std::string_view name = child.name();
        if (name == "Plc" || name == "Project") follow_elements(to, file, child, levels);
        if (name != "Project") continue;
        if (const auto named = child.attribute("PrjFilePath"))
            follow(to, path_beside(path, file.plain(named)), levels);
        if (const auto named = child.attribute("File"))
            follow(to, path_beside(path, "_Config/PLC/" + file.plain(named)), levels);
    }
}

void follow(std::vector<std::string>& to, const std::string& path, int levels) {
    if (extension_of(path) == ".plcproj") return add_plcproj(to, path);
    if (levels == 0) return;
    if (extension_of(path) == ".sln") return follow_solution(to, path, levels - 1);
    Diagnostics unread;
    if (const auto file = XmlFile::read(path, unread))
        follow_elements(to, *file, file->root(), levels - 1);
}

}  // namespace

bool ProjectNames::is_called(std::string_view name) const {
    return std::ranges::any_of(
        own, [&](const std::string& known) { return st::same_name(known, name); });
}

ProjectNames names_of_plcproj(const std::string& path) {
    ProjectNames names{.own = {fs::path(path).stem().string()}, .libraries = {}};
    Diagnostics unread;
    const auto file = XmlFile::read(path, unread);
    if (!file) return names;
    for (const pugi::xml_node group : file->root().children()) {
        for (const char* element : {"Title", "Name"})
            if (std::string name = file->plain(group.child(element)); !name.empty())
                names.own.push_back(std::move(name));
        for (const pugi::xml_node item : group.children()) {
            const std::string_view kind = item.name();
            if (kind != "PlaceholderReference" && kind != "LibraryReference") continue;
            const std::string include = file->plain(item.attribute("Include"));
            std::string name = include.substr(0, include.find(','));
            std::string space = file->plain(item.child("Namespace"));
            if (space.empty()) space = name;
            names.libraries.push_back({std::move(name), as_name(std::move(space))});
        }
    }
    return names;
}

bool is_solution(const fs::path& file) {
    constexpr std::string_view endings[] = {".sln", ".tsproj", ".tspproj", ".xti"};
    return std::ranges::find(endings, extension_of(file)) != std::end(endings);
}

std::vector<std::string> plcprojs_of(const std::string& solution) {
    constexpr int most_levels = 4;
    std::vector<std::string> found;
    follow(found, solution, most_levels);
    return found;
}

void read_solution(const Reading& to, const std::string& path, const Mark& where) {
    for (const std::string& named : plcprojs_of(path))
        if (const auto allowed = to.resolve(named, where, to.out))
            read_plcproj(to, *allowed, where);
}

std::shared_ptr<const SourceFile> in_namespace(const std::shared_ptr<const SourceFile>& source,
                                               const std::string& space) {
    auto made = std::make_shared<SourceFile>(*source);
    const std::string begin = fmt::format("NAMESPACE {}\n", space);
    made->part = fmt::format("{}.{}", space, source->part);
    made->text = begin + source->text + "\nEND_NAMESPACE\n";
    const Mark first =
        source->excerpts.empty() ? Mark{source, 1, 1} : source->excerpts.front().place;
    const Mark last = source->excerpts.empty() ? first : source->excerpts.back().place;
    made->excerpts = {{0, first, false}};
    for (Excerpt excerpt : source->excerpts) {
        excerpt.begin += begin.size();
        made->excerpts.push_back(excerpt);
    }
    made->excerpts.push_back({begin.size() + source->text.size(), last, false});
    return made;
}

}  // namespace lineshaft::projects
