#include <algorithm>

#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/types/elementary.hpp"
#include "tools/lineshaft/lsp/meanings.hpp"
#include "tools/lineshaft/lsp/offer.hpp"
#include "tools/lineshaft/lsp/requests.hpp"
#include "tools/lineshaft/lsp/yaml_places.hpp"

namespace lineshaft::lsp {

namespace {

void add_variable(Offer& to, const st::Variable& v, Offered kind, const std::string& behind = {}) {
    to.add(v.text, kind, v.type ? st::describe(*v.type) : "", v.doc,
           behind.empty() ? behind : std::string(v.text) + behind);
}

/// `FB_init.begins`, which the checker adds, is no name of a method.
bool is_written(std::string_view name) {
    return name.find('.') == name.npos;
}

/// Names with dots, indices left out, that end before a byte: `a.b[i].c` as a, b, c.
std::vector<std::string> chain_before(const std::string& text, std::size_t end) {
    std::vector<std::string> names;
    const auto is_part = [&](std::size_t i) {
        return is_letter(text[i]) || is_digit(text[i]) || !is_ascii(text[i]) || text[i] == '#' ||
               text[i] == '"';
    };
    while (end > 0) {
        while (end > 0 && (text[end - 1] == ']' || text[end - 1] == '^')) {
            int depth = text[end - 1] == ']' ? 1 : 0;
            for (--end; depth > 0 && end > 0; --end)
                depth += text[end - 1] == ']' ? 1 : text[end - 1] == '[' ? -1 : 0;
        }
        std::size_t begin = end;
        while (begin > 0 && is_part(begin - 1)) --begin;
        if (begin == end) break;
        std::string name = text.substr(begin, end - begin);
        std::erase_if(name, [](char c) { return c == '#' || c == '"'; });
        names.insert(names.begin(), name);
        if (begin == 0 || text[begin - 1] != '.') break;
        end = begin - 1;
    }
    return names;
}

struct Completion {
    const Meaning& meaning;
    const st::Routine* routine;

