#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "runtime/st/syntax/parser.hpp"

namespace lineshaft::st {

namespace {

/// What the later ones are called instead, by the names as they are written, of one source.
using NewNames = std::unordered_map<std::string_view, std::string_view>;

NewNames names_of_later_types(Tree& tree, const Source* source) {
    NewNames made;
    NameMap<std::string_view> first;
    const auto is_only_one = [&](std::string_view name) {
        return std::ranges::count(tree.types, name,
                                  [](const auto& type) { return type.name.text; }) == 1;
    };
    for (const TypeDeclaration& type : tree.types) {
        const std::string_view name = type.name.text;
        if (type.name.place.source != source) continue;
        const auto [known, is_first] = first.emplace(name, name);
        if (is_first || known->second == name || !is_only_one(name)) continue;
        made[name] = tree.names.emplace_back(
            fmt::format("{} of line {}", name, type.name.place.mark().line));
    }
    return made;
}

}  // namespace

void tell_types_by_capitals(Tree& tree) {
    NewNames all;
    std::vector<const Source*> seen;
    for (const TypeDeclaration& type : tree.types) {
        const Source* source = type.name.place.source;
        const bool is_new = std::ranges::find(seen, source) == seen.end();
        if (!source || !is_new || !source->dialect.capitals_count) continue;
        seen.push_back(source);
        all.merge(names_of_later_types(tree, source));
    }
    if (all.empty()) return;
    const auto rename = [&](Token& name) {
        if (!name.place.source || !name.place.dialect().capitals_count) return;
        if (const auto it = all.find(name.text); it != all.end()) name.text = it->second;
    };
    for (TypeDeclaration& type : tree.types) rename(type.name);
    for (TypeText& type : tree.type_texts) rename(type.name), rename(type.base);
    for (Expression& e : tree.expressions)
        if (e.kind == Expression::Kind::typed) rename(e.token);
}

}  // namespace lineshaft::st
