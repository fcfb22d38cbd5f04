#include "runtime/source/encoding.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <span>
#include <system_error>
#include <utility>

#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"
#include "runtime/source/utf8.hpp"

namespace lineshaft {

namespace {

struct Letters {
    char32_t first, last;
};

constexpr Letters national_letters[] = {{0x00B5, 0x00B5}, {0x00C0, 0x00D6}, {0x00D8, 0x00F6},
                                        {0x00F8, 0x037D}, {0x037F, 0x1FFF}, {0x2C00, 0x2FEF},
                                        {0x3005, 0xD7FF}, {0xF900, 0xFDCF}};

/// The characters 0x80 to 0x9F, of which five are none; all others are as in Unicode.
constexpr char32_t windows_1252[] = {
    0x20AC, 0xFFFD, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0xFFFD, 0x017D, 0xFFFD, 0xFFFD, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0xFFFD, 0x017E, 0x0178};

/// Half a pair of surrogates, and half a unit at the end, are U+FFFD.
std::string of_utf16(std::string_view bytes, bool big_endian) {
    const auto unit = [&](std::size_t at) -> char32_t {
        const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[at + i]); };
        if (at + 1 >= bytes.size()) return 0xFFFD;
        return big_endian ? byte(0) * 256U + byte(1) : byte(1) * 256U + byte(0);
    };
    std::string text;
    text.reserve(bytes.size());
    for (std::size_t at = 0; at < bytes.size(); at += 2) {
        char32_t code = unit(at);
        const bool leads = code >= 0xD800 && code < 0xDC00;
        const char32_t behind = leads && at + 2 < bytes.size() ? unit(at + 2) : 0;
        if (behind >= 0xDC00 && behind < 0xE000) {
            code = 0x10000 + ((code - 0xD800) << 10) + (behind - 0xDC00);
            at += 2;
        } else if (code >= 0xD800 && code < 0xE000) {
            code = 0xFFFD;
        }
        add_character(text, code);
    }
    return text;
}

/// Behind blanks, comments and pragmas.
std::string_view without_comments(std::string_view text) {
    constexpr std::pair<std::string_view, std::string_view> all[] = {
        {"(*", "*)"}, {"/*", "*/"}, {"//", "\n"}, {"{", "}"}};
    for (bool goes_on = true; goes_on;) {
        text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
        goes_on = false;
        for (const auto& [begin, end] : all) {
            if (!text.starts_with(begin)) continue;
            const std::size_t last = text.find(end, begin.size());
            text.remove_prefix(last == text.npos ? text.size() : last + end.size());
            goes_on = true;
        }
    }
    return text;
}

bool is_text_with_unit(const std::filesystem::path& file) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(file, unknown)) return false;
    std::string first(65'536, '\0');
    std::ifstream bytes(file, std::ios::binary);
    bytes.read(first.data(), static_cast<std::streamsize>(first.size()));
    first.resize(static_cast<std::size_t>(bytes.gcount()));
    return begins_with_unit(as_utf8(std::move(first)));
}

}  // namespace

std::string first_word_of(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    text = without_comments(text);
    return lower(std::string(text.substr(0, text.find_first_of(" \t\r\n\"(*"))));
}

bool begins_with_unit(std::string_view written) {
    constexpr std::string_view words[] = {
        "program",      "function_block", "function",  "type",       "var",
        "class",        "interface",      "namespace", "data_block", "organization_block",
        "configuration"};
    const std::string text = lower(std::string(written)), word = first_word_of(written);
    const std::string unit = word.starts_with("var_") ? "var" : word;
    return std::ranges::find(words, unit) != std::end(words) &&
           text.find("end_" + unit) != text.npos && text.find("\nnetwork") == text.npos;
}

char32_t of_windows_1252(unsigned char byte) {
    return byte >= 0x80 && byte < 0xA0 ? windows_1252[byte - 0x80] : byte;
}

static bool is_among(std::span<const std::string_view> endings, std::string_view ending) {
    return std::ranges::find(endings, ending) != endings.end();
}

bool is_structured_text(const std::filesystem::path& file) {
    static constexpr std::string_view of_vendors[] = {".scl", ".s7dcl", ".udt", ".db",
                                                      ".exp", ".typ",   ".var", ".fun"};
    const std::string extension = extension_of(file);
    return is_among(standard_endings, extension) || is_among(of_vendors, extension) ||
           (has_name_of_any_text(file) && is_text_with_unit(file));
}

bool has_name_of_any_text(const std::filesystem::path& file) {
    return is_among(any_text_endings, extension_of(file));
}

std::string as_utf8(std::string bytes) {
    if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF"))
        return of_utf16(std::string_view(bytes).substr(2), bytes.starts_with("\xFE"));
    std::string text;
    for (std::string_view rest = bytes; !rest.empty();) {
        const Utf8Character character = first_character(rest);
        if (character.valid)
            text += rest.substr(0, character.bytes);
        else
            add_character(text, of_windows_1252(static_cast<unsigned char>(rest.front())));
        rest.remove_prefix(character.bytes);
    }
    return text;
}

std::string in_windows_1252(std::string_view text) {
    std::string bytes;
    for (; !text.empty(); text.remove_prefix(first_character(text).bytes)) {
        const auto [code, size, is_valid] = first_character(text);
        const auto* const known = std::ranges::find(windows_1252, code);
        if (!is_valid || code < 0x80 || (code >= 0xA0 && code <= 0xFF))
            bytes += is_valid ? static_cast<char>(code) : text.front();
        else if (code != 0xFFFD && known != std::end(windows_1252))
            bytes += static_cast<char>(0x80 + (known - std::begin(windows_1252)));
        else
            bytes += '?';
    }
    return bytes;
}

bool is_national_letter(char32_t code) {
    return std::ranges::any_of(national_letters,
                               [&](const Letters& l) { return code >= l.first && code <= l.last; });
}

}  // namespace lineshaft
