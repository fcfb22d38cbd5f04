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
#include "runtime/st/syntax/blanks.hpp"
#include "runtime/st/syntax/foreign_text.hpp"
#include "runtime/st/syntax/literals.hpp"

namespace lineshaft::st {

namespace {

constexpr std::string_view time_prefixes[] = {"t", "time", "lt", "ltime", "s5t", "s5time"};
constexpr std::string_view date_prefixes[] = {
    "d",    "date",         "ld",  "ldate",          "tod", "time_of_day", "dt", "date_and_time",
    "ltod", "ltime_of_day", "ldt", "ldate_and_time", "dtl"};

/// Once, and nothing else can be meant.
void fail_as_binary(TextCursor& in, Place where) {
    in.at = in.text.size();
    in.fail(where, "the file is not a text", "save it as UTF-8");
}

void read_foreign(TextCursor& in) {
    const Utf8Character character = first_character(in.text.substr(in.at));
    in.at += character.bytes;
    const Place here = in.place(in.start, in.at);
    in.tokens.mistakes.push_back(here.begin);
    if (const auto alike = find_look_alike(here.text()))
        return in.out.add(code::look_alike_character, here.mark(),
                          fmt::format("{} stands where {} is meant", alike->name, alike->instead),
                          fmt::format("type {}", alike->instead));
    if (std::exchange(in.last_foreign, in.at) == in.start) return;
    if (!character.valid || is_control(character.code) || character.code == 0xFFFD)
        return fail_as_binary(in, here);
    in.fail(here, fmt::format("'{}' has no meaning here", here.text()),
            std::string(instead_of(in.text.substr(in.start))));
}

/// `:P` behind an address or a tag: what stands there now, which is what the image has.
void skip_periphery(TextCursor& in) {
    const bool goes_on = is_letter(in.peek(2)) || is_digit(in.peek(2)) || in.peek(2) == '_';
    if (in.dialect.peripheries_are_image && in.is_at(":P") && !goes_on) in.at += 2;
}

void read_marked_name(TextCursor& in) {
    const bool local = in.peek() == '#';
    if (local) ++in.at;
    if (in.peek() == '"') {
        const std::size_t begin = ++in.at;
        const bool may_be_text = in.dialect.quotes_may_enclose_texts;
        while (in.peek() != '"' && in.peek() != '\n' && in.at < in.text.size())
            in.at += may_be_text && in.is_at("$\"") ? 2 : 1;
        const std::string_view text = in.text.substr(begin, in.at - begin);
        if (in.peek() == '"')
            ++in.at;
        else
            in.fail(in.place(in.start, in.start + 1), "the quoted name does not end",
                    "it ends with '\"'");
        const bool is_prefix =
            !local && in.peek() == '#' && (is_letter(in.peek(1)) || in.peek(1) == '"');
        Token& token = in.add(is_prefix ? Word::prefix : Word::name);
        token.text = text;
        token.quoted = !local;
        token.local = local;
        if (is_prefix) ++in.at;
        if (!is_prefix && !local) skip_periphery(in);
        return;
    }
    in.skip_name();
    Token& token = in.add(Word::name);
    token.local = true;
    token.text.remove_prefix(1);
    if (!token.text.empty()) return;
    in.fail(token.place, "'#' stands before a name, or between a type and its value", {});
    in.tokens.tokens.pop_back();
}

/// `%X0`, or what follows the dot of a bit.
bool is_direct(const TextCursor& in) {
    return is_letter(in.peek(1)) || in.text.substr(0, in.at).ends_with('.');
}

void read_direct(TextCursor& in) {
    ++in.at;
    in.skip_while([](char c) { return is_letter(c) || is_digit(c); });
    const bool partial = in.is_after_dot();
    const std::string_view named = in.text.substr(in.start + 1, in.at - in.start - 1);
    if (!partial && in.dialect.packs_as_s7 && is_data_block(named))
        return ++in.start, void(in.add(Word::name));
    while (!partial && in.peek() == '.' && is_digit(in.peek(1))) {
        ++in.at;
        in.skip_while(is_digit);
    }
    if (!partial && in.peek() == '*') ++in.at;
    in.add(Word::direct);
    if (!partial) skip_periphery(in);
}

/// To its closing quote, to the end of its line where there is none. It may go on in the next
/// lines; one that lacks its quote has a ';' before the next one, of B&R where its line ends.
void pass_text(TextCursor& in) {
    const auto is_pair = [&] {
        return in.peek() == '$' ? in.peek(1) != '\n' && in.peek(1) != '\0' : in.is_at("''");
    };
    const auto pass_until = [&](std::string_view ends) {
        while (in.at < in.text.size() && (ends.find(in.text[in.at]) == ends.npos || is_pair()))
            in.at += is_pair() ? 2 : 1;
    };
    pass_until("'\n");
    const std::size_t end_of_line = in.at;
    const bool ends_so = in.text[in.text.find_last_not_of(" \t\r", in.at - 1)] == ';';
    if (in.peek() == '\n')
        pass_until(in.dialect.open_texts_end_with_lines && !ends_so ? "'" : "';");
    const std::size_t behind = in.text.find_first_not_of(" \t", in.at + 1);
    const bool is_whole = in.peek() == '\'' && behind != in.text.npos &&
                          in.text.find_first_of(";,)]\r\n", behind) == behind;
    if (in.at != end_of_line && !is_whole) in.at = end_of_line;
}

/// Tells that a text lacks its quote, so that there is no other mistake.
void refuse_open_text(TextCursor& in) {
    const bool escapes = in.text.substr(in.start, in.at - in.start).find("$'") != in.text.npos;
    in.out.add(
        code::character_of_no_word, in.place(in.start, in.start + 1).mark(),
        "the text does not end",
        escapes ? "it ends with \"'\"; $' is a quote in it, $$ is '$'" : "it ends with \"'\"");
    const std::size_t last = in.text.find_last_not_of(" \t\r", in.at - 1);
    if (escapes || last <= in.start || in.text[last] != ';')
        return void(in.tokens.mistakes.push_back(static_cast<std::uint32_t>(in.start)));
    in.at = std::max(in.text.find_last_not_of("); \t\r", last), in.start) + 1;
}

void read_text(TextCursor& in) {
    ++in.at;
    pass_text(in);
    const bool ends = in.peek() == '\'';
    ends ? void(++in.at) : refuse_open_text(in);
    Token& token = in.add(Word::text);
    token.text = token.text.substr(1, token.text.size() - (ends ? 2 : 1));
}

/// `10.` of CODESYS, at the '.'.
bool is_end_of_real(const TextCursor& in) {
    return in.dialect.points_may_end_reals && in.peek(1) != '.' && !is_letter(in.peek(1));
}

/// `THEN` of `16#D013THEN`: the word that a number without a blank behind it ends before. None
/// where the letters are no word: the number is wrong as a whole then.
std::size_t end_of_based_number(const TextCursor& in) {
    const bool is_hexadecimal = in.text.substr(in.start, in.at - in.start) == "16#";
    const auto is_digit_here = [&](char c) {
        return is_digit(c) || c == '_' || (is_hexadecimal && lower(c) >= 'a' && lower(c) <= 'f');
    };
    std::size_t first = in.at;
    while (first < in.text.size() && is_digit_here(in.text[first])) ++first;
    std::size_t end = first;
    while (end < in.text.size() && (is_letter(in.text[end]) || is_digit(in.text[end]))) ++end;
    return word_of(in.text.substr(first, end - first)) ? first : end;
}

void read_number(TextCursor& in) {
    const auto digits = [&] { in.skip_while([](char c) { return is_digit(c) || c == '_'; }); };
    digits();
    if (in.peek() == '#') {
        ++in.at;
        in.at = end_of_based_number(in);
        return void(in.add(Word::integer));
    }
    bool real = false;
    if (in.peek() == '.' && (is_digit(in.peek(1)) || is_end_of_real(in)) && !in.is_after_dot()) {
        real = true;
        ++in.at;
        digits();
    }
    const std::size_t sign = in.peek(1) == '-' || in.peek(1) == '+' ? 2 : 1;
    if (lower(in.peek()) == 'e' && is_digit(in.peek(sign))) {
        real = true;
        in.at += sign;
        digits();
    }
    in.add(real ? Word::real : Word::integer);
}

/// `P#DB102.DBX124.0 WORD 2`, `P#M 100.0 BYTE 4` and `P# I2.0 BYTE 4` of Siemens, at the sign: one
/// address.
void read_any_pointer(TextCursor& in) {
    const auto is_part = [](char c) { return is_letter(c) || is_digit(c) || c == '.'; };
    const auto skip_spaces = [&] { in.skip_while([](char c) { return c == ' '; }); };
    ++in.at;
    skip_spaces();
    in.skip_while(is_part);
    if (is_letter(in.text[in.at - 1]) && in.peek() == ' ') skip_spaces(), in.skip_while(is_part);
    const std::size_t end_of_place = in.at;
    skip_spaces();
    in.skip_while(is_letter);
    skip_spaces();
    const std::size_t end_of_type = in.at;
    in.skip_while(is_digit);
    if (in.at == end_of_type) in.at = end_of_place;
    in.add(Word::direct);
}

void read_prefix(TextCursor& in, std::string_view text) {
    if (in.dialect.packs_as_s7 && same_name(text, "p")) return read_any_pointer(in);
    in.add(Word::prefix);
    in.start = ++in.at;
    if (find_called(date_prefixes, text) && is_digit(in.peek())) {
        const auto is_part = [](char c) { return is_digit(c) || c == '_' || c == ':' || c == '.'; };
        in.skip_while(is_part);
        while (in.peek() == '-' && is_digit(in.peek(1))) {
            ++in.at;
            in.skip_while(is_part);
        }
        return void(in.add(Word::duration));
    }
    if (!find_called(time_prefixes, text)) return;
    if (in.dialect.durations_may_stand_apart) {
        in.skip_while([](char c) { return c == ' ' || c == '\t'; });
        in.start = in.at;
    }
    if (in.peek() == '-' || in.peek() == '+') ++in.at;
    in.skip_while([](char c) { return is_letter(c) || is_digit(c) || c == '.'; });
    in.add(Word::duration);
}

/// `REF=`, and behind what may be assigned `S=` and `R=`.
std::optional<Word> read_letter_assign(const TextCursor& in, std::string_view text) {
    if (in.peek() != '=' || in.tokens.tokens.empty()) return {};
    if (same_name(text, "ref")) return Word::reference_assign;
    const Token& before = in.tokens.tokens.back();
    const bool assigned = before.word == Word::name || before.word == Word::caret ||
                          before.word == Word::close_bracket || before.word == Word::direct ||
                          before.word == Word::integer;
    if (!assigned || in.new_line) return {};
    if (same_name(text, "s")) return Word::set_assign;
    return same_name(text, "r") ? std::optional(Word::reset_assign) : std::nullopt;
}

/// `M0` of `M0.3`, as STEP 7 V5 writes it.
bool is_classic_bit(const TextCursor& in, std::string_view text) {
    return in.dialect.packs_as_s7 && in.peek() == '.' && is_digit(in.peek(1)) &&
           in.text[in.start] != '"' && read_classic_address(fmt::format("{}.0", text)).has_value();
}

/// A ':', ':=' or ',' follows.
bool is_declared_or_assigned(const TextCursor& in) {
    const std::size_t next = in.text.find_first_not_of(" \t", in.at);
    return next != std::string_view::npos && (in.text[next] == ':' || in.text[next] == ',');
}

bool skip_section(TextCursor& in, std::string_view word) {
    if (!in.new_line || !in.dialect.has_sections_of_exports) return false;
    const std::size_t end = end_of_section(in.text, in.at, word);
    if (end != in.text.npos) in.at = end;
    return end != in.text.npos;
}

/// CoDeSys 2.3 exports `FUNCTIONBLOCK TMAX`, too.
bool is_function_block(const TextCursor& in, std::string_view text) {
    return in.new_line && in.dialect.is_loose && same_name(text, "functionblock");
}

void read_word(TextCursor& in) {
    in.skip_name();
    const std::string_view text = in.text.substr(in.start, in.at - in.start);
    const bool after_dot = in.is_after_dot();
    if (in.peek() == '#') return read_prefix(in, text);
    if (const auto word = read_letter_assign(in, text)) return ++in.at, void(in.add(*word));
    if (!after_dot && is_classic_bit(in, text)) return in.at += 2, void(in.add(Word::direct));
    if (skip_section(in, text)) return;
    const std::optional<Word> word =
        is_function_block(in, text) ? Word::function_block_ : word_of(text);
    if (in.new_line && is_title(in.text, in.at, text))
        return in.add(Word::name), in.skip_to_end_of_line();
    const bool is_variable = word == Word::region_ && (!in.new_line || is_declared_or_assigned(in));
    const bool is_part = after_dot && !in.new_line;  // else somebody is about to write it
    const bool is_foreign = word == Word::goto_ && in.dialect.goto_is_a_name;  // it has JMP
    if (!word || is_part || is_variable || is_foreign) return void(in.add(Word::name));
    in.add(*word);
    if (word == Word::region_ || word == Word::end_region_) in.skip_to_end_of_line();  // a title
}

void read_token(TextCursor& in) {
    in.start = in.at;
    const char c = in.peek();
    if (is_letter(c) || in.national_letter() != 0) return read_word(in);
    if (is_digit(c)) return read_number(in);
    if (c == '\'') return read_text(in);
    if (c == '"' || c == '#') return read_marked_name(in);
    if (c == '%' && is_direct(in)) return read_direct(in);
    if (in.is_at("&&") && in.dialect.ampersands_may_be_two)
        return in.at += 2, void(in.add(Word::ampersand));
    for (const Sign& sign : signs()) {
        if (!in.is_at(sign.text)) continue;
        in.at += sign.text.size();
        return void(in.add(sign.word));
    }
    read_foreign(in);
}

}  // namespace

Tokens read_tokens(const std::shared_ptr<const SourceFile>& file, Diagnostics& out,
                   SourceKind kind) {
    const Dialect& dialect = dialect_of(*file, kind);
    TextCursor in(std::make_shared<const Source>(Source{file, dialect, kind}), out);
    if (in.text.starts_with(utf8_byte_order_mark)) in.at = utf8_byte_order_mark.size();
    if (const std::size_t zero = in.text.find('\0'); zero != std::string_view::npos)
        fail_as_binary(in, in.place(zero, zero + 1));
    in.tokens.tokens.reserve(in.text.size() / 4 + 1);
    for (skip_blanks(in); in.at < in.text.size(); skip_blanks(in)) read_token(in);
    for (const Place& open : in.choices)
        in.fail(open, "the {IF} does not end", "it ends with {END_IF}");
    in.start = in.at = in.text.size();
    in.add(Word::end_of_file);
    return std::move(in.tokens);
}

}  // namespace lineshaft::st
