#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/source/yaml.hpp"

namespace lineshaft {

/// YAML files that are read and parsed once, for a program that is loaded many times with other
/// settings. For one thread. A file with a mistake is read anew each time, so that it is reported
/// each time.
class YamlFiles {
  public:
    /// As read_source().
    std::shared_ptr<const SourceFile> source(const std::string& path, Diagnostics& out,
                                             Mark where = {});

    using Texts = std::vector<std::shared_ptr<const SourceFile>>;
    /// What `read` makes of a path, once. It tells in `out` what is wrong.
    Texts texts(const std::string& path, const std::function<Texts()>& read, Diagnostics& out);

    /// As parse_yaml().
    std::optional<Node> parse(const std::shared_ptr<const SourceFile>& file, Diagnostics& out);

    /// All that were read, by path.
    std::vector<std::shared_ptr<const SourceFile>> sources() const;

  private:
    std::map<std::string, std::shared_ptr<const SourceFile>> sources_;
    std::map<std::string, Texts> texts_;
    std::map<std::shared_ptr<const SourceFile>, Node> roots_;
};

}  // namespace lineshaft
