#include "tools/lineshaft/lsp/yaml_places.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/fit/fit_form.hpp"
#include "runtime/program/program_form.hpp"
#include "runtime/program/recording_form.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/study/study_form.hpp"
#include "tools/lineshaft/block_text.hpp"
#include "tools/lineshaft/lsp/offer.hpp"

namespace lineshaft::lsp {

bool is_of_name(char c) {
    return is_letter(c) || is_digit(c);
}

namespace {

/// A key whose value goes on, or a bracket that is open.
struct Level {
    std::size_t indent = 0;
    std::string key;
    char kind = 'k';  ///< k of a block's key, - { [
};

/// Goes through lines as they are written; a text need not be whole.
class Scan {
  public:
    void line(std::string_view text);
    std::vector<Level> levels;
    bool is_value = false;
    std::string word;  ///< that is being written

  private:
    bool is_flow() const {
        return !levels.empty() && (levels.back().kind == '{' || levels.back().kind == '[');
    }
    void close_blocks(std::size_t indent, bool is_item);
    void flow(std::string_view text);
};

void Scan::close_blocks(std::size_t indent, bool is_item) {
    const auto ends = [&](const Level& level) {
        return level.indent > indent || (level.indent == indent && (level.kind == '-' || !is_item));
    };
    while (!levels.empty() && ends(levels.back())) levels.pop_back();
}

/// What stands behind a key: a value, or brackets with keys of their own.
void Scan::flow(std::string_view text) {
    char quote = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quote) {
            quote = c == quote ? '\0' : quote;
        } else if (c == '\'' || c == '"') {
            quote = c;
        } else if (c == '#' && (i == 0 || text[i - 1] == ' ')) {
            return;
        } else if (c == '{' || c == '[') {
            levels.push_back({levels.empty() ? 0 : levels.back().indent, c == '[' ? "[]" : "", c});
            is_value = c == '[';
            word.clear();
        } else if ((c == '}' || c == ']') && is_flow()) {
            levels.pop_back();
            word.clear();
        } else if (c == ',' && is_flow()) {
            if (levels.back().kind == '{') levels.back().key.clear();
            is_value = levels.back().kind == '[';
            word.clear();
        } else if (c == ':' && is_flow() && levels.back().kind == '{' && !is_value) {
            levels.back().key = word;
            is_value = true;
            word.clear();
        } else if (c == ' ') {
            word.clear();
        } else {
            word += c;
        }
    }
}

void Scan::line(std::string_view text) {
    const std::size_t indent = std::min(text.find_first_not_of(' '), text.size());
    word.clear();
    if (indent == text.size() || text[indent] == '#') {
        if (!is_flow()) close_blocks(indent, false), is_value = false;
        return;
    }
    if (is_flow()) return flow(text.substr(indent));
    std::size_t at = indent;
    const auto is_item = [&] {
        return text.substr(at).starts_with("- ") || text.substr(at) == "-";
    };
    close_blocks(indent, is_item());
    is_value = false;
    for (; at < text.size() && is_item();
         at = std::min(text.find_first_not_of(' ', at + 1), text.size())) {
        levels.push_back({at, "[]", '-'});
        is_value = true;
    }
    std::size_t colon = text.find(':', at);
    while (colon != text.npos && colon + 1 < text.size() && text[colon + 1] != ' ')
        colon = text.find(':', colon + 1);
    const bool has_bracket = text.find_first_of("{[#'\"", at) < colon;
    if (colon == text.npos || has_bracket) return flow(text.substr(at));
    levels.push_back({at, std::string(text.substr(at, colon - at)), 'k'});
    is_value = true;
    flow(text.substr(colon + 1));
}

Scan scan_to(const std::string& text, std::size_t offset) {
    Scan scan;
    for (std::size_t begin = 0; begin <= offset;) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view line = std::string_view(text).substr(begin, std::min(end, offset) - begin);
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (end < offset || begin <= offset) scan.line(line);
        begin = end + 1;
    }
    return scan;
}

const BlockType* find_kind(const Session& session, const std::string& path, std::string_view name) {
    if (const auto it = session.programs.find(path); it != session.programs.end())
        if (const auto& kinds = it->second->net.kinds)
            if (const BlockType* found = kinds->find(name)) return found;
    return standard_blocks().find(name);
}

