#include "runtime/model/catalog.hpp"

#include <algorithm>

namespace lineshaft {

const Field* BlockType::find(std::string_view field) const {
    const auto it = std::ranges::find(fields, field, &Field::name);
    return it == fields.end() ? nullptr : &*it;
}

std::vector<std::string> BlockType::field_names() const {
    std::vector<std::string> names;
    for (const Field& f : fields) names.emplace_back(f.name);
    return names;
}

const BlockType* Catalog::find(std::string_view name) const {
    const auto it = std::ranges::find(types_, name, &BlockType::name);
    return it == types_.end() ? nullptr : &*it;
}

std::vector<std::string> Catalog::names() const {
    std::vector<std::string> names;
    for (const BlockType& t : types_) names.emplace_back(t.name);
    return names;
}

}  // namespace lineshaft
