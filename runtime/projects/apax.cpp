#include "runtime/projects/apax.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <string>

#include <fmt/format.h>

#include "runtime/source/yaml.hpp"

namespace lineshaft::projects {

namespace {

namespace fs = std::filesystem;

struct Package {
    std::string name;
    std::vector<std::string> dependencies;
};

/// What `apax.yml` in that folder says; empty: there is none, or it names nothing.
Package package_in(const fs::path& folder) {
    Package made;
    Diagnostics unread;
    const fs::path file = folder / "apax.yml";
    std::error_code unknown;
    if (!fs::is_regular_file(file, unknown)) return made;
    const auto source = read_source(file.string(), unread);
    const auto root = source ? parse_yaml(source, unread) : std::nullopt;
    if (!root) return made;
    if (const Node* name = root->find("name")) made.name = name->text;
    for (const char* list : {"dependencies", "devDependencies"})
        if (const Node* named = root->find(list); named && named->is_map())
            std::ranges::move(named->keys(), std::back_inserter(made.dependencies));
    return made;
}

}  // namespace

std::vector<fs::path> packages_beside(const fs::path& folder) {
    std::error_code unknown;
    const fs::path here =
        fs::absolute(folder / "apax.yml", unknown).lexically_normal().parent_path();
    std::vector<std::string> wanted = package_in(here).dependencies;
    std::vector<fs::path> found;
    if (wanted.empty()) return found;
    std::map<std::string, fs::path> beside;
    constexpr auto options = fs::directory_options::skip_permission_denied;
    for (fs::directory_iterator entry(here.parent_path(), options, unknown), end;
         !unknown && entry != end; entry.increment(unknown))
        if (entry->path() != here) beside.emplace(package_in(entry->path()).name, entry->path());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const auto it = beside.find(wanted[i]);
        if (fs::exists(here / ".apax" / "packages" / wanted[i], unknown)) continue;
        if (it == beside.end() || std::ranges::find(found, it->second) != found.end()) continue;
        found.push_back(it->second);
        for (std::string& next : package_in(it->second).dependencies)
            wanted.push_back(std::move(next));
    }
    return found;
}

fs::path package_of(const fs::path& path) {
    std::error_code unknown;
    const fs::path here = fs::current_path(unknown);
    for (fs::path at = (here / path).lexically_normal(), last; at != last;
         last = at, at = at.parent_path())
        if (fs::exists(at / "apax.yml", unknown) && fs::is_directory(at / "src", unknown))
            return path.is_absolute() ? at : at.lexically_proximate(here);
    return {};
}

std::shared_ptr<const SourceFile> with_symbols(std::shared_ptr<const SourceFile> source) {
    if (source->text.find("{::if") == std::string::npos) return source;
    const fs::path package = package_of(source->path);
    Diagnostics unread;
    const auto file =
        package.empty() ? nullptr : read_source((package / "apax.yml").string(), unread);
    const auto root = file ? parse_yaml(file, unread) : std::nullopt;
    const Node* variables = root ? root->find("variables") : nullptr;
    const bool has_some = variables && variables->is_map();
    const Node* symbols = has_some ? variables->find("DEFINED_PREPROCESSOR_SYMBOLS") : nullptr;
    if (!symbols || !symbols->is_sequence()) return source;
    std::string begin;
    for (const Node& symbol : symbols->items) begin += fmt::format("{{define {}}}", symbol.text);
    begin += "\n";
    auto made = std::make_shared<SourceFile>(*source);
    made->text = begin + source->text;
    made->excerpts = {{0, Mark{source, 1, 1}, false}, {begin.size(), Mark{source, 1, 1}, true}};
    return made;
}

}  // namespace lineshaft::projects
