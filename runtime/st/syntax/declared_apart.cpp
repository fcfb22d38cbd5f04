#include <algorithm>
#include <utility>

#include "runtime/st/syntax/parser.hpp"

namespace lineshaft::st {

namespace {

bool is_declaration(const Pou& unit) {
    return unit.place.source && unit.place.source->has_no_bodies() && unit.body.empty() &&
           unit.methods.empty();
}

/// `name;` or `name();`, wherever that stands.
bool runs(const Block& statements, std::string_view name) {
    return std::ranges::any_of(statements, [&](const Statement* s) {
        const Expression* named = s->value;
        if (s->kind == Statement::Kind::call && named && named->kind == Expression::Kind::call)
            named = named->operands[0];
        const bool is_run = s->kind == Statement::Kind::action || s->kind == Statement::Kind::call;
        if (is_run && named && named->kind == Expression::Kind::name &&
            same_name(named->token.text, name))
            return true;
        return runs(s->body, name) || std::ranges::any_of(s->branches, [&](const Branch& branch) {
                   return runs(branch.body, name);
               });
    });
}

std::string_view folder_of(const Pou& unit) {
    const std::string_view path = unit.place.source->file->path;
    return path.substr(0, path.find_last_of('/') + 1);
}

/// The one block in the folder of an ACTION that runs it; null: none does, or several do.
Pou* runner_of(const Tree& tree, const Pou& action) {
    Pou* found = nullptr;
    for (Pou* unit : tree.units) {
        if (unit->kind != PouKind::function_block || folder_of(*unit) != folder_of(action))
            continue;
        const bool is_run = runs(unit->body, action.name.text) ||
                            std::ranges::any_of(unit->methods, [&](const Pou* method) {
                                return runs(method->body, action.name.text);
                            });
        if (is_run && std::exchange(found, unit)) return nullptr;
    }
    return found;
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

void give_actions_to_blocks(Tree& tree) {
    for (std::size_t i = 0; i < tree.units.size();) {
        Pou* action = tree.units[i++];
        if (!action->is_action || !action->place.dialect().actions_are_of_callers) continue;
        Pou* block = runner_of(tree, *action);
        if (!block) continue;
        action->kind = PouKind::method;
        block->methods.push_back(action);
        tree.units.erase(std::ranges::find(tree.units, action));
        i = 0;  // what it runs itself is of the same block
    }
}

}  // namespace lineshaft::st
