#include <algorithm>
#include <cctype>
#include <filesystem>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "blocks/catalog.hpp"
#include "runtime/projects/project.hpp"
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

/// How a block or a function of a library is called: what stands before it, its name and its pins.
std::string_view head_of(std::string_view text, const std::string& name) {
    const std::string all = lower(text), wanted = lower(name);
    for (const char* head : {"\nfunction_block {}\n", "\nfunction_block {} ", "\nfunction {} "}) {
        const std::string sought = fmt::format(fmt::runtime(head), wanted);
        const std::size_t found = all.find(sought);
        if (found == all.npos) continue;
        std::size_t end = found + sought.size() - 1;
        const bool is_helper =
            std::islower(static_cast<unsigned char>(text[end - wanted.size()])) != 0;
        if (is_helper) continue;
        std::size_t begin = found + 1;
        while (begin > 1) {
            const std::size_t above = all.rfind('\n', begin - 2) + 1;
            if (all.compare(above, 2, "//") != 0) break;
            begin = above;
        }
        end = all.find('\n', end) + 1;
        while (all.compare(end, 6, "var_in") == 0 || all.compare(end, 7, "var_out") == 0)
            end = all.find('\n', all.find("end_var", end)) + 1;
        return text.substr(begin, end - begin);
    }
    return {};
}

/// Describes it in each library that has it, alone or as `Tc2_MC2.MC_MoveModulo`; false: none has.
bool describe_of_libraries(const Catalog& catalog, const std::string& name) {
    bool any = false;
    for (const LibraryFile& file : catalog.libraries()) {
        const std::string of_library = lower(file.library) + ".";
        const bool is_full = lower(name).starts_with(of_library);
        const std::string_view head =
            head_of(file.text, is_full ? name.substr(of_library.size()) : name);
        if (head.empty()) continue;
        fmt::print("{}of the library {}:\n{}", any ? "\n" : "", file.library, head);
        any = true;
    }
    return any;
}

/// The first sentence above a head.
std::string_view doc_of(std::string_view head) {
    if (!head.starts_with("//")) return {};
    const std::string_view line = head.substr(3, head.find('\n') - 3);
    return line.substr(0, std::min(line.find(". "), line.find(": ")));
}

/// All that a library has, a line each; false: there is no such library.
bool list_of_library(const Catalog& catalog, const std::string& name) {
    bool any = false;
    for (const LibraryFile& file : catalog.libraries()) {
        if (lower(file.library) != lower(name)) continue;
        any = true;
        for (std::size_t at = 0; at != file.text.npos; at = file.text.find('\n', at + 1)) {
            const std::string_view line = file.text.substr(at == 0 ? 0 : at + 1);
            for (const std::string_view kind : {"FUNCTION_BLOCK ", "FUNCTION "}) {
                if (!line.starts_with(kind)) continue;
                const std::string_view rest = line.substr(kind.size());
                const std::string called(rest.substr(0, rest.find_first_of(" \n\r;:")));
                const std::string_view head = head_of(file.text, called);
                if (!head.empty()) fmt::print("{:28} {}\n", called, doc_of(head));
                break;
            }
        }
    }
    if (any) fmt::print("\nlineshaft blocks {}.NAME shows the pins of one.\n", name);
    return any;
}

/// Other libraries that have it, with pins of their own.
void name_libraries(const Catalog& catalog, const std::string& name) {
    std::string full;
    for (const LibraryFile& file : catalog.libraries())
        if (!head_of(file.text, name).empty())
            full += fmt::format("\n  lineshaft blocks {}.{}", file.library, name);
    if (!full.empty()) fmt::print("\nLibraries of vendors have it with their pins:{}\n", full);
}

/// The type of that name, or all that have to do with the words.
Exit describe(const Catalog& catalog, const std::vector<std::string>& words, bool json) {
    const BlockType* type = words.size() == 1 ? catalog.find(words.front()) : nullptr;
    if (!type) {
        if (words.size() == 1 && !json &&
            (describe_of_libraries(catalog, words.front()) ||
             list_of_library(catalog, words.front())))
            return Exit::fine;
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
    if (!json) name_libraries(catalog, std::string(type->name));
    return Exit::fine;
}

/// A library such as `Siemens.Step7`, or what one has, as `Tc2_MC2.MC_MoveModulo`.
bool is_of_library(const std::string& name) {
    return std::ranges::any_of(standard_blocks().libraries(), [&](const LibraryFile& file) {
        const std::string library = lower(file.library);
        return lower(name) == library || lower(name).starts_with(library + ".");
    });
}

/// What is there, or is written as files of sources are.
bool is_file(const std::string& name) {
    std::error_code error;
    if (is_of_library(name)) return false;
    return std::filesystem::exists(name, error) || name.find('/') != name.npos ||
           projects::is_source(name);
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
    for (const std::string& name : command.names) (is_file(name) ? files : types).push_back(name);
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
