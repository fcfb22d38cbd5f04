#include "runtime/st/syntax/recovery.hpp"

#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/mistakes.hpp"

namespace lineshaft::st {

namespace {

/// The lexer left something out just before.
bool follows_mistake(const Cursor& p) {
    const std::string_view before = p.source->text().substr(0, p.last().place.begin);
    const std::size_t line = before.rfind('\n') + 1;
    return std::ranges::any_of(
        p.mistakes, [&](std::uint32_t at) { return at >= line && at <= p.here().place.begin; });
}

/// A comment without an end took the rest of the file.
bool is_swallowed(const Cursor& p) {
    return !p.mistakes.empty() && p.mistakes.back() >= p.last().place.end;
}

bool closes_statement(Word word) {
    return word == Word::end_if_ || word == Word::end_case_ || word == Word::end_for_ ||
           word == Word::end_while_ || word == Word::end_repeat_ || word == Word::endtry_;
}

constexpr bool ends_statements(Word word) {
    return word == Word::end_of_file || word == Word::else_ || word == Word::elsif_ ||
           word == Word::until_ || word == Word::catch_ || word == Word::finally_ ||
           word == Word::endtry_;
}

bool at_end_of_block(const Cursor& p) {
    return is_end(p.here().word) || ends_statements(p.here().word) || p.at_pou() || p.at_test() ||
           p.at_action() || (p.is(Word::type_) && p.is_name(1));
}

/// What stands here is beside units, never within one.
bool at_unit(const Cursor& p) {
    return p.at_pou() && !p.at_method() && p.here().first_in_line;
}

/// What stands here cannot be within a block, whose end is missing.
bool is_left(const Parsing& p) {
    return at_end_of_block(p) || at_label_of_case(p);
}

/// What follows the ')' of a call is no operator and no ';'.
bool is_doomed_call(const Cursor& p) {
    int open = 0;
    for (std::size_t i = 1; p.at + i < p.tokens.size(); ++i) {
        const Word word = p.next(i).word;
        open += (word == Word::open) - (word == Word::close);
        if (word == Word::semicolon) return false;
        if (open > 0 || p.next(i + 1).first_in_line) continue;
        const Word then = p.next(i + 1).word;
        return then == Word::then_ || then == Word::do_ || then == Word::of_;
    }
    return false;
}

/// Every word of a text, as what it declares cannot be known.
void lose_words(Tree& tree, std::string_view text) {
    const auto is_part = [](char c) { return is_letter(c) || is_digit(c); };
    for (auto it = text.begin(); it != text.end();) {
        const auto name = std::find_if(it, text.end(), is_part);
        it = std::find_if_not(name, text.end(), is_part);
        tree.lost.try_emplace(std::string_view(name, it));
    }
}

}  // namespace

void tell(Parsing& p, const char* code, Place place, std::string message, std::string help) {
    p.is_wrong = true;
    p.out.add(code, place.mark(), std::move(message), std::move(help));
}

void fail(Parsing& p, const char* code, Place place, std::string message, std::string help) {
    if (!p.panic) tell(p, code, place, std::move(message), std::move(help));
    p.panic = true;
}

void expected(Parsing& p, std::string_view what, std::string_view where) {
    if (p.panic || refuse_unsupported(p)) return;
    p.is_wrong = true;
    p.panic = p.unclosed_at == p.at || follows_mistake(p);
    const char first = what.front();
    const bool is_word =
        (first >= 'A' && first <= 'Z') || (first >= 'a' && first <= 'z') || first == '_';
    fail(p, code::something_else_expected, p.here().place,
         fmt::format("expected {0}{1}{0}{2}{3}, found {4}", is_word ? "" : "'", what,
                     where.empty() ? "" : " ", where, found(p)),
         habit(p));
}

bool expect(Parsing& p, Word word, std::string_view where) {
    if (p.accept(word)) return true;
    if (respell(p, {&word, 1})) {
        p.take();
        return true;
    }
    expected(p, shown(word), where);
    return false;
}

Token expect_name(Parsing& p, std::string_view what) {
    if (!p.panic && p.is_name()) return p.take();
    expected(p, what);
    return p.here();
}

bool close(Parsing& p, Word end, const Token& opener) {
    if (p.accept(end)) return true;
    if (p.panic || p.unclosed_at == p.at) return false;
    if (!is_left(p)) {
        expected(p, shown(end));
        return false;
    }
    p.unclosed_at = p.at;
    if (p.is(Word::end_of_file) && is_swallowed(p)) return false;
    if (find_pou(opener.word) && (p.is(Word::end_of_file) || at_unit(p))) {
        p.out.warn(code::something_else_expected, opener.place.mark(),
                   fmt::format("this {} has no {}", shown(opener.word), shown(end)),
                   p.is(Word::end_of_file) ? std::string("it ends with the file")
                                           : fmt::format("it ends before {}", found(p)));
        return true;
    }
    if (!p.else_ifs.empty() && end == Word::end_if_) {
        tell(p, code::something_else_expected, p.else_ifs.back(),
             "'ELSE IF' begins a second IF without an END_IF", "write ELSIF");
        return false;
    }
    if (closes_statement(p.here().word) && find_pou(opener.word)) {
        tell(p, code::something_else_expected, p.here().place,
             fmt::format("{} ends nothing", found(p)),
             "remove it, or look for another one above that is too many");
        return false;
    }
    tell(p, code::something_else_expected, p.here().place,
         fmt::format("expected {} before {}", shown(end), found(p)),
         fmt::format("the {} in line {} does not end", shown(opener.word),
                     opener.place.mark().line));
    return false;
}

void end_statement(Parsing& p) {
    if (p.panic || p.unclosed_at == p.at || p.accept(Word::semicolon)) return;
    const Token& here = p.here();
    if (!here.first_in_line && !is_end(here.word) && !ends_statements(here.word) && !p.at_method())
        return expected(p, ";", "after the statement");
    if (follows_mistake(p)) return;
    Place place = p.last().place;
    place.begin = place.end - 1;
    tell(p, code::something_else_expected, place, "expected ';' after this",
         "put a ';' at the end of the statement");
}

/// `VAR CONSTANT` of `VAR_CONSTANT`, `END_VAR` of `END_VAR_INPUT`: the word that the name goes on
/// from, and what is meant; empty: it is none.
static std::pair<std::string, std::string> joined_words(std::string_view name,
                                                        std::span<const std::string> words) {
    std::pair<std::string, std::string> found;
    for (const std::string& word : words) {
        const bool is_whole = word.starts_with("VAR") || word.starts_with("END_");
        const bool goes_on = is_whole && name.size() > word.size() && name[word.size()] == '_' &&
                             same_name(name.substr(0, word.size()), word);
        if (!goes_on || word.size() < found.first.size()) continue;
        const std::string rest = upper(name.substr(word.size() + 1));
        const bool is_modifier = rest == "CONSTANT" || rest == "RETAIN" || rest == "PERSISTENT";
        found = {word, is_modifier ? fmt::format("{} {}", word, rest) : word};
    }
    return found;
}

bool respell(Parsing& p, std::span<const Word> words) {
    if (p.panic || !p.is(Word::name) || p.here().quoted) return false;
    std::vector<std::string> names;
    for (const Word word : words) names.emplace_back(shown(word));
    const auto near = nearest(p.here().text, names);
    auto [meant, shown_as] = joined_words(p.here().text, names);
    if (!near.empty()) meant = shown_as = near.front();
    if (meant.empty()) return false;
    tell(p, code::something_else_expected, p.here().place,
         fmt::format("'{}' is not a word of the language", p.here().text),
         fmt::format("write {}", shown_as));
    const auto index = std::ranges::find(names, meant) - names.begin();
    p.tokens[p.at].word = words[static_cast<std::size_t>(index)];
    return true;
}

bool at_doomed_name(const Cursor& p) {
    if (!p.is(Word::name)) return false;
    const Token& behind = p.next();
    if (behind.word == Word::semicolon || behind.first_in_line) return true;
    if (behind.word == Word::open) return is_doomed_call(p);
    return is_name(behind.word) || behind.word == Word::integer || behind.word == Word::not_ ||
           is_end(behind.word);
}

bool at_end_of_statements(const Cursor& p) {
    return !p.is(Word::end_region_) && !p.is(Word::end_network_) && at_end_of_block(p);
}

bool at_label_of_case(const Parsing& p) {
    return p.cases > 0 && p.here().first_in_line && p.at_label() &&
           (p.is(Word::integer) || p.next().word == Word::colon);
}

std::string found(const Cursor& p) {
    constexpr std::size_t longest = 60;  // bytes that are shown
    if (p.is(Word::end_of_file)) return std::string(shown(Word::end_of_file));
    std::string_view text = p.here().place.text();
    text = text.substr(0, text.find('\n'));
    if (text.size() <= longest) return fmt::format("'{}'", text);
    std::size_t end = longest;
    while ((text[end] & 0xC0) == 0x80) --end;  // within a character
    return fmt::format("'{}...'", text.substr(0, end));
}

void skip_line(Parsing& p) {
    p.panic = false;
    p.take();
    while (!p.is(Word::end_of_file) && !p.here().first_in_line) p.take();
}

static void skip_to_declaration(Parsing& p) {
    p.panic = false;
    const auto begins_line = [&](Word word) { return p.is(word) && p.here().first_in_line; };
    while (!p.is(Word::end_of_file) && !p.at_pou() && !p.is(Word::var_global_) && !p.at_test() &&
           !p.is(Word::end_namespace_) && !begins_line(Word::type_) &&
           !begins_line(Word::namespace_) && !(p.at_action() && p.here().first_in_line))
        p.take();
}

void skip_declaration(Parsing& p) {
    p.panic = false;
    while (!p.is(Word::end_of_file) && !is_end(p.here().word) && !p.at_pou())
        if (p.take().word == Word::semicolon) return;
}

void skip_to_statement(Parsing& p) {
    p.panic = false;
    while (!p.is(Word::end_of_file) && !is_end(p.here().word) && !p.accept(Word::semicolon)) {
        const bool begins = p.is(Word::if_) || p.is(Word::for_) || p.is(Word::while_) ||
                            p.is(Word::case_) || p.is(Word::repeat_) || p.is(Word::else_) ||
                            p.is(Word::elsif_) || p.is(Word::until_);
        if (p.here().first_in_line && (begins || p.at_pou() || p.at_test())) return;
        p.take();
    }
}

void skip_past(Parsing& p, Word end) {
    p.panic = false;
    while (!p.is(Word::end_of_file) && !p.is(end) && !p.at_pou() && !p.at_test()) p.take();
    p.accept(end);
}

void lose_if_wrong(Parsing& p, void (*read)(Parsing&)) {
    const std::size_t first = p.at;
    const std::uint32_t begin = first == 0 ? 0 : p.here().place.begin;
    const std::size_t types = p.tree.types.size(), units = p.tree.units.size(),
                      globals = p.tree.globals.size();
    const std::size_t blocks = p.fixture ? p.fixture->blocks.size() : 0,
                      methods = p.fixture ? p.fixture->methods.size() : 0;
    p.is_wrong = false;
    read(p);
    if (p.panic) skip_to_declaration(p);
    const std::uint32_t end = p.here().place.begin;
    const auto is_within = [&](std::uint32_t at) { return at >= begin && at < end; };
    if (!p.is_wrong && std::ranges::none_of(p.mistakes, is_within)) return;
    p.was_wrong = true;
    for (std::size_t i = types; i < p.tree.types.size(); ++i) p.tree.types[i].is_lost = true;
    for (std::size_t i = units; i < p.tree.units.size(); ++i) p.tree.units[i]->is_lost = true;
    for (std::size_t i = globals; i < p.tree.globals.size(); ++i) p.tree.globals[i].is_lost = true;
    if (p.fixture) p.fixture->blocks.resize(blocks), p.fixture->methods.resize(methods);
    for (std::size_t i = first; i < p.at; ++i) p.tree.lost.try_emplace(p.tokens[i].text);
    lose_words(p.tree, p.source->text().substr(begin, end - begin));
}

}  // namespace lineshaft::st