/// `type: gear` of a block, from what is written, be it whole or not.
std::string type_of(const std::string& text, const std::string& block) {
    std::size_t at = 0;
    while ((at = text.find(block + ":", at)) != text.npos) {
        const std::size_t line = at == 0 ? 0 : text.rfind('\n', at) + 1;
        const std::size_t indent = at - line;
        at += block.size() + 1;
        if (text.find_first_not_of(' ', line) != at - block.size() - 1) continue;
        std::size_t end = text.find('\n', at);
        for (; end != text.npos; end = text.find('\n', end + 1)) {
            const std::size_t next = text.find_first_not_of(' ', end + 1);
            if (next != text.npos && text[next] != '\n' && next - end - 1 <= indent) break;
        }
        const std::string body = text.substr(at, end == text.npos ? end : end - at);
        const std::size_t type = body.find("type:");
        if (type == body.npos) continue;
        const std::size_t begin = body.find_first_not_of(' ', type + 5);
        if (begin == body.npos) continue;
        std::size_t last = begin;
        while (last < body.size() && is_of_name(body[last])) ++last;
        return body.substr(begin, last - begin);
    }
    return {};
}

/// `mm/s` of `{unit}/s`, as the block of that name has it; `unit/s` where it is not known.
std::string unit_of(const Session& session, const std::string& path, std::string_view block,
                    const BlockType& kind, const Field& field) {
    if (const auto it = session.programs.find(path); it != session.programs.end())
        for (const Instance& instance : it->second->net.instances)
            if (instance.name == block && instance.known() && instance.type->name == kind.name)
                return it->second->net.unit_of(instance, field.unit).text;
    std::string text(field.unit);
    std::erase_if(text, [](char c) { return c == '{' || c == '}'; });
    return text;
}

std::string about_field(const Field& field, const std::string& unit) {
    std::string text = fmt::format("**{}**: {}", field.name, name_of(field.direction));
    if (field.direction == Direction::in_out) text += fmt::format(" to {}", field.refers);
    if (!unit.empty()) text += fmt::format(", unit {}", unit);
    for (std::size_t i = 0; i < field.names.size(); ++i)
        text += fmt::format("{}{}", i == 0 ? ", one of " : ", ", field.names[i]);
    return fmt::format("{}\n\n{}", text, field.doc);
}

using Shapes = std::vector<Shape>;

/// Shapes that one of several alternatives is.
void expand(const Shape& shape, Shapes& to) {
    if (shape.kind != Shape::Kind::either) return to.push_back(shape);
    for (const Shape& one : shape.of) expand(one, to);
}

/// What may stand at a key of something of these shapes, and the key that says so, if any.
Shapes step(const Shapes& from, const std::string& key, const Key** said) {
    Shapes to;
    *said = nullptr;
    for (const Shape& shape : from) {
        if (key == "[]" && shape.kind == Shape::Kind::list) expand(shape.of[0], to);
        if (key != "[]" && shape.kind == Shape::Kind::map) expand(shape.of[0], to);
        const bool has_keys = shape.kind == Shape::Kind::form || shape.kind == Shape::Kind::block;
        const Form* form = has_keys && shape.form ? &shape.form() : nullptr;
        const Key* found = form ? form->find(key) : nullptr;
        if (!found) continue;
        *said = found;
        expand(found->shape, to);
    }
    return to;
}

const Form& form_of_file(const std::string& text) {
    const SourceFile file{"", text};
    if (file.has_key("lineshaft_study:")) return study_form();
    if (file.has_key("lineshaft_fit:")) return fit_form();
    if (file.has_key("lineshaft_controller:")) return controller_form();
    if (file.has_key("lineshaft_recording:")) return recording_form();
    return program_form();
}

Shapes shapes_at(const std::string& text, const std::vector<std::string>& keys, const Key** said) {
    Shapes shapes{a_form(nullptr)};
    const Form& form = form_of_file(text);
    shapes.clear();
    *said = nullptr;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (i == 0) {
            *said = form.find(keys[0]);
            if (*said) expand((*said)->shape, shapes);
        } else {
            shapes = step(shapes, keys[i], said);
        }
    }
    return shapes;
}

/// The keys lead to one of a block: its type, as it is written.
std::string block_type(const std::string& text, const std::vector<std::string>& keys) {
    return keys.size() >= 2 && keys[0] == "blocks" ? type_of(text, keys[1]) : std::string();
}

void add_keys(const Session& session, const Asked& where, const std::vector<std::string>& keys,
              Offer& to) {
    const auto add_form = [&](const Form& form) {
        for (const Key& key : form.keys)
            to.add(key.name, Offered::property, key.required ? "must be set" : "", key.doc,
                   std::string(key.name) + ": ");
    };
    if (keys.empty()) return add_form(form_of_file(where.text));
    const Key* said = nullptr;
    for (const Shape& shape : shapes_at(where.text, keys, &said)) {
        const bool has_keys = shape.kind == Shape::Kind::form || shape.kind == Shape::Kind::block;
        if (has_keys && shape.form) add_form(shape.form());
        if (shape.kind != Shape::Kind::block) continue;
        if (const BlockType* kind = find_kind(session, where.path, block_type(where.text, keys)))
            for (const Field& field : kind->fields)
                if (field.direction != Direction::output && field.direction != Direction::local &&
                    field.global.empty())
                    to.add(field.name, Offered::field,
                           fmt::format("{} {}", name_of(field.direction),
                                       unit_of(session, where.path, keys[1], *kind, field)),
                           field.doc, std::string(field.name) + ": ");
    }
}

