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
#include "tools/lineshaft/lsp/meanings.hpp"
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
        found.use = found.meaning->find(where.path, where.offset);
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
    if (is_structured_text(where.path)) return find(session, where);
    const auto name = name_at(where.text, where.offset);
    return name ? find_in_sources(session, where, *name) : Found();
}

/// Where a name is written that means what is declared there.
struct Reference {
    Mark mark;
    std::string text;  ///< as it is written, with quotes or `#`
    bool operator<(const Reference& other) const {
        const auto key = [](const Reference& r) {
            return std::make_tuple(r.mark.file->path, r.mark.line, r.mark.column);
        };
        return key(*this) < key(other);
    }
};

bool is_same(const st::Place& a, const st::Place& b) {
    return a.source && b.source && a.begin == b.begin &&
           a.source->file->path == b.source->file->path &&
           a.source->file->part == b.source->file->part;
}

/// Names in a program's file that mean what is declared in its sources: in `job.table[3].x`, the
/// block `job` of a kind, `x` of what `table` has.
class NamesInYaml {
  public:
    NamesInYaml(std::shared_ptr<const SourceFile> file, const st::Place& wanted,
                std::set<Reference>& to)
        : file_(std::move(file)), text_(file_->text), wanted_(wanted), to_(to) {}

    void find(const Program& program, const Meaning& meaning) {
        const Text text(text_);
        for (const BlockPlan& block : program.blocks) {
            const st::Routine* kind = meaning.find_block(block.type.text);
            if (!kind) continue;
            types_[lower(block.name.text)] = kind->type;
            const auto [begin, end] = text.bytes_of(block.type.mark);
            if (is_same(kind->pou->name.place, wanted_)) add(begin, end);
            for (const auto& [key, value] : block.ports)
                follow(text.bytes_of(key.mark).first, kind->type);
        }
        for (const st::Global& global : meaning.compiled.checked.globals) {
            const bool is_it = global.pou && is_same(global.pou->name.place, wanted_);
            if (types_.emplace(lower(global.name), global.type).second && is_it)
                owner_ = lower(global.name);
        }
        for (const Node& kept : program.retain)
            if (const auto [begin, end] = text.bytes_of(kept.mark); lower(kept.text) == owner_)
                add(begin, end);
        for (std::size_t at = 0; at < text_.size(); ++at) {
            const bool begins = at == 0 || (!is_of_name(text_[at - 1]) && text_[at - 1] != '.');
            if (begins && is_of_name(text_[at])) follow_owner(at);
        }
    }

  private:
    std::size_t end_of_name(std::size_t at) const {
        while (at < text_.size() && is_of_name(text_[at])) ++at;
        return at;
    }
    void add(std::size_t begin, std::size_t end) {
        to_.insert({mark_of(file_, begin, end), text_.substr(begin, end - begin)});
    }
    void follow_owner(std::size_t begin) {
        const std::size_t end = end_of_name(begin);
        if (end == text_.size() || text_[end] != '.') return;
        const auto it = types_.find(lower(std::string_view(text_).substr(begin, end - begin)));
        if (it == types_.end()) return;
        if (it->first == owner_) add(begin, end);
        follow(end + 1, it->second);
    }
    void follow(std::size_t at, const st::Type* type) {
        while (at < text_.size() && (text_[at] == '"' || text_[at] == '\'')) ++at;
        while (type) {
            const std::size_t end = end_of_name(at);
            const st::Variable* part = part_of(*type, text_.substr(at, end - at));
            if (!part) return;
            if (is_same(part->name.place, wanted_)) add(at, end);
            type = part->type;
            at = end;
            while (at < text_.size() && text_[at] == '[') at = text_.find(']', at) + 1;
            if (at == 0 || at >= text_.size() || text_[at++] != '.') return;
        }
    }
    /// Of an array, of its elements.
    static const st::Variable* part_of(const st::Type& whole, std::string_view name) {
        const st::Type* type = &whole;
        while (type && type->kind == st::Type::Kind::array) type = type->element;
        if (!type) return nullptr;
        const bool is_block = type->kind == st::Type::Kind::block;
        for (const st::Variable* part :
             is_block ? st::all_variables(*type->routine) : type->members)
            if (st::same_name(part->text, name)) return part;
        return nullptr;
    }

    std::shared_ptr<const SourceFile> file_;
    const std::string& text_;
    const st::Place& wanted_;
    std::set<Reference>& to_;
    std::map<std::string, const st::Type*> types_;  ///< of blocks, by their names in small letters
    std::string owner_;                             ///< the data block that is looked for
};

/// Within the file of a program that has the block among its sources.
void add_in_yaml(Session& session, const std::string& root, const Meaning& meaning,
                 const st::Place& wanted, std::set<Reference>& to) {
    Diagnostics untold;
    const auto file = read_source(root, untold);
    if (!file) return;
    const auto it = session.programs.find(root);
    if (it != session.programs.end())
        NamesInYaml(file, wanted, to).find(it->second->program, meaning);
    else
        NamesInYaml(file, wanted, to).find(read_program(file, {}, untold), meaning);
}

