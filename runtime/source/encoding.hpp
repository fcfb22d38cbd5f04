#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lineshaft {

/// How names of files end that are read as the standard has it, and of those that may have
/// anything.
inline constexpr std::string_view standard_endings[] = {".st", ".iecst", ".iec"};
inline constexpr std::string_view any_text_endings[] = {
    ".txt", ".text", ".il", ".pou", ".plc", ".stl", ".structuredtext"};

/// Whether the file's name ends as one of Structured Text does, or as that of any text, and it
/// begins with a unit of the language, behind comments, and has the end of one.
bool is_structured_text(const std::filesystem::path& file);

/// A text begins with a unit of Structured Text and has the end of one, and is no list of
/// instructions (AWL): other texts begin with `Type` or `Program`, too.
bool begins_with_unit(std::string_view text);

/// Behind blanks, comments and pragmas, in small letters; empty: there is none.
std::string first_word_of(std::string_view text);

/// The file's name does not say what is in it: `.txt`, `.il`, `.plc`.
bool has_name_of_any_text(const std::filesystem::path& file);

/// A file's text in UTF-8: UTF-16 is known by its byte order mark, and a byte that belongs to no
/// character of UTF-8 is one of Windows-1252.
std::string as_utf8(std::string bytes);

/// A text of UTF-8 as bytes of Windows-1252. What that has not is '?'.
std::string in_windows_1252(std::string_view text);

/// The character that a byte is there; U+FFFD of the five that are none.
char32_t of_windows_1252(unsigned char byte);

/// What a name may have beside letters, digits and `_` of ASCII: as XML 1.0 has it, without signs.
bool is_national_letter(char32_t code);

}  // namespace lineshaft
