#include "runtime/program/schema.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "runtime/model/literal.hpp"
#include "runtime/program/program_form.hpp"
#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

const std::string name_pattern = "[A-Za-z_][A-Za-z0-9_]*";
const std::string part_pattern =
    "[A-Za-z_\u00C0-\u1FFF\u3005-\uD7FF][A-Za-z0-9_\u00C0-\u1FFF\u3005-\uD7FF]*";
const std::string address_pattern = "%[IQMiqm][XBWDLxbwdl]?[0-9]+(\\.[0-7])?";
const std::string signal_pattern = "(" + name_pattern + "(\\." + part_pattern +
                                   "(\\[[-0-9,]+\\])?)+|" + address_pattern + "(\\.\\." +
                                   address_pattern + ")?)";
const std::string number_pattern = "([0-9._]+([eE][-+]?[0-9]+)?|(2|8|16)#[0-9A-Fa-f_]+)";

/// A schema of one keyword. Braces alone would leave it to the compiler what a list of one is.
Json keyword(std::string_view word, Json value) {
    Json out = Json::object();
    out[std::string(word)] = std::move(value);
    return out;
}

Json reference(std::string_view name) {
    return keyword("$ref", fmt::format("#/definitions/{}", name));
}

Json any_of(Json::array_t forms) {
    return keyword("anyOf", std::move(forms));
}

Json of_type(std::string_view type) {
    return keyword("type", type);
}

Json required(std::string_view key) {
    return keyword("required", Json::array_t{key});
}

Json if_then(Json condition, Json then) {
    Json out = keyword("if", std::move(condition));
    out["then"] = std::move(then);
    return out;
}

/// `schema` behind its description: the order in which a person wants to read them.
Json described(std::string_view text, const Json& schema) {
    Json out = keyword("description", text);
    out.update(schema);
    return out;
}

Json list_of(Json item) {
    Json out = of_type("array");
    out["items"] = std::move(item);
    return out;
}

Json text(const std::string& pattern) {
    Json out = of_type("string");
    out["pattern"] = "^(" + pattern + ")$";
    return out;
}

/// Every text that `unit` may become when its `{parameter}` is put in.
std::vector<std::string> possible_units(const BlockType& type, const std::string& unit) {
    const auto open = unit.find('{');
    if (open == std::string::npos) return {unit};
    const auto close = unit.find('}', open);
    std::vector<std::string> units;
    for (const std::string_view name :
         type.find_settable(unit.substr(open + 1, close - open - 1))->names) {
        std::string chosen = unit;
        chosen.replace(open, close - open + 1, name);
        std::ranges::move(possible_units(type, chosen), std::back_inserter(units));
    }
    return units;
}

Json bare_number(const Field& field) {
    Json out = of_type(is_integer(field.type) ? "integer" : "number");
    if (std::isfinite(field.minimum))
        out[field.minimum_excluded ? "exclusiveMinimum" : "minimum"] = field.minimum;
    if (std::isfinite(field.maximum))
        out[field.maximum_excluded ? "exclusiveMaximum" : "maximum"] = field.maximum;
    return out;
}

/// Whether it is, or may come to be by its parameters, a number without a unit.
bool may_be_plain(const BlockType& type, const Field& field) {
    const auto is_none = [](const std::string& text) {
        const auto unit = Unit::parse(text);
        return text.empty() || (unit && is_plain(*unit));
    };
    return std::ranges::any_of(possible_units(type, std::string(field.unit)), is_none);
}

/// The forms of a constant for `field`.
Json::array_t constants(const BlockType& type, const Field& field) {
    if (field.direction == Direction::in_out) return {reference("name")};
    if (field.type == Type::enumeration) return {keyword("enum", field.names)};
    if (field.type == Type::boolean) return {of_type("boolean")};
    static const Unit second = *Unit::parse("s");
    Json::array_t forms;
    const auto units = possible_units(type, std::string(field.unit));
    if (may_be_plain(type, field)) forms.push_back(bare_number(field));
    forms.push_back(reference("quantity"));
    if (Unit::parse(units.front())->same_dimension(second)) forms.push_back(reference("interval"));
    return forms;
}

