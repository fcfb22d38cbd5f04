#include "runtime/st/syntax/token.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "runtime/source/habits.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::st {

namespace {

constexpr std::string_view word_names[] = {
#define WORD(name) #name,
#define CODESYS(name) "__" #name,
    LINESHAFT_ST_WORDS(WORD, CODESYS)
#undef CODESYS
#undef WORD
};

/// Names of what is neither a word nor a sign, in the order of Word.
constexpr std::string_view other_names[] = {
    "the end of the file", "a name", "a type", "a number", "a number", "a time", "a text",
    "a direct address"};

/// The signs, in the same order, from `assign` on.
constexpr std::string_view sign_texts[] = {
    ":=", "+=", "-=", "*=", "/=", "S=", "R=", "=>", "REF=", "?=", "**", "*", "/",  "+", "-", "<",
    "<=", ">",  ">=", "=",  "<>", "&",  "^",  "(",  ")",    "[",  "]",  ".", "..", ",", ";", ":"};

const NameMap<Word>& words() {
    static const NameMap<Word> map = [] {
        NameMap<Word> made;
        for (std::size_t i = 0; i < std::size(word_names); ++i)
            made.emplace(word_names[i], static_cast<Word>(i));
        return made;
    }();
    return map;
}

}  // namespace

const Dialect& dialect_of(const SourceFile& file, SourceKind kind) {
    if (kind == SourceKind::prelude) return scl;
    const auto said = [&](std::string_view ending) -> const Dialect& {
        return dialect_of(ending, is_plain_text(ending) ? std::string_view() : file.text);
    };
    if (!file.read_as.empty()) return said(file.read_as);
    const bool is_said = kind != SourceKind::library && is_plain_text(file.path);
    return is_said && !plain_text_ending().empty() ? said(plain_text_ending())
                                                   : dialect_of(file.path, file.text);
}

Mark Place::mark() const {
    return mark_of(source->file, begin, end);
}

bool SameName::operator()(std::string_view a, std::string_view b) const {
    return std::ranges::equal(a, b, [](char x, char y) { return lower(x) == lower(y); });
}

std::size_t NameHash::operator()(std::string_view name) const {
    std::size_t hash = 0xcbf29ce484222325;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(lower(c))) * 0x100000001b3;
    return hash;
}

std::optional<Word> word_of(std::string_view text) {
    const Word* word = find_in(words(), text);
    return word ? std::optional(*word) : std::nullopt;
}

std::span<const Sign> signs() {
    static const auto all = [] {
        std::vector<Sign> made;
        for (const std::string_view text : sign_texts)
            made.push_back(
                {text, static_cast<Word>(static_cast<std::size_t>(Word::assign) + made.size())});
        std::ranges::stable_sort(made, std::greater{}, [](const Sign& s) { return s.text.size(); });
        return made;
    }();
    return all;
}

std::string_view shown(Word word) {
    static const auto capitals = [] {
        std::vector<std::string> made;
        for (const std::string_view name : word_names) made.push_back(upper(name));
        return made;
    }();
    const auto i = static_cast<std::size_t>(word);
    if (i < capitals.size()) return capitals[i];
    if (word < Word::assign) return other_names[i - capitals.size()];
    return sign_texts[i - static_cast<std::size_t>(Word::assign)];
}

}  // namespace lineshaft::st
