#include "tools/lineshaft/lsp/references.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "runtime/source/encoding.hpp"
#include "runtime/source/letters.hpp"
#include "tools/lineshaft/lsp/yaml_places.hpp"

namespace lineshaft::lsp {

namespace {

/// The bytes of the name alone among [begin, end) of a text.
std::pair<std::size_t, std::size_t> bytes_of_name(std::string_view text, std::size_t begin,
                                                  std::size_t end) {
    if (begin < end && text[begin] == '#') ++begin;
    const bool is_quoted = end - begin > 2 && (text[begin] == '"' || text[begin] == '\'') &&
                           text[end - 1] == text[begin];
    return is_quoted ? std::pair(begin + 1, end - 1) : std::pair(begin, end);
}

bool is_same(const st::Place& a, const st::Place& b) {
    return a.source && b.source && a.begin == b.begin &&
           a.source->file->path == b.source->file->path &&
           a.source->file->part == b.source->file->part;
}

using Places = std::vector<st::Place>;

bool contains(const Places& places, const st::Place& place) {
    return std::ranges::any_of(places, [&](const st::Place& p) { return is_same(p, place); });
}

/// Names in a program's file that mean what is declared in its sources: in `job.table[3].x`, the
/// block `job` of a kind, `x` of what `table` has.
class NamesInYaml {
  public:
    NamesInYaml(std::shared_ptr<const SourceFile> file, const Places& wanted,
                std::set<Reference>& to)
        : file_(std::move(file)), text_(file_->text), wanted_(wanted), to_(to) {}

    void find(const Program& program, const Meaning& meaning) {
        const Text text(text_);
        for (const BlockPlan& block : program.blocks) {
            const st::Routine* kind = meaning.find_block(block.type.text);
            if (!kind) continue;
            types_[lower(block.name.text)] = kind->type;
            const auto [begin, end] = text.bytes_of(block.type.mark);
            if (contains(wanted_, kind->pou->name.place)) add(begin, end);
            for (const auto& [key, value] : block.ports)
                follow(text.bytes_of(key.mark).first, kind->type);
        }
        for (const st::Global& global : meaning.compiled.checked.globals) {
            const bool is_it = global.pou && contains(wanted_, global.pou->name.place);
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
        std::tie(begin, end) = bytes_of_name(text_, begin, end);
        to_.insert({mark_of(file_, begin, end)});
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
            if (contains(wanted_, part->name.place)) add(at, end);
            type = part->type;
            at = end;
            while (at < text_.size() && text_[at] == '[') at = text_.find(']', at) + 1;
            if (at == 0 || at >= text_.size()) return;
            if (text_[at] != '.') return add_value(at, type);
            ++at;
        }
    }
    /// Behind a variable of an enumeration, `main.mode: Run` and `{always: main.mode, equals:
    /// Run}`.
    void add_value(std::size_t at, const st::Type* type) {
        while (type && type->kind == st::Type::Kind::array) type = type->element;
        const std::size_t end = std::min(text_.find_first_of("}\n", at), text_.size());
        std::size_t colon = std::min(text_.find_first_not_of(" \"'", at), text_.size());
        if (colon < end && text_[colon] != ':') colon = text_.find(':', text_.find("equals:", at));
        if (!type || colon >= end) return;
        std::size_t begin = text_.find_first_not_of(" \"'", colon + 1), last = begin;
        for (; last < end && (is_of_name(text_[last]) || text_[last] == '.' || text_[last] == '#');
             ++last)
            if (!is_of_name(text_[last])) begin = last + 1;
        for (std::size_t i = 0; i < type->places.size(); ++i)
            if (contains(wanted_, type->places[i]) &&
                st::same_name(type->values[i], text_.substr(begin, last - begin)))
                add(begin, last);
    }
    /// The part of that name; an array's is one of its elements.
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
    const Places& wanted_;
    std::set<Reference>& to_;
    std::map<std::string, const st::Type*> types_;  ///< of blocks, by their names in small letters
    std::string owner_;                             ///< the data block that is looked for
};

/// Within the file of a program that has the block among its sources.
void add_in_yaml(Session& session, const std::string& root, const Meaning& meaning,
                 const Places& wanted, std::set<Reference>& to) {
    Diagnostics untold;
    const auto file = read_source(root, untold);
    if (!file) return;
    const auto it = session.programs.find(root);
    if (it != session.programs.end())
        NamesInYaml(file, wanted, to).find(it->second->program, meaning);
    else
        NamesInYaml(file, wanted, to).find(read_program(file, {}, untold), meaning);
}

bool has_method(const st::Routine& block, std::string_view name) {
    return st::find_in(block.methods, name) || st::find_in(block.getters, name) ||
           st::find_in(block.setters, name);
}

/// Blocks and interfaces whose methods of one name are one to who calls them.
class Family {
  public:
    Family(Session& session, const st::Routine& method)
        : session_(session), name_(text_of_name(method.pou->name.place)) {
        add(*method.owner);
        while (has_grown_) {
            has_grown_ = false;
            for (const std::string& root : roots_) add_relatives(*meaning_of(session_, root));
        }
    }

