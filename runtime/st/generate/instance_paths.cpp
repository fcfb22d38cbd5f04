#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "runtime/st/generate/layout.hpp"

namespace lineshaft::st {

namespace {

struct Paths {
    std::unordered_set<const Variable*> named = {};  ///< that say where their instances are

    bool has_any(const Type& type) const {
        const auto is_one = [&](const Variable* v) {
            return named.contains(v) || (v->type && has_any(*v->type));
        };
        if (type.kind == Kind::array) return has_any(*type.element);
        if (type.kind == Kind::structure) return std::ranges::any_of(type.members, is_one);
        return type.kind == Kind::block &&
               std::ranges::any_of(all_variables(*type.routine), [&](const Variable* v) {
                   return v->space == Space::frame && is_one(v);
               });
    }
};

bool names_its_instance(const Variable& variable) {
    if (!variable.of || !variable.type || variable.type->kind != Kind::text) return false;
    const auto is_it = [&](const Declaration* declared) {
        return declared->is_path && same_name(declared->name.text, variable.text);
    };
    return std::ranges::any_of(variable.of->blocks, [&](const DeclarationBlock& block) {
        return std::ranges::any_of(block.declarations, is_it);
    });
}

void put_text(Writing::Image& image, std::uint32_t at, const Type& type, std::string_view text) {
    text = text.substr(0, type.length);
    image[at] = text.size();
    std::memcpy(&image[at] + 1, text.data(), text.size());
}

void fill_paths_of(Writing& w, const Paths& paths, Writing::Image& image, std::uint32_t at,
                   const Type& type, const std::string& path);

void fill_paths_of_elements(Writing& w, const Paths& paths, Writing::Image& image, std::uint32_t at,
                            const Type& array, const std::string& path) {
    const std::uint32_t slots = slots_of(w, *array.element);
    for (std::int64_t i = array.lower; i <= array.upper; ++i, at += slots) {
        fill_paths_of(w, paths, image, at, *array.element,
                      fmt::format("{}{}{}{}", path, path.ends_with(',') ? "" : "[", i,
                                  array.has_inner ? "," : "]"));
    }
}

void fill_paths_of(Writing& w, const Paths& paths, Writing::Image& image, std::uint32_t at,
                   const Type& type, const std::string& path) {
    if (!paths.has_any(type)) return;
    if (type.kind == Kind::array) return fill_paths_of_elements(w, paths, image, at, type, path);
    const auto members = type.kind == Kind::block ? all_variables(*type.routine) : type.members;
    for (const Variable* member : members) {
        if (member->space != Space::frame || member->section == Section::temp) continue;
        if (paths.named.contains(member))
            put_text(image, at + member->slot, *member->type, path);
        else if (member->type)
            fill_paths_of(w, paths, image, at + member->slot, *member->type,
                          fmt::format("{}.{}", path, member->text));
    }
}

std::string_view path_of_application(const Token& name) {
    return name.place.source ? name.place.dialect().instance_root : iec.instance_root;
}

}  // namespace

void fill_paths(Writing& w) {
    Paths paths;
    for (const Routine& routine : w.checked.routines)
        for (const Variable& variable : routine.variables)
            if (names_its_instance(variable)) paths.named.insert(&variable);
    if (paths.named.empty()) return;
    for (const Routine& routine : w.checked.routines)
        if (routine.pou->kind == PouKind::program && !routine.owner)
            fill_paths_of(
                w, paths, w.images[routine.type], 0, *routine.type,
                fmt::format("{}.{}", path_of_application(routine.pou->name), routine.name));
    for (const Global& global : w.checked.globals) {
        if (global.type->kind != Kind::structure || global.is_statics) continue;
        for (const Variable* member : global.type->members)
            if (member->type)
                fill_paths_of(
                    w, paths, w.images[global.type], member->slot, *member->type,
                    fmt::format("{}.{}", path_of_application(member->name), member->text));
    }
}

}  // namespace lineshaft::st
