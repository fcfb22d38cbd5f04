#include "tools/lineshaft/lsp/meanings.hpp"

#include <algorithm>
#include <bit>
#include <filesystem>

#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/st/library/fields.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/syntax/parser.hpp"
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

using Sources = std::vector<std::shared_ptr<const SourceFile>>;

bool is_of_tests(const std::string& root, const Sources& sources) {
    return is_structured_text(root) && !sources.empty() && st::is_test_file(sources.back());
}

std::shared_ptr<Meaning> make_meaning(const std::string& root, Sources sources) {
    auto made = std::make_shared<Meaning>();
    made->compiled.sources = std::move(sources);
    const Sources& all = made->compiled.sources;
    made->uses = st::understand(made->compiled, standard_blocks(),
                                is_of_tests(root, all) ? all.back().get() : nullptr);
    return made;
}

/// Where the lines begin that mistakes of a text stand in; empty: all of it can be read.
std::vector<std::size_t> mistakes_of(const SourceFile& file, st::SourceKind kind) {
    Diagnostics out;
    st::Tree tree;
    const auto source = std::make_shared<const SourceFile>(file);
    st::parse(st::read_tokens(source, out, kind), tree, out);
    std::vector<std::size_t> places;
    const Text lines(file.text);
    for (const Diagnostic& mistake : out.list()) {
        if (mistake.mark.file != source) continue;
        const std::size_t at = lines.bytes_of(mistake.mark).first;
        places.push_back(at == 0 ? 0 : file.text.rfind('\n', at - 1) + 1);
    }
    return places;
}

/// The last line that has something, before the one that begins at `line`; else that.
std::size_t line_before(std::string_view text, std::size_t line) {
    const std::size_t last = text.substr(0, line).find_last_not_of(" \t\r\n");
    if (last == text.npos) return line;
    const std::size_t begin = text.rfind('\n', last);
    return begin == text.npos ? 0 : begin + 1;
}

void make_blank(std::string& text, std::size_t line) {
    for (; line < text.size() && text[line] != '\n'; ++line)
        if (text[line] != '\r') text[line] = ' ';
}

/// With blanks for the lines that cannot be read, so that all other places stay: of what is half
/// written the line that is told, or the one before it.
std::shared_ptr<const SourceFile> mended(const std::shared_ptr<const SourceFile>& file,
                                         st::SourceKind kind) {
    constexpr int most_lines = 20;
    SourceFile made = *file;
    auto mistakes = mistakes_of(made, kind);
    for (int i = 0; i < most_lines && !mistakes.empty(); ++i) {
        SourceFile best = made;
        std::vector<std::size_t> left;
        for (const std::size_t line : {line_before(made.text, mistakes[0]), mistakes[0]}) {
            SourceFile without = made;
            make_blank(without.text, line);
            auto others = mistakes_of(without, kind);
            if (line == mistakes[0] || others.size() < mistakes.size()) {
                best = std::move(without);
                left = std::move(others);
                if (left.size() < mistakes.size()) break;
            }
        }
        made = std::move(best);
        mistakes = std::move(left);
    }
    return std::make_shared<const SourceFile>(std::move(made));
}

Sources mended_sources(const std::string& root, Sources sources) {
    const bool is_tests = is_of_tests(root, sources);
    for (auto& source : sources)
        source = mended(source, is_tests && source == sources.back() ? st::SourceKind::tests
                                                                     : st::SourceKind::program);
    return sources;
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
    const auto value = [&type](std::size_t i) {
        const auto bits = static_cast<std::uint64_t>(type.numbers[i]);
        return fmt::format(
            "{} = {}", type.values[i],
            st::to_string(st::whole_in(type.base ? type.base->plain() : type, bits)));
    };
    std::string text = fmt::format("```st\n{}\n```", st::describe(type));
    if (use.value) text = fmt::format("```st\n{}.{}\n```\n", type.name, value(*use.value)) + text;
    for (std::size_t i = 0; i < type.values.size(); ++i) text += "\n- " + value(i);
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

std::optional<std::size_t> offset_in(const SourceFile& source, const Asked& where) {
    const auto& parts = source.excerpts;
    if (parts.empty()) return where.offset;
    const Text text(where.text);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (!parts[i].is_copied) continue;
        const std::size_t end = i + 1 < parts.size() ? parts[i + 1].begin : source.text.size();
        const std::size_t first = text.bytes_of(parts[i].place).first;
        if (where.offset >= first && where.offset - first <= end - parts[i].begin)
            return parts[i].begin + where.offset - first;
    }
    return {};
}

const st::NameUse* Meaning::find(const Asked& where) const {
    const st::NameUse* found = nullptr;
    const st::Source* source = nullptr;
    std::optional<std::size_t> offset;
    for (const st::NameUse& use : uses) {
        if (!is_in(use.at, where.path)) continue;
        if (use.at.source != source) offset = offset_in(*use.at.source->file, where);
        source = use.at.source;
        if (offset && use.at.begin <= *offset && *offset <= use.at.end &&
            (!found || use.at.end - use.at.begin < found->at.end - found->at.begin))
            found = &use;
    }
    return found;
}

const st::Routine* Meaning::routine_at(const Asked& where) const {
    const st::Routine* found = nullptr;
    const std::string& path = where.path;
    std::size_t offset = where.offset;
    for (const auto& source : compiled.sources)  // which may be older: as far as it is the same
        if (std::filesystem::path(source->path).lexically_normal().string() == path &&
            source->text.size() != where.text.size()) {
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
    if (last != session.whole_meanings.end()) return last->second;
    auto& mended = session.mended_meanings[root];
    if (!mended) mended = make_meaning(root, mended_sources(root, now->compiled.sources));
    return mended;
}

std::shared_ptr<const Meaning> meaning_of(Session& session, const std::string& root) {
    if (const auto it = session.meanings.find(root); it != session.meanings.end())
        return it->second;
    const auto made = make_meaning(root, session.project.sources_of(root));
    session.meanings[root] = made;
    if (made->compiled.tree.lost.empty()) session.whole_meanings[root] = made;
    return made;
}

}  // namespace lineshaft::lsp
