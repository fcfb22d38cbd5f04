#include "runtime/projects/plain_text.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>

#include "runtime/source/letters.hpp"
#include "runtime/source/paths.hpp"
#include "runtime/st/syntax/dialect.hpp"

namespace lineshaft::projects {

namespace fs = std::filesystem;

namespace {

bool is_plain(const SourceFile& source) {
    return source.read_as.empty() && st::is_plain_text(source.path);
}

std::shared_ptr<const SourceFile> read_as(const SourceFile& source, std::string_view ending) {
    SourceFile made = source;
    made.read_as = ending;
    return std::make_shared<const SourceFile>(std::move(made));
}

}  // namespace

void read_as_neighbours(std::vector<std::shared_ptr<const SourceFile>>& sources) {
    std::map<fs::path, std::string_view> folders;
    for (const auto& source : sources) {
        if (!is_plain(*source)) continue;
        const st::Vendor vendor = st::dialect_of(source->path, source->text).vendor;
        const fs::path folder = fs::path(source->path).parent_path();
        if (vendor == st::Vendor::matiec) folders[folder] = ".matiec";
        if (vendor == st::Vendor::codesys) folders.try_emplace(folder, ".codesys");
    }
    if (folders.empty()) return;
    for (auto& source : sources) {
        const auto folder = folders.find(fs::path(source->path).parent_path());
        if (folder != folders.end() && is_plain(*source)) source = read_as(*source, folder->second);
    }
}

void leave_out_repeated_exports(std::vector<std::shared_ptr<const SourceFile>>& sources) {
    constexpr std::size_t most_bytes = 1 << 30;  // that are compared
    std::vector<std::pair<std::string_view, std::size_t>> exports;
    for (std::size_t i = 0; i < sources.size(); ++i)
        if (extension_of(sources[i]->path) == ".exp")
            exports.emplace_back(trimmed(sources[i]->text, " \t\r\n"), i);
    std::ranges::stable_sort(exports, std::greater<>(),
                             [](const auto& e) { return e.first.size(); });
    std::vector<std::string_view> kept;
    std::vector<bool> is_repeated(sources.size());
    std::size_t bytes = 0, all = 0;
    for (const auto& [text, i] : exports) {
        is_repeated[i] = bytes < most_bytes && !text.empty() &&
                         std::ranges::any_of(kept, [&text = text](std::string_view larger) {
                             return larger.find(text) != larger.npos;
                         });
        bytes += all;
        if (is_repeated[i]) continue;
        kept.push_back(text);
        all += text.size();
    }
    std::erase_if(sources,
                  [&, i = std::size_t{0}](const auto&) mutable { return is_repeated[i++]; });
}

void read_plain_text_as(std::string_view ending,
                        std::vector<std::shared_ptr<const SourceFile>>& sources) {
    for (auto& source : sources)
        if (is_plain(*source)) source = read_as(*source, ending);
}

}  // namespace lineshaft::projects
