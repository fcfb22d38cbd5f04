#include "runtime/source/yaml_files.hpp"

namespace lineshaft {

std::shared_ptr<const SourceFile> YamlFiles::source(const std::string& path, Diagnostics& out,
                                                    Mark where) {
    if (const auto it = sources_.find(path); it != sources_.end()) return it->second;
    auto file = read_source(path, out, std::move(where));
    if (file) sources_.emplace(path, file);
    return file;
}

YamlFiles::Texts YamlFiles::texts(const std::string& path, const std::function<Texts()>& read,
                                  Diagnostics& out) {
    if (const auto it = texts_.find(path); it != texts_.end()) return it->second;
    const std::size_t before = out.count();
    Texts made = read();
    if (out.count() == before) texts_.emplace(path, made);
    return made;
}

std::optional<Node> YamlFiles::parse(const std::shared_ptr<const SourceFile>& file,
                                     Diagnostics& out) {
    if (const auto it = roots_.find(file); it != roots_.end()) return it->second;
    const std::size_t before = out.count();
    auto root = parse_yaml(file, out);
    if (root && out.count() == before) roots_.emplace(file, *root);
    return root;
}

std::vector<std::shared_ptr<const SourceFile>> YamlFiles::sources() const {
    std::vector<std::shared_ptr<const SourceFile>> all;
    for (const auto& [path, file] : sources_) all.push_back(file);
    return all;
}

}  // namespace lineshaft
