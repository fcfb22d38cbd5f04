#include "runtime/st/prelude/standard_source.hpp"

#include <algorithm>

#include "runtime/source/letters.hpp"
#include "runtime/st/types/s5.hpp"

namespace lineshaft::st {

namespace {

constexpr std::string_view written =
#include "runtime/st/prelude/prelude.inc"
    ;

/// Adds to `names` what stands behind each `before`, up to a blank or a character of `ends`.
void add_names(NameSet& names, std::string_view text, std::string_view before,
               std::string_view ends) {
    for (std::size_t at = text.find(before); at != text.npos; at = text.find(before, at)) {
        at += before.size();
        names.insert(text.substr(at, text.find_first_of(ends, at) - at));
    }
}

/// What the prelude has for others: names of its helpers begin with a small letter.
NameSet names_of_prelude(std::initializer_list<std::string_view> kinds) {
    NameSet names;
    for (const std::string_view before : kinds) add_names(names, written, before, " \n");
    std::erase_if(names,
                  [](std::string_view name) { return name.front() >= 'a' && name.front() <= 'z'; });
    return names;
}

const NameSet& functions() {
    static const NameSet names = names_of_prelude({"\nFUNCTION "});
    return names;
}

const NameSet& types() {
    static const NameSet names = names_of_prelude({"\nFUNCTION_BLOCK ", "\nTYPE "});
    return names;
}

/// A function is called; a type is named.
bool is_of_prelude(const Token& token, const Token& behind) {
    const bool is_name = token.word == Word::name || token.word == Word::prefix;
    return is_name && (types().contains(token.text) || same_name(token.text, s5time_type.name) ||
                       (behind.word == Word::open && functions().contains(token.text)));
}

}  // namespace

const std::shared_ptr<const SourceFile>& standard_source() {
    static const auto source = std::make_shared<const SourceFile>(
        SourceFile{"(standard functions)", std::string(written)});
    return source;
}

bool uses_standard_source(const Tokens& tokens) {
    for (std::size_t i = 0; i + 1 < tokens.tokens.size(); ++i)
        if (is_of_prelude(tokens.tokens[i], tokens.tokens[i + 1])) return true;
    return false;
}

bool is_in_standard_source(std::string_view name) {
    return functions().contains(name) || types().contains(name);
}

std::shared_ptr<const SourceFile> source_of(const BlockType& type) {
    return std::make_shared<const SourceFile>(
        SourceFile{"(" + std::string(type.name) + ")", std::string(type.structured_text)});
}

bool uses_source_of(const BlockType& type, const Tokens& tokens) {
    const std::string_view text = type.structured_text;
    if (text.empty()) return false;
    NameSet said;
    add_names(said, text, "FUNCTION \"" + std::string(type.handle) + '.', "\"");
    NameSet first_words;  // of `Modulo.Enable`
    for (const std::string_view name : said) first_words.insert(name.substr(0, name.find('.')));
    return std::ranges::any_of(tokens.tokens, [&](const Token& token) {
        return token.word == Word::name && first_words.contains(token.text);
    });
}

}  // namespace lineshaft::st
