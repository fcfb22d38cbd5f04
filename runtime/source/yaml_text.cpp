#include "runtime/source/yaml_text.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t most_bad_characters = 10;
constexpr std::size_t most_open_brackets = 1000;

std::string_view fault_of(const Utf8Character& character, std::string_view rest) {
    if (!character.valid) return "a byte that is not UTF-8";
    if (character.code == 0xFEFF) return "a byte order mark after its beginning";
    if (character.code == '\r' && !rest.starts_with("\r\n")) {
        return "a carriage return without a line feed";
    }
    if (character.code == '\n' || character.code == '\r' || character.code == '\t') return {};
    if (character.code == 0) return "a NUL character";
    return is_control(character.code) ? "a control character" : std::string_view();
}

bool is_utf16(std::string_view text) {
    return text.starts_with("\xFE\xFF") || text.starts_with("\xFF\xFE");
}

}  // namespace

YamlText::YamlText(std::shared_ptr<const SourceFile> file) : file_(std::move(file)) {
    text_ = file_->text;
    if (text_.starts_with(utf8_byte_order_mark)) {
        text_.remove_prefix(utf8_byte_order_mark.size());
    }
    for (std::size_t i = text_.find('\n'); i != text_.npos; i = text_.find('\n', i + 1))
        lines_.push_back(i + 1);
    if (!std::ranges::all_of(text_, is_ascii)) number_characters();
}

std::size_t YamlText::offset(const YAML::Mark& mark) const {
    return std::min(static_cast<std::size_t>(std::max(mark.pos, 0)), text_.size());
}

std::size_t YamlText::line_index(std::size_t offset) const {
    const auto after = std::upper_bound(lines_.begin(), lines_.end(), offset);
    return static_cast<std::size_t>(after - lines_.begin()) - 1;
}

std::size_t YamlText::line_break(std::size_t offset) const {
    const std::size_t next = line_index(offset) + 1;
    return next < lines_.size() ? lines_[next] - 1 : text_.size();
}

std::size_t YamlText::line_end(std::size_t offset) const {
    std::size_t end = line_break(offset);
    while (end > offset && std::string_view(" \t\r").find(text_[end - 1]) != text_.npos) --end;
    return end;
}

Mark YamlText::mark(std::size_t begin, std::size_t end) const {
    const std::size_t line = line_index(begin);
    return {file_, static_cast<int>(line) + file_->first_line,
            static_cast<int>(characters(lines_[line], begin)) + 1,
            std::max(1, static_cast<int>(characters(begin, end)))};
}

void YamlText::number_characters() {
    characters_.resize(text_.size() + 1);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < text_.size(); ++count)
        for (std::size_t end = i + first_character(text_.substr(i)).bytes; i < end; ++i)
            characters_[i] = count;
    characters_.back() = count;
}

std::size_t YamlText::characters(std::size_t begin, std::size_t end) const {
    return characters_.empty() ? end - begin : characters_[end] - characters_[begin];
}

void check_characters(const YamlText& source, Diagnostics& out) {
    if (is_utf16(source.text())) {
        out.add(code::not_plain_text, source.mark(0), "the file is UTF-16 or UTF-32, not UTF-8",
                "save it as UTF-8");
        return;
    }
    std::size_t found = 0;
    std::string_view rest = source.text();
    while (found < most_bad_characters) {
        rest.remove_prefix(plain_length(rest));
        if (rest.empty()) return;
        const Utf8Character character = first_character(rest);
        const std::string_view fault = fault_of(character, rest);
        if (!fault.empty()) {
            const std::size_t offset = source.text().size() - rest.size();
            const auto byte = static_cast<unsigned char>(rest.front());
            out.add(code::not_plain_text, source.mark(offset),
                    fmt::format("the file contains {}", fault),
                    character.valid
                        ? fmt::format("it is U+{:04X}", static_cast<unsigned>(character.code))
                        : fmt::format("the byte is {:02X}", byte));
            ++found;
        }
        rest.remove_prefix(character.bytes);
    }
}

