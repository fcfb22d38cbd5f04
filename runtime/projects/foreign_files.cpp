#include "runtime/projects/foreign_files.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"

namespace lineshaft::projects {

namespace fs = std::filesystem;

namespace {

struct ForeignForm {
    std::string_view endings, tool, help;  ///< each ending between blanks
};
constexpr std::string_view as_plcopen =
    "export it as PLCopen XML there, or give its Structured Text";
constexpr ForeignForm foreign_forms[] = {
    {" .l5x .l5k .acd ", "Rockwell's Studio 5000 Logix Designer",
     "copy the Structured Text of its routines into .st files, with their tags in VAR"},
    {" .fbt .fboot ", "4diac (IEC 61499)",
     "copy the algorithms in Structured Text into a FUNCTION_BLOCK"},
    {" .smc2 .csm2 .slr .oem ", "Omron's Sysmac Studio",
     "export its programs there as IEC 61131-10 XML, which is read"},
    {" .xef .xst .zef .stu .xbd .xsy .xdb ", "Schneider's Control Expert",
     "copy the text of its sections into .st files, with their variables in VAR"},
    {" .pcwex .pcwef .pcwlx ", "Phoenix Contact's PLCnext Engineer",
     "export its POUs there as IEC 61131-10 XML, which is read"},
    {" .zwt .mwt ", "Phoenix Contact's PC WORX or MULTIPROG", as_plcopen},
    {" .gx3 .gxw ", "Mitsubishi's GX Works", as_plcopen},
    {" .project .library .compiled-library .projectarchive ", "CODESYS, as an archive",
     "export it there: Project > Export, or Export PLCopenXML"},
    {" .tnzip .tpzip .tszip .tmz ", "Beckhoff's TwinCAT, as an archive",
     "unpack it, and name the .plcproj"},
    {" .smbp .smbe ", "Schneider's Machine Expert Basic", as_plcopen}};

bool is_archive_of_tia(std::string_view ending) {
    for (const std::string_view begin : {".zap", ".ap", ".al", ".zal"})
        if (ending.starts_with(begin) && ending.size() > begin.size() &&
            std::ranges::all_of(ending.substr(begin.size()),
                                [](char c) { return is_digit(c) || c == '_'; }))
            return true;
    return false;
}

}  // namespace

std::optional<ForeignFile> foreign_file(const fs::path& file) {
    const std::string ending = extension_of(file);
    if (is_archive_of_tia(ending))
        return ForeignFile{"a project of Siemens' TIA Portal, as it keeps it",
                           "export its blocks there: as SIMATIC SD documents, XML or SCL"};
    const auto* form = std::ranges::find_if(foreign_forms, [&](const ForeignForm& each) {
        return !ending.empty() &&
               each.endings.find(fmt::format(" {} ", ending)) != std::string_view::npos;
    });
    if (form == std::end(foreign_forms)) return {};
    return ForeignFile{fmt::format("a file of {}", form->tool), std::string(form->help)};
}

std::string foreign_files_below(const fs::path& folder) {
    std::map<std::string, std::size_t> counts;  // by ending and what it is
    std::error_code error, unknown;
    constexpr auto options = fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator entry(folder, options, error), end;
         !error && entry != end; entry.increment(error)) {
        const auto known = foreign_file(entry->path());
        if (known && entry->is_regular_file(unknown))
            ++counts[fmt::format("{} ({})", entry->path().extension().string(), known->what)];
    }
    std::string text;
    for (const auto& [what, count] : counts)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
    return text;
}

}  // namespace lineshaft::projects