    const st::Variable* find_variable(std::string_view name) const;
    const st::Type* type_of(const std::vector<std::string>& chain) const;
    const st::Routine* routine_of(const std::vector<std::string>& chain) const;
    void add_members(const st::Type& type, Offer& to) const;
    void add_names(Offer& to) const;
};

const st::Type* plain(const st::Type* type) {
    while (type && type->element &&
           (type->kind == st::Type::Kind::array || type->kind == st::Type::Kind::reference))
        type = type->element;
    return type;
}

const st::Variable* member_of(const st::Type& type, std::string_view name) {
    if (type.kind == st::Type::Kind::block) {
        const auto it = type.routine->names.find(name);
        return it == type.routine->names.end() ? nullptr : it->second;
    }
    const auto it = std::ranges::find_if(type.members, [&](const st::Variable* member) {
        return st::same_name(member->text, name);
    });
    return it == type.members.end() ? nullptr : *it;
}

const st::Variable* Completion::find_variable(std::string_view name) const {
    for (const st::Routine* r = routine; r; r = r->owner)
        if (const auto it = r->names.find(name); it != r->names.end()) return it->second;
    for (const st::NameUse& use : meaning.uses)
        if (use.variable && use.variable->section == st::Section::global &&
            st::same_name(use.variable->text, name))
            return use.variable;
    return nullptr;
}

const st::Type* Completion::type_of(const std::vector<std::string>& chain) const {
    if (chain.empty()) return nullptr;
    const st::Type* type = nullptr;
    const st::Routine* block = routine && routine->owner ? routine->owner : routine;
    if (block && st::same_name(chain[0], "this")) {
        type = block->type;
    } else if (block && block->base && st::same_name(chain[0], "super")) {
        type = block->base->type;
    } else if (const st::Variable* first = find_variable(chain[0])) {
        type = plain(first->type);
    } else {
        for (const st::NameUse& use : meaning.uses)  // values of an enumeration
            if (use.type && !use.variable && !use.routine &&
                st::same_name(use.type->name, chain[0]))
                type = use.type;
    }
    for (std::size_t i = 1; i < chain.size() && type; ++i) {
        const st::Variable* member = member_of(*type, chain[i]);
        type = member ? plain(member->type) : nullptr;
    }
    return type;
}

const st::Routine* Completion::routine_of(const std::vector<std::string>& chain) const {
    if (chain.empty()) return nullptr;
    const std::string& last = chain.back();
    if (chain.size() > 1) {
        const st::Type* of = type_of({chain.begin(), chain.end() - 1});
        if (!of || !of->routine) return nullptr;
        if (const auto it = of->routine->methods.find(last); it != of->routine->methods.end())
            return it->second;
    }
    if (const st::Type* type = type_of(chain)) return type->routine;
    for (const st::Routine* r = routine; r; r = r->owner)
        if (const auto it = r->methods.find(last); it != r->methods.end()) return it->second;
    for (const st::Routine& r : meaning.compiled.checked.routines)
        if (!r.owner && r.is_function() && st::same_name(r.name, last)) return &r;
    return nullptr;
}

void Completion::add_members(const st::Type& type, Offer& to) const {
    const bool is_own =
        routine && type.routine && (routine == type.routine || routine->owner == type.routine);
    if (type.routine) {
        for (const st::Variable* v : st::all_variables(*type.routine))
            if (is_own || v->section == st::Section::input || v->section == st::Section::output)
                add_variable(to, *v, Offered::field);
        for (const auto* known : {&type.routine->methods, &type.routine->getters})
            for (const auto& [name, method] : *known)
                if (is_written(name)) to.add(name, Offered::method, signature_of(*method));
    }
    for (const st::Variable* member : type.members)
        if (type.kind != st::Type::Kind::standard || member->section != st::Section::local)
            add_variable(to, *member, Offered::field);
    if (type.kind == st::Type::Kind::handle)
        for (const lineshaft::Field& field : type.standard->fields)
            to.add(field.name, Offered::field, std::string(field.unit), std::string(field.doc));
    for (const std::string& value : type.values) to.add(value, Offered::enum_, type.name);
}

void Completion::add_names(Offer& to) const {
    for (const st::Routine* r = routine; r; r = r->owner) {
        for (const st::Variable* v : st::all_variables(*r)) add_variable(to, *v, Offered::variable);
        for (const auto& [name, method] : r->methods)
            if (is_written(name)) to.add(name, Offered::method, signature_of(*method));
    }
    for (const st::NameUse& use : meaning.uses)
        if (use.variable && use.variable->section == st::Section::global)
            add_variable(to, *use.variable, Offered::variable);
    for (const st::Routine& r : meaning.compiled.checked.routines)
        if (!r.owner && r.pou->place.source && r.pou->place.source->is_users())
            to.add(r.name, r.is_function() ? Offered::function : Offered::class_, signature_of(r));
    for (const st::Type& type : meaning.compiled.checked.types)
        if (!type.is_unnamed && (type.kind == st::Type::Kind::structure || type.has_values())) {
            to.add(type.name, Offered::class_);
            for (const std::string& value : type.values) to.add(value, Offered::enum_, type.name);
        }
    for (const st::StandardFunction* f : st::standard_functions())
        to.add(f->name, Offered::function, std::string(f->signature), std::string(f->doc));
    for (const BlockType& kind : standard_blocks().types())
        to.add(kind.name, Offered::class_, "", std::string(kind.doc));
    for (int word = 0; word < static_cast<int>(st::Word::end_of_file); ++word)
        to.add(st::shown(static_cast<st::Word>(word)), Offered::keyword);
}

/// A call whose brackets are open at a byte.
struct OpenCall {
    std::size_t open = 0;  ///< of its bracket
    int argument = 0;
    std::string name = {};  ///< of the argument, where it is said
};

std::optional<OpenCall> call_around(const std::string& text, std::size_t offset) {
    constexpr std::size_t farthest = 4000;
    OpenCall call;
    int depth = 0;
    std::size_t begin = offset;  // of the argument
    bool is_first = true;
    for (std::size_t i = offset; i > 0 && offset - i < farthest; --i) {
        const char c = text[i - 1];
        if (c == ';') return {};
        if (c == ')' || c == ']') ++depth;
        if (c == '[' && depth > 0) --depth;
        if (c == ',' && depth == 0) {
            if (is_first) begin = i;
            is_first = false;
            ++call.argument;
        }
        if (c != '(') continue;
        if (depth-- > 0) continue;
        if (is_first) begin = i;
        call.open = i - 1;
        const std::string argument = text.substr(begin, offset - begin);
        if (const std::size_t sign = std::min(argument.find(":="), argument.find("=>"));
            sign != argument.npos) {
            const auto chain =
                chain_before(argument, argument.find_last_not_of(" \t\r\n", sign - (sign > 0)) + 1);
            if (!chain.empty()) call.name = chain.back();
        }
        return call;
    }
    return {};
}

std::size_t without_blanks(const std::string& text, std::size_t end) {
    while (end > 0 && (text[end - 1] == ' ' || text[end - 1] == '\t')) --end;
    return end;
}

/// Where nothing is named.
bool is_in_comment_or_text(const Asked& where) {
    Diagnostics untold;
    const auto before = std::make_shared<SourceFile>(
        SourceFile{.path = where.path, .text = where.text.substr(0, where.offset)});
    const std::string_view text = before->text;
    const st::Tokens all = st::read_tokens(before, untold);
    const auto is_open = [&](std::size_t begin) {
        const std::string_view rest = text.substr(begin);
        return rest.starts_with("(*") || rest.starts_with("/*") ||
               (rest.starts_with('\'') && rest.find('\n') == rest.npos);
    };
    return std::ranges::any_of(all.mistakes, is_open) ||
           std::ranges::any_of(all.comments, [&](const st::Pragma& comment) {
               return comment.place.end == text.size() && comment.place.text().starts_with("//");
           });
}

Json complete_structured_text(Session& session, const Asked& where) {
    Offer offer(false);
    if (is_in_comment_or_text(where)) return offer.take();
    const auto meaning = whole_meaning_of(session, session.project.roots_of(where.path).front());
    const Completion at{*meaning, meaning->routine_at(where)};
    std::size_t begin = where.offset;
    while (begin > 0 && (is_letter(where.text[begin - 1]) || is_digit(where.text[begin - 1])))
        --begin;
    if (begin > 0 && (where.text[begin - 1] == '.' || where.text[begin - 1] == '#')) {
        const st::Type* type = at.type_of(chain_before(where.text, begin - 1));
        if (type) at.add_members(*type, offer);
        const bool is_literal = begin > 1 && is_letter(where.text[begin - 2]);  // `T#`
        if (type || is_literal || where.text[begin - 1] == '.') return offer.take();
    }
    if (const auto call = call_around(where.text, begin); call && call->name.empty()) {
        const auto chain = chain_before(where.text, without_blanks(where.text, call->open));
        if (const st::Routine* called = at.routine_of(chain))
            for (const st::Variable* v : parameters_of(*called))
                add_variable(offer, *v, Offered::field,
                             v->section == st::Section::output ? " => " : " := ");
        else if (const st::Type* type = at.type_of(chain))
            for (const st::Variable* v : type->members)
                add_variable(offer, *v, Offered::field,
                             v->section == st::Section::output ? " => " : " := ");
    }
    at.add_names(offer);
    return offer.take();
}

struct Signature {
    std::string label;
    std::vector<std::string> parameters;
};

std::optional<Signature> signature_at(const Completion& at, const std::vector<std::string>& chain) {
    if (const st::Routine* called = at.routine_of(chain)) {
        Signature made{signature_of(*called), {}};
        for (const st::Variable* v : parameters_of(*called)) made.parameters.emplace_back(v->text);
        return made;
    }
    if (const st::Type* type = at.type_of(chain); type && type->kind == st::Type::Kind::standard) {
        Signature made;
        for (const st::Variable* v : type->members) {
            if (v->section == st::Section::local) continue;
            made.label += fmt::format("{}{} : {}", made.label.empty() ? "" : "; ", v->text,
                                      v->type ? st::describe(*v->type) : "?");
            made.parameters.emplace_back(v->text);
        }
        made.label = fmt::format("FUNCTION_BLOCK {}({})", type->name, made.label);
        return made;
    }
    const auto* f = chain.size() == 1 ? st::find_standard_function(chain[0]) : nullptr;
    if (!f) return {};
    Signature made{std::string(f->signature), {}};
    for (int i = 0; i < f->least; ++i)
        made.parameters.emplace_back(f->parameters[static_cast<std::size_t>(i)].name);
    return made;
}

}  // namespace

Json completion(Session& session, const Json& params) {
    const auto where = asked(session, params);
    if (!where) return nullptr;
    if (is_code(where->path) && !is_structured_text(where->path)) return nullptr;
    return {{"isIncomplete", false},
            {"items", is_structured_text(where->path) ? complete_structured_text(session, *where)
                                                      : complete_yaml(session, *where)}};
}

Json signature_help(Session& session, const Json& params) {
    const auto where = asked(session, params);
    if (!where || !is_structured_text(where->path)) return nullptr;
    const auto call = call_around(where->text, where->offset);
    if (!call) return nullptr;
    const auto meaning = whole_meaning_of(session, session.project.roots_of(where->path).front());
    const Completion at{*meaning, meaning->routine_at(*where)};
    const auto chain = chain_before(where->text, without_blanks(where->text, call->open));
    const auto signature = signature_at(at, chain);
    if (!signature) return nullptr;
    Json parameters = Json::array();
    int active = call->argument;
    for (std::size_t i = 0; i < signature->parameters.size(); ++i) {
        parameters.push_back({{"label", signature->parameters[i]}});
        if (st::same_name(signature->parameters[i], call->name)) active = static_cast<int>(i);
    }
    return {
        {"signatures", Json::array({{{"label", signature->label}, {"parameters", parameters}}})},
        {"activeSignature", 0},
        {"activeParameter", active}};
}

}  // namespace lineshaft::lsp
