#include "runtime/st/library/test_sources.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include <fmt/format.h>

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

/// Characters of the folders that both paths begin with; a file is nearest to itself.
std::size_t nearness(const std::string& a, const std::string& b) {
    if (a == b) return a.size();
    const auto [end, other] = std::ranges::mismatch(a, b);
    const auto same = static_cast<std::size_t>(end - a.begin());
    const std::size_t slash = a.substr(0, same).rfind('/');
    return slash == std::string::npos ? 0 : slash + 1;
}

/// Adds `b.T` and `T` of `a.b.T`, too, each with the whole.
void add_declared(std::multimap<std::string, std::string>& to, std::string_view space,
                  std::string_view name) {
    const std::string full =
        lower(space.empty() ? std::string(name) : fmt::format("{}.{}", space, name));
    for (std::size_t at = 0;; at = full.find('.', at) + 1) {
        to.emplace(full.substr(at), full);
        if (full.find('.', at) == full.npos) return;
    }
}

/// `a.b.c` of a source, where all are names and `a` is none of its variables.
void add_used(std::set<std::string>& to, const std::set<std::string>& own,
              const Expression& member) {
    const Expression* root = &member;
    while (root->kind == Expression::Kind::member) root = root->operands[0];
    if (root->kind != Expression::Kind::name || root->token.local) return;
    if (own.contains(lower(root->token.text))) return;
    std::string text;
    for (const char c : root->place.to(member.place).text())
        if (c != ' ' && c != '\n' && c != '\r' && c != '\t') text += c;
    to.insert(lower(text));
}

/// A namespace with those around it, and what is used in it, from each of these on.
void add_spaces(std::set<std::string>& to, const Scope& scope) {
    std::set<std::string> around{""};
    const std::string path = lower(std::string(scope.path));
    for (std::size_t at = path.find('.'); at != path.npos; at = path.find('.', at + 1))
        around.insert(path.substr(0, at) + '.');
    if (!path.empty()) around.insert(path + '.');
    for (const std::string& start : around)
        for (const Token& used : scope.usings) to.insert(start + lower(used.text) + '.');
    to.merge(around);
}

/// `stack` of `Stack<10>`
std::string without_values(std::string_view name) {
    return lower(name.substr(0, name.find('<')));
}

/// One is B&R's `.fun`, and the other may have bodies of what it declares.
bool are_halves(const std::string& a, const std::string& b) {
    if (has_no_bodies(a) == has_no_bodies(b)) return false;
    const std::string& declares = has_no_bodies(a) ? a : b;
    return nearness(a, b) == declares.find_last_of('/') + 1;
}

auto is_in(const std::set<std::string>& names) {
    return [&](const std::string& name) { return names.contains(name); };
}

