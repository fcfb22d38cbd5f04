#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "blocks/catalog.hpp"
#include "runtime/source/diagnostic.hpp"
#include "tools/lineshaft/block_text.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

struct BlocksCommand {
    std::string type;
    bool json = false;
};

Exit execute(const BlocksCommand& command) {
    const Catalog catalog = standard_blocks();
    if (command.type.empty()) {
        auto list = nlohmann::ordered_json::array();
        for (const BlockType& type : catalog.types()) {
            if (command.json)
                list.push_back(block_json(type));
            else
                fmt::print("{:18} {}\n", type.name, type.doc);
        }
        if (command.json) fmt::print("{}\n", list.dump(2));
        return Exit::fine;
    }
    const BlockType* type = catalog.find(command.type);
    if (!type) {
        spdlog::error("there is no block type '{}'; {}", command.type,
                      suggest(command.type, catalog.names()));
        return Exit::wrong;
    }
    if (command.json)
        fmt::print("{}\n", block_json(*type).dump(2));
    else
        fmt::print("{}", block_text(*type));
    return Exit::fine;
}

}  // namespace

void add_blocks(CLI::App& app, Exit& result) {
    auto command = std::make_shared<BlocksCommand>();
    CLI::App* sub = app.add_subcommand("blocks", "List the function blocks, or describe one");
    sub->add_option("type", command->type, "A block type, such as gear_axis");
    sub->add_flag("--json", command->json, "Print JSON for machines");
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