    /// Where the method is declared; with a name, that parameter of it.
    Places declared(const std::string& parameter) const {
        Places found;
        for (const std::string& root : roots_)
            for (const st::Routine& block : meaning_of(session_, root)->compiled.checked.routines) {
                if (!contains(owners_, block.pou->name.place)) continue;
                for (const st::Routine* method : block.own_methods)
                    if (st::same_name(method->pou->name.text, name_))
                        add_declared(*method, parameter, found);
            }
        return found;
    }

  private:
    static void add_declared(const st::Routine& method, const std::string& parameter,
                             Places& found) {
        if (parameter.empty()) {
            found.push_back(method.pou->name.place);
            return;
        }
        for (const st::Variable* variable : parameters_of(method))
            if (st::same_name(variable->text, parameter)) found.push_back(variable->name.place);
    }

    /// What derives from it, or implements it, has its name.
    void add(const st::Routine& owner) {
        const st::Place& place = owner.pou->name.place;
        if (!place.source || !place.source->is_users() || contains(owners_, place)) return;
        has_grown_ = true;
        owners_.push_back(place);
        for (const std::string& root :
             session_.project.roots_to_look_in(place.source->file->path, text_of_name(place)))
            roots_.insert(root);
    }

    void add_relatives(const Meaning& meaning) {
        std::vector<const st::Routine*> known;
        for (const st::Routine& block : meaning.compiled.checked.routines)
            if (!block.owner && contains(owners_, block.pou->name.place)) known.push_back(&block);
        for (const st::Routine& block : meaning.compiled.checked.routines)
            if (has_method(block, name_) &&
                std::ranges::any_of(known, [&](const st::Routine* owner) {
                    return st::is_a(block, *owner) || st::is_a(*owner, block);
                }))
                add(block);
    }

    Session& session_;
    std::string name_;
    Places owners_;
    std::set<std::string> roots_;
    bool has_grown_ = false;
};

/// The method that is meant, or has the parameter that is; null: neither.
const st::Routine* method_of(const Meaning& meaning, const st::NameUse& use) {
    if (use.routine) return use.routine->owner ? use.routine : nullptr;
    if (!use.variable) return nullptr;
    for (const st::Routine& routine : meaning.compiled.checked.routines)
        if (routine.owner && routine.pou == use.variable->of) return &routine;
    return nullptr;
}

bool is_parameter(const st::Routine& method, const st::Variable& variable) {
    const auto all = parameters_of(method);
    return std::ranges::find(all, &variable) != all.end();
}

/// Where that is declared which has its name together with it. What a method gives back has the
/// method's name.
Places declared_with(Session& session, const Meaning& meaning, const st::NameUse& use) {
    const st::Routine* method = method_of(meaning, use);
    if (!method) return {use.declared};
    if (is_same(use.declared, method->pou->name.place))
        return Family(session, *method).declared({});
    if (!use.variable || !is_parameter(*method, *use.variable)) return {use.declared};
    return Family(session, *method).declared(std::string(use.variable->text));
}

}  // namespace

bool Reference::operator<(const Reference& other) const {
    const auto key = [](const Reference& r) {
        return std::make_tuple(r.mark.file->path, r.mark.line, r.mark.column);
    };
    return key(*this) < key(other);
}

Mark mark_of_name(const st::Place& name) {
    const auto [begin, end] = bytes_of_name(name.source->text(), name.begin, name.end);
    return mark_of(name.source->file, begin, end);
}

std::string text_of_name(const st::Place& name) {
    const auto [begin, end] = bytes_of_name(name.source->text(), name.begin, name.end);
    return std::string(name.source->text().substr(begin, end - begin));
}

References references_to(Session& session, const Meaning& of, const st::NameUse& use) {
    References found;
    const Places declared = declared_with(session, of, use);
    for (const std::string& root : session.project.roots_to_look_in(use.declared.source->file->path,
                                                                    text_of_name(use.declared))) {
        const auto meaning = meaning_of(session, root);
        bool is_there = false;
        for (const st::NameUse& other : meaning->uses)
            if (contains(declared, other.declared)) {
                is_there = true;
                found.places.insert({mark_of_name(other.at)});
            }
        if (!is_there) continue;
        found.meanings.push_back(meaning);
        if (!is_code(root)) add_in_yaml(session, root, *meaning, declared, found.places);
    }
    return found;
}

}  // namespace lineshaft::lsp
