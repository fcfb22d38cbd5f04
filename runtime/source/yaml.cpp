#include "runtime/source/yaml.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include "runtime/source/encoding.hpp"
#include "runtime/source/habits.hpp"
#include "runtime/source/input_file.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"

namespace lineshaft {
namespace {

constexpr std::size_t most_bad_characters = 10;
constexpr std::size_t most_open_brackets = 1000;

/// The text with places: byte offsets to lines and characters.
class Source {
  public:
    explicit Source(std::shared_ptr<const SourceFile> file) : file_(std::move(file)) {
        text_ = file_->text;
        if (text_.starts_with(utf8_byte_order_mark)) {
            text_.remove_prefix(utf8_byte_order_mark.size());
        }
        for (std::size_t i = text_.find('\n'); i != text_.npos; i = text_.find('\n', i + 1))
            lines_.push_back(i + 1);
        if (!std::ranges::all_of(text_, is_ascii)) number_characters();
    }

    std::string_view text() const { return text_; }
    char at(std::size_t offset) const { return offset < text_.size() ? text_[offset] : '\0'; }

    std::size_t offset(const YAML::Mark& mark) const {
        return std::min(static_cast<std::size_t>(std::max(mark.pos, 0)), text_.size());
    }

    /// Index of the line that holds `offset`, from 0.
    std::size_t line_index(std::size_t offset) const {
        const auto after = std::upper_bound(lines_.begin(), lines_.end(), offset);
        return static_cast<std::size_t>(after - lines_.begin()) - 1;
    }

    std::size_t line_begin(std::size_t index) const { return lines_[index]; }

    /// Offset of the line feed that ends the line of `offset`, or of the text's end.
    std::size_t line_break(std::size_t offset) const {
        const std::size_t next = line_index(offset) + 1;
        return next < lines_.size() ? lines_[next] - 1 : text_.size();
    }

    /// Where the line that holds `offset` ends, spaces and line end not counted.
    std::size_t line_end(std::size_t offset) const {
        std::size_t end = line_break(offset);
        while (end > offset && std::string_view(" \t\r").find(text_[end - 1]) != text_.npos) --end;
        return end;
    }

    Mark mark(std::size_t begin, std::size_t end) const {
        const std::size_t line = line_index(begin);
        return {file_, static_cast<int>(line) + file_->first_line,
                static_cast<int>(characters(lines_[line], begin)) + 1,
                std::max(1, static_cast<int>(characters(begin, end)))};
    }

    Mark mark(std::size_t offset) const { return mark(offset, offset); }

  private:
    void number_characters() {
        characters_.resize(text_.size() + 1);
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < text_.size(); ++count)
            for (std::size_t end = i + first_character(text_.substr(i)).bytes; i < end; ++i)
                characters_[i] = count;
        characters_.back() = count;
    }

    std::size_t characters(std::size_t begin, std::size_t end) const {
        return characters_.empty() ? end - begin : characters_[end] - characters_[begin];
    }

