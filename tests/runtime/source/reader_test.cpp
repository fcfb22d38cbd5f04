#include "runtime/source/reader.hpp"

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

Node scalar(std::string text, bool quoted = false) {
    Node node;
    node.text = std::move(text);
    node.quoted = quoted;
    return node;
}

/// The code and message of the first diagnostic; empty when there is none.
std::string first(const Diagnostics& out) {
    if (out.empty()) return {};
    return out.list().front().code + ": " + out.list().front().message;
}

std::string help(const Diagnostics& out) {
    return out.empty() ? "" : out.list().front().help;
}

const Unit mm_s = *Unit::parse("mm/s");
const Unit plain;

}  // namespace

TEST_CASE("reader: names") {
    CHECK(is_identifier("slave_x2"));
    CHECK(is_identifier("_"));
    for (const char* bad : {"", "2nd", "slave-x", "a b", "a.b", "Ä"})
        CHECK_FALSE(is_identifier(bad));
    REQUIRE(split_signal("a.b"));
    CHECK(split_signal("a.b")->owner == "a");
    CHECK(split_signal("a.b")->port == "b");
    REQUIRE(split_signal("a.table[1,-2].x"));
    CHECK(split_signal("a.table[1,-2].x")->port == "table[1,-2].x");
    for (const char* bad : {"a", "a.", ".b", "a.b.", "a.b[", "a.b-c", "NOT a.b"})
        CHECK_FALSE(split_signal(bad));
}

TEST_CASE("reader: booleans are true and false only") {
    Diagnostics out;
    const Reader read(out);
    CHECK(read.boolean(scalar("true")) == true);
    CHECK(read.boolean(scalar("false")) == false);
    CHECK(out.empty());
    const std::string bad = GENERATE("yes", "on", "True", "1", "0");
    CHECK(read.boolean(scalar(bad)) == std::nullopt);
    CHECK(first(out) == "L0307: '" + bad + "' is not a boolean");
}

TEST_CASE("reader: a boolean in quotes is a text") {
    Diagnostics out;
    CHECK(Reader(out).boolean(scalar("true", true)) == std::nullopt);
    CHECK(out.list().size() == 1);
}

TEST_CASE("reader: real numbers are converted to the unit that is due") {
    Diagnostics out;
    const Reader read(out);
    CHECK(read.real(scalar("2 cm/s"), mm_s) == 20);
    CHECK(read.real(scalar("1.5"), plain) == 1.5);
    CHECK(read.real(scalar("20 %"), plain) == 0.2);
    CHECK(read.real(scalar("3"), *Unit::parse("mm/mm")) == 3);
    CHECK(out.empty());
}

TEST_CASE("reader: what is wrong with a real number") {
    struct Row {
        std::string text, message, help;
    };
    const auto row = GENERATE(values<Row>({
        {"10", "L0302: '10' has no unit", "did you mean '10 mm/s'?"},
        {"10 mm", "L0303: '10 mm' is in mm (length), expected a number in mm/s (length/time)", ""},
        {"20 %", "L0303: '20 %' is a plain number, expected a number in mm/s (length/time)", ""},
        {"fast", "L0301: 'fast' is not a number", "expected a number in mm/s"},
        {"nan", "L0301: 'nan' is not a number", "expected a number in mm/s"},
        {"010 mm/s", "L0301: '010 mm/s' is not a number", "a number has no leading zero"},
        {"1,5 mm/s", "L0301: '1,5 mm/s' is not a number",
         "a number has a decimal point, not a comma"},
        {"1.2.3", "L0304: the unit '.3' in '1.2.3' is not known", ""},
        {"10 MM/s", "L0304: the unit 'MM' in '10 MM/s' is not known", "did you mean 'mm'?"},
        {"1e999 mm/s", "L0305: '1e999 mm/s' is beyond a 64-bit number's range", ""},
        {"1e308 m/s", "L0305: '1e308 m/s' is beyond a 64-bit number's range", ""},
    }));
    Diagnostics out;
    CHECK(Reader(out).real(scalar(row.text), mm_s) == std::nullopt);
    CHECK(first(out) == row.message);
    if (!row.help.empty()) CHECK(help(out) == row.help);
    CHECK(out.list().size() == 1);
}

TEST_CASE("reader: a bare number is no ratio of unlike units") {
    Diagnostics out;
    CHECK(Reader(out).real(scalar("1"), *Unit::parse("mm/rad")) == std::nullopt);
    CHECK(Reader(out).real(scalar("1"), *Unit::parse("deg/rad")) == std::nullopt);
    CHECK(out.list().size() == 2);
}

TEST_CASE("reader: whole numbers") {
    Diagnostics out;
    const Reader read(out);
    CHECK(read.integer(scalar("-3")) == -3);
    CHECK(read.integer(scalar("16#E0")) == 224);
    CHECK(read.whole(scalar("-3")) == Wide{-3});
    CHECK(read.whole(scalar("18446744073709551615")) ==
          Wide{std::numeric_limits<std::uint64_t>::max()});
    CHECK(out.empty());
    const std::string bad = GENERATE("3.0", "3 mm", "1e3");
    CHECK(read.integer(scalar(bad)) == std::nullopt);
    CHECK(first(out) == "L0309: '" + bad + "' is not a whole number");
}

