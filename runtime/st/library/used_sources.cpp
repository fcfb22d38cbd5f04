#include "runtime/st/library/used_sources.hpp"

#include <algorithm>
#include <set>

#include "runtime/st/library/test_sources.hpp"

namespace lineshaft::st {

namespace {

using Texts = std::vector<std::shared_ptr<const SourceFile>>;

void add_all(Diagnostics& to, const Diagnostics& found) {
    for (const Diagnostic& d : found.warnings()) to.warn(d.code, d.mark, d.message, d.help);
    for (const Diagnostic& d : found.list()) to.add(d.code, d.mark, d.message, d.help);
}

bool is_of_project(const std::shared_ptr<const SourceFile>& source) {
    return !source->excerpts.empty();
}

/// In the order of the sources.
Texts used_of(const Texts& sources, const std::vector<std::string>& roots) {
    SourcePool pool;
    for (const auto& source : sources) pool.add(source);
    std::set<const SourceFile*> used;
    const auto add = [&](const Texts& texts) {
        for (const auto& text : texts) used.insert(text.get());
    };
    add(pool.needed_by(roots));
    for (const auto& source : sources)
        if (!is_of_project(source)) used.insert(source.get()), add(pool.needed_by(source));
    Texts kept = sources;
    std::erase_if(kept, [&](const auto& source) { return !used.contains(source.get()); });
    return kept;
}

/// The first of each file that has nothing which is used.
void warn_of_the_rest(Diagnostics& to, const Diagnostics& found, const Texts& sources,
                      const Texts& used) {
    std::set<std::string> files;
    for (const auto& source : sources) files.insert(source->path);
    for (const auto& source : used) files.erase(source->path);
    for (const Diagnostic& d : found.list())
        if (d.mark.file && files.erase(d.mark.file->path) > 0)
            to.warn(d.code, d.mark, d.message + ", in what nothing here uses", d.help);
}

}  // namespace

std::optional<Library> compile_used(const Texts& sources, const std::vector<std::string>& roots,
                                    const Catalog& standard, Diagnostics& out,
                                    const Options& options) {
    Diagnostics of_all;
    auto library = compile(sources, standard, of_all, options);
    const Texts used = library || roots.empty() ? sources : used_of(sources, roots);
    if (used.size() == sources.size() || used.empty()) {
        add_all(out, of_all);
        return library;
    }
    Diagnostics of_used;
    library = compile(used, standard, of_used, options);
    add_all(out, of_used);
    warn_of_the_rest(out, of_all, sources, used);
    return library;
}

}  // namespace lineshaft::st
