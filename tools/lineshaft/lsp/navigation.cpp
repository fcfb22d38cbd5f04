#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/types/elementary.hpp"
#include "tools/lineshaft/lsp/references.hpp"
#include "tools/lineshaft/lsp/requests.hpp"
#include "tools/lineshaft/lsp/yaml_places.hpp"

namespace lineshaft::lsp {

namespace {

Json location(const Session& session, const Mark& mark) {
    const std::string path = std::filesystem::path(mark.file->path).lexically_normal().string();
    return {{"uri", session.documents.uri(path)}, {"range", range_of(mark, session.encoding)}};
}

Json markdown(const std::string& text) {
    return {{"contents", {{"kind", "markdown"}, {"value", text}}}};
}

/// What a name in a file means, and where that was found out.
struct Found {
    std::shared_ptr<const Meaning> meaning;
    const st::NameUse* use = nullptr;
};

Found find(Session& session, const Asked& where) {
    for (const std::string& root : session.project.roots_of(where.path)) {
        Found found{meaning_of(session, root), nullptr};
        found.use = found.meaning->find(where);
        if (found.use) return found;
    }
    return {};
}

/// What a name in a program's file means of its Structured Text.
Found find_in_sources(Session& session, const Asked& where, const YamlName& name) {
    Found found;
    const std::string kind = kind_meant(session, where.path, name);
    if (kind.empty()) return found;
    found.meaning = meaning_of(session, where.path);
    const st::Routine* block = found.meaning->find_block(kind);
    if (!block) return found;
    const st::Place declared = name.port.empty() ? block->pou->name.place
                               : block->names.contains(name.port)
                                   ? block->names.at(name.port)->name.place
                                   : st::Place();
    for (const st::NameUse& use : found.meaning->uses)
        if (declared.source && use.at.source == declared.source && use.at.begin == declared.begin)
            found.use = &use;
    return found;
}

Found find_anywhere(Session& session, const Asked& where) {
    if (is_code(where.path)) return find(session, where);
    const auto name = name_at(where.text, where.offset);
    return name ? find_in_sources(session, where, *name) : Found();
}

std::string about_function(const Asked& where) {
    std::size_t begin = where.offset, end = where.offset;
    const auto is_part = [&](std::size_t i) {
        return is_letter(where.text[i]) || is_digit(where.text[i]);
    };
    while (begin > 0 && is_part(begin - 1)) --begin;
    while (end < where.text.size() && is_part(end)) ++end;
    const auto* f = st::find_standard_function(where.text.substr(begin, end - begin));
    return f ? fmt::format("```st\n{}\n```\n{}", f->signature, f->doc) : std::string();
}

/// A block of the program that a source names, `"Axis_1"`, is declared in no source.
bool can_be_changed(const Found& found) {
    if (!found.use || !found.use->declared.source) return false;
    const st::Type* type = found.use->variable ? found.use->variable->type : nullptr;
    return found.use->declared.source->is_users() && !(type && type->is_object());
}

/// As the language of the file has names.
bool is_name(const std::string& name, const SourceFile& file) {
    Diagnostics wrong;
    const auto alone = std::make_shared<SourceFile>(
        SourceFile{.path = file.path, .text = name, .read_as = file.read_as});
    const auto tokens = st::read_tokens(alone, wrong).tokens;
    const bool is_one = wrong.empty() && tokens.size() == 2 && tokens[0].word == st::Word::name &&
                        tokens[0].text == name;
    const auto is_value = [&](const char* value) { return st::same_name(value, name); };
    return is_one && !st::find_elementary(name) &&
           std::ranges::none_of(std::array{"TRUE", "FALSE", "NULL", "THIS", "SUPER"}, is_value);
}

/// A name that stands somewhere already would mean both.
bool is_taken(const References& references, const std::string& name) {
    const auto is_it = [&](const st::NameUse& use) {
        return st::same_name(text_of_name(use.at), name);
    };
    return st::find_standard_function(name) || standard_blocks().find(name) ||
           std::ranges::any_of(references.meanings, [&](const auto& meaning) {
               return std::ranges::any_of(meaning->uses, is_it);
           });
}

/// What a file of another tool says otherwise, a name drawn or put together, cannot be written
/// anew.
void refuse_unless_written(const Mark& mark, std::string_view name) {
    const Text text(mark.file->text);
    const auto [begin, end] = text.bytes_of(mark);
    if (!st::same_name(text.text().substr(begin, end - begin), name))
        throw RefusedName{fmt::format("'{}' is not written as that in {}:{}; rename it there", name,
                                      mark.file->path, mark.line)};
}

/// What stands in a block with a mistake means nothing yet, and would be left as it is.
void refuse_where_lost(Session& session, const std::string& path, const std::string& name) {
    for (const std::string& root : session.project.roots_to_look_in(path, name))
        if (meaning_of(session, root)->compiled.tree.lost.contains(name))
            throw RefusedName{
                fmt::format("'{}' stands in a block that has a mistake ({}); correct that first",
                            name, std::filesystem::path(root).filename().string())};
}

}  // namespace

Json hover(Session& session, const Json& params) {
    const auto where = asked(session, params);
    if (!where) return nullptr;
    const Found found = find_anywhere(session, *where);
    std::string text = found.use ? about(*found.use) : std::string();
    if (text.empty())
        text = is_code(where->path) ? about_function(*where) : about_yaml(session, *where);
    return text.empty() ? Json() : markdown(text);
}

Json definition(Session& session, const Json& params) {
    const auto where = asked(session, params);
    if (!where) return nullptr;
    if (const Found found = find_anywhere(session, *where); found.use) {
        const st::Place& declared = found.use->declared;
        const bool is_own = declared.source && declared.source->is_users();
        return is_own ? location(session, mark_of_name(declared)) : Json();
    }
    if (is_code(where->path)) return nullptr;
    const auto mark = declared_in_yaml(session, *where);
    return mark ? location(session, *mark) : Json();
}

Json references(Session& session, const Json& params) {
    const auto where = asked(session, params);
    const Found found = where ? find_anywhere(session, *where) : Found();
    if (!found.use || !found.use->declared.source) return nullptr;
    const bool with_declaration =
        params.value(Json::json_pointer("/context/includeDeclaration"), true);
    const Mark declared = mark_of_name(found.use->declared);
    Json list = Json::array();
    for (const auto& [mark] : references_to(session, *found.meaning, *found.use).places) {
        const bool is_declaration = mark.file->path == declared.file->path &&
                                    mark.line == declared.line && mark.column == declared.column;
        if (with_declaration || !is_declaration) list.push_back(location(session, mark));
    }
    return list;
}

Json prepare_rename(Session& session, const Json& params) {
    const auto where = asked(session, params);
    const Found found = where ? find_anywhere(session, *where) : Found();
    if (!can_be_changed(found)) return nullptr;
    if (is_code(where->path)) return range_of(mark_of_name(found.use->at), session.encoding);
    const auto name = name_at(where->text, where->offset);
    return Text(where->text).range(name->begin, name->end, session.encoding);
}

Json rename(Session& session, const Json& params) {
    const auto where = asked(session, params);
    const std::string name = params.at("newName").get<std::string>();
    const Found found = where ? find_anywhere(session, *where) : Found();
    if (!can_be_changed(found)) throw RefusedName{"what stands here has no name of yours"};
    const SourceFile& file = *found.use->declared.source->file;
    const std::string old = text_of_name(found.use->declared);
    if (!is_name(name, file)) throw RefusedName{fmt::format("'{}' is not a name", name)};
    const References references = references_to(session, *found.meaning, *found.use);
    if (!st::same_name(name, old) && is_taken(references, name))
        throw RefusedName{fmt::format("there is a '{}'", name)};
    for (const std::string& each : {old, name}) refuse_where_lost(session, file.path, each);
    Json changes = Json::object();
    for (const auto& [mark] : references.places) {
        refuse_unless_written(mark, old);
        const Json at = location(session, mark);
        changes[at["uri"].get<std::string>()].push_back(
            {{"range", at["range"]}, {"newText", name}});
    }
    return {{"changes", changes}};
}

Json code_actions(Session&, const Json& params) {
    constexpr std::string_view question = "did you mean ";
    const std::string uri = params.at("textDocument").at("uri");
    Json actions = Json::array();
    for (const Json& diagnostic : params.at("context").at("diagnostics")) {
        if (!diagnostic.contains("data") || !diagnostic["data"].is_string()) continue;
        const std::string help = diagnostic["data"];
        if (!help.starts_with(question)) continue;
        for (std::size_t begin = help.find('\''); begin != help.npos;
             begin = help.find('\'', begin)) {
            const std::size_t end = help.find('\'', ++begin);
            if (end == help.npos) break;
            const std::string meant = help.substr(begin, end - begin);
            const Json edit{{"range", diagnostic.at("range")}, {"newText", meant}};
            Json changes = Json::object();
            changes[uri] = Json::array({edit});
            actions.push_back({{"title", fmt::format("Write '{}'", meant)},
                               {"kind", "quickfix"},
                               {"diagnostics", Json::array({diagnostic})},
                               {"edit", {{"changes", changes}}}});
            begin = end + 1;
        }
    }
    return actions;
}

}  // namespace lineshaft::lsp
