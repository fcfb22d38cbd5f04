#include "runtime/st/library/library_names.hpp"

#include <algorithm>
#include <deque>
#include <mutex>

#include <fmt/format.h>

#include "runtime/st/prelude/standard_source.hpp"
#include "runtime/st/syntax/parser.hpp"

namespace lineshaft::st {

/// Of all files.
struct LibraryNames::Index {
    NameMap<const LibraryFile*> by_name;  ///< those that are taken for a name alone
    NameMap<const LibraryFile*> by_full_name;
    NameMap<std::vector<const LibraryFile*>> libraries;
    NameSet firsts;  ///< what the libraries' names begin with, up to a point
    std::deque<std::string> full_names;
};

namespace {

constexpr std::string_view of_names =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";

bool is_of_name(char c) {
    return of_names.find(c) != of_names.npos;
}

std::string_view first_word(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_of(of_names), line.size()));
    const std::string_view word = line.substr(0, line.find_first_not_of(of_names));
    line.remove_prefix(word.size());
    return word;
}

bool is_modifier(std::string_view word) {
    return word == "ABSTRACT" || word == "FINAL" || word == "PUBLIC" || word == "INTERNAL";
}

/// Of TcUnit, which is known by its others: these are variables of many programs.
bool is_everyday(std::string_view name) {
    return name == "RUN" || name == "TEST";
}

bool is_helper(std::string_view name) {
    return name.front() >= 'a' && name.front() <= 'z';
}

LibraryNames::Index make_index(const Catalog& catalog) {
    LibraryNames::Index index;
    for (const LibraryFile& file : catalog.libraries()) {
        index.libraries[file.library].push_back(&file);
        index.firsts.insert(file.library.substr(0, file.library.find('.')));
        const bool is_open = file.library.find('.') == file.library.npos;
        for (const std::string_view name : LibraryNames::declared_in(file)) {
            const std::string& full =
                index.full_names.emplace_back(fmt::format("{}.{}", file.library, name));
            index.by_full_name.emplace(full, &file);
            const auto is_kind = [&](const BlockType& type) {
                return same_name(type.name, name) || same_name(type.handle, name);
            };
            if (is_open && !is_everyday(name) && std::ranges::none_of(catalog.types(), is_kind))
                index.by_name.emplace(name, &file);
        }
    }
    return index;
}

const LibraryNames::Index& index_of(const Catalog& catalog) {
    static std::mutex mutex;
    static std::map<const LibraryFile*, LibraryNames::Index> made;
    const std::lock_guard lock(mutex);
    const LibraryFile* files = catalog.libraries().data();
    const auto it = made.find(files);
    return it != made.end() ? it->second : made.emplace(files, make_index(catalog)).first->second;
}

/// Names that users declare so that all see them.
NameSet declared_names(const Tree& tree) {
    NameSet names;
    for (const TypeDeclaration& type : tree.types) names.insert(type.name.text);
    for (const Pou* unit : tree.units) names.insert(unit->name.text);
    for (const auto& [name, is_name] : tree.lost) names.insert(name);
    for (const TypeText& type : tree.type_texts)
        if (type.kind == TypeText::Kind::enumeration)
            for (const Argument& value : type.values) names.insert(value.name.text);
    for (const DeclarationBlock& block : tree.globals)
        for (const Declaration* variable : block.declarations) names.insert(variable->name.text);
    return names;
}

NameSet declared_namespaces(const Tree& tree) {
    NameSet paths;
    for (const auto& [source, scopes] : tree.scopes)
        for (const Scope& scope : scopes) paths.insert(scope.path);
    return paths;
}

}  // namespace

LibraryNames::LibraryNames(const Catalog& catalog) : catalog_(catalog), index_(index_of(catalog)) {}

