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

std::size_t end_of_tools_comment(std::string_view text, std::size_t at) {
    constexpr std::string_view key = "(*@KEY@:", last = "END_DESCRIPTION";
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("(*DBG:")) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        const std::size_t end = line.rfind("*)");
        return at + (end == line.npos ? line.size() : end + 2);
    }
    if (!rest.starts_with(key)) return 0;
    const std::size_t word = rest.find_first_not_of(' ', key.size());
    const std::size_t end = rest.find(last);
    if (end == rest.npos || !rest.substr(word).starts_with("DESCRIPTION")) return 0;
    const std::size_t close = rest.find("*)", end);
    return close == rest.npos ? 0 : at + close + 2;
}

std::size_t end_of_conflict(std::string_view text, std::size_t at) {
    const std::string_view rest = text.substr(at);
    const auto line_behind = [&](std::size_t begin) { return text.find('\n', begin); };
    if (rest.starts_with("<<<<<<< ") || rest.starts_with(">>>>>>> ")) return line_behind(at);
    if (rest.starts_with("||||||| ")) return text.find("\n=======", at);
    if (!rest.starts_with("=======\n") && !rest.starts_with("=======\r\n")) return text.npos;
    const std::size_t theirs = text.find("\n>>>>>>> ", at);
    return theirs == text.npos ? theirs : line_behind(theirs + 1);
}

bool is_translated_comment(std::string_view text, std::size_t at) {
    if (!text.substr(at).starts_with("(/*")) return false;
    const std::size_t end = text.find("*/", at);
    return end != text.npos && text.substr(end).starts_with("*/)");
}

std::size_t end_of_foreign_code(std::string_view text, std::size_t at) {
    if (text.substr(at).starts_with("{{")) {
        const std::size_t end = text.find("}}", at);
        return end == text.npos ? end : end + 2;
    }
    const std::size_t word = text.find_first_not_of(" \t\r\n", at + 1);
    if (text[at] != '{' || word == text.npos) return text.npos;
    const std::size_t behind = text.find_first_of(" \t\r\n{}:'", word);
    if (!same_name(text.substr(word, behind - word), "external")) return text.npos;
    std::size_t depth = 0;
    for (std::size_t end = at; end < text.size(); ++end) {
        depth += text[end] == '{';
        if (text[end] == '}' && --depth == 0) return end + 1;
    }
    return text.npos;
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
