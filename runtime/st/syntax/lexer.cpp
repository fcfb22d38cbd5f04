#include "runtime/st/syntax/lexer.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/habits.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"
#include "runtime/st/syntax/foreign_text.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/syntax/remarks.hpp"

namespace lineshaft::st {

namespace {

constexpr int deepest_comment = 200;

constexpr std::string_view time_prefixes[] = {"t", "time", "lt", "ltime", "s5t", "s5time"};
constexpr std::string_view date_prefixes[] = {
    "d",    "date",         "ld",  "ldate",          "tod", "time_of_day", "dt", "date_and_time",
    "ltod", "ltime_of_day", "ldt", "ldate_and_time", "dtl"};

/// One class, as each kind of token is a function that moves the same place in the text.
class Lexer {
  public:
    Lexer(const std::shared_ptr<const Source>& source, Diagnostics& out)
        : text_(source->text()), out_(out) {
        tokens_.source = source;
    }

    Tokens read() {
        if (text_.starts_with(utf8_byte_order_mark)) at_ = utf8_byte_order_mark.size();
        if (const std::size_t zero = text_.find('\0'); zero != std::string_view::npos)
            fail_as_binary(place(zero, zero + 1));
        tokens_.tokens.reserve(text_.size() / 4 + 1);
        for (skip_blanks(); at_ < text_.size(); skip_blanks()) read_token();
        for (const Place& open : choices_)
            fail(open, "the {IF} does not end", "it ends with {END_IF}");
        start_ = at_ = text_.size();
        add(Word::end_of_file);
        return std::move(tokens_);
    }

  private:
    char peek(std::size_t ahead = 0) const {
        return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
    }
    bool at(std::string_view text) const {
        return peek() == text[0] && text_.substr(at_).starts_with(text);
    }
    Place place(std::size_t begin, std::size_t end) const {
        return {tokens_.source.get(), static_cast<std::uint32_t>(begin),
                static_cast<std::uint32_t>(end)};
    }
    template <class Condition>
    void skip_while(Condition condition) {
        while (at_ < text_.size() && condition(text_[at_])) ++at_;
    }

    /// Bytes of a letter beyond ASCII that is next; 0 where there is none.
    std::size_t national_letter() const {
        if (at_ >= text_.size() || is_ascii(text_[at_])) return 0;
        const Utf8Character character = first_character(text_.substr(at_));
        return character.valid && is_national_letter(character.code) ? character.bytes : 0;
    }

    void skip_name() {
        for (std::size_t bytes = 1; bytes != 0; at_ += bytes)
            bytes = is_letter(peek()) || is_digit(peek()) ? 1 : national_letter();
    }

    Token& add(Word word) {
        Token& token = tokens_.tokens.emplace_back();
        token.word = word;
        token.first_in_line = new_line_;
        token.place = place(start_, at_);
        token.text = text_.substr(start_, at_ - start_);
        new_line_ = false;
        return token;
    }

    void skip_blanks() {
        for (; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (c == ' ' || (c >= '\t' && c <= '\r' && c != '\n')) continue;
            if (c == '\n')
                new_line_ = true;
            else if (at("(*") || at("/*") || at_translated_comment())
                note_comment(&Lexer::skip_comment);
            else if (at("//"))
                note_comment(&Lexer::skip_line);
            else if (c == '{')
                skip_pragma();
            else if (!skip_conflict())
                return;
        }
    }

    void note_comment(void (Lexer::*skip)()) {
        const std::size_t begin = at_;
        (this->*skip)();
        tokens_.comments.push_back(
            {tokens_.tokens.size(), new_line_, place(begin, std::min(at_ + 1, text_.size()))});
    }

    void skip_to_end_of_line() {
        skip_while([](char c) { return c != '\n'; });
    }
    /// Stops at the line's last character.
    void skip_line() {
        skip_to_end_of_line();
        --at_;
    }

