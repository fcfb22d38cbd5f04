#pragma once

#include <string>
#include <utility>
#include <vector>

#include <yaml-cpp/eventhandler.h>

#include "runtime/source/yaml_text.hpp"

namespace lineshaft {

/// Ends the parsing from within the builder; what is wrong has been reported.
struct YamlStop {};

/// Builds the tree from the parser's events. It is as long as the answers to what YAML allows and
/// forms do not: anchors, tags, keys twice, and the like.
class YamlBuilder : public YAML::EventHandler {
  public:
    YamlBuilder(const YamlText& source, Diagnostics& out, const YamlLimits& limits)
        : source_(source), out_(out), limits_(limits) {}

    void OnDocumentStart(const YAML::Mark& mark) override;
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override;
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override;
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override;
    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value style) override;
    void OnSequenceEnd() override { close(); }
    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value style) override;
    void OnMapEnd() override;

    /// Reports what can be said of the maps that were open when the parsing ended early.
    void check_open_maps() const;

    /// The innermost collection in brackets that is open: its mark, and its bracket or '\0'.
    std::pair<Mark, char> open_bracket() const;

    Node take_root() { return std::move(root_); }

    static constexpr const char* no_alias =
        "write the value out; a text that begins with '&' or '*' stands in quotes";
    static constexpr const char* no_tag =
        "'NOT block.port' negates a boolean; a text that begins with '!' stands in quotes";
    static constexpr const char* quote_help = "a text that begins with a quote ends with the same";

  private:
    struct Frame {
        Node node;
        std::size_t begin = 0;
        bool flow = false;
        bool is_key = false;   // stands where a key is due; reported when closed, for an unclosed
        bool in_key = false;   // bracket looks like one to the library
        bool has_key = false;  // of a map: the next node is the value of `key`
        Node key;
        std::size_t key_end = 0;
    };

    [[noreturn]] void stop(std::string code, Mark mark, std::string message, std::string help = {});
    [[noreturn]] void root_is_no_map(std::size_t begin, std::size_t end);
    bool expects_key() const;
    void count_node(std::size_t begin);
    std::size_t word_end(std::size_t begin) const;
    void check_properties(std::size_t begin, const std::string& tag, YAML::anchor_t anchor);
    /// The library takes the file's end for a quote when a line end stands before it.
    void check_closed(const Node& node, std::size_t begin);
    void check_scalar(const Node& node);
    Mark place_of_null(std::size_t begin) const;
    void open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag,
              YAML::anchor_t anchor, YAML::EmitterStyle::value style);
    void close();
    /// `end`: offset after the node as written, for a key.
    void attach(Node node, std::size_t end);
    void check_merge(const Node& key);
    void check_duplicates(const Node& map) const;
    /// `{ratio: 1,5}` is to YAML a map with a key 5.
    void check_decimal_commas(const Node& map) const;

    const YamlText& source_;
    Diagnostics& out_;
    const YamlLimits& limits_;
    std::vector<Frame> stack_;
    std::size_t nodes_ = 0;
    int documents_ = 0;
    Node root_;
};

}  // namespace lineshaft
