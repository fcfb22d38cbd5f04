#include <fmt/core.h>

#include "blocks/catalog.hpp"
#include "runtime/fit/fit.hpp"
#include "runtime/run/link.hpp"
#include "runtime/study/study_reader.hpp"
#include "tools/lineshaft/command.hpp"

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

Exit execute(const CheckCommand& command) {
    Diagnostics out;
    const LoadOptions options = command.common.load_options(out);
    for (const std::string& path : command.files) check(path, options, out);
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
    CLI::App* sub = app.add_subcommand("check", "Say what is wrong with programs and studies");
    sub->add_option("files", command->files, "Programs and studies, YAML files")->required();
    add_strict(*sub, command->strict);
    command->common.add_to(*sub);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