std::string_view space_at(const Tree& tree, Place place) {
    std::string_view path;
    const auto scopes = tree.scopes.find(place.source);
    if (scopes != tree.scopes.end())
        for (const Scope& scope : scopes->second)
            if (scope.begin <= place.begin && place.begin < scope.end) path = scope.path;
    return path;
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
    for (const auto& [source, scopes] : tree.scopes)
        for (const Scope& scope : scopes) {
            add_spaces(entry.spaces, scope);
            entry.own_spaces.insert(lower(scope.path));
            if (file->excerpts.empty()) continue;
            for (const Token& used : scope.usings) entry.usings.insert(lower(used.text));
        }
    const auto declare = [&](const Token& name) {
        add_declared(entry.types, space_at(tree, name.place), name.text);
    };
    for (const Pou* unit : tree.units) declare(unit->name);
    for (const GenericBlock& block : tree.generics) declare(block.pou->name);
    for (const TypeDeclaration& type : tree.types) declare(type.name);
    for (const Pou& pou : tree.pous)
        for (const auto& names : {pou.bases, pou.implemented})
            for (const Token& name : names) entry.used_types.insert(without_values(name.text));
    for (const TypeText& type : tree.type_texts) {
        for (const Token& name : {type.name, type.base})
            if (!name.text.empty()) entry.used_types.insert(without_values(name.text));
        if (type.kind != TypeText::Kind::enumeration || type.is_qualified_only) continue;
        for (const Argument& value : type.values) entry.values.insert(lower(value.name.text));
    }
    for (const Declaration& variable : tree.declarations)
        entry.own.insert(lower(variable.name.text));
    for (const DeclarationBlock& block : tree.globals)
        for (const Declaration* variable : block.declarations) {
            if (block.section == Section::external) {
                entry.own.erase(lower(variable->name.text));
                entry.used.insert(lower(variable->name.text));
                continue;
            }
            const std::string name = lower(fmt::format("{}.{}", block.list, variable->name.text));
            entry.types.emplace(name, name);
            if (const auto point = block.list.find('.'); point != block.list.npos)
                entry.types.emplace(name.substr(point + 1), name);
            if (block.section == Section::global && !block.is_qualified_only)
                entry.values.insert(lower(variable->name.text));
        }
    for (const Expression& e : tree.expressions) {
        if (e.kind == Expression::Kind::member) add_used(entry.used, entry.own, e);
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
    note(entries_.size() - 1);
}

void SourcePool::note(std::size_t entry) {
    const auto note_in = [&](auto& index, const std::string& name) {
        std::vector<std::size_t>& declaring = index[name];
        if (declaring.empty() || declaring.back() != entry) declaring.push_back(entry);
    };
    for (const auto& [name, full] : entries_[entry].types) note_in(with_type_, name);
    for (const std::string& name : entries_[entry].values) note_in(with_value_, name);
}

void SourcePool::leave_out(const std::function<bool(const Entry&)>& is_left) {
    if (std::erase_if(entries_, is_left) == 0) return;
    with_type_.clear();
    with_value_.clear();
    for (std::size_t i = 0; i < entries_.size(); ++i) note(i);
}

void SourcePool::replace(const std::shared_ptr<const SourceFile>& file) {
    leave_out([&](const Entry& entry) { return entry.file->is_same_text(*file); });
    add(file);
}

void SourcePool::leave_out_tcunit() {
    std::set<std::filesystem::path> folders;
    for (const Entry& entry : entries_) {
        if (!entry.types.contains("fb_testsuite")) continue;
        const auto within = std::filesystem::absolute(entry.file->path);
        for (auto folder = within.parent_path(); folder != folder.root_path();
             folder = folder.parent_path())
            if (std::filesystem::exists(folder / "TcUnit.plcproj")) folders.insert(folder);
    }
    leave_out([&](const Entry& entry) {
        const auto path = std::filesystem::absolute(entry.file->path);
        return std::ranges::any_of(folders, [&](const std::filesystem::path& folder) {
            return std::ranges::mismatch(folder, path).in1 == folder.end();
        });
    });
}

std::vector<const SourcePool::Entry*> SourcePool::nearest(const std::string& name,
                                                          const Entry& user,
                                                          const std::string& to) const {
    std::map<std::string, const Entry*> found;  // by what declares it in full
    const auto add = [&](const std::string& full, const Entry& entry) {
        const Entry*& known = found[full];
        if (!known || nearness(entry.file->path, to) > nearness(known->file->path, to))
            known = &entry;
    };
    // In a project of another tool `Planner.Otg` is Otg, where Planner is another project.
    const std::size_t point = user.file->excerpts.empty() ? name.npos : name.find('.');
    const std::string plain = point == name.npos ? name : name.substr(point + 1);
    std::set<std::size_t> declaring;
    for (const std::string& called : {name, plain})
        if (const auto it = with_type_.find(called); it != with_type_.end())
            declaring.insert(it->second.begin(), it->second.end());
    for (const std::size_t place : declaring) {
        const Entry& entry = entries_[place];
        const auto bare = point == name.npos ? entry.types.end() : entry.types.find(plain);
        if (bare != entry.types.end() && bare->first == bare->second) add(bare->second, entry);
        const auto [first, last] = entry.types.equal_range(name);
        for (auto it = first; it != last; ++it) {
            const std::string space = it->second.substr(0, it->second.size() - name.size());
            const bool is_of_project = !entry.file->excerpts.empty();
            if (space.empty() || is_of_project || user.spaces.contains(space))
                add(it->second, entry);
        }
    }
    std::vector<const Entry*> entries;
    for (const auto& [full, entry] : found) entries.push_back(entry);
    return entries;
}

/// The nearest that has a value of that name; null: none has.
const SourcePool::Entry* SourcePool::nearest_value(const std::string& name,
                                                   const std::string& to) const {
    const Entry* found = nullptr;
    const auto declaring = with_value_.find(name);
    if (declaring == with_value_.end()) return nullptr;
    for (const std::size_t place : declaring->second) {
        const Entry& entry = entries_[place];
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
    follow(chosen, tests->path);
    return files_of(chosen);
}

std::vector<std::shared_ptr<const SourceFile>> SourcePool::needed_by(
    const std::vector<std::string>& names) const {
    Entry user;
    user.file = std::make_shared<const SourceFile>();
    for (const std::string& name : names) user.used.insert(lower(name));
    std::vector<const Entry*> chosen{&user};
    follow(chosen, "");
    return files_of(chosen);
}

/// Whatever declares a name that one of the chosen uses, and none declares, and all of a namespace
/// that a project's source says it uses. A value may be called as a type is, that of its own as
/// well.
void SourcePool::follow(std::vector<const Entry*>& chosen, const std::string& to) const {
    const auto has_type = [&](const std::string& name) {
        return std::ranges::any_of(chosen, [&](const Entry* e) { return e->types.contains(name); });
    };
    const auto has_value = [&](const std::string& name) {
        return std::ranges::any_of(chosen,
                                   [&](const Entry* e) { return e->values.contains(name); });
    };
    const auto add = [&](const Entry* found) {
        if (std::ranges::find(chosen, found) == chosen.end()) chosen.push_back(found);
    };
    const auto add_halves = [&](const std::string& name) {
        const auto declaring = with_type_.find(name);
        if (declaring == with_type_.end()) return;
        for (const std::size_t place : declaring->second) {
            const Entry& half = entries_[place];
            const auto is_its = [&](const Entry* e) {
                return e->types.contains(name) && are_halves(e->file->path, half.file->path);
            };
            if (std::ranges::any_of(chosen, is_its)) add(&half);
        }
    };
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const Entry& user = *chosen[i];
        const auto add_types = [&](const std::string& name) {
            if (!has_type(name)) std::ranges::for_each(nearest(name, user, to), add);
            add_halves(name);
        };
        if (!has_no_bodies(user.file->path))
            for (const auto& [name, full] : user.types) add_halves(name);
        for (const Entry& entry : entries_)
            if (std::ranges::any_of(user.usings, is_in(entry.own_spaces))) add(&entry);
        std::ranges::for_each(user.used_types, add_types);
        for (const std::string& name : user.used) {
            const Entry* value =
                has_value(name) || user.own.contains(name) || user.types.contains(name)
                    ? nullptr
                    : nearest_value(name, to);
            if (!has_value(name)) add_types(name);
            if (value) add(value);
        }
    }
}

/// Leaves out the first, which is who asks.
std::vector<std::shared_ptr<const SourceFile>> SourcePool::files_of(
    const std::vector<const Entry*>& chosen) {
    std::vector<std::shared_ptr<const SourceFile>> files;
    for (std::size_t i = 1; i < chosen.size(); ++i) files.push_back(chosen[i]->file);
    return files;
}

}  // namespace lineshaft::st
