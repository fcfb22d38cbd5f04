#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/source/diagnostic.hpp"

namespace lineshaft {

/// One node of a YAML file with its place. The only layer that touches the YAML library: it owns
/// marks and limits, and lets through plain maps, sequences and scalars only.
struct Node {
    enum class Kind { scalar, map, sequence };

    Kind kind = Kind::scalar;

    /// A scalar as written, quotes included (its first line, if it has several; the `|` or `>` of a
    /// block scalar); the `{`, `[` or first `-` of a collection, else a map's first key. For an
    /// empty value: the place where it would stand.
    Mark mark;

    std::string text;       ///< scalar; empty for an empty value (`key:`, `key: ~`, `key: null`)
    bool quoted = false;    ///< scalar in quotes or block scalar: never a number or a wire
    std::string parameter;  ///< name, where the text was written as `$name`; or the formula
    int used_in_line = 0;   ///< where it was, if `mark` is where the parameter is declared
    std::vector<std::pair<Node, Node>> entries;  ///< map, in file order; keys are scalars, unique
    std::vector<Node> items;                     ///< sequence

    // Defined in yaml.cpp: a pair of nodes inside a node is complete only there.
    Node();
    Node(const Node&);
    Node(Node&&) noexcept;
    Node& operator=(const Node&);
    Node& operator=(Node&&) noexcept;
    ~Node();

    bool is_scalar() const { return kind == Kind::scalar; }
    bool is_map() const { return kind == Kind::map; }
    bool is_sequence() const { return kind == Kind::sequence; }
    /// `$name` of no parameter: reported, and no further mistake is looked for here.
    bool is_unknown_parameter() const { return !parameter.empty() && text == "$" + parameter; }
    bool is_empty() const { return is_scalar() && text.empty() && !quoted; }
    const Node* find(std::string_view key) const;  ///< map's value, or null
    std::vector<std::string> keys() const;
};

/// A scalar that stands in no file: what the command line or a client says.
Node node_of(std::string text);

struct YamlLimits {
    std::size_t bytes = 1 << 20;
    std::size_t nodes = 100'000;
    std::size_t depth = 64;
    std::size_t scalar_bytes = 64 << 10;
};

/// The one document of `file`, whose root is a map. Empty when anything is wrong; then `out` says
/// what, all at once as far as the text can be read:
///   L0101  not YAML (tabs in the indentation are named as such)
///   L0102  duplicate key (names the first's line)
///   L0103  a second document, or text after the document's end
///   L0104  alias, anchor, tag or merge key
///   L0105  the root is no map, or empty file
///   L0106  a limit is exceeded (says which, and the limit)
///   L0107  a key that is no scalar, or empty (`: 1`, `null: 1`)
///   L0108  not UTF-8, a NUL or another control character (also as an escape in double quotes), a
///          lone carriage return, a byte order mark other than UTF-8's
///   L0109  a line that begins with a space or a dash that is not the keyboard's
///   L0301  a decimal comma in braces
/// Nothing is thrown.
std::optional<Node> parse_yaml(std::shared_ptr<const SourceFile> file, Diagnostics& out,
                               const YamlLimits& limits = {});

/// Reads a whole file. Empty and an L0001 (cannot be read: says why: not found, a directory, no
/// permission) or L0106 (too large) diagnostic at `where` (the place that names the file) when it
/// cannot.
std::shared_ptr<const SourceFile> read_source(const std::string& path, Diagnostics& out,
                                              Mark where = {}, const YamlLimits& limits = {});

}  // namespace lineshaft
