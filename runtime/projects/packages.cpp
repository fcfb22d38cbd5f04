#include "runtime/projects/packages.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "runtime/projects/drawings/rung_graphs.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::projects {

namespace {

namespace fs = std::filesystem;

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

}  // namespace

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
    if (is_of_package && lower(file.extension().string()) == ".st") return true;
    for (fs::path at = file; !in_logical(at) && at.has_filename(); at = at.parent_path()) {
        const std::string& list = list_of(at.parent_path());
        if (!list.empty() && !is_listed(list, at.filename().string())) return true;
    }
    return false;
}

}  // namespace lineshaft::projects
