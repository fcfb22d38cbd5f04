#include "tools/lineshaft/lsp/positions.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"

namespace lineshaft::lsp {

namespace {

/// Beyond the first plane a character is two units.
std::size_t units_of(const Utf8Character& c, Encoding encoding) {
    if (encoding == Encoding::utf8) return c.bytes;
    return c.code > 0xFFFF ? 2 : 1;
}

}  // namespace

Text::Text(std::string_view text) : text_(text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool is_pair = text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n';
        if (text[i] == '\n' || (text[i] == '\r' && !is_pair)) lines_.push_back(i + 1);
    }
}

std::size_t Text::line_of(std::size_t offset) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(lines_, offset) - lines_.begin()) - 1;
}

std::string_view Text::line(std::size_t index) const {
    const std::size_t end = index + 1 < lines_.size() ? lines_[index + 1] : text_.size();
    std::string_view found = text_.substr(lines_[index], end - lines_[index]);
    if (found.ends_with('\n')) found.remove_suffix(1);
    if (found.ends_with('\r')) found.remove_suffix(1);
    return found;
}

std::size_t Text::offset(const Json& position, Encoding encoding) const {
    const auto index = position.at("line").get<std::uint32_t>();
    if (index >= lines_.size()) return text_.size();
    std::string_view rest = line(index);
    const char* const begin = rest.data();
    for (std::size_t left = position.at("character").get<std::uint32_t>(); !rest.empty();) {
        const Utf8Character c = first_character(rest);
        if (units_of(c, encoding) > left) break;
        left -= units_of(c, encoding);
        rest.remove_prefix(c.bytes);
    }
    return lines_[index] + static_cast<std::size_t>(rest.data() - begin);
}

Json Text::position(std::size_t offset, Encoding encoding) const {
    const std::size_t index = line_of(std::min(offset, text_.size()));
    std::string_view before = line(index).substr(0, offset - lines_[index]);
    std::size_t units = 0;
    while (!before.empty()) {
        const Utf8Character c = first_character(before);
        units += units_of(c, encoding);
        before.remove_prefix(c.bytes);
    }
    return {{"line", index}, {"character", units}};
}

Json Text::range(std::size_t begin, std::size_t end, Encoding encoding) const {
    return {{"start", position(begin, encoding)}, {"end", position(end, encoding)}};
}

std::pair<std::size_t, std::size_t> Text::bytes_of(const Mark& mark) const {
    if (mark.line == 0) return {0, 0};
    const bool marked = text_.starts_with(utf8_byte_order_mark);
    std::size_t begin = marked ? utf8_byte_order_mark.size() : 0;
    for (int i = mark.file->first_line; i < mark.line; ++i) {
        const std::size_t end = text_.find('\n', begin);
        if (end == text_.npos) return {text_.size(), text_.size()};
        begin = end + 1;
    }
    const auto forward = [&](std::size_t from, int characters) {
        for (; characters > 0 && from < text_.size() && text_[from] != '\n'; --characters)
            from += first_character(text_.substr(from)).bytes;
        return from;
    };
    begin = forward(begin, mark.column - 1);
    return {begin, forward(begin, mark.length)};
}

Json range_of(const Mark& mark, Encoding encoding) {
    if (!mark.file) return Text({}).range(0, 0, encoding);
    const Text text(mark.file->text);
    const auto [begin, end] = text.bytes_of(mark);
    Json range = text.range(begin, end, encoding);
    for (const char* side : {"start", "end"})
        if (mark.line > 0)
            range[side]["line"] = range[side]["line"].get<int>() + mark.file->first_line - 1;
    return range;
}

std::string path_of(const std::string& uri) {
    constexpr std::string_view scheme = "file://";
    if (!uri.starts_with(scheme)) return {};
    const std::size_t slash = uri.find('/', scheme.size());
    if (slash == uri.npos) return {};
    std::string path;
    for (std::size_t i = slash; i < uri.size(); ++i) {
        unsigned code = 0;
        const char* const digits = uri.data() + i + 1;
        const bool is_code = uri[i] == '%' && i + 2 < uri.size() &&
                             std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
        path += is_code ? static_cast<char>(code) : uri[i];
        if (is_code) i += 2;
    }
    return std::filesystem::path(path).lexically_normal().string();
}

std::string uri_of(const std::string& path) {
    constexpr std::string_view plain = "/-._~";
    std::string uri = "file://";
    for (const char c : path)
        if (is_letter(c) || is_digit(c) || plain.find(c) != plain.npos)
            uri += c;
        else
            uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    return uri;
}

}  // namespace lineshaft::lsp
