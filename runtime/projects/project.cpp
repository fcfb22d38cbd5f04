#include "runtime/projects/project.hpp"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "runtime/projects/apax.hpp"
#include "runtime/projects/automation_studio.hpp"
#include "runtime/projects/codesys_export.hpp"
#include "runtime/projects/configuration.hpp"
#include "runtime/projects/fixtures.hpp"
#include "runtime/projects/foreign_files.hpp"
#include "runtime/projects/instruction_lists.hpp"
#include "runtime/projects/openplc.hpp"
#include "runtime/projects/organization_blocks.hpp"
#include "runtime/projects/packages.hpp"
#include "runtime/projects/plc_configuration.hpp"
#include "runtime/projects/plcopen.hpp"
#include "runtime/projects/simatic_ml.hpp"
#include "runtime/projects/simatic_sd.hpp"
#include "runtime/projects/solution.hpp"
#include "runtime/projects/task_classes.hpp"
#include "runtime/projects/twincat.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/entries.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"
#include "runtime/source/yaml.hpp"
#include "runtime/st/library/binary_libraries.hpp"
#include "runtime/st/library/test_sources.hpp"

namespace lineshaft::projects {

namespace fs = std::filesystem;

namespace {

/// How the files of a library of B&R are read, by the list beside them; empty: it is none.
std::string form_in_library(const fs::path& file) {
    constexpr std::pair<const char*, std::string_view> lists[] = {
        {"IEC.lby", ""},
        {"ANSIC.lby", st::of_library_in_c},
        {"Binary.lby", st::of_binary_library},
        {"binary.lby", st::of_binary_library}};
    std::error_code unknown;
    for (const auto& [list, form] : lists)
        if (fs::exists(file.parent_path() / list, unknown)) return std::string(form) + ".fun";
    return {};
}

void read_text(const Reading& to, const std::string& path, const Mark& where) {
    if (const auto known = foreign_file(path))
        return to.out.add(code::not_supported, where,
                          fmt::format("'{}' is {}, which is not read", path, known->what),
                          known->help);
    auto source = read_source(path, to.out, where);
    if (!source) return;
    source = with_symbols(std::move(source));
    read_configuration(to, source);
    if (extension_of(path) == ".exp") {
        read_tasks_of_export(to, *source);
        read_plc_configuration(to, source);
    }
    read_organization_blocks(to, source);
    source = with_lists_as_statements(std::move(source));
    if (const std::string space = private_space_of(path); !space.empty())
        source = in_namespace(source, space);
    if (std::string form = form_in_library(path); !form.empty()) {
        SourceFile made = *source;
        made.read_as = std::move(form);
        source = std::make_shared<const SourceFile>(std::move(made));
    }
    to.project.add(std::move(source));
}

void read_xml(const Reading& to, const std::string& path, const Mark& where) {
    return is_simatic_ml(path) ? read_simatic_ml(to, path, where) : read_plcopen(to, path, where);
}

/// By the ending of a file's name, in small letters.
struct Form {
    std::string_view ending;
    void (*read)(const Reading& to, const std::string& path, const Mark& where);
};
constexpr Form forms[] = {{".tcpou", read_twincat_object},  {".tcdut", read_twincat_object},
                          {".tcgvl", read_twincat_object},  {".tcio", read_twincat_object},
                          {".tctleo", read_twincat_object}, {".tctto", read_twincat_object},
                          {".plcproj", read_plcproj},       {".sln", read_solution},
                          {".tsproj", read_solution},       {".tspproj", read_solution},
                          {".xti", read_solution},          {".xml", read_xml},
                          {".prg", read_iec_program},       {".s7dcl", read_simatic_sd},
                          {".export", read_codesys_export}};

const Form* form_of(const fs::path& file) {
    const std::string ending = extension_of(file);
    const auto* form = std::ranges::find(forms, ending, &Form::ending);
    return form == std::end(forms) ? nullptr : form;
}

/// The sources of a package of SIMATIC AX, which `apax.yml` stands beside.
void read_apax(const Reading& to, const std::string& path, const Mark& where) {
    const std::string folder = (fs::path(path).parent_path() / "src").lexically_normal().string();
    std::error_code error;
    const std::vector<std::string> files = sources_below(folder, error);
    if (error)
        to.out.add(code::file_cannot_be_read, where,
                   fmt::format("cannot read the folder '{}': {}", folder, error.message()),
                   "a package of SIMATIC AX has its sources there");
    for (const std::string& file : files)
        if (const auto allowed = to.resolve(file, where, to.out)) read_sources(to, *allowed, where);
}

bool is_apax(const fs::path& file) {
    return lower(file.filename().string()) == "apax.yml";
}

/// TESTs, fixtures of SIMATIC AX, and assertions of a project's own for them.
bool is_test_file(const std::string& file) {
    if (!is_structured_text(file)) return false;
    Diagnostics unread;
    const auto source = read_source(file, unread);
    if (!source) return false;
    const bool has_assertions =
        lower(source->text).find("namespace axunit.assert") != std::string::npos;
    return has_fixtures(*source) || has_assertions || st::is_test_file(source);
}

/// Siemens' data blocks say what they are; other programs have databases whose names end alike.
bool is_database(const std::string& file) {
    if (extension_of(file) != ".db") return false;
    std::string first(65'536, '\0');
    std::ifstream text(file, std::ios::binary);
    text.read(first.data(), static_cast<std::streamsize>(first.size()));
    std::erase(first, '\0');  // UTF-16
    return lower(std::move(first)).find("data_block") == std::string::npos;
}

/// Chapters in Typst's markup are named as B&R's types are: those begin with TYPE, or stand beside
/// a list of Automation Studio's.
bool is_of_typst(const std::string& file) {
    constexpr const char* lists[] = {"Package.pkg", "package.pkg", "IEC.prg",    "ANSIC.prg",
                                     "IEC.lby",     "ANSIC.lby",   "Binary.lby", "binary.lby"};
    if (extension_of(file) != ".typ") return false;
    std::error_code unknown;
    const fs::path folder = fs::path(file).parent_path();
    for (const char* list : lists)
        if (fs::exists(folder / list, unknown)) return false;
    Diagnostics unread;
    const auto source = read_source(file, unread);
    return source && first_word_of(source->text) != "type";
}

/// A table of exports, which linkers name as CoDeSys does its files.
bool is_of_a_linker(const std::string& file) {
    if (extension_of(file) != ".exp") return false;
    std::string first(256, ' ');
    std::ifstream bytes(file, std::ios::binary);
    bytes.read(first.data(), static_cast<std::streamsize>(first.size()));
    return first.find('\0') != std::string::npos && !first.starts_with("\xFF\xFE");
}

/// What B&R's tools make beside `Logical`, and what a program in C has for itself.
bool is_of_no_source(const std::string& file) {
    std::error_code unknown;
    const fs::path folder = fs::path(file).parent_path();
    if (fs::exists(folder / "ANSIC.prg", unknown)) return true;
    for (fs::path at = folder; at.has_filename(); at = at.parent_path())
        if (at.filename() == "Temp" && fs::exists(at.parent_path() / "Logical", unknown))
            return true;
    return false;
}

/// Beremiz' and OpenPLC's.
bool has_editors_project(const fs::path& folder) {
    std::error_code unknown;
    const fs::path project = folder / "plc.xml";
    return fs::exists(project, unknown) && is_plcopen(project);
}

/// What an editor generates of the `plc.xml` beside it: `build/`, and a whole program where its
/// user wants it; and `generated_plc.st`, which `plc.st` begins with.
bool is_built(const std::string& file) {
    std::error_code unknown;
    const fs::path folder = fs::path(file).parent_path();
    if (folder.filename() == "build" && has_editors_project(folder.parent_path())) return true;
    if (extension_of(file) != ".st") return false;
    if (fs::path(file).filename() == "generated_plc.st")
        return fs::exists(folder / "plc.st", unknown);
    if (!has_editors_project(folder)) return false;
    Diagnostics unread;
    const auto source = read_source(file, unread);
    return source && source->text.find("\nCONFIGURATION ") != std::string::npos;
}

/// Beside `src` and `test` of a package of SIMATIC AX, which neither its program nor its tests are.
bool is_beside_package(const fs::path& file, const fs::path& folder) {
    const fs::path below = file.lexically_relative(folder);
    std::error_code unknown;
    fs::path at = file.parent_path();
    for (auto left = std::distance(below.begin(), below.end()); left > 0; --left) {
        if (fs::exists(at / "apax.yml", unknown) && fs::is_directory(at / "src", unknown)) {
            const fs::path first = *file.lexically_relative(at).begin();
            return first != "src" && first != "test";
        }
        at = at.parent_path();
    }
    return false;
}

/// What projects list themselves: all below a `.plcproj`, or a `.prg`; and what lists them.
void leave_to_projects(std::vector<std::string>& files) {
    std::vector<std::string> folders, programs;
    for (const std::string& file : files) {
        const std::string folder = (fs::path(file).parent_path() / "").string();
        if (extension_of(file) == ".plcproj") folders.push_back(folder);
        if (extension_of(file) == ".prg") programs.push_back(folder);
    }
    std::erase_if(files, [&](const std::string& file) {
        const Form* form = form_of(file);
        if (is_solution(file)) return true;
        if (form && form->read == read_twincat_object)
            return std::ranges::any_of(folders, [&](const auto& f) { return file.starts_with(f); });
        return !form &&
               std::ranges::any_of(programs, [&](const auto& f) { return file.starts_with(f); });
    });
}

/// What packages beside the folder's own one have in `src`, where it depends on them.
void add_packages(std::vector<std::string>& files, const std::string& folder) {
    for (const fs::path& package : packages_beside(folder)) {
        std::error_code missing;
        std::ranges::move(sources_below((package / "src").string(), missing),
                          std::back_inserter(files));
    }
}

}  // namespace

void Project::add(std::shared_ptr<const SourceFile> source) {
    const auto is_there = [&](const auto& other) { return other->is_same_text(*source); };
    if (std::ranges::none_of(sources, is_there)) sources.push_back(std::move(source));
}

bool is_source(const fs::path& file) {
    const Form* form = form_of(file);
    if (is_mapp_configuration(file) || is_software_of_cpu(file)) return true;
    if (is_of_hardware(file)) return false;
    if (form && form->read == read_xml) return is_plcopen(file) || is_simatic_ml(file);
    if (form && form->read == read_iec_program) return is_iec_program(file);
    if (form && form->read == read_codesys_export) return is_codesys_export(file);
    if (is_openplc_project(file) || is_openplc_pou(file)) return true;
    return is_apax(file) || form || is_structured_text(file);
}

std::vector<std::string> sources_below(const std::string& folder, std::error_code& error) {
    std::vector<std::string> files;
    constexpr auto options = fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator entry(folder, options, error), end;
         !error && entry != end; entry.increment(error))
        if (is_source(entry->path()) && !is_apax(entry->path()) && is_file_to_read(*entry))
            files.push_back(entry->path().string());
    std::erase_if(files, is_test_file);
    if (!std::ranges::all_of(files, has_name_of_any_text))
        std::erase_if(files, has_name_of_any_text);
    std::erase_if(files, is_database);
    std::erase_if(files, is_of_typst);
    std::erase_if(files, is_of_a_linker);
    std::erase_if(files, is_built);
    std::erase_if(files, is_of_no_source);
    std::erase_if(files, [packages = Packages()](const std::string& path) mutable {
        return packages.leave_out(path);
    });
    std::erase_if(files, is_left_to_openplc);
    std::erase_if(files, [&](const auto& file) { return is_beside_package(file, folder); });
    leave_to_projects(files);
    std::ranges::sort(files);
    if (!error) add_packages(files, folder);
    return files;
}

void read_sources(const Reading& to, const std::string& path, const Mark& where) {
    const Form* form = form_of(path);
    if (is_apax(path)) return read_apax(to, path, where);
    if (is_software_of_cpu(path)) return read_task_classes(to, path, where);
    if (is_mapp_configuration(path)) return read_mapp_configuration(to, path, where);
    if (is_openplc_project(path)) return read_openplc_project(to, path, where);
    if (is_openplc_pou(path)) return read_openplc_pou(to, path, where);
    return form ? form->read(to, path, where) : read_text(to, path, where);
}

}  // namespace lineshaft::projects
