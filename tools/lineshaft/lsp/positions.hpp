#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/messages/messages.hpp"
#include "runtime/source/diagnostic.hpp"

namespace lineshaft::lsp {

/// What a character counts in a position: units of 16 bits, or bytes.
enum class Encoding : std::uint8_t { utf16, utf8 };

/// A text in which the protocol's positions are places: line and character from 0. Lines end as the
/// protocol says, with "\n", "\r\n" or "\r".
class Text {
  public:
    explicit Text(std::string_view text);

    /// A position behind its line's end is that end, one behind the last line the text's end.
    std::size_t offset(const Json& position, Encoding encoding) const;
    Json position(std::size_t offset, Encoding encoding) const;
    Json range(std::size_t begin, std::size_t end, Encoding encoding) const;

    /// Where a message's mark begins and ends, whose lines end with "\n" and whose columns are
    /// characters.
    std::pair<std::size_t, std::size_t> bytes_of(const Mark& mark) const;

    std::string_view text() const { return text_; }

  private:
    std::size_t line_of(std::size_t offset) const;
    std::string_view line(std::size_t index) const;

    std::string_view text_;
    std::vector<std::size_t> lines_{0};
};

/// Where a mark is in its file, which may be a part of one.
Json range_of(const Mark& mark, Encoding encoding);

/// The path of a `file:` URI, without dots; empty for any other.
std::string path_of(const std::string& uri);
std::string uri_of(const std::string& path);

}  // namespace lineshaft::lsp
