#include "runtime/st/syntax/style.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"
#include "runtime/st/syntax/lexer.hpp"

namespace lineshaft::st {

namespace {

constexpr std::size_t blanks_a_level = 4;

/// A token, a comment or a pragma, as it is written.
struct Piece {
    Place place = {};
    const Token* token = nullptr;  ///< null: a comment or a pragma

    bool is(Word word) const { return token && token->word == word; }
    /// A comment or a pragma comes without the blanks behind it.
    std::string_view text() const {
        std::string_view text = place.text();
        if (!token) text = text.substr(0, text.find_last_not_of(" \r\t") + 1);
        return text;
    }
    std::string word() const { return token && !token->quoted ? upper(text()) : std::string(); }
};

std::vector<Piece> pieces_of(const Tokens& all) {
    std::vector<Piece> pieces;
    for (const Token& token : all.tokens)
        if (token.word != Word::end_of_file) pieces.push_back({token.place, &token});
    for (const auto* list : {&all.comments, &all.pragmas})
        for (const Pragma& one : *list) pieces.push_back({one.place, nullptr});
    std::ranges::sort(pieces, {}, [](const Piece& p) { return p.place.begin; });
    return pieces;
}

bool is_one_of(const Piece& piece, std::initializer_list<Word> words) {
    return piece.token && std::ranges::find(words, piece.token->word) != words.end();
}

bool is_value(const Piece& piece) {
    return is_one_of(piece, {Word::name, Word::integer, Word::real, Word::duration, Word::text,
                             Word::direct, Word::close, Word::close_bracket, Word::caret});
}

bool is_sign(const Piece& piece) {
    return is_one_of(piece, {Word::plus, Word::minus});
}

/// 1: it opens a bracket; -1: it closes one; else 0.
int bracket(const Piece& piece) {
    if (is_one_of(piece, {Word::open, Word::open_bracket})) return 1;
    return is_one_of(piece, {Word::close, Word::close_bracket}) ? -1 : 0;
}

/// Writes the pieces line by line.
class Style {
  public:
    Style(const SourceFile& file, std::vector<Piece> pieces)
        : text_(file.text),
          pieces_(std::move(pieces)),
          end_(text_.find("\r\n") == text_.npos ? "\n" : "\r\n") {
        for (const Piece& piece : pieces_)
            if (const std::string word = piece.word(); word.starts_with("END_"))
                closed_.push_back(word.substr(4));
        for (std::size_t i = 1; i < pieces_.size(); ++i)
            if (const std::string word = pieces_[i - 1].word(); word == "GOTO" || word == "JMP")
                labels_.push_back(pieces_[i].word());
    }
    /// Empty: there is something between the tokens, which goes to `out`.
    std::optional<std::string> write(Diagnostics& out);

  private:
    struct Open {
        std::string word;
        bool is_indented = true;
        bool has_label = false;  ///< of CASE: what follows belongs to one
    };

    std::string_view between(std::size_t i) const {
        const std::size_t begin = i == 0 ? 0 : pieces_[i - 1].place.end;
        return text_.substr(begin, pieces_[i].place.begin - begin);
    }
    bool in_case() const { return !open_.empty() && open_.back().word == "CASE"; }
    /// The colon of a CASE, or of a label that is jumped to.
    bool ends_label(std::size_t i) const {
        const bool is_jumped_to =
            i == begun_ + 1 && std::ranges::find(labels_, pieces_[begun_].word()) != labels_.end();
        return pieces_[i].is(Word::colon) && brackets_ == 0 && (in_case() || is_jumped_to);
    }
    bool is_spaced(std::size_t i) const;
    bool is_label(std::size_t i) const;
    bool is_attribute(std::size_t i) const;
    bool opens(const std::string& word) const;
    std::size_t depth() const;
    std::size_t indent_of(std::size_t i);
    void take(std::size_t i);
    void close(const std::string& word);
    std::string_view title_behind(std::size_t i) const;
    void refuse(std::size_t i, Diagnostics& wrong) const;

