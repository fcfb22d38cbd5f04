#include "runtime/source/yaml_builder.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"

namespace lineshaft {

void YamlBuilder::OnDocumentStart(const YAML::Mark& mark) {
    if (documents_++ == 0) return;
    const std::size_t begin = source_.offset(mark);
    const bool marked = source_.text().substr(begin).starts_with("---");
    stop(code::second_document, source_.mark(begin, marked ? begin + 3 : source_.line_end(begin)),
         marked ? "the file holds a second document" : "text stands after the end of the document",
         "a file holds one document");
}

void YamlBuilder::OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) {
    const std::size_t begin = source_.offset(mark);
    check_properties(begin, "?", anchor);
    count_node(begin);
    if (stack_.empty()) stop(code::root_is_no_map, source_.mark(0), "the file is empty");
    if (expects_key()) {
        out_.add(code::key_is_no_name, source_.mark(begin), "a key is empty",
                 "a key that is called null or ~ stands in quotes");
    }
    Node node;
    node.mark = place_of_null(begin);
    attach(std::move(node), begin);
}

void YamlBuilder::OnAlias(const YAML::Mark& mark, YAML::anchor_t) {
    const std::size_t begin = source_.offset(mark);
    count_node(begin);
    out_.add(code::yaml_anchor_or_tag, source_.mark(begin, word_end(begin)), "this is a YAML alias",
             no_alias);
    Node node;
    node.mark = source_.mark(begin);
    attach(std::move(node), begin + 1);
}

void YamlBuilder::OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                           const std::string& value) {
    const std::size_t begin = source_.offset(mark);
    const std::size_t end = scalar_end(source_, begin, value);
    check_properties(begin, tag, anchor);
    count_node(begin);
    if (stack_.empty()) root_is_no_map(begin, end);
    Node node;
    node.mark = source_.mark(begin, end);
    node.text = value;
    node.quoted = std::string_view("\"'|>").find(source_.at(begin)) != std::string_view::npos;
    check_closed(node, begin);
    check_scalar(node);
    attach(std::move(node), end);
}

void YamlBuilder::OnSequenceStart(const YAML::Mark& mark, const std::string& tag,
                                  YAML::anchor_t anchor, YAML::EmitterStyle::value style) {
    open(Node::Kind::sequence, mark, tag, anchor, style);
}

void YamlBuilder::OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                             YAML::EmitterStyle::value style) {
    open(Node::Kind::map, mark, tag, anchor, style);
}

void YamlBuilder::OnMapEnd() {
    Node& map = stack_.back().node;
    check_duplicates(map);
    check_decimal_commas(map);
    const bool flow = source_.at(stack_.back().begin) == '{';
    if (!flow && !map.entries.empty()) map.mark = map.entries.front().first.mark;
    close();
}

void YamlBuilder::check_open_maps() const {
    for (const Frame& frame : stack_) check_duplicates(frame.node);
}

std::pair<Mark, char> YamlBuilder::open_bracket() const {
    if (stack_.empty() || !stack_.back().flow) return {{}, '\0'};
    return {stack_.back().node.mark, source_.at(stack_.back().begin)};
}

void YamlBuilder::stop(std::string code, Mark mark, std::string message, std::string help) {
    out_.add(std::move(code), std::move(mark), std::move(message), std::move(help));
    throw YamlStop{};
}

void YamlBuilder::root_is_no_map(std::size_t begin, std::size_t end) {
    stop(code::root_is_no_map, source_.mark(begin, end), "the file is not a map",
         "its first level is made of lines such as 'key: value'");
}

bool YamlBuilder::expects_key() const {
    return !stack_.empty() && stack_.back().node.is_map() && !stack_.back().has_key;
}

void YamlBuilder::count_node(std::size_t begin) {
    if (++nodes_ <= limits_.nodes) return;
    stop(code::file_too_large, source_.mark(begin),
         fmt::format("the file has more than {} values", limits_.nodes));
}

std::size_t YamlBuilder::word_end(std::size_t begin) const {
    const std::size_t end = source_.text().find_first_of(" \t\r\n,[]{}", begin);
    return std::min(end, source_.text().size());
}

void YamlBuilder::check_properties(std::size_t begin, const std::string& tag,
                                   YAML::anchor_t anchor) {
    const bool implicit = tag == "?" || tag == "!";  // "!": a text in quotes, or a lone '!'
    const bool tagged = !implicit || source_.at(begin) == '!';
    if (anchor == YAML::NullAnchor && !tagged) return;
    const Mark mark = source_.mark(begin, word_end(begin));
    if (anchor != YAML::NullAnchor)
        out_.add(code::yaml_anchor_or_tag, mark, "this is a YAML anchor", no_alias);
    if (tagged) out_.add(code::yaml_anchor_or_tag, mark, "this is a YAML tag", no_tag);
}