void add_signals(const Session& session, const std::string& path, const std::string& owner,
                 Offer& to) {
    const auto it = session.programs.find(path);
    if (it == session.programs.end()) return;
    const CheckedProgram& program = *it->second;
    for (const auto& [name, value] : program.program.inputs)
        to.add(owner == "inputs" ? name.text : "inputs." + name.text, Offered::variable, "input",
               "");
    for (const Instance& instance : program.net.instances) {
        if (!instance.type || (!owner.empty() && owner != instance.name)) continue;
        for (const Field& field : instance.type->fields)
            if (field.direction == Direction::output || field.direction == Direction::local)
                to.add(owner.empty() ? fmt::format("{}.{}", instance.name, field.name)
                                     : std::string(field.name),
                       Offered::variable,
                       fmt::format("{} {}", instance.type->name,
                                   unit_of(session, path, instance.name, *instance.type, field)),
                       field.doc);
    }
}

/// Those of one dimension: alone, and with what stands behind the first of the factors.
void add_units(std::string_view unit, Offer& to) {
    const auto wanted = Unit::parse(unit);
    const std::string others(unit.substr(std::min(unit.find('/'), unit.size())));
    std::set<std::string> names;
    for (const std::string& name : unit_names()) names.insert({name, name + others});
    for (const std::string& name : names)
        if (const auto known = Unit::parse(name); known && wanted && known->same_dimension(*wanted))
            to.add(name, Offered::unit, "", "");
}

/// The values of one that is an enumeration, where it is declared, or set: `inputs.mode: fast`.
void add_values_of_input(const CheckedProgram& program, const std::vector<std::string>& keys,
                         Offer& to) {
    const bool is_declared = keys.size() == 2 && keys[0] == "inputs";
    for (const InputNode& input : program.net.inputs)
        if (keys.back() == (is_declared ? input.name : "inputs." + input.name))
            for (const std::string_view name : input.field.names)
                to.add(name, Offered::enum_member, "", "");
}

void add_values(const Session& session, const Asked& where, const YamlPlace& place, Offer& to) {
    const std::string& key = place.keys.back();
    const std::size_t dot = place.written.rfind('.');
    const std::string owner = dot == std::string::npos ? "" : place.written.substr(0, dot);
    const auto known = session.programs.find(where.path);
    if (key == "type" && !place.keys.empty() && place.keys[0] == "blocks") {
        const auto add = [&](const Catalog& catalog) {
            for (const BlockType& type : catalog.types())
                to.add(type.name, Offered::class_, "", type.doc);
        };
        add(standard_blocks());
        if (known != session.programs.end() && known->second->net.kinds)
            add(*known->second->net.kinds);
        return;
    }
    const Key* said = nullptr;
    for (const Shape& shape : shapes_at(where.text, place.keys, &said)) {
        for (const std::string_view name : shape.names) to.add(name, Offered::value, "", "");
        if (shape.kind == Shape::Kind::boolean)
            for (const char* name : {"true", "false"}) to.add(name, Offered::value, "", "");
        if (shape.kind == Shape::Kind::time || shape.kind == Shape::Kind::share) add_units("s", to);
        if (shape.kind == Shape::Kind::signal) add_signals(session, where.path, owner, to);
        if (shape.kind == Shape::Kind::task && known != session.programs.end())
            for (const TaskPlan& task : known->second->program.tasks)
                to.add(task.name, Offered::value, "task", "");
    }
    if (known != session.programs.end()) add_values_of_input(*known->second, place.keys, to);
    if (place.keys.size() != 3 || place.keys[0] != "blocks") return;
    const BlockType* kind = find_kind(session, where.path, block_type(where.text, place.keys));
    const Field* field = kind ? kind->find_settable(key) : nullptr;
    if (!field) return;
    for (const std::string_view name : field->names) to.add(name, Offered::enum_member, "", "");
    if (!field->unit.empty())
        add_units(unit_of(session, where.path, place.keys[1], *kind, *field), to);
    if (field->direction == Direction::input) add_signals(session, where.path, owner, to);
    if (field->direction == Direction::in_out && known != session.programs.end())
        for (const Instance& instance : known->second->net.instances)
            if (instance.type && instance.type->name == field->refers)
                to.add(instance.name, Offered::variable, field->refers, "");
}

}  // namespace

