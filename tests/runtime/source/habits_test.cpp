#include "runtime/source/habits.hpp"

#include <random>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/source/units.hpp"

using namespace lineshaft;

namespace {

/// What stands in the first quotes of `text`.
std::string quoted(const std::string& text) {
    const auto begin = text.find('\'') + 1;
    return text.substr(begin, text.find('\'', begin) - begin);
}

bool suggests(const std::string& help) {
    return help.starts_with("did you mean");
}

}  // namespace

TEST_CASE("habits: characters that look like others") {
    CHECK_FALSE(find_look_alike("10 mm/s, -5 \"x\" \xC3\xA4\xC2\xB5\xC2\xB0"));
    CHECK_FALSE(find_look_alike(""));
    CHECK_FALSE(find_look_alike("\xE2\x88"));
    const auto minus = find_look_alike(
        "a \xE2\x88\x92"
        "5");
    REQUIRE(minus);
    CHECK(minus->offset == 2);
    CHECK(minus->name == "a minus sign (U+2212)");
    CHECK(minus->instead == "'-'");
    CHECK(find_look_alike("10\xC2\xA0mm")->instead == "a blank");
}

TEST_CASE("habits: expressions") {
    struct Row {
        std::string text, block;
    };
    const auto row = GENERATE(values<Row>({
        {"a.q AND b.q", "and"},
        {"a.q and b.q", "and"},
        {"a.q && b.q", "and"},
        {"a.q OR NOT b.q", "or"},
        {"a.q XOR b.q", "xor"},
        {"NOT a.q", "not"},
        {"a.x > 5 mm", "gt"},
        {"a.x>=5 mm", "ge"},
        {"a.x < b.x", "lt"},
        {"a.x <> 5", "ne"},
        {"a.x == 5", "eq"},
        {"a.x = 5", "eq"},
        {"$speed * 2", "mul"},
        {"2*$speed", "mul"},
        {"a.x / 2", "div"},
        {"a.x + b.x", "add"},
        {"10 mm - $way", "sub"},
    }));
    const std::string help = expression_help(row.text);
    CHECK(help.ends_with("see 'lineshaft blocks " + row.block + "'"));
    CHECK(standard_blocks().find(row.block) != nullptr);
}

TEST_CASE("habits: what is no expression") {
    for (const char* text :
         {"", "10 mm/s", "-5 mm", "1e-3", "5 mm / s", "a.x", "previous(a.x)", "fast",
          "every(servo)", "16#E0", "slave-x", "2024-01-02", "- 5 mm", "BRAND AND"})
        CHECK(expression_help(text).empty());
    CHECK(expression_help(">= 10 mm/s") == "a bound is written at_least: 10 mm/s");
    CHECK(expression_help("<5") == "a bound is written at_most: 5");
    CHECK(expression_help("!a.q") == "write NOT a.q");
    CHECK(expression_help("!").empty());
}

TEST_CASE("habits: a unit's right spelling") {
    struct Row {
        std::string name, unit;
    };
    const auto row = GENERATE(values<Row>({
        {"sec", "s"},
        {"s2", "s^2"},
        {"s\u00B2", "s^2"},
        {"\u00B5m", "um"},
        {"\u03BCs", "us"},
        {"MM", "mm"},
        {"KHZ", "kHz"},
        {"degrees", "deg"},
        {"\u00B0", "deg"},
        {"mps", "m/s"},
        {"pulsse", "pulse' or 'pulses"},
        {"U/min", "rpm"},
    }));
    CHECK(unit_help(row.name, "expected a time") == "did you mean '" + row.unit + "'?");
}

TEST_CASE("habits: what measures something else is never taken for a unit's misspelling") {
    for (const char* symbol :
         {"N", "Nm", "A", "V", "W", "g", "bar", "Pa", "J", "K", "degC", "\u00B0C", "l"})
        for (const char* prefix : {"", "k", "m", "u", "M", "h", "c"}) {
            const std::string name = std::string(prefix) + symbol;
            INFO(name);
            if (!Unit::parse(name)) CHECK_FALSE(suggests(unit_help(name, {})));
        }
    CHECK(unit_help("Nm", "expected a number in mm") ==
          "'Nm' measures torque; expected a number in mm");
    CHECK(unit_help("in", {}) == "1 in is 25.4 mm");
    CHECK(unit_help("furlong", "expected a time") ==
          "'lineshaft units' lists the units; expected a time");
    for (const char* name : {"mHz", "Mm", "mss"}) CHECK_FALSE(suggests(unit_help(name, {})));
}

TEST_CASE("habits: a suggested unit is a unit, whatever was written") {
    const unsigned seed = 7;
    std::mt19937 random(seed);
    const std::string letters = "mskurdegHzMNApul1/^2 ";
    for (int i = 0; i < 20'000; ++i) {
        std::string name;
        for (auto length = random() % 7 + 1; length > 0; --length)
            name += letters[random() % letters.size()];
        if (Unit::parse(name)) continue;
        const std::string help = unit_help(name, {});
        INFO("seed " << seed << ": '" << name << "': " << help);
        CHECK(!help.empty());
        if (suggests(help)) CHECK(Unit::parse(quoted(help)));
    }
}