    /// Stops before the end of the line. It is told where it begins.
    bool skip_conflict() {
        const std::size_t end = new_line_ ? end_of_conflict(text_, at_) : text_.npos;
        if (end != text_.npos && at("<"))
            fail(place(at_, at_ + 7), "a merge of git has left both versions here",
                 "keep one of them, and remove the lines of '<<<<<<<', '=======' and '>>>>>>>'");
        if (end != text_.npos) at_ = end - 1;
        return end != text_.npos;
    }

    /// Behind a name that is a call.
    bool at_translated_comment() const {
        const auto& tokens = tokens_.tokens;
        return (tokens.empty() || tokens.back().word != Word::name) &&
               is_translated_comment(text_, at_);
    }

    /// Stops at the comment's last character.
    void skip_comment() {
        const std::size_t begin = at_;
        if (const std::size_t end = end_of_tools_comment(text_, at_)) return void(at_ = end - 1);
        const bool standard = at("(*"), translated = at("(/*");
        const std::string_view open = standard ? "(*" : translated ? "(/*" : "/*";
        const std::string_view close = standard ? "*)" : translated ? "*/)" : "*/";
        int depth = 0;
        std::size_t first_end = 0;
        for (; at_ < text_.size(); ++at_) {
            if (at(open)) {
                if (++depth > deepest_comment) return too_deep(place(at_, at_ + 2));
                at_ += open.size() - 1;
            } else if (at(close)) {
                at_ += close.size() - 1;
                if (first_end == 0) first_end = at_;
                if (--depth == 0) return;
            }
        }
        if (first_end != 0) {
            at_ = first_end;
            return out_.warn(code::character_of_no_word, place(begin, begin + 2).mark(),
                             fmt::format("this comment is read up to its first '{}'", close),
                             fmt::format("a comment in it has no '{}' of its own", close));
        }
        fail(place(begin, begin + 2), "the comment does not end",
             fmt::format("it ends with '{}'; comments nest, so each '{}' needs one", close, open));
    }

    void too_deep(Place where) {
        tokens_.mistakes.push_back(where.begin);
        out_.add(code::too_deep_or_large, where.mark(),
                 fmt::format("comments are nested deeper than {} levels", deepest_comment),
                 "a comment in a comment needs an end of its own");
        at_ = text_.size();
    }

    bool skip_foreign_code() {
        const std::size_t end = end_of_foreign_code(text_, at_);
        if (end == std::string_view::npos) return false;
        if (!std::exchange(has_foreign_code_, true))
            out_.warn(code::not_supported, place(at_, at_ + 2).mark(),
                      "what is written in C is left out",
                      at("{{") ? "between {{ and }} stands what another compiler gives to its own"
                               : "{external ...} is what STruCpp gives to another compiler");
        tokens_.pragmas.push_back({tokens_.tokens.size(), new_line_, place(at_, end)});
        at_ = end - 1;
        return true;
    }

    void skip_pragma() {
        if (skip_foreign_code()) return;
        const std::size_t begin = at_;
        for (; at_ < text_.size() && text_[at_] != '}'; ++at_)
            if (const std::size_t end = end_of_quoted(text_, at_)) at_ = end;
        if (at_ == text_.size())
            fail(place(begin, begin + 1), "the pragma does not end", "it ends with '}'");
        tokens_.pragmas.push_back(
            {tokens_.tokens.size(), new_line_, place(begin, std::min(at_ + 1, text_.size()))});
        obey(tokens_.pragmas.back().place);
    }

    /// `{IF defined (x)}`, `{define x}`: a part whose condition does not hold is left out.
    void obey(Place pragma) {
        const std::string_view text = pragma.text();
        note_definition(text, defined_);
        if (says_pragma(text, "if")) {
            choices_.push_back(pragma);
            if (!holds(text, defined_)) skip_part(true);
        } else if (!choices_.empty() && (says_pragma(text, "elsif") || says_pragma(text, "else"))) {
            skip_part(false);
        } else if (!choices_.empty() && ends_choice(text)) {
            choices_.pop_back();
        }
    }