TEST_CASE("reader: whole numbers beyond 64 bits, or beyond those with a sign") {
    Diagnostics out;
    CHECK(Reader(out).integer(scalar("9223372036854775808")) == std::nullopt);
    CHECK(first(out) ==
          "L0305: '9223372036854775808' is above 9223372036854775807, the greatest integer that "
          "has a sign");
    Diagnostics beyond;
    CHECK(Reader(beyond).whole(scalar("18446744073709551616")) == std::nullopt);
    CHECK(first(beyond) == "L0305: '18446744073709551616' is beyond a 64-bit number's range");
}

TEST_CASE("reader: times are whole nanoseconds") {
    Diagnostics out;
    const Reader read(out);
    CHECK(read.time(scalar("2 ms")) == 2'000'000);
    CHECK(read.time(scalar("0.1 s")) == 100'000'000);
    CHECK(read.time(scalar("0 s")) == 0);
    CHECK(out.empty());
}

TEST_CASE("reader: what is wrong with a time") {
    struct Row {
        std::string text, message;
    };
    const auto row = GENERATE(values<Row>({
        {"2", "L0302: '2' has no time unit"},
        {"2 mm", "L0308: '2 mm' is in mm (length), not a time"},
        {"-2 ms", "L0308: '-2 ms' is below 0"},
        {"0.5 ns", "L0308: '0.5 ns' is not a whole number of nanoseconds"},
        {"300000 h", ""},
        {"3000000 h", "L0308: '3000000 h' is too long"},
        {"soon", "L0301: 'soon' is not a number"},
    }));
    Diagnostics out;
    CHECK(Reader(out).time(scalar(row.text)).has_value() == row.message.empty());
    CHECK(first(out) == row.message);
}

TEST_CASE("reader: a share of a time") {
    Diagnostics out;
    const Reader read(out);
    CHECK(read.time_or_share(scalar("1 %"), 5'000'000) == 50'000);
    CHECK(read.time_or_share(scalar("3 us"), 5'000'000) == 3'000);
    CHECK(out.empty());
    CHECK(read.time_or_share(scalar("120 %"), 5'000'000) == std::nullopt);
    CHECK(first(out) == "L0305: '120 %' is not between 0 % and 100 %");
}

TEST_CASE("reader: kinds of nodes") {
    Diagnostics out;
    const Reader read(out);
    Node list;
    list.kind = Node::Kind::sequence;
    CHECK(read.expect_sequence(list, "'signals'"));
    CHECK(out.empty());
    CHECK_FALSE(read.expect_map(list, "'tasks'"));
    CHECK(first(out) == "L0209: 'tasks' is a map, not a list");
    CHECK_FALSE(read.expect_scalar(scalar(""), "'until'"));
    CHECK(out.list().back().message == "'until' has no value");
    CHECK(read.expect_scalar(scalar("", true), "the title"));
}

TEST_CASE("reader: an unknown parameter is reported once") {
    Diagnostics out;
    Node node = scalar("$speed");
    node.parameter = "speed";
    CHECK(Reader(out).real(node, mm_s) == std::nullopt);
    CHECK(out.empty());
    node.text = "10";
    CHECK(Reader(out).real(node, mm_s) == std::nullopt);
    CHECK(first(out) == "L0302: '10' has no unit (parameter 'speed' is '10')");
}

TEST_CASE("reader: a character that looks like another is pointed at") {
    Diagnostics out;
    Node node = scalar("10\xC2\xA0mm/s");
    node.mark = {nullptr, 3, 5, 7};
    CHECK(Reader(out).real(node, mm_s) == std::nullopt);
    CHECK(first(out) == "L0109: a no-break space (U+00A0) stands in '10\xC2\xA0mm/s'");
    CHECK(out.list().front().mark.column == 7);
    CHECK(out.list().front().mark.length == 1);
}

TEST_CASE("reader: an expression is called one") {
    Diagnostics out;
    CHECK(Reader(out).real(scalar("2 * 5 mm/s"), mm_s) == std::nullopt);
    CHECK(first(out) == "L0217: '2 * 5 mm/s' is an expression");
    CHECK(Reader(out).boolean(scalar("NOT a.q", true)) == std::nullopt);
    CHECK(out.list().back().help == "write it without quotes");
}

TEST_CASE("reader: a declared parameter is pointed at, and its use is named") {
    Diagnostics out;
    Node node = scalar("10");
    node.parameter = "speed";
    node.used_in_line = 9;
    CHECK(Reader(out).real(node, mm_s) == std::nullopt);
    CHECK(first(out) == "L0302: '10' has no unit (parameter 'speed', used in line 9)");
}
