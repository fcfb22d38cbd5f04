#include <algorithm>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/parser.hpp"

namespace lineshaft::st {

namespace {

bool is_declaration(const Pou& unit) {
    return unit.place.source && lower(unit.place.source->file->path).ends_with(".fun") &&
           unit.body.empty() && unit.methods.empty();
}

bool is_body(const Pou& unit) {
    return !unit.result && unit.blocks.empty() && unit.bases.empty() && !unit.is_action;
}

}  // namespace

void join_declared_apart(Tree& tree) {
    NameMap<Pou*> declared;
    for (Pou* unit : tree.units)
        if (is_declaration(*unit)) declared.emplace(unit->name.text, unit);
    if (declared.empty()) return;
    std::vector<const Pou*> joined;
    for (Pou* unit : tree.units) {
        const auto it = declared.find(unit->name.text);
        if (it == declared.end() || it->second == unit) continue;
        Pou& declaration = *it->second;
        if (declaration.kind != unit->kind || !is_body(*unit)) continue;
        unit->result = declaration.result;
        unit->blocks = std::move(declaration.blocks);
        if (unit->doc.empty()) unit->doc = declaration.doc;
        joined.push_back(&declaration);
        declared.erase(it);
    }
    std::erase_if(tree.units,
                  [&](const Pou* unit) { return std::ranges::find(joined, unit) != joined.end(); });
}

}  // namespace lineshaft::st
