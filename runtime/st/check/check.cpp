#include "runtime/st/check/check.hpp"

#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/configuration.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/dynamic_memory.hpp"
#include "runtime/st/check/image.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/statements.hpp"

namespace lineshaft::st {

namespace {

/// Once for all libraries of a project that are not here.
void tell_missing_libraries(Checking& c) {
    constexpr std::size_t most_shown = 12;
    if (c.foreign.empty()) return;
    std::vector<std::string> names, libraries;
    for (const auto& [name, place] : c.foreign) {
        const Mark mark = place.mark();
        names.push_back(fmt::format("{} ({}:{})", name, mark.file->path, mark.line));
    }
    for (const LibraryReference& missing : c.missing_libraries) libraries.push_back(missing.name);
    std::ranges::sort(names);
    const std::size_t more = names.size() - std::min(names.size(), most_shown);
    names.resize(names.size() - more);
    if (more > 0) names.push_back(fmt::format("and {} more", more));
    c.out.add(
        code::library_is_missing, c.missing_libraries.front().mark,
        fmt::format("{} that nobody declares may be of libraries that are not here: {}",
                    c.foreign.size() == 1 ? "a name" : fmt::format("{} names", c.foreign.size()),
                    fmt::join(libraries, ", ")),
        fmt::format("give their sources, too: `sources:` takes several projects; {}",
                    fmt::join(names, ", ")));
}

}  // namespace

Checked check(Tree& tree, const Catalog& catalog, Evaluate evaluate, Diagnostics& out,
              std::span<const LibraryReference> missing, std::vector<NameUse>* uses) {
    Checking c{tree, catalog, evaluate, out};
    c.missing_libraries = missing;
    c.uses = uses;
    make_sums_of_timers(c);
    add_configured_programs(c);
    collect_names(c);
    resolve_bases(c);
    declare_globals(c);
    declare_routines(c);
    check_classes(c);
    configure_programs(c);
    check_initial_values(c);
    for (std::size_t i = 0; i < c.checked.routines.size(); ++i)  // they become more
        check_body(c, c.checked.routines[i]);
    write_deletions(c);
    if (out.empty()) write_serializations(c);
    tell_missing_libraries(c);
    finish_image(c);
    order_routines(c);
    share_eno(c);
    if (out.empty()) warn_of_usings(c), warn_of_unused(c);
    return std::move(c.checked);
}

}  // namespace lineshaft::st
