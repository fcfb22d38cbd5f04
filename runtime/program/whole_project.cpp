#include "runtime/program/whole_project.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>

#include "runtime/projects/packages.hpp"
#include "runtime/projects/solution.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

bool is_plcproj(const std::string& path) {
    return extension_of(path) == ".plcproj";
}

/// Folders of projects of Automation Studio, where there are several.
std::set<std::string> studio_projects_of(const std::vector<std::string>& files) {
    std::set<std::string> folders;
    for (const std::string& file : files)
        if (std::string folder = projects::studio_project_of(file); !folder.empty())
            folders.insert(std::move(folder));
    if (folders.size() == 1) folders.clear();
    return folders;
}

/// What belongs to none of the projects below a folder, whose files these are.
WholeProject rest_of(const std::string& path, const std::vector<std::string>& files,
                     const std::set<std::string>& studio,
                     const std::vector<std::string>& include_dirs, Diagnostics& out) {
    WholeProject rest{.path = path, .project = {}};
    for (const std::string& file : files) {
        if (is_plcproj(file) || studio.contains(projects::studio_project_of(file))) continue;
        projects::Project read = read_project(file, include_dirs, out);
        for (auto& source : read.sources) rest.project.add(std::move(source));
        std::ranges::move(read.tasks, std::back_inserter(rest.project.tasks));
        std::ranges::move(read.organization_blocks,
                          std::back_inserter(rest.project.organization_blocks));
        std::ranges::move(read.libraries, std::back_inserter(rest.project.libraries));
    }
    rest.own = rest.project.sources.size();
    return rest;
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
    const std::vector<std::string> files = plcprojs_of(path);
    std::vector<WholeProject> made;
    std::error_code error;
    const auto below = fs::is_directory(path, error) ? projects::sources_below(path, error)
                                                     : std::vector<std::string>();
    const std::set<std::string> studio = studio_projects_of(below);
    const auto add = [&](const std::string& at) {
        made.push_back({.path = at, .project = read_project(at, include_dirs, out)});
        made.back().own = made.back().project.sources.size();
    };
    for (const std::string& folder : studio) add(folder);
    if (!files.empty()) {
        Projects all(path, include_dirs, out);
        for (const std::string& file : files) made.push_back(all.whole(file));
    }
    if (made.empty()) return add(path), made;
    WholeProject rest = rest_of(path, below, studio, include_dirs, out);
    for (std::size_t i = 0; i < studio.size(); ++i)
        for (const auto& source : rest.project.sources) made[i].project.add(source);
    if (rest.own > 0) made.push_back(std::move(rest));
    return made;
}

std::vector<std::string> task_programs(const projects::Project& project) {
    std::vector<std::string> programs;
    for (const projects::ProjectTask& task : project.tasks)
        for (const projects::TaskProgram& program : task.programs) programs.push_back(program.text);
    return programs;
}

std::vector<LibraryReference> references_of(const projects::Project& project) {
    std::vector<LibraryReference> references;
    for (const projects::Name& library : project.libraries)
        references.push_back({library.text, library.mark});
    return references;
}

}  // namespace lineshaft
