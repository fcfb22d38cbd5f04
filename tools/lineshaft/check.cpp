#include <filesystem>

#include <fmt/core.h>

#include "blocks/catalog.hpp"
#include "runtime/fit/fit.hpp"
#include "runtime/run/link.hpp"
#include "runtime/study/study_reader.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/test_files.hpp"

namespace lineshaft {

namespace {

struct CheckCommand {
    CommonOptions common;
    std::vector<std::string> files;
    bool strict = false;
};

void check(const std::string& path, const LoadOptions& options, Diagnostics& out) {
    const auto file = read_source(path, out);
    if (!file) return;
    const Catalog& catalog = standard_blocks();
    if (is_study(*file))
        read_study(file, options, catalog, out);
    else if (is_fit(*file))
        read_fit(file, options, catalog, out);
    else
        link(read_program(file, options, out), catalog, out);
}

/// Those that are no tests together.
void check_structured_text(const std::vector<std::string>& paths, Diagnostics& out) {
    std::vector<std::string> sources;
    for (const std::string& path : paths) {
        Diagnostics unread;
        const auto file = is_structured_text(path) ? read_source(path, unread) : nullptr;
        if (file && st::is_test_file(file))
            compile_tests(find_tests(path, {}).front(), file, out);
        else
            sources.push_back(path);
    }
    if (!sources.empty()) compile_files(sources, out);
}

Exit execute(const CheckCommand& command) {
    Diagnostics out;
    const LoadOptions options = command.common.load_options(out);
    std::vector<std::string> sources;
    for (const std::string& path : command.files)
        if (std::error_code error;
            is_structured_text(path) || std::filesystem::is_directory(path, error))
            sources.push_back(path);
        else
            check(path, options, out);
    check_structured_text(sources, out);
    if (command.strict) out.be_strict();
    const bool speaks = !out.empty() || command.common.json || !out.warnings().empty();
    const Exit said = speaks ? report(out, command.common.json) : Exit::fine;
    if (!out.empty()) return said;
    if (!command.common.json && !command.common.quiet)
        for (const std::string& path : command.files) fmt::print("ok  {}\n", path);
    return Exit::fine;
}

}  // namespace

void add_check(CLI::App& app, Exit& result) {
    auto command = std::make_shared<CheckCommand>();
    CLI::App* sub =
        app.add_subcommand("check", "Say what is wrong with programs, studies and sources");
    sub->add_option("files", command->files,
                    "Programs, studies, fits (YAML), and files or folders of Structured Text")
        ->required();
    add_strict(*sub, command->strict);
    command->common.add_to(*sub);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
