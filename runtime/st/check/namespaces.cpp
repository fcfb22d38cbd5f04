#include "runtime/st/check/namespaces.hpp"

#include <limits>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/syntax/list_properties.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

std::string_view before_last_point(std::string_view name) {
    const std::size_t point = name.rfind('.');
    return point == name.npos ? std::string_view() : name.substr(0, point);
}

bool is_namespace(const Checking& c, std::string_view path) {
    const bool* is_known = find_in(c.namespaces, path);
    return is_known && *is_known;
}

/// The path of the namespace that `name` means there; empty: none.
std::string find_namespace(const Checking& c, Place place, std::string_view name) {
    if (const Prefixes* here = c.prefixes_at(place))
        for (const std::string_view path : here->paths)
            if (std::string inner = fmt::format("{}.{}", path, name); is_namespace(c, inner))
                return inner;
    return is_namespace(c, name) ? std::string(name) : std::string();
}

/// One of its own libraries, which come with it, has that name.
bool is_of_ax(std::string_view path) {
    const std::string name = lower(path);
    return name.starts_with("system.") || name.starts_with("siemens.simatic.");
}

std::string namespace_meant(const Checking& c, std::string_view path) {
    std::vector<std::string> names;
    for (const auto& [known, is_there] : c.namespaces)
        if (is_there) names.emplace_back(known);
    std::ranges::sort(names);
    const std::string near = suggest(path, names);
    return near.starts_with("did you") ? near
                                       : "give the sources that declare it, too, as test does with "
                                         "--source FOLDER";
}

void refuse_namespace(Checking& c, Place place, std::string_view path) {
    if (!c.namespaces.emplace(c.checked.names.emplace_back(path), false).second) return;
    Token name;
    name.text = path;
    name.place = place;
    if (c.may_be_foreign(name)) return;
    const bool is_of_library =
        std::ranges::any_of(c.catalog.libraries(),
                            [&](const LibraryFile& file) { return same_name(file.library, path); });
    if (is_of_library)
        return (void)c.fail(code::not_declared, place,
                            fmt::format("the library '{}' is here without this", path),
                            fmt::format("declare it in your sources, without '{}.'", path));
    if (is_of_ax(path))
        return (void)c.fail(
            code::not_declared, place,
            fmt::format("the library '{}' of SIMATIC AX is not here", path),
            fmt::format("declare what you use of it in a source of yours, in NAMESPACE {}", path));
    c.fail(code::not_declared, place, fmt::format("there is no namespace '{}'", path),
           namespace_meant(c, path));
}

/// `a.b.x`; empty: there is more to it than names.
std::string joined(const Expression& e) {
    if (e.kind == E::name)
        return e.token.local ? std::string() : std::string(without_point(e.token.text));
    if (e.kind != E::member) return {};
    const std::string before = joined(*e.operands[0]);
    return before.empty() ? before : fmt::format("{}.{}", before, e.token.text);
}

/// Its first name, where that may be one of a namespace, or of a list of globals that has the name
/// of a library's variable.
const Expression* root_of(Checking& c, const Expression& member) {
    const Expression* root = &member;
    while (root->kind == E::member) root = root->operands[0];
    if (root->kind != E::name || root->token.local || root->token.quoted || root->type)
        return nullptr;
    if (is_own_instance(c, *root) || find_accessor(c, *root, Accessor::get)) return nullptr;
    const Variable* variable = find_variable(c, root->token);
    const bool is_free = !variable || (is_library(variable->name) && !is_library(root->token));
    return is_free ? root : nullptr;
}

/// Sources in SCL use them without saying so.
void open_siemens(Checking& c) {
    static const Scope whole_source = {.end = std::numeric_limits<std::uint32_t>::max()};
    Prefixes opened{&whole_source};
    for (const std::string_view library : {siemens_motion, siemens_step7})
        if (is_namespace(c, library)) opened.paths.push_back(library);
    if (opened.paths.empty()) return;
    for (const auto& source : c.tree.sources)
        if (source->dialect.libraries == Libraries::siemens)
            c.prefixes[source.get()].push_back(opened);
}

}  // namespace