    void skip_part(bool may_choose) {
        const LeftOut part = left_out(text_, at_, may_choose, defined_);
        at_ = part.last;
        if (part.ends_choice) choices_.pop_back();
    }

    void read_token() {
        start_ = at_;
        const char c = peek();
        if (is_letter(c) || national_letter() != 0) return read_word();
        if (is_digit(c)) return read_number();
        if (c == '\'') return read_text();
        if (c == '"' || c == '#') return read_marked_name();
        if (c == '%' && is_direct()) return read_direct();
        const bool is_of_ax = at("&&") && tokens_.source->dialect.vendor == Vendor::none;
        if (is_of_ax) return at_ += 2, void(add(Word::ampersand));
        for (const Sign& sign : signs()) {
            if (!at(sign.text)) continue;
            at_ += sign.text.size();
            return void(add(sign.word));
        }
        read_foreign();
    }

    void read_word() {
        skip_name();
        const std::string_view text = text_.substr(start_, at_ - start_);
        const bool after_dot = is_after_dot();
        if (peek() == '#') return read_prefix(text);
        if (const auto word = read_letter_assign(text)) return ++at_, void(add(*word));
        if (!after_dot && is_classic_bit(text)) return at_ += 2, void(add(Word::direct));
        if (skip_section(text)) return;
        const std::optional<Word> word = word_of(text);
        if (new_line_ && is_title(text_, at_, text)) return add(Word::name), skip_to_end_of_line();
        const bool is_variable = word == Word::region_ && (!new_line_ || is_declared_or_assigned());
        const bool is_part = after_dot && !new_line_;  // else somebody is about to write it
        const bool is_foreign =
            word == Word::goto_ && tokens_.source->dialect.vendor == Vendor::codesys;  // it has JMP
        if (!word || is_part || is_variable || is_foreign) return void(add(Word::name));
        add(*word);
        if (word == Word::region_ || word == Word::end_region_) skip_to_end_of_line();  // a title
    }

    /// `REF=`, and behind what may be assigned `S=` and `R=`.
    std::optional<Word> read_letter_assign(std::string_view text) const {
        if (peek() != '=' || tokens_.tokens.empty()) return {};
        if (same_name(text, "ref")) return Word::reference_assign;
        const Token& before = tokens_.tokens.back();
        const bool assigned = before.word == Word::name || before.word == Word::caret ||
                              before.word == Word::close_bracket || before.word == Word::direct ||
                              before.word == Word::integer;
        if (!assigned || new_line_) return {};
        if (same_name(text, "s")) return Word::set_assign;
        return same_name(text, "r") ? std::optional(Word::reset_assign) : std::nullopt;
    }

    /// `M0` of `M0.3`, as STEP 7 V5 writes it.
    bool is_classic_bit(std::string_view text) const {
        return tokens_.source->dialect.packs_as_s7 && peek() == '.' && is_digit(peek(1)) &&
               text_[start_] != '"' && read_classic_address(fmt::format("{}.0", text)).has_value();
    }

    /// A ':', ':=' or ',' follows.
    bool is_declared_or_assigned() const {
        const std::size_t next = text_.find_first_not_of(" \t", at_);
        return next != std::string_view::npos && (text_[next] == ':' || text_[next] == ',');
    }

    bool skip_section(std::string_view word) {
        if (!new_line_ || tokens_.source->dialect.vendor != Vendor::codesys) return false;
        const std::size_t end = end_of_section(text_, at_, word);
        if (end != text_.npos) at_ = end;
        return end != text_.npos;
    }

    void read_prefix(std::string_view text) {
        add(Word::prefix);
        start_ = ++at_;
        if (find_called(date_prefixes, text) && is_digit(peek())) {
            const auto is_part = [](char c) {
                return is_digit(c) || c == '_' || c == ':' || c == '.';
            };
            skip_while(is_part);
            while (peek() == '-' && is_digit(peek(1))) {
                ++at_;
                skip_while(is_part);
            }
            return void(add(Word::duration));
        }
        if (!find_called(time_prefixes, text)) return;
        if (tokens_.source->dialect.vendor == Vendor::matiec) {
            skip_while([](char c) { return c == ' ' || c == '\t'; });
            start_ = at_;
        }
        if (peek() == '-' || peek() == '+') ++at_;
        skip_while([](char c) { return is_letter(c) || is_digit(c) || c == '.'; });
        add(Word::duration);
    }

