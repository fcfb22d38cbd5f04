#include "runtime/st/syntax/blanks.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/st/syntax/foreign_text.hpp"

namespace lineshaft::st {

namespace {

constexpr int deepest_comment = 200;

/// Behind a name it is a call.
bool at_translated_comment(const TextCursor& in) {
    const auto& tokens = in.tokens.tokens;
    return (tokens.empty() || tokens.back().word != Word::name) &&
           is_translated_comment(in.text, in.at);
}

/// Stops before the end of the line. It is told where it begins.
bool skip_conflict(TextCursor& in) {
    const std::size_t end = in.new_line ? end_of_conflict(in.text, in.at) : in.text.npos;
    if (end == in.text.npos) return false;
    if (in.is_at("<"))
        in.fail(in.place(in.at, in.at + 7), "a merge of git has left both versions here",
                "keep one of them, and remove the lines of '<<<<<<<', '=======' and '>>>>>>>'");
    in.at = end - 1;
    return true;
}

void too_deep(TextCursor& in, Place where) {
    in.tokens.mistakes.push_back(where.begin);
    in.out.add(code::too_deep_or_large, where.mark(),
               fmt::format("comments are nested deeper than {} levels", deepest_comment),
               "a comment in a comment needs an end of its own");
    in.at = in.text.size();
}

/// Stops at the line's last character.
void skip_line(TextCursor& in) {
    in.skip_to_end_of_line();
    --in.at;
}

/// Stops at the comment's last character.
void skip_comment(TextCursor& in) {
    const std::size_t begin = in.at;
    if (const std::size_t end = end_of_tools_comment(in.text, in.at)) return void(in.at = end - 1);
    const bool standard = in.is_at("(*"), translated = in.is_at("(/*");
    const std::string_view open = standard ? "(*" : translated ? "(/*" : "/*";
    const std::string_view close = standard ? "*)" : translated ? "*/)" : "*/";
    int depth = 0;
    std::size_t first_end = 0;
    for (; in.at < in.text.size(); ++in.at) {
        if (in.is_at(open)) {
            if (++depth > deepest_comment) return too_deep(in, in.place(in.at, in.at + 2));
            in.at += open.size() - 1;
        } else if (in.is_at(close)) {
            in.at += close.size() - 1;
            if (first_end == 0) first_end = in.at;
            if (--depth == 0) return;
        }
    }
    if (first_end != 0) {
        in.at = first_end;
        return in.out.warn(code::character_of_no_word, in.place(begin, begin + 2).mark(),
                           fmt::format("this comment is read up to its first '{}'", close),
                           fmt::format("a comment in it has no '{}' of its own", close));
    }
    in.fail(in.place(begin, begin + 2), "the comment does not end",
            fmt::format("it ends with '{}'; comments nest, so each '{}' needs one", close, open));
}

void note_comment(TextCursor& in, void (*skip)(TextCursor&)) {
    const std::size_t begin = in.at;
    skip(in);
    in.tokens.comments.push_back({in.tokens.tokens.size(), in.new_line,
                                  in.place(begin, std::min(in.at + 1, in.text.size()))});
}

bool skip_foreign_code(TextCursor& in) {
    const std::size_t end = end_of_foreign_code(in.text, in.at);
    if (end == std::string_view::npos) return false;
    if (!std::exchange(in.has_foreign_code, true))
        in.out.warn(code::not_supported, in.place(in.at, in.at + 2).mark(),
                    "what is written in C is left out",
                    in.is_at("{{")
                        ? "between {{ and }} stands what another compiler gives to its own"
                        : "{external ...} is what STruCpp gives to another compiler");
    in.tokens.pragmas.push_back({in.tokens.tokens.size(), in.new_line, in.place(in.at, end)});
    in.at = end - 1;
    return true;
}

void skip_part(TextCursor& in, bool may_choose) {
    const LeftOut part = left_out(in.text, in.at, may_choose, in.defined);
    in.at = part.last;
    if (part.ends_choice) in.choices.pop_back();
}

/// `{IF defined (x)}`, `{define x}`: a part whose condition does not hold is left out.
void obey(TextCursor& in, Place pragma) {
    const std::string_view text = pragma.text();
    note_definition(text, in.defined);
    if (begins_choice(text)) {
        in.choices.push_back(pragma);
        if (!holds(text, in.defined)) skip_part(in, true);
    } else if (!in.choices.empty() && (says_pragma(text, "elsif") || says_pragma(text, "else"))) {
        skip_part(in, false);
    } else if (!in.choices.empty() && ends_choice(text)) {
        in.choices.pop_back();
    }
}

void skip_pragma(TextCursor& in) {
    if (skip_foreign_code(in)) return;
    const std::size_t begin = in.at;
    for (; in.at < in.text.size() && in.text[in.at] != '}'; ++in.at)
        if (const std::size_t end = end_of_quoted(in.text, in.at)) in.at = end;
    if (in.at == in.text.size())
        in.fail(in.place(begin, begin + 1), "the pragma does not end", "it ends with '}'");
    in.tokens.pragmas.push_back({in.tokens.tokens.size(), in.new_line,
                                 in.place(begin, std::min(in.at + 1, in.text.size()))});
    obey(in, in.tokens.pragmas.back().place);
}

}  // namespace

void skip_blanks(TextCursor& in) {
    for (; in.at < in.text.size(); ++in.at) {
        const char c = in.text[in.at];
        if (c == ' ' || (c >= '\t' && c <= '\r' && c != '\n')) continue;
        if (c == '\n')
            in.new_line = true;
        else if (in.is_at("(*") || in.is_at("/*") || at_translated_comment(in))
            note_comment(in, skip_comment);
        else if (in.is_at("//"))
            note_comment(in, skip_line);
        else if (c == '{')
            skip_pragma(in);
        else if (!skip_conflict(in))
            return;
    }
}

}  // namespace lineshaft::st