void collect_namespaces(Checking& c) {
    for (const auto& source : c.tree.sources) {  // CODESYS' language has none: those of libraries
        const auto scopes = c.tree.scopes.find(source.get());
        const bool is_project =
            source->dialect.is_loose && !source->is_library() && scopes != c.tree.scopes.end();
        if (!is_project || scopes->second.front().path.empty()) continue;
        const std::string_view library = scopes->second.front().path;
        if (std::ranges::find(c.open_libraries, library) == c.open_libraries.end())
            c.open_libraries.push_back(library);
    }
    for (const LibraryFile& file : c.catalog.libraries()) {
        const bool is_taken = std::ranges::any_of(c.tree.sources, [&](const auto& source) {
            return source->is_library() && source->file->path == file.path;
        });
        const bool is_known =
            std::ranges::find(c.open_libraries, file.library) != c.open_libraries.end();
        if (is_taken && !is_known && is_open(file)) c.open_libraries.push_back(file.library);
    }
    for (const auto& [source, scopes] : c.tree.scopes)
        for (const Scope& scope : scopes)
            for (std::string_view path = scope.path; !path.empty(); path = before_last_point(path))
                c.namespaces.emplace(path, true);
    for (const auto& source : c.tree.sources) {
        const auto scopes = c.tree.scopes.find(source.get());
        if (scopes == c.tree.scopes.end()) continue;
        auto& all = c.prefixes[source.get()];
        for (const Scope& scope : scopes->second) {
            Prefixes& made = all.emplace_back(Prefixes{&scope});
            for (const Scope* s = &scope; s; s = s->outer) {
                const std::string_view outer = s->outer ? s->outer->path : std::string_view();
                for (std::string_view p = s->path; p.size() > outer.size();
                     p = before_last_point(p))
                    made.paths.push_back(p);
                for (const Token& used : s->usings) {
                    const std::string_view path = library_called(used.text);
                    const bool has_assertions = is_namespace_of_assertions(path);
                    c.has_tests |= has_assertions;
                    if (is_namespace(c, path) || has_assertions)
                        made.paths.push_back(path);
                    else
                        c.unknown_usings.push_back(used), made.is_whole = false;
                }
            }
        }
    }
    open_siemens(c);
}

Token name_with_namespace(Checking& c, Token declared) {
    const Prefixes* here = c.prefixes_at(declared.place);
    if (here && !here->scope->path.empty())
        declared.text =
            c.checked.names.emplace_back(fmt::format("{}.{}", here->scope->path, declared.text));
    return declared;
}

std::optional<Token> without_project(Checking& c, Token name) {
    const std::size_t point = name.text.find('.');
    if (point == name.text.npos || name.place.source->file->excerpts.empty()) return {};
    Token first = name;
    first.text = name.text.substr(0, point);
    const std::string_view rest = name.text.substr(point + 1);
    const bool is_given_on = is_namespace(c, rest.substr(0, rest.find('.')));
    if ((is_namespace(c, first.text) && !is_given_on) || c.look_up(&Names::types, first) ||
        c.find_routine(first))
        return {};
    name.text = rest;
    const bool is_known = c.look_up(&Names::types, name) || c.find_routine(name);
    return is_known ? std::optional(name) : std::nullopt;
}

std::optional<Token> qualified_name(Checking& c, const Expression& member) {
    if (member.kind != E::member || !root_of(c, member)) return {};
    const std::string text = joined(member);
    if (text.empty()) return {};
    Token name = member.token;
    name.place = member.place;
    name.text = text;
    const auto is_known = [&](const Token& full) {
        return find_variable(c, full) || c.look_up(&Names::types, full) ||
               c.look_up(&Names::values, full) || c.find_routine(full);
    };
    const auto own = without_project(c, name);
    if (!is_known(name) && own) {
        name = *own;
    } else if (!is_known(name)) {
        const std::string_view rest = without_library(text);
        if (rest == text) return {};
        name.text = rest;
    }
    name.text = c.checked.names.emplace_back(name.text);
    return name;
}

