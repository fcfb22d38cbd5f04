#include "tools/lineshaft/codes.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace lineshaft {

namespace {

constexpr std::string_view codes_txt =
#include "runtime/source/codes.inc"
    ;

/// The text before `end`, which is taken off, too.
std::string_view take(std::string_view& rest, std::string_view end) {
    const std::string_view part = rest.substr(0, rest.find(end));
    rest.remove_prefix(std::min(part.size() + end.size(), rest.size()));
    return part;
}

/// A line `L0203 unknown_port`, a line with the title, the paragraph, and a blank line each.
std::vector<CodeText> read_texts() {
    std::vector<CodeText> texts;
    for (std::string_view rest = codes_txt; !rest.empty();) {
        std::string_view part = take(rest, "\n\n");
        const std::string_view code = take(part, " ");
        const std::string_view name = take(part, "\n");
        const std::string_view title = take(part, "\n");
        texts.push_back({code, name, title, part.substr(0, part.find_last_not_of('\n') + 1)});
    }
    return texts;
}

}  // namespace

std::span<const CodeText> diagnostic_codes() {
    static const std::vector<CodeText> texts = read_texts();
    return texts;
}

const CodeText* find_code(std::string_view code) {
    std::string wanted(code);
    if (wanted.starts_with('l')) wanted.front() = 'L';
    const auto codes = diagnostic_codes();
    const auto it = std::ranges::find(codes, wanted, &CodeText::code);
    return it == codes.end() ? nullptr : &*it;
}

}  // namespace lineshaft