    std::string_view text_;
    std::vector<Piece> pieces_;
    std::string end_;
    std::vector<std::string> closed_;  ///< words that some END_... ends
    std::vector<std::string> labels_;  ///< that some GOTO or JMP names
    std::vector<Open> open_;
    int brackets_ = 0;
    std::size_t begun_ = 0;   ///< the piece that began the last statement
    bool begins_ = true;      ///< a statement or a declaration
    bool is_header_ = false;  ///< which the line ends
};

/// `.g`, a global variable: no part of what stands before.
bool begins_with_point(const Piece& before, const Piece& here) {
    return here.is(Word::dot) && !is_value(before) && !before.is(Word::super_);
}

/// An operator's sign or a statement's colon has blanks around it, a call's bracket none before.
bool Style::is_spaced(std::size_t i) const {
    const Piece &before = pieces_[i - 1], &here = pieces_[i];
    if (!before.token || !here.token) return true;
    if (is_one_of(here, {Word::comma, Word::semicolon, Word::close, Word::close_bracket, Word::dot,
                         Word::range, Word::caret}) &&
        !begins_with_point(before, here))
        return false;
    if (is_one_of(before, {Word::open, Word::open_bracket, Word::dot, Word::range, Word::prefix}))
        return false;
    if (here.is(Word::open))
        return !is_one_of(before, {Word::name, Word::caret, Word::close_bracket});
    if (here.is(Word::open_bracket)) return !is_value(before) && !before.is(Word::array_);
    const bool is_unary = is_sign(before) && (i < 2 || !is_value(pieces_[i - 2]));
    return !is_unary;
}

/// `1, 3..5:` of a CASE.
bool Style::is_label(std::size_t i) const {
    if (!in_case() || !pieces_[i].token) return false;
    for (int depth = 0; i < pieces_.size(); ++i) {
        depth += bracket(pieces_[i]);
        if (pieces_[i].is(Word::colon) && depth == 0) return true;
        if (is_one_of(pieces_[i], {Word::semicolon, Word::assign, Word::then_, Word::do_}))
            return false;
    }
    return false;
}

bool Style::opens(const std::string& word) const {
    if (word.starts_with("VAR")) return word == "VAR" || word.starts_with("VAR_");
    if (word == "PROGRAM" || word == "FUNCTION" || word == "FUNCTION_BLOCK") return true;
    return std::ranges::find(closed_, word) != closed_.end();
}

/// `VERSION : 0.1`, `AUTHOR : me` and `TITLE = text` of SCL, which their line ends.
bool Style::is_attribute(std::size_t i) const {
    constexpr std::string_view words[] = {"AUTHOR", "FAMILY", "NAME"};
    const bool has_colon = i + 1 < pieces_.size() && pieces_[i + 1].is(Word::colon) && !in_case();
    return pieces_[i].is(Word::version_) || !title_behind(i).empty() ||
           (has_colon && std::ranges::find(words, pieces_[i].word()) != std::end(words));
}

bool is_unindented(const std::string& word) {
    constexpr std::string_view words[] = {
        "PROGRAM",  "FUNCTION",  "FUNCTION_BLOCK",     "METHOD",     "CLASS",  "INTERFACE",
        "PROPERTY", "NAMESPACE", "ORGANIZATION_BLOCK", "DATA_BLOCK", "ACTION", "CONFIGURATION"};
    return std::ranges::find(words, word) != std::end(words);
}

std::size_t Style::depth() const {
    std::size_t levels = 0;
    for (const Open& open : open_)
        levels += (open.is_indented ? 1U : 0U) + (open.has_label ? 1U : 0U);
    return levels;
}

void Style::close(const std::string& word) {
    const auto fits = [&](const Open& open) {
        return open.word == word || (word == "VAR" && open.word.starts_with("VAR"));
    };
    const auto found = std::find_if(open_.rbegin(), open_.rend(), fits);
    if (found != open_.rend()) open_.erase(std::prev(found.base()), open_.end());
}

std::size_t Style::indent_of(std::size_t i) {
    const Piece& piece = pieces_[i];
    const std::string word = piece.word();
    const bool is_end = word.starts_with("END_");
    if (is_header_ && brackets_ == 0) begins_ = true;
    is_header_ = false;
    if (is_end) {
        auto inner = open_;
        close(word.substr(4));
        const std::size_t at = depth();
        open_ = std::move(inner);
        return blanks_a_level * at;
    }
    std::size_t levels = depth();
    const bool is_middle = word == "ELSE" || word == "ELSIF" ||
                           (word == "UNTIL" && !open_.empty() && open_.back().word == "REPEAT");
    if (is_middle && levels > 0) {
        levels -= in_case() && open_.back().has_label ? 2 : 1;
    } else if (begins_ && in_case() && open_.back().has_label && is_label(i)) {
        --levels;
    } else if (!begins_ && piece.token && !is_one_of(piece, {Word::then_, Word::do_, Word::of_})) {
        if (!(brackets_ == 1 && bracket(piece) < 0)) ++levels;
    }
    return blanks_a_level * levels;
}

/// What the piece opens, ends and goes on with.
void Style::take(std::size_t i) {
    const Piece& piece = pieces_[i];
    if (!piece.token) return;
    const std::string word = piece.word();
    brackets_ = std::max(brackets_ + bracket(piece), 0);
    const bool is_inner = word == "STRUCT" || word == "UNION";
    if (word.starts_with("END_")) {
        close(word.substr(4));
        begins_ = true;
        return;
    }
    if ((begins_ || is_inner) && brackets_ == 0 && opens(word)) {
        open_.push_back({word, !is_unindented(word)});
        is_header_ = word != "IF" && word != "CASE" && word != "FOR" && word != "WHILE";
        begins_ = word == "REPEAT";
        return;
    }
    if (begins_ && is_attribute(i)) {
        is_header_ = true;
        return;
    }
    if (begins_ && word == "ELSE" && in_case()) open_.back().has_label = false;
    if (ends_label(i)) {
        if (in_case()) open_.back().has_label = true;
        begins_ = true;
        return;
    }
    if (begins_) begun_ = i;
    begins_ =
        is_one_of(piece, {Word::semicolon, Word::then_, Word::do_, Word::else_, Word::begin_}) ||
        (piece.is(Word::of_) && in_case());
}

/// What is no token up to the end of the line: of a REGION or a TITLE, with a blank before it.
std::string_view Style::title_behind(std::size_t i) const {
    const std::size_t next = i + 1 < pieces_.size() ? pieces_[i + 1].place.begin : text_.size();
    std::string_view title = text_.substr(pieces_[i].place.end, next - pieces_[i].place.end);
    const std::size_t line = title.find('\n');
    if (!pieces_[i].token || (line == title.npos && next < text_.size())) return {};
    title = title.substr(0, line);
    title = title.substr(0, title.find_last_not_of(" \r\t") + 1);
    const std::size_t begin = std::min(title.find_first_not_of(" \t"), title.size());
    return title.substr(begin > 0 && begin < title.size() ? begin - 1 : begin);
}

std::optional<std::string> Style::write(Diagnostics& wrong) {
    std::string out;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        std::string gap(between(i));
        if (i > 0) {
            const std::string_view title = title_behind(i - 1);
            out += title;
            if (!title.empty())
                gap.erase(0, static_cast<std::size_t>(title.data() + title.size() - text_.data()) -
                                 pieces_[i - 1].place.end);
        }
        const auto lines = std::ranges::count(gap, '\n');
        std::string left = gap;  // what is no token, as the '#' behind a prefix
        std::erase_if(left, [](char c) {
            return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f';
        });
        if (!left.empty() && left != "#" && left != utf8_byte_order_mark) {
            refuse(i, wrong);
            return {};
        }
        if (i == 0 || lines > 0) {
            const bool is_apart = lines > 1 && i > 0;
            if (i > 0) out += is_apart ? end_ + end_ : end_;
            out += std::string(indent_of(i), ' ');
        } else if (!pieces_[i].token && pieces_[i - 1].token) {
            const auto blanks = gap.size() - left.size();
            out += std::string(std::max<std::size_t>(blanks, 1), ' ');
        } else if (left.empty() && is_spaced(i)) {
            out += ends_label(i) ? "" : " ";
        }
        out += left;
        out += pieces_[i].text();
        take(i);
    }
    const std::string_view title =
        pieces_.empty() ? std::string_view() : title_behind(pieces_.size() - 1);
    out += title;
    const std::size_t last =
        pieces_.empty() ? 0
        : title.empty() ? pieces_.back().place.end
                        : static_cast<std::size_t>(title.data() - text_.data()) + title.size();
    std::string rest(text_.substr(last));
    rest.erase(0, std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
    if (!rest.empty()) return {};
    return out.empty() ? out : out + end_;
}

/// Tells what stands before a piece and is none.
void Style::refuse(std::size_t i, Diagnostics& wrong) const {
    const std::uint32_t end = i == 0 ? 0 : pieces_[i - 1].place.end;
    const auto begin = static_cast<std::uint32_t>(text_.find_first_not_of(" \t\r\n\f", end));
    const bool has_condition = std::ranges::any_of(pieces_, [](const Piece& piece) {
        return !piece.token && upper(piece.text()).starts_with("{IF");
    });
    wrong.add(code::character_of_no_word, Place{pieces_[i].place.source, begin, begin + 1}.mark(),
              fmt::format("what stands here is {}, and is not brought into the style",
                          has_condition ? "left out by its {IF ...}" : "not read"));
}

/// Nothing but blanks and ends of lines differs.
bool is_same_code(const std::string& a, const std::string& b, const std::string& path) {
    const auto bare = [&](const std::string& text) {
        Diagnostics untold;
        const auto file = std::make_shared<SourceFile>(SourceFile{path, text});
        const Tokens all = read_tokens(file, untold, SourceKind::tests);
        std::vector<std::string> words;
        for (const Piece& piece : pieces_of(all)) words.emplace_back(piece.text());
        return words;
    };
    return bare(a) == bare(b);
}

}  // namespace

std::optional<std::string> in_style(const std::shared_ptr<const SourceFile>& file,
                                    Diagnostics& out) {
    const Tokens all = read_tokens(file, out, SourceKind::tests);
    if (!out.empty()) return {};
    auto styled = Style(*file, pieces_of(all)).write(out);
    if (styled && !is_same_code(file->text, *styled, file->path)) styled.reset();
    return styled;
}

}  // namespace lineshaft::st
