#pragma once

#include <map>
#include <string>

#include "tools/lineshaft/lsp/positions.hpp"

namespace lineshaft::lsp {

/// A file as the editor has it.
struct Document {
    std::string uri;  ///< as the editor writes it
    std::string path;
    std::string text;
    Json version;
};

/// What is open. Whoever reads one of these files gets its text (lay_over()).
class Documents {
  public:
    ~Documents();
    /// Null for what is no file.
    const Document* open(const Json& item);
    /// `contentChanges`, one behind the other. Null: it is not open.
    const Document* change(const std::string& uri, const Json& version, const Json& changes,
                           Encoding encoding);
    void close(const std::string& path);

    const Document* find(const std::string& path) const;
    const std::map<std::string, Document>& all() const { return documents_; }
    /// As the editor wrote it, if it did.
    std::string uri(const std::string& path) const;

  private:
    std::map<std::string, Document> documents_;  ///< by path
};

}  // namespace lineshaft::lsp
