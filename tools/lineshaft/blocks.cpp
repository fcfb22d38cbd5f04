#include <cmath>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "blocks/catalog.hpp"
#include "runtime/model/literal.hpp"
#include "runtime/source/diagnostic.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

struct BlocksCommand {
    std::string type;
    bool json = false;
};

/// A block as it is before its first scan, to read the defaults from.
class Fresh {
  public:
    explicit Fresh(const BlockType& type) : memory_(type.size) { type.construct(memory_.data()); }
    Value value(const Field& field) const {
        return load(field.type, memory_.data() + field.offset);
    }

  private:
    std::vector<std::byte> memory_;
};

std::string unit_text(const Field& field) {
    std::string text(field.unit);
    std::erase(text, '{');
    std::erase(text, '}');
    return text;
}

/// `immediate | early`; the empty name, a unit's of plain numbers, as it is written in YAML.
std::string names_text(const Field& field) {
    std::string text;
    for (const std::string_view name : field.names)
        text += fmt::format("{}{}", text.empty() ? "" : " | ", name.empty() ? "\"\"" : name);
    return text;
}

std::string default_text(const Field& field, const Value& value) {
    const std::string text = describe(value, field.type, field.names, "");
    return text.empty() ? "\"\"" : text;
}

void add_limits(nlohmann::ordered_json& object, const Field& field) {
    if (std::isfinite(field.minimum))
        object[field.minimum_excluded ? "above" : "at_least"] = field.minimum;
    if (std::isfinite(field.maximum))
        object[field.maximum_excluded ? "below" : "at_most"] = field.maximum;
}

nlohmann::ordered_json to_json(const BlockType& type) {
    const Fresh fresh(type);
    auto fields = nlohmann::ordered_json::array();
    for (const Field& f : type.fields) {
        nlohmann::ordered_json field{{"name", f.name},
                                     {"direction", name_of(f.direction)},
                                     {"type", name_of(f.type)},
                                     {"unit", f.unit},
                                     {"doc", f.doc},
                                     {"default", describe(fresh.value(f), f.type, f.names, "")},
                                     {"required", f.required}};
        if (!f.names.empty()) field["values"] = f.names;
        add_limits(field, f);
        fields.push_back(std::move(field));
    }
    nlohmann::ordered_json object{{"type", type.name}, {"doc", type.doc}, {"fields", fields}};
    for (const TableField& t : type.tables) {
        auto columns = nlohmann::ordered_json::array();
        for (const Field& c : t.columns) {
            columns.push_back({{"name", c.name}, {"unit", c.unit}, {"doc", c.doc}});
            add_limits(columns.back(), c);
        }
        object["tables"].push_back(
            {{"name", t.name}, {"doc", t.doc}, {"rows", t.capacity}, {"columns", columns}});
    }
    return object;
}

void print_fields(const BlockType& type, Direction direction) {
    const Fresh fresh(type);
    bool first = true;
    for (const Field& f : type.fields) {
        if (f.direction != direction) continue;
        if (first) fmt::print("\n{}s\n", name_of(direction));
        first = false;
        std::string notes;
        if (direction != Direction::output)
            notes = f.required ? "must be set" : "default " + default_text(f, fresh.value(f));
        if (const std::string limits = describe_limits(f, ""); !limits.empty())
            notes += ", " + limits;
        fmt::print("  {:18} {:10} {}{}\n", f.name, unit_text(f), f.doc,
                   notes.empty() ? "" : " (" + notes + ")");
        if (f.type == Type::enumeration) fmt::print("  {:18} {:10} {}\n", "", "", names_text(f));
    }
}

void print_tables(const BlockType& type) {
    for (const TableField& table : type.tables) {
        fmt::print("\nlist {}, up to {} rows: {}\n", table.name, table.capacity, table.doc);
        for (const Field& column : table.columns) {
            const std::string limits = describe_limits(column, "");
            fmt::print("  {:18} {:10} {}{}\n", column.name, column.unit, column.doc,
                       limits.empty() ? "" : " (" + limits + ")");
        }
    }
}

Exit execute(const BlocksCommand& command) {
    const Catalog catalog = standard_blocks();
    if (command.type.empty()) {
        auto list = nlohmann::ordered_json::array();
        for (const BlockType& type : catalog.types()) {
            if (command.json)
                list.push_back(to_json(type));
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
    if (command.json) {
        fmt::print("{}\n", to_json(*type).dump(2));
        return Exit::fine;
    }
    fmt::print("{}: {}\n", type->name, type->doc);
    for (const Direction d : {Direction::parameter, Direction::input, Direction::output})
        print_fields(*type, d);
    print_tables(*type);
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
