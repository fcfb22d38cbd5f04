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
        const std::size_t begin = rest.find_first_not_of("{} \t\r\n");
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
    bool accept(std::string_view word) { return same_name(next(), word) && !take().empty(); }
};

bool any_holds(PragmaWords& words, const NameSet& defined);

bool one_holds(PragmaWords& words, const NameSet& defined) {
    if (words.accept("not")) return !one_holds(words, defined);
    if (words.accept("(")) {
        const bool inner = any_holds(words, defined);
        words.accept(")");
        return inner;
    }
    const bool asks_definition = same_name(words.take(), "defined");
    if (!words.accept("(")) return false;
    const std::string_view name = words.take();
    const bool is_plain = words.next() == ")";
    while (!words.next().empty() && words.take() != ")") continue;
    return asks_definition && is_plain && defined.contains(name);
}

bool any_holds(PragmaWords& words, const NameSet& defined) {
    bool any = false;
    do {
        bool all = one_holds(words, defined);
        while (words.accept("and")) all = one_holds(words, defined) && all;
        any = any || all;
    } while (words.accept("or"));
    return any;
}

}  // namespace

bool says_pragma(std::string_view pragma, std::string_view word) {
    return same_name(PragmaWords{pragma}.next(), word);
}

bool holds(std::string_view pragma, const NameSet& defined) {
    PragmaWords words{pragma};
    words.take();
    return any_holds(words, defined);
}

void note_definition(std::string_view pragma, NameSet& defined) {
    PragmaWords words{pragma};
    const std::string_view what = words.take(), name = words.take();
    if (same_name(what, "define")) defined.insert(name);
    if (same_name(what, "undefine")) defined.erase(name);
}

}  // namespace lineshaft::st
