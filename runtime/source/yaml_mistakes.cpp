#include "runtime/source/yaml_mistakes.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/habits.hpp"

namespace lineshaft {

namespace {

/// What the library says, and what we say instead.
struct Translation {
    std::string_view library;  ///< beginning of its message
    const char* code;
    std::string_view message;
    std::string_view help;
};

const Translation* translation_of(std::string_view message) {
    static constexpr std::string_view quotes = "a text with special characters stands in quotes";
    static const auto table = std::to_array<Translation>({
        {YAML::ErrorMsg::TAB_IN_INDENTATION, code::not_yaml,
         "a tab character indents the line; YAML indents with spaces", "replace it by spaces"},
        {YAML::ErrorMsg::END_OF_MAP_FLOW, code::not_yaml, "expected ',' or '}'", quotes},
        {YAML::ErrorMsg::END_OF_MAP, code::not_yaml, "this does not continue the map above",
         "expected 'key: value', indented like the keys above"},
        {YAML::ErrorMsg::END_OF_SEQ_FLOW, code::not_yaml, "expected ',' or ']'", quotes},
        {YAML::ErrorMsg::END_OF_SEQ, code::not_yaml, "this does not continue the list above",
         "expected '- item', indented like the items above"},
        {YAML::ErrorMsg::UNKNOWN_TOKEN, code::not_yaml, "no value may begin with this character",
         quotes},
        {YAML::ErrorMsg::DOC_IN_SCALAR, code::not_yaml, "a document's mark stands inside quotes",
         "the quote that opens this text is not closed before it"},
        {YAML::ErrorMsg::EOF_IN_SCALAR, code::not_yaml, "a quote is never closed",
         YamlBuilder::quote_help},
        {YAML::ErrorMsg::FLOW_END, code::not_yaml, "this bracket closes nothing", quotes},
        {YAML::ErrorMsg::BLOCK_ENTRY, code::not_yaml, "no list item may begin here",
         "each '- item' stands on a line of its own, or the list in brackets"},
        {YAML::ErrorMsg::MAP_KEY, code::not_yaml, "no key may begin here", quotes},
        {YAML::ErrorMsg::MAP_VALUE, code::not_yaml, "no ':' may stand here",
         "a key is indented like its neighbours, a nested map begins on a line of its own, a text "
         "with ': ' stands in quotes"},
        {YAML::ErrorMsg::INVALID_ESCAPE, code::not_yaml,
         "this escape in double quotes is not known",
         "a backslash is written '\\\\'; in single quotes it stands for itself"},
        {YAML::ErrorMsg::UNKNOWN_ANCHOR, code::yaml_anchor_or_tag, "this is a YAML alias",
         YamlBuilder::no_alias},
        {YAML::ErrorMsg::MULTIPLE_ANCHORS, code::yaml_anchor_or_tag, "this is a YAML anchor",
         YamlBuilder::no_alias},
        {YAML::ErrorMsg::ALIAS_NOT_FOUND, code::yaml_anchor_or_tag, "a YAML alias has no name",
         quotes},
        {YAML::ErrorMsg::ANCHOR_NOT_FOUND, code::yaml_anchor_or_tag, "a YAML anchor has no name",
         quotes},
        {YAML::ErrorMsg::CHAR_IN_ALIAS, code::yaml_anchor_or_tag, "this is a YAML alias",
         YamlBuilder::no_alias},
        {YAML::ErrorMsg::CHAR_IN_ANCHOR, code::yaml_anchor_or_tag, "this is a YAML anchor",
         YamlBuilder::no_alias},
        {YAML::ErrorMsg::MULTIPLE_TAGS, code::yaml_anchor_or_tag, "this is a YAML tag",
         YamlBuilder::no_tag},
        {YAML::ErrorMsg::CHAR_IN_TAG_HANDLE, code::yaml_anchor_or_tag, "this is a YAML tag",
         YamlBuilder::no_tag},
        {YAML::ErrorMsg::TAG_WITH_NO_SUFFIX, code::yaml_anchor_or_tag, "this is a YAML tag",
         YamlBuilder::no_tag},
        {YAML::ErrorMsg::END_OF_VERBATIM_TAG, code::yaml_anchor_or_tag, "this is a YAML tag",
         YamlBuilder::no_tag},
    });
    const auto found = std::find_if(table.begin(), table.end(), [&](const Translation& entry) {
        return message.starts_with(entry.library);
    });
    return found == table.end() ? nullptr : &*found;
}

/// The tab in the indentation of the line that holds `offset`, or npos.
std::size_t indenting_tab(const YamlText& source, std::size_t offset) {
    const std::size_t begin = source.line_begin(source.line_index(offset));
    const std::string_view line = source.text().substr(begin, offset - begin);
    const std::size_t tab = line.substr(0, line.find_first_not_of(" \t")).find('\t');
    return tab == std::string_view::npos ? tab : begin + tab;
}

/// A space or a dash that begins the line of `offset`, or the one before, and is not the
/// keyboard's: to YAML it is text.
bool report_look_alike(const YamlText& source, std::size_t offset, Diagnostics& out) {
    const std::size_t last = source.line_index(offset);
    for (std::size_t line = last;; --line) {
        const std::size_t begin = source.line_begin(line);
        const std::string_view text = source.text().substr(begin, source.line_break(begin) - begin);
        const auto found = find_look_alike(text);
        if (found && text.find_first_not_of(' ') == found->offset) {
            out.add(code::look_alike_character, source.mark(begin + found->offset),
                    fmt::format("a line begins with {}", found->name),
                    fmt::format("write {} instead", found->instead));
            return true;
        }
        if (line == 0 || line + 1 == last) return false;
    }
}

/// Place of the colon of `key:value` in the last line before that of `offset`, or npos: YAML reads
/// on there as in one text of two lines.
std::size_t glued_colon(const YamlText& source, std::size_t offset) {
    const std::size_t begin = source.line_begin(source.line_index(offset));
    const std::size_t end = source.text().substr(0, begin).find_last_not_of(" \r\n");
    if (end == std::string_view::npos) return end;
    const std::size_t start = source.line_begin(source.line_index(end));
    const std::string_view line = source.text().substr(start, end + 1 - start);
    const std::size_t key = line.find_first_not_of(" -");
    const std::size_t colon = line.find_first_of(": #\"'[{", key);
    if (colon == std::string_view::npos || line[colon] != ':' || colon + 1 == line.size()) {
        return std::string_view::npos;
    }
    return line[colon + 1] == ' ' ? std::string_view::npos : start + colon;
}

/// `z.dst[6].q`, whose bracket at `offset` YAML takes for that of a list; empty when there is none.
std::string_view indexed_name(std::string_view text, std::size_t offset) {
    constexpr std::string_view name =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.";
    const std::size_t begin = text.substr(0, offset).find_last_not_of(name) + 1;
    std::size_t end = offset;
    while (end < text.size() && text[end] == '[') {
        const std::size_t closed = text.substr(0, text.find('\n', end)).find(']', end);
        if (closed == std::string_view::npos) return {};
        end = std::min(text.find_first_not_of(name, closed + 1), text.size());
    }
    return begin < offset && offset < end ? text.substr(begin, end - begin) : std::string_view();
}

}  // namespace

void report_mistake(const YAML::Exception& fault, const YamlText& source,
                    const YamlBuilder& builder, Diagnostics& out) {
    std::size_t offset = source.offset(fault.mark);
    const bool at_end = offset == source.text().size();
    if (at_end) {
        const std::size_t last = source.text().find_last_not_of(" \t\r\n");
        offset = last == std::string_view::npos ? 0 : last + 1;
    }
    const std::size_t tab = indenting_tab(source, offset);
    if (tab != std::string_view::npos) {
        out.add(code::not_yaml, source.mark(tab),
                "a tab character indents the line; YAML indents with spaces",
                "replace it by spaces");
        return;
    }
    if (report_look_alike(source, offset, out)) return;
    const auto [opened, bracket] = builder.open_bracket();
    const bool in_brackets = bracket == '[' || bracket == '{';
    if (at_end && in_brackets) {
        out.add(code::not_yaml, opened, fmt::format("this '{}' is never closed", bracket));
        return;
    }
    const std::size_t glued = glued_colon(source, offset);
    if (fault.msg == YAML::ErrorMsg::MAP_VALUE && glued != std::string_view::npos) {
        out.add(code::not_yaml, source.mark(glued), "a blank is missing after ':'");
        return;
    }
    const Translation* known = translation_of(fault.msg);
    if (known == nullptr) {
        out.add(code::not_yaml, source.mark(offset),
                fmt::format("this is not YAML: {}", fault.msg));
        return;
    }
    const bool unclosed = in_brackets && known->message.starts_with("expected");
    const Mark here = source.mark(offset);
    std::string help(known->help);
    if (const std::string_view name = indexed_name(source.text(), offset); !name.empty())
        help = fmt::format("a name with an index stands in quotes here: '{}'", name);
    else if (unclosed && opened.line != here.line)
        return out.add(code::not_yaml, opened, fmt::format("this '{}' is not closed", bracket),
                       fmt::format("{} before line {}", known->message, here.line));
    else if (unclosed)
        help = fmt::format("the '{}' of line {} is still open", bracket, opened.line);
    out.add(known->code, source.mark(offset), std::string(known->message), std::move(help));
}

}  // namespace lineshaft