/// Before its first event the library collects everything up to the first bracket that closes: a
/// megabyte of '[' would be 250 MB. Brackets in texts and comments count too, hence the margin.
void check_brackets(const YamlText& source, const YamlLimits& limits, Diagnostics& out) {
    const std::size_t most = std::max(limits.depth, most_open_brackets);
    std::size_t open = 0;
    std::size_t too_deep = 0;
    for (std::size_t i = 0; i < source.text().size() && open <= most; ++i) {
        const char c = source.text()[i];
        if ((c == ']' || c == '}') && open > 0) --open;
        if (c != '[' && c != '{') continue;
        ++open;
        if (open == limits.depth) too_deep = i;
    }
    if (open <= most) return;
    out.add(code::file_too_large, source.mark(too_deep),
            fmt::format("the file is nested deeper than {} levels", limits.depth));
}

std::size_t quoted_end(std::string_view text, std::size_t begin) {
    const char quote = text[begin];
    const std::string_view stops = quote == '"' ? "\"\\" : "'";
    std::size_t i = text.find_first_of(stops, begin + 1);
    while (i != std::string_view::npos) {
        const bool doubled = quote == '\'' && text.substr(i).starts_with("''");
        if (text[i] == quote && !doubled) return i + 1;
        i = text.find_first_of(stops, i + 2);
    }
    return i;
}

bool is_quote(char c) {
    return c == '"' || c == '\'';
}

std::size_t scalar_end(const YamlText& source, std::size_t begin, std::string_view value) {
    const char first = source.at(begin);
    if (first == '|' || first == '>') return begin + 1;
    if (!is_quote(first) && source.text().substr(begin).starts_with(value)) {
        return begin + value.size();
    }
    const std::size_t end = is_quote(first) ? quoted_end(source.text(), begin) : source.text().npos;
    return end <= source.line_break(begin) ? end : source.line_end(begin);
}

std::size_t null_word(const YamlText& source, std::size_t offset) {
    for (const std::string_view word : {"~", "null", "Null", "NULL"}) {
        if (!source.text().substr(offset).starts_with(word)) continue;
        const char next = source.at(offset + word.size());
        if (std::string_view("\0 \t\r\n,]}", 8).find(next) != std::string_view::npos) {
            return word.size();
        }
    }
    return 0;
}

std::size_t after_colon(const YamlText& source, std::size_t key_end) {
    std::size_t colon = key_end;
    while (source.at(colon) == ' ' || source.at(colon) == '\t') ++colon;
    return source.at(colon) == ':' ? colon + 1 : key_end;
}

std::size_t after_dash(const YamlText& source, std::size_t next) {
    std::size_t end = next;
    for (std::size_t line = source.line_index(next) + 1; line-- > 0;) {
        const std::size_t begin = source.line_begin(line);
        const std::string_view written = source.text().substr(begin, end - begin);
        const std::string_view head = written.substr(0, written.find_first_not_of(" \t-"));
        const std::size_t dash = head.rfind('-');
        if (dash != std::string_view::npos) return begin + dash + 1;
        end = begin;
    }
    return next;
}

std::string yaml_quoted(std::string_view text) {
    std::string out = "'";
    for (const char c : text) out.append(c == '\'' ? 2 : 1, c);
    return out + "'";
}

std::string yaml_name(std::string_view name) {
    constexpr std::string_view letters =
        "_.0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    const bool is_plain = name.find_first_not_of(letters) == name.npos &&
                          name.find_first_of(letters.substr(12)) != name.npos;
    static constexpr std::string_view words[] = {"null", "true", "false", "nan", "inf"};
    const bool is_word =
        std::ranges::any_of(words, [&](std::string_view word) { return lower(name) == word; });
    return is_plain && !is_word ? std::string(name) : yaml_quoted(name);
}

}  // namespace lineshaft
