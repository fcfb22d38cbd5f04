#include <algorithm>
#include <filesystem>
#include <set>

#include <fmt/core.h>

#include "blocks/catalog.hpp"
#include "runtime/source/encoding.hpp"
#include "tools/lineshaft/check_apart.hpp"
#include "tools/lineshaft/check_file.hpp"
#include "tools/lineshaft/check_project.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/once.hpp"
#include "tools/lineshaft/test_files.hpp"

namespace lineshaft {

namespace {

struct CheckCommand {
    CommonOptions common;
    std::vector<std::string> files;
    bool strict = false;
};

/// All below a folder: programs, studies, fits, TESTs, and what is left of Structured Text, a file
/// with those that declare what it names. How many files there were.
std::size_t check_folder(const std::string& folder, const LoadOptions& options, Diagnostics& out) {
    std::size_t files = 0;
    std::set<std::string> seen;  // sources that a program has
    st::SourcePool pool;
    Once once(out);
    for (const TestFile& test : find_tests(folder, {})) {
        ++files;
        Diagnostics found;
        const auto source = is_structured_text(test.path) ? read_source(test.path, found) : nullptr;
        if (source && has_tests(source))
            compile_tests(test, source, found);
        else if (projects::is_source(test.path))
            --files;  // one of the sources below
        else if (const auto checked =
                     found.empty() ? check_file(test.path, options, found) : std::nullopt)
            for (const auto& text : checked->program.texts)
                seen.insert(std::filesystem::path(text->path).lexically_normal().string());
        once.add(found);
    }
    const auto texts = read_project(folder, options.include_dirs, out).sources;
    for (const auto& text : texts) pool.add(text);
    for (const auto& text : texts) {
        ++files;
        if (seen.contains(std::filesystem::path(text->path).lexically_normal().string())) continue;
        once.add(check_apart(pool, {text}));
    }
    return files;
}

/// Those that are no tests together.
void check_sources(const std::vector<std::string>& paths, const LoadOptions& options,
                   Diagnostics& out) {
    std::vector<std::string> sources;
    for (const std::string& path : paths) {
        Diagnostics unread;
        const auto file = is_structured_text(path) ? read_source(path, unread) : nullptr;
        if (file && has_tests(file))
            compile_tests(find_tests(path, {}).front(), file, out);
        else
            sources.push_back(path);
    }
    const auto texts = read_files(sources, options.include_dirs, out);
    if (texts.empty() || !out.empty()) return;
    Diagnostics found;
    st::compile(texts, standard_blocks(), found);
    Once(out).add(without_neighbours(texts, found));
}

Exit execute(const CheckCommand& command) {
    Diagnostics out;
    const LoadOptions options = command.common.load_options(out);
    std::vector<std::string> sources, checked;
    for (const std::string& path : command.files) {
        checked.push_back(path);
        const bool is_ours = has_forms(path);
        if (!is_ours && is_project(path)) {
            Diagnostics found;
            const std::string page = check_project(path, options, found);
            if (!command.common.json && !found.empty()) fmt::print("{}", page);
            Once(out).add(found);
            continue;
        }
        if (std::error_code error; is_ours) {
            const std::size_t files = check_folder(path, options, out);
            checked.back() += fmt::format(": {} {}", files, files == 1 ? "file" : "files");
        } else if (projects::is_source(path) || std::filesystem::is_directory(path, error))
            sources.push_back(path);
        else
            check_file(path, options, out);
    }
    check_sources(sources, options, out);
    if (command.strict) out.be_strict();
    const bool speaks = !out.empty() || command.common.json || !out.warnings().empty();
    const Exit said = speaks ? report(out, command.common.json) : Exit::fine;
    if (!out.empty()) return said;
    if (!command.common.json && !command.common.quiet)
        for (const std::string& path : checked) fmt::print("ok  {}\n", path);
    return Exit::fine;
}

}  // namespace

void add_check(CLI::App& app, Exit& result) {
    auto command = std::make_shared<CheckCommand>();
    CLI::App* sub =
        app.add_subcommand("check", "Say what is wrong with programs, studies and sources");
    sub->add_option(
           "files", command->files,
           "Programs, studies, fits (YAML), files of Structured Text, projects of others, and "
           "folders of all of "
           "them")
        ->required();
    add_strict(*sub, command->strict);
    add_dialect(*sub);
    command->common.add_to(*sub);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
