#include "runtime/st/library/library_index.hpp"

#include <algorithm>
#include <map>
#include <mutex>

#include <fmt/format.h>

#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

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

/// TcUnit has such names, too, and is known by its others: these are variables of many programs.
bool is_everyday(std::string_view name) {
    return name == "RUN" || name == "TEST";
}

bool is_helper(std::string_view name) {
    return name.front() >= 'a' && name.front() <= 'z';
}

/// Kinds, their parts, and the values of these: `axis.Status` is not looked for alone.
NameSet names_of(const Catalog& catalog) {
    NameSet names;
    for (const BlockType& type : catalog.types()) {
        names.insert({type.name, type.handle});
        for (const Field& field : type.fields) {
            names.insert(field.name);
            names.insert(field.names.begin(), field.names.end());
        }
    }
    return names;
}

struct DeclaredName {
    std::string_view name;
    bool is_value;  ///< of an enumeration
};

/// By the lines that they stand in.
std::vector<DeclaredName> names_in(const LibraryFile& file) {
    std::vector<DeclaredName> names;
    bool in_values = false, in_globals = false;
    for (std::string_view rest = file.text; !rest.empty();) {
        std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
        const bool is_inside = line.starts_with("    ") && !line.starts_with("     ");
        const bool ends = line.starts_with(")") || line.starts_with("END_");
        if (ends) in_values = in_globals = false;
        if ((in_values || in_globals) && is_inside && is_of_name(line[4]))
            names.push_back({first_word(line), in_values});
        if (line.empty() || is_inside || ends || !is_of_name(line[0])) continue;
        const std::string_view kind = first_word(line);
        in_globals = in_globals || kind == "VAR_GLOBAL";
        const bool is_type = kind == "TYPE";
        if (!is_type && kind != "FUNCTION" && kind != "FUNCTION_BLOCK" && kind != "CLASS" &&
            kind != "INTERFACE")
            continue;
        std::string_view name = first_word(line);
        while (is_modifier(name)) name = first_word(line);
        const bool is_part = line.starts_with('.');  // of "AXIS_REF.fSetPosition"
        if (is_part) name = first_word(line);
        if (kind != "FUNCTION" || is_part || !is_helper(name)) names.push_back({name, false});
        in_values = is_type && line.ends_with("(");
    }
    return names;
}

LibraryIndex make_index(const Catalog& catalog) {
    LibraryIndex index;
    index.of_catalog = names_of(catalog);
    for (const LibraryFile& file : catalog.libraries()) {
        index.libraries[file.library].push_back(&file);
        index.firsts.insert(file.library.substr(0, file.library.find('.')));
        std::string_view enumeration;
        for (const auto& [name, is_value] : names_in(file)) {
            if (is_value) {
                LibraryIndex::Value& value = index.values[name];
                value.libraries.insert(file.library);
                value.enumerations.insert(enumeration);
            } else {
                enumeration = name;
            }
            const std::string& full =
                index.full_names.emplace_back(fmt::format("{}.{}", file.library, name));
            index.by_full_name.emplace(full, &file);
            if (file.library == siemens_motion || file.library == siemens_step7)
                index.of_siemens.emplace(name, &file);
            if (is_open(file) && !is_everyday(name)) index.by_name[name].push_back(&file);
        }
    }
    return index;
}

/// A block, or a structure, with its parts.
std::string_view block_in(const LibraryFile& file, std::string_view name) {
    const auto unit_in = [&](const std::string& head, std::string_view end) {
        const std::size_t begin = file.text.find(head);
        const std::string_view unit = file.text.substr(std::min(begin, file.text.size()));
        return unit.substr(0, unit.find(end));
    };
    const auto block = unit_in(fmt::format("FUNCTION_BLOCK {}\n", name), "END_FUNCTION_BLOCK");
    return block.empty() ? unit_in(fmt::format("TYPE {} : STRUCT\n", name), "END_STRUCT") : block;
}

}  // namespace

const LibraryIndex& index_of(const Catalog& catalog) {
    static std::mutex mutex;
    static std::map<const LibraryFile*, LibraryIndex> made;
    const std::lock_guard lock(mutex);
    const LibraryFile* files = catalog.libraries().data();
    const auto it = made.find(files);
    return it != made.end() ? it->second : made.emplace(files, make_index(catalog)).first->second;
}

std::vector<std::string_view> declared_in(const LibraryFile& file) {
    std::vector<std::string_view> names;
    for (const DeclaredName& declared : names_in(file)) names.push_back(declared.name);
    return names;
}

NameSet words_of(const LibraryFile& file, std::string_view name) {
    NameSet words;
    std::string_view unit = block_in(file, name);
    for (std::string_view word = first_word(unit); !word.empty(); word = first_word(unit))
        words.insert(word);
    return words;
}

}  // namespace lineshaft::st