std::set<Reference> references_to(Session& session, const st::Place& declared) {
    std::set<Reference> found;
    const std::string name(declared.text());
    for (const std::string& root :
         session.project.roots_to_look_in(declared.source->file->path, name)) {
        const auto meaning = meaning_of(session, root);
        bool is_there = false;
        for (const st::NameUse& use : meaning->uses)
            if (is_same(use.declared, declared)) {
                is_there = true;
                found.insert({use.at.mark(), std::string(use.at.text())});
            }
        if (is_there && !is_structured_text(root))
            add_in_yaml(session, root, *meaning, declared, found);
    }
    return found;
}

/// A method, and all that it replaces or implements, or that does so with it.
std::vector<st::Place> family_of(const Meaning& meaning, const st::NameUse& use) {
    std::vector<st::Place> places{use.declared};
    if (!use.routine || !use.routine->owner) return places;
    const std::string_view name = use.declared.text();
    const auto& routines = meaning.compiled.checked.routines;
    std::set<const st::Routine*> owners{use.routine->owner};
    for (std::size_t known = 0; known != owners.size();) {
        known = owners.size();
        for (const st::Routine& block : routines)
            if (st::find_in(block.methods, name) &&
                std::ranges::any_of(owners, [&](const st::Routine* owner) {
                    return st::is_a(block, *owner) || st::is_a(*owner, block);
                }))
                owners.insert(&block);
    }
    for (const st::Routine* owner : owners)
        for (const st::Routine* method : owner->own_methods)
            if (const st::Place& place = method->pou->name.place;
                st::same_name(method->pou->name.text, name) && !is_same(place, use.declared))
                places.push_back(place);
    return places;
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
bool is_taken(const Meaning& meaning, const std::string& name) {
    return st::find_standard_function(name) || standard_blocks().find(name) ||
           std::ranges::any_of(meaning.uses, [&](const st::NameUse& use) {
               return st::same_name(use.at.text(), name);
           });
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
        text =
            is_structured_text(where->path) ? about_function(*where) : about_yaml(session, *where);
    return text.empty() ? Json() : markdown(text);
}

Json definition(Session& session, const Json& params) {
    const auto where = asked(session, params);
    if (!where) return nullptr;
    if (const Found found = find_anywhere(session, *where); found.use) {
        const st::Place& declared = found.use->declared;
        const bool is_own = declared.source && declared.source->is_users();
        return is_own ? location(session, declared.mark()) : Json();
    }
    if (is_structured_text(where->path)) return nullptr;
    const auto mark = declared_in_yaml(session, *where);
    return mark ? location(session, *mark) : Json();
}

Json references(Session& session, const Json& params) {
    const auto where = asked(session, params);
    const Found found = where ? find_anywhere(session, *where) : Found();
    if (!found.use || !found.use->declared.source) return nullptr;
    const bool with_declaration =
        params.value(Json::json_pointer("/context/includeDeclaration"), true);
    const Mark declared = found.use->declared.mark();
    Json list = Json::array();
    for (const Reference& reference : references_to(session, found.use->declared)) {
        const Mark& mark = reference.mark;
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
    if (is_structured_text(where->path)) return range_of(found.use->at.mark(), session.encoding);
    const auto name = name_at(where->text, where->offset);
    return Text(where->text).range(name->begin, name->end, session.encoding);
}

Json rename(Session& session, const Json& params) {
    const auto where = asked(session, params);
    const std::string name = params.at("newName").get<std::string>();
    const Found found = where ? find_anywhere(session, *where) : Found();
    if (!can_be_changed(found)) throw RefusedName{"what stands here has no name of yours"};
    const SourceFile& file = *found.use->declared.source->file;
    const std::string old(found.use->declared.text());
    if (!is_name(name, file)) throw RefusedName{fmt::format("'{}' is not a name", name)};
    if (!st::same_name(name, old) && is_taken(*found.meaning, name))
        throw RefusedName{fmt::format("there is a '{}'", name)};
    for (const std::string& each : {old, name}) refuse_where_lost(session, file.path, each);
    std::set<Reference> references;
    for (const st::Place& declared : family_of(*found.meaning, *found.use))
        references.merge(references_to(session, declared));
    Json changes = Json::object();
    for (const auto& [mark, text] : references) {
        const std::string_view before = text.starts_with('#') ? "#" : "";
        const std::string_view quote = text.ends_with('"') ? "\"" : "";
        const Json at = location(session, mark);
        changes[at["uri"].get<std::string>()].push_back(
            {{"range", at["range"]},
             {"newText", fmt::format("{}{}{}{}", before, quote, name, quote)}});
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