    void read_number() {
        const auto digits = [&] { skip_while([](char c) { return is_digit(c) || c == '_'; }); };
        digits();
        if (peek() == '#') {
            ++at_;
            skip_while([](char c) { return is_letter(c) || is_digit(c); });
            return void(add(Word::integer));
        }
        bool real = false;
        if (peek() == '.' && (is_digit(peek(1)) || is_end_of_real()) && !is_after_dot()) {
            real = true;
            ++at_;
            digits();
        }
        const std::size_t sign = peek(1) == '-' || peek(1) == '+' ? 2 : 1;
        if (lower(peek()) == 'e' && is_digit(peek(sign))) {
            real = true;
            at_ += sign;
            digits();
        }
        add(real ? Word::real : Word::integer);
    }

    /// `10.` of CODESYS, at the '.'.
    bool is_end_of_real() const {
        return tokens_.source->dialect.vendor == Vendor::codesys && peek(1) != '.' &&
               !is_letter(peek(1));
    }

    /// After `word.` a number is that of a bit, and a word a name.
    bool is_after_dot() const {
        return !tokens_.tokens.empty() && tokens_.tokens.back().word == Word::dot;
    }

    /// To its closing quote, to the end of its line where there is none. It may go on in the next
    /// lines; one that lacks its quote has a ';' before the next one, of B&R where its line ends.
    void pass_text() {
        const auto is_pair = [&] {
            return peek() == '$' ? peek(1) != '\n' && peek(1) != '\0' : at("''");
        };
        const auto pass_until = [&](std::string_view ends) {
            while (at_ < text_.size() && (ends.find(text_[at_]) == ends.npos || is_pair()))
                at_ += is_pair() ? 2 : 1;
        };
        pass_until("'\n");
        const std::size_t end_of_line = at_;
        const bool is_of_br = tokens_.source->dialect.vendor == Vendor::automation_studio;
        const bool ends_so = text_[text_.find_last_not_of(" \t\r", at_ - 1)] == ';';
        if (peek() == '\n') pass_until(is_of_br && !ends_so ? "'" : "';");
        const std::size_t behind = text_.find_first_not_of(" \t", at_ + 1);
        const bool is_whole = peek() == '\'' && behind != text_.npos &&
                              text_.find_first_of(";,)]\r\n", behind) == behind;
        if (at_ != end_of_line && !is_whole) at_ = end_of_line;
    }

    /// Of a text without its quote, so that there is no other mistake.
    void refuse_open_text() {
        const bool escapes = text_.substr(start_, at_ - start_).find("$'") != text_.npos;
        out_.add(
            code::character_of_no_word, place(start_, start_ + 1).mark(), "the text does not end",
            escapes ? "it ends with \"'\"; $' is a quote in it, $$ is '$'" : "it ends with \"'\"");
        const std::size_t last = text_.find_last_not_of(" \t\r", at_ - 1);
        if (escapes || last <= start_ || text_[last] != ';')
            return void(tokens_.mistakes.push_back(static_cast<std::uint32_t>(start_)));
        at_ = std::max(text_.find_last_not_of("); \t\r", last), start_) + 1;
    }

    void read_text() {
        ++at_;
        pass_text();
        const bool ends = peek() == '\'';
        ends ? void(++at_) : refuse_open_text();
        Token& token = add(Word::text);
        token.text = token.text.substr(1, token.text.size() - (ends ? 2 : 1));
    }

