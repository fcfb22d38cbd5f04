#include "tools/lineshaft/check_project.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/program/whole_project.hpp"
#include "runtime/projects/solution.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/st/library/used_sources.hpp"
#include "tools/lineshaft/check_apart.hpp"
#include "tools/lineshaft/once.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t most_causes = 30;

/// A message without what it quotes: the same for all names.
std::string cause_of(const Diagnostic& diagnostic) {
    std::string cause = diagnostic.code + " ";
    bool is_quoted = false;
    for (const char c : diagnostic.message) {
        if (c == '\'' && !is_quoted) cause += "'...'";
        if (c == '\'')
            is_quoted = !is_quoted;
        else if (!is_quoted)
            cause += c;
    }
    return cause;
}

/// The line of a file at which what a text of the project has of it begins.
struct Part {
    std::size_t source = 0;
    int first = 0;
};

using PartsOfFiles = std::map<std::string, std::vector<Part>>;

PartsOfFiles parts_of(const WholeProject& project) {
    PartsOfFiles parts;
    for (std::size_t i = 0; i < project.own; ++i) {
        const SourceFile& source = *project.project.sources[i];
        std::map<std::string, int> firsts;
        if (source.excerpts.empty()) firsts[source.path] = 1;
        for (const auto& [begin, place, is_copied] : source.excerpts) {
            const std::string& file = place.file ? place.file->path : source.path;
            int& first = firsts.try_emplace(file, place.line).first->second;
            first = std::min(first, place.line);
        }
        for (const auto& [file, first] : firsts) parts[file].push_back({i, first});
    }
    return parts;
}

/// Texts of the project with a mistake in them, or a name of a library that is not here. The last
/// that begins before the mistake has it.
std::set<std::size_t> with_mistakes(const WholeProject& project, const Diagnostics& out,
                                    const std::set<const SourceFile*>& foreign) {
    const PartsOfFiles parts = parts_of(project);
    std::set<std::size_t> wrong;
    for (std::size_t i = 0; i < project.own; ++i)
        if (foreign.contains(project.project.sources[i].get())) wrong.insert(i);
    for (const Diagnostic& diagnostic : out.list()) {
        const auto file =
            diagnostic.mark.file ? parts.find(diagnostic.mark.file->path) : parts.end();
        if (file == parts.end()) continue;
        const Part* found = nullptr;
        for (const Part& part : file->second)
            if (part.first <= diagnostic.mark.line && (!found || part.first > found->first))
                found = &part;
        if (found) wrong.insert(found->source);
    }
    return wrong;
}

struct Cause {
    std::size_t places = 0;
    std::set<std::string> files;
    const Diagnostic* first = nullptr;
};

bool is_before(const Diagnostic& a, const Diagnostic& b) {
    const auto key = [](const Diagnostic& d) {
        return std::make_tuple(d.mark.file ? d.mark.file->path : "", d.mark.line, d.mark.column);
    };
    return key(a) < key(b);
}

std::string table_of(const Diagnostics& out) {
    std::map<std::string, Cause> causes;
    for (const Diagnostic& diagnostic : out.list()) {
        Cause& cause = causes[cause_of(diagnostic)];
        ++cause.places;
        if (diagnostic.mark.file) cause.files.insert(diagnostic.mark.file->path);
        if (!cause.first || is_before(diagnostic, *cause.first)) cause.first = &diagnostic;
    }
    std::vector<std::pair<std::string, const Cause*>> sorted;
    for (const auto& [text, cause] : causes) sorted.emplace_back(text, &cause);
    std::ranges::stable_sort(sorted, [](const auto& a, const auto& b) {
        return std::make_pair(a.second->files.size(), a.second->places) >
               std::make_pair(b.second->files.size(), b.second->places);
    });
    std::string text = "  files  places  cause, and where it is first\n";
    for (std::size_t i = 0; i < std::min(sorted.size(), most_causes); ++i) {
        const Cause& cause = *sorted[i].second;
        text += fmt::format("{:>7} {:>7}  {}\n", cause.files.size(), cause.places, sorted[i].first);
        if (const Mark& mark = cause.first->mark; mark.file)
            text += fmt::format("{:17}{}:{}:{}\n", "", mark.file->path, mark.line, mark.column);
    }
    if (sorted.size() > most_causes)
        text += fmt::format("... and {} more causes\n", sorted.size() - most_causes);
    if (out.count() > out.list().size())
        text += fmt::format("... and {} more places, which are not counted here\n",
                            out.count() - out.list().size());
    return text;
}

}  // namespace

bool is_project(const std::string& path) {
    std::error_code error;
    const auto is_other = [](const std::string& file) {
        return projects::is_source(file) && !is_structured_text(file);
    };
    if (!std::filesystem::is_directory(path, error)) {
        const std::string ending = std::filesystem::path(path).extension().string();
        return projects::is_solution(path) ||
               (is_other(path) && (ending == ".plcproj" || ending == ".xml"));
    }
    const auto files = projects::sources_below(path, error);
    return std::ranges::any_of(files, is_other);
}

std::string check_project(const std::string& path, const LoadOptions& options, Diagnostics& out) {
    Once once(out);
    std::size_t whole = 0, wrong = 0, tasks = 0, libraries = 0;
    Diagnostics unread;
    const std::vector<WholeProject> all = read_projects(path, options.include_dirs, unread);
    once.add(unread);
    for (const WholeProject& each : all) {
        Diagnostics found;
        std::set<const SourceFile*> foreign;
        st::compile_used(
            each.project.sources, task_programs(each.project), standard_blocks(), found,
            {.references = references_of(each.project), .addresses = {}, .foreign = &foreign});
        if (each.path == path || std::filesystem::is_directory(each.path))
            found = without_neighbours(each.project.sources, found);
        whole += each.own;
        wrong += with_mistakes(each, found, foreign).size();
        tasks += each.project.tasks.size();
        libraries += each.project.libraries.size();
        once.add(found);
    }
    std::string page =
        fmt::format("{}: {} of {} POUs, types and lists have no mistake; {} tasks, {} libraries\n",
                    path, whole - wrong, whole, tasks, libraries);
    if (all.size() > 1) page += fmt::format("  {} projects\n", all.size());
    if (!out.empty()) page += table_of(out);
    return page;
}

}  // namespace lineshaft
