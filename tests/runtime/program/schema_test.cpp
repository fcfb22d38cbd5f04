#include "runtime/program/schema.hpp"

#include "runtime/program/program_form.hpp"
#include "tests/runtime/names/small_blocks.hpp"

using namespace lineshaft;
using Json = nlohmann::ordered_json;

namespace {

bool has_form(const Json& property, const Json& form) {
    const auto& forms = property.at("anyOf");
    return std::find(forms.begin(), forms.end(), form) != forms.end();
}

Json reference(const std::string& name) {
    Json out;
    out["$ref"] = "#/definitions/" + name;
    return out;
}

Json small_schema() {
    static constexpr FormOf files[] = {program_form, controller_form};
    return file_schema(small_catalog(), files);
}

}  // namespace

TEST_CASE("schema: a block's keys are its parameters and inputs") {
    const Json schema = small_schema();
    const Json& gain = schema.at("definitions").at("block_gain");
    std::vector<std::string> keys;
    for (const auto& [key, value] : gain.at("properties").items()) keys.push_back(key);
    CHECK(keys == std::vector<std::string>{"type", "task", "cost", "called", "initial", "unit",
                                           "factor", "x"});
    CHECK(gain.at("required") == Json::array({"type", "task", "x"}));
    CHECK(gain.at("additionalProperties") == false);
    CHECK(gain.at("properties").at("x").at("description") == "input: taken [unit]; must be set");
    CHECK(gain.at("properties").at("factor").at("description") ==
          "parameter: y / x, above 0, below 100; default 1");
}

TEST_CASE("schema: the forms of a value") {
    const Json schema = small_schema();
    const Json& counter = schema.at("definitions").at("block_counter").at("properties");
    const Json& gain = schema.at("definitions").at("block_gain").at("properties");
    const Json& probe = schema.at("definitions").at("block_probe").at("properties");
    CHECK(has_form(counter.at("enable"), Json{{"type", "boolean"}}));
    CHECK(has_form(counter.at("enable"), reference("wire")));
    CHECK(has_form(counter.at("step"),
                   Json{{"type", "integer"}, {"minimum", 1.0}, {"maximum", 9.0}}));
    CHECK_FALSE(has_form(gain.at("factor"), reference("wire")));
    CHECK(
        has_form(gain.at("factor"),
                 Json{{"type", "number"}, {"exclusiveMinimum", 0.0}, {"exclusiveMaximum", 100.0}}));
    CHECK_FALSE(has_form(gain.at("x"), Json{{"type", "number"}}));
    CHECK(has_form(probe.at("delay"), reference("interval")));
    CHECK_FALSE(has_form(probe.at("length"), reference("interval")));
    CHECK(has_form(probe.at("pace"), Json{{"enum", {"slow", "fast"}}}));
    for (const auto& [key, value] : probe.items())
        if (key != "type" && key != "task" && key != "cost" && key != "called" && key != "initial")
            CHECK(has_form(value, reference("parameter")));
}

TEST_CASE("schema: a reference is a block's name, a local is not a key") {
    static constexpr FormOf files[] = {program_form, controller_form};
    const Json schema = file_schema(small_catalog().add<Display>(), files);
    const Json& display = schema.at("definitions").at("block_display");
    const Json& counter = display.at("properties").at("counter");
    CHECK(counter.at("anyOf") == Json::array({reference("name"), reference("parameter")}));
    CHECK(counter.at("description") ==
          "reference to a block of type counter: that is shown; must be set");
    CHECK(display.at("required") == Json::array({"type", "task", "counter"}));
    CHECK_FALSE(display.at("properties").contains("shown"));
    CHECK_FALSE(display.at("properties").contains("highest"));
}

TEST_CASE("schema: every reference leads somewhere") {
    const Json schema = small_schema();
    int references = 0;
    const std::function<void(const Json&)> visit = [&](const Json& node) {
        if (!node.is_structured()) return;
        for (const auto& [key, value] : node.items()) {
            if (key == "$ref") {
                ++references;
                CHECK(schema.contains(Json::json_pointer(value.get<std::string>().substr(1))));
            }
            visit(value);
        }
    };
    visit(schema);
    CHECK(references > 50);
}
