#include "runtime/study/study_reader.hpp"

#include <set>

#include <fmt/format.h>

#include "runtime/csv/checksum.hpp"
#include "runtime/csv/csv_metadata.hpp"
#include "runtime/source/input_file.hpp"
#include "runtime/source/text_hash.hpp"
#include "runtime/study/study_file_reader.hpp"
#include "runtime/version.hpp"

namespace lineshaft {

namespace {

/// The hash is then that of all before and `text`.
void add(std::string& hash, const std::string& text) {
    hash = text_hash(hash + text);
}

/// The checksum of a file's bytes; of none where it cannot be read.
std::string checksum_of(const std::string& path) {
    Checksum checksum;
    InputFile file(path);
    std::vector<char> bytes(std::size_t{1} << 16);
    for (auto count = file.read(bytes.data(), bytes.size()); count > 0;
         count = file.read(bytes.data(), bytes.size()))
        checksum.add({bytes.data(), count});
    return checksum.text();
}

}  // namespace

Study StudyFileReader::read(std::shared_ptr<const SourceFile> file) {
    study_.file = file;
    const auto root = parse_yaml(file, read_.diagnostics());
    if (!root || !check_kind(read_, *root, "lineshaft_study")) return std::move(study_);
    StudyPlan plan;
    read_form(study_form(), read_, *root, plan);
    return read(std::move(file), std::move(plan));
}

Study StudyFileReader::read(std::shared_ptr<const SourceFile> file, StudyPlan plan) {
    plan_ = std::move(plan);
    study_.file = std::move(file);
    study_.title = plan_.title;
    study_.notes = plan_.notes;
    study_.include_dirs = options_.include_dirs;
    find_program();
    common_ = plan_.settings;
    common_.insert(common_.end(), options_.settings.begin(), options_.settings.end());
    for (const CasePlan& one : plan_.cases) one_case(one);
    for (const ClaimPlan& one : plan_.claims) claim(one);
    if (read_.diagnostics().empty()) study_.identity = identity();
    return std::move(study_);
}

void StudyFileReader::find_program() {
    const Node& node = plan_.program;
    checkable_ = false;
    if (node.is_empty()) return;
    Diagnostics& out = read_.diagnostics();
    const auto path =
        resolve_path(node.text, study_.file->path, options_.include_dirs, node.mark, out);
    if (!path) return;
    study_.program = *path;
    program_file_ = files_.source(*path, out, node.mark);
    checkable_ = program_file_ != nullptr;
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
    return file.has_key("lineshaft_study:");
}
bool is_program(const SourceFile& file) {
    return file.has_key("lineshaft:");
}

Study read_study(std::shared_ptr<const SourceFile> file, const LoadOptions& options,
                 const Catalog& catalog, Diagnostics& out, StudyCheck check) {
    return StudyFileReader(options, catalog, check, out).read(std::move(file));
}

Study read_study(std::shared_ptr<const SourceFile> file, StudyPlan plan, const LoadOptions& options,
                 const Catalog& catalog, Diagnostics& out) {
    return StudyFileReader(options, catalog, StudyCheck::values, out)
        .read(std::move(file), std::move(plan));
}

}  // namespace lineshaft