    std::shared_ptr<const SourceFile> file_;
    std::string_view text_;
    std::vector<std::size_t> lines_{0};
    std::vector<std::uint32_t> characters_;  // before each byte; empty for a text of ASCII
};

/// Ends the parsing from within the handler; what is wrong has been reported.
struct Stop {};

std::string_view fault_of(const Utf8Character& character, std::string_view rest) {
    if (!character.valid) return "a byte that is not UTF-8";
    if (character.code == 0xFEFF) return "a byte order mark after its beginning";
    if (character.code == '\r' && !rest.starts_with("\r\n")) {
        return "a carriage return without a line feed";
    }
    if (character.code == '\n' || character.code == '\r' || character.code == '\t') return {};
    if (character.code == 0) return "a NUL character";
    return is_control(character.code) ? "a control character" : std::string_view();
}

bool is_utf16(std::string_view text) {
    return text.starts_with("\xFE\xFF") || text.starts_with("\xFF\xFE");
}

void check_characters(const Source& source, Diagnostics& out) {
    if (is_utf16(source.text())) {
        out.add("L0108", source.mark(0), "the file is UTF-16 or UTF-32, not UTF-8",
                "save it as UTF-8");
        return;
    }
    std::size_t found = 0;
    std::string_view rest = source.text();
    while (found < most_bad_characters) {
        rest.remove_prefix(plain_length(rest));
        if (rest.empty()) return;
        const Utf8Character character = first_character(rest);
        const std::string_view fault = fault_of(character, rest);
        if (!fault.empty()) {
            const std::size_t offset = source.text().size() - rest.size();
            const auto byte = static_cast<unsigned char>(rest.front());
            out.add("L0108", source.mark(offset), fmt::format("the file contains {}", fault),
                    character.valid
                        ? fmt::format("it is U+{:04X}", static_cast<unsigned>(character.code))
                        : fmt::format("the byte is {:02X}", byte));
            ++found;
        }
        rest.remove_prefix(character.bytes);
    }
}

/// Before its first event the library collects everything up to the first bracket that closes: a
/// megabyte of '[' would be 250 MB. Brackets in texts and comments count too, hence the margin.
void check_brackets(const Source& source, const YamlLimits& limits, Diagnostics& out) {
    const std::size_t most = std::max(limits.depth, most_open_brackets);
    std::size_t open = 0;
    std::size_t too_deep = 0;
    for (std::size_t i = 0; i < source.text().size() && open <= most; ++i) {
        const char c = source.text()[i];
        if ((c == ']' || c == '}') && open > 0) --open;
        if (c != '[' && c != '{') continue;
        ++open;
        if (open == limits.depth) too_deep = i;
    }
    if (open <= most) return;
    out.add("L0106", source.mark(too_deep),
            fmt::format("the file is nested deeper than {} levels", limits.depth));
}

/// Offset after the closing quote of the quoted text at `begin`, npos when there is none.
std::size_t quoted_end(std::string_view text, std::size_t begin) {
    const char quote = text[begin];
    const std::string_view stops = quote == '"' ? "\"\\" : "'";
    std::size_t i = text.find_first_of(stops, begin + 1);
    while (i != std::string_view::npos) {
        const bool doubled = quote == '\'' && text.substr(i).starts_with("''");
        if (text[i] == quote && !doubled) return i + 1;
        i = text.find_first_of(stops, i + 2);
    }
    return i;
}

bool is_quote(char c) {
    return c == '"' || c == '\'';
}

/// Offset after a scalar as written, or where its first line ends.
std::size_t scalar_end(const Source& source, std::size_t begin, std::string_view value) {
    const char first = source.at(begin);
    if (first == '|' || first == '>') return begin + 1;
    if (!is_quote(first) && source.text().substr(begin).starts_with(value)) {
        return begin + value.size();
    }
    const std::size_t end = is_quote(first) ? quoted_end(source.text(), begin) : source.text().npos;
    return end <= source.line_break(begin) ? end : source.line_end(begin);
}

/// Length of `~`, `null`, `Null` or `NULL` when it stands at `offset` as a word, else 0.
std::size_t null_word(const Source& source, std::size_t offset) {
    for (const std::string_view word : {"~", "null", "Null", "NULL"}) {
        if (!source.text().substr(offset).starts_with(word)) continue;
        const char next = source.at(offset + word.size());
        if (std::string_view("\0 \t\r\n,]}", 8).find(next) != std::string_view::npos) {
            return word.size();
        }
    }
    return 0;
}

/// Where the value of the key that ends at `key_end` would begin.
std::size_t after_colon(const Source& source, std::size_t key_end) {
    std::size_t colon = key_end;
    while (source.at(colon) == ' ' || source.at(colon) == '\t') ++colon;
    return source.at(colon) == ':' ? colon + 1 : key_end;
}

/// Where the item of the last `-` before `next` would begin: between are blanks and comments only.
std::size_t after_dash(const Source& source, std::size_t next) {
    std::size_t end = next;
    for (std::size_t line = source.line_index(next) + 1; line-- > 0;) {
        const std::size_t begin = source.line_begin(line);
        const std::string_view written = source.text().substr(begin, end - begin);
        const std::string_view head = written.substr(0, written.find_first_not_of(" \t-"));
        const std::size_t dash = head.rfind('-');
        if (dash != std::string_view::npos) return begin + dash + 1;
        end = begin;
    }
    return next;
}

/// Builds the tree from the parser's events. It is as long as the answers to what YAML allows and
/// forms do not: anchors, tags, keys twice, and the like.
class Builder : public YAML::EventHandler {
  public:
    Builder(const Source& source, Diagnostics& out, const YamlLimits& limits)
        : source_(source), out_(out), limits_(limits) {}

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (documents_++ == 0) return;
        const std::size_t begin = source_.offset(mark);
        const bool marked = source_.text().substr(begin).starts_with("---");
        stop("L0103", source_.mark(begin, marked ? begin + 3 : source_.line_end(begin)),
             marked ? "the file holds a second document"
                    : "text stands after the end of the document",
             "a file holds one document");
    }