std::vector<std::string_view> LibraryNames::declared_in(const LibraryFile& file) {
    std::vector<std::string_view> names;
    bool in_values = false, in_globals = false;
    for (std::string_view rest = file.text; !rest.empty();) {
        std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
        const bool is_inside = line.starts_with("    ") && !line.starts_with("     ");
        const bool ends = line.starts_with(")") || line.starts_with("END_");
        if (ends) in_values = in_globals = false;
        if ((in_values || in_globals) && is_inside && is_of_name(line[4]))
            names.push_back(first_word(line));
        if (line.empty() || is_inside || ends || !is_of_name(line[0])) continue;
        const std::string_view kind = first_word(line);
        in_globals = in_globals || kind == "VAR_GLOBAL";
        const bool is_type = kind == "TYPE";
        if (!is_type && kind != "FUNCTION" && kind != "FUNCTION_BLOCK" && kind != "CLASS" &&
            kind != "INTERFACE")
            continue;
        std::string_view name = first_word(line);
        while (is_modifier(name)) name = first_word(line);
        if (is_type || !is_helper(name)) names.push_back(name);
        in_values = is_type && line.ends_with("(");
    }
    return names;
}

void LibraryNames::note_names(const Tokens& tokens) {
    if (catalog_.libraries().empty()) return;
    const bool is_siemens = &tokens.source->dialect == &scl;
    for (std::size_t i = 0; i < tokens.tokens.size(); ++i) {
        const Token& token = tokens.tokens[i];
        const bool is_name = token.word == Word::name || token.word == Word::prefix;
        if (!is_name || token.quoted || token.local) continue;
        const auto it = is_siemens ? index_.by_name.end() : index_.by_name.find(token.text);
        if (it != index_.by_name.end()) names_.insert(it->first);
        if (index_.firsts.contains(token.text)) note_qualified(tokens, i);
    }
}

void LibraryNames::note_qualified(const Tokens& tokens, std::size_t at) {
    const bool is_used = at > 0 && tokens.tokens[at - 1].word == Word::using_;
    std::string path(tokens.tokens[at].text);
    for (;;) {
        const bool goes_on = tokens.tokens[at + 1].word == Word::dot;
        if (const auto it = index_.libraries.find(path); it != index_.libraries.end()) {
            const bool is_open = path.find('.') == path.npos;
            if (is_used || (goes_on && !is_open)) names_.insert(it->first);
        }
        if (!goes_on || tokens.tokens[at + 2].word == Word::end_of_file) return;
        at += 2;
        path += fmt::format(".{}", tokens.tokens[at].text);
        if (const auto it = index_.by_full_name.find(path); it != index_.by_full_name.end())
            names_.insert(it->first);
    }
}

void LibraryNames::take_named(const NameSet& declared, const NameSet& own) {
    const auto take = [&](const LibraryFile* file) {
        if (!own.contains(file->library)) taken_.insert(file);
    };
    for (const std::string_view name : names_) {
        if (const auto it = index_.libraries.find(name); it != index_.libraries.end())
            std::ranges::for_each(it->second, take);
        if (const auto it = index_.by_full_name.find(name); it != index_.by_full_name.end())
            take(it->second);
        const auto it = index_.by_name.find(name);
        if (it != index_.by_name.end() && !declared.contains(name)) take(it->second);
    }
    names_.clear();
}

void LibraryNames::add_files(Tree& tree, Diagnostics& out) {
    if (names_.empty()) return;
    const NameSet own = declared_namespaces(tree);
    take_named(declared_names(tree), own);
    std::set<const LibraryFile*> read;
    while (read.size() < taken_.size()) {
        const LibraryFile* file =
            *std::ranges::find_if(taken_, [&](const auto* f) { return read.insert(f).second; });
        Tokens tokens = read_tokens(std::make_shared<const SourceFile>(SourceFile{
                                        std::string(file->path), std::string(file->text)}),
                                    out, SourceKind::library);
        uses_standard_source_ = uses_standard_source_ || st::uses_standard_source(tokens);
        note_names(tokens);
        parse(std::move(tokens), tree, out);
        take_named({}, own);
    }
}

}  // namespace lineshaft::st
