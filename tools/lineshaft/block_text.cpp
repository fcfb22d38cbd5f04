#include "tools/lineshaft/block_text.hpp"

#include <cmath>

#include <fmt/format.h>

#include "runtime/model/literal.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

/// A block as it is before its first scan, to read the defaults from.
class Fresh {
  public:
    explicit Fresh(const BlockType& type) : memory_(type.size) { type.construct(memory_.data()); }
    std::string text(const Field& f) const {
        return describe(load(f.type, memory_.data() + f.offset), f.type, f.names, "");
    }

  private:
    std::vector<std::byte> memory_;
};

bool is_reference(const Field& field) {
    return field.direction == Direction::in_out;
}

/// Of a reference the kind that it takes.
std::string unit_text(const Field& field) {
    std::string text(is_reference(field) ? field.refers : field.unit);
    std::erase_if(text, [](char c) { return c == '{' || c == '}'; });
    return text;
}

/// The empty name, a unit's of plain numbers, as it is written in YAML.
std::string_view written(std::string_view name) {
    return name.empty() ? "\"\"" : name;
}

/// `immediate | early`
std::string names_text(const Field& field) {
    std::string text;
    for (const std::string_view name : field.names)
        text += fmt::format("{}{}", text.empty() ? "" : " | ", written(name));
    return text;
}

/// What must be known to set it: the default, the limits.
std::string notes(const Field& field, const Fresh& fresh) {
    const bool settable = field.direction != Direction::output &&
                          field.direction != Direction::local && field.global.empty();
    std::string text = !settable        ? ""
                       : field.required ? "must be set"
                                        : fmt::format("default {}", written(fresh.text(field)));
    if (const std::string limits = describe_limits(field, ""); !limits.empty())
        text += (text.empty() ? "" : ", ") + limits;
    return text;
}

std::string line(const Field& field, const std::string& notes) {
    return fmt::format("  {:18} {:10} {}{}\n", field.name, unit_text(field), field.doc,
                       notes.empty() ? "" : " (" + notes + ")");
}

void add_limits(Json& object, const Field& field) {
    if (std::isfinite(field.minimum))
        object[field.minimum_excluded ? "above" : "at_least"] = field.minimum;
    if (std::isfinite(field.maximum))
        object[field.maximum_excluded ? "below" : "at_most"] = field.maximum;
}

Json field_json(const Field& field, const Fresh& fresh) {
    Json out{{"name", field.name}, {"direction", name_of(field.direction)}};
    if (is_reference(field))
        out["refers"] = field.refers;
    else
        out.update({{"type", name_of(field.type)}, {"unit", field.unit}});
    out["doc"] = field.doc;
    if (!is_reference(field)) out["default"] = fresh.text(field);
    out["required"] = field.required;
    if (!field.names.empty()) out["values"] = field.names;
    add_limits(out, field);
    return out;
}

}  // namespace

std::string block_text(const BlockType& type) {
    const Fresh fresh(type);
    std::string text = fmt::format("{}: {}\n", type.name, type.doc);
    using enum Direction;
    for (const Direction direction : {parameter, in_out, input, output, local}) {
        std::string lines;
        for (const Field& f : type.fields) {
            if (f.direction != direction) continue;
            lines += line(f, notes(f, fresh));
            if (f.type == Type::enumeration)
                lines += fmt::format("  {:18} {:10} {}\n", "", "", names_text(f));
        }
        if (!lines.empty()) text += fmt::format("\n{}s\n{}", name_of(direction), lines);
    }
    for (const TableField& table : type.tables) {
        text +=
            fmt::format("\nlist {}, up to {} rows: {}\n", table.name, table.capacity, table.doc);
        for (const Field& column : table.columns) text += line(column, describe_limits(column, ""));
    }
    return text;
}

Json block_json(const BlockType& type) {
    const Fresh fresh(type);
    Json out{{"type", type.name}, {"doc", type.doc}, {"fields", Json::array()}};
    for (const Field& f : type.fields) out["fields"].push_back(field_json(f, fresh));
    for (const TableField& t : type.tables) {
        auto columns = Json::array();
        for (const Field& c : t.columns) {
            columns.push_back({{"name", c.name}, {"unit", c.unit}, {"doc", c.doc}});
            add_limits(columns.back(), c);
        }
        out["tables"].push_back(
            {{"name", t.name}, {"doc", t.doc}, {"rows", t.capacity}, {"columns", columns}});
    }
    return out;
}

}  // namespace lineshaft
