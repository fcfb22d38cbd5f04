#include "runtime/st/syntax/foreign_text.hpp"

#include <algorithm>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::st {

namespace {

struct ForeignSection {
    std::string_view first, last;
    bool is_alone;  ///< in its line
};
constexpr ForeignSection foreign_sections[] = {{"visualisation", "END_VISUALISATION", false},
                                               {"plc_configuration", "PLC_END", true},
                                               {"_alarmconfig", "_END_ALARMCONFIG", true},
                                               {"_workspace", "_END_WORKSPACE", true},
                                               {"library", "END_LIBRARY", true},
                                               {"macro", "END_MACRO", true},
                                               {"resource", "END_RESOURCE", true}};

}  // namespace

std::size_t end_of_section(std::string_view text, std::size_t at, std::string_view word) {
    const auto* section = find_called(foreign_sections, word, &ForeignSection::first);
    if (!section) return text.npos;
    const std::size_t next = text.find_first_not_of(" \t\r", at);
    if (section->is_alone && next != text.npos && text[next] != '\n') return text.npos;
    const std::size_t end = text.find(section->last, at);
    return end == text.npos ? end : end + section->last.size();
}

bool is_title(std::string_view text, std::size_t at, std::string_view word) {
    if (!same_name(word, "title")) return false;
    const std::size_t next = text.find_first_not_of(" \t", at);
    return next != text.npos && text[next] == '=';
}

std::string_view instead_of(std::string_view text) {
    if (text.starts_with("!=")) return "write '<>'";
    if (text.starts_with('!')) return "write NOT";
    if (text.starts_with('?')) return "write IF, or SEL(condition, otherwise, then)";
    if (text.starts_with('%')) return "write MOD";
    if (text.starts_with("||")) return "write OR";
    return "names have letters, digits and '_'; others stand in quotes";
}

}  // namespace lineshaft::st
