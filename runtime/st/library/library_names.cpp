#include "runtime/st/library/library_names.hpp"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "runtime/st/library/binary_libraries.hpp"
#include "runtime/st/prelude/standard_source.hpp"
#include "runtime/st/syntax/parser.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

/// Whole numbers, but LREALs in TwinCAT's library.
bool is_of_twincat_alone(std::string_view name) {
    return same_name(name, "floor") || same_name(name, "ceil");
}

/// PLCopen's enumerations of the catalogue's pins, which others have with values of other names.
constexpr std::string_view plcopen_enumerations = "PLCopenMC";

/// B&R's of axes.
bool is_of_mapp(std::string_view library) {
    return library.starts_with("Mc") || library.starts_with("Mp");
}

/// SoftMotion's axis in a source of CODESYS.
bool is_of_softmotion(const Declaration& declared) {
    if (!declared.type || !declared.type->name.place.source) return false;
    const Token& type = declared.type->name;
    const Libraries theirs = type.place.dialect().libraries;
    return (theirs == Libraries::codesys || theirs == Libraries::twincat) &&
           same_name(type.text, "AXIS_REF_SM3");
}

/// Names that users declare so that all see them.
NameSet declared_names(const Tree& tree) {
    NameSet names;
    for (const TypeDeclaration& type : tree.types) names.insert(type.name.text);
    for (const Pou* unit : tree.units)  // `"S_PULSE"` of SCL is not S_PULSE
        if (!is_users_name(unit->name)) names.insert(unit->name.text);
    for (const auto& [name, is_name] : tree.lost) names.insert(name);
    for (const TypeText& type : tree.type_texts)
        if (type.kind == TypeText::Kind::enumeration && !type.is_qualified_only)
            for (const Argument& value : type.values) names.insert(value.name.text);
    for (const DeclarationBlock& block : tree.globals)
        for (const Declaration* variable : block.declarations)
            if (block.section == Section::global && !block.is_qualified_only)
                names.insert(variable->name.text);
    return names;
}

NameSet declared_namespaces(const Tree& tree) {
    NameSet paths;
    for (const auto& [source, scopes] : tree.scopes)
        for (const Scope& scope : scopes) paths.insert(scope.path);
    return paths;
}

}  // namespace

LibraryNames::LibraryNames(const Catalog& catalog, const std::vector<LibraryReference>& references,
                           bool misses_some)
    : catalog_(catalog), index_(index_of(catalog)), misses_some_(misses_some) {
    for (const LibraryReference& reference : references) references_.insert(reference.name);
}

void LibraryNames::note_libraries(const Tokens& tokens) {
    if (catalog_.libraries().empty()) return;
    for (std::size_t i = 0; i < tokens.tokens.size(); ++i) {
        const Token& token = tokens.tokens[i];
        const bool is_name = token.word == Word::name && !token.quoted && !token.local;
        if (is_name && index_.firsts.contains(token.text)) note_qualified(tokens, i);
    }
}

void LibraryNames::note(const Token& name) {
    const bool is_plain = !name.quoted && !name.local && name.place.source;
    if (!is_plain) return;
    const Libraries theirs = name.place.dialect().libraries;
    if (theirs == Libraries::siemens || reading_ == siemens_motion) {
        const auto own = index_.of_siemens.find(name.text);
        if (own != index_.of_siemens.end()) of_siemens_.insert(own->first);
        return;
    }
    const auto it = index_.by_name.find(name.text);
    const bool is_twincat = theirs == Libraries::twincat;
    if (it == index_.by_name.end() || (is_of_twincat_alone(it->first) && !is_twincat)) return;
    const bool is_plcopens = it->second.front()->library == plcopen_enumerations;
    const bool may_be_plcopens = reading_.empty() && !name.place.dialect().is_loose;
    if (is_plcopens && it->second.size() == 1 && !may_be_plcopens) return;
    const auto own = std::ranges::find(it->second, reading_, &LibraryFile::library);
    if (own != it->second.end()) return take(**own);
    names_.insert(it->first);
    if (!reading_.empty()) of_libraries_.insert(it->first);
    if (is_twincat) of_twincat_.insert(it->first);
    if (theirs == Libraries::matiec) of_matiec_.insert(it->first);
    const bool in_studio = theirs == Libraries::automation_studio;
    if (in_studio || is_of_mapp(reading_)) of_mapp_.insert(it->first);
    if (in_studio) of_studio_.insert(it->first);
}

