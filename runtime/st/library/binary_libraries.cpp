#include "runtime/st/library/binary_libraries.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/library/library_index.hpp"
#include "runtime/st/prelude/standard_source.hpp"
#include "runtime/st/types/elementary.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

std::string_view read_as(const Token& name) {
    return name.place.source ? std::string_view(name.place.source->file->read_as) : "";
}

bool is_declared(const Token& name) {
    return is_of_binary_library(name) || read_as(name).starts_with(of_library_in_c);
}

/// The folder of its file.
std::string library_of(const Token& name) {
    return std::filesystem::path(name.place.source->file->path).parent_path().filename().string();
}

/// `REAL_TO_INT`.
bool is_conversion(std::string_view name) {
    constexpr std::string_view between = "_to_";
    const std::string small = lower(std::string(name));
    const std::size_t at = small.find(between);
    return at != small.npos && find_elementary(name.substr(0, at)) &&
           find_elementary(name.substr(at + between.size()));
}

/// B&R's commands of axes take ADR of a McAxisType, which is no axis here.
bool takes_axis(const BlockType& kind, const Catalog& catalog) {
    return std::ranges::any_of(kind.fields, [&](const Field& field) {
        const BlockType* referred = catalog.find(field.refers);
        return referred && !referred->handle.empty();
    });
}

bool is_pin(Section section) {
    return section == Section::input || section == Section::output || section == Section::in_out;
}

/// What lineshaft has of its own.
class Known {
  public:
    explicit Known(const Catalog& catalog) : catalog_(catalog) {}

    bool has(const Token& name) {
        const BlockType* kind = find_called(catalog_.types(), name.text, &BlockType::name);
        return (kind && !kind->is_device() && !takes_axis(*kind, catalog_)) ||
               find_standard_function(name.text) || is_in_standard_source(name.text) ||
               is_conversion(name.text) || standard_type_name(name.text) != name.text ||
               names_in(library_of(name)).contains(name.text);
    }

    /// A library whose blocks have pins that are not here is of another version: all of it is
    /// meant as it is declared.
    void note_version(const Pou& unit) {
        const std::string library = library_of(unit.name);
        for (const LibraryFile& file : catalog_.libraries()) {
            const NameSet words =
                same_name(file.library, library) ? words_of(file, unit.name.text) : NameSet();
            const auto is_missing = [&](const Declaration* pin) {
                return !words.empty() && !words.contains(pin->name.text);
            };
            for (const DeclarationBlock& block : unit.blocks)
                if (is_pin(block.section) && std::ranges::any_of(block.declarations, is_missing))
                    names_[library].clear();
        }
    }

  private:
    const NameSet& names_in(const std::string& library) {
        const auto [it, is_new] = names_.try_emplace(library);
        if (!is_new) return it->second;
        for (const LibraryFile& file : catalog_.libraries())
            if (same_name(file.library, library))
                for (const std::string_view name : declared_in(file)) it->second.insert(name);
        return it->second;
    }

    const Catalog& catalog_;
    std::map<std::string, NameSet> names_;  ///< of libraries
};

/// Names of types, functions and variables in sources that have bodies.
NameSet used_names(const Tree& tree) {
    NameSet used;
    for (const TypeText& type : tree.type_texts)
        if (!is_declared(type.name)) used.insert(type.name.text);
    for (const Expression& e : tree.expressions)
        if (e.kind == Expression::Kind::name && !is_declared(e.token)) used.insert(e.token.text);
    return used;
}

bool is_empty(const Pou& unit) {
    return unit.body.empty() && !unit.chart && unit.methods.empty();
}

/// What B&R's blocks say that a controller does not have: ERR_NOTIMPLEMENTED. 0 would be success.
void answer(Tree& tree, Pou& unit) {
    for (const DeclarationBlock& block : unit.blocks)
        for (Declaration* output : block.declarations) {
            const bool is_status = block.section == Section::output && !output->initial &&
                                   same_name(output->name.text, "status") && output->type &&
                                   same_name(output->type->name.text, "UINT");
            if (!is_status) continue;
            Expression& number = tree.expressions.emplace_back();
            number.token = output->name;
            number.token.word = Word::integer;
            number.token.text = "9999";
            number.place = output->name.place;
            output->initial = &number;
        }
}

}  // namespace

bool is_of_binary_library(const Token& name) {
    return read_as(name).starts_with(of_binary_library);
}

void leave_out_declared(Tree& tree, const Catalog& catalog) {
    Known known(catalog);
    for (const Pou* unit : tree.units)
        if (unit->kind == PouKind::function_block && is_of_binary_library(unit->name))
            known.note_version(*unit);
    const auto is_here = [&](const Token& name) {
        return is_of_binary_library(name) && known.has(name);
    };
    std::erase_if(tree.types, [&](const TypeDeclaration& type) { return is_here(type.name); });
    std::erase_if(tree.units, [&](const Pou* unit) { return is_here(unit->name); });
    for (Pou* unit : tree.units)
        if (unit->kind == PouKind::function_block && is_of_binary_library(unit->name) &&
            is_empty(*unit))
            answer(tree, *unit);
    for (DeclarationBlock& block : tree.globals)
        std::erase_if(block.declarations,
                      [&](const Declaration* variable) { return is_here(variable->name); });
}

void warn_of_declared(const Tree& tree, Diagnostics& out) {
    std::map<std::string, std::vector<const Pou*>> libraries;
    NameSet used;
    for (const Pou* unit : tree.units) {
        if (!is_declared(unit->name) || !is_empty(*unit)) continue;
        if (used.empty()) used = used_names(tree);
        if (used.contains(unit->name.text)) libraries[library_of(unit->name)].push_back(unit);
    }
    for (const auto& [library, units] : libraries) {
        std::vector<std::string_view> names;
        for (const Pou* unit : units) names.push_back(unit->name.text);
        out.warn(code::not_supported, units.front()->name.place.mark(),
                 fmt::format("of the library '{}' there are declarations alone, so this does "
                             "nothing: {}",
                             library, fmt::join(names, ", ")),
                 "write what the program needs of it in Structured Text, without the declaration");
    }
}

}  // namespace lineshaft::st
