#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <yaml-cpp/mark.h>

#include "runtime/source/yaml.hpp"

namespace lineshaft {

/// The text of a YAML file with places: byte offsets to lines and characters. A byte order mark at
/// its beginning is no part of it.
class YamlText {
  public:
    explicit YamlText(std::shared_ptr<const SourceFile> file);

    std::string_view text() const { return text_; }
    char at(std::size_t offset) const { return offset < text_.size() ? text_[offset] : '\0'; }
    std::size_t offset(const YAML::Mark& mark) const;

    /// Index of the line that holds `offset`, from 0.
    std::size_t line_index(std::size_t offset) const;
    std::size_t line_begin(std::size_t index) const { return lines_[index]; }
    /// Offset of the line feed that ends the line of `offset`, or of the text's end.
    std::size_t line_break(std::size_t offset) const;
    /// Where the line that holds `offset` ends, spaces and line end not counted.
    std::size_t line_end(std::size_t offset) const;

    Mark mark(std::size_t begin, std::size_t end) const;
    Mark mark(std::size_t offset) const { return mark(offset, offset); }

  private:
    void number_characters();
    std::size_t characters(std::size_t begin, std::size_t end) const;

    std::shared_ptr<const SourceFile> file_;
    std::string_view text_;
    std::vector<std::size_t> lines_{0};
    std::vector<std::uint32_t> characters_;  // before each byte; empty for a text of ASCII
};

/// Reports what no YAML file may hold, before it is parsed: characters that are none of its, and
/// brackets that are nested so deep that the library would need too much memory.
void check_characters(const YamlText& source, Diagnostics& out);
void check_brackets(const YamlText& source, const YamlLimits& limits, Diagnostics& out);

bool is_quote(char c);

/// Offset after the closing quote of the quoted text at `begin`, npos when there is none.
std::size_t quoted_end(std::string_view text, std::size_t begin);

/// Offset after a scalar as written, or where its first line ends.
std::size_t scalar_end(const YamlText& source, std::size_t begin, std::string_view value);

/// Length of `~`, `null`, `Null` or `NULL` when it stands at `offset` as a word, else 0.
std::size_t null_word(const YamlText& source, std::size_t offset);

/// Where the value of the key that ends at `key_end` would begin.
std::size_t after_colon(const YamlText& source, std::size_t key_end);

/// Where the item of the last `-` before `next` would begin: between are blanks and comments only.
std::size_t after_dash(const YamlText& source, std::size_t next);

/// How a text is written: `'it''s'`.
std::string yaml_quoted(std::string_view text);

/// How a name is written within braces or brackets: in quotes where it is not letters alone, or a
/// word of YAML's.
std::string yaml_name(std::string_view name);

}  // namespace lineshaft
