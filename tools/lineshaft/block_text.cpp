#include "tools/lineshaft/block_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "runtime/model/literal.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/library/shortened.hpp"

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

/// The unit; for a reference the kind that it takes.
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

std::string names_line(const Field& field) {
    return fmt::format("  {:18} {:10} {}\n", "", "", names_text(field));
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

/// `my_gear_in` of MC_GearIn, `my_ton` of ton.
std::string example_name(std::string_view type) {
    if (type.starts_with("MC_")) type.remove_prefix(3);
    std::string name = "my_";
    for (std::size_t i = 0; i < type.size(); ++i) {
        if (i > 0 && type[i] != lower(type[i]) && type[i - 1] == lower(type[i - 1]) &&
            type[i - 1] != '_')
            name += '_';
        name += lower(type[i]);
    }
    return name;
}

/// `1 mm/s` of `{unit}/s`: with the block's own default unit, with mm of what it refers to.
std::string example_number(const BlockType& type, const Fresh& fresh, const Field& field,
                           std::string_view number) {
    std::string text(field.is_time() ? "s" : field.unit);
    for (std::size_t at = text.find('{'); at != std::string::npos; at = text.find('{', at)) {
        const std::size_t end = text.find('}', at);
        const Field* chosen = type.find_settable(text.substr(at + 1, end - at - 1));
        const bool is_own = chosen && !is_reference(*chosen);
        text.replace(at, end + 1 - at, is_own ? fresh.text(*chosen) : "mm");
    }
    if (text.starts_with("/") || text.starts_with("^")) text.clear();  // of a plain number
    return text.empty() ? std::string(number) : fmt::format("{} {}", number, text);
}

/// Kinds that an example may refer to: their own is called by example_name, an axis x.
bool is_of_examples(std::string_view kind) {
    static constexpr std::string_view kinds[] = {"axis",           "cam_table",    "axes_group",
                                                 "path_table",     "cam_switches", "digital_inputs",
                                                 "digital_outputs"};
    return std::ranges::find(kinds, kind) != std::end(kinds);
}

std::string example_value(const BlockType& type, const Fresh& fresh, const Field& field) {
    if (is_reference(field) && field.refers != "axis") return example_name(field.refers);
    if (is_reference(field)) return lower(field.name).starts_with("master") ? "line" : "x";
    if (field.name == "CamTableID") return "my_cam_table_select.CamTableID";
    if (field.type == Type::boolean) return "inputs.go";
    if (field.type == Type::enumeration) return std::string(written(field.names.front()));
    return example_number(type, fresh, field, field.name == "low" ? "0" : "1");
}

/// What the block is for, if it need not be said.
bool is_telling(const BlockType& type, const Field& field) {
    static constexpr std::string_view names[] = {
        "execute", "enable",     "position",  "distance",  "phaseshift", "camtableid",
        "count",   "start_rate", "position1", "distance1", "endpoint1"};
    const bool is_velocity = field.name == "Velocity" && type.name == "MC_MoveVelocity";
    return is_velocity || std::ranges::find(names, lower(field.name)) != std::end(names);
}

/// `points: [[0 mm, 0 mm], [1 mm, 1 mm]]`
std::string example_rows(const BlockType& type, const Fresh& fresh, const TableField& table) {
    const std::size_t columns = table.needed > 0 ? table.needed : table.columns.size();
    std::string rows;
    for (const double number : {0.0, 1.0}) {
        std::string row;
        for (const Field& column : table.columns.first(columns)) {
            const std::string text = fmt::format("{}", std::max(number, column.minimum));
            row += (row.empty() ? "" : ", ") + example_number(type, fresh, column, text);
        }
        rows += fmt::format("{}[{}]", rows.empty() ? "" : ", ", row);
    }
    return fmt::format(", {}: [{}]", table.name, rows);
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
    if (!field.names.empty()) out["values"] = field.names.list();
    add_limits(out, field);
    return out;
}

std::string shortened_text(const BlockType& type) {
    if (st::shortened_variables(type).empty()) return {};
    return fmt::format(
        "\nnot all of {}\n  of a block's arrays {} elements are known, of its instances and "
        "structures {} parts\n",
        fmt::join(st::shortened_variables(type), ", "), st::most_elements, st::most_parts);
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
            if (f.type == Type::enumeration) lines += names_line(f);
        }
        if (!lines.empty()) text += fmt::format("\n{}s\n{}", name_of(direction), lines);
    }
    text += shortened_text(type);
    for (const TableField& table : type.tables) {
        text +=
            fmt::format("\nlist {}, up to {} rows: {}\n", table.name, table.capacity, table.doc);
        for (const Field& column : table.columns) {
            text += line(column, describe_limits(column, ""));
            if (!column.names.empty()) text += names_line(column);
        }
    }
    if (const std::string example = block_example(type); !example.empty())
        text += fmt::format("\nexample\n  {}\n", example);
    return text;
}

std::string block_example(const BlockType& type) {
    const Fresh fresh(type);
    std::string text =
        fmt::format("{}: {{type: {}, task: main", example_name(type.name), type.name);
    bool has_inputs = false;
    for (const Field& f : type.fields) {
        if (is_reference(f) && !is_of_examples(f.refers)) return {};
        has_inputs = has_inputs || f.direction == Direction::input;
        const bool is_asked = f.required || is_reference(f);
        const bool is_set = f.direction == Direction::input && is_telling(type, f);
        if (f.name.find('.') != std::string_view::npos || (!is_asked && !is_set)) continue;
        const bool has_index = f.name.find('[') != std::string_view::npos;
        text += fmt::format(", {0}{1}{0}: {2}", has_index ? "\"" : "", f.name,
                            example_value(type, fresh, f));
    }
    for (const TableField& table : type.tables)
        if (!has_inputs) text += example_rows(type, fresh, table);
    return text + "}";
}

Json block_json(const BlockType& type) {
    const Fresh fresh(type);
    Json out{{"type", type.name},
             {"doc", type.doc},
             {"example", block_example(type)},
             {"fields", Json::array()}};
    for (const Field& f : type.fields) out["fields"].push_back(field_json(f, fresh));
    if (const auto shortened = st::shortened_variables(type); !shortened.empty())
        out["shortened"] = shortened;
    for (const TableField& t : type.tables) {
        auto columns = Json::array();
        for (const Field& c : t.columns) {
            columns.push_back({{"name", c.name}, {"unit", c.unit}, {"doc", c.doc}});
            if (!c.names.empty()) columns.back()["values"] = c.names.list();
            add_limits(columns.back(), c);
        }
        out["tables"].push_back(
            {{"name", t.name}, {"doc", t.doc}, {"rows", t.capacity}, {"columns", columns}});
    }
    return out;
}

}  // namespace lineshaft
