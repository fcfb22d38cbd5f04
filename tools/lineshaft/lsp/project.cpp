#include "tools/lineshaft/lsp/project.hpp"

#include <algorithm>
#include <filesystem>

#include "blocks/catalog.hpp"
#include "runtime/program/whole_project.hpp"
#include "runtime/projects/instruction_lists.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"
#include "runtime/st/library/library.hpp"
#include "runtime/study/study_reader.hpp"
#include "tools/lineshaft/check_project.hpp"
#include "tools/lineshaft/lsp/yaml_places.hpp"
#include "tools/lineshaft/test_files.hpp"

namespace lineshaft::lsp {

namespace fs = std::filesystem;

namespace {

std::string normal(const std::string& path) {
    return fs::path(path).lexically_normal().string();
}

/// A POU, a type or a list of globals of TwinCAT.
bool is_object(const std::string& path) {
    const std::string ending = extension_of(path);
    return ending == ".tcpou" || ending == ".tcdut" || ending == ".tcgvl";
}

bool is_project_file(const std::string& path) {
    return extension_of(path) == ".plcproj";
}

/// Editors have other people's YAML open, too.
bool is_ours(const SourceFile& file) {
    return file.text.find("lineshaft:") != file.text.npos ||
           file.text.find("lineshaft_") != file.text.npos;
}

/// As a whole name; letters small.
bool has_word(std::string_view text, std::string_view word) {
    const auto is_part = [&](std::size_t at) { return at < text.size() && is_of_name(text[at]); };
    for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1))
        if (!(at > 0 && is_part(at - 1)) && !is_part(at + word.size())) return true;
    return false;
}

}  // namespace

bool is_code(const std::string& path) {
    return is_structured_text(path) || is_object(path) || is_project_file(path);
}

bool Project::lies_in_folders(const std::string& path) const {
    return std::ranges::any_of(folders_, [&](const auto& f) { return lies_below(path, f); });
}

void Project::forget() {
    is_read_ = has_pool_ = false;
}

void Project::read_folders() {
    if (is_read_) return;
    is_read_ = true;
    yaml_files_.clear();
    sources_.clear();
    projects_.clear();
    programs_.clear();
    std::error_code error;
    for (const std::string& folder : folders_) {
        constexpr auto options = fs::directory_options::skip_permission_denied;
        for (fs::recursive_directory_iterator entry(folder, options, error), end;
             !error && entry != end; entry.increment(error)) {
            if (entry->path().filename().string().starts_with(".")) {
                entry.disable_recursion_pending();
                continue;
            }
            const std::string path = entry->path().lexically_normal().string();
            if (entry->path().extension() == ".yaml") yaml_files_.insert(path);
            if (is_project_file(path))
                projects_.insert(path);
            else if (is_code(path))
                sources_.insert(path);
        }
    }
    for (const std::string& path : yaml_files_) index(path);
}

void Project::index(const std::string& program) {
    Diagnostics untold;
    programs_.erase(program);
    const auto file = read_source(program, untold);
    if (!file || !is_program(*file) || file->text.find("sources:") == std::string::npos) return;
    for (const auto& text : read_program(file, {}, untold).texts)
        programs_[program].insert(normal(text->path));
}

const st::SourcePool& Project::pool() {
    if (has_pool_) return pool_;
    has_pool_ = true;
    pool_ = {};
    Diagnostics untold;
    for (const std::string& folder : folders_)
        for (const auto& source : read_project(folder, {}, untold).sources) pool_.add(source);
    return pool_;
}

void Project::change(const std::string& path) {
    if (is_read_ && !is_code(path)) index(path);
    if (is_object(path)) has_pool_ = false;
    Diagnostics untold;
    if (!has_pool_ || !is_structured_text(path)) return;
    if (const auto file = read_source(path, untold)) pool_.replace(file);
}

std::string Project::project_of(const std::string& object) const {
    std::string nearest;
    for (const std::string& project : projects_) {
        const std::string folder = fs::path(project).parent_path().string();
        if (folder.size() >= fs::path(nearest).parent_path().string().size() &&
            lies_below(object, folder))
            nearest = project;
    }
    return nearest.empty() ? object : nearest;
}

std::vector<std::string> Project::roots_of(const std::string& path) {
    if (!is_code(path)) return {path};
    read_folders();
    std::vector<std::string> roots;
    for (const auto& [program, texts] : programs_)
        if (texts.contains(path)) roots.push_back(program);
    if (roots.empty()) roots.push_back(is_object(path) ? project_of(path) : path);
    return roots;
}

std::vector<std::string> Project::roots_to_look_in(const std::string& path,
                                                   const std::string& word) {
    std::vector<std::string> found = roots_of(path);
    const std::string small = lower(word);
    for (const std::string& source : sources_) {
        Diagnostics untold;
        const auto file = read_source(source, untold);
        if (!file || !has_word(lower(file->text), small)) continue;
        for (const std::string& root : roots_of(source)) found.push_back(root);
    }
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

std::vector<std::shared_ptr<const SourceFile>> Project::sources_of(const std::string& root) {
    Diagnostics untold;
    const auto file = read_source(root, untold);
    if (!file) return {};
    if (is_object(root) || is_project_file(root)) {
        const auto projects = read_projects(root, {}, untold);
        return projects.empty() ? std::vector<std::shared_ptr<const SourceFile>>()
                                : projects.front().project.sources;
    }
    if (!is_structured_text(root))
        return is_program(*file) ? read_program(file, {}, untold).texts
                                 : std::vector<std::shared_ptr<const SourceFile>>();
    std::vector<std::shared_ptr<const SourceFile>> together;
    if (lies_in_folders(root))
        together = pool().needed_by(file);
    else if (st::is_test_file(file))
        together = find_tests(root, {}).front().sources->needed_by(file);
    together.push_back(file);
    return together;
}

std::optional<CheckedProgram> Project::check(const std::string& root, Diagnostics& out) {
    const auto file = read_source(root, out);
    if (!file) return {};
    if (is_object(root) || is_project_file(root)) {
        check_project(root, {}, out);
        return {};
    }
    if (!is_structured_text(root)) return is_ours(*file) ? check_file(root, {}, out) : std::nullopt;
    auto together = sources_of(root);
    if (!st::is_test_file(file)) {
        for (auto& text : together) text = projects::with_lists_as_statements(std::move(text));
        st::compile(together, standard_blocks(), out);
        return {};
    }
    together.pop_back();
    st::compile_tests(file, together, standard_blocks(), out);
    return {};
}

}  // namespace lineshaft::lsp
