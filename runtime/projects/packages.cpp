#include "runtime/projects/packages.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "runtime/projects/drawings/rung_graphs.hpp"
#include "runtime/projects/xml.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"

namespace lineshaft::projects {

namespace {

namespace fs = std::filesystem;

constexpr const char* names_of_packages[] = {"Package.pkg", "package.pkg"};
constexpr const char* names_of_lists[] = {"Package.pkg", "package.pkg", "IEC.lby"};
constexpr std::size_t longest_list = 1U << 20;

bool is_listed(const std::string& list, const std::string& name) {
    const bool is_plain = std::ranges::all_of(name, [](char c) { return (c & 0x80) == 0; });
    const std::string written = as_xml(lower(name));
    const std::string forms[] = {">" + written + "<", "\\" + written + "<", ">" + written + "\\"};
    return !is_plain || std::ranges::any_of(forms, [&](const std::string& form) {
        return list.find(form) != list.npos;
    });
}

/// That the package in a folder has for itself.
std::vector<std::string> private_files_of(const fs::path& folder) {
    std::vector<std::string> files;
    std::error_code unknown;
    for (const char* name : names_of_packages) {
        Diagnostics unread;
        const fs::path path = folder / name;
        const auto list =
            fs::exists(path, unknown) ? XmlFile::read(path.string(), unread) : nullptr;
        if (!list) continue;
        for (const auto object : list->root().child("Objects").children("Object"))
            if (list->plain(object.attribute("Private")) == "true" &&
                list->plain(object.attribute("Type")) == "File")
                files.push_back((folder / list->plain(object)).string());
        break;
    }
    return files;
}

/// `_Logical._Cell`: what is named in a namespace is found in those within it.
std::string space_of(const fs::path& folder) {
    std::string space;
    std::error_code unknown;
    for (const fs::path& part : fs::absolute(folder, unknown).lexically_normal()) {
        std::string name = part.string();
        if (name.empty() || (space.empty() && name != "Logical")) continue;
        for (char& c : name)
            if (!is_letter(c) && !is_digit(c)) c = '_';
        space += (space.empty() ? "_" : "._") + name;
    }
    return space;
}

}  // namespace

std::string studio_project_of(const fs::path& file) {
    std::error_code unknown;
    for (fs::path at = file.parent_path(); at.has_filename(); at = at.parent_path()) {
        const fs::path folder = at.parent_path();
        const bool is_half = at.filename() == "Logical" || at.filename() == "Physical";
        for (const char* name : names_of_packages)
            if (is_half && fs::exists(folder / "Logical" / name, unknown)) return folder.string();
    }
    return {};
}

std::string private_space_of(const fs::path& file) {
    const fs::path folder = file.parent_path();
    const auto files = private_files_of(folder);
    const std::string path = file.string();
    return std::ranges::find(files, path) == files.end() ? "" : space_of(folder);
}

std::vector<std::string> private_files_above(const fs::path& folder) {
    std::vector<std::string> files;
    for (fs::path at = folder; at.has_filename() && at.filename() != "Logical";) {
        at = at.parent_path();
        std::ranges::move(private_files_of(at), std::back_inserter(files));
    }
    return files;
}

/// Empty: it has none.
const std::string& Packages::list_of(const fs::path& folder) {
    const auto [found, is_new] = lists_.try_emplace(folder);
    if (!is_new) return found->second;
    for (const char* name : names_of_lists) {
        std::ifstream stream(folder / name, std::ios::binary);
        if (!stream || !found->second.empty()) continue;
        std::string text(longest_list, '\0');
        stream.read(text.data(), static_cast<std::streamsize>(text.size()));
        text.resize(static_cast<std::size_t>(stream.gcount()));
        if (text.size() < longest_list) found->second = lower(std::move(text));
    }
    return found->second;
}

bool Packages::leave_out(const fs::path& file) {
    const auto in_logical = [](const fs::path& at) { return at.filename() == "Logical"; };
    const fs::path folder = file.parent_path();
    if (std::none_of(folder.begin(), folder.end(), in_logical)) return false;
    const std::string& beside = list_of(folder);
    const bool is_of_package = beside.find("<package") != beside.npos;
    if (is_of_package && extension_of(file) == ".st") return true;
    for (fs::path at = file; !in_logical(at) && at.has_filename(); at = at.parent_path()) {
        const std::string& list = list_of(at.parent_path());
        if (!list.empty() && !is_listed(list, at.filename().string())) return true;
    }
    return false;
}

}  // namespace lineshaft::projects
