#include "runtime/st/library/test_sources.hpp"

#include <algorithm>
#include <filesystem>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/cursor.hpp"
#include "runtime/st/syntax/parser.hpp"

namespace lineshaft::st {

namespace {

/// `x` of `test_x.st`, `x_test.st`, `x.test.st`.
std::string tested_by(const std::string& path) {
    std::string stem = lower(std::filesystem::path(path).stem().string());
    for (const std::string_view before : {"test_", "tests_"})
        if (stem.starts_with(before)) return stem.substr(before.size());
    for (const std::string_view behind : {"_test", "_tests", ".test"})
        if (stem.ends_with(behind)) return stem.substr(0, stem.size() - behind.size());
    return {};
}

/// Characters of the folders that both paths begin with.
std::size_t nearness(const std::string& a, const std::string& b) {
    const auto [end, other] = std::ranges::mismatch(a, b);
    const auto same = static_cast<std::size_t>(end - a.begin());
    const std::size_t slash = a.substr(0, same).rfind('/');
    return slash == std::string::npos ? 0 : slash + 1;
}

}  // namespace

bool is_test_file(const std::shared_ptr<const SourceFile>& file) {
    Diagnostics unread;
    Cursor cursor{read_tokens(file, unread, SourceKind::tests)};
    while (!cursor.is(Word::end_of_file) && !(cursor.is(Word::test_) && cursor.at_test()))
        cursor.take();
    return !cursor.is(Word::end_of_file);
}

SourcePool::Entry SourcePool::entry_of(const std::shared_ptr<const SourceFile>& file) {
    Entry entry;
    entry.file = file;
    Diagnostics unread;
    Tree tree;
    parse(read_tokens(entry.file, unread, SourceKind::tests), tree, unread);
    for (const Pou* unit : tree.units) entry.types.insert(lower(unit->name.text));
    for (const TypeDeclaration& type : tree.types) entry.types.insert(lower(type.name.text));
    for (const TypeText& type : tree.type_texts)
        if (type.kind == TypeText::Kind::enumeration)
            for (const Argument& value : type.values) entry.values.insert(lower(value.name.text));
    for (const TypeText& type : tree.type_texts)
        if (!type.name.text.empty()) entry.used.insert(lower(type.name.text));
    for (const Declaration& variable : tree.declarations)
        entry.own.insert(lower(variable.name.text));
    for (const DeclarationBlock& block : tree.globals)
        for (const Declaration* variable : block.declarations)
            entry.values.insert(lower(variable->name.text));
    for (const Expression& e : tree.expressions) {
        const bool is_name = e.kind == Expression::Kind::name || e.kind == Expression::Kind::typed;
        const std::string name = lower(e.token.text);
        if (is_name && !e.token.local && !entry.own.contains(name)) entry.used.insert(name);
    }
    return entry;
}

void SourcePool::add(const std::shared_ptr<const SourceFile>& file) {
    const auto is_known = [&](const Entry& entry) { return entry.file->is_same_text(*file); };
    if (std::ranges::any_of(entries_, is_known) || is_test_file(file)) return;
    entries_.push_back(entry_of(file));
}

void SourcePool::replace(const std::shared_ptr<const SourceFile>& file) {
    std::erase_if(entries_, [&](const Entry& entry) { return entry.file->is_same_text(*file); });
    add(file);
}

const SourcePool::Entry* SourcePool::nearest(const std::string& name, const Entry& user,
                                             const std::string& to) const {
    const Entry* found = nullptr;
    for (const Entry& entry : entries_) {
        const bool hidden = user.own.contains(name);
        if (!entry.types.contains(name) && (hidden || !entry.values.contains(name))) continue;
        if (!found || nearness(entry.file->path, to) > nearness(found->file->path, to))
            found = &entry;
    }
    return found;
}

std::vector<std::shared_ptr<const SourceFile>> SourcePool::needed_by(
    const std::shared_ptr<const SourceFile>& tests) const {
    const Entry test = entry_of(tests);
    const std::string subject = tested_by(tests->path);
    const auto folder = std::filesystem::path(tests->path).parent_path();
    std::vector<const Entry*> chosen{&test};
    for (const Entry& entry : entries_) {
        const std::filesystem::path path(entry.file->path);
        const bool beside = !subject.empty() && path.parent_path() == folder;
        if (beside && lower(path.stem().string()) == subject) chosen.push_back(&entry);
    }
    const auto is_declared = [&](const std::string& name) {
        return std::ranges::any_of(chosen, [&](const Entry* e) {
            return e->types.contains(name) || e->values.contains(name);
        });
    };
    for (std::size_t i = 0; i < chosen.size(); ++i)
        for (const std::string& name : chosen[i]->used)
            if (!is_declared(name))
                if (const Entry* found = nearest(name, *chosen[i], tests->path))
                    chosen.push_back(found);
    std::vector<std::shared_ptr<const SourceFile>> files;
    for (const Entry* entry : chosen)
        if (entry != &test) files.push_back(entry->file);
    return files;
}

}  // namespace lineshaft::st
