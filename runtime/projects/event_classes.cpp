#include "runtime/projects/event_classes.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "runtime/projects/xml.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"
#include "runtime/source/reader.hpp"

namespace lineshaft::projects {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_files = 64;

/// TwinCAT's own: a project's files have them where its events are named, too.
constexpr std::pair<std::string_view, std::string_view> classes_of_system[] = {
    {"TcSystemEventClass", "{BB2A9999-102E-421A-8D3D-B0660E07B1FE}"},
    {"TcRouterEventClass", "{E759605A-2341-48FC-9F3F-C8FA405C4B24}"},
    {"TcGeneralAdsEventClass", "{7D760066-D373-4A0C-B0F1-328B1620B0F0}"},
    {"TcRTimeEventClass", "{92F05393-06A8-48C2-8871-EAA38C1E3990}"},
    {"Win32EventClass", "{4ABEFBBF-6620-4349-91AD-E6110A3BE851}"}};

constexpr bool is_hex(char c) {
    return digit_of(c) < 16;
}

/// The GUID `{665BAD9E-6191-FEB1-F9FA-D5AD80AC3506}` as a value; empty: it is none.
std::string guid_value(std::string_view text) {
    std::string digits;
    for (const char c : text)
        if (is_hex(c)) digits += c;
    if (digits.size() != 32) return {};
    std::string bytes;
    for (std::size_t i = 16; i < 32; i += 2)
        bytes += fmt::format("{}16#{}", i > 16 ? ", " : "", digits.substr(i, 2));
    return fmt::format("(Data1 := 16#{}, Data2 := 16#{}, Data3 := 16#{}, Data4 := [{}])",
                       digits.substr(0, 8), digits.substr(8, 4), digits.substr(12, 4), bytes);
}

/// The number `29` or `#x1D` as a literal; empty: it is none.
std::string number_value(std::string_view text) {
    const bool has_letters = text.starts_with("#x");
    if (has_letters) text.remove_prefix(2);
    if (text.empty() || !std::ranges::all_of(text, has_letters ? is_hex : is_digit)) return {};
    return fmt::format("{}{}", has_letters ? "16#" : "", text);
}

bool is_severity(const std::string& text) {
    static constexpr std::array<std::string_view, 5> all = {"Verbose", "Info", "Warning", "Error",
                                                            "Critical"};
    return std::ranges::find(all, text) != all.end();
}

bool names(const Project& project, std::string_view word) {
    const std::string small = lower(word);
    return std::ranges::any_of(project.sources, [&](const auto& source) {
        return lower(source->text).find(small) != std::string::npos;
    });
}

class EventClasses {
  public:
    void add_file(const std::string& path) {
        Diagnostics unread;
        const auto file = XmlFile::read(path, unread);
        if (!file) return;
        for (const pugi::xml_node type : file->root().child("DataTypes").children("DataType"))
            if (type.child("EventId")) add_class(*file, type);
    }

    void finish(Project& project, const std::string& path) {
        for (const auto& [name, guid] : classes_of_system)
            if (names(project, name) && known_.insert(lower(name)).second)
                add_guid(name, guid_value(guid), {});
        if (known_.empty()) return;
        if (!entries_.is_empty()) {
            project.add(types_.finish(path, "TC_EVENTS types"));
            project.add(list_of(entries_).finish(path, "TC_EVENTS"));
        }
        project.add(list_of(guids_).finish(path, "TC_EVENT_CLASSES"));
    }

  private:
    void add_class(const XmlFile& file, pugi::xml_node type) {
        const Mark place = file.mark_of_tag(type);
        const std::string name = file.plain(type.child("Name"));
        const std::string guid = guid_value(file.plain(type.child("Name").attribute("GUID")));
        if (!is_identifier(name) || guid.empty() || !known_.insert(lower(name)).second) return;
        types_.write(fmt::format("TYPE TC_EVENTS_{} : STRUCT\n", name), place);
        std::set<std::string> events;
        for (const pugi::xml_node event : type.children("EventId")) {
            const std::string called = file.plain(event.child("Name"));
            const std::string number =
                number_value(file.plain(event.child("Name").attribute("Id")));
            const std::string severity = file.plain(event.child("Severity"));
            if (!is_identifier(called) || number.empty() || !events.insert(lower(called)).second)
                continue;
            types_.write(
                fmt::format("{} : TcEventEntry := (uuidEventClass := {}, nEventId := {}, "
                            "eSeverity := TcEventSeverity.{});\n",
                            called, guid, number, is_severity(severity) ? severity : "Verbose"),
                file.mark_of_tag(event));
        }
        types_.write("END_STRUCT END_TYPE\n", place);
        entries_.write(fmt::format("{0} : TC_EVENTS_{0};\n", name), place);
        add_guid(name, guid, place);
    }

    void add_guid(std::string_view name, const std::string& guid, const Mark& place) {
        guids_.write(fmt::format("{} : GUID := {};\n", name, guid), place);
    }

    static Excerpts list_of(const Excerpts& variables) {
        Excerpts list;
        list.write("{attribute 'qualified_only'}\nVAR_GLOBAL CONSTANT\n", {});
        list.append(variables);
        list.write("END_VAR\n", {});
        return list;
    }

    std::set<std::string> known_;
    Excerpts types_, entries_, guids_;
};

std::vector<std::string> files_of(const fs::path& folder) {
    std::vector<std::string> files;
    std::error_code error;
    constexpr auto options = fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator entry(folder, options, error), end;
         !error && entry != end; entry.increment(error))
        if (extension_of(entry->path()) == ".tmc") files.push_back(entry->path().string());
    std::vector<std::string> above;
    bool is_of_project = false;
    for (fs::directory_iterator entry(folder / "..", error), end; !error && entry != end;
         entry.increment(error)) {
        const bool is_solution = extension_of(entry->path()) == ".tsproj";
        is_of_project = is_of_project || is_solution;
        if (is_solution || extension_of(entry->path()) == ".tmc")
            above.push_back(entry->path().lexically_normal().string());
    }
    if (is_of_project) files.insert(files.end(), above.begin(), above.end());
    std::ranges::sort(files);
    if (files.size() > most_files) files.resize(most_files);
    return files;
}

}  // namespace

void read_event_classes(const Reading& to, const std::string& plcproj, const Mark& where) {
    if (!names(to.project, "tc_event")) return;
    const fs::path folder = fs::path(plcproj).parent_path();
    EventClasses classes;
    Diagnostics unread;
    for (const std::string& file : files_of(folder.empty() ? "." : folder))
        if (const auto allowed = to.resolve(file, where, unread)) classes.add_file(*allowed);
    classes.finish(to.project, plcproj);
}

}  // namespace lineshaft::projects
