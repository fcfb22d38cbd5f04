#include "tools/lineshaft/check_apart.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "blocks/catalog.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/library/library.hpp"
#include "runtime/st/syntax/lexer.hpp"
#include "runtime/st/syntax/parser.hpp"
#include "tools/lineshaft/once.hpp"

namespace lineshaft {

namespace {

std::string path_of(const Diagnostic& diagnostic) {
    return diagnostic.mark.file ? diagnostic.mark.file->path : "";
}

/// Adds what is told of the files that `wanted` is true of.
template <class Wanted>
void add_if(Once& to, const Diagnostics& found, Wanted wanted) {
    Diagnostics kept;
    for (const Diagnostic& d : found.list())
        if (wanted(path_of(d))) kept.add(d.code, d.mark, d.message, d.help);
    for (const Diagnostic& d : found.warnings())
        if (wanted(path_of(d))) kept.warn(d.code, d.mark, d.message, d.help);
    to.add(kept);
}

std::string folder_of(const SourceFile& text) {
    return std::filesystem::path(text.path).parent_path().string();
}

/// Names in small letters.
struct Declared {
    std::set<std::string> programs, others;
};

Declared declared_in(const std::shared_ptr<const SourceFile>& text) {
    Diagnostics unread;
    st::Tree tree;
    st::parse(st::read_tokens(text, unread), tree, unread);
    Declared found;
    for (const st::Pou* unit : tree.units) {
        const bool is_program = unit->kind == st::PouKind::program;
        (is_program ? found.programs : found.others).insert(lower(unit->name.text));
    }
    for (const st::TypeDeclaration& type : tree.types) found.others.insert(lower(type.name.text));
    return found;
}

/// Files that are a program each, of those in one folder: several with a PROGRAM declare the same
/// type or block, or the same PROGRAM and nothing that others of them need.
std::set<std::string> whole_programs(const Texts& texts, const st::SourcePool& pool) {
    std::map<std::pair<std::string, std::string>, std::set<std::string>> files;
    for (const auto& text : texts) {
        if (!text->excerpts.empty()) continue;
        const Declared declared = declared_in(text);
        if (declared.programs.empty()) continue;
        for (const std::string& name : declared.others)
            files[{folder_of(*text), name}].insert(text->path);
        if (!pool.needed_by(text).empty()) continue;
        for (const std::string& name : declared.programs)
            files[{folder_of(*text), "PROGRAM " + name}].insert(text->path);
    }
    std::set<std::string> whole;
    for (auto& [name, paths] : files)
        if (paths.size() > 1) whole.merge(paths);
    return whole;
}

/// Files that a text was put together of, and its own.
std::set<std::string> files_of(const SourceFile& text) {
    std::set<std::string> files{text.path};
    for (const Excerpt& excerpt : text.excerpts)
        if (excerpt.place.file) files.insert(excerpt.place.file->path);
    return files;
}

bool is_told(const Diagnostics& found, const Diagnostic& wanted) {
    const auto is_it = [&](const Diagnostic& d) {
        return d.code == wanted.code && path_of(d) == path_of(wanted) &&
               d.mark.line == wanted.mark.line && d.mark.column == wanted.mark.column;
    };
    return std::ranges::any_of(found.list(), is_it);
}

}  // namespace

Diagnostics check_apart(const st::SourcePool& pool, const Texts& texts) {
    Texts together = texts;
    for (const auto& text : texts)
        for (const auto& needed : pool.needed_by(text))
            if (std::ranges::find(together, needed) == together.end()) together.push_back(needed);
    Diagnostics found;
    st::compile(together, standard_blocks(), found);
    return found;
}

Diagnostics without_neighbours(const Texts& texts, const Diagnostics& found) {
    const auto is_twice = [](const Diagnostic& d) { return d.code == code::declared_twice; };
    if (std::ranges::none_of(found.list(), is_twice)) return found;
    std::set<std::string> wrong;
    for (const Diagnostic& d : found.list()) wrong.insert(path_of(d));
    st::SourcePool pool, shared;
    for (const auto& text : texts) pool.add(text);
    const std::set<std::string> whole = whole_programs(texts, pool);
    std::map<std::string, Texts> programs;  // by the file that is one, or the folder
    std::set<std::string> again;
    for (const auto& text : texts) {
        if (!whole.contains(text->path)) shared.add(text);
        const bool is_file =
            whole.contains(text->path) || std::filesystem::path(text->path).extension() == ".xml";
        const std::string program = is_file ? text->path : folder_of(*text);
        programs[program].push_back(text);
        const auto is_wrong = [&](const std::string& file) { return wrong.contains(file); };
        if (std::ranges::any_of(files_of(*text), is_wrong)) again.insert(program);
    }
    Diagnostics out;
    Once once(out);
    std::set<std::string> files;
    for (const auto& [program, own] : programs) {
        if (!again.contains(program)) continue;
        std::set<std::string> paths;
        for (const auto& text : own) paths.merge(files_of(*text));
        add_if(once, check_apart(whole.contains(program) ? shared : pool, own),
               [&](const auto& path) { return paths.contains(path); });
        files.merge(paths);
    }
    add_if(once, found, [&](const std::string& path) { return !files.contains(path); });
    for (const Diagnostic& d : found.list())
        if (is_twice(d) && !is_told(out, d))
            out.warn(d.code, d.mark, d.message + ", in programs that are checked apart", d.help);
    return out;
}

}  // namespace lineshaft