void YamlBuilder::check_closed(const Node& node, std::size_t begin) {
    if (!is_quote(source_.at(begin))) return;
    if (quoted_end(source_.text(), begin) != std::string_view::npos) return;
    stop(code::not_yaml, node.mark, "a quote is never closed", quote_help);
}

void YamlBuilder::check_scalar(const Node& node) {
    if (node.text.size() > limits_.scalar_bytes) {
        stop(code::file_too_large, node.mark,
             fmt::format("a text has more than {} bytes", limits_.scalar_bytes));
    }
    for (std::string_view rest = node.text; !rest.empty();) {
        const auto [code, bytes, valid] = first_character(rest);
        rest.remove_prefix(bytes);
        if (!is_control(code) || code == '\n' || code == '\t') continue;
        out_.add(code::not_plain_text, node.mark,
                 fmt::format("a text contains the control character U+{:04X}",
                             static_cast<unsigned>(code)));
        return;
    }
}

Mark YamlBuilder::place_of_null(std::size_t begin) const {
    const std::size_t written = null_word(source_, begin);
    const Frame& parent = stack_.back();
    if (written > 0 || expects_key()) return source_.mark(begin, begin + written);
    if (parent.node.is_map()) return source_.mark(after_colon(source_, parent.key_end));
    return source_.mark(parent.flow ? begin : after_dash(source_, begin));
}

void YamlBuilder::open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag,
                       YAML::anchor_t anchor, YAML::EmitterStyle::value style) {
    const std::size_t begin = source_.offset(mark);
    check_properties(begin, tag, anchor);
    count_node(begin);
    if (stack_.empty() && kind != Node::Kind::map) root_is_no_map(begin, begin + 1);
    if (stack_.size() >= limits_.depth) {
        stop(code::file_too_large, source_.mark(begin),
             fmt::format("the file is nested deeper than {} levels", limits_.depth));
    }
    Frame frame;
    frame.node.kind = kind;
    frame.node.mark = source_.mark(begin);
    frame.begin = begin;
    frame.flow = style == YAML::EmitterStyle::Flow;
    frame.is_key = expects_key();
    frame.in_key = !stack_.empty() && (stack_.back().is_key || stack_.back().in_key);
    stack_.push_back(std::move(frame));
}

void YamlBuilder::close() {
    Frame frame = std::move(stack_.back());
    stack_.pop_back();
    if (frame.is_key && !frame.in_key) {
        out_.add(code::key_is_no_name, source_.mark(frame.begin), "a key is not a name",
                 "a key is a word; a text with brackets stands in quotes");
    }
    attach(std::move(frame.node), frame.begin + 1);
}

void YamlBuilder::attach(Node node, std::size_t end) {
    if (stack_.empty()) {
        root_ = std::move(node);
        return;
    }
    Frame& parent = stack_.back();
    if (parent.node.is_sequence()) {
        parent.node.items.push_back(std::move(node));
    } else if (parent.has_key) {
        parent.node.entries.emplace_back(std::move(parent.key), std::move(node));
        parent.has_key = false;
    } else {
        check_merge(node);
        parent.key = std::move(node);
        parent.key_end = end;
        parent.has_key = true;
    }
}

void YamlBuilder::check_merge(const Node& key) {
    if (key.quoted || key.text != "<<") return;
    out_.add(code::yaml_anchor_or_tag, key.mark, "this is a YAML merge key",
             "write the values out");
}

void YamlBuilder::check_duplicates(const Node& map) const {
    std::vector<const Node*> keys;
    keys.reserve(map.entries.size());
    for (const auto& [key, value] : map.entries) {
        if (key.is_scalar() && !key.is_empty()) keys.push_back(&key);
    }
    std::stable_sort(keys.begin(), keys.end(),
                     [](const Node* a, const Node* b) { return a->text < b->text; });
    const Node* first = nullptr;
    for (const Node* key : keys) {
        if (first == nullptr || first->text != key->text) {
            first = key;
            continue;
        }
        out_.add(code::key_twice, key->mark, fmt::format("the key '{}' stands twice", key->text),
                 fmt::format("it was first given in line {}", first->mark.line));
    }
}

void YamlBuilder::check_decimal_commas(const Node& map) const {
    for (std::size_t i = 1; i < map.entries.size(); ++i) {
        const Node& value = map.entries[i - 1].second;
        const auto& [key, nothing] = map.entries[i];
        const bool digits = !key.text.empty() && is_digit(key.text.front()) &&
                            !value.text.empty() && is_digit(value.text.back());
        if (!digits || value.quoted || !nothing.is_empty()) continue;
        Mark mark = value.mark;
        mark.length = std::max(1, key.mark.column + key.mark.length - mark.column);
        out_.add(code::not_a_number, std::move(mark),
                 fmt::format("'{},{}' is not a number", value.text, key.text),
                 fmt::format("a number has a decimal point: {}.{}", value.text, key.text));
    }
}

}  // namespace lineshaft
