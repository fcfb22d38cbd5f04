#include <algorithm>
#include <filesystem>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "blocks/catalog.hpp"
#include "runtime/source/letters.hpp"
#include "tools/lineshaft/block_text.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

struct BlocksCommand {
    std::vector<std::string> names;  ///< a type or words, and files of Structured Text
    bool json = false;
};

using Types = std::vector<const BlockType*>;

void list(const Types& types, bool json) {
    auto all = nlohmann::ordered_json::array();
    for (const BlockType* type : types) {
        if (json)
            all.push_back(block_json(*type));
        else
            fmt::print("{:18} {}\n", type->name, type->doc);
    }
    if (json) fmt::print("{}\n", all.dump(2));
}

bool has(std::string_view text, const std::string& word) {
    return lower(text).find(lower(word)) != std::string::npos;
}

/// Those whose name and description have all of the words; of none those whose pins have them, too.
Types found(const Catalog& catalog, const std::vector<std::string>& words) {
    const auto with = [&](bool pins) {
        Types types;
        for (const BlockType& type : catalog.types()) {
            std::string text = fmt::format("{} {}", type.name, type.doc);
            for (const Field& f : type.fields)
                if (pins) text += fmt::format(" {} {}", f.name, f.doc);
            if (std::ranges::all_of(words, [&](const auto& word) { return has(text, word); }))
                types.push_back(&type);
        }
        return types;
    };
    Types types = with(false);
    return types.empty() ? with(true) : types;
}

/// The type of that name, or all that have to do with the words.
Exit describe(const Catalog& catalog, const std::vector<std::string>& words, bool json) {
    const BlockType* type = words.size() == 1 ? catalog.find(words.front()) : nullptr;
    if (!type) {
        const Types types = found(catalog, words);
        const std::string_view instead =
            catalog.instead_of(fmt::format("{}", fmt::join(words, " ")));
        if (!instead.empty())
            spdlog::error("there is no block type '{}': {}", fmt::join(words, " "), instead);
        else if (types.empty())
            spdlog::error("there is no block type '{0}', and none has to do with that; {1}",
                          fmt::join(words, " "), suggest(words.front(), catalog.names()));
        else
            list(types, json);
        return types.empty() || !instead.empty() ? Exit::wrong : Exit::fine;
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
    const auto texts = read_files(files, {}, out);
    const auto library = out.empty() ? st::compile(texts, standard_blocks(), out) : std::nullopt;
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
    const auto catalog = files.empty() ? standard_blocks() : compiled(files, command.json);
    if (!catalog) return Exit::wrong;
    if (!types.empty()) return describe(*catalog, types, command.json);
    if (files.empty() || command.json) {
        list(found(*catalog, {}), command.json);
        return Exit::fine;
    }
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
        "blocks",
        "List the function blocks, search them, describe one, or those of Structured Text");
    sub->add_option("names", command->names,
                    "A block type, such as MC_GearIn, or words to look for, such as gear; and "
                    "files or folders of Structured Text that have it");
    sub->add_flag("--json", command->json, "Print JSON for machines");
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