std::string description(const BlockType& type, const Field& field) {
    if (field.direction == Direction::in_out)
        return fmt::format("reference to a block of type {}: {}; must be set", field.refers,
                           field.doc);
    std::vector<std::byte> fresh(type.size);
    type.construct(fresh.data());
    std::string unit(field.unit);
    std::erase_if(unit, [](char c) { return c == '{' || c == '}'; });
    const std::string limits = describe_limits(field, unit);
    const Value value = load(field.type, fresh.data() + field.offset);
    return fmt::format("{}: {}{}{}; {}", name_of(field.direction), field.doc,
                       unit.empty() ? "" : " [" + unit + "]", limits.empty() ? "" : ", " + limits,
                       field.required
                           ? "must be set"
                           : "default " + describe(value, field.type, field.names, unit));
}

Json rows(const BlockType& type, const TableField& table) {
    Json::array_t columns;
    for (const Field& column : table.columns) {
        Json::array_t forms{reference("quantity"), reference("parameter")};
        if (!column.names.empty()) {
            Json::array_t names(column.names.begin(), column.names.end());
            forms = {keyword("enum", names), reference("parameter")};
        }
        if (column.names.empty() && may_be_plain(type, column))
            forms.push_back(bare_number(column));
        if (table.needed > 0 && columns.size() >= table.needed) forms.push_back(of_type("null"));
        columns.push_back(described(column.doc, any_of(forms)));
    }
    Json row = of_type("array");
    row["minItems"] = table.needed > 0 ? table.needed : columns.size();
    row["maxItems"] = columns.size();
    row["items"] = std::move(columns);
    Json out = list_of(std::move(row));
    out["maxItems"] = table.capacity;
    return described(table.doc, any_of({out, reference("name")}));
}

/// `common` is the form of any block.
Json block_type(const BlockType& type, const Json& common) {
    Json properties = common.at("properties");
    properties["type"] = keyword("const", type.name);
    Json::array_t needed = common.at("required");
    for (const Field& field : type.fields) {
        if (field.direction == Direction::output || field.direction == Direction::local) continue;
        Json::array_t forms = constants(type, field);
        if (field.direction == Direction::input) forms.push_back(reference("wire"));
        forms.push_back(reference("parameter"));
        properties[std::string(field.name)] = described(description(type, field), any_of(forms));
        if (field.required) needed.push_back(field.name);
    }
    for (const TableField& table : type.tables)
        properties[std::string(table.name)] = rows(type, table);
    Json out = of_type("object");
    out["properties"] = std::move(properties);
    out["required"] = std::move(needed);
    out["additionalProperties"] = false;
    return described(type.doc, out);
}

/// A type from the catalogue, and then the keys of that type; or one of the program's sources.
Json block(const Catalog& catalog) {
    Json out = of_type("object");
    out["required"] = Json::array_t{"type", "task"};
    out["properties"]["type"] = any_of({reference("name"), reference("parameter")});
    Json::array_t cases;
    for (const BlockType& type : catalog.types()) {
        Json is_type;
        is_type["properties"]["type"] = keyword("const", type.name);
        cases.push_back(if_then(is_type, reference("block_" + std::string(type.name))));
    }
    out["allOf"] = std::move(cases);
    return out;
}

/// Without sources, the types of blocks are those of the catalogue.
Json types_without_sources(const Catalog& catalog) {
    Json of_block;
    of_block["properties"]["type"] =
        any_of({keyword("enum", catalog.names()), reference("parameter")});
    Json blocks;
    blocks["properties"]["blocks"]["additionalProperties"] = std::move(of_block);
    Json out;
    out["if"] = required("sources");
    out["else"] = std::move(blocks);
    return out;
}

std::string time_units() {
    static const Unit second = *Unit::parse("s");
    std::string names;
    for (const std::string& name : unit_names())
        if (Unit::parse(name)->same_dimension(second)) names += (names.empty() ? "" : "|") + name;
    return names;
}

const std::string& time_pattern() {
    static const std::string pattern = fmt::format("\\+?{} *({})", number_pattern, time_units());
    return pattern;
}

/// `within TIME of SIGNAL` with what may stand in it.
std::string phrase_pattern(std::string_view phrase) {
    std::string pattern(phrase);
    pattern.replace(pattern.find("TIME"), 4, time_pattern());
    pattern.replace(pattern.find("SIGNAL"), 6, signal_pattern);
    return "^" + pattern + "$";
}