/// A block of the catalogue that another one extends.
void LibraryNames::note_extended(const Token& name) {
    if (!name.place.source || !name.place.dialect().is_loose) return;
    const auto it =
        index_.by_full_name.find(fmt::format("{}{}", extended_blocks, without_library(name.text)));
    if (it != index_.by_full_name.end()) said_.insert(it->first);
}

void LibraryNames::note_names(const Tree& tree) {
    using E = Expression::Kind;
    std::optional<NameSet> variables;
    const auto is_variable = [&](std::string_view name) {
        if (!index_.by_name.contains(name)) return false;
        if (!variables) {
            variables.emplace();
            for (std::size_t i = declarations_; i < tree.declarations.size(); ++i)
                if (const Token& own = tree.declarations[i].name; !is_of_binary_library(own))
                    variables->insert(own.text);
        }
        return variables->contains(name);
    };
    for (; types_ < tree.type_texts.size(); ++types_) note(tree.type_texts[types_].name);
    for (; pous_ < tree.pous.size(); ++pous_)
        for (const auto list : {&Pou::bases, &Pou::implemented})
            for (const Token& name : tree.pous[pous_].*list) note(name), note_extended(name);
    for (; expressions_ < tree.expressions.size(); ++expressions_) {
        const Expression& e = tree.expressions[expressions_];
        const bool may_be = e.kind == E::name || (e.kind == E::member && !reading_.empty());
        const bool is_free = may_be && !is_variable(e.token.text);
        const bool is_member = e.kind == E::member && reading_.empty();
        if (is_free || is_member || e.kind == E::typed) note(e.token);
    }
    for (; declarations_ < tree.declarations.size(); ++declarations_)
        if (is_of_softmotion(tree.declarations[declarations_]))
            taken_libraries_.insert("SM3_Basic");
}

void LibraryNames::note_qualified(const Tokens& tokens, std::size_t at) {
    const bool is_used = at > 0 && tokens.tokens[at - 1].word == Word::using_;
    std::string path(tokens.tokens[at].text);
    for (;;) {
        const bool goes_on = tokens.tokens[at + 1].word == Word::dot;
        const std::string_view library = library_called(path);
        if (const auto it = index_.libraries.find(library); it != index_.libraries.end()) {
            if (is_used || (goes_on && !is_open(*it->second.front()))) said_.insert(it->first);
        }
        if (!goes_on || tokens.tokens[at + 2].word == Word::end_of_file) return;
        at += 2;
        path += fmt::format(".{}", tokens.tokens[at].text);
        if (const auto it = index_.by_full_name.find(path); it != index_.by_full_name.end())
            said_.insert(it->first);
    }
}

/// That libraries have, as they write it; empty: none.
std::string_view LibraryNames::block_of(const Declaration& declared) const {
    if (!declared.type) return {};
    const Token& name = declared.type->name;
    const bool is_of_siemens =
        name.place.source && name.place.dialect().libraries == Libraries::siemens;
    if (is_of_siemens) {
        const auto it = index_.of_siemens.find(name.text);
        return it == index_.of_siemens.end() ? std::string_view() : it->first;
    }
    const auto it = index_.by_name.find(name.text);
    return it == index_.by_name.end() ? std::string_view() : it->first;
}

void LibraryNames::note_pin(std::string_view block, const Argument& argument) {
    pins_[block].insert(argument.name.text);
    if (argument.value && argument.value->kind == Expression::Kind::name)
        given_.insert(argument.value->token.text);
}

