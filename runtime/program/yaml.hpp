#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/program/diagnostic.hpp"

namespace lineshaft {

/// One node of a YAML file with its place. The only layer that touches the YAML library: it owns marks and
/// limits, and lets through plain maps, sequences and scalars only.
struct Node {
    enum class Kind { scalar, map, sequence };

    Kind kind = Kind::scalar;
    Mark mark;                                  ///< of the scalar's text, or of the first entry
    std::string text;                           ///< scalar; empty for an empty value (`key:`)
    bool quoted = false;                        ///< scalar in quotes: never a number or a wire
    std::string parameter;                      ///< name, where the text was written as `$name`
    std::vector<std::pair<Node, Node>> entries; ///< map, in file order; keys are scalars, unique
    std::vector<Node> items;                    ///< sequence

    bool is_scalar() const { return kind == Kind::scalar; }
    bool is_map() const { return kind == Kind::map; }
    bool is_sequence() const { return kind == Kind::sequence; }
    bool is_empty() const { return is_scalar() && text.empty() && !quoted; }
    const Node* find(std::string_view key) const;  ///< map's value, or null
    std::vector<std::string> keys() const;
};

struct YamlLimits {
    std::size_t bytes = 1 << 20;
    std::size_t nodes = 100'000;
    std::size_t depth = 64;
    std::size_t scalar_bytes = 64 << 10;
};

/// The one document of `file`, whose root is a map. Empty when anything is wrong; then `out` says what:
///   L0101 not YAML (the library's message, tabs named as such)   L0102 duplicate key (names the first's line)
///   L0103 a second document    L0104 alias, anchor, tag or merge key    L0105 the root is no map, or empty file
///   L0106 a limit is exceeded (says which, and the limit)   L0107 a key that is no scalar
///   L0108 not UTF-8, a NUL or another control character, a byte order mark other than UTF-8's
std::optional<Node> parse_yaml(std::shared_ptr<const SourceFile> file, Diagnostics& out,
                               const YamlLimits& limits = {});

/// Reads a whole file. Empty and an L0001 (cannot be read: says why: not found, a directory, no permission)
/// or L0106 (too large) diagnostic at `where` (the place that names the file) when it cannot.
std::shared_ptr<const SourceFile> read_source(const std::string& path, Diagnostics& out, Mark where = {},
                                              const YamlLimits& limits = {});

}  // namespace lineshaft
