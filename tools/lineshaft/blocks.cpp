#include <filesystem>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "blocks/catalog.hpp"
#include "tools/lineshaft/block_text.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

struct BlocksCommand {
    std::vector<std::string> names;  ///< a type, and files of Structured Text
    bool json = false;
};

Exit list(const Catalog& catalog, bool json) {
    auto all = nlohmann::ordered_json::array();
    for (const BlockType& type : catalog.types()) {
        if (json)
            all.push_back(block_json(type));
        else
            fmt::print("{:18} {}\n", type.name, type.doc);
    }
    if (json) fmt::print("{}\n", all.dump(2));
    return Exit::fine;
}

Exit describe(const Catalog& catalog, const std::string& name, bool json) {
    const BlockType* type = catalog.find(name);
    if (!type) {
        spdlog::error("there is no block type '{}'; {}", name, suggest(name, catalog.names()));
        return Exit::wrong;
    }
    if (json)
        fmt::print("{}\n", block_json(*type).dump(2));
    else
        fmt::print("{}", block_text(*type));
    return Exit::fine;
}

/// The kinds of block of the files; empty, and reported, when there is a mistake in them.
std::optional<Catalog> compiled(const std::vector<std::string>& files, bool json) {
    Diagnostics out;
    const auto library = compile_files(files, out);
    if (!out.empty() || !out.warnings().empty()) report(out, json && !out.empty());
    if (!library) return {};
    Catalog kinds;
    for (const BlockType& kind : library->kinds()) kinds.add(kind);
    return kinds;
}

Exit execute(const BlocksCommand& command) {
    std::vector<std::string> files, types;
    for (const std::string& name : command.names) {
        std::error_code error;
        const bool is_file = std::filesystem::path(name).has_extension() ||
                             std::filesystem::is_directory(name, error);
        (is_file ? files : types).push_back(name);
    }
    if (types.size() > 1) {
        spdlog::error("'{}' and '{}' are two types; name one", types[0], types[1]);
        return Exit::wrong;
    }
    const auto catalog = files.empty() ? standard_blocks() : compiled(files, command.json);
    if (!catalog) return Exit::wrong;
    if (!types.empty()) return describe(*catalog, types[0], command.json);
    if (files.empty() || command.json) return list(*catalog, command.json);
    if (catalog->types().empty())
        fmt::print("no PROGRAM or FUNCTION_BLOCK in {}\n", fmt::join(files, ", "));
    for (const BlockType& type : catalog->types())
        fmt::print("{}{}", &type == catalog->types().data() ? "" : "\n", block_text(type));
    return Exit::fine;
}

}  // namespace

void add_blocks(CLI::App& app, Exit& result) {
    auto command = std::make_shared<BlocksCommand>();
    CLI::App* sub = app.add_subcommand(
        "blocks", "List the function blocks, or describe one, or those of Structured Text");
    sub->add_option(
        "names", command->names,
        "A block type, such as MC_GearIn, and files or folders of Structured Text that have it");
    sub->add_flag("--json", command->json, "Print JSON for machines");
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
