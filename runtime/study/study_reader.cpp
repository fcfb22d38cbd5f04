#include "runtime/study/study_reader.hpp"

#include <fstream>
#include <set>

#include <fmt/format.h>

#include "runtime/csv/checksum.hpp"
#include "runtime/csv/csv_metadata.hpp"
#include "runtime/source/text_hash.hpp"
#include "runtime/study/study_file_reader.hpp"
#include "runtime/version.hpp"

namespace lineshaft {

namespace {

/// At the beginning of a line.
bool has_key(const std::string& text, const std::string& key) {
    return text.starts_with(key) || text.find("\n" + key) != std::string::npos;
}

/// Of all before and `text`.
void add(std::string& hash, const std::string& text) {
    hash = text_hash(hash + text);
}

/// Of a file's bytes; of none where it cannot be read.
std::string checksum_of(const std::string& path) {
    Checksum checksum;
    std::ifstream file(path, std::ios::binary);
    std::vector<char> bytes(std::size_t{1} << 16);
    while (file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())), file.gcount() > 0)
        checksum.add({bytes.data(), static_cast<std::size_t>(file.gcount())});
    return checksum.text();
}

}  // namespace

Study StudyFileReader::read(std::shared_ptr<const SourceFile> file) {
    const auto root = parse_yaml(file, read_.diagnostics());
    if (!root || !check_kind(read_, *root, "lineshaft_study")) {
        study_.file = std::move(file);
        return std::move(study_);
    }
    return read(std::move(file), *root);
}

Study StudyFileReader::read(std::shared_ptr<const SourceFile> file, const Node& root) {
    study_.file = std::move(file);
    study_.include_dirs = options_.include_dirs;
    read_.only_keys(root, "a study",
                    {"lineshaft_study", "title", "program", "notes", "set", "repeat", "compare",
                     "cases", "claims"});
    if (const Node* n = root.find("title"); n && read_.expect_scalar(*n, "the title"))
        study_.title = n->text;
    program(root);
    if (const Node* n = root.find("notes")) notes(*n);
    if (const Node* n = root.find("set")) settings(*n, common_);
    common_.insert(common_.end(), options_.settings.begin(), options_.settings.end());
    if (const Node* n = root.find("repeat"))
        common_repeat_ = positive(*n, "a case runs at least once");
    if (const Node* n = root.find("compare")) comparisons(*n, common_comparisons_);
    if (const Node* n = read_.require(root, "cases", "a study")) cases(*n);
    if (const Node* n = root.find("claims")) claims(*n);
    if (read_.diagnostics().empty()) study_.identity = identity();
    return std::move(study_);
}

void StudyFileReader::program(const Node& root) {
    const Node* node = read_.require(root, "program", "a study");
    checkable_ = false;
    if (!node || !read_.expect_scalar(*node, "'program'")) return;
    Diagnostics& out = read_.diagnostics();
    const auto path =
        resolve_path(node->text, study_.file->path, options_.include_dirs, node->mark, out);
    if (!path) return;
    study_.program = *path;
    program_file_ = files_.source(*path, out, node->mark);
    checkable_ = program_file_ != nullptr;
}

void StudyFileReader::notes(const Node& node) {
    if (node.is_scalar()) return study_.notes.push_back(node.text);
    if (!read_.expect_sequence(node, "'notes'")) return;
    for (const Node& item : node.items)
        if (read_.expect_scalar(item, "a note")) study_.notes.push_back(item.text);
}

std::string StudyFileReader::identity() {
    std::string hash;
    add(hash, version());
    add(hash, study_.file->text);
    for (const Setting& s : options_.settings) add(hash, s.name + "=" + s.value);
    add(hash, program_file_->text);
    add_files(hash);
    return hash;
}

/// Its controller and what it replays, each with the sidecar that it may have.
void StudyFileReader::add_files(std::string& hash) {
    Diagnostics unread;  // then the cases that name them tell it
    const auto root = files_.parse(program_file_, unread);
    if (!root) return;
    std::vector<const Node*> named{root->find("controller")};
    if (const Node* stimuli = root->find("stimulus"))
        for (const Node& item : stimuli->items) named.push_back(item.find("file"));
    for (const Node* node : named) {
        if (!node) continue;
        for (const std::string& value : choices(*root, *node)) {
            const auto path =
                resolve_path(value, program_file_->path, options_.include_dirs, node->mark, unread);
            if (path) add(hash, checksum_of(*path) + checksum_of(sidecar_path(*path)));
        }
    }
}

/// All that a case may choose for `node`, whether it is among those at hand or not.
std::set<std::string> StudyFileReader::choices(const Node& root, const Node& node) const {
    if (!node.text.starts_with('$')) return {node.text};
    const std::string parameter = node.text.substr(1);
    const Node* parameters = root.find("parameters");
    const Node* usual = parameters ? parameters->find(parameter) : nullptr;
    std::set<std::string> values{usual ? usual->text : ""};
    const auto take = [&](const Setting& s) {
        if (s.name == parameter) values.insert(s.value);
    };
    for (const CaseGroup& group : study_.groups) {
        for (const Setting& s : group.settings) take(s);
        for (const GridAxis& axis : group.grid)
            for (const Setting& s : axis.values) take(s);
        for (const RandomParameter& p : group.random)
            if (p.name == parameter) values.insert(p.choices.begin(), p.choices.end());
    }
    return values;
}

bool is_study(const SourceFile& file) {
    return has_key(file.text, "lineshaft_study:");
}
bool is_program(const SourceFile& file) {
    return has_key(file.text, "lineshaft:");
}

Study read_study(std::shared_ptr<const SourceFile> file, const LoadOptions& options,
                 const Catalog& catalog, Diagnostics& out, StudyCheck check) {
    return StudyFileReader(options, catalog, check, out).read(std::move(file));
}

Study read_study(std::shared_ptr<const SourceFile> file, const Node& root,
                 const LoadOptions& options, const Catalog& catalog, Diagnostics& out) {
    return StudyFileReader(options, catalog, StudyCheck::values, out).read(std::move(file), root);
}

}  // namespace lineshaft