void LibraryNames::note_pins(const Tree& tree) {
    NameMap<std::string_view> instances;
    for (const Declaration& declared : tree.declarations) {
        const std::string_view block = block_of(declared);
        if (block.empty()) continue;
        instances.emplace(declared.name.text, block);
        if (!declared.initial) continue;
        for (const Argument& argument : declared.initial->arguments)
            if (argument.is_named()) note_pin(block, argument);
    }
    if (instances.empty()) return;
    for (const Expression& e : tree.expressions) {
        const bool is_part = e.kind == Expression::Kind::call || e.kind == Expression::Kind::member;
        const auto it =
            is_part && e.operands[0] ? instances.find(e.operands[0]->token.text) : instances.end();
        if (it == instances.end()) continue;
        NameSet& pins = pins_[it->second];
        if (e.kind == Expression::Kind::member) pins.insert(e.token.text);
        for (const Argument& argument : e.arguments)
            if (argument.is_named()) note_pin(it->second, argument);
    }
}

/// How many it has of those that the sources name; empty where they name none, or it is no block.
std::optional<std::size_t> LibraryNames::pins_of(const LibraryFile& file,
                                                 std::string_view name) const {
    const NameSet* named = find_in(pins_, name);
    const NameSet words = named ? words_of(file, name) : NameSet();
    if (!named || named->empty() || words.empty()) return {};
    return std::ranges::count_if(*named, [&](auto pin) { return words.contains(pin); });
}

/// The sources name more that a block has not than it has.
bool LibraryNames::is_another(const LibraryFile& file, std::string_view name) const {
    const auto own = pins_of(file, name);
    return own && 2 * *own < find_in(pins_, name)->size();
}

std::size_t LibraryNames::pins_of_catalog(std::string_view name) const {
    const BlockType* type = catalog_.find(name);
    const NameSet* named = find_in(pins_, name);
    if (!type || !named) return 0;
    const auto is_its = [&](std::string_view pin) {
        return std::ranges::any_of(type->fields, [&](const Field& field) {
            return same_name(field.name, pin) || same_name(field.name, standard_part_name(pin));
        });
    };
    return static_cast<std::size_t>(std::ranges::count_if(*named, is_its));
}

/// Sources of no vendor's dialect name values that are PLCopen's alone.
bool LibraryNames::names_values_of_plcopen() const {
    return std::ranges::any_of(names_, [&](std::string_view name) {
        const auto& files = index_.by_name.at(name);
        return files.size() == 1 && files.front()->library == plcopen_enumerations;
    });
}

/// A value of an enumeration whose library the sources have not asked for.
bool LibraryNames::is_hidden(const LibraryFile& file, std::string_view name) const {
    const LibraryIndex::Value* value = find_in(index_.values, name);
    if (!value || !value->libraries.contains(file.library)) return false;
    const auto is_named = [&](std::string_view enumeration) {
        const auto it = index_.by_name.find(enumeration);
        return it != index_.by_name.end() && names_.contains(it->first);
    };
    if (std::ranges::any_of(value->enumerations, is_named)) return false;
    const bool is_of_twincat = file.library.starts_with("Tc");
    const bool is_foreign = is_of_twincat || file.library.starts_with("SM3_");
    const bool is_with_all =
        references_.empty() ? file.library.starts_with("Tc2_") : file.library == "Tc2_System";
    return !references_.contains(file.library) && !taken_libraries_.contains(file.library) &&
           !of_libraries_.contains(name) && !given_.contains(name) &&
           !(of_twincat_.contains(name) && is_with_all) &&
           !(of_studio_.contains(name) && !is_foreign);
}

