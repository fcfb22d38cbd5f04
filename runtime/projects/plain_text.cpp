#include "runtime/projects/plain_text.hpp"

#include <filesystem>
#include <map>

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
        if (vendor == st::Vendor::codesys) folders.try_emplace(folder, ".exp");
    }
    if (folders.empty()) return;
    for (auto& source : sources) {
        const auto folder = folders.find(fs::path(source->path).parent_path());
        if (folder != folders.end() && is_plain(*source)) source = read_as(*source, folder->second);
    }
}

void read_plain_text_as(std::string_view ending,
                        std::vector<std::shared_ptr<const SourceFile>>& sources) {
    for (auto& source : sources)
        if (is_plain(*source)) source = read_as(*source, ending);
}

}  // namespace lineshaft::projects