    void OnDocumentEnd() override {}

    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        const std::size_t begin = source_.offset(mark);
        check_properties(begin, "?", anchor);
        count_node(begin);
        if (stack_.empty()) stop("L0105", source_.mark(0), "the file is empty");
        if (expects_key()) {
            out_.add("L0107", source_.mark(begin), "a key is empty",
                     "a key that is called null or ~ stands in quotes");
        }
        Node node;
        node.mark = place_of_null(begin);
        attach(std::move(node), begin);
    }

    void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
        const std::size_t begin = source_.offset(mark);
        count_node(begin);
        out_.add("L0104", source_.mark(begin, word_end(begin)), "this is a YAML alias", no_alias);
        Node node;
        node.mark = source_.mark(begin);
        attach(std::move(node), begin + 1);
    }

    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
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

    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value style) override {
        open(Node::Kind::sequence, mark, tag, anchor, style);
    }

    void OnSequenceEnd() override { close(); }

    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value style) override {
        open(Node::Kind::map, mark, tag, anchor, style);
    }

    void OnMapEnd() override {
        Node& map = stack_.back().node;
        check_duplicates(map);
        check_decimal_commas(map);
        const bool flow = source_.at(stack_.back().begin) == '{';
        if (!flow && !map.entries.empty()) map.mark = map.entries.front().first.mark;
        close();
    }

    /// Reports what can be said of the maps that were open when the parsing ended early.
    void check_open_maps() const {
        for (const Frame& frame : stack_) check_duplicates(frame.node);
    }

    /// The innermost collection in brackets that is open: its mark, and its bracket or '\0'.
    std::pair<Mark, char> open_bracket() const {
        if (stack_.empty() || !stack_.back().flow) return {{}, '\0'};
        return {stack_.back().node.mark, source_.at(stack_.back().begin)};
    }

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

    [[noreturn]] void stop(std::string code, Mark mark, std::string message,
                           std::string help = {}) {
        out_.add(std::move(code), std::move(mark), std::move(message), std::move(help));
        throw Stop{};
    }

    [[noreturn]] void root_is_no_map(std::size_t begin, std::size_t end) {
        stop("L0105", source_.mark(begin, end), "the file is not a map",
             "its first level is made of lines such as 'key: value'");
    }

    bool expects_key() const {
        return !stack_.empty() && stack_.back().node.is_map() && !stack_.back().has_key;
    }

    void count_node(std::size_t begin) {
        if (++nodes_ <= limits_.nodes) return;
        stop("L0106", source_.mark(begin),
             fmt::format("the file has more than {} values", limits_.nodes));
    }

    std::size_t word_end(std::size_t begin) const {
        const std::size_t end = source_.text().find_first_of(" \t\r\n,[]{}", begin);
        return std::min(end, source_.text().size());
    }

    void check_properties(std::size_t begin, const std::string& tag, YAML::anchor_t anchor) {
        const bool implicit = tag == "?" || tag == "!";  // "!": a text in quotes, or a lone '!'
        const bool tagged = !implicit || source_.at(begin) == '!';
        if (anchor == YAML::NullAnchor && !tagged) return;
        const Mark mark = source_.mark(begin, word_end(begin));
        if (anchor != YAML::NullAnchor) out_.add("L0104", mark, "this is a YAML anchor", no_alias);
        if (tagged) out_.add("L0104", mark, "this is a YAML tag", no_tag);
    }

    /// The library takes the file's end for a quote when a line end stands before it.
    void check_closed(const Node& node, std::size_t begin) {
        if (!is_quote(source_.at(begin))) return;
        if (quoted_end(source_.text(), begin) != std::string_view::npos) return;
        stop("L0101", node.mark, "a quote is never closed", quote_help);
    }

    void check_scalar(const Node& node) {
        if (node.text.size() > limits_.scalar_bytes) {
            stop("L0106", node.mark,
                 fmt::format("a text has more than {} bytes", limits_.scalar_bytes));
        }
        for (std::string_view rest = node.text; !rest.empty();) {
            const auto [code, bytes, valid] = first_character(rest);
            rest.remove_prefix(bytes);
            if (!is_control(code) || code == '\n' || code == '\t') continue;
            out_.add("L0108", node.mark,
                     fmt::format("a text contains the control character U+{:04X}",
                                 static_cast<unsigned>(code)));
            return;
        }
    }

    Mark place_of_null(std::size_t begin) const {
        const std::size_t written = null_word(source_, begin);
        const Frame& parent = stack_.back();
        if (written > 0 || expects_key()) return source_.mark(begin, begin + written);
        if (parent.node.is_map()) return source_.mark(after_colon(source_, parent.key_end));
        return source_.mark(parent.flow ? begin : after_dash(source_, begin));
    }

    void open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag,
              YAML::anchor_t anchor, YAML::EmitterStyle::value style) {
        const std::size_t begin = source_.offset(mark);
        check_properties(begin, tag, anchor);
        count_node(begin);
        if (stack_.empty() && kind != Node::Kind::map) root_is_no_map(begin, begin + 1);
        if (stack_.size() >= limits_.depth) {
            stop("L0106", source_.mark(begin),
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

    void close() {
        Frame frame = std::move(stack_.back());
        stack_.pop_back();
        if (frame.is_key && !frame.in_key) {
            out_.add("L0107", source_.mark(frame.begin), "a key is not a name",
                     "a key is a word; a text with brackets stands in quotes");
        }
        attach(std::move(frame.node), frame.begin + 1);
    }

    /// `end`: offset after the node as written, for a key.
    void attach(Node node, std::size_t end) {
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

    void check_merge(const Node& key) {
        if (key.quoted || key.text != "<<") return;
        out_.add("L0104", key.mark, "this is a YAML merge key", "write the values out");
    }

    void check_duplicates(const Node& map) const {
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
            out_.add("L0102", key->mark, fmt::format("the key '{}' stands twice", key->text),
                     fmt::format("it was first given in line {}", first->mark.line));
        }
    }

    /// `{ratio: 1,5}` is to YAML a map with a key 5.
    void check_decimal_commas(const Node& map) const {
        for (std::size_t i = 1; i < map.entries.size(); ++i) {
            const Node& value = map.entries[i - 1].second;
            const auto& [key, nothing] = map.entries[i];
            const bool digits = !key.text.empty() && is_digit(key.text.front()) &&
                                !value.text.empty() && is_digit(value.text.back());
            if (!digits || value.quoted || !nothing.is_empty()) continue;
            Mark mark = value.mark;
            mark.length = std::max(1, key.mark.column + key.mark.length - mark.column);
            out_.add("L0301", std::move(mark),
                     fmt::format("'{},{}' is not a number", value.text, key.text),
                     fmt::format("a number has a decimal point: {}.{}", value.text, key.text));
        }
    }

    const Source& source_;
    Diagnostics& out_;
    const YamlLimits& limits_;
    std::vector<Frame> stack_;
    std::size_t nodes_ = 0;
    int documents_ = 0;
    Node root_;
};

/// What the library says, and what we say instead.
struct Translation {
    std::string_view library;  ///< beginning of its message
    const char* code;
    std::string_view message;
    std::string_view help;
};

const Translation* translation_of(std::string_view message) {
    static constexpr std::string_view quotes = "a text with special characters stands in quotes";
    static const auto table = std::to_array<Translation>({
        {YAML::ErrorMsg::TAB_IN_INDENTATION, "L0101",
         "a tab character indents the line; YAML indents with spaces", "replace it by spaces"},
        {YAML::ErrorMsg::END_OF_MAP_FLOW, "L0101", "expected ',' or '}'", quotes},
        {YAML::ErrorMsg::END_OF_MAP, "L0101", "this does not continue the map above",
         "expected 'key: value', indented like the keys above"},
        {YAML::ErrorMsg::END_OF_SEQ_FLOW, "L0101", "expected ',' or ']'", quotes},
        {YAML::ErrorMsg::END_OF_SEQ, "L0101", "this does not continue the list above",
         "expected '- item', indented like the items above"},
        {YAML::ErrorMsg::UNKNOWN_TOKEN, "L0101", "no value may begin with this character", quotes},
        {YAML::ErrorMsg::DOC_IN_SCALAR, "L0101", "a document's mark stands inside quotes",
         "the quote that opens this text is not closed before it"},
        {YAML::ErrorMsg::EOF_IN_SCALAR, "L0101", "a quote is never closed", Builder::quote_help},
        {YAML::ErrorMsg::FLOW_END, "L0101", "this bracket closes nothing", quotes},
        {YAML::ErrorMsg::BLOCK_ENTRY, "L0101", "no list item may begin here",
         "each '- item' stands on a line of its own, or the list in brackets"},
        {YAML::ErrorMsg::MAP_KEY, "L0101", "no key may begin here", quotes},
        {YAML::ErrorMsg::MAP_VALUE, "L0101", "no ':' may stand here",
         "a key is indented like its neighbours, a nested map begins on a line of its own, a text "
         "with ': ' stands in quotes"},
        {YAML::ErrorMsg::INVALID_ESCAPE, "L0101", "this escape in double quotes is not known",
         "a backslash is written '\\\\'; in single quotes it stands for itself"},
        {YAML::ErrorMsg::UNKNOWN_ANCHOR, "L0104", "this is a YAML alias", Builder::no_alias},
        {YAML::ErrorMsg::MULTIPLE_ANCHORS, "L0104", "this is a YAML anchor", Builder::no_alias},
        {YAML::ErrorMsg::ALIAS_NOT_FOUND, "L0104", "a YAML alias has no name", quotes},
        {YAML::ErrorMsg::ANCHOR_NOT_FOUND, "L0104", "a YAML anchor has no name", quotes},
        {YAML::ErrorMsg::CHAR_IN_ALIAS, "L0104", "this is a YAML alias", Builder::no_alias},
        {YAML::ErrorMsg::CHAR_IN_ANCHOR, "L0104", "this is a YAML anchor", Builder::no_alias},
        {YAML::ErrorMsg::MULTIPLE_TAGS, "L0104", "this is a YAML tag", Builder::no_tag},
        {YAML::ErrorMsg::CHAR_IN_TAG_HANDLE, "L0104", "this is a YAML tag", Builder::no_tag},
        {YAML::ErrorMsg::TAG_WITH_NO_SUFFIX, "L0104", "this is a YAML tag", Builder::no_tag},
        {YAML::ErrorMsg::END_OF_VERBATIM_TAG, "L0104", "this is a YAML tag", Builder::no_tag},
    });
    const auto found = std::find_if(table.begin(), table.end(), [&](const Translation& entry) {
        return message.starts_with(entry.library);
    });
    return found == table.end() ? nullptr : &*found;
}

/// The tab in the indentation of the line that holds `offset`, or npos.
std::size_t indenting_tab(const Source& source, std::size_t offset) {
    const std::size_t begin = source.line_begin(source.line_index(offset));
    const std::string_view line = source.text().substr(begin, offset - begin);
    const std::size_t tab = line.substr(0, line.find_first_not_of(" \t")).find('\t');
    return tab == std::string_view::npos ? tab : begin + tab;
}

/// A space or a dash that begins the line of `offset`, or the one before, and is not the
/// keyboard's: to YAML it is text.
bool report_look_alike(const Source& source, std::size_t offset, Diagnostics& out) {
    const std::size_t last = source.line_index(offset);
    for (std::size_t line = last;; --line) {
        const std::size_t begin = source.line_begin(line);
        const std::string_view text = source.text().substr(begin, source.line_break(begin) - begin);
        const auto found = find_look_alike(text);
        if (found && text.find_first_not_of(' ') == found->offset) {
            out.add("L0109", source.mark(begin + found->offset),
                    fmt::format("a line begins with {}", found->name),
                    fmt::format("write {} instead", found->instead));
            return true;
        }
        if (line == 0 || line + 1 == last) return false;
    }
}

/// Place of the colon of `key:value` in the last line before that of `offset`, or npos: YAML reads
/// on there as in one text of two lines.
std::size_t glued_colon(const Source& source, std::size_t offset) {
    const std::size_t begin = source.line_begin(source.line_index(offset));
    const std::size_t end = source.text().substr(0, begin).find_last_not_of(" \r\n");
    if (end == std::string_view::npos) return end;
    const std::size_t start = source.line_begin(source.line_index(end));
    const std::string_view line = source.text().substr(start, end + 1 - start);
    const std::size_t key = line.find_first_not_of(" -");
    const std::size_t colon = line.find_first_of(": #\"'[{", key);
    if (colon == std::string_view::npos || line[colon] != ':' || colon + 1 == line.size()) {
        return std::string_view::npos;
    }
    return line[colon + 1] == ' ' ? std::string_view::npos : start + colon;
}

/// `z.dst[6].q`, whose bracket at `offset` YAML takes for that of a list; empty when there is none.
std::string_view indexed_name(std::string_view text, std::size_t offset) {
    constexpr std::string_view name =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.";
    const std::size_t begin = text.substr(0, offset).find_last_not_of(name) + 1;
    std::size_t end = offset;
    while (end < text.size() && text[end] == '[') {
        const std::size_t closed = text.substr(0, text.find('\n', end)).find(']', end);
        if (closed == std::string_view::npos) return {};
        end = std::min(text.find_first_not_of(name, closed + 1), text.size());
    }
    return begin < offset && offset < end ? text.substr(begin, end - begin) : std::string_view();
}

void report(const YAML::Exception& fault, const Source& source, const Builder& builder,
            Diagnostics& out) {
    std::size_t offset = source.offset(fault.mark);
    const bool at_end = offset == source.text().size();
    if (at_end) {
        const std::size_t last = source.text().find_last_not_of(" \t\r\n");
        offset = last == std::string_view::npos ? 0 : last + 1;
    }
    const std::size_t tab = indenting_tab(source, offset);
    if (tab != std::string_view::npos) {
        out.add("L0101", source.mark(tab),
                "a tab character indents the line; YAML indents with spaces",
                "replace it by spaces");
        return;
    }
    if (report_look_alike(source, offset, out)) return;
    const auto [opened, bracket] = builder.open_bracket();
    const bool in_brackets = bracket == '[' || bracket == '{';
    if (at_end && in_brackets) {
        out.add("L0101", opened, fmt::format("this '{}' is never closed", bracket));
        return;
    }
    const std::size_t glued = glued_colon(source, offset);
    if (fault.msg == YAML::ErrorMsg::MAP_VALUE && glued != std::string_view::npos) {
        out.add("L0101", source.mark(glued), "a blank is missing after ':'");
        return;
    }
    const Translation* known = translation_of(fault.msg);
    if (known == nullptr) {
        out.add("L0101", source.mark(offset), fmt::format("this is not YAML: {}", fault.msg));
        return;
    }
    const bool unclosed = in_brackets && known->message.starts_with("expected");
    const Mark here = source.mark(offset);
    std::string help(known->help);
    if (const std::string_view name = indexed_name(source.text(), offset); !name.empty())
        help = fmt::format("a name with an index stands in quotes here: '{}'", name);
    else if (unclosed && opened.line != here.line)
        return out.add("L0101", opened, fmt::format("this '{}' is not closed", bracket),
                       fmt::format("{} before line {}", known->message, here.line));
    else if (unclosed)
        help = fmt::format("the '{}' of line {} is still open", bracket, opened.line);
    out.add(known->code, source.mark(offset), std::string(known->message), std::move(help));
}

void build(const Source& source, Builder& builder, Diagnostics& out) {
    try {
        std::istringstream in{std::string(source.text())};
        YAML::Parser parser(in);
        if (!parser.HandleNextDocument(builder)) {
            out.add("L0105", source.mark(0), "the file is empty");
            return;
        }
        parser.HandleNextDocument(builder);
    } catch (const Stop&) {
        builder.check_open_maps();
    } catch (const YAML::Exception& fault) {
        builder.check_open_maps();
        report(fault, source, builder, out);
    } catch (const std::exception& fault) {
        out.add("L0101", source.mark(0),
                fmt::format("the file cannot be read as YAML: {}", fault.what()));
    }
}

std::string reason_of(int error) {
    if (error == ENOENT) return "it does not exist";
    if (error == EISDIR) return "it is a directory";
    if (error == EACCES) return "you have no permission";
    return std::generic_category().message(error);
}

}  // namespace

Node::Node() = default;
Node::Node(const Node&) = default;
Node::Node(Node&&) noexcept = default;
Node& Node::operator=(const Node&) = default;
Node& Node::operator=(Node&&) noexcept = default;
Node::~Node() = default;

const Node* Node::find(std::string_view key) const {
    const auto found = std::find_if(entries.begin(), entries.end(),
                                    [&](const auto& entry) { return entry.first.text == key; });
    return found == entries.end() ? nullptr : &found->second;
}

std::vector<std::string> Node::keys() const {
    std::vector<std::string> names;
    names.reserve(entries.size());
    for (const auto& [key, value] : entries) names.push_back(key.text);
    return names;
}

std::optional<Node> parse_yaml(std::shared_ptr<const SourceFile> file, Diagnostics& out,
                               const YamlLimits& limits) {
    assert(file);
    if (file->text.size() > limits.bytes) {
        out.add("L0106", {file, 1, 1, 1},
                fmt::format("the file has more than {} bytes", limits.bytes));
        return {};
    }
    const std::size_t before = out.count();
    const Source source(std::move(file));
    check_characters(source, out);
    check_brackets(source, limits, out);
    if (out.count() != before) return {};

    Builder builder(source, out, limits);
    build(source, builder, out);
    if (out.count() != before) return {};
    return builder.take_root();
}

std::shared_ptr<const SourceFile> read_source(const std::string& path, Diagnostics& out, Mark where,
                                              const YamlLimits& limits) {
    const std::string looked_for =
        where.file ? fmt::format("the path counts from the folder of '{}'", where.file->path)
                   : std::string();
    int error = path.find('\0') == std::string::npos ? 0 : ENOENT;
    std::string text;
    if (error == 0) text = read_bytes(path, limits.bytes + 1, error);
    if (error != 0) {
        out.add("L0001", std::move(where),
                fmt::format("cannot read '{}': {}", path, reason_of(error)), looked_for);
        return nullptr;
    }
    if (text.size() > limits.bytes) {
        out.add("L0106", std::move(where),
                fmt::format("'{}' has more than {} bytes", path, limits.bytes));
        return nullptr;
    }
    if (is_structured_text(path)) text = as_utf8(std::move(text));
    return std::make_shared<const SourceFile>(SourceFile{path, std::move(text)});
}

}  // namespace lineshaft
