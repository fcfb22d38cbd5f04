#include "runtime/program/whole_project.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <ranges>
#include <set>

#include "runtime/projects/solution.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

bool is_plcproj(const std::string& path) {
    return lower(fs::path(path).extension().string()) == ".plcproj";
}

/// `.plcproj` below a folder, or what a file leads to.
std::vector<std::string> plcprojs_of(const std::string& path) {
    std::error_code error;
    if (projects::is_solution(path)) return projects::plcprojs_of(path);
    if (!fs::is_directory(path, error))
        return is_plcproj(path) ? std::vector{path} : std::vector<std::string>();
    auto files = projects::sources_below(path, error);
    std::erase_if(files, [](const std::string& file) { return !is_plcproj(file); });
    return files;
}

/// Each file below a folder that no `.plcproj` is, read by itself.
std::vector<WholeProject> files_of_folder(const std::string& folder,
                                          const std::vector<std::string>& include_dirs,
                                          Diagnostics& out) {
    std::error_code error;
    std::vector<std::string> allowed = include_dirs;
    allowed.push_back(folder);
    std::vector<WholeProject> read;
    for (const std::string& file : projects::sources_below(folder, error))
        if (!is_plcproj(file))
            read.push_back({.path = file, .project = read_project(file, allowed, out)});
    return read;
}

/// By what they call their parts: two exports of PLCopen that have one in common are two projects.
/// Several without are one.
void leave_exports_apart(std::vector<WholeProject>& files, std::vector<WholeProject>& apart) {
    std::map<std::string, std::set<std::string>> exports;
    const auto is_export = [](const WholeProject& file) {
        return lower(fs::path(file.path).extension().string()) == ".xml";
    };
    for (const WholeProject& file : files)
        if (is_export(file))
            for (const auto& source : file.project.sources)
                exports[lower(source->part)].insert(file.path);
    const auto is_apart = [&](const WholeProject& file) {
        const auto is_shared = [&](const auto& source) {
            return exports[lower(source->part)].size() > 1;
        };
        return is_export(file) && std::ranges::any_of(file.project.sources, is_shared);
    };
    const auto first = std::ranges::stable_partition(files, std::not_fn(is_apart)).begin();
    for (WholeProject& file : std::ranges::subrange(first, files.end())) {
        file.own = file.project.sources.size();
        apart.push_back(std::move(file));
    }
    files.erase(first, files.end());
}

/// All files that are left, as one project.
WholeProject together(const std::string& path, std::vector<WholeProject>& files) {
    WholeProject made{.path = path, .project = {}};
    for (WholeProject& file : files) {
        for (auto& source : file.project.sources) made.project.add(std::move(source));
        std::ranges::move(file.project.tasks, std::back_inserter(made.project.tasks));
        std::ranges::move(file.project.libraries, std::back_inserter(made.project.libraries));
    }
    made.own = made.project.sources.size();
    return made;
}

/// All projects in reach, each read once.
class Projects {
  public:
    Projects(const std::string& path, std::vector<std::string> include_dirs, Diagnostics& out)
        : allowed_(std::move(include_dirs)), out_(out) {
        std::error_code error;
        const fs::path folder = fs::path(path).parent_path();
        allowed_.push_back(fs::is_directory(path, error) ? path
                           : folder.empty()              ? "."
                                                         : folder.string());
        for (const std::string& dir : allowed_)
            for (const std::string& file : plcprojs_of(dir)) add(file);
        for (const std::string& file : plcprojs_of(path)) add(file);
    }

    WholeProject whole(const std::string& path) {
        WholeProject made{.path = path, .project = read(path)};
        made.own = made.project.sources.size();
        std::vector<std::string> taken{path};
        take_libraries(made, path, taken);
        return made;
    }

  private:
    void add(const std::string& file) {
        names_.try_emplace(fs::path(file).lexically_normal().string(),
                           projects::names_of_plcproj(file));
    }

    const projects::Project& read(const std::string& path) {
        const auto [it, is_new] = read_.try_emplace(path);
        if (is_new) it->second = read_project(path, allowed_, out_);
        return it->second;
    }

    /// That is called so: of several the one that is nearest in the tree of folders.
    const std::string* find(const std::string& name, const std::string& user) const {
        const std::string* best = nullptr;
        std::size_t most = 0;
        for (const auto& [path, names] : names_) {
            if (!names.is_called(name) || path == user) continue;
            const auto same =
                static_cast<std::size_t>(std::ranges::mismatch(path, user).in1 - path.begin());
            if (!best || same > most) best = &path, most = same;
        }
        return best;
    }

    void take_libraries(WholeProject& to, const std::string& user,
                        std::vector<std::string>& taken) {
        const auto names = names_.find(fs::path(user).lexically_normal().string());
        if (names == names_.end()) return;
        for (const auto& library : names->second.libraries) {
            const std::string* path = find(library.name, names->first);
            if (!path) continue;
            std::erase_if(to.project.libraries, [&](const projects::Name& name) {
                return lower(name.text) == lower(library.name);
            });
            if (std::ranges::find(taken, *path) != taken.end()) continue;
            taken.push_back(*path);
            to.library_paths.push_back(*path);
            for (const auto& source : read(*path).sources)
                to.project.sources.push_back(projects::in_namespace(source, library.space));
            take_libraries(to, *path, taken);
        }
    }

    std::vector<std::string> allowed_;
    Diagnostics& out_;
    std::map<std::string, projects::ProjectNames> names_;  ///< by path
    std::map<std::string, projects::Project> read_;
};

}  // namespace

std::vector<WholeProject> read_projects(const std::string& path,
                                        const std::vector<std::string>& include_dirs,
                                        Diagnostics& out) {
    const std::vector<std::string> plcprojs = plcprojs_of(path);
    std::vector<WholeProject> made;
    std::error_code error;
    if (!plcprojs.empty()) {
        Projects all(path, include_dirs, out);
        for (const std::string& file : plcprojs) made.push_back(all.whole(file));
    }
    if (!fs::is_directory(path, error)) {
        if (!plcprojs.empty()) return made;
        std::vector<WholeProject> one(1);
        one.front().project = read_project(path, include_dirs, out);
        return {together(path, one)};
    }
    std::vector<WholeProject> files = files_of_folder(path, include_dirs, out);
    leave_exports_apart(files, made);
    WholeProject rest = together(path, files);
    if (rest.own > 0 || made.empty()) made.push_back(std::move(rest));
    return made;
}

std::vector<LibraryReference> references_of(const projects::Project& project) {
    std::vector<LibraryReference> references;
    for (const projects::Name& library : project.libraries)
        references.push_back({library.text, library.mark});
    return references;
}

}  // namespace lineshaft
