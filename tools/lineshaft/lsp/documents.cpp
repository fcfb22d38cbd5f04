#include "tools/lineshaft/lsp/documents.hpp"

#include <algorithm>

#include "runtime/source/input_file.hpp"

namespace lineshaft::lsp {

Documents::~Documents() {
    for (const auto& [path, document] : documents_) lay_over(path, {});
}

const Document* Documents::open(const Json& item) {
    const std::string uri = item.at("uri").get<std::string>(), path = path_of(uri);
    if (path.empty()) return nullptr;
    Document& document = documents_[path];
    document = {uri, path, item.at("text").get<std::string>(), item.value("version", Json())};
    lay_over(path, document.text);
    return &document;
}

const Document* Documents::change(const std::string& uri, const Json& version, const Json& changes,
                                  Encoding encoding) {
    const auto found = documents_.find(path_of(uri));
    if (found == documents_.end()) return nullptr;
    Document& document = found->second;
    for (const Json& change : changes) {
        const std::string text = change.at("text").get<std::string>();
        if (!change.contains("range")) {
            document.text = text;
            continue;
        }
        const Text before(document.text);
        const std::size_t begin = before.offset(change.at("range").at("start"), encoding);
        const std::size_t end = before.offset(change.at("range").at("end"), encoding);
        document.text.replace(begin, std::max(begin, end) - begin, text);
    }
    document.version = version;
    lay_over(document.path, document.text);
    return &document;
}

void Documents::close(const std::string& path) {
    if (documents_.erase(path) > 0) lay_over(path, {});
}

const Document* Documents::find(const std::string& path) const {
    const auto found = documents_.find(path);
    return found == documents_.end() ? nullptr : &found->second;
}

std::string Documents::uri(const std::string& path) const {
    const Document* document = find(path);
    return document ? document->uri : uri_of(path);
}

}  // namespace lineshaft::lsp