YamlPlace place_at(const std::string& text, std::size_t offset) {
    const Scan scan = scan_to(text, offset);
    YamlPlace place;
    for (const Level& level : scan.levels)
        if (!level.key.empty()) place.keys.push_back(level.key);
    place.is_value = scan.is_value;
    place.written = scan.word;
    return place;
}

std::optional<YamlName> name_at(const std::string& text, std::size_t offset) {
    std::size_t begin = offset, end = offset;
    while (begin > 0 && is_of_name(text[begin - 1])) --begin;
    while (end < text.size() && is_of_name(text[end])) ++end;
    if (begin == end) return {};
    YamlName name;
    name.begin = begin, name.end = end;
    name.word = text.substr(begin, end - begin);
    const YamlPlace place = place_at(text, begin);
    name.keys = place.keys;
    name.is_key = !place.is_value;
    if (begin > 0 && text[begin - 1] == '.') {
        std::size_t first = begin - 1;
        while (first > 0 && is_of_name(text[first - 1])) --first;
        name.owner = text.substr(first, begin - 1 - first);
        name.port = name.word;
    } else if (name.is_key && place.keys.size() == 2 && place.keys[0] == "blocks") {
        name.owner = place.keys[1];
        name.port = name.word;
    } else {
        name.owner = name.word;
    }
    return name;
}

std::string kind_meant(const Session& session, const std::string& path, const YamlName& name) {
    const auto it = session.programs.find(path);
    if (it == session.programs.end()) return {};
    if (name.port.empty())
        return !name.is_key && !name.keys.empty() && name.keys.back() == "type" ? name.word
                                                                                : std::string();
    for (const BlockPlan& block : it->second->program.blocks)
        if (block.name.text == name.owner) return block.type.text;
    return {};
}

std::optional<Mark> declared_in_yaml(const Session& session, const Asked& where) {
    const auto name = name_at(where.text, where.offset);
    const auto it = session.programs.find(where.path);
    if (!name || it == session.programs.end()) return {};
    const Program& program = it->second->program;
    const bool is_port = !name->port.empty() && !name->is_key;
    if (is_port)
        for (const auto* list : {&program.inputs, &program.outputs})
            for (const auto& [key, value] : *list)
                if (name->owner == (list == &program.inputs ? "inputs" : "outputs") &&
                    key.text == name->port)
                    return key.mark;
    for (const BlockPlan& block : program.blocks)
        if (block.name.text == name->owner) return block.name.mark;
    for (const TaskPlan& task : program.tasks)
        if (task.name == name->word && task.mark.file && task.mark.file->path == where.path)
            return task.mark;
    if (const Node* parameters = program.root.find("parameters"))
        for (const auto& [key, value] : parameters->entries)
            if (key.text == name->word && name->begin > 0 && where.text[name->begin - 1] == '$')
                return key.mark;
    return {};
}

std::string about_yaml(const Session& session, const Asked& where) {
    const auto name = name_at(where.text, where.offset);
    if (!name) return {};
    std::vector<std::string> keys = name->keys;
    if (name->is_key) keys.push_back(name->word);
    if (!name->is_key && !keys.empty() && keys.back() == "type" && keys[0] == "blocks")
        if (const BlockType* kind = find_kind(session, where.path, name->word))
            return fmt::format("```\n{}```", block_text(*kind));
    const std::string type =
        name->is_key ? block_type(where.text, keys) : kind_meant(session, where.path, *name);
    if (const BlockType* kind = find_kind(session, where.path, type); kind && !name->port.empty()) {
        const Field* field =
            name->is_key ? kind->find_settable(name->port) : kind->find_readable(name->port);
        if (field)
            return about_field(*field, unit_of(session, where.path, name->owner, *kind, *field));
    }
    const Key* said = nullptr;
    if (name->is_key && !keys.empty()) shapes_at(where.text, keys, &said);
    if (!said) return {};
    std::string text = fmt::format("**{}**: {}", said->name, said->doc);
    if (!said->otherwise.empty()) text += fmt::format("\n\ndefault {}", said->otherwise);
    return text;
}

Json complete_yaml(const Session& session, const Asked& where) {
    const YamlPlace place = place_at(where.text, where.offset);
    Offer items(true);
    if (place.is_value && !place.keys.empty()) add_values(session, where, place, items);
    if (!place.is_value || place.keys.empty() || place.keys.back() == "[]")
        add_keys(session, where, place.keys, items);
    return items.take();
}

}  // namespace lineshaft::lsp
