#include "runtime/st/syntax/remarks.hpp"

#include <algorithm>

namespace lineshaft::st {

std::pair<std::string_view, Place> unit_between(const Tokens& tokens, std::size_t first,
                                                std::size_t last) {
    const auto& pragmas = tokens.pragmas;
    for (auto it = std::ranges::upper_bound(pragmas, first, {}, &Pragma::before);
         it != pragmas.end() && it->before <= last; ++it) {
        if (it->before == last && it->first_in_line) continue;
        std::string_view text = it->place.text();
        text.remove_prefix(std::min(text.find_first_not_of("{ \t"), text.size()));
        if (!same_name(text.substr(0, 4), "unit")) continue;
        const std::size_t begin = text.find_first_of("'\""), end = text.find_last_of("'\"");
        if (begin != end) return {text.substr(begin + 1, end - begin - 1), it->place};
    }
    return {};
}

bool has_attribute(const Tokens& tokens, std::size_t token, std::string_view name) {
    return std::any_of(tokens.pragmas.begin(), tokens.pragmas.end(), [&](const Pragma& pragma) {
        if (pragma.before != token) return false;
        std::string_view text = pragma.place.text();
        const std::size_t quote = std::min(text.find('\''), text.size());
        if (text.substr(0, quote).find("attribute") == text.npos) return false;
        text.remove_prefix(std::min(quote + 1, text.size()));
        return same_name(text.substr(0, text.find('\'')), name);
    });
}

bool is_of_caller(const Tokens& tokens, std::size_t token) {
    return std::ranges::any_of(tokens.pragmas, [&](const Pragma& pragma) {
        return pragma.before == token && (says_pragma(pragma.place.text(), "callerfilepath") ||
                                          says_pragma(pragma.place.text(), "callerlinenumber"));
    });
}

std::string_view comment_before(const Tokens& tokens, std::size_t token, bool first_in_line) {
    const auto& comments = tokens.comments;
    const auto first = std::ranges::lower_bound(comments, token, {}, &Pragma::before);
    const auto behind = std::ranges::upper_bound(comments, token, {}, &Pragma::before);
    const auto fits = [&](const Pragma& c) { return c.first_in_line == first_in_line; };
    auto begin = std::find_if(first, behind, fits);
    const auto end = std::find_if_not(begin, behind, fits);
    const auto is_apart = [](const Pragma& a, const Pragma& b) {
        Place between = a.place;
        between.begin = a.place.end;
        between.end = b.place.begin;
        return std::ranges::count(between.text(), '\n') > 1;
    };
    for (auto next = begin; next != end && next + 1 != end; ++next)
        if (is_apart(*next, next[1])) begin = next + 1;
    return begin == end ? std::string_view() : begin->place.to((end - 1)->place).text();
}

}  // namespace lineshaft::st