/// The values that are not forms.
Json scalars() {
    const std::string parameter = "\\$" + name_pattern;
    Json out;
    out["name"] = text(name_pattern);
    constexpr const char* functions =
        "(abs|sqrt|exp|ln|a?sin|a?cos|a?tan|atan2|min|max|mean)\\(.*\\)";
    const std::string formula =
        fmt::format(".*{0} *[-+*/,)].*|.*[-+*/(,] *{0}.*|{1}.*", parameter, functions);
    out["parameter"] =
        described("$name: a parameter of the program; or a formula, such as $speed * 2",
                  text(fmt::format("{}|{}", parameter, formula)));
    out["wire"] = described(
        "a wire from block.port or inputs.name; NOT negates it, previous(...) is the last scan's "
        "value",
        text(fmt::format("(NOT )?({0}|previous\\({0}\\))", signal_pattern)));
    out["signal"] = described("block.port, inputs.name or outputs.name", text(signal_pattern));
    out["quantity"] = described("a number with its unit, such as 20 mm, 5e4 mm/s^3 or 20 %",
                                text("[-+]?[.0-9].*"));
    out["interval"] = described("every(task): the interval of a task; every() of the block's own",
                                text("every\\((" + name_pattern + ")?\\)"));
    out["time"] = described("a time, such as 2 ms", text(time_pattern()));
    out["share"] = described("a percentage", text("[0-9.]+ *%"));
    out["integer"] =
        described("a whole number, such as 16#FF", text("[-+]?[0-9_]+|(2|8|16)#[0-9A-Fa-f_]+"));
    out["number"] = any_of({of_type("number"), reference("quantity")});
    out["scalar"] = keyword("type", Json::array_t{"string", "number", "boolean"});
    out["task_name"] = described("a task that scans", text(name_pattern));
    return out;
}

/// A default as it stands in JSON.
Json value_of(std::string_view written) {
    Json value = Json::parse(written, nullptr, false);
    return value.is_discarded() ? Json(written) : value;
}

/// Writes forms and the shapes of their keys as definitions, each form once.
class SchemaWriter {
  public:
    explicit SchemaWriter(Json& definitions) : definitions_(definitions) {}

    /// With `parameters` $name may stand for what is no text.
    Json form(const Form& form, bool parameters) {
        if (!definitions_.contains(form.name)) {
            definitions_[std::string(form.name)] = {};
            definitions_[std::string(form.name)] = table(form, parameters);
        }
        return reference(form.name);
    }

    Json table(const Form& form, bool parameters) {
        Json out = described(form.doc, of_type("object"));
        Json::array_t needed, rules;
        for (const Key& key : form.keys) {
            out["properties"][std::string(key.name)] =
                described(description_of(key), value(key, parameters));
            if (key.required) needed.push_back(key.name);
        }
        if (!form.others.name.empty())
            out["patternProperties"]["^" + signal_pattern + "$"] =
                described(form.others.doc, shape(form.others.shape, parameters));
        if (!form.phrase.name.empty())
            out["patternProperties"][phrase_pattern(form.phrase.name)] =
                described(form.phrase.doc, shape(form.phrase.shape, parameters));
        if (!needed.empty()) out["required"] = std::move(needed);
        out["additionalProperties"] = false;
        for (const Rule& r : form.rules) rules.push_back(rule(form, r));
        if (!rules.empty()) out["allOf"] = std::move(rules);
        return out;
    }

  private:
    using Kind = Shape::Kind;

    Json value(const Key& key, bool parameters) {
        const Json plain = shape(key.shape, parameters);
        if (key.word.empty()) return plain;
        return any_of({keyword("const", key.word), plain});
    }

    Json shape(const Shape& s, bool parameters) {
        const auto or_parameter = [&](Json::array_t forms) {
            if (parameters) forms.push_back(reference("parameter"));
            return forms.size() == 1 ? forms[0] : any_of(forms);
        };
        switch (s.kind) {
            case Kind::scalar:
                return reference("scalar");
            case Kind::name:
                return reference("name");
            case Kind::signal:
                return or_parameter({reference("signal")});
            case Kind::task:
                return or_parameter({reference("task_name")});
            case Kind::number:
                return or_parameter({reference("number")});
            case Kind::boolean:
                return or_parameter({of_type("boolean")});
            case Kind::integer:
                return or_parameter(
                    {limited(of_type("integer"), s, "minimum", "maximum"), reference("integer")});
            case Kind::time:
                return or_parameter({reference("time")});
            case Kind::share:
                return or_parameter({reference("time"), reference("share")});
            case Kind::choice:
                return or_parameter({keyword("enum", s.names)});
            case Kind::nothing:
                return of_type("null");
            case Kind::version:
                return keyword("enum", Json::array_t{1, "1"});
            case Kind::list:
                return list(s, parameters);
            case Kind::map:
                return map(s, parameters);
            case Kind::form:
                return form(s.form(), parameters);
            case Kind::block:
                return reference("block");
            case Kind::either:
                break;
        }
        Json::array_t forms;
        for (const Shape& one : s.of) forms.push_back(shape(one, parameters));
        return any_of(std::move(forms));
    }