    void read_marked_name() {
        const bool local = peek() == '#';
        if (local) ++at_;
        if (peek() == '"') {
            const std::size_t begin = ++at_;
            const bool may_be_text = tokens_.source->dialect.quotes_may_enclose_texts;
            while (peek() != '"' && peek() != '\n' && at_ < text_.size())
                at_ += may_be_text && at("$\"") ? 2 : 1;
            const std::string_view text = text_.substr(begin, at_ - begin);
            if (peek() == '"')
                ++at_;
            else
                fail(place(start_, start_ + 1), "the quoted name does not end",
                     "it ends with '\"'");
            const bool is_prefix =
                !local && peek() == '#' && (is_letter(peek(1)) || peek(1) == '"');
            Token& token = add(is_prefix ? Word::prefix : Word::name);
            token.text = text;
            token.quoted = !local;
            token.local = local;
            if (is_prefix) ++at_;
            if (!is_prefix && !local) skip_periphery();
            return;
        }
        skip_name();
        Token& token = add(Word::name);
        token.local = true;
        token.text.remove_prefix(1);
        if (!token.text.empty()) return;
        fail(token.place, "'#' stands before a name, or between a type and its value", {});
        tokens_.tokens.pop_back();
    }

    /// `%X0`, or what follows the dot of a bit.
    bool is_direct() const { return is_letter(peek(1)) || text_.substr(0, at_).ends_with('.'); }

    void read_direct() {
        ++at_;
        skip_while([](char c) { return is_letter(c) || is_digit(c); });
        const bool partial = is_after_dot();
        const std::string_view named = text_.substr(start_ + 1, at_ - start_ - 1);
        if (!partial && tokens_.source->dialect.packs_as_s7 && is_data_block(named))
            return ++start_, void(add(Word::name));
        while (!partial && peek() == '.' && is_digit(peek(1))) {
            ++at_;
            skip_while(is_digit);
        }
        if (!partial && peek() == '*') ++at_;
        add(Word::direct);
        if (!partial) skip_periphery();
    }

    /// `:P` behind an address or a tag: what stands there now, which is what the image has.
    void skip_periphery() {
        const bool goes_on = is_letter(peek(2)) || is_digit(peek(2)) || peek(2) == '_';
        if (tokens_.source->dialect.peripheries_are_image && at(":P") && !goes_on) at_ += 2;
    }

    void read_foreign() {
        const Utf8Character character = first_character(text_.substr(at_));
        at_ += character.bytes;
        const Place here = place(start_, at_);
        tokens_.mistakes.push_back(here.begin);
        if (const auto alike = find_look_alike(here.text()))
            return out_.add(code::look_alike_character, here.mark(),
                            fmt::format("{} stands where {} is meant", alike->name, alike->instead),
                            fmt::format("type {}", alike->instead));
        if (std::exchange(last_foreign_, at_) == start_) return;
        if (!character.valid || is_control(character.code) || character.code == 0xFFFD)
            return fail_as_binary(here);
        fail(here, fmt::format("'{}' has no meaning here", here.text()),
             std::string(instead_of(text_.substr(start_))));
    }

    /// Once, and nothing else can be meant.
    void fail_as_binary(Place where) {
        at_ = text_.size();
        fail(where, "the file is not a text", "save it as UTF-8");
    }

    void fail(Place where, std::string message, std::string help) {
        tokens_.mistakes.push_back(where.begin);
        out_.add(code::character_of_no_word, where.mark(), std::move(message), std::move(help));
    }

    Tokens tokens_;
    const std::string_view text_;
    Diagnostics& out_;
    std::size_t at_ = 0, start_ = 0;
    std::size_t last_foreign_ = std::string_view::npos;  ///< end of the last character of no token
    bool new_line_ = true;
    bool has_foreign_code_ = false;  ///< which was told
    std::vector<Place> choices_;     ///< each `{IF}` that is open
    Definitions defined_;            ///< by `{define}`
};

}  // namespace

Tokens read_tokens(const std::shared_ptr<const SourceFile>& file, Diagnostics& out,
                   SourceKind kind) {
    const Dialect& dialect = dialect_of(*file, kind);
    return Lexer(std::make_shared<const Source>(Source{file, dialect, kind}), out).read();
}

}  // namespace lineshaft::st
