#include <algorithm>
#include <filesystem>
#include <set>

#include "tools/lineshaft/lsp/meanings.hpp"

namespace lineshaft::lsp {

namespace {

constexpr int error_severity = 1, warning_severity = 2;

auto place_of(const Diagnostic& d) {
    return std::make_tuple(d.mark.line, d.mark.column, std::string_view(d.code),
                           std::string_view(d.message));
}

}  // namespace

Json to_json(const Session& session, const Diagnostic& d) {
    const Json range = range_of(d.mark, session.encoding);
    Json made{{"range", range},
              {"severity", d.is_warning ? warning_severity : error_severity},
              {"code", d.code},
              {"source", "lineshaft"},
              {"message", d.whole_message()}};
    if (d.help.empty()) return made;
    made["data"] = d.help;
    if (!session.takes_related_information)
        made["message"] = d.whole_message() + "\n" + d.help;
    else if (d.mark.file)
        made["relatedInformation"] = Json::array(
            {{{"location", {{"uri", session.documents.uri(d.mark.file->path)}, {"range", range}}},
              {"message", d.help}}});
    return made;
}

void Diagnosis::change(const std::string& path) {
    session_.project.change(path);
    session_.meanings.clear();
    session_.mended_meanings.clear();
    std::set<std::string> wanted;
    std::deque<std::string> first;
    for (const auto& [open, document] : session_.documents.all())
        for (const std::string& root : session_.project.roots_of(open)) {
            if (wanted.insert(root).second && open != path) waiting_.push_back(root);
            if (open == path) first.push_back(root);
        }
    std::erase_if(waiting_, [&](const std::string& root) {
        return !wanted.contains(root) || std::ranges::find(first, root) != first.end();
    });
    std::ranges::sort(waiting_);
    waiting_.erase(std::unique(waiting_.begin(), waiting_.end()), waiting_.end());
    waiting_.insert(waiting_.begin(), first.begin(), first.end());
    std::set<std::string> changed;
    for (auto it = found_.begin(); it != found_.end();) {
        if (wanted.contains(it->first)) {
            ++it;
            continue;
        }
        for (const auto& [file, list] : it->second) changed.insert(file);
        it = found_.erase(it);
    }
    for (const std::string& file : changed) publish(file);
}

void Diagnosis::close(const std::string& path) {
    change(path);
    publish(path);
}

bool Diagnosis::work() {
    if (waiting_.empty()) return false;
    const std::string root = waiting_.front();
    waiting_.pop_front();
    check(root);
    return true;
}

void Diagnosis::check(const std::string& root) {
    Diagnostics out;
    if (auto checked = session_.project.check(root, out)) {
        const bool has_kinds = checked->program.texts.empty() || checked->net.kinds;
        if (has_kinds && !checked->program.blocks.empty())
            session_.programs[root] = std::make_shared<const CheckedProgram>(std::move(*checked));
    }
    meaning_of(session_, root);  // as long as it is whole
    std::set<std::string> files{root};
    Found& found = found_[root];
    for (const auto& [file, list] : found) files.insert(file);
    found.clear();
    for (const Diagnostic& d : out.empty() ? out.warnings() : out.list()) {
        const std::string path =
            d.mark.file ? std::filesystem::path(d.mark.file->path).lexically_normal().string()
                        : root;
        found[path].push_back(d);
        files.insert(path);
    }
    for (const auto& [path, document] : session_.documents.all()) {
        const auto roots = session_.project.roots_of(path);
        if (std::ranges::find(roots, root) != roots.end()) files.insert(path);
    }
    for (const std::string& file : files) publish(file);
}

void Diagnosis::publish(const std::string& path) {
    std::vector<const Diagnostic*> all;
    for (const auto& [root, found] : found_)
        if (const auto it = found.find(path); it != found.end())
            for (const Diagnostic& d : it->second) all.push_back(&d);
    std::ranges::stable_sort(all, {}, [](const Diagnostic* d) { return place_of(*d); });
    const auto is_same = [](const auto* a, const auto* b) { return place_of(*a) == place_of(*b); };
    all.erase(std::unique(all.begin(), all.end(), is_same), all.end());
    Json message{{"uri", session_.documents.uri(path)}, {"diagnostics", Json::array()}};
    const Document* document = session_.documents.find(path);
    if (document && !document->version.is_null()) message["version"] = document->version;
    for (const Diagnostic* d : all) message["diagnostics"].push_back(to_json(session_, *d));
    const auto told = told_.find(path);
    const bool is_first = told == told_.end();
    if (is_first ? all.empty() && !document : told->second == message) return;
    session_.send(
        {{"jsonrpc", "2.0"}, {"method", "textDocument/publishDiagnostics"}, {"params", message}});
    told_[path] = message;
}

}  // namespace lineshaft::lsp