void name_block_of_list(Checking& c, Expression& member) {
    const Expression& list = *member.operands[0];
    if (list.type || find_variable(c, list.token) || !root_of(c, member)) return;
    const std::string full = fmt::format("{}.{}", joined(list), list_properties);
    const Variable* block = find_in(c.globals, full);
    const Routine* of = block && block->type ? block->type->routine : nullptr;
    const std::string_view name = member.token.text;
    if (of && (of->getters.contains(name) || of->setters.contains(name)))
        member.operands[0] = make_name(c, list, c.checked.names.emplace_back(full));
}

bool is_full_name(Checking& c, const Expression& e, std::string_view full) {
    if (e.kind == E::member && !root_of(c, e)) return false;
    const std::string text = joined(e);
    if (text.size() > full.size() || text.empty()) return false;
    if (text.size() == full.size()) return same_name(text, full);
    const std::string_view path = full.substr(0, full.size() - text.size() - 1);
    const Prefixes* here = c.prefixes_at(e.place);
    return here && find_called(here->paths, path) && full[path.size()] == '.' &&
           same_name(full.substr(path.size() + 1), text);
}

void refuse_qualified(Checking& c, const Token& name) {
    const std::string_view before = before_last_point(name.text);
    const std::string path = find_namespace(c, name.place, before);
    if (path.empty()) return refuse_namespace(c, name.place, before);
    const std::string start = path + '.';
    std::vector<std::string> names;
    const auto add = [&](std::string_view full) {
        if (full.starts_with(start)) names.emplace_back(full.substr(start.size()));
    };
    for (const auto& [full, place] : c.users.places) add(full);
    std::ranges::sort(names);
    const std::string_view last = name.text.substr(before.size() + 1);
    if (c.tree.lost.contains(last)) return;
    c.fail(code::not_declared, name.place,
           fmt::format("the namespace '{}' has no '{}'", path, last), suggest(last, names));
}

bool refuse_member_of_namespace(Checking& c, const Expression& member) {
    if (member.kind != E::member || !root_of(c, member)) return false;
    Token name = member.token;
    const std::string text = joined(member);
    name.text = text;
    name.place = member.place;
    const std::string path(before_last_point(text));
    if (path.empty() || find_namespace(c, name.place, path).empty()) return false;
    refuse_qualified(c, name);
    return true;
}

bool refuse_of_list(Checking& c, const Expression& e) {
    const Expression& list = *e.operands[0];
    if (list.kind != E::name || list.token.local || list.type || find_variable(c, list.token))
        return false;
    std::vector<std::string> names;
    for (const DeclarationBlock& block : c.tree.globals)
        if (!block.list.empty() && same_name(block.list, list.token.text))
            for (const Declaration* declared : block.declarations)
                if (declared->name.text != list_properties) names.emplace_back(declared->name.text);
    if (names.empty() || c.find_routine(list.token) || c.look_up(&Names::types, list.token))
        return false;
    c.fail(code::not_declared, e.token.place,
           fmt::format("the list '{}' has no '{}'", list.token.text, e.token.text),
           suggest(e.token.text, names));
    return true;
}

bool may_be_elsewhere(Checking& c, Place place) {
    const Prefixes* here = c.prefixes_at(place);
    if (!here || here->is_whole) return false;
    for (const Token& used : c.unknown_usings)
        if (used.place.source == place.source) refuse_namespace(c, used.place, used.text);
    return true;
}

void warn_of_usings(Checking& c) {
    for (const Token& used : c.unknown_usings)
        if (c.namespaces.emplace(used.text, false).second)
            c.warn(code::not_declared, used.place,
                   fmt::format("there is no namespace '{}'", used.text),
                   "nothing of it is named: remove the USING");
}

}  // namespace lineshaft::st
