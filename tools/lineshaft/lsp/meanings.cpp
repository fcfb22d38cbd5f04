#include "tools/lineshaft/lsp/meanings.hpp"

#include <algorithm>
#include <bit>
#include <filesystem>

#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/st/library/fields.hpp"
#include "runtime/st/types/elementary.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::lsp {

namespace {

constexpr std::string_view sections[] = {"VAR_INPUT",    "VAR_OUTPUT", "VAR_IN_OUT",
                                         "VAR",          "VAR_TEMP",   "VAR_GLOBAL",
                                         "VAR_EXTERNAL", "result",     "VAR_INST"};

std::string value_of(const st::Variable& variable) {
    if (variable.space != st::Space::constant || !variable.type) return {};
    const st::Type& type = *variable.type;
    if (type.kind == st::Type::Kind::text) return st::text_literal(variable.value.text);
    const bool is_real = type.kind == st::Type::Kind::real;
    return st::value_text(type, is_real ? std::bit_cast<std::uint64_t>(variable.value.real)
                                        : static_cast<std::uint64_t>(variable.value.integer));
}

std::string about_variable(const st::Variable& v) {
    std::string text = fmt::format("{} : {}", v.text, v.type ? st::describe(*v.type) : "?");
    if (const std::string value = value_of(v); !value.empty()) text += " := " + value;
    text = fmt::format("```st\n{}\n```\n{}", text, sections[static_cast<std::size_t>(v.section)]);
    if (v.constant) text += " CONSTANT";
    if (!v.unit.empty()) text += fmt::format(", unit {}", v.unit);
    if (!v.doc.empty()) text += "\n\n" + st::text_of_comments(v.doc);
    return text;
}

}  // namespace

bool is_in(const st::Place& place, const std::string& path) {
    return place.source && place.source->is_users() &&
           std::filesystem::path(place.source->file->path).lexically_normal().string() == path;
}

std::string about(const st::NameUse& use) {
    if (use.variable) return about_variable(*use.variable);
    if (use.routine) {
        std::string text = fmt::format("```st\n{}\n```", signature_of(*use.routine));
        if (!use.routine->pou->doc.empty())
            text += "\n" + st::text_of_comments(use.routine->pou->doc);
        return text;
    }
    const st::Type& type = *use.type;
    std::string text = fmt::format("```st\n{}\n```", st::describe(type));
    for (std::size_t i = 0; i < type.values.size(); ++i)
        text += fmt::format("\n- {} = {}", type.values[i], type.numbers[i]);
    for (const st::Variable* member : type.members)
        text += fmt::format("\n- {} : {}", member->text,
                            member->type ? st::describe(*member->type) : "?");
    return text;
}

std::string signature_of(const st::Routine& routine) {
    constexpr std::string_view kinds[] = {"PROGRAM", "FUNCTION_BLOCK", "FUNCTION",
                                          "METHOD",  "DATA_BLOCK",     "INTERFACE"};
    std::string text =
        fmt::format("{} {}(", kinds[static_cast<std::size_t>(routine.pou->kind)], routine.name);
    std::string_view between;
    for (const st::Variable* v : parameters_of(routine)) {
        text += fmt::format("{}{} : {}", between, v->text, v->type ? st::describe(*v->type) : "?");
        between = "; ";
    }
    text += ")";
    if (routine.result && routine.result->type) text += " : " + st::describe(*routine.result->type);
    return text;
}

std::vector<const st::Variable*> parameters_of(const st::Routine& routine) {
    std::vector<const st::Variable*> found;
    for (const st::Variable* v : st::all_variables(routine))
        if (v->section == st::Section::input || v->section == st::Section::in_out ||
            v->section == st::Section::output)
            found.push_back(v);
    return found;
}

const st::NameUse* Meaning::find(const std::string& path, std::size_t offset) const {
    const st::NameUse* found = nullptr;
    for (const st::NameUse& use : uses)
        if (use.at.begin <= offset && offset <= use.at.end && is_in(use.at, path) &&
            (!found || use.at.end - use.at.begin < found->at.end - found->at.begin))
            found = &use;
    return found;
}

const st::Routine* Meaning::routine_at(const Asked& where) const {
    const st::Routine* found = nullptr;
    const std::string& path = where.path;
    std::size_t offset = where.offset;
    for (const auto& source : compiled.sources)  // which may be older: as far as it is the same
        if (std::filesystem::path(source->path).lexically_normal().string() == path) {
            const auto changed = std::ranges::mismatch(source->text, where.text).in1;
            offset = std::min(offset, static_cast<std::size_t>(changed - source->text.begin()));
        }
    for (const st::Routine& routine : compiled.checked.routines) {
        const st::Place& at = routine.pou->name.place;
        if (at.begin <= offset && is_in(at, path) &&
            (!found || at.begin > found->pou->name.place.begin))
            found = &routine;
    }
    return found;
}

const st::Routine* Meaning::find_block(std::string_view name) const {
    for (const st::Routine& routine : compiled.checked.routines)
        if (routine.has_instances() && !routine.owner && st::same_name(routine.name, name))
            return &routine;
    return nullptr;
}

std::shared_ptr<const Meaning> whole_meaning_of(Session& session, const std::string& root) {
    const auto now = meaning_of(session, root);
    const auto last = session.whole_meanings.find(root);
    return last == session.whole_meanings.end() ? now : last->second;
}

std::shared_ptr<const Meaning> meaning_of(Session& session, const std::string& root) {
    if (const auto it = session.meanings.find(root); it != session.meanings.end())
        return it->second;
    auto made = std::make_shared<Meaning>();
    made->compiled.sources = session.project.sources_of(root);
    const auto& sources = made->compiled.sources;
    const bool is_tests =
        is_structured_text(root) && !sources.empty() && st::is_test_file(sources.back());
    made->uses = st::understand(made->compiled, standard_blocks(),
                                is_tests ? sources.back().get() : nullptr);
    session.meanings[root] = made;
    if (made->compiled.tree.lost.empty()) session.whole_meanings[root] = made;
    return made;
}

}  // namespace lineshaft::lsp
