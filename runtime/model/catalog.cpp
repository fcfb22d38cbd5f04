#include "runtime/model/catalog.hpp"

#include <algorithm>

namespace lineshaft {

bool same_letters(std::string_view a, std::string_view b) {
    const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    return std::ranges::equal(a, b, {}, small, small);
}

const Field* BlockType::find_settable(std::string_view field) const {
    for (const Field& f : fields)
        if (same_letters(f.name, field) && f.direction != Direction::output &&
            f.direction != Direction::local)
            return &f;
    return nullptr;
}

const Field* BlockType::find_readable(std::string_view field) const {
    for (const Field& f : fields)
        if (same_letters(f.name, field) &&
            (f.direction == Direction::output || f.direction == Direction::local))
            return &f;
    const Field* settable = find_settable(field);
    return settable && settable->direction == Direction::in_out ? nullptr : settable;
}

const TableField* BlockType::find_table(std::string_view table) const {
    for (const TableField& t : tables)
        if (same_letters(t.name, table)) return &t;
    return nullptr;
}

const BlockType* Catalog::find(std::string_view name) const {
    const auto it = std::ranges::find_if(
        types_, [&](const BlockType& type) { return same_letters(type.name, name); });
    return it == types_.end() ? nullptr : &*it;
}

std::string_view Catalog::instead_of(std::string_view name) const {
    const auto it = std::ranges::find_if(
        lacking_, [&](const Lacking& kind) { return same_letters(kind.name, name); });
    return it == lacking_.end() ? std::string_view{} : it->instead;
}

std::vector<std::string> Catalog::names() const {
    std::vector<std::string> names;
    for (const BlockType& t : types_) names.emplace_back(t.name);
    return names;
}

}  // namespace lineshaft
