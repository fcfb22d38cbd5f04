#include "runtime/study/study_reader.hpp"

#include <set>

#include <fmt/format.h>

#include "runtime/study/study_file_reader.hpp"
#include "runtime/trace/csv_writer.hpp"
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
    add_controllers(hash);
    return hash;
}

/// All that a case may choose, whether it is among those at hand or not.
void StudyFileReader::add_controllers(std::string& hash) {
    Diagnostics unread;  // then the cases that name them tell it
    const auto root = files_.parse(program_file_, unread);
    const Node* named = root ? root->find("controller") : nullptr;
    if (!named) return;
    std::set<std::string> values{named->text};
    if (named->text.starts_with('$')) {
        const std::string parameter = named->text.substr(1);
        const auto take = [&](const Setting& s) {
            if (s.name == parameter) values.insert(s.value);
        };
        const Node* parameters = root->find("parameters");
        const Node* usual = parameters ? parameters->find(parameter) : nullptr;
        values = {usual ? usual->text : ""};
        for (const CaseGroup& group : study_.groups) {
            for (const Setting& s : group.settings) take(s);
            for (const GridAxis& axis : group.grid)
                for (const Setting& s : axis.values) take(s);
            for (const RandomParameter& p : group.random)
                if (p.name == parameter) values.insert(p.choices.begin(), p.choices.end());
        }
    }
    for (const std::string& value : values) {
        const auto path =
            resolve_path(value, program_file_->path, options_.include_dirs, named->mark, unread);
        const auto file = path ? files_.source(*path, unread) : nullptr;
        if (file) add(hash, file->text);
    }
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
