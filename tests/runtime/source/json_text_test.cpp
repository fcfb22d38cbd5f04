#include "runtime/source/json_text.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace lineshaft;

TEST_CASE("what somebody else wrote as JSON is read in its order") {
    const char* const text =
        R"({"z": [1, -2, 2.5, "t", true, null, [], {}], "a": {"y": 18446744073709551615, "b": {}}})";
    CHECK(parse_json(text) == nlohmann::ordered_json::parse(text));
    CHECK(parse_json(text).dump() == nlohmann::ordered_json::parse(text).dump());
    CHECK(parse_json("7") == 7);
    for (const char* const wrong : {"", "{", "[1,]", "{\"a\" 1}", "[1] 2", "nul", "\"\xff\""})
        CHECK(parse_json(wrong).is_null());
}

TEST_CASE("JSON that is nested too deep, or has too many values, is none") {
    const auto nested = [](std::size_t depth) {
        return std::string(depth, '[') + std::string(depth, ']');
    };
    CHECK(parse_json(nested(deepest_json)).is_array());
    CHECK(parse_json(nested(deepest_json + 1)).is_null());
    const auto long_list = [](std::size_t values) {
        std::string text = "[0";
        for (std::size_t i = 1; i < values; ++i) text += ",0";
        return text + "]";
    };
    CHECK(parse_json(long_list(most_json_values - 1)).size() == most_json_values - 1);
    CHECK(parse_json(long_list(most_json_values)).is_null());
}

TEST_CASE("JSON with many keys is read as quickly as one with as many values") {
    std::string keys = "{\"\":0", objects = "[{}";
    for (int i = 0; i < 500'000; ++i) keys += fmt::format(",\"{}\":0", i);
    for (int i = 0; i < 500'000; ++i) objects += ",{}";
    CHECK(parse_json(keys + "}").size() == 500'001);  // for hours by the square
    CHECK(parse_json(objects + "]").size() == 500'001);
}