const LibraryFile* LibraryNames::choose(std::string_view name) const {
    std::vector<const LibraryFile*> files = index_.by_name.at(name);
    const bool in_twincat = of_twincat_.contains(name);
    const bool are_plcopens = names_values_of_plcopen() && !taken_libraries_.contains("SM3_Basic");
    std::erase_if(files, [&](const LibraryFile* file) {
        const bool is_softmotion = file->library.starts_with("SM3_");
        if (file->library == plcopen_enumerations)
            return pins_of(*file, name) == 0 || !are_plcopens;
        return pins_of(*file, name) == 0 || (is_softmotion && in_twincat) || is_hidden(*file, name);
    });
    const auto plcopens = std::ranges::find(files, plcopen_enumerations, &LibraryFile::library);
    if (plcopens != files.end() && index_.by_name.at(name).size() > 1) return *plcopens;
    const auto is_referred_to = [&](const LibraryFile* f) {
        return references_.contains(f->library);
    };
    if (std::ranges::any_of(files, is_referred_to))
        std::erase_if(files, std::not_fn(is_referred_to));
    else if (misses_some_)
        std::erase_if(files, [&](const LibraryFile* file) { return is_another(*file, name); });
    if (files.empty()) return nullptr;
    const auto pins = [&](const LibraryFile* file) { return pins_of(*file, name).value_or(0); };
    const std::size_t most = pins(*std::ranges::max_element(files, {}, pins));
    std::erase_if(files, [&](const LibraryFile* file) { return pins(file) < most; });
    const bool is_catalogs = index_.of_catalog.contains(name) && most <= pins_of_catalog(name);
    const auto is_of_twincat = [](const LibraryFile* f) { return f->library.starts_with("Tc2_"); };
    if (in_twincat && std::ranges::any_of(files, is_of_twincat))
        std::erase_if(files, std::not_fn(is_of_twincat));
    const auto is_of_matiec = [&](const LibraryFile* f) {
        return (f->library == "Beremiz") == of_matiec_.contains(name);
    };
    if (std::ranges::any_of(files, is_of_matiec)) std::erase_if(files, std::not_fn(is_of_matiec));
    const bool in_mapp = of_mapp_.contains(name);
    const auto fits_mapp = [&](const LibraryFile* f) { return is_of_mapp(f->library) == in_mapp; };
    if (std::ranges::any_of(files, fits_mapp)) std::erase_if(files, std::not_fn(fits_mapp));
    for (const LibraryFile* file : files)
        if (taken_libraries_.contains(file->library)) return file;
    if (in_twincat && is_of_twincat(files.front())) return files.front();
    if (in_mapp && is_of_mapp(files.front()->library)) return files.front();
    return is_catalogs ? nullptr : files.front();
}

void LibraryNames::take(const LibraryFile& file) {
    if (own_.contains(file.library)) return;
    taken_.insert(&file);
    taken_libraries_.insert(file.library);
}

void LibraryNames::take_said() {
    for (const std::string_view said : said_) {
        if (const auto it = index_.libraries.find(said); it != index_.libraries.end())
            for (const LibraryFile* file : it->second) take(*file);
        const auto it = index_.by_full_name.find(said);
        if (it != index_.by_full_name.end()) take(*it->second);
    }
    said_.clear();
}

void LibraryNames::take_named() {
    for (const bool has_one : {true, false})
        for (const std::string_view name : names_)
            if ((index_.by_name.at(name).size() == 1) == has_one)
                if (const LibraryFile* file = choose(name)) take(*file);
    for (const std::string_view name : of_siemens_) {
        const LibraryFile& file = *index_.of_siemens.at(name);
        const auto named = pins_of(file, name);
        if (!named || *named >= pins_of_catalog(name)) take(file);
    }
}

void LibraryNames::read(const LibraryFile& file, Tree& tree, Diagnostics& out) {
    Tokens tokens = read_tokens(std::make_shared<const SourceFile>(
                                    SourceFile{std::string(file.path), std::string(file.text)}),
                                out, SourceKind::library);
    uses_standard_source_ = uses_standard_source_ || st::uses_standard_source(tokens);
    note_libraries(tokens);
    parse(std::move(tokens), tree, out);
    reading_ = file.library;
    note_names(tree);
    reading_ = {};
}

void LibraryNames::add_files(Tree& tree, Diagnostics& out) {
    if (catalog_.libraries().empty()) return;
    note_names(tree);
    if (names_.empty() && said_.empty() && of_siemens_.empty()) return;
    note_pins(tree);
    own_ = declared_namespaces(tree);
    const NameSet declared = declared_names(tree);
    for (auto* names : {&names_, &of_siemens_})
        std::erase_if(*names, [&](std::string_view name) { return declared.contains(name); });
    std::set<const LibraryFile*> is_read;
    for (std::optional<std::size_t> before; before != taken_.size() + taken_libraries_.size();) {
        before = taken_.size() + taken_libraries_.size();
        take_said();
        take_named();
        for (const LibraryFile& file : catalog_.libraries())
            if (taken_.contains(&file) && is_read.insert(&file).second) read(file, tree, out);
    }
}

}  // namespace lineshaft::st
