#include "runtime/st/syntax/text_cursor.hpp"

#include "runtime/source/codes.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"

namespace lineshaft::st {

TextCursor::TextCursor(const std::shared_ptr<const Source>& source, Diagnostics& diagnostics)
    : text(source->text()), dialect(source->dialect), out(diagnostics) {
    tokens.source = source;
}

Place TextCursor::place(std::size_t begin, std::size_t end) const {
    return {tokens.source.get(), static_cast<std::uint32_t>(begin),
            static_cast<std::uint32_t>(end)};
}

std::size_t TextCursor::national_letter() const {
    if (at >= text.size() || is_ascii(text[at])) return 0;
    const Utf8Character character = first_character(text.substr(at));
    return character.valid && is_national_letter(character.code) ? character.bytes : 0;
}

void TextCursor::skip_name() {
    for (std::size_t bytes = 1; bytes != 0; at += bytes)
        bytes = is_letter(peek()) || is_digit(peek()) ? 1 : national_letter();
}

void TextCursor::skip_to_end_of_line() {
    skip_while([](char c) { return c != '\n'; });
}

Token& TextCursor::add(Word word) {
    Token& token = tokens.tokens.emplace_back();
    token.word = word;
    token.first_in_line = new_line;
    token.place = place(start, at);
    token.text = text.substr(start, at - start);
    new_line = false;
    return token;
}

bool TextCursor::is_after_dot() const {
    return !tokens.tokens.empty() && tokens.tokens.back().word == Word::dot;
}

void TextCursor::fail(Place where, std::string message, std::string help) {
    tokens.mistakes.push_back(where.begin);
    out.add(code::character_of_no_word, where.mark(), std::move(message), std::move(help));
}

}  // namespace lineshaft::st
