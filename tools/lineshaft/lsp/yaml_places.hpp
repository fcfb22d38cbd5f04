#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/lineshaft/lsp/requests.hpp"

namespace lineshaft::lsp {

/// Where a byte of a YAML text stands, which may be half-written: keys from the root on, `[]` for
/// an item of a list.
struct YamlPlace {
    std::vector<std::string> keys;
    bool is_value = false;  ///< behind a colon, or an item
    std::string written;    ///< of the word that ends there
};
YamlPlace place_at(const std::string& text, std::size_t offset);

/// A word in a program, and what of it a wire's `owner.port` takes apart.
struct YamlName {
    std::vector<std::string> keys;
    bool is_key = false;
    std::string owner;  ///< before the dot, or of the block at whose key it is
    std::string port;   ///< behind it; empty: the owner itself
    std::string word;
    std::size_t begin = 0, end = 0;  ///< of the part that the byte is in
};
std::optional<YamlName> name_at(const std::string& text, std::size_t offset);

/// The kind of block that the name is, or is a pin of; empty: neither.
std::string kind_meant(const Session& session, const std::string& path, const YamlName& name);

/// Part of a word of a YAML text.
bool is_of_name(char c);

/// Where the block, input, output, task or parameter is written that stands there.
std::optional<Mark> declared_in_yaml(const Session& session, const Asked& where);

/// What a key means, or a kind of block or its pin; empty: nothing is known.
std::string about_yaml(const Session& session, const Asked& where);

Json complete_yaml(const Session& session, const Asked& where);

}  // namespace lineshaft::lsp
