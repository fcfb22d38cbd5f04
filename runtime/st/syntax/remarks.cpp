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

namespace {

/// What stands between the quotes of `text` at the number `place`; empty: it has fewer.
std::string_view between_quotes(std::string_view text, int place) {
    for (; place >= 0; --place) {
        text.remove_prefix(std::min(text.find('\''), text.size() - 1) + 1);
        const std::size_t end = std::min(text.find('\''), text.size());
        if (place == 0) return text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (text.empty()) break;
    }
    return {};
}

const Pragma* find_attribute(const Tokens& tokens, std::size_t token, std::string_view name) {
    const auto it = std::ranges::find_if(tokens.pragmas, [&](const Pragma& pragma) {
        if (pragma.before != token) return false;
        const std::string_view text = pragma.place.text();
        const std::string_view words = text.substr(0, std::min(text.find('\''), text.size()));
        return words.find("attribute") != words.npos && same_name(between_quotes(text, 0), name);
    });
    return it == tokens.pragmas.end() ? nullptr : &*it;
}

}  // namespace

bool has_attribute(const Tokens& tokens, std::size_t token, std::string_view name) {
    return find_attribute(tokens, token, name) != nullptr;
}

std::string_view attribute_value(const Tokens& tokens, std::size_t token, std::string_view name) {
    const Pragma* found = find_attribute(tokens, token, name);
    return found ? between_quotes(found->place.text(), 1) : std::string_view();
}

std::string_view block_number(const Tokens& tokens, std::size_t token) {
    for (const Pragma& pragma : tokens.pragmas) {
        const std::string_view text = pragma.place.text();
        const std::size_t at = pragma.before == token ? text.find("S7_BlockNumber") : text.npos;
        const std::size_t begin = at == text.npos ? at : text.find('"', at);
        const std::size_t end = begin == text.npos ? begin : text.find('"', begin + 1);
        if (end != text.npos) return text.substr(begin + 1, end - begin - 1);
    }
    return {};
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
