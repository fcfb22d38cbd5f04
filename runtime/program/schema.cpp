#include "runtime/program/schema.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "runtime/model/literal.hpp"
#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

const std::string name_pattern = "[A-Za-z_][A-Za-z0-9_]*";
const std::string signal_pattern = name_pattern + "\\." + name_pattern;

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

/// `schema` behind its description: the order in which a person wants to read them.
Json described(std::string_view text, const Json& schema) {
    Json out = keyword("description", text);
    out.update(schema);
    return out;
}

Json map_of(Json properties, Json::array_t needed = {}) {
    Json out = of_type("object");
    out["properties"] = std::move(properties);
    if (!needed.empty()) out["required"] = std::move(needed);
    out["additionalProperties"] = false;
    return out;
}

/// A map whose keys are chosen by the user.
Json named(Json value) {
    Json out = of_type("object");
    out["propertyNames"] = keyword("pattern", "^" + name_pattern + "$");
    out["additionalProperties"] = std::move(value);
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

Json version(std::string_view what) {
    return described(fmt::format("version of the form of this {}", what),
                     keyword("enum", Json::array_t{1, "1"}));
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
    Json out = of_type(field.type == Type::integer ? "integer" : "number");
    if (std::isfinite(field.minimum))
        out[field.minimum_excluded ? "exclusiveMinimum" : "minimum"] = field.minimum;
    if (std::isfinite(field.maximum))
        out[field.maximum_excluded ? "exclusiveMaximum" : "maximum"] = field.maximum;
    return out;
}

/// The forms of a constant for `field`.
Json::array_t constants(const BlockType& type, const Field& field) {
    if (field.type == Type::enumeration) return {keyword("enum", field.names)};
    if (field.type == Type::boolean) return {of_type("boolean")};
    static const Unit second = *Unit::parse("s");
    Json::array_t forms;
    const auto units = possible_units(type, std::string(field.unit));
    if (std::ranges::any_of(units, [](const auto& unit) { return is_plain(*Unit::parse(unit)); }))
        forms.push_back(bare_number(field));
    forms.push_back(reference("quantity"));
    if (Unit::parse(units.front())->same_dimension(second)) forms.push_back(reference("interval"));
    return forms;
}

std::string description(const BlockType& type, const Field& field) {
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

Json rows(const TableField& table) {
    Json::array_t columns;
    for (const Field& column : table.columns) {
        Json::array_t forms{reference("quantity"), reference("parameter")};
        if (column.unit.empty()) forms.push_back(bare_number(column));
        columns.push_back(described(column.doc, any_of(forms)));
    }
    Json row = of_type("array");
    row["minItems"] = row["maxItems"] = columns.size();
    row["items"] = std::move(columns);
    Json out = list_of(std::move(row));
    out["maxItems"] = table.capacity;
    return described(table.doc, out);
}

Json block_type(const BlockType& type) {
    Json properties;
    properties["type"] = keyword("const", type.name);
    properties["task"] = reference("task_name");
    properties["cost"] = described("adds to its task's execution time", reference("time"));
    Json::array_t needed{"type", "task"};
    for (const Field& field : type.fields) {
        if (field.direction == Direction::output) continue;
        Json::array_t forms = constants(type, field);
        if (field.direction == Direction::input) forms.push_back(reference("wire"));
        forms.push_back(reference("parameter"));
        properties[std::string(field.name)] = described(description(type, field), any_of(forms));
        if (field.required) needed.push_back(field.name);
    }
    for (const TableField& table : type.tables) properties[std::string(table.name)] = rows(table);
    return described(type.doc, map_of(properties, needed));
}

/// A type from the catalogue, and then the keys of that type.
Json block(const Catalog& catalog) {
    Json out = of_type("object");
    out["required"] = Json::array_t{"type", "task"};
    out["properties"]["type"] = any_of({keyword("enum", catalog.names()), reference("parameter")});
    Json::array_t cases;
    for (const BlockType& type : catalog.types()) {
        Json one;
        one["if"]["properties"]["type"] = keyword("const", type.name);
        one["then"] = reference("block_" + std::string(type.name));
        cases.push_back(std::move(one));
    }
    out["allOf"] = std::move(cases);
    return out;
}

Json scalars() {
    const std::string parameter = "\\$" + name_pattern;
    Json out;
    out["name"] = text(name_pattern);
    out["parameter"] = described("$name: a parameter of the program", text(parameter));
    out["wire"] = described(
        "a wire from block.port or inputs.name; NOT negates it, previous(...) is the last scan's "
        "value",
        text(fmt::format("(NOT )?({0}|previous\\({0}\\))", signal_pattern)));
    out["signal"] = described("block.port, inputs.name or outputs.name",
                              text(signal_pattern + "|" + parameter));
    out["quantity"] = described("a number with its unit, such as 20 mm, 5e4 mm/s^3 or 20 %",
                                text("[-+]?[.0-9].*"));
    out["interval"] =
        described("every(task): the interval of a task", text("every\\(" + name_pattern + "\\)"));
    out["time"] =
        described("a time, such as 2 ms", any_of({reference("quantity"), reference("parameter")}));
    out["count"] = any_of({of_type("integer"), reference("quantity"), reference("parameter")});
    out["number"] = any_of({of_type("number"), reference("quantity")});
    out["scalar"] = keyword("type", Json::array_t{"string", "number", "boolean"});
    out["task_name"] = described("a task that scans", text(name_pattern + "|" + parameter));
    return out;
}

Json task() {
    const auto time = [](std::string_view text) { return described(text, reference("time")); };
    Json properties;
    properties["every"] = time("interval");
    properties["on"] = described("boolean signals: each rising edge starts a scan",
                                 any_of({reference("signal"), list_of(reference("signal"))}));
    properties["on_overrun"] =
        described("tasks: each time error of theirs starts a scan, as OB80",
                  any_of({reference("task_name"), list_of(reference("task_name"))}));
    properties["offset"] = time("start of the first scan");
    properties["priority"] = described("a larger number wins", reference("count"));
    properties["jitter"] = time("each interval is drawn from every +- jitter; a time or in %");
    properties["cost"] = time("execution time: outputs are published this long after the start");
    properties["cost_jitter"] = time("each cost is drawn from cost +- cost_jitter; a time or in %");
    properties["maximum_cycle_time"] = time("longest scan; 150 ms in the task of lowest priority");
    properties["motion"] = described("an overrun is STOP, as of MC_Servo",
                                     any_of({of_type("boolean"), reference("parameter")}));
    return map_of(properties);
}

Json expectation() {
    Json bounds;
    bounds["at_least"] = reference("scalar");
    bounds["at_most"] = reference("scalar");
    Json properties = bounds;
    properties["at"] =
        described("a time, or end", any_of({keyword("const", "end"), reference("time")}));
    properties["always"] = described("a signal that is judged in every scan", reference("signal"));
    properties["within"] =
        described("tolerance: in the signal's unit or in %", reference("scalar"));
    Json out = of_type("object");
    out["properties"] = properties;
    out["patternProperties"]["^" + signal_pattern + "$"] =
        any_of({reference("scalar"), map_of(bounds)});
    out["additionalProperties"] = false;
    out["oneOf"] = Json::array_t{required("at"), required("always")};
    return out;
}

Json values_of_signals() {
    Json values = of_type("object");
    values["patternProperties"]["^" + signal_pattern + "$"] = reference("scalar");
    values["additionalProperties"] = false;
    return values;
}

Json stimulus() {
    Json properties;
    properties["at"] = reference("time");
    properties["scan"] = described("before this scan of the task, from 0", reference("count"));
    properties["task"] = reference("task_name");
    properties["set"] = described("inputs and their new values", values_of_signals());
    properties["cost"] = described("execution time of this scan", reference("time"));
    Json out = map_of(properties);
    Json by_scan;
    by_scan["required"] = Json::array_t{"scan", "task"};
    Json by_time;
    by_time["required"] = Json::array_t{"at", "set"};
    out["oneOf"] = Json::array_t{by_time, by_scan};
    return out;
}

Json replay() {
    Json properties;
    properties["file"] =
        described("CSV with a column 'time', relative to this file", reference("scalar"));
    properties["set"] = described("inputs and the columns played into them", values_of_signals());
    properties["at"] = described("time of the run at the file's time 0", reference("time"));
    properties["between"] = described(
        "from row to row: held, the default, or on a line",
        any_of({keyword("enum", Json::array_t{"held", "interpolated"}), reference("parameter")}));
    return map_of(properties, {"file", "set"});
}

Json force() {
    Json properties;
    properties["from"] = described("default: the start", reference("time"));
    properties["until"] =
        described("then the program's own value again; default: never", reference("time"));
    properties["set"] = described("signals and their values meanwhile", values_of_signals());
    return map_of(properties, {"set"});
}

Json run() {
    Json properties;
    properties["for"] = described("how long to run, or how long at most", reference("time"));
    properties["until"] = described("a boolean signal that ends the run", reference("signal"));
    properties["seed"] = described("of all random numbers", reference("count"));
    properties["on_error"] =
        any_of({keyword("enum", Json::array_t{"stop", "continue"}), reference("parameter")});
    return map_of(properties, {"for"});
}

Json trigger() {
    const auto with = [](std::string_view key, Json value) {
        Json properties;
        properties["signal"] = reference("signal");
        properties[std::string(key)] = std::move(value);
        return map_of(properties, {"signal", key});
    };
    Json bounds = list_of(reference("scalar"));
    bounds["minItems"] = bounds["maxItems"] = 2;
    return described(
        "when a measurement begins; its time counts from there",
        any_of({keyword("const", "immediate"),
                with("edge", any_of({keyword("enum", Json::array_t{"rising", "falling"}),
                                     reference("parameter")})),
                with("above", reference("scalar")), with("below", reference("scalar")),
                with("inside", bounds), with("equals", reference("scalar"))}));
}

Json trace() {
    Json properties;
    properties["task"] = reference("task_name");
    properties["every"] = described("records every n-th scan", reference("count"));
    properties["signals"] = list_of(reference("signal"));
    properties["trigger"] = trigger();
    properties["pre_trigger"] = described("rows kept from before the trigger", reference("count"));
    properties["samples"] = described("rows from the trigger on, at most", reference("count"));
    properties["for"] = described("time from the trigger on, at most", reference("time"));
    properties["repeat"] =
        described("measurements at most, each in a file of its own", reference("count"));
    return map_of(properties, {"task", "signals"});
}

Json program_file() {
    Json properties;
    properties["lineshaft"] = version("program");
    properties["title"] = reference("scalar");
    properties["parameters"] =
        described("names and defaults; $name stands for the value", named(reference("scalar")));
    properties["controller"] =
        described("a file with tasks, relative to this one", reference("scalar"));
    properties["tasks"] = named(reference("task"));
    properties["blocks"] = described("in the order of their scan", named(reference("block")));
    properties["inputs"] =
        described("values from outside, as they are at the start", named(reference("scalar")));
    properties["outputs"] =
        described("names for outside and the signals that they show", named(reference("signal")));
    properties["retain"] =
        described("signals that outlive a run, see --retain-file", list_of(reference("signal")));
    properties["run"] = run();
    properties["stimulus"] =
        described("changes of inputs while running, and files played into them",
                  list_of(any_of({stimulus(), replay()})));
    properties["trace"] = described("what --trace records", reference("trace"));
    properties["traces"] = described(
        "further traces: --trace FILE.csv writes them to FILE.NAME.csv", named(reference("trace")));
    properties["force"] =
        described("values that win over what the program writes", list_of(force()));
    properties["expect"] = described("what must hold", list_of(reference("expectation")));
    Json out = map_of(properties, {"lineshaft", "blocks", "run"});
    out["anyOf"] = Json::array_t{required("tasks"), required("controller")};
    return out;
}

Json controller_file() {
    Json properties;
    properties["lineshaft_controller"] = version("controller");
    properties["title"] = reference("scalar");
    properties["tasks"] = named(reference("task"));
    return map_of(properties, {"lineshaft_controller", "tasks"});
}

void add_bounds(Json& properties) {
    properties["paper"] = described("the paper's value", reference("number"));
    properties["within"] = described(
        "distance from the paper's value, in its unit, in % or in points; of a list one is enough",
        any_of({reference("number"), list_of(reference("number"))}));
    properties["at_least"] = reference("number");
    properties["at_most"] = reference("number");
}

/// Of the repeats' values.
Json spread(Json properties) {
    return described("standard deviation over the repeats",
                     any_of({of_type("null"), map_of(std::move(properties))}));
}

Json comparisons() {
    Json properties;
    add_bounds(properties);
    properties["spread"] = spread(properties);
    Json map = of_type("object");
    map["patternProperties"]["^" + signal_pattern + "$"] =
        any_of({of_type("null"), map_of(properties)});
    map["additionalProperties"] = false;
    return any_of({list_of(text(signal_pattern)), map});
}

Json study_case() {
    Json properties;
    properties["name"] = described("for the claims' formulas", reference("name"));
    properties["set"] = reference("settings");
    properties["grid"] = described("every combination of these values is a run",
                                   named(list_of(reference("scalar"))));
    properties["random"] = described("parameters whose values are drawn for each case",
                                     named(reference("distribution")));
    properties["draws"] = described("how often; each is a case", reference("count"));
    properties["seed"] = described("of the draws, 1 unless said", of_type("integer"));
    properties["compare"] = reference("comparisons");
    properties["repeat"] = described("runs with seeds that follow each other", reference("count"));
    return map_of(properties);
}

Json distribution() {
    const Json two = [] {
        Json list = list_of(reference("scalar"));
        list["minItems"] = list["maxItems"] = 2;
        return list;
    }();
    Json properties;
    properties["uniform"] = described("[least, greatest]", two);
    properties["log_uniform"] = described("[least, greatest], both above 0", two);
    properties["normal"] = described("[mean, standard deviation], which may be in %", two);
    properties["integer"] = described("[least, greatest], whole numbers, both included", two);
    properties["choice"] = described("one of these", list_of(reference("scalar")));
    Json map = map_of(properties);
    map["minProperties"] = map["maxProperties"] = 1;
    return map;
}

Json claim() {
    Json properties;
    properties["claim"] = described("what is claimed", reference("scalar"));
    properties["formula"] = described("over the names of cases", reference("scalar"));
    properties["unit"] = keyword("const", "%");
    add_bounds(properties);
    return map_of(properties, {"claim", "formula"});
}

Json study_file() {
    Json properties;
    properties["lineshaft_study"] = version("study");
    properties["title"] = reference("scalar");
    properties["program"] = described("the program, relative to this file", reference("scalar"));
    properties["notes"] = any_of({reference("scalar"), list_of(reference("scalar"))});
    properties["set"] = reference("settings");
    properties["repeat"] = reference("count");
    properties["compare"] = reference("comparisons");
    properties["cases"] = list_of(reference("case"));
    properties["claims"] = list_of(reference("claim"));
    return map_of(properties, {"lineshaft_study", "program", "cases"});
}

Json fit_parameter() {
    Json properties;
    properties["from"] = described("lower bound", reference("number"));
    properties["to"] = described("upper bound", reference("number"));
    properties["start"] =
        described("of the first search, by default the middle", reference("number"));
    properties["step"] = described("of the difference quotients", reference("number"));
    return map_of(properties, {"from", "to"});
}

Json fit_comparisons() {
    Json properties;
    add_bounds(properties);
    properties["uncertainty"] = described(
        "differences are counted in it, in the signal's unit or in %", reference("number"));
    properties["spread"] = spread(properties);
    properties["column"] =
        described("of the trace, by default named as the signal", reference("scalar"));
    Json map = of_type("object");
    map["patternProperties"]["^" + signal_pattern + "$"] =
        any_of({of_type("null"), map_of(properties)});
    map["additionalProperties"] = false;
    return any_of({list_of(text(signal_pattern)), map});
}

Json fit_trace() {
    Json properties;
    properties["file"] = described("CSV, relative to this file", reference("scalar"));
    properties["time"] = described("its column of times, by default 'time'", reference("scalar"));
    properties["offset"] = described("time of the run at its time 0", reference("time"));
    return any_of({reference("scalar"), map_of(properties, {"file"})});
}

Json fit_case() {
    Json properties;
    properties["name"] = reference("name");
    properties["set"] = reference("settings");
    properties["repeat"] = described("runs with seeds that follow each other", reference("count"));
    properties["hold_out"] = described("takes no part in the search", of_type("boolean"));
    properties["trace"] = described("what was measured, sample by sample", fit_trace());
    properties["compare"] = fit_comparisons();
    return map_of(properties, {"compare"});
}

Json fit_file() {
    Json properties;
    properties["lineshaft_fit"] = version("fit");
    properties["title"] = reference("scalar");
    properties["program"] = described("the program, relative to this file", reference("scalar"));
    properties["notes"] = any_of({reference("scalar"), list_of(reference("scalar"))});
    properties["set"] = reference("settings");
    properties["repeat"] = reference("count");
    properties["parameters"] =
        described("of the program, whose values are looked for", named(fit_parameter()));
    properties["starts"] = described("searches from other points", reference("count"));
    properties["seed"] = described("of their points", reference("count"));
    properties["hold_out"] = described("leaves each case out in turn, predicted from all others",
                                       keyword("const", "each"));
    properties["cases"] = list_of(fit_case());
    return map_of(properties, {"lineshaft_fit", "program", "parameters", "cases"});
}

Json definitions(const Catalog& catalog) {
    Json out = scalars();
    out["task"] = task();
    out["block"] = block(catalog);
    for (const BlockType& type : catalog.types())
        out["block_" + std::string(type.name)] = block_type(type);
    out["trace"] = trace();
    out["expectation"] = expectation();
    out["settings"] =
        described("parameters of the program and their values", named(reference("scalar")));
    out["comparisons"] = comparisons();
    out["distribution"] = distribution();
    out["case"] = study_case();
    out["claim"] = claim();
    out["program"] = program_file();
    out["study"] = study_file();
    out["fit"] = fit_file();
    out["controller"] = controller_file();
    return out;
}

Json if_key(std::string_view key, const Json& then, const Json& otherwise) {
    Json out = keyword("if", required(key));
    out["then"] = then;
    out["else"] = otherwise;
    return out;
}

}  // namespace

nlohmann::ordered_json program_schema(const Catalog& catalog) {
    Json out;
    out["$schema"] = "http://json-schema.org/draft-07/schema#";
    out["title"] = "lineshaft: a program, a study, a fit or a controller";
    out["type"] = "object";
    out.update(if_key(
        "lineshaft_study", reference("study"),
        if_key("lineshaft_fit", reference("fit"),
               if_key("lineshaft_controller", reference("controller"), reference("program")))));
    out["definitions"] = definitions(catalog);
    return out;
}

}  // namespace lineshaft