    static Json limited(Json out, const Shape& s, const char* least, const char* most) {
        if (s.least != Shape{}.least) out[least] = s.least;
        if (s.most != Shape{}.most) out[most] = s.most;
        return out;
    }

    Json list(const Shape& s, bool parameters) {
        Json out = limited(list_of(shape(s.of[0], parameters)), s, "minItems", "maxItems");
        if (!s.twice.empty()) out["uniqueItems"] = true;
        return out;
    }

    Json map(const Shape& s, bool parameters) {
        Json out = of_type("object");
        if (!s.numbered) out = limited(std::move(out), s, "minProperties", "maxProperties");
        const std::string names = s.numbered       ? "[0-9]+"
                                  : s.what.empty() ? signal_pattern
                                                   : name_pattern;
        out["patternProperties"]["^" + names + "$"] = shape(s.of[0], parameters);
        out["additionalProperties"] = false;
        return out;
    }

    static Json is_there(const Form& form, std::string_view key) {
        if (key != form.phrase.name) return required(key);
        const Json another = keyword("not", keyword("pattern", phrase_pattern(key)));
        return keyword("not", keyword("propertyNames", another));
    }

    /// `key` is there, and does not say its default.
    static Json stands(const Form& form, std::string_view key) {
        const Key& k = *form.find(key);
        Json::array_t defaults;
        for (const std::string_view said : {k.otherwise, k.word})
            if (!said.empty()) defaults.push_back(value_of(said));
        Json out = required(key);
        if (!defaults.empty())
            out["properties"][std::string(key)] = keyword("not", keyword("enum", defaults));
        return out;
    }

    static Json rule(const Form& form, const Rule& r) {
        Json::array_t others;
        for (const std::string_view other : r.others)
            others.push_back(r.kind == Rule::Kind::only_with ? stands(form, other)
                                                             : is_there(form, other));
        switch (r.kind) {
            case Rule::Kind::not_with:
                return if_then(is_there(form, r.key), keyword("not", any_of(others)));
            case Rule::Kind::only_with:
                return if_then(stands(form, r.key), any_of(others));
            case Rule::Kind::exactly_one:
                return keyword("oneOf", others);
            case Rule::Kind::at_least_one:
                break;
        }
        return any_of(others);
    }

    Json& definitions_;
};

}  // namespace

std::string description_of(const Key& key) {
    const std::string_view said = key.word.empty() ? key.otherwise : key.word;
    if (said.empty()) return std::string(key.doc);
    return fmt::format("{}; {}{}", key.doc, key.word.empty() ? "default " : "or ", said);
}

nlohmann::ordered_json file_schema(const Catalog& catalog, std::span<const FormOf> files) {
    Json definitions = scalars();
    SchemaWriter writer(definitions);
    definitions["block"] = block(catalog);
    Json choice;
    for (const FormOf file : files) {
        const Form& form = file();
        const bool parameters = &form == &files.front()();
        Json schema = writer.form(form, parameters);
        if (parameters) {
            Json program;
            program["allOf"] = Json::array_t{schema, types_without_sources(catalog)};
            schema = std::move(program);
        }
        if (!choice.is_null()) {
            Json other = if_then(required(form.keys.front().name), std::move(schema));
            other["else"] = std::move(choice);
            schema = std::move(other);
        }
        choice = std::move(schema);
    }
    const Json common = writer.table(block_form(), true);
    for (const BlockType& type : catalog.types())
        definitions["block_" + std::string(type.name)] = block_type(type, common);
    Json out;
    out["$schema"] = "http://json-schema.org/draft-07/schema#";
    out["title"] = "lineshaft: a program, a study, a fit or a controller";
    out["type"] = "object";
    out.update(choice);
    out["definitions"] = std::move(definitions);
    return out;
}

}  // namespace lineshaft
