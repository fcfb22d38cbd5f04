#include <algorithm>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/remarks.hpp"

namespace lineshaft::st {

namespace {

/// Words and signs of a pragma, one by one.
struct PragmaWords {
    std::string_view rest;

    static bool is_part(char c) { return is_letter(c) || is_digit(c); }

    std::string_view next() const {
        const std::size_t begin = rest.find_first_not_of("{}: \t\r\n");
        if (begin == rest.npos) return {};
        const std::string_view text = rest.substr(begin);
        const auto* end = std::ranges::find_if_not(text, is_part);
        return text.substr(0,
                           std::max<std::size_t>(1, static_cast<std::size_t>(end - text.begin())));
    }
    std::string_view take() {
        const std::string_view word = next();
        rest =
            word.empty() ? word : rest.substr(static_cast<std::size_t>(word.end() - rest.begin()));
        return word;
    }
    /// What stands between quotes; empty where none follows.
    std::string_view take_value() {
        if (!accept("'")) return {};
        const std::string_view text = rest.substr(0, rest.find('\''));
        rest.remove_prefix(std::min(text.size() + 1, rest.size()));
        return text;
    }
    bool accept(std::string_view word) { return same_name(next(), word) && !take().empty(); }
};

bool any_holds(PragmaWords& words, const Definitions& defined);

bool one_holds(PragmaWords& words, const Definitions& defined) {
    if (words.accept("not")) return !one_holds(words, defined);
    if (words.accept("(")) {
        const bool inner = any_holds(words, defined);
        words.accept(")");
        return inner;
    }
    const std::string_view asked = words.take();
    if (!words.accept("(")) return false;
    const auto known = defined.find(words.take());
    const bool asks_value = same_name(asked, "hasvalue") && words.accept(",");
    const std::string_view value = asks_value ? words.take_value() : std::string_view();
    const bool is_plain = words.next() == ")";
    while (!words.next().empty() && words.take() != ")") continue;
    if (!is_plain || known == defined.end()) return false;
    return asks_value ? known->second == value : same_name(asked, "defined");
}

bool any_holds(PragmaWords& words, const Definitions& defined) {
    bool any = false;
    do {
        bool all = one_holds(words, defined);
        while (words.accept("and")) all = one_holds(words, defined) && all;
        any = any || all;
    } while (words.accept("or"));
    return any;
}

}  // namespace

std::size_t end_of_quoted(std::string_view text, std::size_t begin) {
    const char quote = text[begin];
    if (quote != '\'' && quote != '"') return 0;
    const std::size_t end = text.find(quote, begin + 1);
    if (end == std::string_view::npos) return 0;
    const std::string_view quoted = text.substr(begin, end - begin);
    if (quoted.find('\n') == std::string_view::npos) return end;
    const bool closes = quoted.substr(0, quoted.find('\n')).find('}') != std::string_view::npos;
    const std::size_t behind = text.find_first_not_of(" \t\r\n", end + 1);
    const bool goes_on = behind != std::string_view::npos &&
                         std::string_view("},;:)").find(text[behind]) != std::string_view::npos;
    return !closes && goes_on ? end : 0;
}

bool says_pragma(std::string_view pragma, std::string_view word) {
    return same_name(PragmaWords{pragma}.next(), word);
}

bool begins_choice(std::string_view pragma) {
    return says_pragma(pragma, "if") || says_pragma(pragma, "ifdef") ||
           says_pragma(pragma, "ifndef");
}

bool holds(std::string_view pragma, const Definitions& defined) {
    PragmaWords words{pragma};
    const std::string_view what = words.take();
    if (same_name(what, "ifdef")) return defined.contains(words.take());
    if (same_name(what, "ifndef")) return !defined.contains(words.take());
    return any_holds(words, defined);
}

bool ends_choice(std::string_view pragma) {
    return says_pragma(pragma, "end_if") || says_pragma(pragma, "endif");
}

LeftOut left_out(std::string_view text, std::size_t at, bool may_choose,
                 const Definitions& defined) {
    std::size_t inner = 0;
    for (++at; at < text.size(); ++at) {
        if (text[at] != '{') continue;
        const std::size_t end = std::min(text.find('}', at), text.size() - 1);
        const std::string_view pragma = text.substr(at, end + 1 - at);
        at = end;
        const bool ends = ends_choice(pragma);
        if (ends && inner == 0) return {at, true};
        inner += begins_choice(pragma);
        inner -= ends;
        const bool chosen =
            says_pragma(pragma, "else") || (says_pragma(pragma, "elsif") && holds(pragma, defined));
        if (may_choose && inner == 0 && chosen) return {at, false};
    }
    return {at, false};
}

void note_definition(std::string_view pragma, Definitions& defined) {
    PragmaWords words{pragma};
    const std::string_view what = words.take(), name = words.take();
    if (same_name(what, "define")) defined.insert_or_assign(name, words.take_value());
    if (same_name(what, "undefine")) defined.erase(name);
}

}  // namespace lineshaft::st
